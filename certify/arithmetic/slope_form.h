// SPDX-License-Identifier: GPL-3.0-or-later
// Centred forms: a function of one variable t over an interval T, enclosed at its midpoint and by its slope.
//
// Claim.  SlopeForm<I>{at_mid, slope, range} stands for a function x, differentiable on T, with
//   x(m) in at_mid,   x(t) in range   and   x(t) − x(m) = σ (t − m) for some σ in slope,   for every t in T,
// m the midpoint of T, and every operation keeps that. So x(t) is in at_mid + slope (t − m): second-order tight, while
// `range` alone is first-order. tighten() intersects the two.
//
// `slope` is not an enclosure of x' over T, though any such will do for it (mean value theorem): slopes from m are
// about half as wide, and between two other points of T the quotient of differences may lie outside. Rules:
// docs/theory.md, "Centred forms".
//
// The prover evaluates pose, rotation and force densities on this scalar; a clearance between bodies or any other
// quantity of the pose would be evaluated on it just the same.
//
// Over a box of several variables, `slope` is a Gradient (gradient.h), one slope a variable: x(t) − x(m) = Σ σ_k
// (t_k − m_k) with σ_k in slope[k]. Every rule is linear in the slopes, so it is the same.
#pragma once

#include <string>

#include "certify/arithmetic/rounding.h"
#include "problem/scalar.h"

namespace taut {

template <class I, class Slope = I>
struct SlopeForm {
  I at_mid;
  Slope slope;
  I range;

  SlopeForm() = default;
  SlopeForm(I mid, Slope slope_over, I range_over)
      : at_mid(std::move(mid)), slope(std::move(slope_over)), range(std::move(range_over)) {}
  /// A constant.
  explicit(false) SlopeForm(const I& constant) : at_mid(constant), slope(0.0), range(constant) {}
  explicit(false) SlopeForm(double constant) : SlopeForm(I(constant)) {}

  friend SlopeForm operator+(const SlopeForm& a, const SlopeForm& b) {
    return {a.at_mid + b.at_mid, a.slope + b.slope, a.range + b.range};
  }
  friend SlopeForm operator-(const SlopeForm& a, const SlopeForm& b) {
    return {a.at_mid - b.at_mid, a.slope - b.slope, a.range - b.range};
  }
  friend SlopeForm operator-(const SlopeForm& a) { return {-a.at_mid, -a.slope, -a.range}; }
  friend SlopeForm operator*(const SlopeForm& a, const SlopeForm& b) {
    return {a.at_mid * b.at_mid, a.slope * b.range + a.at_mid * b.slope, a.range * b.range};
  }
  friend SlopeForm operator/(const SlopeForm& a, const SlopeForm& b) { return a * reciprocal(b); }

  friend SlopeForm operator+(const SlopeForm& a, const I& k) { return {a.at_mid + k, a.slope, a.range + k}; }
  friend SlopeForm operator-(const SlopeForm& a, const I& k) { return {a.at_mid - k, a.slope, a.range - k}; }
  friend SlopeForm operator*(const SlopeForm& a, const I& k) { return {a.at_mid * k, a.slope * k, a.range * k}; }

