// SPDX-License-Identifier: GPL-3.0-or-later
// The arithmetic of formal/Certificate.v's checker, in binary64: a quantity q(s) over a box of s with the middle m.
// Nothing is proved with it: Coq computes all of it again.
#pragma once

#include <array>
#include <cstddef>

#include "certify/arithmetic/interval.h"
#include "problem/rational.h"

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

using Vector = std::array<Slope, 3>;

inline Vector operator+(const Vector& u, const Vector& v) { return {u[0] + v[0], u[1] + v[1], u[2] + v[2]}; }
inline Vector operator-(const Vector& u, const Vector& v) { return {u[0] - v[0], u[1] - v[1], u[2] - v[2]}; }
inline Slope dot(const Vector& u, const Vector& v) { return u[0] * v[0] + u[1] * v[1] + u[2] * v[2]; }
inline Vector cross(const Vector& u, const Vector& v) {
  return {u[1] * v[2] - u[2] * v[1], u[2] * v[0] - u[0] * v[2], u[0] * v[1] - u[1] * v[0]};
}
inline Vector tight(Vector v, Interval t) {
  for (Slope& x : v) x = tight(x, t);
  return v;
}

/// Of a linear map. @param images  of the unit vectors
inline Vector image(const std::array<Vector, 3>& images, const Vector& v) {
  Vector result;
  for (std::size_t i = 0; i < 3; ++i) result[i] = v[0] * images[0][i] + v[1] * images[1][i] + v[2] * images[2][i];
  return result;
}

inline Interval exact(const RationalText& text) { return from_rational<Interval>(text); }
inline Vector exact(const std::array<RationalText, 3>& text) {
  return {Slope(exact(text[0])), Slope(exact(text[1])), Slope(exact(text[2]))};
}

}  // namespace taut::formal
