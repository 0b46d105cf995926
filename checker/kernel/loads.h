// SPDX-License-Identifier: GPL-3.0-or-later
// The items that K is the sum of: how far the force densities that they cause may be from nominal ones.
//
// An item is a compact convex set S of wrenches (F ; M) about a point c of the platform, r = R (c - p_m), in axes of W
// or of P. About the load point (F ; M) is (F ; r x F + M); so a row y = (y_F, y_M) of D^-1 sees it as
//     y . w = g . F + m . M,    g = y_F + y_M x r,   m = y_M        (g and m in the item's axes: turned back by R'
//     for P).
// Each item has a nominal wrench. With the largest of all y . w, max_S = g . F + m . M over S, and those of a sum of
// sets being added,
//     above(y) = max_S (y . w) - y . w_nominal,    below(y) = y . w_nominal - min_S (y . w) = above(-y).
//
//   item                                         nominal      above(y)
//   weight: mass in M -+ mu, gravity gamma, its  M gamma at c M B + mu |A + B|,  A = g . gamma,  B = rho |gamma x m|
//     centre of gravity within rho of c
//   forces in a ball of radius f                 0            f |g|
//   forces in a disc at right angles to n        0            f |g - (g . n) n / |n|^2|
//   forces f e / |e|, f in [f-, f+]              f_n e / |e|  the larger of (f - f_n) g . e / |e| for f = f-, f+
//   moments                                      likewise     the same with m for g
//   load cases w_1 ... w_k                       their mean   max_j (g . F + m . M) of w_j - mean
//
// f_n is 0 if 0 is in [f-, f+], else the middle. A weight m gamma at c + e, |e| <= rho, is the wrench
// (m gamma ; e x m gamma): m (A + e . (gamma x m)), which is at most m (A + B), linear in m. Below the table's A is
// -A, so that mu |A - B| is there.
//
// Rotation.  Where the platform turns at the rate W (axes of W), r moves at W x r, and F and M turn if they are fixed
// in P, e does not: y . w changes at the rate W . T, with F and M in axes of W now,
//     T = r x (F x m)                               for axes of W,  as m . ((W x r) x F) = W . (r x (F x m)),
//     T = F x y_F + (r x F + M) x y_M               for axes of P.
#pragma once

#include <optional>
#include <variant>
#include <vector>

#include "checker/kernel/linear.h"
#include "checker/kernel/statement.h"

namespace taut::checker {

/// A force [N] and a moment [N m].
struct Wrench {
  Vector3<Ball> force;
  Vector3<Ball> moment;
};

/// (g, m) above.
template <class T>
struct Lever {
  Vector3<T> g;
  Vector3<T> m;
};
template <class T>
Lever<T> operator-(const Lever<T>& y) {
  return {-y.g, -y.m};
}
/// y . w
template <class T>
T of(const Lever<T>& y, const Wrench& w) {
  return dot(y.g, w.force) + dot(y.m, w.moment);
}

/// One item at one precision.
class Load {
 public:
  Load(const LoadItem& item, const ExactVector& load_point, const ExactVector& gravity);

  [[nodiscard]] const Wrench& nominal() const { return nominal_; }  ///< about c, in the item's axes
  /// r = R (c - p_m).
  template <class T>
  [[nodiscard]] Vector3<T> arm(const Matrix3<T>& R) const {
    return multiply(R, from_load_point_);
  }
  /// What the item sees of a row of D^-1.
  template <class T>
  [[nodiscard]] Lever<T> lever(const Matrix3<T>& R, const Vector6<T>& y) const {
    const Vector3<T> m = {y[3], y[4], y[5]};
    const Vector3<T> g = Vector3<T>{y[0], y[1], y[2]} + cross(m, arm(R));
    if (!turns_) return {g, m};
    return {multiply(transposed(R), g), multiply(transposed(R), m)};
  }
  /// w_nominal about the load point, in axes of W.
  [[nodiscard]] Vector6<MeanValueForm> nominal_about_load_point(const Matrix3<MeanValueForm>& R) const;
  [[nodiscard]] MeanValueForm above(const Lever<MeanValueForm>& y) const;
  /// Wrenches about c, in the item's axes.
  struct Extremes {
    std::vector<Wrench> least, most;
  };
  /// For each y in the balls one of the first attains min_S, and one of the others max_S.
  [[nodiscard]] Extremes extremes(const Lever<Ball>& y) const;
  /// T for the row of which `y` is. @param R  of the pose
  [[nodiscard]] Vector3<Ball> turning(const Matrix3<Ball>& R, const Vector6<Ball>& y, const Wrench& w) const;

 private:
  struct Mass {
    Ball least, most, mean, half_range;  ///< M - mu, M + mu, M, mu
    Vector3<Ball> gravity;
    Ball offset;  ///< rho
  };
  /// f P v for all |v| <= 1; P is the projection along n of a disc, I of a ball.
  struct Round {
    Ball radius;
    Matrix3<Ball> projection;
    bool is_moment;
  };
  /// Load cases; and f- e / |e| and f+ e / |e| of a line segment.
  struct Corners {
    std::vector<Wrench> from_nominal;
  };
  void set(const Weight& weight, const ExactVector& gravity);
  void set(const BallOrDisc& x);
  void set(const LineSegment& x);
  void set(const LoadCases& cases);

  bool turns_;  ///< axes of P
  Vector3<Ball> from_load_point_;
  Wrench nominal_;
  std::variant<Mass, Round, Corners> set_;
};

/// The problem whose items are these loads alone. @pre each choice is of its item's kind, and there is one for each
/// @throws Rejected unless each of them is in its item, exactly.
[[nodiscard]] Problem acting(Problem problem, const std::vector<LoadChoice>& loads);

}  // namespace taut::checker
