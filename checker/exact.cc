#include "checker/exact.h"

#include <algorithm>
#include <cctype>
#include <charconv>
#include <cmath>
#include <limits>

#include "checker/errors.h"

namespace taut::checker {
namespace {

constexpr std::size_t kMaxDigits = 1000;
constexpr int kMaxExponent = 1000;

/// Appends the digits at `i` to `digits`; returns how many.
std::size_t take_digits(const std::string& text, std::size_t& i, std::string& digits) {
  const std::size_t begin = i;
  while (i < text.size() && std::isdigit(static_cast<unsigned char>(text[i]))) digits += text[i++];
  return i - begin;
}

mpz_class power_of_ten(unsigned long n) {
  mpz_class result;
  mpz_ui_pow_ui(result.get_mpz_t(), 10, n);
  return result;
}

[[noreturn]] void fail(const std::string& text, const std::string& where, const char* expected) {
  throw Malformed(where + ": got '" + text.substr(0, 60) + "', expected " + expected);
}

}  // namespace

mpq_class parse_decimal(const std::string& text, const std::string& where) {
  constexpr const char* kExpected = "a decimal of at most 1000 digits, with an exponent of at most 1000 either way";
  std::size_t i = 0;
  const bool negative = i < text.size() && text[i] == '-';
  if (negative) ++i;
  std::string digits;
  std::string exponent_digits;
  take_digits(text, i, digits);
  long exponent = 0;
  if (i < text.size() && text[i] == '.') exponent = -static_cast<long>(take_digits(text, ++i, digits));
  if (digits.empty() || digits.size() > kMaxDigits) fail(text, where, kExpected);
  if (i < text.size() && (text[i] == 'e' || text[i] == 'E')) {
    ++i;
    const bool minus = i < text.size() && text[i] == '-';
    if (i < text.size() && (text[i] == '-' || text[i] == '+')) ++i;
    take_digits(text, i, exponent_digits);
    if (exponent_digits.empty() || exponent_digits.size() > 4 || std::stol(exponent_digits) > kMaxExponent) {
      fail(text, where, kExpected);
    }
    exponent += (minus ? -1 : 1) * std::stol(exponent_digits);
  }
  if (i != text.size()) fail(text, where, kExpected);
  mpq_class value(mpz_class(digits, 10));
  const mpz_class scale = power_of_ten(static_cast<unsigned long>(std::labs(exponent)));
  value = exponent < 0 ? mpq_class(value / scale) : mpq_class(value * scale);
  return negative ? mpq_class(-value) : value;
}

mpq_class parse_dyadic(const std::string& text, const std::string& where) {
  constexpr const char* kExpected = "\"0\", \"1\" or k/m with m a power of two, in lowest terms, in [0, 1]";
  if (text == "0") return 0;
  if (text == "1") return 1;
  std::string k;
  std::string m;
  std::size_t i = 0;
  take_digits(text, i, k);
  if (i < text.size() && text[i] == '/') take_digits(text, ++i, m);
  if (k.empty() || m.empty() || i != text.size() || k[0] == '0' || m[0] == '0' || m.size() > 302) {
    fail(text, where, kExpected);
  }
  const mpz_class numerator(k, 10);
  const mpz_class denominator(m, 10);
  if (mpz_popcount(denominator.get_mpz_t()) != 1 || denominator == 1 || mpz_even_p(numerator.get_mpz_t()) ||
      numerator >= denominator) {
    fail(text, where, kExpected);
  }
  return mpq_class(numerator, denominator);
}

double parse_binary64(const std::string& text, const std::string& where) {
  const bool negative = text.starts_with('-');
  const char* const end = text.data() + text.size();
  const char* const digits = text.data() + std::min<std::size_t>(text.size(), negative ? 3 : 2);  // behind "0x"
  double value = std::numeric_limits<double>::infinity();
  std::from_chars(digits, end, value, std::chars_format::hex);
  if (negative) value = -value;
  char written[32];
  const auto [last, error] = std::to_chars(written, written + sizeof written, std::abs(value), std::chars_format::hex);
  const std::string canonical = (negative ? "-0x" : "0x") + std::string(written, last);
  // Equal to what is written of it, as by "%a": then the text is exact, whatever from_chars did on its way.
  if (!std::isfinite(value) || text != canonical) fail(text, where, "a finite binary64 as printed by %a");
  return value;
}

}  // namespace taut::checker
