// SPDX-License-Identifier: GPL-3.0-or-later
#include "certify/arithmetic/interval.h"

#include <mpfr.h>

#include <array>
#include <cmath>
#include <cstdint>
#include <optional>
#include <string_view>
#include <vector>

#include "base/input_error.h"
#include "certify/arithmetic/big_float.h"

namespace taut {
namespace {

// ---- MPFR for one end at a time -------------------------------------------------------------------------------------

using MpfrUnary = int (*)(mpfr_ptr, mpfr_srcptr, mpfr_rnd_t);

/// f(x) correctly rounded to binary64 in the given direction.
double mpfr_rounded(MpfrUnary f, double x, mpfr_rnd_t direction) {
  const rounding_detail::NearestGuard nearest;
  mpfr_t value;
  mpfr_init2(value, 53);
  mpfr_set_d(value, x, MPFR_RNDN);
  f(value, value, direction);
  const double result = mpfr_get_d(value, direction);
  mpfr_clear(value);
  return result;
}

Interval checked(double lower, double upper) {
  if (!(std::isfinite(lower) && std::isfinite(upper) && lower <= upper)) {
    Faults<Interval>::raise();
    return {0.0};
  }
  return {lower, upper};
}

Interval increasing(MpfrUnary f, Interval x) {
  return checked(mpfr_rounded(f, x.lower(), MPFR_RNDD), mpfr_rounded(f, x.upper(), MPFR_RNDU));
}

/// A sine's values: asin and acos are NaN beyond them, and checked() would see that too.
void require_sine(Interval x) {
  if (!(x.lower() >= -1 && x.upper() <= 1)) Faults<Interval>::raise();
}

// ---- Sine and cosine ------------------------------------------------------------------------------------------------
//
// For |x| <= kTableEnd: x = k/32 + r with an integer k and |r| <= 1/64 + tiny. r is an interval: just below x = 1/64,
// where rounding upward makes k = 1, it is no binary64 number; elsewhere it is exact (Sterbenz). The table holds
// enclosures of sin(k/32), cos(k/32), one binary64 ulp wide, from MPFR. For |r| <= 1 the Taylor series alternate with
// falling terms, so with z = r^2
//   sin r in r (1 − z/6 (1 − z/20 (1 − [0,1] z/42))),   cos r in 1 − z/2 (1 − z/12 (1 − z/30 (1 − [0,1] z/56))).

constexpr int kStepsPerRadian = 32;
constexpr int kTableEndRadians = 8;
constexpr int kTableSize = kStepsPerRadian * kTableEndRadians + 2;

struct TableEntry {
  double sin_lower, sin_upper, cos_lower, cos_upper;
};

std::vector<TableEntry> make_table() {
  const rounding_detail::NearestGuard nearest;
  std::vector<TableEntry> table(kTableSize);
  mpfr_t x, s, c;
  mpfr_inits2(53, x, s, c, static_cast<mpfr_ptr>(nullptr));
  const auto bounds = [](mpfr_ptr value, int ternary, double& lower, double& upper) {
    // `value` was rounded down to 53 bits; exact when the ternary value is 0.
    lower = mpfr_get_d(value, MPFR_RNDD);
    if (ternary != 0) mpfr_nextabove(value);
    upper = mpfr_get_d(value, MPFR_RNDU);
  };
  for (int k = 0; k < kTableSize; ++k) {
    mpfr_set_si_2exp(x, k, -5, MPFR_RNDN);  // k/32, exact
    auto& entry = table[static_cast<std::size_t>(k)];
    const int sin_ternary = mpfr_sin(s, x, MPFR_RNDD);
    const int cos_ternary = mpfr_cos(c, x, MPFR_RNDD);
    bounds(s, sin_ternary, entry.sin_lower, entry.sin_upper);
    bounds(c, cos_ternary, entry.cos_lower, entry.cos_upper);
  }
  mpfr_clears(x, s, c, static_cast<mpfr_ptr>(nullptr));
  return table;
}

const TableEntry* sine_table() {
  static const std::vector<TableEntry> table = make_table();
  return table.data();
}

/// Thin argument within the table.
SinCos<Interval> sincos_table(double x) {
  const double size = std::abs(x);
  const int k = static_cast<int>(size * kStepsPerRadian + 0.5);
  const Interval r = Interval(size) - Interval(static_cast<double>(k) * (1.0 / kStepsPerRadian));
  const TableEntry& entry = sine_table()[k];
  const Interval table_sin(entry.sin_lower, entry.sin_upper);
  const Interval table_cos(entry.cos_lower, entry.cos_upper);

  const Interval z = sqr(r);
  const Interval one(1.0);
  // Enclosures of 1/6, 1/20, [0, 1/42], 1/12, 1/30, [0, 1/56].
  const Interval sixth(0x1.5555555555555p-3, 0x1.5555555555556p-3);
  const Interval twentieth(0x1.9999999999999p-5, 0x1.999999999999ap-5);
  const Interval up_to_42nd(0.0, 0x1.8618618618619p-6);
  const Interval twelfth(0x1.5555555555555p-4, 0x1.5555555555556p-4);
  const Interval thirtieth(0x1.1111111111111p-5, 0x1.1111111111112p-5);
  const Interval up_to_56th(0.0, 0x1.2492492492493p-6);
  const Interval sin_r = r * (one - z * sixth * (one - z * twentieth * (one - z * up_to_42nd)));
  const Interval cos_r = one - 0.5 * z * (one - z * twelfth * (one - z * thirtieth * (one - z * up_to_56th)));

  const Interval sine = table_sin * cos_r + table_cos * sin_r;
  const Interval cosine = table_cos * cos_r - table_sin * sin_r;
  return {x < 0 ? -sine : sine, cosine};
}

SinCos<Interval> sincos_interval(Interval x);

/// Largest |x| that is reduced modulo 2 pi here; beyond it, [−1, 1].
constexpr double kReductionEnd = 1e6;

/// Any thin argument.
SinCos<Interval> sincos_thin(double x) {
  if (std::abs(x) < kTableEndRadians) return sincos_table(x);
  if (!(std::abs(x) < kReductionEnd)) return {{-1.0, 1.0}, {-1.0, 1.0}};
  const double turns = std::nearbyint(x / 6.283185307179586);  // any integer is right; this one makes the rest small
  const Interval reduced = Interval(x) - turns * (2.0 * ScalarTraits<Interval>::pi());
  return sincos_interval(reduced);
}

Interval clamp_to_unit(double lower, double upper) { return {std::max(lower, -1.0), std::min(upper, 1.0)}; }

/// An interval of width < pi holds at most one zero of the derivative, which is simple: where the derivative has one
/// proved sign at both ends the function is monotone; else the extremum of the possible sign change is included.
Interval hull_with_extrema(Interval at_lower, Interval at_upper, Interval slope_at_lower, Interval slope_at_upper) {
  const Interval ends = hull(at_lower, at_upper);
  const bool maximum_possible = upper_bound(slope_at_lower) >= 0 && lower_bound(slope_at_upper) <= 0;
  const bool minimum_possible = lower_bound(slope_at_lower) <= 0 && upper_bound(slope_at_upper) >= 0;
  return clamp_to_unit(minimum_possible ? -1.0 : lower_bound(ends), maximum_possible ? 1.0 : upper_bound(ends));
}

/// Width, relative to x, of what is an exact number but for rounding.
constexpr double kNarrow = 0x1p-50;

SinCos<Interval> sincos_interval(Interval x) {
  if (x.lower() == x.upper()) return sincos_thin(x.lower());
  const double width = x.upper() - x.lower();                                   // rounded up
  if (!(width < 3.0)) return {{-1.0, 1.0}, {-1.0, 1.0}};                        // 3 < pi
  if (width <= kNarrow * std::min(std::abs(x.lower()), std::abs(x.upper()))) {  // neither moves by more than x does
    const SinCos<Interval> at_lower = sincos_thin(x.lower());
    const Interval moved(-width, width);
    const SinCos<Interval> around{at_lower.sin + moved, at_lower.cos + moved};
    return {clamp_to_unit(around.sin.lower(), around.sin.upper()),
            clamp_to_unit(around.cos.lower(), around.cos.upper())};
  }
  const SinCos<Interval> a = sincos_thin(x.lower());
  const SinCos<Interval> b = sincos_thin(x.upper());
  return {hull_with_extrema(a.sin, b.sin, a.cos, b.cos), hull_with_extrema(a.cos, b.cos, -a.sin, -b.sin)};
}

}  // namespace

SinCos<Interval> sincos(Interval x) { return sincos_interval(x); }

Interval tan(Interval x) {
  const SinCos<Interval> sc = sincos(x);
  return sc.sin / sc.cos;
}

Interval exp(Interval x) { return increasing(mpfr_exp, x); }

Interval log(Interval x) {
  if (!(x.lower() > 0)) {
    Faults<Interval>::raise();
    return {0.0};
  }
  return increasing(mpfr_log, x);
}

Interval asin(Interval x) {
  require_sine(x);
  return increasing(mpfr_asin, x);
}

Interval acos(Interval x) {
  require_sine(x);
  return checked(mpfr_rounded(mpfr_acos, x.upper(), MPFR_RNDD), mpfr_rounded(mpfr_acos, x.lower(), MPFR_RNDU));
}

Interval atan(Interval x) { return increasing(mpfr_atan, x); }

Interval atan2(Interval y, Interval x) {
  if (!(x.lower() > 0 || y.lower() > 0 || y.upper() < 0)) {  // meets the cut or the origin
    Faults<Interval>::raise();
    return {0.0};
  }
  // The box is convex and free of the origin and the cut, so the polar angle takes its extrema at corners.
  const rounding_detail::NearestGuard nearest;
  double lowest = 4.0;
  double highest = -4.0;
  mpfr_t a, b, angle;
  mpfr_inits2(53, a, b, angle, static_cast<mpfr_ptr>(nullptr));
  for (const double corner_y : {y.lower(), y.upper()}) {
    for (const double corner_x : {x.lower(), x.upper()}) {
      mpfr_set_d(a, corner_y, MPFR_RNDN);
      mpfr_set_d(b, corner_x, MPFR_RNDN);
      mpfr_atan2(angle, a, b, MPFR_RNDD);
      lowest = std::min(lowest, mpfr_get_d(angle, MPFR_RNDD));
      mpfr_atan2(angle, a, b, MPFR_RNDU);
      highest = std::max(highest, mpfr_get_d(angle, MPFR_RNDU));
    }
  }
  mpfr_clears(a, b, angle, static_cast<mpfr_ptr>(nullptr));
  return {lowest, highest};
}

Interval pow_int(Interval x, int n) {
  if (n < 0) return reciprocal(pow_int(x, -n));
  if (n == 0) return {1.0};
  if (n % 2 == 0) {
    const Interval half = pow_int(x, n / 2);
    return sqr(half);
  }
  if (n == 1) return x;
  if (x.lower() < 0 && x.upper() > 0) {  // it increases
    return hull(pow_int(Interval(x.lower()), n), pow_int(Interval(x.upper()), n));
  }
  return x * pow_int(x, n - 1);
}

namespace {

/// A decimal as a quotient of two integers that are exact in binary64, the second one positive. None for
/// a text with more than digits, a sign and a point, or with too many digits.
struct PlainDecimal {
  double numerator;
  double denominator;
};
std::optional<PlainDecimal> plain_decimal(std::string_view text) {
  constexpr std::size_t kMostDigits = 15;  // 10^15 < 2^53
  const bool negative = text.starts_with('-');
  if (negative) text.remove_prefix(1);
  std::int64_t digits = 0;
  std::int64_t power = 1;
  std::size_t count = 0;
  bool after_point = false;
  for (const char c : text) {
    if (c == '.' && !after_point) {
      after_point = true;
      continue;
    }
    if (c < '0' || c > '9' || ++count > kMostDigits) return std::nullopt;
    digits = 10 * digits + (c - '0');
    if (after_point) power *= 10;
  }
  if (count == 0) return std::nullopt;
  return PlainDecimal{static_cast<double>(negative ? -digits : digits), static_cast<double>(power)};
}

/// The quotient rounded downward and upward, whatever the caller's rounding.
Interval quotient(const PlainDecimal& x) {
  alignas(16) double ends[2] = {0, 0};  // −lower, upper
  const auto divide = [&] {
    _mm_store_pd(ends, _mm_div_pd(_mm_set_pd(x.numerator, -x.numerator), _mm_set1_pd(x.denominator)));
  };
  const rounding_detail::UpwardGuard guard;
  rounding_detail::call_opaque(&divide);
  return {-ends[0], ends[1]};
}

}  // namespace

Interval ScalarTraits<Interval>::from_decimal(const std::string& text) {
  if (text == "0") return {0.0};  // most entries of most problems
  if (const auto plain = plain_decimal(text)) return quotient(*plain);
  const rounding_detail::NearestGuard nearest;
  mpfr_t value;
  mpfr_init2(value, 53);
  const int bad = mpfr_set_str(value, text.c_str(), 10, MPFR_RNDD);
  const double lower = mpfr_get_d(value, MPFR_RNDD);
  mpfr_set_str(value, text.c_str(), 10, MPFR_RNDU);
  const double upper = mpfr_get_d(value, MPFR_RNDU);
  mpfr_clear(value);
  if (bad != 0) throw std::invalid_argument("not a decimal: " + text);
  if (!std::isfinite(lower) || !std::isfinite(upper)) {
    throw InputError("got '" + text + "', expected a number within the range of binary64");
  }
  return {lower, upper};
}

Interval ScalarTraits<Interval>::pi() { return {0x1.921fb54442d18p+1, 0x1.921fb54442d19p+1}; }

}  // namespace taut
