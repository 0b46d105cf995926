// SPDX-License-Identifier: GPL-3.0-or-later
// Exact decimal numbers: the meaning of a number typed in a case file.
#pragma once

#include <boost/multiprecision/cpp_int.hpp>
#include <compare>
#include <string>
#include <string_view>

#include "base/json_cursor.h"

namespace taut {

/// mantissa · 10^exponent, exactly; the mantissa has no trailing zero, so each value has one representation.
///
/// Invariant: zero, or at most kMaxDigits digits and 10^-kMaxMagnitude <= |value| < 10^kMaxMagnitude. Therefore the
/// text of every Decimal can be read back, and its nearest binary64 is zero or finite and normal.
class Decimal {
 public:
  static constexpr int kMaxDigits = 1000;    ///< bounds the cost of hostile input; nobody types more
  static constexpr int kMaxMagnitude = 300;  ///< within binary64's normal range, 2.2e-308 to 1.8e308

  Decimal() = default;

  /// Reads an optional sign, digits with an optional point (at least one digit), and an optional exponent: "-0.021",
  /// ".5", "+1E-4". White space and anything else is an error. @throws InputError with the text seen and what was
  /// expected.
  [[nodiscard]] static Decimal parse(std::string_view text);

  [[nodiscard]] bool is_power_of_ten() const { return mantissa_ == 1; }
  /// 1 / value, for a power of ten. @throws InputError for any other value.
  [[nodiscard]] Decimal reciprocal_of_power_of_ten() const;

  /// The canonical text of the value: "-0.1905256", "10000", "0"; with an exponent, as "1.25e-9", below 1e-7 and from
  /// 1e21 on.
  [[nodiscard]] std::string text() const;

  [[nodiscard]] int sign() const { return mantissa_.sign(); }
  /// @throws InputError if the product violates the invariant.
  [[nodiscard]] Decimal operator*(const Decimal& other) const;
  [[nodiscard]] bool operator==(const Decimal& other) const = default;
  [[nodiscard]] std::strong_ordering operator<=>(const Decimal& other) const;
  [[nodiscard]] boost::multiprecision::cpp_rational rational() const;

 private:
  Decimal(boost::multiprecision::cpp_int mantissa, int exponent);

  boost::multiprecision::cpp_int mantissa_ = 0;
  int exponent_ = 0;
};

/// @throws InputError that quotes the text and says what was expected instead of it
[[noreturn]] void fail_to_read(std::string_view text, const std::string& expected);

/// Decimal::parse. @throws FieldError that names the place
[[nodiscard]] Decimal decimal_at(const std::string& where, std::string_view text);
/// The decimal in a JSON string. @throws FieldError that names the place
[[nodiscard]] Decimal decimal_from_json(const JsonCursor& value);

}  // namespace taut
