// SPDX-License-Identifier: GPL-3.0-or-later
// A real function of n variables u_k in [-1, 1], enclosed to first order; and numbers with their partial derivatives.
//
// A FirstOrderForm says of a function f, continuous on [-1, 1]^n:
//     for every u there are x in `at` and y_k in `slope[k]` with f(u) = x + sum_k y_k u_k.
// So what is known of f beyond first order, of the size of the square of what f varies by, widens `at`. Each operation
// keeps the statement:
//     f + g   by adding both;
//     f g     (x + sum y_k u_k)(v + sum w_k u_k) = x v + sum (x w_k + y_k v) u_k + sum y_k w_k u_k^2
//             + sum_{k<l} (y_k w_l + y_l w_k) u_k u_l, with u_k^2 in [0, 1] and u_k u_l in [-1, 1];
//     f^2     x^2 + 2 x sum y_k u_k + h^2, h = sum y_k u_k;
//     F(f)    F(c + h) = F(c) + F'(c) h + F''(xi) h^2 / 2 with c the middle of `at`, h = (x - c) + sum y_k u_k, by
//             Taylor's theorem, for F twice differentiable on the range of f.
//     max_j f_j   lies between (max_j x_j) + y_j u for the least and the greatest y_j u.
// An operation throws Undefined unless its result is defined, and F differentiable, on the whole range. So the
// existence of a form also proves that its function is continuous. Where the slopes are exactly 0, f is known as a
// constant (in `at`); its F(f) is one too, and F need not be differentiable.
//
// A Jet holds, for every point of a box of variables, the value of a function and its partial derivatives.
#pragma once

#include <algorithm>
#include <array>
#include <span>

#include "checker/kernel/ball.h"

namespace taut::checker {

template <std::size_t kVariables>
struct FirstOrderForm {
  Ball at;
  std::array<Ball, kVariables> slope;

  FirstOrderForm() = default;  ///< the constant 0
  explicit FirstOrderForm(Ball constant) : at(std::move(constant)) {}
  FirstOrderForm(Ball at_zero, Ball by_u) requires(kVariables == 1) : at(std::move(at_zero)), slope{std::move(by_u)} {}

  [[nodiscard]] bool is_constant() const { return std::ranges::all_of(slope, &Ball::is_zero); }
  /// The most by which the slopes move f.
  [[nodiscard]] Ball reach() const {
    Ball sum = magnitude(slope[0]);
    for (std::size_t k = 1; k < kVariables; ++k) sum += magnitude(slope[k]);
    return sum;
  }
  /// f(u) for every u.
  [[nodiscard]] Ball range() const { return is_constant() ? at : plus_minus(at, reach()); }

  FirstOrderForm& operator+=(const FirstOrderForm& b) {
    at += b.at;
    for (std::size_t k = 0; k < kVariables; ++k) slope[k] += b.slope[k];
    return *this;
  }
  FirstOrderForm& operator-=(const FirstOrderForm& b) {
    at -= b.at;
    for (std::size_t k = 0; k < kVariables; ++k) slope[k] -= b.slope[k];
    return *this;
  }
  friend FirstOrderForm operator+(FirstOrderForm a, const FirstOrderForm& b) { return std::move(a += b); }
  friend FirstOrderForm operator-(FirstOrderForm a, const FirstOrderForm& b) { return std::move(a -= b); }
  friend FirstOrderForm operator-(FirstOrderForm a) {
    a.at = -a.at;
    for (Ball& y : a.slope) y = -y;
    return a;
  }
  friend FirstOrderForm operator*(const Ball& a, const FirstOrderForm& b) { return {a * b.at, a, b}; }
  friend FirstOrderForm operator*(const FirstOrderForm& a, const Ball& b) { return b * a; }
  friend FirstOrderForm operator*(const FirstOrderForm& a, const FirstOrderForm& b) {
    if (a.is_constant()) return a.at * b;
    if (b.is_constant()) return b.at * a;
    FirstOrderForm result = a.at * b;
    for (std::size_t k = 0; k < kVariables; ++k) {
      result.slope[k].add_product(a.slope[k], b.at);
      result.at += from_zero_to(a.slope[k] * b.slope[k]);
      for (std::size_t l = 0; l < k; ++l) {
        const Ball crossed = (a.slope[k] * b.slope[l]).add_product(a.slope[l], b.slope[k]);
        result.at = plus_minus(result.at, crossed);
      }
    }
    return result;
  }
  friend FirstOrderForm sqr(const FirstOrderForm& f) {
    if (f.is_constant()) return FirstOrderForm(sqr(f.at));
    return {sqr(f.at) + from_zero_to(sqr(f.reach())), Ball(2) * f.at, f};
  }
  friend FirstOrderForm apply(Function F, const FirstOrderForm& f) {
    if (f.is_constant()) return FirstOrderForm(value(F, f.at));
    const Ball centre = middle(f.at);
    return f.taylor(value(F, centre), first_derivative(F, centre), second_derivative(F, f.range()));
  }
  friend FirstOrderForm power(const FirstOrderForm& f, int n) {
    if (n == 0) return FirstOrderForm(Ball(1));
    if (n == 1) return f;
    if (f.is_constant()) return FirstOrderForm(power(f.at, n));
    const Ball centre = middle(f.at);
    return f.taylor(power(centre, n), Ball(n) * power(centre, n - 1), Ball(n) * Ball(n - 1) * power(f.range(), n - 2));
  }
  friend Ball range(const FirstOrderForm& f) { return f.range(); }

