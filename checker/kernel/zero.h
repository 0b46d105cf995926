// SPDX-License-Identifier: GPL-3.0-or-later
// A motion that equations imply: where the zero y(u) of g(y, u) = 0 is, for every u in [-1, 1], and that it is the only
// one.
//
// Let Y be a box of k unknowns and G enclose the partial derivatives of g by y on all of Y and for all u. By the mean
// value theorem g(y, u) - g(z, u) = G' (y - z) for some G' in G. Take any matrix A and M = I - A G.
//
//   at most one   If ||M|| < 1 (row sums), then A G' = I - M' is non-singular; so two zeros in Y are equal.    (1)
//   exactly one   Let c(u) be any curve, w >= 0, and Z(u) the box |y_i - c_i(u)| <= w_i, within Y. For each u and each
//                 y in Z(u), y - A g(y, u) is in
//                     K(u) = c(u) - A g(c(u), u) + M [-w, w],                                                  (2)
//                 so where K(u) is within Z(u) this map has a fixed point there (Brouwer), a zero of g as A is
//                 non-singular, and by (1) the only one in Y.
//   where         That zero is in K(u); and again, whenever it is known to be within w' of a curve c', in the K of
//                 these, with G over the range of that box. So its enclosure is narrowed.                      (3)
//
// As G' is non-singular and g continuously differentiable, y(u) is continuous (implicit function theorem).
#pragma once

#include "checker/kernel/linear.h"
#include "checker/kernel/statement.h"

namespace taut::checker {

/// g = 0 in k <= 6 unknowns. Vectors and matrices of six are used; beyond k stand those of the equations y_i = 0.
class Equations {
 public:
  Equations() = default;
  Equations(const Equations&) = delete;
  Equations& operator=(const Equations&) = delete;
  virtual ~Equations() = default;
  [[nodiscard]] virtual std::size_t unknowns() const = 0;
  /// g(y(u), u), of a curve y.
  [[nodiscard]] virtual Vector6<MeanValueForm> residual(const Vector6<MeanValueForm>& y) const = 0;
  /// G on all of Y, for all u: that it exists proves g continuously differentiable there.
  [[nodiscard]] virtual Matrix6<Ball> jacobian(const Vector6<Ball>& Y) const = 0;
};

/// A, close to the inverse of G in its middle, and M for the box Y. @throws Undefined unless ||M|| < 1.
struct Contraction {
  Contraction(const Equations& equations, const Vector6<Ball>& Y);
  explicit Contraction(const Matrix6<Ball>& G);
  /// G'^-1 b for every G' in G. Of x with G' x = b, (I - M') x = A b with |M'| <= M: so |x| <= |A b| + M |x|, first in
  /// the largest component, and then in each.
  [[nodiscard]] Vector6<Ball> divide(const Vector6<Ball>& b) const;
  Matrix6<Ball> A;
  Matrix6<Ball> M;  ///< magnitudes
};

/// The only zero with |y_i| <= tube, for every u; `near` states c, w and how often (3) is applied. @throws Undefined
/// unless there is exactly one.
[[nodiscard]] Vector6<MeanValueForm> only_zero(const Equations& equations, const Ball& tube, const NearZero& near);

/// (3), so many times, of a zero that is in `known` for every u. @throws Undefined where ||M|| < 1 is not shown
[[nodiscard]] Vector6<MeanValueForm> narrowed(const Equations& equations, Vector6<MeanValueForm> known, int narrowings);

}  // namespace taut::checker
