// SPDX-License-Identifier: GPL-3.0-or-later
#include "certify/loads/item_rows.h"

#include <algorithm>
#include <cmath>

namespace taut {

namespace {

// ---- From intervals -------------------------------------------------------------------------------------------------

/// A bound of |x − mid|.
double half_width(const Interval& x, double mid) { return std::max(x.upper() - mid, mid - x.lower()); }

KnownNumber known(const Interval& x) {
  const double mid = midpoint_approx(x);
  return {mid, half_width(x, mid), magnitude(x)};
}

KnownVector known(const Vector3<Interval>& v) {
  KnownVector result;
  std::array<double, 3> errors;
  for (std::size_t k = 0; k < 3; ++k) {
    const Interval& x = v(static_cast<int>(k));
    result.mid[k] = midpoint_approx(x);
    errors[k] = half_width(x, result.mid[k]);
  }
  result.error = size_of(errors) + kUnderflow;
  result.size = size_of(result.mid);
  return result;
}

bool is_zero(const Vector3<Interval>& v) { return magnitude(v(0)) + magnitude(v(1)) + magnitude(v(2)) == 0; }

/// R v.
VectorForm<double> turned(const RotationForm& r, const KnownVector& v) {
  std::array<double, 3> mid, slope;
  for (std::size_t i = 0; i < 3; ++i) {
    mid[i] = dot(r.mid[i], v.mid);
    slope[i] = dot(r.slope[i], v.mid);
  }
  ProductBounds<double> bounds = product_bounds(r, v);
  bounds.mid_size = size_of(mid) + kUnderflow;
  bounds.slope_size = size_of(slope) + kUnderflow;
  return vector_form(mid, slope, bounds);
}

SlopeForm<Interval> slope_form(double mid_below, double mid_above, double slope_below, double slope_above,
                               double radius) {
  const double change = radius * std::max(slope_below, slope_above);
  return {{-mid_below, mid_above}, {-slope_below, slope_above}, {-(mid_below + change), mid_above + change}};
}

}  // namespace

// ---- Rows times wrenches --------------------------------------------------------------------------------------------

std::array<SlopeForm<Interval>, kCables> times(const RowForms& rows, const NominalForm& w) {
  const NumberForm<Six> x = dot(rows.force, w.force, rows.radius) + dot(rows.moment, w.moment, rows.radius);
  const auto mid_below = (x.mid_error - x.mid).values(), mid_above = (x.mid_error + x.mid).values();
  const auto slope_below = (x.slope_error - x.slope).values(), slope_above = (x.slope_error + x.slope).values();
  std::array<SlopeForm<Interval>, kCables> result;
  for (std::size_t i = 0; i < kCables; ++i) {
    result[i] = slope_form(mid_below[i], mid_above[i], slope_below[i], slope_above[i], rows.radius);
  }
  return result;
}

// ---- Items ----------------------------------------------------------------------------------------------------------

/// Σ below and Σ above along mid + slope (t − m): at the start of the box, its midpoint and its end.
class ItemRows::Sum {
 public:
  using Triple = std::array<Six, 3>;

  explicit Sum(double radius) : radius_(radius) {
    for (auto* side : {&below_, &above_}) side->fill(Six(0.0));
  }

  [[nodiscard]] Six reach(const auto& v) const { return v.mid_size + Six(radius_) * v.slope_size; }
  [[nodiscard]] Triple values(const NumberForm<Six>& v) const {
    const Six change = Six(radius_) * v.slope;
    return {v.mid - change, v.mid, v.mid + change};
  }
  [[nodiscard]] Triple norms(const VectorForm<Six>& v) const {
    std::array<Six, 3> before, after;
    for (std::size_t k = 0; k < 3; ++k) {
      const Six change = Six(radius_) * v.slope[k];
      before[k] = v.mid[k] - change;
      after[k] = v.mid[k] + change;
    }
    return {size_of(before), size_of(v.mid), size_of(after)};
  }

