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

#include "certify/checker/certificate.h"
#include "certify/checker/form.h"
#include "certify/checker/linear.h"
#include "certify/checker/motion.h"

namespace taut::checker {

/// Of all six cables, for every pose of the box.
struct Geometry {
  Vector6<Form> length;  ///< |d_i| [m]; certainly positive
  Matrix6<Form> D;
};

/// For every pose of the box; that it exists proves J non-singular there.
struct Tensions {
  Vector6<Form> centre;  ///< f0_i [N]
  Vector6<Form> spread;  ///< v_i [N]
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

  /// The mean of |b_i| [m].
  [[nodiscard]] Interval platform_size() const;

  // At the working precision, which should be bits(). Each throws Undefined where the box has to be split.
  [[nodiscard]] Geometry geometry(const Frame& pose) const;
  [[nodiscard]] Tensions tensions(const Geometry& geometry) const;

 private:
  int bits_;
  std::array<Vector3<Interval>, 6> base_;      ///< a_i
  std::array<Vector3<Interval>, 6> platform_;  ///< b_i
  std::array<Vector3<Interval>, 6> arm_;       ///< b_i - p_m
  std::array<std::array<Interval, 2>, 6> tension_;
  std::array<std::array<Interval, 2>, 6> length_;
  Vector6<Interval> wrench_;
  Matrix6<Interval> M_inverse_;  ///< lower triangular
};

/// D at the centre of the box.
[[nodiscard]] Matrix6<Interval> mid(const Matrix6<Form>& D);

}  // namespace taut::checker
