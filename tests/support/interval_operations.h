// SPDX-License-Identifier: GPL-3.0-or-later
// Every operation of the interval arithmetics with what it must enclose: its exact range over a box of operands.
//
// The ranges come from MPFR alone, at kOracleBits, rounded down at the lower and up at the upper end. An enclosure
// whose ends have fewer bits contains the range if and only if it contains the rounded one, so that no miss is too
// small to be seen. The operands are binary64, and 2100 bits tell any of them from any multiple of a quarter turn.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdlib>
#include <limits>
#include <string>
#include <vector>

#include "tests/support/enclosing.h"

namespace taut::testing {

inline constexpr mpfr_prec_t kOracleBits = 2100;

/// Outward, at kOracleBits.
struct Range {
  BigFloat lower;
  BigFloat upper;
};

namespace oracle_detail {

template <class F, class... Args>
BigFloat down(F f, const Args&... args) {
  return BigFloat::apply_rounded(MPFR_RNDD, f, BigFloat(args)...);
}
template <class F, class... Args>
BigFloat up(F f, const Args&... args) {
  return BigFloat::apply_rounded(MPFR_RNDU, f, BigFloat(args)...);
}
template <class F>
Range increasing(F f, const Operand& a) {
  return {down(f, a.lower), up(f, a.upper)};
}
template <class F>
Range decreasing(F f, const Operand& a) {
  return {down(f, a.upper), up(f, a.lower)};
}
/// Of a function that takes its extrema at corners of the box.
template <class F>
Range corners(F f, const Operand& a, const Operand& b) {
  Range range{down(f, a.lower, b.lower), up(f, a.lower, b.lower)};
  for (const double x : {a.lower, a.upper}) {
    for (const double y : {b.lower, b.upper}) {
      range.lower = std::min(range.lower, down(f, x, y));
      range.upper = std::max(range.upper, up(f, x, y));
    }
  }
  return range;
}

inline bool holds_zero(const Operand& x) { return x.lower <= 0 && x.upper >= 0; }
/// The least and the largest |x|.
inline Operand sizes(const Operand& x) {
  const double a = std::abs(x.lower);
  const double b = std::abs(x.upper);
  return {holds_zero(x) ? 0.0 : std::min(a, b), std::max(a, b)};
}

/// Whether there is a number (phase + period k) pi/2 in x, k an integer.
inline bool meets(const Operand& x, int phase, int period) {
  const auto turns = [&](double end) {
    return (BigFloat(end) / (ScalarTraits<BigFloat>::pi() / BigFloat(2.0)) - BigFloat(phase)) / BigFloat(period);
  };
  BigFloat first = turns(x.lower);
  BigFloat last = turns(x.upper);
  mpfr_ceil(first.get(), first.get());
  mpfr_floor(last.get(), last.get());
  return first <= last;
}
template <class F>
Range sinusoid(F f, const Operand& x, int phase_of_maximum) {
  Range range{std::min(down(f, x.lower), down(f, x.upper)), std::max(up(f, x.lower), up(f, x.upper))};
  if (meets(x, phase_of_maximum, 4)) range.upper = BigFloat(1.0);
  if (meets(x, phase_of_maximum + 2, 4)) range.lower = BigFloat(-1.0);
  return range;
}

}  // namespace oracle_detail

/// kUlps bounds how far each end is beyond the exact one, in ulps of that. kMayGiveUp allows faults inside the domain.
/// kUnit: most operands are to be taken from [−1, 1].
struct Operation {
  static constexpr double kUlps = 1;
  static constexpr bool kMayGiveUp = false;
  static constexpr int kOperands = 1;
  static constexpr bool kUnit = false;
  static bool defined(const Operand&, const Operand&) { return true; }
};
constexpr double kUnboundedUlps = HUGE_VAL;

struct Add : Operation {
  static constexpr const char* kName = "a + b";
  static constexpr int kOperands = 2;
  template <class S>
  static S apply(const S& a, const S& b) {
    return a + b;
  }
  static Range range(const Operand& a, const Operand& b) { return oracle_detail::corners(mpfr_add, a, b); }
};
struct Subtract : Operation {
  static constexpr const char* kName = "a − b";
  static constexpr int kOperands = 2;
  template <class S>
  static S apply(const S& a, const S& b) {
    return a - b;
  }
  static Range range(const Operand& a, const Operand& b) { return oracle_detail::corners(mpfr_sub, a, b); }
};
struct Multiply : Operation {
  static constexpr const char* kName = "a b";
  static constexpr int kOperands = 2;
  template <class S>
  static S apply(const S& a, const S& b) {
    return a * b;
  }
  static Range range(const Operand& a, const Operand& b) { return oracle_detail::corners(mpfr_mul, a, b); }
};
struct Divide : Operation {
  static constexpr const char* kName = "a / b";
  static constexpr double kUlps = 4;  // Interval multiplies by a reciprocal
  static constexpr int kOperands = 2;
  static bool defined(const Operand&, const Operand& b) { return !oracle_detail::holds_zero(b); }
  template <class S>
  static S apply(const S& a, const S& b) {
    return a / b;
  }
  static Range range(const Operand& a, const Operand& b) { return oracle_detail::corners(mpfr_div, a, b); }
};
struct Negate : Operation {
  static constexpr const char* kName = "−a";
  static constexpr double kUlps = 0;
  template <class S>
  static S apply(const S& a, const S&) {
    return -a;
  }
  static Range range(const Operand& a, const Operand&) { return oracle_detail::decreasing(mpfr_neg, a); }
};
struct Reciprocal : Operation {
  static constexpr const char* kName = "1 / a";
  static bool defined(const Operand& a, const Operand&) { return !oracle_detail::holds_zero(a); }
  template <class S>
  static S apply(const S& a, const S&) {
    return reciprocal(a);
  }
  static Range range(const Operand& a, const Operand&) {
    return oracle_detail::decreasing(
        [](mpfr_ptr r, mpfr_srcptr x, mpfr_rnd_t rounding) { return mpfr_ui_div(r, 1, x, rounding); }, a);
  }
};
struct Square : Operation {
  static constexpr const char* kName = "sqr a";
  template <class S>
  static S apply(const S& a, const S&) {
    return sqr(a);
  }
  static Range range(const Operand& a, const Operand&) {
    return oracle_detail::increasing(mpfr_sqr, oracle_detail::sizes(a));
  }
};
struct Root : Operation {
  static constexpr const char* kName = "sqrt a";
  static constexpr double kUlps = 2;  // Interval's lower end is one too low where the root is exact
  static bool defined(const Operand& a, const Operand&) { return a.lower >= 0; }
  template <class S>
  static S apply(const S& a, const S&) {
    return sqrt(a);
  }
  static Range range(const Operand& a, const Operand&) { return oracle_detail::increasing(mpfr_sqrt, a); }
};
struct Sine : Operation {
  static constexpr const char* kName = "sin a";
  static constexpr double kUlps = kUnboundedUlps;  // Interval is bounded in ulps of 1: interval_test.cc
  template <class S>
  static S apply(const S& a, const S&) {
    if constexpr (requires { sincos(a); })
      return sincos(a).sin;
    else
      return sin(a);
  }
  static Range range(const Operand& a, const Operand&) { return oracle_detail::sinusoid(mpfr_sin, a, 1); }
};
struct Cosine : Sine {
  static constexpr const char* kName = "cos a";
  template <class S>
  static S apply(const S& a, const S&) {
    if constexpr (requires { sincos(a); })
      return sincos(a).cos;
    else
      return cos(a);
  }
  static Range range(const Operand& a, const Operand&) { return oracle_detail::sinusoid(mpfr_cos, a, 0); }
};
struct Tangent : Operation {
  static constexpr const char* kName = "tan a";
  static constexpr double kUlps = kUnboundedUlps;
  static constexpr bool kMayGiveUp = true;  // near a pole, and wherever the cosine of a wide argument may be 0
  static bool defined(const Operand& a, const Operand&) { return !oracle_detail::meets(a, 1, 2); }
  template <class S>
  static S apply(const S& a, const S&) {
    return tan(a);
  }
  static Range range(const Operand& a, const Operand&) { return oracle_detail::increasing(mpfr_tan, a); }
};
struct Exponential : Operation {
  static constexpr const char* kName = "exp a";
  template <class S>
  static S apply(const S& a, const S&) {
    return exp(a);
  }
  static Range range(const Operand& a, const Operand&) { return oracle_detail::increasing(mpfr_exp, a); }
};
struct Logarithm : Operation {
  static constexpr const char* kName = "log a";
  static bool defined(const Operand& a, const Operand&) { return a.lower > 0; }
  template <class S>
  static S apply(const S& a, const S&) {
    return log(a);
  }
  static Range range(const Operand& a, const Operand&) { return oracle_detail::increasing(mpfr_log, a); }
};
struct Arcsine : Operation {
  static constexpr const char* kName = "asin a";
  static constexpr bool kUnit = true;
  static bool defined(const Operand& a, const Operand&) { return a.lower >= -1 && a.upper <= 1; }
  template <class S>
  static S apply(const S& a, const S&) {
    return asin(a);
  }
  static Range range(const Operand& a, const Operand&) { return oracle_detail::increasing(mpfr_asin, a); }
};
struct Arccosine : Arcsine {
  static constexpr const char* kName = "acos a";
  template <class S>
  static S apply(const S& a, const S&) {
    return acos(a);
  }
  static Range range(const Operand& a, const Operand&) { return oracle_detail::decreasing(mpfr_acos, a); }
};
struct Arctangent : Operation {
  static constexpr const char* kName = "atan a";
  template <class S>
  static S apply(const S& a, const S&) {
    return atan(a);
  }
  static Range range(const Operand& a, const Operand&) { return oracle_detail::increasing(mpfr_atan, a); }
};
struct Angle : Operation {
  static constexpr const char* kName = "atan2(a, b)";
  static constexpr double kUlps = kUnboundedUlps;  // near 0 some are differences of right angles
  static constexpr int kOperands = 2;
  static bool defined(const Operand& y, const Operand& x) { return !(oracle_detail::holds_zero(y) && x.lower <= 0); }
  template <class S>
  static S apply(const S& y, const S& x) {
    return atan2(y, x);
  }
  static Range range(const Operand& y, const Operand& x) { return oracle_detail::corners(mpfr_atan2, y, x); }
};
template <int N>
struct Power : Operation {
  static inline const std::string kText = "a^" + std::to_string(N);
  static inline const char* const kName = kText.c_str();
  static constexpr double kUlps = N > 0 ? 2 * N : -2 * N + 2;
  static bool defined(const Operand& a, const Operand&) { return N >= 0 || !oracle_detail::holds_zero(a); }
  template <class S>
  static S apply(const S& a, const S&) {
    return pow_int(a, N);
  }
  static Range range(const Operand& a, const Operand&) {
    const auto power = [](mpfr_ptr r, mpfr_srcptr x, mpfr_rnd_t rounding) { return mpfr_pow_si(r, x, N, rounding); };
    const Operand x = N % 2 == 0 ? oracle_detail::sizes(a) : a;
    return N >= 0 ? oracle_detail::increasing(power, x) : oracle_detail::decreasing(power, x);
  }
};

/// Calls visit.template operator()<Op>() for each of them.
template <class Visitor>
void for_each_operation(Visitor&& visit) {
  const auto all = [&]<class... Ops>() { (visit.template operator()<Ops>(), ...); };
  all.template operator()<Add, Subtract, Multiply, Divide, Negate, Reciprocal, Square, Root, Power<0>, Power<1>,
                          Power<2>, Power<3>, Power<7>, Power<-1>, Power<-2>, Power<-3>, Sine, Cosine, Tangent,
                          Exponential, Logarithm, Arcsine, Arccosine, Arctangent, Angle>();
}

/// How far x is beyond the exact end, in ulps of that at `bits`; 0 for no distance at all, unbounded for some at 0.
inline double ulps_beyond(const BigFloat& x, const BigFloat& exact, mpfr_prec_t bits) {
  BigFloat distance = BigFloat::apply_rounded(MPFR_RNDU, mpfr_sub, x, exact);
  if (mpfr_zero_p(distance.get()) != 0) return 0;
  if (mpfr_regular_p(exact.get()) == 0) return kUnboundedUlps;
  mpfr_mul_2si(distance.get(), distance.get(), bits - mpfr_get_exp(exact.get()), MPFR_RNDU);
  return std::abs(distance.to_double(MPFR_RNDA));
}

inline bool extreme(const BigFloat& x) {
  const BigFloat size = abs(x);
  return size > BigFloat(1e290) || (size < BigFloat(1e-290) && size != BigFloat(0.0));
}
inline bool extreme(const Operand& x) { return extreme(BigFloat(x.lower)) || extreme(BigFloat(x.upper)); }

inline bool finite(const BigFloat& x) { return mpfr_number_p(x.get()) != 0; }

inline int random_cases() {
  constexpr int kQuickCases = 600;
  const char* const wanted = std::getenv("TAUT_INTERVAL_CASES");  // NOLINT(concurrency-mt-unsafe): nothing sets it
  return wanted == nullptr ? kQuickCases : std::atoi(wanted);
}

/// Random operands, folded into the domain where that is [−1, 1]; a few are left as they are.
template <class Op>
Operand random_operand(Operands& operands) {
  const Operand x = operands.interval();
  if (!Op::kUnit || operands.coin(0.1)) return x;
  const auto fold = [](double end) { return std::abs(end) > 1 ? 1 / end : end; };
  const auto [lower, upper] = std::minmax({fold(x.lower), fold(x.upper)});
  return {lower, upper};
}

/// Zeros of both signs, subnormals, the largest, edges of domains and their neighbours, what is next to multiples of a
/// quarter turn, huge angles; as points, next to each other, and as wide as any two of them are apart.
inline const std::vector<Operand>& directed_operands() {
  static const std::vector<Operand> all = [] {
    using Limits = std::numeric_limits<double>;
    constexpr double kTiny = Limits::denorm_min();
    constexpr double kMax = Limits::max();
    std::vector<double> points = {
        0.0, kTiny, 3 * kTiny, Limits::min(), 0x1.fffffffffffffp-1023, 0x1p-511, 0x1p-27, 0.5, 0x1.fffffffffffffp-1,
        1.0, 0x1.0000000000001p+0, 2.0, 3.0, 0x1p+26, 0x1p+53, 0x1p+511, 0x1p+512, 1e300, kMax, std::nextafter(kMax, 0),
        // just below and above pi/4, pi/2, pi, 3/2 pi, 2 pi, 100 pi, the end of the table of sines, a
        // double that is 2^-60 from a multiple of pi/2, and huge angles
        0x1.921fb54442d18p-1, 0x1.921fb54442d19p-1, 0x1.921fb54442d18p+0, 0x1.921fb54442d19p+0, 0x1.921fb54442d18p+1,
        0x1.921fb54442d19p+1, 0x1.2d97c7f3321d2p+2, 0x1.2d97c7f3321d3p+2, 0x1.921fb54442d18p+2, 0x1.921fb54442d19p+2,
        0x1.3a28c59d5433bp+8, 0x1.3a28c59d5433cp+8, 8.0, 0x1.fffffffffffffp+2, 0x1.6ac5b262ca1ffp+849, 1e6, 1e22,
        0x1p+1023,
        // where exp overflows, and where it leaves the normal and the subnormal numbers
        0x1.62e42fefa39efp+9, 0x1.62e42fefa39f0p+9, 0x1.6232bdd7abcd2p+9, 0x1.74910d52d3051p+9, 0x1.74910d52d3052p+9,
        746.0};
    for (std::size_t n = points.size(); n-- > 0;) points.push_back(-points[n]);
    std::vector<Operand> operands = {{-0.0, 0.0}, {0.0, -0.0}};
    for (const double x : points) operands.push_back({x, x});
    for (std::size_t i = 0; i < points.size(); i += 3) {
      for (std::size_t k = i % 2; k < points.size(); k += 4) {
        if (points[i] < points[k]) operands.push_back({points[i], points[k]});
      }
    }
    return operands;
  }();
  return all;
}

}  // namespace taut::testing
