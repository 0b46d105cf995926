// SPDX-License-Identifier: GPL-3.0-or-later
// Vectors of the campaign, in double, in double with a bound on its error, and in 200 bits.
#pragma once

#include <array>
#include <cmath>
#include <string>

#include "problem/problem.h"
#include "tests/oracle/oracle_at_origin.h"
#include "tests/soundness/guarded.h"

namespace taut::campaign {

inline double root(double x) { return std::sqrt(x); }
inline double sine(double x) { return std::sin(x); }
inline double cosine(double x) { return std::cos(x); }
inline double magnitude(double x) { return std::abs(x); }
inline double to_double(double x) { return x; }
inline double angle(double y, double x) { return std::atan2(y, x); }
using oracle::cosine;
using oracle::root;
using oracle::sine;
inline BigFloat magnitude(const BigFloat& x) { return abs(x); }
inline double to_double(const BigFloat& x) { return x.to_double(); }
inline BigFloat angle(const BigFloat& y, const BigFloat& x) {
  return BigFloat::apply_rounded(MPFR_RNDN, mpfr_atan2, y, x);
}

/// Of a decimal, or of "a/b".
template <class S>
S number(const std::string& text) {
  if (const std::size_t bar = text.find('/'); bar != std::string::npos) {
    return number<S>(text.substr(0, bar)) / number<S>(text.substr(bar + 1));
  }
  if constexpr (std::is_same_v<S, double>) {
    return std::strtod(text.c_str(), nullptr);
  } else if constexpr (std::is_same_v<S, Guarded>) {
    return Guarded::rounded(std::strtod(text.c_str(), nullptr), 0);
  } else {
    return oracle::big(text);
  }
}

template <class S>
using Vec = std::array<S, 3>;
template <class S>
using Rows = std::array<Vec<S>, 3>;
template <class S>
using Six = std::array<S, 6>;
template <class S>
using SixBySix = std::array<Six<S>, 6>;

template <class S>
Vec<S> operator+(const Vec<S>& a, const Vec<S>& b) {
  return {a[0] + b[0], a[1] + b[1], a[2] + b[2]};
}
template <class S>
Vec<S> operator-(const Vec<S>& a, const Vec<S>& b) {
  return {a[0] - b[0], a[1] - b[1], a[2] - b[2]};
}
template <class S>
Vec<S> operator*(const S& k, const Vec<S>& a) {
  return {k * a[0], k * a[1], k * a[2]};
}
template <class S>
S dot(const Vec<S>& a, const Vec<S>& b) {
  return a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
}
template <class S>
Vec<S> cross(const Vec<S>& a, const Vec<S>& b) {
  return {a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]};
}
template <class S>
Vec<S> operator*(const Rows<S>& r, const Vec<S>& x) {
  return {dot(r[0], x), dot(r[1], x), dot(r[2], x)};
}
template <class S>
Rows<S> operator*(const Rows<S>& a, const Rows<S>& b) {
  Rows<S> result;
  for (std::size_t i = 0; i < 3; ++i) {
    for (std::size_t j = 0; j < 3; ++j) {
      result[i][j] = a[i][0] * b[0][j] + a[i][1] * b[1][j] + a[i][2] * b[2][j];
    }
  }
  return result;
}

}  // namespace taut::campaign
