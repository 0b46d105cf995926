// SPDX-License-Identifier: GPL-3.0-or-later
// What the pictures of a machine show of its bodies. It is computed in floating point and proves nothing.
#pragma once

#include <Eigen/Core>
#include <functional>
#include <map>
#include <string>
#include <vector>

#include "kinematics/bodies.h"
#include "reports/page/drawing.h"
#include "reports/summary/scene.h"

namespace taut {

struct BodyShape {
  std::string name;
  bool is_obstacle = false;             ///< in W; else on the platform, and in P
  std::vector<Eigen::Vector3d> points;  ///< the body is all within the radius of their convex hull [m]
  double radius = 0;
  bool is_half_space = false;       ///< { normal·x <= offset }, in place of both
  Eigen::Vector3d normal{0, 0, 1};  ///< of length 1
  double offset = 0;                ///< [m]
  const ShownBody* mesh = nullptr;  ///< in place of all: triangles

  /// The corners of a box that contains all of it, in its own axes; none of a half-space.
  [[nodiscard]] std::vector<Eigen::Vector3d> box() const;
};

/// The obstacles, then the bodies of the platform. @param meshes  by their bodies' names; referred to
[[nodiscard]] std::vector<BodyShape> body_shapes(const BodiesText& bodies, const BodyModel<double>& model,
                                                 const std::map<std::string, ShownBody>& meshes);
/// The same of a report; none where the problem has none. Meshes are those that the checker was given.
[[nodiscard]] std::vector<BodyShape> body_shapes(const ReportContext& scene);

/// The corners of what of the obstacles is next to some points: what is far from the machine would make it tiny.
[[nodiscard]] std::vector<Eigen::Vector3d> near_parts(const std::vector<BodyShape>& bodies,
                                                      const std::vector<Eigen::Vector3d>& points);
/// The path of the feature_edges() of a body of triangles in a picture, the longest ones if there are many.
[[nodiscard]] std::string edges_data(const ShownBody& body, const Eigen::Vector3d& towards,
                                     const std::function<Point2(const Eigen::Vector3d&)>& place);

/// "obstacles: floor, stack", in quotes; at most `most` names. Nothing where there are none.
[[nodiscard]] std::string body_names(const std::vector<BodyText>& bodies, std::size_t most);

}  // namespace taut
