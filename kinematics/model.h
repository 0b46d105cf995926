// SPDX-License-Identifier: GPL-3.0-or-later
// The problem in numbers of one scalar: anchors, limits, load and the pose as a function of the parameters.
//
// Model<double> is an approximation, Model<MpInterval> an enclosure of the exact Problem. Frames: W world, P platform,
// M the load point (origin P_m, axes of P for anchors, axes of W for wrenches).
#pragma once

#include <Eigen/Core>
#include <array>

#include "kinematics/loads.h"
#include "problem/expression.h"
#include "problem/problem.h"
#include "problem/rational.h"
#include "problem/scalar.h"

namespace taut {

template <class S>
using Vector3 = Eigen::Matrix<S, 3, 1>;
template <class S>
using Matrix3 = Eigen::Matrix<S, 3, 3>;
template <class S>
using Vector6 = Eigen::Matrix<S, 6, 1>;
template <class S>
using Matrix6 = Eigen::Matrix<S, 6, 6>;

/// p [m] and the angles [rad] of the space (AngleKind): phi, theta, sigma unless the case chooses others.
template <class S>
struct Pose {
  Vector3<S> p_WP;
  std::array<S, 3> angles;
};

/// How a pose's angles give R_WP. The matrices are those of kAxis, with n the unit vector along the axis, so that
/// R = 1 + sin(turn) [n] + (1 − cos(turn)) [n]².
template <class S>
struct Angles {
  AngleKind kind = AngleKind::kTiltAndTorsion;
  Matrix3<S> cross;   ///< [n], the matrix of the cross product by n
  Matrix3<S> square;  ///< [n]² = n nᵀ − 1
};
/// @pre the axis is not 0
template <class S>
[[nodiscard]] Angles<S> make_angles(const AnglesText& text);

template <class S>
struct Model {
  std::array<Vector3<S>, kCables> p_WA;                 ///< base anchors a_i [m]
  std::array<Vector3<S>, kCables> p_PB;                 ///< platform anchors b_i [m]
  std::array<Vector3<S>, kCables> p_MB;                 ///< b_i − p_m, from the load point, axes of P [m]
  Vector3<S> p_PM;                                      ///< load point p_m [m]
  std::array<S, kCables> tension_lower, tension_upper;  ///< [N]
  std::array<S, kCables> length_lower, length_upper;    ///< [m]
  Vector6<S> wrench;                                    ///< w0 about P_m, axes of W [N, N m]
  LoadModel<S> loads;                                   ///< K is the sum of these and, if there is one, the ellipsoid
  bool has_ellipsoid = false;                           ///< else what follows of it is 0
  Matrix6<S> ellipsoid;                                 ///< E
  /// L with E^-1 = L L^T, upper triangular: the semi-axes of K, so that K = {w0 + L z : |z| <= 1}.
  Matrix6<S> ellipsoid_root;
  Angles<S> angles;                    ///< of the space's poses
  bool ellipsoid_is_diagonal = false;  ///< E, hence L, is exactly diagonal
  double characteristic_length = 0;    ///< mean |b_i| [m], scales lengths against angles in searches
};

/// E^-1 = L L^T from E = M M^T (Cholesky), L = M^-T. For an enclosing scalar, positive diagonal enclosures prove that E
/// is positive definite. @throws InputError where a pivot is not positive.
template <class S>
[[nodiscard]] Matrix6<S> ellipsoid_root(const Matrix6<S>& ellipsoid, bool is_diagonal = false);

template <class S>
[[nodiscard]] Model<S> make_model_without_ellipsoid(const Problem& problem);
/// Sets `has_ellipsoid`, `ellipsoid`, `ellipsoid_is_diagonal` and `ellipsoid_root`. @throws InputError as
/// ellipsoid_root.
template <class S>
void set_ellipsoid(const LoadText& load, Model<S>& model);
/// Both.
template <class S>
[[nodiscard]] Model<S> make_model(const Problem& problem);

/// The tape of the six pose expressions px, py, pz and angles over the problem's parameters.
[[nodiscard]] ExpressionTape pose_tape(const Problem& problem);
/// The tape of the space's constraints.
[[nodiscard]] ExpressionTape constraint_tape(const Problem& problem);

template <class S>
[[nodiscard]] Pose<S> evaluate_pose(const Evaluator<S>& pose, std::span<const S> parameters) {
  std::array<S, 6> values;
  pose.evaluate(parameters, values);
  return {Vector3<S>(values[0], values[1], values[2]), {values[3], values[4], values[5]}};
}

}  // namespace taut

#include "kinematics/model_impl.h"
