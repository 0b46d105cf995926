// A motion that equations imply: where the zero y(u) of g(y, u) = 0 is, for every u in [-1, 1], and that there is only one.
//
// Let Y be a box of k unknowns, c its middle, and let G and h enclose the partial derivatives of g by y and by u, on all
// of Y and for all u. Between (c, 0) and (y, u) the mean value theorem says
//     g(y, u) = g(c, 0) + h' u + G' (y - c)   for some h' in h and G' in G.                                          (1)
// Take any matrix A, M = I - A G, ||M|| <= rho < 1 (row sums), and
//     K = c - A g(c, 0) - A h [-1, 1] + M (Y - c).
// For each u, y -> y - A g(y, u) maps Y into K by (1), and shrinks distances (largest component) by rho. Since
// A G' = I - M' is non-singular, so is A, and the fixed points of this map are the zeros of g. So Y has
//     at most one zero,   and exactly one where K is within Y.                                                       (2)
// The first half is shown of the whole tube |y_i| <= t, the second of a small box in it. Whatever Y and A are,
//     a zero in Y is in K too,                                                                                       (3)
// by which Y is narrowed about y(u). By (1) between two zeros, y is continuous in u, hence differentiable by the
// implicit function theorem, with G' y' = -h', that is y' = -A h' + M' y':
//     |y'_i| <= max_k |(A h)_k| / (1 - rho),   and y' in -A h + M y'.                                                (4)
#pragma once

#include "certify/checker/linear.h"

namespace taut::checker {

/// g = 0, in k <= 6 unknowns. Vectors and matrices of six are used; what is beyond k is that
/// of the equations y_i = 0.
class Equations {
 public:
  struct Derivatives {
    Matrix6<Interval> by_y;
    Vector6<Interval> by_u;
  };
  Equations() = default;
  Equations(const Equations&) = delete;
  Equations& operator=(const Equations&) = delete;
  virtual ~Equations() = default;
  [[nodiscard]] virtual std::size_t unknowns() const = 0;
  /// On all of Y and for all u; that they exist proves g continuously differentiable there.
  [[nodiscard]] virtual Derivatives derivatives(const Vector6<Interval>& Y) const = 0;
  /// g(y, 0).
  [[nodiscard]] virtual Vector6<Interval> at_middle(const Vector6<Interval>& y) const = 0;
};

/// What is known of y(u) for every u.
struct Zero {
  Vector6<Interval> y;
  Vector6<Interval> slope;  ///< y'
};

/// From an approximation of y at u = 0. @throws Undefined unless there is exactly one zero with |y_i| <= tube, for every u.
[[nodiscard]] Zero only_zero(const Equations& equations, const Interval& tube, const Vector6<Interval>& near);

/// About where y(0) is, by Newton's method; nothing is proved.
[[nodiscard]] Vector6<Interval> approximate_zero(const Equations& equations);

}  // namespace taut::checker
