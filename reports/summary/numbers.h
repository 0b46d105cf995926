// SPDX-License-Identifier: GPL-3.0-or-later
// Exact numbers in binary64, for what is shown. Nothing here proves anything.
#pragma once

#include <cmath>

#include "problem/rational.h"

namespace taut {

/// In which direction a number is rounded when it is printed.
enum class Rounding { kDown, kUp };

/// π/180 is one.
[[nodiscard]] inline double degrees(double radians) { return radians * (180 / 3.14159265358979323846); }

/// Whether a number is beyond the range of Decimal, which refuses it; no physical quantity is that large or small.
[[nodiscard]] inline bool is_absurd(double x) {
  constexpr double kLargest = 1e290;
  const double size = std::abs(x);
  return !(x == 0 || (size < kLargest && size > 1 / kLargest));
}

/// A number that is not above x: further off than the conversion, and one subtraction of such numbers, err by.
[[nodiscard]] inline double below(const Rational& x) {
  constexpr double kShare = 1e-15;
  const auto nearest = x.convert_to<double>();
  return nearest - kShare * std::abs(nearest);
}

/// A number that is not below x.
[[nodiscard]] inline double above(const Rational& x) { return -below(Rational(-x)); }

/// The number nearest to a decimal.
[[nodiscard]] inline double nearest_double(const DecimalText& text) { return ScalarTraits<double>::from_decimal(text); }

}  // namespace taut
