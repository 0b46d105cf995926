// SPDX-License-Identifier: GPL-3.0-or-later
// How long a motion is, by the cost that a case names, in binary64.
//
// A motion straight in the parameters curves in space, as does one on constraints: its length is that of its own curve,
// not the distance between its ends. Distances are the heuristic of a search: no motion between two poses is shorter.
#pragma once

#include <vector>

#include "atlas/manifold.h"
#include "case/case_file.h"
#include "kinematics/pose_sampler.h"

namespace taut {

class PathLength {
 public:
  /// `near`: where in the space to look for the sphere of Cost::kGreatCircle; at least one point.
  /// @throws InputError if the positions p of the space do not lie on one sphere, for kGreatCircle.
  PathLength(const PoseSampler& sampler, Cost cost, const std::vector<Coordinates>& near);

  /// Of the motion from a to b (edge_motion.h): rotation angle [rad], way of the origin [m], or length in the
  /// parameters. Never less than distance(a, b); its relative error is of fourth order in the distance of samples.
  [[nodiscard]] double along(const Coordinates& a, const Coordinates& b) const;

  /// Of the shortest motion between the two poses if nothing were in its way: the angle ‖log(R_a^T R_b)‖ [rad], the arc
  /// on the sphere [m], or the distance in the parameters.
  [[nodiscard]] double distance(const Coordinates& a, const Coordinates& b) const;

 private:
  struct PlatformPose {
    Vector3<double> p_WP;
    Matrix3<double> r_WP;
  };
  [[nodiscard]] PlatformPose platform_pose(const Pose<double>& pose) const;
  [[nodiscard]] PlatformPose platform_pose(const Coordinates& q) const;
  [[nodiscard]] double between(const PlatformPose& a, const PlatformPose& b) const;
  [[nodiscard]] Coordinates point_near(const Coordinates& centre, const Coordinates& away) const;
  void fit_sphere(const std::vector<Coordinates>& near);

  const PoseSampler& sampler_;
  Cost cost_;
  double sphere_radius_ = 0;  ///< [m], for kGreatCircle
};

}  // namespace taut
