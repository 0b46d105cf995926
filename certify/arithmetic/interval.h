// SPDX-License-Identifier: GPL-3.0-or-later
// The fast enclosing scalar: a bounded interval of doubles, (−lower, upper) packed in one SSE register.
//
// Claim.  While the thread rounds upward (run_upward) and Faults<Interval> is not raised, every operation's result
// contains every value of the exact operation on members of the operands. With (−lower, upper) stored, upward rounding
// rounds both ends outward and the mode never changes.
//
// Intervals are bounded: an operation that would be undefined on some member (division by an interval with 0, square
// root of a negative, …) or that overflows raises a fault and the proof in progress is void. Hence there are no empty
// intervals and no infinities to reason about.
//
// Transcendentals: sin and cos come from a table of MPFR enclosures and a Taylor remainder (interval.cc;
// docs/theory.md, "Sine and cosine"), tan is their quotient; exp, log, asin, acos, atan, atan2 ask
// MPFR for each end. No libm.
#pragma once

#include <immintrin.h>

#include <algorithm>
#include <string>

#include "certify/arithmetic/rounding.h"
#include "problem/scalar.h"

namespace taut {

class Interval {
 public:
  Interval() = default;  // uninitialised, as double
  explicit(false) Interval(double x) : v_(_mm_set_pd(x, -x)) {}
  /// @pre lower <= upper, both finite.
  Interval(double lower, double upper) : v_(_mm_set_pd(upper, -lower)) {}

  [[nodiscard]] double lower() const { return -_mm_cvtsd_f64(v_); }
  [[nodiscard]] double upper() const { return _mm_cvtsd_f64(high()); }

  friend Interval operator+(Interval a, Interval b) { return Interval(_mm_add_pd(a.v_, b.v_)); }
  friend Interval operator-(Interval a, Interval b) { return Interval(_mm_add_pd(a.v_, b.swapped())); }
  friend Interval operator-(Interval a) { return Interval(a.swapped()); }
  friend Interval operator*(Interval a, Interval b);
  friend Interval operator/(Interval a, Interval b) { return a * reciprocal(b); }
  Interval& operator+=(Interval b) { return *this = *this + b; }
  Interval& operator-=(Interval b) { return *this = *this - b; }
  Interval& operator*=(Interval b) { return *this = *this * b; }
  Interval& operator/=(Interval b) { return *this = *this / b; }

  friend Interval operator*(double x, Interval a);
  friend Interval times_nonnegative(Interval a, Interval b);
  friend Interval reciprocal(Interval a);
  friend Interval sqr(Interval a);
  friend Interval sqrt(Interval a);
  friend Interval hull(Interval a, Interval b) { return Interval(_mm_max_pd(a.v_, b.v_)); }
  /// Both enclose the same quantity, so they meet; a fault where they do not.
  friend Interval intersect(Interval a, Interval b) {
    const Interval meet(_mm_min_pd(a.v_, b.v_));
    if (!(meet.lower() <= meet.upper())) Faults<Interval>::raise();
    return meet;
  }

 private:
  explicit Interval(__m128d v) : v_(v) {}
  [[nodiscard]] __m128d swapped() const { return _mm_shuffle_pd(v_, v_, 1); }
  [[nodiscard]] __m128d high() const { return _mm_unpackhi_pd(v_, v_); }