 private:
  /// x + b sum_k y_k u_k with the slopes of `f`.
  FirstOrderForm(Ball x, const Ball& b, const FirstOrderForm& f) : at(std::move(x)) {
    for (std::size_t k = 0; k < kVariables; ++k) {
      if (!f.slope[k].is_zero()) slope[k] = b * f.slope[k];
    }
  }
  /// F(f) from F and F' at the middle of `at` and F'' on the range.
  [[nodiscard]] FirstOrderForm taylor(const Ball& value, const Ball& first, const Ball& second) const {
    const Ball off = at - middle(at);
    const Ball h = magnitude(plus_minus(off, reach()));
    return {value + first * off + second * from_zero_to(half(sqr(h))), first, *this};
  }
};

using MeanValueForm = FirstOrderForm<1>;  ///< over a box of the path
inline constexpr std::size_t kCellAxes = 3;
using CellForm = FirstOrderForm<kCellAxes>;  ///< over a cell of a map

/// The largest of one or more functions, which may be another one at another u. Those that never are the largest are
/// left out.
inline MeanValueForm maximum(std::span<const MeanValueForm> forms) {
  Ball least = lowest(forms.front().range());
  for (const MeanValueForm& f : forms) least = larger(least, lowest(f.range()));
  const MeanValueForm* first = nullptr;
  MeanValueForm result;
  for (const MeanValueForm& f : forms) {
    if (certainly_negative(f.range() - least)) continue;
    if (first == nullptr) {
      first = &f;
      result = f;
      continue;
    }
    result.at = hull(larger(lowest(result.at), lowest(f.at)), larger(highest(result.at), highest(f.at)));
    result.slope[0] = hull(result.slope[0], f.slope[0]);
  }
  return result;
}
inline MeanValueForm absolute(const MeanValueForm& f) { return maximum(std::array{f, -f}); }

struct Jet {
  static constexpr std::size_t kVariables = 6;
  Ball value;
  std::array<Ball, kVariables> by;

  Jet() = default;
  explicit Jet(Ball constant) : value(std::move(constant)) {}
  /// F(a, b), where F is x by a and y by b.
  Jet(Ball F, const Jet& a, const Ball& x, const Jet& b, const Ball& y) : value(std::move(F)) {
    for (std::size_t i = 0; i < kVariables; ++i) {
      if (!a.by[i].is_zero()) by[i].add_product(a.by[i], x);
      if (!b.by[i].is_zero()) by[i].add_product(b.by[i], y);
    }
  }
  [[nodiscard]] bool is_constant() const { return std::ranges::all_of(by, &Ball::is_zero); }
};

inline Jet operator+(const Jet& a, const Jet& b) { return {a.value + b.value, a, Ball(1), b, Ball(1)}; }
inline Jet operator-(const Jet& a, const Jet& b) { return {a.value - b.value, a, Ball(1), b, Ball(-1)}; }
inline Jet operator-(const Jet& a) { return Jet() - a; }
inline Jet operator*(const Jet& a, const Jet& b) { return {a.value * b.value, a, b.value, b, a.value}; }
inline Jet apply(Function F, const Jet& a) {
  if (a.is_constant()) return Jet(value(F, a.value));
  return {value(F, a.value), a, first_derivative(F, a.value), Jet(), Ball()};
}
inline Jet power(const Jet& a, int n) {
  if (n == 0 || a.is_constant()) return Jet(power(a.value, n));
  return {power(a.value, n), a, Ball(n) * power(a.value, n - 1), Jet(), Ball()};
}

inline Ball range(const Jet& f) { return f.value; }

template <class T>
concept Differentiable = std::same_as<T, MeanValueForm> || std::same_as<T, CellForm> || std::same_as<T, Jet>;
template <Differentiable T>
T operator/(const T& a, const T& b) {
  return a * apply(Function::kInverse, b);
}
/// The angle of (x, y) in (-pi, pi]. @throws Undefined where (x, y) may be the origin or cross the cut y = 0, x < 0.
template <class T>
T atan2(const T& y, const T& x) {
  const Ball over = range(x);
  const Ball up = range(y);
  if (certainly_positive(over)) return apply(Function::kAtan, y / x);
  const T right_angle(Ball::pi() / Ball(2));
  if (certainly_positive(up)) return right_angle - apply(Function::kAtan, x / y);
  if (certainly_negative(up)) return -right_angle - apply(Function::kAtan, x / y);
  if (up.is_zero() && certainly_negative(over)) return T(Ball::pi());
  throw Undefined("atan2 at what may be the origin or its cut");
}

}  // namespace taut::checker
