// SPDX-License-Identifier: GPL-3.0-or-later
#include "formal/load.h"

#include <cmath>

namespace taut::formal {

Load::Along Load::along(const RationalVector& direction, const RationalText& lower, const RationalText& upper) {
  const Interval half(0.5);
  return {exact(direction), (exact(lower) + exact(upper)) * half, (exact(upper) - exact(lower)) * half};
}

Load::Set Load::set(const VectorSet& stated) {
  if (const auto* ball = std::get_if<BallOfVectors>(&stated)) return Ball{exact(ball->radius)};
  if (const auto* disc = std::get_if<DiscOfVectors>(&stated)) return Disc{exact(disc->radius), exact(disc->normal)};
  const auto& segment = std::get<SegmentOfVectors>(stated);
  return along(segment.direction, segment.lower, segment.upper);
}

Load::Item Load::item(const LoadItem& stated, const LoadText& load, Interval load_point_tolerance) {
  const Vector load_point = exact(load.point_m);
  const auto from_load_point = [&](const RationalVector& at) {
    return exact(at) - within(kLoadPoint, load_point_tolerance, load_point);
  };
  if (const auto* weight = std::get_if<Weight>(&stated.what)) {
    return Mass{along(load.gravity_m_s2, weight->mass_lower, weight->mass_upper), from_load_point(weight->at),
                exact(weight->at_tolerance)};
  }
  if (const auto* force = std::get_if<Force>(&stated.what)) {
    return Applied{set(force->set), force->axes, from_load_point(force->at)};
  }
  if (const auto* moment = std::get_if<Moment>(&stated.what)) {
    return Applied{set(moment->set), moment->axes, std::nullopt};
  }
  const auto& cases = std::get<LoadCases>(stated.what);
  Cases result{{}, cases.axes, from_load_point(cases.at)};
  for (const auto& w : cases.wrenches) {
    std::array<Vector, 2> wrench = {exact({w[0], w[1], w[2]}), exact({w[3], w[4], w[5]})};
    if (!result.wrenches.empty()) {
      wrench = {wrench[0] - result.wrenches[0][0], wrench[1] - result.wrenches[0][1]};
    }
    result.wrenches.push_back(wrench);
  }
  return result;
}

std::vector<Load::Square> Load::squares(const EllipsoidText& matrix) {
  std::array<std::array<Rational, 6>, 6> rest;
  for (std::size_t i = 0; i < 6; ++i) {
    for (std::size_t j = 0; j < 6; ++j) rest[i][j] = parse_rational(matrix[i][j]);
  }
  std::vector<Square> result;
  for (std::size_t k = 0; k < 6; ++k) {
    Square square{nearly(rest[k][k]), {}};
    for (std::size_t j = k + 1; j < 6; ++j) square.others.push_back(nearly(rest[k][j] / rest[k][k]));
    for (std::size_t i = k + 1; i < 6; ++i) {
      const Rational share = rest[k][i] / rest[k][k];
      for (std::size_t j = k + 1; j < 6; ++j) rest[i][j] -= share * rest[k][j];
    }
    result.push_back(std::move(square));
  }
  return result;
}

Load::Load(const LoadText& load, const TolerancesText& tolerances) {
  if (load.ellipsoid) {
    Ellipsoid ellipsoid;
    for (std::size_t i = 0; i < 6; ++i) {
      ellipsoid.center[i] = exact(load.wrench[i]);
      ellipsoid.shift[i] = exact(tolerances.wrench[i]);
    }
    ellipsoid.squares = squares(*load.ellipsoid);
    items_.emplace_back(ellipsoid);
  }
  for (const LoadItem& stated : load.items) items_.push_back(item(stated, load, exact(tolerances.load_point_m)));
}

/// What is computed of one row in one box.
class Load::Row {
 public:
  Row(const std::array<Interval, 6>& y, const std::array<Vector, 3>& turn, const Reach& reach)
      : y_(y),
        turn_(turn),
        reach_(reach),
        forces_{Slope(y[0]), Slope(y[1]), Slope(y[2])},
        moments_{Slope(y[3]), Slope(y[4]), Slope(y[5])} {}

  Part operator()(const Ellipsoid& ellipsoid) const {
    Interval center(0.0), shift(0.0), square(0.0);
    std::array<Interval, 6> rest = y_;
    for (std::size_t k = 0; k < 6; ++k) {
      center += y_[k] * ellipsoid.center[k];
      shift += y_[k] * ellipsoid.shift[k];
      square += sqr(rest[k]) / ellipsoid.squares[k].scale;
      for (std::size_t j = k + 1; j < 6; ++j) rest[j] -= rest[k] * ellipsoid.squares[k].others[j - k - 1];
    }
    return {Slope(center), symmetric(Interval(magnitude(shift)) + sqrt(square))};
  }
  Part operator()(const Mass& mass) const {
    const Part exactly = multiples(mass.range, dot(covector(mass.point), mass.range.direction));
    const Interval most = Interval(magnitude(mass.range.middle)) + mass.range.half;
    return {exactly.form,
            symmetric(exactly.others + most * mass.tolerance * size(cross(mass.range.direction, moments_)))};
  }
  Part operator()(const Applied& applied) const {
    const Vector h = seen(applied.axes, applied.point ? covector(*applied.point) : moments_);
    if (const auto* ball = std::get_if<Ball>(&applied.set)) return {Slope(), symmetric(ball->radius * size(h))};
    if (const auto* disc = std::get_if<Disc>(&applied.set)) {
      return {Slope(), symmetric(disc->radius * size(cross(disc->normal, h)) / size(disc->normal))};
    }
    const auto& along = std::get<Along>(applied.set);
    const Part part = multiples(along, dot(h, along.direction) / Slope(size(along.direction)));
    return {part.form, symmetric(part.others)};
  }
  Part operator()(const Cases& cases) const {
    const Vector h = seen(cases.axes, covector(cases.point)), k = seen(cases.axes, moments_);
    const auto made_of = [&](const std::array<Vector, 2>& w) { return dot(h, w[0]) + dot(k, w[1]); };
    Part result{made_of(cases.wrenches.front())};
    for (std::size_t n = 1; n < cases.wrenches.size(); ++n) {
      result.others = hull(result.others, range(made_of(cases.wrenches[n])));
    }
    return result;
  }

 private:
  [[nodiscard]] Interval range(const Slope& f) const { return tight(f, reach_).over; }
  [[nodiscard]] Interval size(const Vector& v) const { return norm({range(v[0]), range(v[1]), range(v[2])}); }
  [[nodiscard]] Part multiples(const Along& range_of, const Slope& f) const {
    return {Slope(range_of.middle) * f, range_of.half * Interval(0.0, magnitude(range(f)))};
  }
  [[nodiscard]] Vector covector(const Vector& point) const {
    return forces_ + cross(moments_, tight(image(turn_, point), reach_));
  }
  [[nodiscard]] Vector seen(Axes axes, const Vector& h) const {
    return axes == Axes::kWorld ? h : Vector{dot(turn_[0], h), dot(turn_[1], h), dot(turn_[2], h)};
  }

  const std::array<Interval, 6>& y_;
  const std::array<Vector, 3>& turn_;
  const Reach& reach_;
  Vector forces_, moments_;
};

Part Load::part(const std::array<Interval, 6>& y, const std::array<Vector, 3>& turn, const Reach& reach) const {
  const Row row(y, turn, reach);
  Part sum;
  for (const Item& item : items_) {
    const Part part = std::visit(row, item);
    sum = {sum.form + part.form, sum.others + part.others};
  }
  return sum;
}

}  // namespace taut::formal
