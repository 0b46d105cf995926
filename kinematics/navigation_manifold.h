// SPDX-License-Identifier: GPL-3.0-or-later
// The navigation manifold M of the paper: F(x) = 0 over 90 variables, as a graph over the pose.
//
// x = (p, τ, d_1…d_6, d, f0, v_1…v_6, g, s, t), 3 + 3 + 18 + 6 + 6 + 36 + 6 + 6 + 6 = 90 numbers, subject to 84
// equations:
//
//   d_i = p + R(τ) b_i − a_i                                                     18                               (1)
//   d_i² = |d_i|²                                                                 6                               (2)
//   J f0 = w0, J with columns (d_i ; (R(b_i − p_m)) × d_i)/d_i                     6                               (4)
//   (row j of B) v_i = 0 for j ≠ i,   B = J^T E J                                30                               (5)
//   v_i^T B v_i = 1                                                                6                               (6)
//   g_i (d_i − d_lo)(d_hi − d_i) = ((d_hi − d_lo)/2)²                              6                              (10)
//   s_i (f0_i − v_ii − f_lo) = (f_hi − f_lo)/2                                     6                              (11)
//   t_i (f_hi − f0_i − v_ii) = (f_hi − f_lo)/2                                     6                              (12)
//
// (1)–(2), (4)–(6), (10)–(12) number the paper's equations. Its right-hand sides in (10)–(12) are a choice of unit for
// the slack variables; with these each slack is 1 at mid-range. x(q) and dx/dq are closed form:
//   Y = D^-1,  B^-1 = diag(d) Y E^-1 Y^T diag(d),  v_i = B^-1 e_i / sqrt((B^-1)_ii),  Y' = −Y D' Y.
//
// Planning uses the part of x that its metric needs (atlas/wrench_feasible_manifold.h); F(x) is here to be tested
// against.
#pragma once

#include <Eigen/Core>

#include "kinematics/statics.h"

namespace taut {

inline constexpr int kNavigationVariables = 90;
inline constexpr int kNavigationEquations = 84;

template <class S>
using NavigationPoint = Eigen::Matrix<S, kNavigationVariables, 1>;

/// Where each group starts in x.
struct NavigationLayout {
  static constexpr int kPosition = 0, kAngles = 3, kCableVectors = 6, kLengths = 24, kTensions = 30, kVariations = 36,
                       kLengthSlack = 72, kLowSlack = 78, kHighSlack = 84;
};

/// x(q) and, in columns, dx/dq along given directions of the pose (q = px, py, pz and the angles).
template <class S>
struct NavigationTangent {
  NavigationPoint<S> point;
  Eigen::Matrix<S, kNavigationVariables, 6> tangent;
};

/// @returns whether D is regular; else `result` is of no use.
template <class S>
bool navigation_tangent(const Model<S>& model, const Pose<S>& pose, NavigationTangent<S>& result);

/// F(x) [m, m², N, N·…, 1]: zero exactly on M. Any x.
template <class S>
[[nodiscard]] Eigen::Matrix<S, kNavigationEquations, 1> navigation_residual(const Model<S>& model,
                                                                            const NavigationPoint<S>& x);

extern template bool navigation_tangent(const Model<double>&, const Pose<double>&, NavigationTangent<double>&);
extern template Eigen::Matrix<double, kNavigationEquations, 1> navigation_residual(const Model<double>&,
                                                                                   const NavigationPoint<double>&);

}  // namespace taut

#include "kinematics/navigation_manifold_impl.h"
