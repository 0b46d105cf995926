// SPDX-License-Identifier: GPL-3.0-or-later
// From where the pictures of a machine look at it, moving or still, and the level grid below it. It is computed in
// floating point.
#pragma once

#include <array>
#include <vector>

#include "reports/page/drawing.h"
#include "reports/summary/scene.h"

namespace taut {

/// A parallel projection, in which equal lengths in a plane across the view are equal in the picture. Weights pull
/// down.
struct MachineView {
  /// Of the axes of W, `up` is taken if the weights, or else the nominal force, nearly pull against it.
  explicit MachineView(const ReportContext& scene);

  Eigen::Vector3d up;      ///< against the load
  Eigen::Vector3d across;  ///< level: to the right, seen from the front
  Eigen::Vector3d inward;  ///< level: away from who stands in front; up × across
  double azimuth = 0;      ///< of who looks, from the front to the right [rad]
  double elevation = 0;    ///< of who looks, above the level [rad]

  /// Level lines along `across` and `inward`, at multiples of a round length.
  struct Grid {
    double height = 0;                      ///< along `up`, from the origin of W [m]
    double step = 0;                        ///< [m]
    std::array<int, 2> across{}, inward{};  ///< first and last, in steps from the origin of W
  };
  Grid grid;
  std::vector<Eigen::Vector3d>
      swept;                 ///< base anchors, and platform anchors, load point and weights along the path, and
                             ///< bodies: all of the platform's, and of obstacles what is near [m]
  bool is_drawable = false;  ///< whether all of them are numbers that can be drawn; else the grid is not set

  [[nodiscard]] Eigen::Vector3d right() const;    ///< in the picture
  [[nodiscard]] Eigen::Vector3d upward() const;   ///< in the picture
  [[nodiscard]] Eigen::Vector3d towards() const;  ///< towards who looks
  /// In the picture, in metres, y pointing down.
  [[nodiscard]] Point2 operator()(const Eigen::Vector3d& p) const { return {right().dot(p), -upward().dot(p)}; }
  /// The part of a plane { normal·x = offset } that is next to what is drawn: the corners of a rectangle, in order.
  /// @pre normal has length 1, and this is drawable
  [[nodiscard]] std::array<Eigen::Vector3d, 4> plane(const Eigen::Vector3d& normal, double offset) const;
  /// The point of the ground below p.
  [[nodiscard]] Eigen::Vector3d foot(const Eigen::Vector3d& p) const { return p + (grid.height - up.dot(p)) * up; }
};

/// Where weights pull, or else the nominal force, or else −z: an axis of W, if it nearly is one; of length 1.
[[nodiscard]] Eigen::Vector3d downward(const Model<double>& model, const LoadText& load);
/// The level direction that is to the right when a machine is seen from the front.
[[nodiscard]] Eigen::Vector3d across_of(const Eigen::Vector3d& up);

/// The platform's anchors at a pose [m].
[[nodiscard]] std::vector<Eigen::Vector3d> platform_at(const ReportContext& scene, const Pose<double>& pose);
/// The load point at a pose [m].
[[nodiscard]] Eigen::Vector3d load_point_at(const ReportContext& scene, const Pose<double>& pose);
/// The centres of gravity of the load's weights at a pose, each in the middle of where it may be [m].
[[nodiscard]] std::vector<Eigen::Vector3d> weights_at(const ReportContext& scene, const Pose<double>& pose);
[[nodiscard]] std::vector<Eigen::Vector3d> base_of(const ReportContext& scene);
/// The corners of the box around a body that is only shown, along its own axes; none where there is none.
[[nodiscard]] std::vector<Eigen::Vector3d> box_corners(const std::optional<ShownBody>& body);
[[nodiscard]] std::vector<Eigen::Vector3d> box_corners(const ShownBody& body);

}  // namespace taut
