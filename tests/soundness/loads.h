// SPDX-License-Identifier: GPL-3.0-or-later
// Load items of the campaign: the extremes of a tension over a sum of items, each attained by a load that is written
// down in full, force by force and lever by lever: vertices of what has vertices, and of balls and discs the direction
// of the gradient and, in 200 bits, the coordinate axes and some directions between. No support functions, no
// derivatives.
#pragma once

#include <algorithm>
#include <array>
#include <utility>
#include <vector>

#include "tests/soundness/vectors.h"

namespace taut::campaign {

template <class S>
struct Range {
  S low, high;
  void include(const S& x) {
    if (x < low) low = x;
    if (x > high) high = x;
  }
};

/// The tension of one cable that a wrench about P_m makes: y w.
template <class S>
struct TensionOf {
  const Six<S>& y;

  [[nodiscard]] S wrench(const Vec<S>& force, const Vec<S>& moment) const {
    return y[0] * force[0] + y[1] * force[1] + y[2] * force[2] + y[3] * moment[0] + y[4] * moment[1] + y[5] * moment[2];
  }
  [[nodiscard]] S force_at(const Vec<S>& lever, const Vec<S>& force) const {
    return wrench(force, cross(lever, force));
  }
};

template <class S>
Vec<S> numbers(const RationalVector& text) {
  return {number<S>(text[0]), number<S>(text[1]), number<S>(text[2])};
}

/// `visit` for vectors of a set, in the axes in which it is fixed: all vertices, or many directions. `gradient` points to
/// where what is sought grows.
template <class S, class Visit>
void for_each_vector(const VectorSet& set, const Vec<S>& gradient, Visit visit) {
  const auto scaled_to = [](const S& size, const Vec<S>& v) {
    const S length = root(dot(v, v));
    return length > S(0.0) ? (size / length) * v : S(0.0) * v;
  };
  if (const auto* segment = std::get_if<SegmentOfVectors>(&set)) {
    const Vec<S> e = numbers<S>(segment->direction);
    for (const RationalText& end : {segment->lower, segment->upper}) {
      const S amount = number<S>(end);
      visit(amount < S(0.0) ? scaled_to(-amount, S(-1.0) * e) : scaled_to(amount, e));
    }
    return;
  }
  const auto* disc = std::get_if<DiscOfVectors>(&set);
  const S radius = number<S>(disc != nullptr ? disc->radius : std::get<BallOfVectors>(set).radius);
  const auto inside = [&](Vec<S> v) {
    if (disc != nullptr) {
      const Vec<S> n = numbers<S>(disc->normal);
      const S whole = dot(v, v);
      v = v - (dot(v, n) / dot(n, n)) * n;
      if (dot(v, v) < S(1e-20) * whole) v = S(0.0) * v;  // along the normal: what is left is rounding
    }
    return scaled_to(radius, v);
  };
  std::vector<Vec<S>> directions = {gradient};
  if constexpr (std::is_same_v<S, double>) {  // a search, which takes many; the judge looks at more
    visit(inside(gradient));
    visit(S(-1.0) * inside(gradient));
    return;
  }
  for (const double x : {-1.0, 0.0, 1.0}) {
    for (const double y : {-1.0, 0.0, 1.0}) {
      for (const double z : {-1.0, 0.0, 1.0}) directions.push_back({S(x), S(y), S(z)});
    }
  }
  for (const Vec<S>& direction : directions) {
    visit(inside(direction));
    visit(S(-1.0) * inside(direction));
  }
}

/// The extremes of a tension over one item. @param r the platform's rotation, `load_point` p_m
template <class S>
Range<S> extremes(const LoadItem& item, const Vec<S>& gravity, const Rows<S>& r, const Vec<S>& load_point,
                  const TensionOf<S>& tension) {
  const S zero(0.0), one(1.0);
  std::vector<S> values;
  const auto lever = [&](const RationalVector& at) { return r * (numbers<S>(at) - load_point); };
  const auto along = [&](Axes axes, const Vec<S>& v) { return axes == Axes::kPlatform ? r * v : v; };
  const std::array<Vec<S>, 3> units = {Vec<S>{one, zero, zero}, Vec<S>{zero, one, zero}, Vec<S>{zero, zero, one}};
  const auto try_all = [&](const VectorSet& set, Axes axes, const auto& value) {
    Vec<S> gradient;
    for (std::size_t k = 0; k < 3; ++k) gradient[k] = value(along(axes, units[k]));
    for_each_vector(set, gradient, [&](const Vec<S>& v) { values.push_back(value(along(axes, v))); });
  };
  if (const auto* weight = std::get_if<Weight>(&item.what)) {
    const S reach = number<S>(weight->at_tolerance);
    const Vec<S> at = lever(weight->at);
    Vec<S> gradient;  // of the value by the offset
    for (std::size_t k = 0; k < 3; ++k) {
      gradient[k] = tension.force_at(units[k], gravity) - tension.force_at({zero, zero, zero}, gravity);
    }
    for (const RationalText& mass : {weight->mass_lower, weight->mass_upper}) {
      for_each_vector<S>(BallOfVectors{weight->at_tolerance}, gradient, [&](const Vec<S>& offset) {
        values.push_back(tension.force_at(at + (reach > zero ? offset : zero * offset), number<S>(mass) * gravity));
      });
    }
  } else if (const auto* force = std::get_if<Force>(&item.what)) {
    const Vec<S> at = lever(force->at);
    try_all(force->set, force->axes, [&](const Vec<S>& v) { return tension.force_at(at, v); });
  } else if (const auto* moment = std::get_if<Moment>(&item.what)) {
    try_all(moment->set, moment->axes, [&](const Vec<S>& v) { return tension.wrench({zero, zero, zero}, v); });
  } else {
    const auto& cases = std::get<LoadCases>(item.what);
    const Vec<S> at = lever(cases.at);
    for (const auto& w : cases.wrenches) {
      const Vec<S> f = along(cases.axes, numbers<S>({w[0], w[1], w[2]}));
      const Vec<S> m = along(cases.axes, numbers<S>({w[3], w[4], w[5]}));
      values.push_back(tension.wrench(f, cross(at, f) + m));
    }
  }
  Range<S> result{values.front(), values.front()};
  for (const S& value : values) result.include(value);
  return result;
}

}  // namespace taut::campaign
