// SPDX-License-Identifier: GPL-3.0-or-later
// What the pictures of a machine show of its bodies. It is computed in floating point and proves nothing.
#pragma once

#include <Eigen/Core>
#include <string>
#include <vector>

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

/// The obstacles, then the bodies of the platform; none where the problem has none. Meshes are those that the
/// checker was given.
[[nodiscard]] std::vector<BodyShape> body_shapes(const ReportContext& scene);

/// "obstacles: floor, stack", in quotes; at most `most` names. Nothing where there are none.
[[nodiscard]] std::string body_names(const std::vector<BodyText>& bodies, std::size_t most);

}  // namespace taut
