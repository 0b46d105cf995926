// The equations, and how the claim is proved for all poses of one box of the path at once.
//
// A box is a part [s0, s1] of one segment, written s = m + r u with u in [-1, 1]; every quantity below is a Form
// in u (form.h). What is proved holds for every u.
//
//   pose       p and R, from motion.h or, where the machine is held by its cables' lengths, from held.h
//   geometry   d_i = p + R b_i - a_i,   lengths |d_i|,   arms r_i = R (b_i - p_m) from the load point P_m
//   statics    cable i pulls along u_i = d_i / |d_i| with force f_i. With the force density x_i = f_i / |d_i|,
//              J f = w reads D x = w; column i of D is (d_i ; r_i x d_i), and J = D diag(1 / |d_i|). So, lengths
//              being positive, J is non-singular exactly where D is, and row i of J^-1 is |d_i| y_i with y_i
//              row i of Y = D^-1.
//   extremes   over K = { w0 + e : e' E e <= 1 }, f_i = |d_i| y_i (w0 + e) fills [f0_i - v_i, f0_i + v_i] with
//                f0_i = |d_i| y_i w0,    v_i = |d_i| sqrt(y_i E^-1 y_i').
//              With E = M M' (Cholesky) the root is the norm of M^-1 y_i'. A Cholesky factorisation that
//              succeeds in intervals also proves that E is positive definite.
//
// D^-1 on a whole box.  Let C be any fixed matrix and A(u) = C D(u) - I. If ||A(u)|| <= rho < 1 (row sums) for every
// u, then C D(u) = I + A(u) is non-singular, hence so is D(u), and
//     Y(u) = (I + A)^-1 C = C + B C   with ||B|| <= rho / (1 - rho)                  (1)
//     Y(u) = C - A Y(u)               from (I + A) Y = C                             (2)
//     Y'(u) = -Y D' Y                 from D Y = I                                   (3)
// (1) encloses Y roughly, (2) better, and (3) makes it a Form, whose mid comes from Gauss-Jordan elimination of D(0).
#pragma once

#include <array>

#include "checker/certificate.h"
#include "checker/form.h"
#include "checker/linear.h"
#include "checker/motion.h"

namespace taut::checker {

/// Of all six cables, for every pose of the box.
struct Geometry {
  std::array<Vector3<Form>, 6> d;    ///< d_i [m]
  std::array<Vector3<Form>, 6> arm;  ///< r_i [m]
  Vector6<Form> length;              ///< |d_i| [m]; certainly positive
  Matrix6<Form> D;
};

/// D^-1 on the box; that it exists proves D non-singular there.
struct Inverse {
  Matrix6<Interval> C;
  Matrix6<Interval> A;  ///< C D(u) - I for every u
  Matrix6<Form> Y;
};

/// (1) and (2): Y for every matrix in A. @throws Undefined unless all of them have ||A|| < 1.
[[nodiscard]] Matrix6<Interval> inverses(const Matrix6<Interval>& C, const Matrix6<Interval>& A);

[[nodiscard]] Inverse inverse(const Matrix6<Form>& D);

/// For every pose of the box.
struct Tensions {
  Vector6<Form> centre;  ///< f0_i [N]
  Vector6<Form> spread;  ///< v_i [N]
};

/// Bounds of how far a machine may deviate from what the problem says of it: its Tolerances at one precision.
struct Deviation {
  Vector6<Interval> base;      ///< |a_i' - a_i| <= [m]
  Vector6<Interval> platform;  ///< |b_i' - b_i| <= [m]
  Vector6<Interval> length;    ///< of the lengths by which it is held, if it is [m]
  Interval load_point;         ///< |p_m' - p_m| <= [m]
  Vector6<Interval> wrench;    ///< w0' - w0 = t wrench, |t| <= 1 [N, N m]
  Interval position;           ///< tracking: |p' - p| <= [m]
  Interval angle;              ///< tracking: of the rotation from R to R' [rad]
};

/// Enclosures of one problem's numbers at one precision.
class Model {
 public:
  /// @throws Undefined where E can't be shown to be positive definite at this precision.
  Model(const Problem& problem, int bits);

  [[nodiscard]] int bits() const { return bits_; }
  [[nodiscard]] Interval tension_limit(std::size_t cable, bool upper) const { return tension_[cable][upper ? 1 : 0]; }
  [[nodiscard]] Interval length_limit(std::size_t cable, bool upper) const { return length_[cable][upper ? 1 : 0]; }

  [[nodiscard]] const std::array<Vector3<Interval>, 6>& base_anchors() const { return base_; }
  [[nodiscard]] const std::array<Vector3<Interval>, 6>& platform_anchors() const { return platform_; }

  [[nodiscard]] const std::array<Vector3<Interval>, 6>& arms() const { return arm_; }
  [[nodiscard]] const Vector3<Interval>& load_point() const { return load_point_; }
  [[nodiscard]] const Vector6<Interval>& wrench() const { return wrench_; }
  /// M^-1, lower triangular: the wrenches of K are w0 + M^-T z, |z| <= 1.
  [[nodiscard]] const Matrix6<Interval>& ellipsoid_factor() const { return M_inverse_; }
  /// Null where there are no tolerances.
  [[nodiscard]] const Deviation* deviation() const { return deviation_ ? &*deviation_ : nullptr; }

  /// The mean of |b_i| [m].
  [[nodiscard]] Interval platform_size() const;
  /// This machine with its anchors moved towards the other's, by a part of the way.
  [[nodiscard]] Model towards(const Model& other, const Interval& part) const;

  // At the working precision, which should be bits(). Each throws Undefined where the box has to be split.
  [[nodiscard]] Geometry geometry(const Frame& pose) const;
  [[nodiscard]] Tensions tensions(const Geometry& geometry) const { return tensions(geometry, inverse(geometry.D).Y); }
  [[nodiscard]] Tensions tensions(const Geometry& geometry, const Matrix6<Form>& Y) const;

 private:
  int bits_;
  std::array<Vector3<Interval>, 6> base_;      ///< a_i
  std::array<Vector3<Interval>, 6> platform_;  ///< b_i
  std::array<Vector3<Interval>, 6> arm_;       ///< b_i - p_m
  std::array<std::array<Interval, 2>, 6> tension_;
  std::array<std::array<Interval, 2>, 6> length_;
  Vector6<Interval> wrench_;
  Vector3<Interval> load_point_;  ///< p_m
  Matrix6<Interval> M_inverse_;
  std::optional<Deviation> deviation_;
};

/// D at the centre of the box.
[[nodiscard]] Matrix6<Interval> mid(const Matrix6<Form>& D);

}  // namespace taut::checker
