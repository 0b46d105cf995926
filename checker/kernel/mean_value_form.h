// SPDX-License-Identifier: GPL-3.0-or-later
// A real function of one variable u in [-1, 1], enclosed to first order; and numbers with their partial derivatives.
//
// A MeanValueForm says of a function f, continuous on [-1, 1]:
//     for every u there are x in `at` and y in `slope` with f(u) = x + y u.
// So what is known of f beyond first order, of the size of the square of what f varies by, widens `at`. Each operation
// keeps the statement:
//     f + g   by adding both;
//     f g     (x + y u)(v + w u) = x v + (x w + y v) u + y w u^2, and u^2 is in [0, 1];
//     F(f)    F(c + h) = F(c) + F'(c) h + F''(xi) h^2 / 2 with c the middle of `at`, h = (x - c) + y u, by Taylor's
//             theorem, for F twice differentiable on the range of f.
//     max_j f_j   lies between (max_j x_j) + y_j u for the least and the greatest y_j u.
// An operation throws Undefined unless its result is defined, and F differentiable, on the whole range. So the
// existence of a MeanValueForm also proves that its function is continuous. Where `slope` is exactly 0, f is known as a
// constant (in `at`); its F(f) is one too, and F need not be differentiable.
//
// A Jet holds, for every point of a box of variables, the value of a function and its partial derivatives.
#pragma once

#include <algorithm>
#include <array>
#include <span>

#include "checker/kernel/ball.h"

namespace taut::checker {

struct MeanValueForm {
  Ball at;
  Ball slope;

  MeanValueForm() = default;  ///< the constant 0
  explicit MeanValueForm(Ball constant) : at(std::move(constant)) {}
  MeanValueForm(Ball at_zero, Ball by_u) : at(std::move(at_zero)), slope(std::move(by_u)) {}

  [[nodiscard]] bool is_constant() const { return slope.is_zero(); }
  /// f(u) for every u.
  [[nodiscard]] Ball range() const { return is_constant() ? at : plus_minus(at, magnitude(slope)); }
};

inline MeanValueForm operator+(const MeanValueForm& a, const MeanValueForm& b) {
  return {a.at + b.at, a.slope + b.slope};
}
inline MeanValueForm operator-(const MeanValueForm& a, const MeanValueForm& b) {
  return {a.at - b.at, a.slope - b.slope};
}
inline MeanValueForm operator-(const MeanValueForm& a) { return {-a.at, -a.slope}; }
inline MeanValueForm& operator+=(MeanValueForm& a, const MeanValueForm& b) {
  a.at += b.at;
  a.slope += b.slope;
  return a;
}
inline MeanValueForm operator*(const Ball& a, const MeanValueForm& b) {
  return {a * b.at, b.is_constant() ? Ball() : a * b.slope};
}
inline MeanValueForm operator*(const MeanValueForm& a, const Ball& b) { return b * a; }
inline MeanValueForm operator*(const MeanValueForm& a, const MeanValueForm& b) {
  if (a.is_constant()) return a.at * b;
  if (b.is_constant()) return b.at * a;
  Ball slope = a.at * b.slope;
  slope.add_product(a.slope, b.at);
  return {a.at * b.at + from_zero_to(a.slope * b.slope), std::move(slope)};
}

/// F(f) from F and F' at the middle of `at` and F'' on the range.
inline MeanValueForm taylor(const MeanValueForm& f, const Ball& value, const Ball& first, const Ball& second) {
  const Ball off = f.at - middle(f.at);
  const Ball largest = magnitude(plus_minus(off, magnitude(f.slope)));
  return {value + first * off + second * from_zero_to(half(sqr(largest))), first * f.slope};
}
inline MeanValueForm apply(Function F, const MeanValueForm& f) {
  if (f.is_constant()) return MeanValueForm(value(F, f.at));
  const Ball centre = middle(f.at);
  return taylor(f, value(F, centre), first_derivative(F, centre), second_derivative(F, f.range()));
}
inline MeanValueForm sqr(const MeanValueForm& f) {
  return f.is_constant() ? MeanValueForm(sqr(f.at))
                         : MeanValueForm{sqr(f.at) + from_zero_to(sqr(f.slope)), Ball(2) * f.at * f.slope};
}
inline MeanValueForm power(const MeanValueForm& f, int n) {
  if (n == 0) return MeanValueForm(Ball(1));
  if (n == 1) return f;
  if (f.is_constant()) return MeanValueForm(power(f.at, n));
  const Ball centre = middle(f.at);
  return taylor(f, power(centre, n), Ball(n) * power(centre, n - 1), Ball(n) * Ball(n - 1) * power(f.range(), n - 2));
}

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
    result.slope = hull(result.slope, f.slope);
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

inline Ball range(const MeanValueForm& f) { return f.range(); }
inline Ball range(const Jet& f) { return f.value; }

template <class T>
T operator/(const T& a, const T& b) requires(std::same_as<T, MeanValueForm> || std::same_as<T, Jet>) {
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
  if (up.is_zero() && y.is_constant() && certainly_negative(over)) return T(Ball::pi());
  throw Undefined("atan2 at what may be the origin or its cut");
}

}  // namespace taut::checker