  friend SlopeForm reciprocal(const SlopeForm& a) {
    const I mid = reciprocal(a.at_mid);
    const I over = reciprocal(a.range);
    return {mid, -(a.slope * (mid * over)), over};
  }
  friend SlopeForm sqr(const SlopeForm& a) { return {sqr(a.at_mid), a.slope * (a.at_mid + a.range), sqr(a.range)}; }
  friend SlopeForm sqrt(const SlopeForm& a) {
    if (!certainly_positive(a.range)) Faults<I>::raise();  // not differentiable at 0
    const I mid = sqrt(a.at_mid);
    const I over = sqrt(a.range);
    return {mid, a.slope / (mid + over), over};
  }
  // These need no derivative: | |a(t)| − |a(m)| | <= |a(t) − a(m)|; and the change of a maximum lies between the least
  // and the greatest change of what it is the maximum of.
  friend SlopeForm absolute(const SlopeForm& a) {
    if (certainly_positive(a.range)) return a;
    if (certainly_positive(-a.range)) return -a;
    return {absolute(a.at_mid), hull(a.slope, -a.slope), absolute(a.range)};
  }
  friend SlopeForm larger(const SlopeForm& a, const SlopeForm& b) {
    return {larger(a.at_mid, b.at_mid), hull(a.slope, b.slope), larger(a.range, b.range)};
  }
  friend SlopeForm euclidean_norm(const SlopeForm& x, const SlopeForm& y, const SlopeForm& z) {
    const I mid = euclidean_norm(x.at_mid, y.at_mid, z.at_mid);
    const I over = euclidean_norm(x.range, y.range, z.range);
    if (certainly_positive(mid + over)) {
      const Slope change =
          x.slope * (x.at_mid + x.range) + y.slope * (y.at_mid + y.range) + z.slope * (z.at_mid + z.range);
      return {mid, change / (mid + over), over};
    }
    const Slope slope = euclidean_norm(x.slope, y.slope, z.slope);
    return {mid, hull(slope, -slope), over};
  }
  /// With x = a(m), h = a(t) − x:  sin(x + h) − sin x = h (cos x sinc h − sin x verc h),
  ///   cos(x + h) − cos x = −h (sin x sinc h + cos x verc h),  where
  ///   sinc h = sin h / h in [1 − h²/6, 1],   verc h = (1 − cos h) / h in h [0, 1/2].
  friend SinCos<SlopeForm> sincos(const SlopeForm& a) {
    constexpr double kNear = 0.5;               // where series are tighter than sines of the ends
    constexpr double kAboveASixth = 11.0 / 64;  // exact
    const SinCos<I> mid = sincos(a.at_mid);
    const I h = hull(a.range - a.at_mid, I(0.0));
    const I square = sqr(h);
    const I sinc = I(1.0) - I(kAboveASixth) * square;
    const I verc = I(0.5) * h;
    I sin_slope = mid.cos * sinc - mid.sin * verc;
    I cos_slope = -(mid.sin * sinc + mid.cos * verc);
    SinCos<I> over;
    if (upper_bound(magnitude(h)) <= kNear) {
      const I cosine = I(1.0) - I(0.5) * square;  // cos h; sin h is in h
      over = {mid.sin * cosine + mid.cos * h, mid.cos * cosine - mid.sin * h};
    } else {
      over = sincos(a.range);
      sin_slope = intersect(sin_slope, over.cos);
      cos_slope = intersect(cos_slope, -over.sin);
    }
    return {{mid.sin, sin_slope * a.slope, over.sin}, {mid.cos, cos_slope * a.slope, over.cos}};
  }
  friend SlopeForm tan(const SlopeForm& a) {
    const SinCos<SlopeForm> sc = sincos(a);
    return sc.sin / sc.cos;
  }
  friend SlopeForm sin(const SlopeForm& a) { return sincos(a).sin; }
  friend SlopeForm cos(const SlopeForm& a) { return sincos(a).cos; }
  friend SlopeForm exp(const SlopeForm& a) {
    const I over = exp(a.range);
    return {exp(a.at_mid), over * a.slope, over};
  }
  friend SlopeForm log(const SlopeForm& a) { return {log(a.at_mid), a.slope / a.range, log(a.range)}; }
  friend SlopeForm asin(const SlopeForm& a) {
    return {asin(a.at_mid), a.slope / cosine_of_asin(a.range), asin(a.range)};
  }
  friend SlopeForm acos(const SlopeForm& a) {
    return {acos(a.at_mid), -(a.slope / cosine_of_asin(a.range)), acos(a.range)};
  }
  friend SlopeForm atan(const SlopeForm& a) {
    return {atan(a.at_mid), a.slope / (I(1.0) + sqr(a.range)), atan(a.range)};
  }
  friend SlopeForm atan2(const SlopeForm& y, const SlopeForm& x) {
    return {atan2(y.at_mid, x.at_mid), (x.range * y.slope - y.range * x.slope) / (sqr(x.range) + sqr(y.range)),
            atan2(y.range, x.range)};
  }
  friend SlopeForm pow_int(const SlopeForm& a, int n) {
    if (n == 0) return SlopeForm(1.0);
    const I derivative = I(static_cast<double>(n)) * pow_int(a.range, n - 1);
    return {pow_int(a.at_mid, n), derivative * a.slope, pow_int(a.range, n)};
  }

  /// Intersects `range` with the mean-value form; `offset` encloses t − m for all t in T (Gradient: t_k − m_k).
  void tighten(const Slope& offset) { range = intersect(range, at_mid + slope * offset); }

 private:
  static I cosine_of_asin(const I& x) { return sqrt((I(1.0) + x) * (I(1.0) - x)); }
};

template <class I, class Slope>
struct ScalarTraits<SlopeForm<I, Slope>> {
  static SlopeForm<I, Slope> from_decimal(const std::string& text) { return ScalarTraits<I>::from_decimal(text); }
  static SlopeForm<I, Slope> pi() { return ScalarTraits<I>::pi(); }
};

}  // namespace taut
