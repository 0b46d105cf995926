// SPDX-License-Identifier: GPL-3.0-or-later
// A real function of up to three variables u_k in [-1, 1], enclosed to first order: mean_value_form.h's idea over a
// cell in place of a box.
//
// A CellForm says of a function f, continuous on [-1, 1]^3:
//     for every u there are x in `at` and y_k in `slope[k]` with f(u) = x + sum_k y_k u_k.
// Each operation keeps the statement:
//     f + g   by adding both;
//     f g     (x + sum y_k u_k)(v + sum w_k u_k) = x v + sum (x w_k + y_k v) u_k + sum y_k w_k u_k^2
//             + sum_{k<l} (y_k w_l + y_l w_k) u_k u_l, with u_k^2 in [0, 1] and u_k u_l in [-1, 1];
//     F(f)    by Taylor's theorem, as there, with h = (x - c) + sum y_k u_k.
// An operation throws Undefined unless its result is defined, and F differentiable, on the whole range. So the
// existence of a CellForm also proves that its function is continuous.
#pragma once

#include "checker/kernel/mean_value_form.h"

namespace taut::checker {

inline constexpr std::size_t kCellAxes = 3;

struct CellForm {
  Ball at;
  std::array<Ball, kCellAxes> slope;

  CellForm() = default;  ///< the constant 0
  explicit CellForm(Ball constant) : at(std::move(constant)) {}

  [[nodiscard]] bool is_constant() const { return std::ranges::all_of(slope, &Ball::is_zero); }
  /// The most by which the slopes move f.
  [[nodiscard]] Ball reach() const {
    Ball sum;
    for (const Ball& y : slope) {
      if (!y.is_zero()) sum += magnitude(y);
    }
    return sum;
  }
  /// f(u) for every u.
  [[nodiscard]] Ball range() const { return is_constant() ? at : plus_minus(at, reach()); }
  CellForm& operator+=(const CellForm& b) {
    at += b.at;
    for (std::size_t k = 0; k < kCellAxes; ++k) slope[k] += b.slope[k];
    return *this;
  }
  CellForm& operator-=(const CellForm& b) {
    at -= b.at;
    for (std::size_t k = 0; k < kCellAxes; ++k) slope[k] -= b.slope[k];
    return *this;
  }
};

inline Ball range(const CellForm& f) { return f.range(); }

inline CellForm operator*(const Ball& a, const CellForm& b) {
  CellForm result(a * b.at);
  for (std::size_t k = 0; k < kCellAxes; ++k) {
    if (!b.slope[k].is_zero()) result.slope[k] = a * b.slope[k];
  }
  return result;
}
inline CellForm operator*(const CellForm& a, const Ball& b) { return b * a; }
inline CellForm operator+(CellForm a, const CellForm& b) { return a += b; }
inline CellForm operator-(CellForm a, const CellForm& b) { return a -= b; }
inline CellForm operator-(const CellForm& a) { return CellForm() - a; }

inline CellForm operator*(const CellForm& a, const CellForm& b) {
  if (a.is_constant()) return a.at * b;
  if (b.is_constant()) return b.at * a;
  CellForm result(a.at * b.at);
  Ball crossed;
  for (std::size_t k = 0; k < kCellAxes; ++k) {
    result.slope[k].add_product(a.at, b.slope[k]).add_product(a.slope[k], b.at);
    result.at += from_zero_to(a.slope[k] * b.slope[k]);
    for (std::size_t l = 0; l < k; ++l) {
      crossed += magnitude((a.slope[k] * b.slope[l]).add_product(a.slope[l], b.slope[k]));
    }
  }
  result.at = plus_minus(result.at, crossed);
  return result;
}

/// F(f) from F and F' at the middle of `at` and F'' on the range.
inline CellForm taylor(const CellForm& f, const Ball& value, const Ball& first, const Ball& second) {
  const Ball off = f.at - middle(f.at);
  const Ball largest = magnitude(plus_minus(off, f.reach()));
  CellForm result(value + first * off + second * from_zero_to(half(sqr(largest))));
  for (std::size_t k = 0; k < kCellAxes; ++k) result.slope[k] = first * f.slope[k];
  return result;
}
inline CellForm apply(Function F, const CellForm& f) {
  if (f.is_constant()) return CellForm(value(F, f.at));
  const Ball centre = middle(f.at);
  return taylor(f, value(F, centre), first_derivative(F, centre), second_derivative(F, f.range()));
}
inline CellForm power(const CellForm& f, int n) {
  if (n == 0) return CellForm(Ball(1));
  if (n == 1) return f;
  if (f.is_constant()) return CellForm(power(f.at, n));
  const Ball centre = middle(f.at);
  return taylor(f, power(centre, n), Ball(n) * power(centre, n - 1), Ball(n) * Ball(n - 1) * power(f.range(), n - 2));
}
inline CellForm sqr(const CellForm& f) { return power(f, 2); }
inline CellForm operator/(const CellForm& a, const CellForm& b) { return a * apply(Function::kInverse, b); }

}  // namespace taut::checker
