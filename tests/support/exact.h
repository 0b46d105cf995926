// SPDX-License-Identifier: GPL-3.0-or-later
// The reference for tests of enclosures: a 300-bit MPFR number that models the scalar concept, and difficult operands.
//
// An enclosure's ends have at most 300 bits and rounding is monotone, so an exact value inside an enclosure stays
// inside when it is rounded to 300 bits: a miss is a miss.
#pragma once

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <cstring>
#include <limits>
#include <random>
#include <string>

#include "certify/arithmetic/big_float.h"
#include "problem/scalar.h"

namespace taut {

// The scalar concept for BigFloat, rounded to nearest at the working precision: for tests only.
namespace exact_detail {
template <class F>
BigFloat nearest(F function, const BigFloat& x) {
  return BigFloat::apply_rounded(MPFR_RNDN, function, x);
}
}  // namespace exact_detail
inline BigFloat sqr(const BigFloat& x) { return x * x; }
inline BigFloat reciprocal(const BigFloat& x) { return BigFloat(1.0) / x; }
inline BigFloat sqrt(const BigFloat& x) { return exact_detail::nearest(mpfr_sqrt, x); }
inline BigFloat sin(const BigFloat& x) { return exact_detail::nearest(mpfr_sin, x); }
inline BigFloat cos(const BigFloat& x) { return exact_detail::nearest(mpfr_cos, x); }
inline BigFloat tan(const BigFloat& x) { return exact_detail::nearest(mpfr_tan, x); }
inline BigFloat exp(const BigFloat& x) { return exact_detail::nearest(mpfr_exp, x); }
inline BigFloat log(const BigFloat& x) { return exact_detail::nearest(mpfr_log, x); }
inline BigFloat absolute(const BigFloat& x) { return abs(x); }
inline BigFloat larger(const BigFloat& x, const BigFloat& y) { return x < y ? y : x; }
inline BigFloat euclidean_norm(const BigFloat& x, const BigFloat& y, const BigFloat& z) {
  return sqrt(x * x + y * y + z * z);
}
inline SinCos<BigFloat> sincos(const BigFloat& x) { return {sin(x), cos(x)}; }
inline BigFloat asin(const BigFloat& x) { return exact_detail::nearest(mpfr_asin, x); }
inline BigFloat acos(const BigFloat& x) { return exact_detail::nearest(mpfr_acos, x); }
inline BigFloat atan(const BigFloat& x) { return exact_detail::nearest(mpfr_atan, x); }
inline BigFloat atan2(const BigFloat& y, const BigFloat& x) {
  return BigFloat::apply_rounded(MPFR_RNDN, mpfr_atan2, y, x);
}
inline BigFloat pow_int(const BigFloat& x, int n) {
  BigFloat result;
  mpfr_pow_si(result.get(), x.get(), n, MPFR_RNDN);
  return result;
}
inline bool certainly_positive(const BigFloat& x) { return x > BigFloat(0.0); }
template <>
struct ScalarTraits<BigFloat> {
  static BigFloat from_decimal(const std::string& text) {
    BigFloat x;
    mpfr_set_str(x.get(), text.c_str(), 10, MPFR_RNDN);
    return x;
  }
  static BigFloat pi() {
    BigFloat x;
    mpfr_const_pi(x.get(), MPFR_RNDN);
    return x;
  }
};

namespace testing {

inline constexpr mpfr_prec_t kExactBits = 300;

struct Operand {
  double lower;
  double upper;
  [[nodiscard]] bool thin() const { return lower == upper; }
};

/// Points and intervals: zeros of both signs, subnormals, powers of two and their neighbours, multiples of pi/2 and of
/// 1/64 and theirs, any exponent, plain numbers; thin, a few ulps wide, narrow, or as wide as two such points are
/// apart.
class Operands {
 public:
  explicit Operands(std::uint64_t seed) : random_(seed) {}

  double point() {
    using Limits = std::numeric_limits<double>;
    const double sign = coin(0.5) ? 1 : -1;
    switch (pick(8)) {
      case 0: {
        static constexpr double kSpecial[] = {0.0,    0.0,   Limits::denorm_min(), Limits::min(), 1.0, 2.0,
                                              1e-300, 1e300, Limits::max(),        0.5,           3.0, 1e6};
        return sign * near(kSpecial[pick(12)]);
      }
      case 1: return sign * near(std::ldexp(1.0, pick(80) - 40));
      case 2: return sign * near(pick(coin(0.5) ? 12 : 700'000) * 1.5707963267948966);
      case 3: return sign * near(pick(520) / 64.0);
      case 4: {  // any bits
        const std::uint64_t bits = random_();
        double x;
        std::memcpy(&x, &bits, sizeof x);
        return std::isfinite(x) ? x : 1.0;
      }
      case 5: return sign * std::exp(uniform(-14, 14));
      default: return uniform(-8, 8);
    }
  }

  Operand interval() {
    const double x = point();
    switch (pick(5)) {
      case 0: {
        Operand wide{x, point()};
        if (wide.lower > wide.upper) std::swap(wide.lower, wide.upper);
        return wide;
      }
      case 1: {
        double upper = x;
        for (int n = pick(4); n > 0; --n) upper = above(upper);
        return {x, upper};
      }
      case 2: {
        const double upper = x + std::exp(uniform(-30, 1));
        return {x, std::isfinite(upper) ? upper : x};
      }
      default: return {x, x};
    }
  }

  /// An end or a number between.
  double inside(const Operand& x) {
    if (coin(0.4)) return coin(0.5) ? x.lower : x.upper;
    const double u = uniform(0, 1);
    return std::clamp((1 - u) * x.lower + u * x.upper, x.lower, x.upper);
  }

  double uniform(double lower, double upper) { return std::uniform_real_distribution<double>(lower, upper)(random_); }
  int pick(int n) { return std::uniform_int_distribution<int>(0, n - 1)(random_); }
  bool coin(double probability) { return uniform(0, 1) < probability; }

 private:
  static double above(double x) {
    const double next = std::nextafter(x, std::numeric_limits<double>::infinity());
    return std::isfinite(next) ? next : x;
  }
  double near(double x) {
    for (int n = pick(3); n > 0; --n) x = coin(0.5) ? above(x) : -above(-x);
    return x;
  }

  std::mt19937_64 random_;
};

/// A double that prints exactly.
inline std::string hex(double x) {
  char text[40];
  std::snprintf(text, sizeof text, "%a", x);
  return text;
}
inline std::string hex(const Operand& x) { return std::string("[").append(hex(x.lower)) + ", " + hex(x.upper) + "]"; }
inline std::string digits(const BigFloat& x) {
  char text[80];
  mpfr_snprintf(text, sizeof text, "%.40Rg", x.get());
  return text;
}

}  // namespace testing
}  // namespace taut
