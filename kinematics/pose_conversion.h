// SPDX-License-Identifier: GPL-3.0-or-later
// Poses from one form to another, in floating point: angles, quaternions, cable lengths.
//
// For waypoints that are given in one form and joined in another. What comes out is rounded to binary64, and it is
// those waypoints that a proof is about.
#pragma once

#include <Eigen/Geometry>
#include <array>
#include <optional>

#include "kinematics/model.h"
#include "kinematics/segment.h"

namespace taut {

/// p [m] and R = R(q); |q| = 1 up to rounding.
struct RigidPose {
  Vector3<double> p;
  Eigen::Quaterniond q;
};

/// As waypoints have it.
[[nodiscard]] PoseNumbers pose_numbers(const RigidPose& pose);
/// With the numbers of a waypoint; q may have any length there.
[[nodiscard]] RigidPose rigid_pose(const PoseNumbers& x);

/// R(q) is the pose's rotation; of angles that grow continuously, q is continuous.
[[nodiscard]] RigidPose rigid_pose(const Angles<double>& angles, const Pose<double>& pose);

/// p [m] and tilt-and-torsion angles [rad].
struct TiltedPose {
  Vector3<double> p;
  double phi, theta, sigma;
};
[[nodiscard]] RigidPose rigid_pose(const TiltedPose& pose);

/// Angles as x + π half_turns: phi, theta, sigma.
struct TiltAndTorsion {
  std::array<double, 3> x{};
  std::array<int, 3> half_turns{};
  [[nodiscard]] double value(std::size_t i) const;
};

/// Those of R(q) that are next to `previous`: by whole turns of phi and sigma, and of (phi, theta) and (phi + π,
/// −theta) the nearer one. Without `previous`: theta in [0, π]. phi is kept where theta = 0, sigma where theta = π.
[[nodiscard]] TiltAndTorsion tilt_and_torsion(const Eigen::Quaterniond& q,
                                              const std::optional<TiltAndTorsion>& previous);

/// |p + R b_i − a_i| [m]
[[nodiscard]] std::array<double, kCables> cable_lengths(const Model<double>& model, const RigidPose& pose);

/// The pose with those lengths that is reached from `start` as its lengths change to them at constant rates, in
/// floating point, in steps short enough for Newton's method to contract well from the first: a good guess, and no
/// proof, that it is the way's next pose. Nothing where that fails, as where the way ends at a singular pose. q is
/// followed, too: it is −q after a whole turn.
[[nodiscard]] std::optional<RigidPose> pose_of_lengths(const Model<double>& model,
                                                       const std::array<double, kCables>& lengths,
                                                       const RigidPose& start);

/// At s, under a law between poses; of cable lengths, the reference.
[[nodiscard]] RigidPose pose_between(const Segment& segment, double s);

}  // namespace taut