  /// @param size  a bound of all that is summed up for these values: they are off by few roundings of it
  void add(const Triple& below, const Triple& above, const Six& size, const Six& error, const Six& slope_error) {
    for (std::size_t k = 0; k < 3; ++k) {
      below_[k] += below[k];
      above_[k] += above[k];
    }
    size_ += size;
    error_ += error + Six(kRounding) * size;
    slope_error_ += slope_error;
    rounding_ += 0x1p-52;
  }
  /// f |v|
  void add_norm(const VectorForm<Six>& v, const KnownNumber& f) {
    Triple size = norms(v);
    for (Six& x : size) x = Six(f.mid) * x;
    const Six most = reach(v);
    add(size, size, Six(f.upper) * most, Six(f.upper) * v.mid_error + Six(f.error) * most,
        Six(f.upper) * v.slope_error);
  }

  [[nodiscard]] Reach forms() const { return {forms(below_), forms(above_)}; }

 private:
  [[nodiscard]] Forms forms(const Triple& sum) const {
    const Six error = error_ + Six(rounding_) * size_;
    const Six radius(radius_);
    const auto mid_below = (error - sum[1]).values(), mid_above = (error + sum[1]).values();
    const auto slope_below = (((sum[0] - sum[1]) + Six(2.0) * error) / radius + slope_error_).values();
    const auto slope_above = (((sum[2] - sum[1]) + Six(2.0) * error) / radius + slope_error_).values();
    Forms result;
    for (std::size_t i = 0; i < kCables; ++i) {
      result[i] = slope_form(mid_below[i], mid_above[i], slope_below[i], slope_above[i], radius_);
    }
    return result;
  }

  double radius_;
  Triple below_, above_;
  Six size_ = Six(0.0), error_ = Six(kUnderflow), slope_error_ = Six(0.0);
  double rounding_ = 0;  ///< of the sums, in parts of `size_`
};

namespace {

Vector3<Interval> zero() { return {Interval(0.0), Interval(0.0), Interval(0.0)}; }
Vector3<Interval> force_of(const Vector6<Interval>& w) { return {w(0), w(1), w(2)}; }
Vector3<Interval> moment_of(const Vector6<Interval>& w) { return {w(3), w(4), w(5)}; }
Vector3<Interval> multiple(const Vector3<Interval>& v, const Interval& k) { return {v(0) * k, v(1) * k, v(2) * k}; }
Vector3<Interval> plus(const Vector3<Interval>& a, const Vector3<Interval>& b) {
  return {a(0) + b(0), a(1) + b(1), a(2) + b(2)};
}
bool are_same(const Vector3<Interval>& a, const Vector3<Interval>& b) {
  return std::ranges::equal(
      a, b, [](const Interval& x, const Interval& y) { return x.lower() == y.lower() && x.upper() == y.upper(); });
}

}  // namespace

/// Sums up the nominal wrenches: those of W and of P about P_m; and Σ M c of the weights, whose γ is one.
struct ItemRows::NominalSum {
  std::array<Vector3<Interval>, 2> fixed{zero(), zero()}, turning{zero(), zero()};
  Vector3<Interval> gravity = zero(), first_moment = zero();
  std::vector<ForceAtPoint> at_points;

