// SPDX-License-Identifier: GPL-3.0-or-later
#include "checker/format/exact.h"

#include <array>
#include <charconv>
#include <cmath>
#include <cstdlib>

namespace taut::checker {
namespace {

constexpr std::size_t kMaxDigits = 1000;
constexpr long kMaxExponent = 1000;
constexpr std::size_t kMaxDenominatorDigits = 302;
constexpr std::size_t kMaxFractionDigits = 300;

/// Removes the character from the front of `text`, if it is there.
bool take(std::string_view& text, char c) {
  const bool found = text.starts_with(c);
  if (found) text.remove_prefix(1);
  return found;
}

/// Removes the digits from the front of `text`.
std::string take_digits(std::string_view& text) {
  const std::string digits(text.substr(0, text.find_first_not_of("0123456789")));
  text.remove_prefix(digits.size());
  return digits;
}

}  // namespace

std::optional<mpq_class> parse_decimal(std::string_view text) {
  const bool is_negative = take(text, '-');
  const std::string whole = take_digits(text);
  const std::string fraction = take(text, '.') ? take_digits(text) : "";
  const std::string digits = whole + fraction;
  if (digits.empty() || digits.size() > kMaxDigits) return std::nullopt;
  long exponent = 0;
  if (take(text, 'e') || take(text, 'E')) {
    const bool is_minus = take(text, '-');
    if (!is_minus) take(text, '+');
    const std::string written = take_digits(text);
    if (written.empty() || written.size() > 4 || std::stol(written) > kMaxExponent) return std::nullopt;
    exponent = is_minus ? -std::stol(written) : std::stol(written);
  }
  if (!text.empty()) return std::nullopt;
  exponent -= static_cast<long>(fraction.size());
  mpz_class scale;
  mpz_ui_pow_ui(scale.get_mpz_t(), 10, static_cast<unsigned long>(std::labs(exponent)));
  mpq_class value(mpz_class(is_negative ? "-" + digits : digits, 10));
  if (exponent < 0) return value / scale;
  return value * scale;
}

std::optional<mpq_class> parse_rational(std::string_view text) {
  if (text.find('/') == std::string_view::npos) return parse_decimal(text);
  const bool is_negative = take(text, '-');
  const std::string above = take_digits(text);
  take(text, '/');
  const std::string below = take_digits(text);
  const auto fits = [](const std::string& digits) { return !digits.empty() && digits.size() <= kMaxFractionDigits; };
  if (!text.empty() || !fits(above) || !fits(below)) return std::nullopt;
  const mpz_class denominator(below, 10);
  if (denominator == 0) return std::nullopt;
  mpq_class value(mpz_class(is_negative ? "-" + above : above, 10), denominator);
  value.canonicalize();
  return value;
}

std::optional<mpq_class> parse_dyadic(std::string_view text) {
  const std::string written(text);
  mpq_class value;
  if (text.size() > 2 * kMaxDenominatorDigits + 1 || text.find_first_not_of("0123456789/") != std::string_view::npos ||
      value.set_str(written, 10) != 0 || value.get_den() == 0) {
    return std::nullopt;
  }
  value.canonicalize();
  const bool is_dyadic = mpz_popcount(value.get_den_mpz_t()) == 1 && value <= 1;
  if (!is_dyadic || value.get_str() != written || value.get_den().get_str().size() > kMaxDenominatorDigits) {
    return std::nullopt;
  }
  return value;
}

std::string print_binary64(double x) {
  std::array<char, 32> digits{};
  const auto end = std::to_chars(digits.data(), digits.data() + digits.size(), std::abs(x), std::chars_format::hex).ptr;
  return (std::signbit(x) ? "-0x" : "0x") + std::string(digits.data(), end);
}

std::optional<double> parse_binary64(std::string_view text) {
  std::string_view digits = text;
  const bool is_negative = take(digits, '-');
  if (!take(digits, '0') || !take(digits, 'x')) return std::nullopt;
  double value = 0;
  const auto [end, error] =
      std::from_chars(digits.data(), digits.data() + digits.size(), value, std::chars_format::hex);
  if (is_negative) value = -value;
  // Printing it again must give the same text: then the text is exact, however from_chars() rounds.
  if (error != std::errc() || !std::isfinite(value) || print_binary64(value) != text) return std::nullopt;
  return value;
}

}  // namespace taut::checker
