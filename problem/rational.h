// SPDX-License-Identifier: GPL-3.0-or-later
// Exact rational numbers: what an expression such as 1/6^2 means where a decimal could not say it.
#pragma once

#include <boost/multiprecision/cpp_int.hpp>
#include <string>
#include <string_view>

#include "problem/loads.h"
#include "problem/problem.h"
#include "problem/scalar.h"

namespace taut {

using Rational = boost::multiprecision::cpp_rational;

/// Digits that the numerator and the denominator of "a/b" may have.
inline constexpr std::size_t kMaxFractionDigits = 300;

/// Reads a decimal literal as Decimal::parse() does, or "a/b" with digits only, b > 0 and perhaps a minus sign in
/// front. @throws InputError with the text seen and what was expected.
[[nodiscard]] Rational parse_rational(std::string_view text);

/// The canonical text of the value: that of the decimal if it is a finite one, else "a/b" in lowest terms. @throws
/// InputError if the value has no text within the limits of Decimal and kMaxFractionDigits.
[[nodiscard]] RationalText rational_text(const Rational& value);

/// The exact value of a constant expression that consists of decimals, + - * / ^ and parentheses. @throws InputError
/// naming what was seen and what was expected: for a name, a function, pi, a division by zero, and for values that
/// need more than some thousand digits.
[[nodiscard]] Rational evaluate_exactly(const ExpressionText& expression);

/// A decimal that is not below the square root of x >= 0, and above it by less than 1e-12 of it.
[[nodiscard]] Rational root_above(const Rational& x);

/// The value in scalar S: an enclosure if S encloses. @pre parse_rational(text) succeeds, and the rounding mode is the
/// one that divisions of S need.
template <class S>
[[nodiscard]] S from_rational(const RationalText& text) {
  const std::size_t slash = text.find('/');
  if (slash == std::string::npos) return ScalarTraits<S>::from_decimal(text);
  return S(ScalarTraits<S>::from_decimal(text.substr(0, slash))) /
         ScalarTraits<S>::from_decimal(text.substr(slash + 1));
}

}  // namespace taut
