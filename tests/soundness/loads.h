// SPDX-License-Identifier: GPL-3.0-or-later
// Load items of the campaign: the extremes of a tension over a sum of items, each attained by a load that is written
// down in full, force by force and lever by lever: vertices of what has vertices, and of balls and discs the direction
// of the gradient and, in 200 bits, the coordinate axes and some directions between. No support functions, no
// derivatives.
#pragma once

#include <algorithm>
#include <array>
#include <optional>
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

/// A set of forces or moments in numbers.
template <class S>
struct SetOfVectors {
  bool is_segment = false;
  std::optional<Vec<S>> normal;  ///< of a disc
  S radius{0.0};                 ///< of a ball or disc
  std::vector<Vec<S>> ends;      ///< of a segment
};

/// An item in numbers: one of these, the others empty.
template <class S>
struct Load {
  Vec<S> at;
  Axes axes = Axes::kWorld;
  std::vector<S> masses;
  SetOfVectors<S> offsets;  ///< of a centre of gravity
  std::optional<SetOfVectors<S>> forces, moments;
  std::vector<std::pair<Vec<S>, Vec<S>>> cases;
};

template <class S>
Vec<S> numbers(const RationalVector& text) {
  return {number<S>(text[0]), number<S>(text[1]), number<S>(text[2])};
}

/// `v`, of length `size` >= 0; 0 for 0.
template <class S>
Vec<S> scaled_to(const S& size, const Vec<S>& v) {
  const S length = root(dot(v, v));
  return length > S(0.0) ? (size / length) * v : S(0.0) * v;
}

template <class S>
SetOfVectors<S> make_set(const VectorSet& set) {
  SetOfVectors<S> result;
  if (const auto* segment = std::get_if<SegmentOfVectors>(&set)) {
    result.is_segment = true;
    const Vec<S> e = scaled_to(S(1.0), numbers<S>(segment->direction));
    for (const RationalText& end : {segment->lower, segment->upper}) result.ends.push_back(number<S>(end) * e);
  } else if (const auto* disc = std::get_if<DiscOfVectors>(&set)) {
    result.radius = number<S>(disc->radius);
    result.normal = numbers<S>(disc->normal);
  } else {
    result.radius = number<S>(std::get<BallOfVectors>(set).radius);
  }
  return result;
}

template <class S>
Load<S> make_load(const LoadItem& item) {
  Load<S> result;
  result.at = {S(0.0), S(0.0), S(0.0)};
  if (const auto* weight = std::get_if<Weight>(&item.what)) {
    result.at = numbers<S>(weight->at);
    result.masses = {number<S>(weight->mass_lower), number<S>(weight->mass_upper)};
    result.offsets.radius = number<S>(weight->at_tolerance);
  } else if (const auto* force = std::get_if<Force>(&item.what)) {
    result.at = numbers<S>(force->at);
    result.axes = force->axes;
    result.forces = make_set<S>(force->set);
  } else if (const auto* moment = std::get_if<Moment>(&item.what)) {
    result.axes = moment->axes;
    result.moments = make_set<S>(moment->set);
  } else {
    const auto& cases = std::get<LoadCases>(item.what);
    result.at = numbers<S>(cases.at);
    result.axes = cases.axes;
    for (const auto& w : cases.wrenches) {
      result.cases.emplace_back(numbers<S>({w[0], w[1], w[2]}), numbers<S>({w[3], w[4], w[5]}));
    }
  }
  return result;
}

/// `visit` for vectors of a set, in the axes in which it is fixed: all vertices, or many directions. `gradient` points
/// to where what is sought grows.
template <class S, class Visit>
void for_each_vector(const SetOfVectors<S>& set, const Vec<S>& gradient, Visit visit) {
  if (set.is_segment) {
    for (const Vec<S>& end : set.ends) visit(end);
    return;
  }
  const auto visit_both = [&](Vec<S> v) {
    if (set.normal) {
      const S whole = dot(v, v);
      v = v - (dot(v, *set.normal) / dot(*set.normal, *set.normal)) * *set.normal;
      if (dot(v, v) < S(1e-20) * whole) v = S(0.0) * v;  // along the normal: what is left is rounding
    }
    v = scaled_to(set.radius, v);
    visit(v);
    visit(S(-1.0) * v);
  };
  visit_both(gradient);
  if constexpr (std::is_same_v<S, double>) return;  // a search, which takes many; the judge looks at more
  // Every axis that (x, y, z) of -1, 0 and 1 gives, once: its opposite is visited with it.
  for (int n = 1; n <= 13; ++n) {
    const int code = 13 + n;  // in base 3: the first digit that is not 1 is 2
    visit_both({S(static_cast<double>(code / 9 - 1)), S(static_cast<double>(code / 3 % 3 - 1)),
                S(static_cast<double>(code % 3 - 1))});
  }
}

/// The extremes of a tension over one item. @param r the platform's rotation, `load_point` p_m
template <class S>
Range<S> extremes(const Load<S>& load, const Vec<S>& gravity, const Rows<S>& r, const Vec<S>& load_point,
                  const TensionOf<S>& tension) {
  const S zero(0.0), one(1.0);
  const Vec<S> none{zero, zero, zero};
  const std::array<Vec<S>, 3> units = {Vec<S>{one, zero, zero}, Vec<S>{zero, one, zero}, Vec<S>{zero, zero, one}};
  std::optional<Range<S>> result;
  const auto include = [&](const S& x) {
    if (!result) result = Range<S>{x, x};
    result->include(x);
  };
  const Vec<S> lever = r * (load.at - load_point);
  const auto along = [&](const Vec<S>& v) { return load.axes == Axes::kPlatform ? r * v : v; };
  const auto try_all = [&](const SetOfVectors<S>& set, const auto& value) {
    Vec<S> gradient;
    for (std::size_t k = 0; k < 3; ++k) gradient[k] = value(along(units[k]));
    for_each_vector(set, gradient, [&](const Vec<S>& v) { include(value(along(v))); });
  };
  if (!load.masses.empty()) {
    Vec<S> gradient;  // of the value by the offset
    for (std::size_t k = 0; k < 3; ++k)
      gradient[k] = tension.force_at(units[k], gravity) - tension.force_at(none, gravity);
    for (const S& mass : load.masses) {
      for_each_vector(load.offsets, gradient,
                      [&](const Vec<S>& offset) { include(tension.force_at(lever + offset, mass * gravity)); });
    }
  } else if (load.forces) {
    try_all(*load.forces, [&](const Vec<S>& v) { return tension.force_at(lever, v); });
  } else if (load.moments) {
    try_all(*load.moments, [&](const Vec<S>& v) { return tension.wrench(none, v); });
  } else {
    for (const auto& [f, m] : load.cases) {
      const Vec<S> force = along(f);
      include(tension.wrench(force, cross(lever, force) + along(m)));
    }
  }
  return *result;
}

}  // namespace taut::campaign
