// SPDX-License-Identifier: GPL-3.0-or-later
// The length of a motion by the cost that a case names, in binary64.
//
// A motion that is straight in the parameters is a curve in space, and so is one on constraints. Its length is that of
// the curve, not the distance between its ends. No motion between two poses is shorter than their distance, so
// distances are the heuristic of a search.
#pragma once

#include <string>
#include <vector>

#include "atlas/manifold.h"
#include "case/case_file.h"
#include "kinematics/pose_sampler.h"

namespace taut {

class PathLength {
 public:
  /// @param near  points near which the sphere of Cost::kGreatCircle is fitted; at least one.
  /// @param travel  what Cost::kTravel adds up.
  /// @throws InputError if, for kGreatCircle, the positions p of the space do not lie on one sphere.
  PathLength(const PoseSampler& sampler, Cost cost, const std::vector<Coordinates>& near,
             const TravelCost& travel = {});

  /// What is measured, in words: "the angle that the platform turns".
  [[nodiscard]] std::string measure() const;
  /// The unit of lengths: "rad" or "m"; empty for the parameters, which mix both.
  [[nodiscard]] const char* unit() const;

  /// Length of the motion from a to b (edge_motion.h): rotation angle [rad], distance travelled by the origin [m],
  /// distance travelled by a point plus a length per radian turned [m], or length in the parameters. Never less than
  /// distance(a, b); its relative error is of fourth order in the distance between samples.
  [[nodiscard]] double along(const Coordinates& a, const Coordinates& b) const;

  /// x -> along(a, x) + along(x, b), but for rounding, where much of what a and b take is done once.
  class Through;

  /// Length of the shortest motion between the two poses without limits: the angle ‖log(R_a^T R_b)‖ [rad], the arc on
  /// the sphere [m], the distance of the point's places plus a length per radian of that angle [m], or the distance in
  /// the parameters.
  [[nodiscard]] double distance(const Coordinates& a, const Coordinates& b) const;

 private:
  struct RigidTransform {
    Vector3<double> p_W;  ///< of the point that is measured, which is the platform's origin but for kTravel
    Matrix3<double> r_WP;
  };
  [[nodiscard]] RigidTransform transform(const Pose<double>& pose) const;
  [[nodiscard]] RigidTransform transform(const Coordinates& q) const;
  [[nodiscard]] double between(const RigidTransform& a, const RigidTransform& b) const;
  [[nodiscard]] double along(const Coordinates& a, const RigidTransform& at_a, const Coordinates& b,
                             const RigidTransform& at_b) const;
  [[nodiscard]] Coordinates point_near(const Coordinates& centre, const Coordinates& away) const;
  void fit_sphere(const std::vector<Coordinates>& near);

  const PoseSampler& sampler_;
  Cost cost_;
  Vector3<double> point_P_;   ///< [m], for kTravel
  double per_radian_ = 0;     ///< [m], for kTravel
  double sphere_radius_ = 0;  ///< [m], for kGreatCircle
};

class PathLength::Through {
 public:
  /// `length` has to outlive this.
  Through(const PathLength& length, Coordinates a, Coordinates b);
  [[nodiscard]] double operator()(const Coordinates& x) const;

 private:
  const PathLength& length_;
  Coordinates a_, b_;
  RigidTransform at_a_, at_b_;
};

}  // namespace taut
