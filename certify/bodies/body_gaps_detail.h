// SPDX-License-Identifier: GPL-3.0-or-later
// Small parts of body_gaps.cc and mesh_gaps.cc.
#pragma once

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

/// The second body of a pair that is a hull.
template <class I>
const ConvexBody<I>& second_hull(const BodyModel<I>& bodies, const CheckedPair<I>& pair) {
  return is_of_obstacle(pair) ? std::get<ConvexBody<I>>(bodies.obstacles[pair.second]) : bodies.platform[pair.second];
}

}  // namespace taut::body_gaps_detail
