// SPDX-License-Identifier: GPL-3.0-or-later
// The arithmetic of formal/Certificate.v's checker, in binary64: a quantity q(s) over a box of s with the middle m.
// Nothing is proved with it: Coq computes all of it again.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <optional>
#include <utility>

#include "certify/arithmetic/interval.h"
#include "problem/rational.h"

namespace taut::formal {

/// The balls in which what deviates is: the platform's position, the axis and angle by which it is turned, the load
/// point, and each cable's anchors, at the base and at the platform.
inline constexpr std::size_t kPosition = 0, kTurn = 1, kLoadPoint = 2, kBalls = 15;
constexpr std::size_t base_ball(std::size_t cable) { return 3 + 2 * cable; }
constexpr std::size_t platform_ball(std::size_t cable) { return 4 + 2 * cable; }

/// Slopes along what deviates: a vector for each ball, none for a ball on which a quantity does not depend.
class Slopes {
 public:
  using Block = std::array<Interval, 3>;
  Slopes() = default;
  Slopes(std::size_t ball, const Block& slopes) { blocks_[ball] = slopes; }

  const std::optional<Block>& operator[](std::size_t ball) const { return blocks_[ball]; }

  friend Slopes operator+(Slopes f, const Slopes& g) {
    for (std::size_t ball = 0; ball < kBalls; ++ball) {
      const std::optional<Block>& more = g.blocks_[ball];
      std::optional<Block>& block = f.blocks_[ball];
      if (!more) continue;
      if (!block) block = Block{Interval(0.0), Interval(0.0), Interval(0.0)};
      for (std::size_t i = 0; i < 3; ++i) (*block)[i] += (*more)[i];
    }
    return f;
  }
  friend Slopes operator-(const Slopes& f, const Slopes& g) { return f + -g; }
  friend Slopes operator-(Slopes f) {
    return f.each([](Interval& x) { x = -x; });
  }
  friend Slopes operator*(Slopes f, Interval c) {
    return f.each([&](Interval& x) { x *= c; });
  }
  friend Slopes operator/(Slopes f, Interval c) {
    return f.each([&](Interval& x) { x /= c; });
  }

 private:
  template <class Change>
  const Slopes& each(Change change) {
    for (auto& block : blocks_) {
      if (block) std::ranges::for_each(*block, change);
    }
    return *this;
  }

  std::array<std::optional<Block>, kBalls> blocks_;
};

inline const Slopes::Block kZeros{Interval(0.0), Interval(0.0), Interval(0.0)};

inline Interval symmetric(Interval size) { return {-size.upper(), size.upper()}; }
inline Interval norm(const std::array<Interval, 3>& v) { return sqrt(sqr(v[0]) + sqr(v[1]) + sqr(v[2])); }

/// How far s is from m, and what deviates from what is stated.
struct Reach {
  Interval offset{0.0};
  std::array<Interval, kBalls> radii{};
};

/// q(m) in `mid`; q(m) and q'(s) in `over`, where q' is of a machine that deviates; q'(s) = q(m) + k (s - m) + the sum
/// of k_b · e_b for a k in `slope` and k_b in `slopes`, where e_b is how far it deviates in ball b.
struct Slope {
  Interval mid{0.0}, over{0.0}, slope{0.0};
  Slopes slopes;

  Slope() = default;
  explicit Slope(Interval constant) : mid(constant), over(constant) {}
  Slope(Interval at_middle, Interval anywhere, Interval rate, Slopes others = {})
      : mid(at_middle), over(anywhere), slope(rate), slopes(std::move(others)) {}

