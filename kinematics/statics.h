// SPDX-License-Identifier: GPL-3.0-or-later
// Tensions at one pose: the unique balance f0 of the nominal wrench, and how far each tension moves over the wrench set
// K.
//
//   Y = D^-1,  f0_i = d_i (Y w0)_i,  v_ii = d_i |y_i L|,  E^-1 = L L^T,  y_i the i-th row of Y                (4)–(6)
//
// Where K is an ellipsoid, tensions fill [f0_i − v_ii, f0_i + v_ii]; items of loads (loads.h) add to f0 and to what is
// below and above it. A pose is wrench-feasible when that range lies inside (f_lo, f_hi) and d_i inside (d_lo, d_hi)
// for all six cables.
// For an enclosing scalar everything returned is an enclosure; where the inverse does not exist (or can't be enclosed)
// the result is not `regular`. Segments are proved by certify/box_proof.h, which is tighter over a range of poses.
#pragma once

#include "kinematics/geometry.h"

namespace taut {

template <class S>
struct Statics {
  bool regular = false;                  ///< D was inverted; else only lengths are set
  std::array<S, kCables> length;         ///< d_i [m]
  std::array<S, kCables> tension;        ///< f0_i [N]
  std::array<S, kCables> tension_below;  ///< v_ii; how far K moves a tension below f0 [N]
  std::array<S, kCables> tension_above;  ///< v_ii; how far above [N]
  S determinant;                         ///< det J about P_m, equal to det J about O
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

/// Wrench scale: the factor by which K may grow about its nominal wrench, min over i of (f0_i − f_lo)/v_ii and (f_hi −
/// f0_i)/v_ii; infinite if K is a single wrench.
[[nodiscard]] double wrench_scale_approx(const Model<double>& model, const Statics<double>& statics);

}  // namespace taut

#include "kinematics/statics_impl.h"
