// SPDX-License-Identifier: GPL-3.0-or-later
#include "problem/decimal.h"

#include <fmt/format.h>
#include <xmmintrin.h>

#include <algorithm>
#include <cctype>
#include <charconv>
#include <cmath>
#include <nlohmann/json.hpp>

#include "base/input_error.h"
#include "problem/scalar.h"

namespace taut {
namespace {

using boost::multiprecision::cpp_int;
using boost::multiprecision::cpp_rational;

cpp_int ten_to_the(int n) { return boost::multiprecision::pow(cpp_int(10), static_cast<unsigned>(n)); }

/// Removes and returns the digits that `text` begins with.
std::string_view take_digits(std::string_view& text) {
  const auto end = std::find_if_not(text.begin(), text.end(), [](unsigned char c) { return std::isdigit(c); });
  const std::string_view digits = text.substr(0, static_cast<std::size_t>(end - text.begin()));
  text.remove_prefix(digits.size());
  return digits;
}

bool take_any_of(std::string_view& text, std::string_view characters) {
  if (text.empty() || characters.find(text.front()) == std::string_view::npos) return false;
  text.remove_prefix(1);
  return true;
}

}  // namespace

Decimal::Decimal(cpp_int mantissa, int exponent) : mantissa_(std::move(mantissa)), exponent_(exponent) {
  if (mantissa_ == 0) {
    exponent_ = 0;
    return;
  }
  while (mantissa_ % 10 == 0) {
    mantissa_ /= 10;
    ++exponent_;
  }
  const cpp_int magnitude = abs(mantissa_);
  const std::string digits = magnitude.str();
  const int size = static_cast<int>(digits.size());
  if (size > kMaxDigits) fail_to_read(digits, fmt::format("at most {} significant digits", kMaxDigits));
  if (size + exponent_ > kMaxMagnitude || size + exponent_ <= -kMaxMagnitude) {
    fail_to_read(fmt::format("{}e{}", digits, exponent_),
                 fmt::format("zero or a magnitude of at least 1e-{0} and below 1e{0}", kMaxMagnitude));
  }
}

Decimal Decimal::parse(std::string_view text) {
  const std::string what = "a decimal number such as 0.05 or 1e-4";
  std::string_view rest = text;
  const bool negative = rest.starts_with('-');
  take_any_of(rest, "+-");
  const std::string_view whole = take_digits(rest);
  const std::string_view fraction = take_any_of(rest, ".") ? take_digits(rest) : std::string_view();
  if (whole.empty() && fraction.empty()) fail_to_read(text, what);
  if (whole.size() + fraction.size() > kMaxDigits) fail_to_read(text, fmt::format("at most {} digits", kMaxDigits));
  int exponent = 0;
  if (take_any_of(rest, "eE")) {
    const bool negative_exponent = rest.starts_with('-');
    take_any_of(rest, "+-");
    const std::string_view digits = take_digits(rest);
    if (digits.empty()) fail_to_read(text, what);
    const auto [end, error] = std::from_chars(digits.data(), digits.data() + digits.size(), exponent);
    constexpr int kMaxExponent = kMaxDigits + kMaxMagnitude;  // 1000 digits may stand before or after the point
    if (error != std::errc() || exponent > kMaxExponent) {
      fail_to_read(text, fmt::format("zero or a magnitude of at least 1e-{0} and below 1e{0}", kMaxMagnitude));
    }
    if (negative_exponent) exponent = -exponent;
  }
  if (!rest.empty()) fail_to_read(text, what);
  // cpp_int reads a leading zero as the mark of an octal number.
  std::string digits = std::string(whole) + std::string(fraction);
  digits.erase(0, std::min(digits.find_first_not_of('0'), digits.size() - 1));
  const cpp_int magnitude(digits);
  return Decimal(negative ? cpp_int(-magnitude) : magnitude, exponent - static_cast<int>(fraction.size()));
}

Decimal Decimal::reciprocal_of_power_of_ten() const {
  if (mantissa_ != 1) fail_to_read(text(), "a power of ten");
  return Decimal(1, -exponent_);
}

std::string Decimal::text() const {
  if (mantissa_ == 0) return "0";
  const cpp_int magnitude = abs(mantissa_);
  std::string digits = magnitude.str();
  const int size = static_cast<int>(digits.size());
  const int point = size + exponent_;  // the decimal point follows this many digits
  constexpr int kSmallestPlain = -6, kLargestPlain = 21;
  if (point < kSmallestPlain || point > kLargestPlain) {
    if (size > 1) digits.insert(1, ".");
    digits += fmt::format("e{}", point - 1);
  } else if (point <= 0) {
    digits.insert(0, "0." + std::string(static_cast<std::size_t>(-point), '0'));
  } else if (point < size) {
    digits.insert(static_cast<std::size_t>(point), ".");
  } else {
    digits.append(static_cast<std::size_t>(exponent_), '0');
  }
  return mantissa_ < 0 ? "-" + digits : digits;
}

Decimal Decimal::operator*(const Decimal& other) const {
  return Decimal(cpp_int(mantissa_ * other.mantissa_), exponent_ + other.exponent_);
}

std::strong_ordering Decimal::operator<=>(const Decimal& other) const {
  const int common = std::min(exponent_, other.exponent_);
  const cpp_int left = mantissa_ * ten_to_the(exponent_ - common);
  const cpp_int right = other.mantissa_ * ten_to_the(other.exponent_ - common);
  return left.compare(right) <=> 0;
}

cpp_rational Decimal::rational() const {
  return exponent_ >= 0 ? cpp_rational(mantissa_ * ten_to_the(exponent_))
                        : cpp_rational(mantissa_, ten_to_the(-exponent_));
}

double ScalarTraits<double>::from_decimal(const std::string& text) {
  double value = 0;
  const auto read = [&value](const std::string& digits) {
    // from_chars multiplies short numbers in the current rounding mode, which a prover may have set upward. It sets
    // MXCSR only, so fegetround() does not show it.
    const unsigned mode = _mm_getcsr();
    _mm_setcsr(mode & ~static_cast<unsigned>(_MM_ROUND_MASK));
    const auto [end, error] = std::from_chars(digits.data(), digits.data() + digits.size(), value);
    _mm_setcsr(mode);
    return error == std::errc() && end == digits.data() + digits.size() && std::isfinite(value);
  };
  if (!read(text)) read(Decimal::parse(text).text());  // a leading plus sign, or not a decimal
  return value;
}

void fail_to_read(std::string_view text, const std::string& expected) {
  constexpr std::size_t kShown = 60;
  throw InputError(
      fmt::format("got '{}{}', expected {}", text.substr(0, kShown), text.size() > kShown ? "…" : "", expected));
}

Decimal decimal_at(const std::string& where, std::string_view text) {
  try {
    return Decimal::parse(text);
  } catch (const InputError& error) {
    throw FieldError(where, "", error.what());
  }
}

Decimal decimal_from_json(const JsonCursor& value) {
  try {
    if (value.value().is_string()) return Decimal::parse(value.text());
  } catch (const InputError&) {  // names no place; fail() below does
  }
  value.fail("a decimal number in a string");
}

}  // namespace taut
