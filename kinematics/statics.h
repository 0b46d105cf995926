// SPDX-License-Identifier: GPL-3.0-or-later
// Tensions at one pose: the unique balance f0 of w0, and how far each tension moves over the wrench set K.
//
//   Y = D^-1,  f0_i = d_i (Y w0)_i,  v_ii = d_i |y_i L|,  E^-1 = L L^T,  y_i the i-th row of Y                (4)–(6)
//
// A pose is wrench-feasible when f0_i ± v_ii lies inside (f_lo, f_hi) and d_i inside (d_lo, d_hi) for all six cables.
// For an enclosing scalar everything returned is an enclosure; where the inverse does not exist (or can't be enclosed)
// the result is not `regular`. Segments are proved by certify/box_proof.h, which is tighter over a range of poses.
#pragma once

#include "kinematics/geometry.h"

namespace taut {

template <class S>
struct Statics {
  bool regular = false;                   ///< D was inverted; else only lengths are set
  std::array<S, kCables> length;          ///< d_i [m]
  std::array<S, kCables> tension;         ///< f0_i [N]
  std::array<S, kCables> tension_radius;  ///< v_ii [N]
  S determinant;                          ///< det J about P_m, equal to det J about O
};

/// Gauss–Jordan elimination with partial pivoting by mignitude. @returns whether `matrix` is (certainly) regular.
template <class S>
bool invert(const Matrix6<S>& matrix, Matrix6<S>& inverse, S& determinant);

template <class S>
[[nodiscard]] Statics<S> statics(const Model<S>& model, const Vector3<S>& p_WP, const Matrix3<S>& r_WP);
template <class S>
[[nodiscard]] Statics<S> statics(const Model<S>& model, const Pose<S>& pose) {
  return statics(model, pose.p_WP, rotation(model.angles, pose.angles));
}

/// Wrench scale: the factor by which the semi-axes of K may grow, min over i of (f0_i − f_lo)/v_ii and (f_hi −
/// f0_i)/v_ii.
[[nodiscard]] double wrench_scale_approx(const Model<double>& model, const Statics<double>& statics);

}  // namespace taut

#include "kinematics/statics_impl.h"