  friend Slope operator+(const Slope& f, const Slope& g) {
    return {f.mid + g.mid, f.over + g.over, f.slope + g.slope, f.slopes + g.slopes};
  }
  friend Slope operator-(const Slope& f, const Slope& g) {
    return {f.mid - g.mid, f.over - g.over, f.slope - g.slope, f.slopes - g.slopes};
  }
  friend Slope operator-(const Slope& f) { return {-f.mid, -f.over, -f.slope, -f.slopes}; }
  friend Slope operator*(const Slope& f, const Slope& g) {
    return {f.mid * g.mid, f.over * g.over, f.slope * g.over + f.mid * g.slope, f.slopes * g.over + g.slopes * f.mid};
  }
  friend Slope operator/(const Slope& f, const Slope& g) {
    const Interval mid = f.mid / g.mid;
    return {mid, f.over / g.over, (f.slope - mid * g.slope) / g.over, (f.slopes - g.slopes * mid) / g.over};
  }
  friend Slope sqrt(const Slope& f) {
    const Interval mid = sqrt(f.mid);
    const Interval over = sqrt(f.over);
    return {mid, over, f.slope / (mid + over), f.slopes / (mid + over)};
  }
  friend SinCos<Slope> sincos(const Slope& f) {
    const SinCos<Interval> mid = sincos(f.mid);
    const SinCos<Interval> over = sincos(f.over);
    return {{mid.sin, over.sin, over.cos * f.slope, f.slopes * over.cos},
            {mid.cos, over.cos, -over.sin * f.slope, f.slopes * -over.sin}};
  }
};

/// Narrows `over` by the mean value form.
inline Slope tight(const Slope& f, const Reach& reach) {
  Interval value = f.mid + f.slope * reach.offset;
  for (std::size_t ball = 0; ball < kBalls; ++ball) {
    if (f.slopes[ball]) value += symmetric(norm(*f.slopes[ball]) * reach.radii[ball]);
  }
  return {f.mid, intersect(f.over, value), f.slope, f.slopes};
}

using Vector = std::array<Slope, 3>;

inline Vector operator+(const Vector& u, const Vector& v) { return {u[0] + v[0], u[1] + v[1], u[2] + v[2]}; }
inline Vector operator-(const Vector& u, const Vector& v) { return {u[0] - v[0], u[1] - v[1], u[2] - v[2]}; }
inline Slope dot(const Vector& u, const Vector& v) { return u[0] * v[0] + u[1] * v[1] + u[2] * v[2]; }
inline Vector cross(const Vector& u, const Vector& v) {
  return {u[1] * v[2] - u[2] * v[1], u[2] * v[0] - u[0] * v[2], u[0] * v[1] - u[1] * v[0]};
}
inline Vector tight(Vector v, const Reach& reach) {
  for (Slope& x : v) x = tight(x, reach);
  return v;
}

/// A point somewhere in a ball around `v`.
inline Vector within(std::size_t ball, Interval radius, Vector v) {
  if (radius.upper() == 0) return v;
  for (std::size_t i = 0; i < 3; ++i) {
    Slopes::Block unit = kZeros;
    unit[i] = Interval(1.0);
    v[i] = v[i] + Slope(Interval(0.0), symmetric(radius), Interval(0.0), Slopes(ball, unit));
  }
  return v;
}

/// The image of v under a turn by no more than `angle`, about any axis: v + w × (v + d), where w is along the axis,
/// |w| <= angle and |d| <= angle |v|. @pre v does not deviate
inline Vector turned(Interval angle, const Vector& v) {
  if (angle.upper() == 0) return v;
  const Interval change = symmetric(angle * norm({v[0].over, v[1].over, v[2].over}));
  Vector result;
  for (std::size_t x = 0; x < 3; ++x) {
    const std::size_t y = (x + 1) % 3, z = (x + 2) % 3;
    Slopes::Block block = kZeros;
    block[y] = v[z].over + change;
    block[z] = -(v[y].over + change);
    result[x] = Slope(v[x].mid, v[x].over + change, v[x].slope, Slopes(kTurn, block));
  }
  return result;
}

/// v turned about a unit vector.
inline Vector turned_about(const Vector& axis, const SinCos<Slope>& angle, const Vector& v) {
  const Slope share = (Slope(Interval(1.0)) - angle.cos) * dot(axis, v);
  const Vector across = cross(axis, v);
  Vector result;
  for (std::size_t i = 0; i < 3; ++i) result[i] = angle.cos * v[i] + angle.sin * across[i] + share * axis[i];
  return result;
}

/// Of a linear map. @param images  of the unit vectors
inline Vector image(const std::array<Vector, 3>& images, const Vector& v) {
  Vector result;
  for (std::size_t i = 0; i < 3; ++i) result[i] = v[0] * images[0][i] + v[1] * images[1][i] + v[2] * images[2][i];
  return result;
}

/// Of the unit vector along v.
inline Vector unit_along(const std::array<Interval, 3>& v) {
  const Interval inverse = Interval(1.0) / norm(v);
  return {Slope(inverse * v[0]), Slope(inverse * v[1]), Slope(inverse * v[2])};
}

/// Two units in the last place wide.
inline Interval nearly(const Rational& x) {
  const auto nearest = x.convert_to<double>();
  return nearest == 0 ? Interval(0.0) : Interval(std::nextafter(nearest, -HUGE_VAL), std::nextafter(nearest, HUGE_VAL));
}
inline Interval exact(const RationalText& text) { return from_rational<Interval>(text); }
inline Vector exact(const std::array<RationalText, 3>& text) {
  return {Slope(exact(text[0])), Slope(exact(text[1])), Slope(exact(text[2]))};
}

}  // namespace taut::formal
