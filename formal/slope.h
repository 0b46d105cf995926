// SPDX-License-Identifier: GPL-3.0-or-later
// The arithmetic of formal/Certificate.v's checker, in binary64: a quantity q(s) over a box of s with the middle m.
// Nothing is proved with it: Coq computes all of it again.
#pragma once

#include "certify/arithmetic/interval.h"

namespace taut::formal {

/// q(m) in `mid`; q(m) and q(s) in `over`; q(s) = q(m) + k (s - m) for a k in `slope`.
struct Slope {
  Interval mid{0.0}, over{0.0}, slope{0.0};

  Slope() = default;
  explicit Slope(Interval constant) : mid(constant), over(constant) {}
  Slope(Interval at_middle, Interval anywhere, Interval rate) : mid(at_middle), over(anywhere), slope(rate) {}

  friend Slope operator+(const Slope& f, const Slope& g) { return {f.mid + g.mid, f.over + g.over, f.slope + g.slope}; }
  friend Slope operator-(const Slope& f, const Slope& g) { return {f.mid - g.mid, f.over - g.over, f.slope - g.slope}; }
  friend Slope operator-(const Slope& f) { return {-f.mid, -f.over, -f.slope}; }
  friend Slope operator*(const Slope& f, const Slope& g) {
    return {f.mid * g.mid, f.over * g.over, f.slope * g.over + f.mid * g.slope};
  }
  friend Slope operator/(const Slope& f, const Slope& g) {
    return {f.mid / g.mid, f.over / g.over, (f.slope - f.mid / g.mid * g.slope) / g.over};
  }
  friend Slope sqrt(const Slope& f) {
    const Interval mid = sqrt(f.mid);
    const Interval over = sqrt(f.over);
    return {mid, over, f.slope / (mid + over)};
  }
  friend SinCos<Slope> sincos(const Slope& f) {
    const SinCos<Interval> mid = sincos(f.mid);
    const SinCos<Interval> over = sincos(f.over);
    return {{mid.sin, over.sin, over.cos * f.slope}, {mid.cos, over.cos, -over.sin * f.slope}};
  }
};

/// Narrows `over` by the mean value form. @param t  s - m over the box
inline Slope tight(const Slope& f, Interval t) { return {f.mid, intersect(f.over, f.mid + f.slope * t), f.slope}; }

}  // namespace taut::formal
