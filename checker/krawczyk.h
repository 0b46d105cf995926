// A motion that equations imply: where the zero y(u) of g(y, u) = 0 is, for every u in [-1, 1], and that there is only one.
//
// Let Y be a box of k unknowns, c its middle; let G enclose the partial derivatives of g by y on all of Y and for all u, and
// let h and j be such that for y in Y and all u
//     dg/du = h' + u j',   g(y, u) = g(y, 0) + u h' + u^2/2 j'   for some h' in h, j' in j (not the same in both):     (0)
// by Taylor's theorem h encloses dg/du at u = 0 and j the second derivative for all u; or h encloses dg/du for all u, and
// j is 0. With the mean value theorem from (c, 0) to (y, 0),
//     g(y, u) = g(c, 0) + u h' + u^2/2 j' + G' (y - c)   for some h' in h, j' in j and G' in G.                      (1)
// Take any matrix A, M = I - A G, ||M|| <= rho < 1 (row sums), and
//     K = c - A g(c, 0) - A h [-1, 1] - A j [0, 1/2] + M (Y - c).
// For each u, y -> y - A g(y, u) maps Y into K by (1), and shrinks distances (largest component) by rho. Since
// A G' = I - M' is non-singular, so is A, and the fixed points of this map are the zeros of g. So Y has
//     at most one zero,   and exactly one where K is within Y.                                                       (2)
// The first half is shown of the whole tube |y_i| <= t, the second of a small box in it. Whatever Y and A are,
//     a zero in Y is in K too,                                                                                       (3)
// by which Y is narrowed about y(u). As G' is non-singular, the implicit function theorem makes y differentiable in u (it is
// the only zero, and stays in K), with G' y' = -dg/du. With D = A h + A j [-1, 1] that is y' = -D' + M' y':
//     |y'_i| <= max_k |D_k| / (1 - rho),   and y' in -D + M y'.                                                      (4)
#pragma once

#include "checker/linear.h"

namespace taut::checker {

/// g = 0, in k <= 6 unknowns. Vectors and matrices of six are used; what is beyond k is that
/// of the equations y_i = 0.
class Equations {
 public:
  struct Derivatives {
    Matrix6<Interval> by_y;   ///< G
    Vector6<Interval> by_u;   ///< h
    Vector6<Interval> by_uu;  ///< j
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
