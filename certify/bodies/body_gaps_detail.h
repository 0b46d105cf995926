// SPDX-License-Identifier: GPL-3.0-or-later
// Small parts of body_gaps.cc and mesh_gaps.cc.
#pragma once

#include <stdexcept>

#include "certify/bodies/body_gaps.h"

namespace taut::body_gaps_detail {

template <class I>
UpperOf<I> above(const I& x) {
  return UpperOf<I>(magnitude(x));
}

template <class I>
UpperOf<I> norm_above(const Vector3<I>& x) {
  const UpperOf<I> a = above(x(0)), b = above(x(1)), c = above(x(2));
  return ProofScalarTraits<I>::root(a * a + b * b + c * c);
}

template <class I, class Slope>
SlopeForm<I, Slope> lesser(const SlopeForm<I, Slope>& a, const SlopeForm<I, Slope>& b) {
  return -larger(-a, -b);
}

template <class I>
I lesser(const I& a, const I& b) {
  return -larger(-a, -b);
}

/// The constant x·y.
template <class I>
I dot(const std::array<I, 3>& x, const Vector3<I>& y) {
  return x[0] * y(0) + x[1] * y(1) + x[2] * y(2);
}

/// A product with an exact number, or with another.
inline Interval times(double x, const Interval& y) { return x * y; }
template <class I>
I times(double x, const I& y) {
  return I(x) * y;
}
template <class I>
I times(const I& x, const I& y) {
  return x * y;
}

/// x * y, quickly where all of y has one sign.
inline Interval times_of_sign(const Interval& x, const Interval& y) {
  if (y.lower() >= 0) return times_nonnegative(x, y);
  if (y.upper() <= 0) return -times_nonnegative(x, -y);
  return x * y;
}
template <class I>
I times_of_sign(const I& x, const I& y) {
  return x * y;
}

template <class I>
I dot(const std::array<double, 3>& x, const Vector3<I>& y) {
  return times(x[0], y(0)) + times(x[1], y(1)) + times(x[2], y(2));
}

template <class I, class Slope>
SlopeForm<I, Slope> dot(const std::array<SlopeForm<I, Slope>, 3>& x, const Vector3<I>& y) {
  return x[0] * y(0) + x[1] * y(1) + x[2] * y(2);
}

template <class I>
bool is_of_obstacle(const CheckedPair<I>& pair) {
  return pair.kind == PairClass::kPlatformObstacles || pair.kind == PairClass::kCablesObstacles;
}

template <class I>
const HalfSpace<I>* half_space(const BodyModel<I>& bodies, const CheckedPair<I>& pair) {
  return is_of_obstacle(pair) ? std::get_if<HalfSpace<I>>(&bodies.obstacles[pair.second]) : nullptr;
}

inline std::array<double, 3> components(const Direction& direction) {
  return {static_cast<double>(direction.u[0]), static_cast<double>(direction.u[1]),
          static_cast<double>(direction.u[2])};
}

template <class I>
I norm_of(const std::array<I, 3>& u) {
  return euclidean_norm(u[0], u[1], u[2]);
}
/// Of components of a direction: their squares are exact, and so is the sum.
template <class I>
I norm_of(const std::array<double, 3>& u) {
  return sqrt(I(u[0] * u[0] + u[1] * u[1] + u[2] * u[2]));
}

/// @throws std::logic_error for a cable and the platform in W, where the platform's points do not stand still
template <class I>
void check_axes(const CheckedPair<I>& pair, const Direction& direction) {
  if (pair.kind == PairClass::kCablesPlatform && !direction.in_platform) {
    throw std::logic_error("a cable and the platform are compared in the platform's axes");
  }
}

/// Contains the body's points.
template <class I>
Vector3<I> box_around(const ConvexBody<I>& body) {
  Vector3<I> result;
  for (int k = 0; k < 3; ++k) result(k) = hull(body.lowest(k), body.highest(k));
  return result;
}

/// The second body of a pair that is a hull.
template <class I>
const ConvexBody<I>& second_hull(const BodyModel<I>& bodies, const CheckedPair<I>& pair) {
  return is_of_obstacle(pair) ? std::get<ConvexBody<I>>(bodies.obstacles[pair.second]) : bodies.platform[pair.second];
}

}  // namespace taut::body_gaps_detail