  __m128d v_;  // low lane −lower, high lane upper
};

inline Interval operator*(Interval a, Interval b) {
  // The four candidates for each end, e.g. upper = max((−la)(−lb), ua ub, −((−la) ub), −(ua (−lb))).
  const __m128d sign = _mm_set1_pd(-0.0);
  const __m128d na = _mm_unpacklo_pd(a.v_, a.v_);
  const __m128d ua = _mm_unpackhi_pd(a.v_, a.v_);
  const __m128d b_swapped = b.swapped();
  const __m128d p1 = _mm_mul_pd(na, b_swapped);
  const __m128d p2 = _mm_mul_pd(ua, b.v_);
  const __m128d p3 = _mm_mul_pd(_mm_xor_pd(na, sign), b.v_);
  const __m128d p4 = _mm_mul_pd(_mm_xor_pd(ua, sign), b_swapped);
  return Interval(_mm_max_pd(_mm_max_pd(p1, p2), _mm_max_pd(p3, p4)));
}

/// Product with an exact number: one multiplication, and no branch on its sign.
inline Interval operator*(double x, Interval a) {
  const __m128d factor = _mm_set1_pd(x);
  const __m128d negative = _mm_cmplt_pd(factor, _mm_setzero_pd());
  const __m128d magnitude = _mm_andnot_pd(_mm_set1_pd(-0.0), factor);
  const __m128d ends = _mm_or_pd(_mm_and_pd(negative, a.swapped()), _mm_andnot_pd(negative, a.v_));
  return Interval(_mm_mul_pd(magnitude, ends));
}
inline Interval operator*(Interval a, double x) { return x * a; }

/// a * b, with half the multiplications. @pre b.lower() >= 0
inline Interval times_nonnegative(Interval a, Interval b) {
  const __m128d least = _mm_xor_pd(_mm_unpacklo_pd(b.v_, b.v_), _mm_set1_pd(-0.0));
  return Interval(_mm_max_pd(_mm_mul_pd(a.v_, least), _mm_mul_pd(a.v_, b.high())));
}

inline Interval reciprocal(Interval a) {
  if (!(a.lower() > 0 || a.upper() < 0)) Faults<Interval>::raise();
  return Interval(_mm_div_pd(_mm_set_pd(1.0, -1.0), _mm_set_pd(a.lower(), a.upper())));
}

inline Interval sqr(Interval a) {
  const __m128d negated = _mm_xor_pd(a.v_, _mm_set1_pd(-0.0));  // (lower, −upper)
  const __m128d magnitude = _mm_max_pd(a.v_, a.swapped());
  const __m128d mignitude = _mm_max_pd(_mm_max_pd(negated, _mm_shuffle_pd(negated, negated, 1)), _mm_setzero_pd());
  const __m128d sizes = _mm_move_sd(magnitude, mignitude);
  return Interval(_mm_mul_pd(_mm_xor_pd(sizes, _mm_set_pd(0.0, -0.0)), sizes));
}

/// The lower end is the predecessor of the root rounded up, which lies below the root.
inline Interval sqrt(Interval a) {
  if (!(a.lower() >= 0)) Faults<Interval>::raise();
  const __m128d roots = _mm_sqrt_pd(_mm_set_pd(a.upper(), a.lower()));
  const __m128i bits = _mm_castpd_si128(roots);
  const __m128d below = _mm_castsi128_pd(_mm_sub_epi64(bits, _mm_set_epi64x(0, 1)));
  const double lower = a.lower() > 0 ? _mm_cvtsd_f64(below) : 0.0;
  return Interval(lower, _mm_cvtsd_f64(_mm_unpackhi_pd(roots, roots)));
}

inline Interval absolute(Interval x) { return sqrt(sqr(x)); }
/// max(x, y) for every x in a, y in b.
inline Interval larger(Interval a, Interval b) {
  return {std::max(a.lower(), b.lower()), std::max(a.upper(), b.upper())};
}
inline Interval euclidean_norm(Interval x, Interval y, Interval z) { return sqrt(sqr(x) + sqr(y) + sqr(z)); }
[[nodiscard]] SinCos<Interval> sincos(Interval x);
[[nodiscard]] Interval tan(Interval x);
[[nodiscard]] Interval exp(Interval x);
[[nodiscard]] Interval log(Interval x);
/// Principal values; asin and acos raise a fault where a member is beyond [−1, 1].
[[nodiscard]] Interval asin(Interval x);
[[nodiscard]] Interval acos(Interval x);
[[nodiscard]] Interval atan(Interval x);
/// Principal value; a fault where the box (x, y) meets the cut x <= 0, y = 0.
[[nodiscard]] Interval atan2(Interval y, Interval x);
[[nodiscard]] Interval pow_int(Interval x, int n);
inline Interval sin(Interval x) { return sincos(x).sin; }
inline Interval cos(Interval x) { return sincos(x).cos; }

inline double lower_bound(Interval x) { return x.lower(); }
inline double upper_bound(Interval x) { return x.upper(); }
/// Some number inside, near the middle; no claim.
inline double midpoint_approx(Interval x) { return 0.5 * x.lower() + 0.5 * x.upper(); }
/// Upper bound of |x| over the interval.
inline double magnitude(Interval x) { return std::max(-x.lower(), x.upper()); }
inline bool certainly_positive(Interval x) { return x.lower() > 0; }
inline bool certainly_nonpositive(Interval x) { return x.upper() <= 0; }
inline bool contains(Interval x, double value) { return x.lower() <= value && value <= x.upper(); }

template <>
struct ScalarTraits<Interval> {
  static Interval from_decimal(const std::string& text);
  static Interval pi();
};

}  // namespace taut
