// SPDX-License-Identifier: GPL-3.0-or-later
// The multiprecision enclosing scalar: Boost.Interval over MPFR with every rounding directed.
//
// MpfrRounding is the rounding policy: each elementary operation, square root and transcendental is MPFR's own,
// correctly rounded in the direction asked. Boost's own transcendental policies call libm and do not enclose; they are
// not used. The policy also serves binary64 (BoostInterval<double>), where it is the slow twin that tests hold Interval
// against.
#pragma once

#include <mpfr.h>

// Not <boost/numeric/interval.hpp>: it brings Boost's transcendentals, which call libm.
#include <boost/numeric/interval/arith.hpp>
#include <boost/numeric/interval/arith2.hpp>
#include <boost/numeric/interval/checking.hpp>
#include <boost/numeric/interval/interval.hpp>
#include <boost/numeric/interval/policies.hpp>
#include <boost/numeric/interval/rounding.hpp>
#include <boost/numeric/interval/utility.hpp>
#include <cmath>
#include <limits>
#include <string>

#include "certify/arithmetic/big_float.h"
#include "certify/arithmetic/rounding.h"
#include "problem/scalar.h"

namespace taut {

/// Ends of type T as MPFR numbers and back.
template <class T>
struct MpfrEnds;

template <>
struct MpfrEnds<BigFloat> {
  static const BigFloat& in(const BigFloat& x) { return x; }
  static BigFloat out(BigFloat x, mpfr_rnd_t) { return x; }
};
template <>
struct MpfrEnds<double> {
  static BigFloat in(double x) { return BigFloat(x); }
  static double out(const BigFloat& x, mpfr_rnd_t rounding) {
    const double result = x.to_double(rounding);
    if (std::isinf(result)) mpfr_set_overflow();  // MPFR's own exponent range is wider
    return result;
  }
};

template <class T>
class MpfrRounding {
 public:
  using unprotected_rounding = MpfrRounding;

#define TAUT_DIRECTED_UNARY(name, function)                                 \
  static T name##_down(const T& x) { return call(MPFR_RNDD, function, x); } \
  static T name##_up(const T& x) { return call(MPFR_RNDU, function, x); }
#define TAUT_DIRECTED_BINARY(name, function)                                               \
  static T name##_down(const T& x, const T& y) { return call(MPFR_RNDD, function, x, y); } \
  static T name##_up(const T& x, const T& y) { return call(MPFR_RNDU, function, x, y); }

  TAUT_DIRECTED_BINARY(add, mpfr_add)
  TAUT_DIRECTED_BINARY(sub, mpfr_sub)
  TAUT_DIRECTED_BINARY(mul, mpfr_mul)
  TAUT_DIRECTED_BINARY(div, mpfr_div)
  TAUT_DIRECTED_UNARY(sqrt, mpfr_sqrt)
  TAUT_DIRECTED_UNARY(sin, mpfr_sin)
  TAUT_DIRECTED_UNARY(cos, mpfr_cos)
  TAUT_DIRECTED_UNARY(exp, mpfr_exp)
  TAUT_DIRECTED_UNARY(log, mpfr_log)
  TAUT_DIRECTED_UNARY(asin, mpfr_asin)
  TAUT_DIRECTED_UNARY(acos, mpfr_acos)
  TAUT_DIRECTED_UNARY(atan, mpfr_atan)
  TAUT_DIRECTED_BINARY(atan2, mpfr_atan2)
#undef TAUT_DIRECTED_UNARY
#undef TAUT_DIRECTED_BINARY

  static T median(const T& x, const T& y) { return (x + y) / T(2); }
  template <class U>
  static T conv_down(const U& x) {
    return T(x);
  }
  template <class U>
  static T conv_up(const U& x) {
    return T(x);
  }

 private:
  template <class F, class... Args>
  static T call(mpfr_rnd_t rounding, F function, const Args&... args) {
    // The results are binary64 or of working precision, and BigFloat rounds once, in this direction.
    return MpfrEnds<T>::out(BigFloat::apply_rounded(rounding, function, as_big(MpfrEnds<T>::in(args))...), rounding);
  }
  static const BigFloat& as_big(const BigFloat& x) { return x; }
};

/// Anything that would make an empty or unbounded interval is a fault (see Faults<MpInterval>).
template <class T>
struct FaultChecking {
  static T pos_inf() { return fault(); }
  static T neg_inf() { return fault(); }
  static T nan() { return fault(); }
  static bool is_nan(const T& x) { return x != x; }
  static T empty_lower() { return fault(); }
  static T empty_upper() { return fault(); }
  static bool is_empty(const T& lower, const T& upper) { return !(lower <= upper); }

