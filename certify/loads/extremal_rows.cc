// SPDX-License-Identifier: GPL-3.0-or-later
// The loads at which densities are extremal, for all rows at once: see extremal_load.h, which states it for one row.
#include "certify/loads/item_rows.h"

namespace taut {

namespace {

using Ball = VectorBall<Six>;

Ball operator*(const NumberBall<Six>& k, const Ball& v) {
  return {{k.mid * v.mid[0], k.mid * v.mid[1], k.mid * v.mid[2]},
          k.error * (v.size + v.error) + k.size * (v.error + Six(kRounding) * v.size) + Six(kUnderflow),
          Six(kAbove) * k.size * v.size + Six(kUnderflow)};
}
Ball operator*(const NumberBall<Six>& k, const VectorBall<double>& v) {
  return k * Ball{{Six(v.mid[0]), Six(v.mid[1]), Six(v.mid[2])}, Six(v.error), Six(v.size)};
}
NumberBall<Six> number(const KnownNumber& x) { return {Six(x.mid), Six(x.error), Six(x.upper)}; }
NumberBall<Six> operator+(const NumberBall<Six>& a, const NumberBall<Six>& b) {
  const Six size = a.size + b.size;
  return {a.mid + b.mid, a.error + b.error + Six(kRounding) * size, Six(kAbove) * size};
}
NumberBall<Six> operator*(const NumberBall<Six>& a, const NumberBall<Six>& b) {
  const Six size = a.size * b.size;
  return {a.mid * b.mid, a.error * (b.size + b.error) + a.size * b.error + Six(kRounding) * size + Six(kUnderflow),
          Six(kAbove) * size + Six(kUnderflow)};
}
NumberBall<Six> operator-(const NumberBall<Six>& a) { return {-a.mid, a.error, a.size}; }
Ball operator-(const Ball& a) { return {{-a.mid[0], -a.mid[1], -a.mid[2]}, a.error, a.size}; }

Ball operator+(const Ball& a, const Ball& b) {
  const Six size = a.size + b.size;
  return {sum(a.mid, b.mid), a.error + b.error + Six(kRounding) * size, Six(kAbove) * size};
}
/// Of a product with |a∘b| <= |a||b|.
template <class A, class B>
std::array<Six, 2> error_and_size(const A& a, const B& b) {
  const Six size = Six(kAbove) * a.size * Six(b.size) + Six(kUnderflow);
  return {a.error * Six(b.size + b.error) + a.size * Six(b.error + kRounding * b.size) + Six(kUnderflow), size};
}
std::array<Six, 2> error_and_size(const Ball& a, const Ball& b) {
  const Six size = Six(kAbove) * a.size * b.size + Six(kUnderflow);
  return {a.error * (b.size + b.error) + a.size * b.error + Six(kRounding) * size + Six(kUnderflow), size};
}
Ball cross(const Ball& a, const VectorBall<double>& b) {
  const auto [error, size] = error_and_size(a, b);
  return {taut::cross(a.mid, b.mid), error, size};
}
Ball cross(const Ball& a, const Ball& b) {
  const auto [error, size] = error_and_size(a, b);
  return {{a.mid[1] * b.mid[2] - a.mid[2] * b.mid[1], a.mid[2] * b.mid[0] - a.mid[0] * b.mid[2],
           a.mid[0] * b.mid[1] - a.mid[1] * b.mid[0]},
          error,
          size};
}
NumberBall<Six> dot(const Ball& a, const VectorBall<double>& b) {
  const auto [error, size] = error_and_size(a, b);
  return {taut::dot(a.mid, b.mid), error, size};
}
NumberBall<Six> norm(const Ball& v) {
  const Six size = size_of(v.mid);
  return {size, v.error + Six(kRounding) * size + Six(kUnderflow), size};
}
/// An upper bound of |x|.
Six above(const NumberBall<Six>& x) { return abs(x.mid) + x.error; }

/// R v.
VectorBall<double> turned_ball(const RotationForm& r, const KnownVector& v) {
  VectorBall<double> result;
  for (std::size_t i = 0; i < 3; ++i) result.mid[i] = taut::dot(r.mid[i], v.mid);
  result.error = r.mid_error * (v.size + v.error) + r.mid_size * (v.error + kRounding * v.size) + kUnderflow;
  result.size = size_of(result.mid) + kUnderflow;
  return result;
}

/// The numbers from −1 to 1 that x/|x| may be, and any of them where x may be 0.
NumberBall<Six> sign(const NumberBall<Six>& x) {
  const Six one(1.0), zero(0.0), size = abs(x.mid);
  return {if_greater(size, x.error, if_greater(x.mid, zero, one, -one), zero), if_greater(size, x.error, zero, one),
          one};
}

/// The same of vectors: |v/|v| − v̂/|v̂|| <= 2|v − v̂|/(|v| + |v̂|).
Ball unit(const Ball& v) {
  const Six one(1.0), zero(0.0), size = size_of(v.mid), error = v.error + Six(kUnderflow);
  const Six minus_sum = error - Six(2 * (1 - kRounding)) * size;  // an upper bound of −(|v| + |v̂|)
  const Six quotient = (error + error) / max(-minus_sum, Six(kUnderflow)) + Six(kRounding);
  const Six inverse = if_greater(one, quotient, one / max(size, Six(kUnderflow)), zero);
  return {{v.mid[0] * inverse, v.mid[1] * inverse, v.mid[2] * inverse},
          if_greater(one, quotient, quotient, one),
          Six(kAbove)};
}

/// Adds up three vectors for a side.
void accumulate(ExtremalRows::Side& to, const Ball& force, const Ball& moment, const Ball& turn) {
  to.force = to.force + force;
  to.moment = to.moment + moment;
  to.turn = to.turn + turn;
}

const Ball& nothing() {
  static const Ball ball{{Six(0.0), Six(0.0), Six(0.0)}, Six(0.0), Six(0.0)};
  return ball;
}

}  // namespace

/// What an item is evaluated with.
struct ItemRows::Place {
  const RotationForm& rotation;
  const RowBalls& rows;
  std::optional<VectorBall<double>> lever;  ///< r, unless it is 0
  Ball g;

