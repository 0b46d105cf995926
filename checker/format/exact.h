// SPDX-License-Identifier: GPL-3.0-or-later
// The exact numbers of a certificate. All of them are strings, and none is rounded when it is read.
#pragma once

#include <gmpxx.h>

#include <optional>
#include <string>
#include <string_view>

namespace taut::checker {

inline constexpr const char* kDecimalForm =
    "a decimal of at most 1000 digits, with an exponent of at most 1000 either way";
inline constexpr const char* kRationalForm =
    "such a decimal, or a fraction a/b of integers with b > 0 and at most 300 digits each";
inline constexpr const char* kDyadicForm = "\"0\", \"1\" or k/m with m a power of two, in lowest terms, in [0, 1]";
inline constexpr const char* kBinary64Form = "a finite binary64 as printed by %a";

// Each of these returns nothing unless the whole text has the form.

/// "-0.0210" or "1e-4": the rational number that is written there.
[[nodiscard]] std::optional<mpq_class> parse_decimal(std::string_view text);

/// A decimal, or "-1/36": the rational number that is written there.
[[nodiscard]] std::optional<mpq_class> parse_rational(std::string_view text);

/// "0", "1", or "k/m" with a denominator of at most 302 digits.
[[nodiscard]] std::optional<mpq_class> parse_dyadic(std::string_view text);

/// "-0x1.2666666666666p+1": only the one text that "%a" prints for the number.
[[nodiscard]] std::optional<double> parse_binary64(std::string_view text);

/// The text that parse_binary64() reads back bit for bit. `x` is finite.
[[nodiscard]] std::string print_binary64(double x);

}  // namespace taut::checker
