// SPDX-License-Identifier: GPL-3.0-or-later
// Vectors and numbers on a box around middles, in binary64 under run_upward().
//
// A vector v on the box with midpoint m is stated by numbers with
//   |v(m) − mid| <= mid_error,   v(t) − v(m) = (slope + e)(t − m) with |e| <= slope_error,   for every t,
// Euclidean norms, and so is a number. Middles are rounded, and all errors include that. docs/theory.md, "Items, all
// rows at once".
#pragma once

#include <array>
#include <cmath>
#include <type_traits>

#include "certify/arithmetic/six.h"

namespace taut {

/// A vector v on T; T is double, or Six for those that belong to the rows of D^-1.
template <class T>
struct VectorForm {
  std::array<T, 3> mid, slope;
  T mid_error, slope_error;
  T mid_size, slope_size;  ///< >= |mid|, |slope|
};
template <class T>
struct NumberForm {
  T mid, slope;
  T mid_error, slope_error;
  T mid_size, slope_size;
};

/// A number that is the same everywhere.
struct KnownNumber {
  double mid = 0, error = 0, upper = 0;  ///< |x − mid| <= error, |x| <= upper
};
/// A vector of which only |v − mid| <= error is stated, and |mid| <= size.
template <class T>
struct VectorBall {
  std::array<T, 3> mid{};
  T error{}, size{};
};
template <class T>
struct NumberBall {
  T mid{}, error{}, size{};
};
/// A vector that is the same everywhere.
using KnownVector = VectorBall<double>;

/// Rounding, in parts of the sizes, of the few operations of a product, a sum or a norm: an operation that rounds
/// upward is off by at most 2^-52 of its result.
inline constexpr double kRounding = 0x1p-48;
inline constexpr double kAbove = 1 + kRounding;
/// More than underflow adds to any of them: the square root of a sum of squares that are 0 or subnormal is < 2^-530.
inline constexpr double kUnderflow = 0x1p-500;

inline double size_of(const std::array<double, 3>& v) { return std::sqrt(v[0] * v[0] + v[1] * v[1] + v[2] * v[2]); }
inline Six size_of(const std::array<Six, 3>& v) { return sqrt(v[0] * v[0] + v[1] * v[1] + v[2] * v[2]); }

// ---- Bilinear products: a∘b with |a∘b| <= |a||b| --------------------------------------------------------------------

template <class T>
struct ProductBounds {
  T mid_error, slope_error, mid_size, slope_size;
};

/// a(m)∘b(m) − â∘b̂ = (a(m) − â)∘b(m) + â∘(b(m) − b̂), and
/// a(t)∘b(t) − a(m)∘b(m) = (a(t) − a(m))∘b(t) + a(m)∘(b(t) − b(m)).
template <class A, class B>
auto product_bounds(const A& a, const B& b, double radius) {
  const auto at_mid = b.mid_size + b.mid_error;
  const auto slope = b.slope_size + b.slope_error;
  const auto drift = b.mid_error + radius * slope;  // >= |b(t) − b̂|
  using T = std::decay_t<decltype(a.mid_size)>;
  ProductBounds<T> result;
  result.mid_error = a.mid_error * T(at_mid) + a.mid_size * T(b.mid_error + kRounding * b.mid_size) + T(kUnderflow);
  result.slope_error = a.slope_size * T(drift + kRounding * b.mid_size) + a.slope_error * T(b.mid_size + drift) +
                       a.mid_error * T(slope) + a.mid_size * T(b.slope_error + kRounding * b.slope_size) +
                       T(kUnderflow);
  result.mid_size = T(kAbove * b.mid_size) * a.mid_size + T(kUnderflow);
  result.slope_size = T(kAbove) * (a.slope_size * T(b.mid_size) + a.mid_size * T(b.slope_size)) + T(kUnderflow);
  return result;
}

/// The same for a constant b.
template <class A>
auto product_bounds(const A& a, const KnownVector& b) {
  using T = std::decay_t<decltype(a.mid_size)>;
  const T size(b.size + b.error), error(b.error + kRounding * b.size), above(kAbove * b.size);
  return ProductBounds<T>{a.mid_error * size + a.mid_size * error + T(kUnderflow),
                          a.slope_error * size + a.slope_size * error + T(kUnderflow),
                          a.mid_size * above + T(kUnderflow), a.slope_size * above + T(kUnderflow)};
}

template <class T>
std::array<T, 3> cross(const std::array<T, 3>& a, const std::array<double, 3>& b) {
  return {a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]};
}
template <class T>
T dot(const std::array<T, 3>& a, const std::array<double, 3>& b) {
  return a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
}
template <class T>
std::array<T, 3> sum(const std::array<T, 3>& a, const std::array<T, 3>& b) {
  return {a[0] + b[0], a[1] + b[1], a[2] + b[2]};
}

template <class T>
VectorForm<T> vector_form(const std::array<T, 3>& mid, const std::array<T, 3>& slope, const ProductBounds<T>& bounds) {
  return {mid, slope, bounds.mid_error, bounds.slope_error, bounds.mid_size, bounds.slope_size};
}
inline NumberForm<Six> number_form(const Six& mid, const Six& slope, const ProductBounds<Six>& bounds) {
  return {mid, slope, bounds.mid_error, bounds.slope_error, bounds.mid_size, bounds.slope_size};
}

inline VectorForm<Six> cross(const VectorForm<Six>& a, const VectorForm<double>& b, double radius) {
  return vector_form(cross(a.mid, b.mid), sum(cross(a.slope, b.mid), cross(a.mid, b.slope)),
                     product_bounds(a, b, radius));
}
template <class T>
VectorForm<T> cross(const VectorForm<T>& a, const KnownVector& b) {
  return vector_form(cross(a.mid, b.mid), cross(a.slope, b.mid), product_bounds(a, b));
}
inline NumberForm<Six> dot(const VectorForm<Six>& a, const VectorForm<double>& b, double radius) {
  return number_form(dot(a.mid, b.mid), dot(a.slope, b.mid) + dot(a.mid, b.slope), product_bounds(a, b, radius));
}
inline NumberForm<Six> dot(const VectorForm<Six>& a, const KnownVector& b) {
  return number_form(dot(a.mid, b.mid), dot(a.slope, b.mid), product_bounds(a, b));
}

template <class T>
ProductBounds<T> sum_bounds(const T& mid_error, const T& slope_error, const T& mid_size, const T& slope_size) {
  const T r(kRounding), above(kAbove);
  return {mid_error + r * mid_size, slope_error + r * slope_size, above * mid_size, above * slope_size};
}
template <class T>
VectorForm<T> operator+(const VectorForm<T>& a, const VectorForm<T>& b) {
  return vector_form(sum(a.mid, b.mid), sum(a.slope, b.slope),
                     sum_bounds<T>(a.mid_error + b.mid_error, a.slope_error + b.slope_error, a.mid_size + b.mid_size,
                                   a.slope_size + b.slope_size));
}
inline NumberForm<Six> operator+(const NumberForm<Six>& a, const NumberForm<Six>& b) {
  return number_form(a.mid + b.mid, a.slope + b.slope,
                     sum_bounds<Six>(a.mid_error + b.mid_error, a.slope_error + b.slope_error, a.mid_size + b.mid_size,
                                     a.slope_size + b.slope_size));
}

inline VectorForm<double> constant(const KnownVector& v) { return {v.mid, {0, 0, 0}, v.error, 0, v.size, 0}; }

}  // namespace taut