 private:
  static T fault() {
    mpfr_set_nanflag();
    return T(0);
  }
};

template <class T>
using BoostInterval = boost::numeric::interval<
    T, boost::numeric::interval_lib::policies<boost::numeric::interval_lib::save_state_nothing<MpfrRounding<T>>,
                                              FaultChecking<T>>>;

using MpInterval = BoostInterval<BigFloat>;

/// MPFR's own sticky flags, one set a thread.
template <class T>
struct MpfrFaults {
  static void clear() { mpfr_clear_flags(); }
  static bool raised() {
    return mpfr_nanflag_p() != 0 || mpfr_divby0_p() != 0 || mpfr_overflow_p() != 0 || mpfr_erangeflag_p() != 0;
  }
  static void raise() { mpfr_set_nanflag(); }
};
template <>
struct Faults<MpInterval> : MpfrFaults<BigFloat> {};
template <>
struct Faults<BoostInterval<double>> : MpfrFaults<double> {};

}  // namespace taut

// The scalar concept for Boost's intervals; in their namespace so that argument-dependent lookup finds it.
namespace boost::numeric {

// Boost's own quotient and root are silent where they leave their domain: 0 / [−1, 1] = 0, sqrt([−1, 4]) = [0, 2].
// These are more specialised, hence preferred, and raise a fault there.
template <class T>
[[nodiscard]] taut::BoostInterval<T> operator/(const taut::BoostInterval<T>& x, const taut::BoostInterval<T>& y) {
  using I = taut::BoostInterval<T>;
  if (zero_in(y)) taut::Faults<I>::raise();
  return operator/<T, typename I::traits_type>(x, y);
}
template <class T>
[[nodiscard]] taut::BoostInterval<T> sqrt(const taut::BoostInterval<T>& x) {
  using I = taut::BoostInterval<T>;
  if (!(x.lower() >= T(0))) taut::Faults<I>::raise();
  return sqrt<T, typename I::traits_type>(x);
}

template <class T, class P>
[[nodiscard]] interval<T, P> sqr(const interval<T, P>& x) {
  return square(x);
}

template <class T, class P>
[[nodiscard]] interval<T, P> absolute(const interval<T, P>& x) {
  return sqrt(square(x));
}
template <class T, class P>
[[nodiscard]] interval<T, P> larger(const interval<T, P>& x, const interval<T, P>& y) {
  return interval<T, P>(std::max(x.lower(), y.lower()), std::max(x.upper(), y.upper()));
}
template <class T, class P>
[[nodiscard]] interval<T, P> euclidean_norm(const interval<T, P>& x, const interval<T, P>& y, const interval<T, P>& z) {
  return sqrt(interval<T, P>(square(x) + square(y) + square(z)));
}

namespace taut_detail {

template <class T, class P>
interval<T, P> with_extrema(const interval<T, P>& a, const interval<T, P>& b, const interval<T, P>& slope_a,
                            const interval<T, P>& slope_b) {
  const bool maximum_possible = slope_a.upper() >= T(0) && slope_b.lower() <= T(0);
  const bool minimum_possible = slope_a.lower() <= T(0) && slope_b.upper() >= T(0);
  const interval<T, P> ends = hull(a, b);
  return interval<T, P>(minimum_possible ? T(-1) : ends.lower(), maximum_possible ? T(1) : ends.upper());
}

}  // namespace taut_detail

/// As for Interval (interval.cc): ends from MPFR, extrema where the derivative may change sign; no pi is needed.
template <class T, class P>
[[nodiscard]] taut::SinCos<interval<T, P>> sincos(const interval<T, P>& x) {
  using I = interval<T, P>;
  using R = taut::MpfrRounding<T>;
  const T width = R::sub_up(x.upper(), x.lower());
  if (!(width < T(3))) return {I(T(-1), T(1)), I(T(-1), T(1))};
  const auto thin = [](const T& t) {
    return taut::SinCos<I>{I(R::sin_down(t), R::sin_up(t)), I(R::cos_down(t), R::cos_up(t))};
  };
  const auto a = thin(x.lower());
  if (x.lower() == x.upper()) return a;
  const auto b = thin(x.upper());
  return {taut_detail::with_extrema(a.sin, b.sin, a.cos, b.cos),
          taut_detail::with_extrema(a.cos, b.cos, -a.sin, -b.sin)};
}

template <class T, class P>
[[nodiscard]] interval<T, P> tan(const interval<T, P>& x) {
  const auto sc = sincos(x);
  return sc.sin / sc.cos;
}
template <class T, class P>
[[nodiscard]] interval<T, P> exp(const interval<T, P>& x) {
  using R = taut::MpfrRounding<T>;
  return interval<T, P>(R::exp_down(x.lower()), R::exp_up(x.upper()));
}
template <class T, class P>
[[nodiscard]] interval<T, P> log(const interval<T, P>& x) {
  using R = taut::MpfrRounding<T>;
  if (!(x.lower() > T(0))) {
    taut::Faults<interval<T, P>>::raise();
    return interval<T, P>(T(0));
  }
  return interval<T, P>(R::log_down(x.lower()), R::log_up(x.upper()));
}
template <class T, class P>
[[nodiscard]] interval<T, P> asin(const interval<T, P>& x) {
  using R = taut::MpfrRounding<T>;
  if (!(x.lower() >= T(-1) && x.upper() <= T(1))) {
    taut::Faults<interval<T, P>>::raise();
    return interval<T, P>(T(0));
  }
  return interval<T, P>(R::asin_down(x.lower()), R::asin_up(x.upper()));
}
template <class T, class P>
[[nodiscard]] interval<T, P> acos(const interval<T, P>& x) {
  using R = taut::MpfrRounding<T>;
  if (!(x.lower() >= T(-1) && x.upper() <= T(1))) {
    taut::Faults<interval<T, P>>::raise();
    return interval<T, P>(T(0));
  }
  return interval<T, P>(R::acos_down(x.upper()), R::acos_up(x.lower()));
}
template <class T, class P>
[[nodiscard]] interval<T, P> atan(const interval<T, P>& x) {
  using R = taut::MpfrRounding<T>;
  return interval<T, P>(R::atan_down(x.lower()), R::atan_up(x.upper()));
}
template <class T, class P>
[[nodiscard]] interval<T, P> atan2(const interval<T, P>& y, const interval<T, P>& x) {
  using R = taut::MpfrRounding<T>;
  if (!(x.lower() > T(0) || y.lower() > T(0) || y.upper() < T(0))) {
    taut::Faults<interval<T, P>>::raise();
    return interval<T, P>(T(0));
  }
  interval<T, P> result(R::atan2_down(y.lower(), x.lower()), R::atan2_up(y.lower(), x.lower()));
  for (const T& corner_y : {y.lower(), y.upper()}) {
    for (const T& corner_x : {x.lower(), x.upper()}) {
      result = hull(result, interval<T, P>(R::atan2_down(corner_y, corner_x), R::atan2_up(corner_y, corner_x)));
    }
  }
  return result;
}
template <class T, class P>
[[nodiscard]] interval<T, P> pow_int(const interval<T, P>& x, int n) {
  if (n < 0) return interval<T, P>(T(1)) / pow_int(x, -n);
  if (n == 0) return interval<T, P>(T(1));
  if (n % 2 == 0) return sqr(pow_int(x, n / 2));
  if (n == 1) return x;
  if (x.lower() < T(0) && x.upper() > T(0)) {  // it increases
    return hull(pow_int(interval<T, P>(x.lower()), n), pow_int(interval<T, P>(x.upper()), n));
  }
  return x * pow_int(x, n - 1);
}

template <class T, class P>
[[nodiscard]] double lower_bound(const interval<T, P>& x) {
  return taut::MpfrEnds<T>::in(x.lower()).to_double(MPFR_RNDD);
}
template <class T, class P>
[[nodiscard]] double upper_bound(const interval<T, P>& x) {
  return taut::MpfrEnds<T>::in(x.upper()).to_double(MPFR_RNDU);
}
template <class T, class P>
[[nodiscard]] double midpoint_approx(const interval<T, P>& x) {
  return 0.5 * lower_bound(x) + 0.5 * upper_bound(x);
}
template <class T, class P>
[[nodiscard]] bool certainly_positive(const interval<T, P>& x) {
  return x.lower() > T(0);
}
template <class T, class P>
[[nodiscard]] bool certainly_nonpositive(const interval<T, P>& x) {
  return x.upper() <= T(0);
}
template <class T, class P>
[[nodiscard]] bool contains(const interval<T, P>& x, double value) {
  return x.lower() <= T(value) && T(value) <= x.upper();
}
template <class T, class P>
[[nodiscard]] T magnitude(const interval<T, P>& x) {
  return std::max(T(-x.lower()), T(x.upper()));
}
template <class T, class P>
[[nodiscard]] interval<T, P> reciprocal(const interval<T, P>& x) {
  return interval<T, P>(T(1)) / x;
}

}  // namespace boost::numeric

namespace taut {

template <class T>
struct BoostIntervalTraits {
  static BoostInterval<T> from_decimal(const std::string& text) {
    BigFloat low, high;
    if (mpfr_set_str(low.get(), text.c_str(), 10, MPFR_RNDD) != 0) {
      throw std::invalid_argument("not a decimal: " + text);
    }
    mpfr_set_str(high.get(), text.c_str(), 10, MPFR_RNDU);
    return {MpfrEnds<T>::out(low, MPFR_RNDD), MpfrEnds<T>::out(high, MPFR_RNDU)};
  }
  static BoostInterval<T> pi() {
    BigFloat low, high;
    mpfr_const_pi(low.get(), MPFR_RNDD);
    mpfr_const_pi(high.get(), MPFR_RNDU);
    return {MpfrEnds<T>::out(low, MPFR_RNDD), MpfrEnds<T>::out(high, MPFR_RNDU)};
  }
};
template <>
struct ScalarTraits<MpInterval> : BoostIntervalTraits<BigFloat> {};
template <>
struct ScalarTraits<BoostInterval<double>> : BoostIntervalTraits<double> {};

}  // namespace taut
