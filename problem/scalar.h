// SPDX-License-Identifier: GPL-3.0-or-later
// The scalar concept: the operations that the equations of kinematics/ use.
//
// It is modelled by double, Interval (certify/arithmetic/interval.h), MpInterval (certify/arithmetic/mp_interval.h) and
// the forms over them. Functions are found by argument-dependent lookup; ScalarTraits makes constants.
#pragma once

#include <cmath>
#include <concepts>
#include <string>
#include <utility>

namespace taut {

/// Constants of scalar S. For an enclosing scalar each result contains the exact value.
template <class S>
struct ScalarTraits;

/// Sine and cosine of one argument.
template <class S>
struct SinCos {
  S sin;
  S cos;
};

template <>
struct ScalarTraits<double> {
  static double from_decimal(const std::string& text);  ///< nearest binary64
  static double pi() { return 3.14159265358979323846; }
};

/// Bounds as doubles. For an enclosing scalar they lie below and above all its members.
inline double lower_bound(double x) { return x; }
inline double upper_bound(double x) { return x; }
/// True only if every member is positive.
inline bool certainly_positive(double x) { return x > 0; }
inline double sqr(double x) { return x * x; }
inline double absolute(double x) { return std::abs(x); }
inline double larger(double x, double y) { return x < y ? y : x; }
inline double euclidean_norm(double x, double y, double z) { return std::sqrt(x * x + y * y + z * z); }
inline SinCos<double> sincos(double x) { return {std::sin(x), std::cos(x)}; }
inline double pow_int(double x, int n) { return std::pow(x, n); }
using std::acos;
using std::asin;
using std::atan;
using std::atan2;
using std::cos;
using std::exp;
using std::log;
using std::sin;
using std::sqrt;
using std::tan;

template <class S>
concept Scalar = std::copyable<S> && requires(S x, S y, const std::string& text, double d, int n) {
  {S(d)};  // exact
  { x + y } -> std::convertible_to<S>;
  { x - y } -> std::convertible_to<S>;
  { x* y } -> std::convertible_to<S>;
  { x / y } -> std::convertible_to<S>;
  { -x } -> std::convertible_to<S>;
  { sqr(x) } -> std::convertible_to<S>;
  { sqrt(x) } -> std::convertible_to<S>;
  { absolute(x) } -> std::convertible_to<S>;
  { larger(x, y) } -> std::convertible_to<S>;
  { euclidean_norm(x, y, x) } -> std::convertible_to<S>;
  { sincos(x) } -> std::convertible_to<SinCos<S>>;
  { tan(x) } -> std::convertible_to<S>;
  { exp(x) } -> std::convertible_to<S>;
  { log(x) } -> std::convertible_to<S>;
  { asin(x) } -> std::convertible_to<S>;
  { acos(x) } -> std::convertible_to<S>;
  { atan(x) } -> std::convertible_to<S>;
  { atan2(x, y) } -> std::convertible_to<S>;
  { pow_int(x, n) } -> std::convertible_to<S>;
};

}  // namespace taut
