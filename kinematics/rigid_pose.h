// Poses in binary64 along the laws of segment.h that know nothing of a space, and the pose that given lengths hold.
//
// For what proposes, measures and draws; nothing here is proved.
#pragma once

#include <array>
#include <optional>

#include "kinematics/geometry.h"
#include "kinematics/quaternion.h"
#include "kinematics/segment.h"

namespace taut {

struct RigidPose {
  Vector3<double> p_WP;  ///< [m]
  Matrix3<double> r_WP;
};

/// At s, under a law with poses; of cable lengths, the reference.
[[nodiscard]] RigidPose pose_between(const Segment& segment, double s);

/// Waypoint::x of a pose: position, and the unit quaternion (x, y, z, w) of the rotation, of the sign that is next to `near`.
[[nodiscard]] std::array<double, 7> pose_numbers(const RigidPose& pose, const std::array<double, 4>& near = {0, 0, 0, 1});

/// |d_i| [m].
[[nodiscard]] std::array<double, kCables> lengths(const Model<double>& model, const RigidPose& pose);

/// A pose with these lengths [m], by Newton's method from `start`; nothing if it does not converge.
[[nodiscard]] std::optional<RigidPose> pose_of_lengths(const Model<double>& model, const RigidPose& start,
                                                       const std::array<double, kCables>& lengths);

/// How far (p [m], rotation vector [rad]) moves, coordinate by coordinate at most, where lengths may be wrong by `errors` [m];
/// first order. Nothing where the pose is singular.
[[nodiscard]] std::optional<std::array<double, 6>> displacement(const Model<double>& model, const RigidPose& pose,
                                                                const std::array<double, kCables>& errors);

}  // namespace taut