  void add_weight(const Model::Item& item) {
    gravity = item.direction;
    fixed[0] = plus(fixed[0], multiple(item.direction, item.nominal));
    first_moment = plus(first_moment, multiple(item.lever, item.nominal));
  }
  void add(const Model::Item& item, const Vector3<Interval>& force, const Vector3<Interval>& moment) {
    const bool turns = item.axes == Axes::kPlatform;
    auto& to = turns ? turning : fixed;
    to[0] = plus(to[0], force);
    to[1] = plus(to[1], moment);
    if (is_zero(force) || is_zero(item.lever)) return;
    if (turns) {
      to[1] = plus(to[1], loads_detail::cross(item.lever, force));
    } else {
      at_points.push_back({known(item.lever), known(force)});
    }
  }
  void add(const Model::Item& item) {
    if (item.kind == Model::Kind::kWeight) {
      add_weight(item);
    } else if (item.kind == Model::Kind::kCases) {
      add(item, force_of(item.mean), moment_of(item.mean));
    } else if (item.shape == Model::Shape::kSegment) {
      const Vector3<Interval> nominal = multiple(item.direction, item.nominal);
      if (item.kind == Model::Kind::kForce) {
        add(item, nominal, zero());
      } else {
        add(item, zero(), nominal);
      }
    }
  }
};

ItemRows::Item ItemRows::packed(const Model::Item& item) {
  Item result;
  result.kind = item.kind;
  result.shape = item.shape;
  result.turns = item.axes == Axes::kPlatform;
  result.varies = item.varies;
  result.swings = item.swings;
  if (item.kind == Model::Kind::kCases) {
    for (const Vector6<Interval>& w : item.deviations) {
      Vector3<Interval> moment = moment_of(w);
      if (result.turns) moment = plus(moment, loads_detail::cross(item.lever, force_of(w)));
      result.deviations.push_back({known(force_of(w)), known(moment)});
    }
    return result;
  }
  result.direction = known(item.direction);
  result.moment = known(Vector3<Interval>(loads_detail::cross(item.lever, item.direction)));
  result.nominal = known(item.nominal);
  result.offset = known(item.offset);
  result.radius = known(item.radius);
  result.reach = known(item.reach);
  return result;
}

ItemRows::ItemRows(const LoadModel<Interval>& model) {
  using Kind = Model::Kind;
  NominalSum nominal;
  std::vector<Vector3<Interval>> levers;
  for (const Model::Item& item : model.items) {
    nominal.add(item);
    if (item.kind == Kind::kCases) has_cases_ = true;
    if (item.kind == Kind::kWeight && !item.varies && !item.swings) continue;
    const bool turns_with_its_point = item.axes == Axes::kPlatform && item.shape == Model::Shape::kSegment;
    const bool needs_point = item.kind == Kind::kWeight  ? item.varies
                             : item.kind == Kind::kCases ? item.axes == Axes::kWorld
                                                         : item.kind == Kind::kForce && !turns_with_its_point;
    if (!needs_point) {
      elsewhere_.push_back(packed(item));
      continue;
    }
    const auto same = std::ranges::find_if(levers, [&](const auto& lever) { return are_same(lever, item.lever); });
    const auto place = static_cast<std::size_t>(same - levers.begin());
    if (same == levers.end()) {
      levers.push_back(item.lever);
      points_.push_back({is_zero(item.lever) ? std::nullopt : std::optional(known(item.lever)), {}});
    }
    points_[place].items.push_back(packed(item));
  }
  if (!is_zero(nominal.first_moment)) {
    nominal.at_points.push_back({known(nominal.first_moment), known(nominal.gravity)});
  }
  nominal_at_points_ = nominal.at_points;
  fixed_nominal_ = {known(nominal.fixed[0]), known(nominal.fixed[1])};
  turning_nominal_ = {known(nominal.turning[0]), known(nominal.turning[1])};
}

RotationForm ItemRows::rotation(const Matrix3<SlopeForm<Interval>>& r_WP) {
  RotationForm result;
  double mid_error = 0, slope_error = 0, mid_size = 0, slope_size = 0;
  for (std::size_t i = 0; i < 3; ++i) {
    for (std::size_t j = 0; j < 3; ++j) {
      const SlopeForm<Interval>& entry = r_WP(static_cast<int>(i), static_cast<int>(j));
      const double mid = result.mid[i][j] = midpoint_approx(entry.at_mid);
      const double slope = result.slope[i][j] = midpoint_approx(entry.slope);
      const double of_mid = half_width(entry.at_mid, mid), of_slope = half_width(entry.slope, slope);
      mid_error += of_mid * of_mid;
      slope_error += of_slope * of_slope;
      mid_size += mid * mid;
      slope_size += slope * slope;
    }
  }
  result.mid_error = std::sqrt(mid_error) + kUnderflow;
  result.slope_error = std::sqrt(slope_error) + kUnderflow;
  result.mid_size = std::sqrt(mid_size) + kUnderflow;
  result.slope_size = std::sqrt(slope_size) + kUnderflow;
  return result;
}

RotationForm ItemRows::rotation(const Matrix3<Interval>& r_WP) {
  RotationForm result;
  double error = 0, size = 0;
  for (std::size_t i = 0; i < 3; ++i) {
    for (std::size_t j = 0; j < 3; ++j) {
      const Interval& entry = r_WP(static_cast<int>(i), static_cast<int>(j));
      const double mid = result.mid[i][j] = midpoint_approx(entry);
      const double off = half_width(entry, mid);
      error += off * off;
      size += mid * mid;
      result.slope[i][j] = 0;
    }
  }
  result.mid_error = std::sqrt(error) + kUnderflow;
  result.mid_size = std::sqrt(size) + kUnderflow;
  result.slope_error = result.slope_size = 0;
  return result;
}

Vector6<Interval> ItemRows::nominal_wrench(const Matrix3<Interval>& r_WP) const {
  const auto interval = [](const KnownVector& v) {
    const auto entry = [&](std::size_t k) { return Interval(-(v.error - v.mid[k]), v.mid[k] + v.error); };
    return Vector3<Interval>(entry(0), entry(1), entry(2));
  };
  const auto in_world = [&](const KnownVector& v) { return loads_detail::turned(r_WP, interval(v)); };
  const Vector3<Interval> force = plus(interval(fixed_nominal_[0]), in_world(turning_nominal_[0]));
  Vector3<Interval> moment = plus(interval(fixed_nominal_[1]), in_world(turning_nominal_[1]));
  for (const ForceAtPoint& at : nominal_at_points_) {
    moment = plus(moment, loads_detail::cross(in_world(at.lever), interval(at.force)));
  }
  return {force(0), force(1), force(2), moment(0), moment(1), moment(2)};
}

NominalForm ItemRows::nominal(const RotationForm& rotation) const {
  NominalForm w{constant(fixed_nominal_[0]), constant(fixed_nominal_[1])};
  if (turning_nominal_[0].size > 0) w.force = w.force + turned(rotation, turning_nominal_[0]);
  if (turning_nominal_[1].size > 0) w.moment = w.moment + turned(rotation, turning_nominal_[1]);
  for (const ForceAtPoint& at : nominal_at_points_) w.moment = w.moment + cross(turned(rotation, at.lever), at.force);
  return w;
}

namespace {

/// For |x| + |y|.
KnownNumber both(const KnownNumber& x, const KnownNumber& y) { return {0, x.error + y.error, x.upper + y.upper}; }

KnownNumber product(const KnownNumber& x, const KnownNumber& y) {
  const double size = x.upper * y.upper;
  return {x.mid * y.mid, x.upper * y.error + x.error * y.upper + kRounding * size + kUnderflow, size};
}

}  // namespace

/// The greatest of y·w and of −y·w for the deviations w.
void ItemRows::add_cases(const Item& item, const RotationForm& rotation, const RowForms& rows, const VectorForm<Six>& g,
                         Sum& sum) {
  Sum::Triple most, least;
  Six size(0.0), error(0.0), slope_error(0.0);
  for (std::size_t j = 0; j < item.deviations.size(); ++j) {
    const auto& [force, moment] = item.deviations[j];
    const NumberForm<Six> v = item.turns ? dot(rows.force, turned(rotation, force), rows.radius) +
                                               dot(rows.moment, turned(rotation, moment), rows.radius)
                                         : dot(g, force) + dot(rows.moment, moment);
    const Sum::Triple values = sum.values(v);
    for (std::size_t k = 0; k < 3; ++k) {
      most[k] = j == 0 ? values[k] : max(most[k], values[k]);
      least[k] = j == 0 ? -values[k] : max(least[k], -values[k]);
    }
    size = max(size, sum.reach(v));
    error = max(error, v.mid_error);
    slope_error = max(slope_error, v.slope_error);
  }
  sum.add(least, most, size, error, slope_error);
}

/// M B + μ|A ∓ B| with A = g·γ and B = ρ|y_M × γ|. Where the mass does not vary, this is M ρ|y_M × γ|.
void ItemRows::add_weight(const Item& item, const RowForms& rows, const VectorForm<Six>& g, Sum& sum) {
  const KnownNumber &mass = item.nominal, &mu = item.radius, &rho = item.reach;
  const VectorForm<Six> swing = cross(rows.moment, item.direction);
  if (!item.varies) return sum.add_norm(swing, product(mass, rho));
  const NumberForm<Six> weight = dot(g, item.direction);
  const Sum::Triple a = sum.values(weight), b = sum.norms(swing);
  Sum::Triple below, above;
  for (std::size_t k = 0; k < 3; ++k) {
    const Six offset = Six(rho.mid) * b[k];
    const Six mean = Six(mass.mid) * offset;
    below[k] = mean + Six(mu.mid) * abs(a[k] - offset);
    above[k] = mean + Six(mu.mid) * abs(a[k] + offset);
  }
  const KnownNumber of_swing = product(both(mass, mu), rho);
  const Six most_a = sum.reach(weight), most_b = sum.reach(swing);
  sum.add(below, above, Six(mu.upper) * most_a + Six(of_swing.upper) * most_b,
          Six(mu.upper) * weight.mid_error + Six(mu.error) * most_a + Six(of_swing.upper) * swing.mid_error +
              Six(of_swing.error) * most_b,
          Six(mu.upper) * weight.slope_error + Six(of_swing.upper) * swing.slope_error);
}

/// f_r|a| ∓ (f_m − f_n) a
void ItemRows::add_segment(const Item& item, const NumberForm<Six>& a, Sum& sum) {
  const Sum::Triple values = sum.values(a);
  Sum::Triple below, above;
  for (std::size_t k = 0; k < 3; ++k) {
    const Six size = Six(item.radius.mid) * abs(values[k]), shift = Six(item.offset.mid) * values[k];
    below[k] = size - shift;
    above[k] = size + shift;
  }
  const KnownNumber factor = both(item.radius, item.offset);
  const Six most = sum.reach(a);
  sum.add(below, above, Six(factor.upper) * most, Six(factor.upper) * a.mid_error + Six(factor.error) * most,
          Six(factor.upper) * a.slope_error);
}

void ItemRows::add(const Item& item, const RotationForm& rotation, const RowForms& rows, const VectorForm<Six>& g,
                   Sum& sum) {
  const double radius = rows.radius;
  if (item.kind == Model::Kind::kCases) return add_cases(item, rotation, rows, g, sum);
  if (item.kind == Model::Kind::kWeight) return add_weight(item, rows, g, sum);
  const bool is_force = item.kind == Model::Kind::kForce;
  const VectorForm<Six>& acts = is_force ? g : rows.moment;
  switch (item.shape) {
    case Model::Shape::kBall: return sum.add_norm(acts, item.radius);
    case Model::Shape::kDisc:  // |g − (g·n) n| = |g × n|
      return sum.add_norm(
          item.turns ? cross(acts, turned(rotation, item.direction), radius) : cross(acts, item.direction),
          item.radius);
    case Model::Shape::kSegment: {
      if (!item.turns) return add_segment(item, dot(acts, item.direction), sum);
      const VectorForm<double> direction = turned(rotation, item.direction);
      if (!is_force) return add_segment(item, dot(rows.moment, direction, radius), sum);
      const VectorForm<double> moment = turned(rotation, item.moment);
      return add_segment(item, dot(rows.force, direction, radius) + dot(rows.moment, moment, radius), sum);
    }
    case Model::Shape::kPoint: break;
  }
}

ItemRows::Reach ItemRows::reach(const RotationForm& rotation, const RowForms& rows) const {
  Sum sum(rows.radius);
  for (const Item& item : elsewhere_) add(item, rotation, rows, rows.force, sum);
  for (const Point& point : points_) {
    VectorForm<Six> g = rows.force;
    if (point.lever) g = g + cross(rows.moment, turned(rotation, *point.lever), rows.radius);
    for (const Item& item : point.items) add(item, rotation, rows, g, sum);
  }
  return sum.forms();
}

}  // namespace taut