  /// A force that keeps its axes in W: with its moment r × F, and T = r × (F × m).
  void add_force(ExtremalRows::Side& to, const Ball& force) const {
    if (!lever) return accumulate(to, force, nothing(), nothing());
    accumulate(to, force, -cross(force, *lever), -cross(cross(force, rows.moment), *lever));
  }
  /// A force and a moment about P_m that turn with P: T = F × f + M × m.
  void add_turning(ExtremalRows::Side& to, const Ball& force, const Ball& moment) const {
    accumulate(to, force, moment, cross(force, rows.force) + cross(moment, rows.moment));
  }
};

/// The mass is M + μ sgn(B ± A), at r ± ρ e with e the unit vector along γ × m.
void ItemRows::add_weight(const Item& item, const Place& at, ExtremalRows& sum) {
  const NumberBall<Six> rho = number(item.reach), mu = number(item.radius);
  const Ball across = -cross(at.rows.moment, item.direction);
  const NumberBall<Six> swing = rho * norm(across);  // B
  const NumberBall<Six> weight = item.varies ? dot(at.g, item.direction) : NumberBall<Six>{};
  const Ball offset = item.swings ? rho * unit(across) : nothing();
  for (std::size_t side = 0; side < 2; ++side) {
    const bool is_least = side == 0;
    ExtremalRows::Side& to = sum.sides[side];
    NumberBall<Six> mass = number(item.nominal);
    to.reach += above(mass * swing);
    if (item.varies) {
      const NumberBall<Six> slope = is_least ? swing + -weight : weight + swing;
      const NumberBall<Six> change = mu * sign(slope);
      to.reach += above(mu * slope);
      at.add_force(to, change * item.direction);
      mass = mass + change;
    }
    if (!item.swings) continue;
    const Ball moment = cross(is_least ? -offset : offset, item.direction);  // e × γ
    to.moment = to.moment + mass * moment;
  }
}

/// Amounts f_m − f_n ± f_r sgn(a) of the unit vector.
void ItemRows::add_segment(const Item& item, const Place& at, ExtremalRows& sum) {
  const bool is_force = item.kind == Model::Kind::kForce;
  const VectorBall<double> direction = item.turns ? turned_ball(at.rotation, item.direction) : item.direction;
  const VectorBall<double> moment = item.turns && is_force ? turned_ball(at.rotation, item.moment) : KnownVector{};
  NumberBall<Six> a = dot(is_force ? item.turns ? at.rows.force : at.g : at.rows.moment, direction);
  if (item.turns && is_force) a = a + dot(at.rows.moment, moment);
  const NumberBall<Six> range = number(item.radius) * sign(a);
  for (std::size_t side = 0; side < 2; ++side) {
    ExtremalRows::Side& to = sum.sides[side];
    const NumberBall<Six> amount = number(item.offset) + (side == 0 ? -range : range);
    to.reach += above(amount * a);
    const Ball vector = amount * direction;
    if (!is_force) {
      item.turns ? at.add_turning(to, nothing(), vector) : accumulate(to, nothing(), vector, nothing());
    } else if (item.turns) {
      at.add_turning(to, vector, amount * moment);
    } else {
      at.add_force(to, vector);
    }
  }
}

/// ± f times the unit vector along g, or along n × (g × n) for what is across n.
void ItemRows::add_round(const Item& item, const Place& at, ExtremalRows& sum) {
  const bool is_force = item.kind == Model::Kind::kForce;
  Ball along = is_force ? at.g : at.rows.moment;
  if (item.shape == Model::Shape::kDisc) {
    const VectorBall<double> normal = item.turns ? turned_ball(at.rotation, item.direction) : item.direction;
    along = -cross(cross(along, normal), normal);
  }
  const NumberBall<Six> radius = number(item.radius);
  const Six reach = above(radius * norm(along));
  const Ball direction = unit(along);
  const Ball greatest = radius * direction;
  const bool turns = item.turns && item.shape == Model::Shape::kDisc;
  for (std::size_t side = 0; side < 2; ++side) {
    ExtremalRows::Side& to = sum.sides[side];
    to.reach += reach;
    const Ball vector = side == 0 ? -greatest : greatest;
    if (!is_force) {
      turns ? at.add_turning(to, nothing(), vector) : accumulate(to, nothing(), vector, nothing());
    } else if (turns) {
      at.add_turning(to, vector, at.lever ? -cross(vector, *at.lever) : nothing());
    } else {
      at.add_force(to, vector);
    }
  }
}

void ItemRows::add(const Item& item, const Place& at, ExtremalRows& sum) {
  if (item.kind == Model::Kind::kWeight) {
    add_weight(item, at, sum);
  } else if (item.shape == Model::Shape::kSegment) {
    add_segment(item, at, sum);
  } else {
    add_round(item, at, sum);
  }
}

ExtremalRows ItemRows::extremes(const RotationForm& rotation, const RowBalls& rows) const {
  ExtremalRows sum;
  for (ExtremalRows::Side& side : sum.sides) side = {nothing(), nothing(), nothing(), Six(0.0)};
  Place at{rotation, rows, std::nullopt, rows.force};
  // What the nominal wrench adds to T.
  ExtremalRows::Side nominal = sum.sides[0];
  for (const ForceAtPoint& force : nominal_at_points_) {
    const VectorBall<double> lever = turned_ball(rotation, force.lever);
    nominal.turn = nominal.turn + cross(cross(rows.moment, force.force), lever);  // r × (F × m)
  }
  nominal.turn = nominal.turn + -cross(rows.force, turned_ball(rotation, turning_nominal_[0])) +
                 -cross(rows.moment, turned_ball(rotation, turning_nominal_[1]));
  for (ExtremalRows::Side& side : sum.sides) side.turn = nominal.turn;

  for (const Item& item : elsewhere_) add(item, at, sum);
  for (const Point& point : points_) {
    at.lever.reset();
    at.g = rows.force;
    if (point.lever) {
      at.lever = turned_ball(rotation, *point.lever);
      at.g = rows.force + cross(rows.moment, *at.lever);
    }
    for (const Item& item : point.items) add(item, at, sum);
  }
  return sum;
}

}  // namespace taut
