#include "problem/nearest_si.h"

#include <fmt/format.h>

#include <algorithm>
#include <boost/multiprecision/cpp_int.hpp>
#include <cctype>
#include <charconv>
#include <cmath>
#include <cstdint>
#include <optional>
#include <utility>

#include "problem/decimal.h"
#include "problem/scalar.h"

namespace taut {
namespace {

/// Grows as needed; what is usual here fits without allocation.
using Integer = boost::multiprecision::number<boost::multiprecision::cpp_int_backend<512>>;

/// ±digits · 10^exponent
struct ShortDecimal {
  bool negative = false;
  std::uint64_t digits = 0;
  int exponent = 0;
};

/// The decimal, if it is one of at most kMaxDigits digits and a plain exponent; nothing for all else, which is for Decimal.
std::optional<ShortDecimal> read_short(std::string_view text) {
  constexpr int kMaxDigits = 18;
  constexpr int kMaxExponent = 99;
  ShortDecimal result;
  if (!text.empty() && (text.front() == '-' || text.front() == '+')) {
    result.negative = text.front() == '-';
    text.remove_prefix(1);
  }
  int digits = 0;
  bool behind_point = false;
  while (!text.empty() && (std::isdigit(static_cast<unsigned char>(text.front())) != 0 || text.front() == '.')) {
    if (text.front() == '.') {
      if (behind_point) return std::nullopt;
      behind_point = true;
    } else {
      result.digits = 10 * result.digits + static_cast<std::uint64_t>(text.front() - '0');
      result.exponent -= behind_point ? 1 : 0;
      if (++digits > kMaxDigits) return std::nullopt;
    }
    text.remove_prefix(1);
  }
  if (digits == 0) return std::nullopt;
  if (text.empty()) return result;
  if (text.front() != 'e' && text.front() != 'E') return std::nullopt;
  text.remove_prefix(1);
  if (text.starts_with('+') && text.size() > 1 && text[1] != '-') text.remove_prefix(1);
  int exponent = 0;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), exponent);
  if (error != std::errc() || end != text.data() + text.size() || std::abs(exponent) > kMaxExponent) {
    return std::nullopt;
  }
  result.exponent += exponent;
  return result;
}

/// floor(2^bits · arctan(1/n)), up to one for each term of the series.
Integer scaled_arctan_of_reciprocal(unsigned n, unsigned bits) {
  Integer power = (Integer(1) << bits) / n;
  Integer sum = power;
  for (unsigned k = 1; power != 0; ++k) {
    power /= n * n;
    const Integer term = power / (2 * k + 1);
    if (k % 2 == 0) {
      sum += term;
    } else {
      sum -= term;
    }
  }
  return sum;
}

/// 2^bits · pi lies between this and this + 2. (Machin: pi = 16 arctan(1/5) − 4 arctan(1/239).)
Integer scaled_pi_below(unsigned bits) {
  // Each of fewer than `bits` terms of a series is off by less than 2 units; 40 · bits < 2^kGuardBits.
  constexpr unsigned kGuardBits = 32;
  const unsigned fine = bits + kGuardBits;
  const Integer pi = 16 * scaled_arctan_of_reciprocal(5, fine) - 4 * scaled_arctan_of_reciprocal(239, fine);
  return (pi - 40 * fine) >> kGuardBits;
}

/// x · 2^exponent to nearest, ties upward. @pre x >= 2^53
double rounded(const Integer& x, int exponent) {
  constexpr unsigned kMantissaBits = 53;
  const unsigned excess = msb(x) + 1 - kMantissaBits;
  auto mantissa = static_cast<std::uint64_t>(x >> excess);
  if (bit_test(x, excess - 1)) ++mantissa;
  return std::ldexp(static_cast<double>(mantissa), static_cast<int>(excess) + exponent);
}

/// The binary64 nearest to p/q degrees in radians, which is no tie as it is irrational. @pre p, q > 0; the result is normal.
double nearest_radians(const Integer& p, const Integer& q) {
  constexpr unsigned kFirstBits = 128;
  static const Integer first_pi = scaled_pi_below(kFirstBits);
  const Integer divisor = 180 * q;
  for (unsigned bits = kFirstBits;; bits *= 2) {
    const Integer pi = bits == kFirstBits ? first_pi : scaled_pi_below(bits);
    const Integer below = p * pi;
    constexpr unsigned kQuotientBits = 100;
    const unsigned shift = msb(divisor) + kQuotientBits > msb(below) ? msb(divisor) + kQuotientBits - msb(below) : 0;
    const int exponent = -static_cast<int>(bits + shift);
    const double low = rounded((below << shift) / divisor, exponent);
    const double high = rounded(((below + 2 * p) << shift) / divisor + 1, exponent);
    if (low == high) return low;
  }
}

Integer ten_to_the(int n) { return pow(Integer(10), static_cast<unsigned>(n)); }

double radians(const ShortDecimal& degrees) {
  const Integer digits(degrees.digits);
  return degrees.exponent >= 0 ? nearest_radians(digits * ten_to_the(degrees.exponent), 1)
                               : nearest_radians(digits, ten_to_the(-degrees.exponent));
}

}  // namespace

NearestSi::NearestSi(Unit unit) : unit_(std::move(unit)) {
  if (const auto factor = read_short(unit_.factor.text())) {
    factor_digits_ = factor->digits;
    factor_exponent_ = factor->exponent;
    for (; factor_digits_ % 10 == 0; factor_digits_ /= 10) ++factor_exponent_;
  }
}

double NearestSi::operator()(std::string_view text) const {
  const auto typed = read_short(text);
  if (typed && typed->digits == 0) return 0;
  if (typed && unit_.is_degree) return typed->negative ? -radians(*typed) : radians(*typed);
  if (typed && factor_digits_ == 1) {
    const double magnitude =
        ScalarTraits<double>::from_decimal(fmt::format("{}e{}", typed->digits, typed->exponent + factor_exponent_));
    return typed->negative ? -magnitude : magnitude;
  }
  const Decimal value = Decimal::parse(text) * unit_.factor;
  if (!unit_.is_degree || value.sign() == 0) return ScalarTraits<double>::from_decimal(value.text()) + 0.0;
  const auto exact = value.rational();
  const double magnitude = nearest_radians(Integer(abs(numerator(exact))), Integer(denominator(exact)));
  return value.sign() < 0 ? -magnitude : magnitude;
}

}  // namespace taut
