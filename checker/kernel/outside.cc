// SPDX-License-Identifier: GPL-3.0-or-later
#include "checker/kernel/outside.h"

#include "checker/kernel/rotation.h"

namespace taut::checker {
namespace {

using Force = Vector3<Ball>;

/// A force and a moment.
struct ChosenWrench {
  Force force, moment;
};

/// The numbers in the middle of the balls.
template <std::size_t N>
std::array<Ball, N> middles(std::array<Ball, N> x) {
  for (Ball& entry : x) entry = middle(entry);
  return x;
}

/// v / |v| for numbers v; 0 if v is.
Force unit(const Force& v) {
  const Ball squared = squared_norm(v);
  return certainly_positive(squared) ? Ball(1) / sqrt(squared) * v : Force{};
}

ChosenWrench along(const Force& vector, bool is_moment) {
  return is_moment ? ChosenWrench{{}, vector} : ChosenWrench{vector, {}};
}

/// A wrench of an item, about its point and in its axes, for which g . F + m . M is about as large as it gets. In the
/// set whatever the numbers g and m are.
class Choice {
 public:
  Choice(Force g, Force m, const ExactVector& gravity) : g_(std::move(g)), m_(std::move(m)), gravity_(gravity) {}

  ChosenWrench operator()(const Weight& x) const {
    const Force gravity = balls(gravity_);
    const Force e = Ball(x.offset) * unit(middles(cross(gravity, m_)));  // |e| <= offset
    const bool is_most = certainly_positive(middle(dot(g_, gravity) + dot(e, cross(gravity, m_))));
    const Force weight = Ball(is_most ? x.mass.upper : x.mass.lower) * gravity;
    return {weight, cross(e, weight)};
  }
  ChosenWrench operator()(const BallOrDisc& x) const {
    Force v = x.is_moment ? m_ : g_;
    if (x.normal) {
      const Force normal = balls(*x.normal);
      // v need not be quite in the plane: what is chosen is the unit vector along its part there.
      const Force exact = middles(v);
      v = exact - dot(exact, normal) / Ball(dot(*x.normal, *x.normal)) * normal;
      return along(Ball(x.radius) * unit(v), x.is_moment);
    }
    return along(Ball(x.radius) * unit(middles(v)), x.is_moment);
  }
  ChosenWrench operator()(const LineSegment& x) const {
    const Ball towards = dot(x.is_moment ? m_ : g_, balls(x.direction));
    const mpq_class& f = certainly_positive(middle(towards)) ? x.range.upper : x.range.lower;
    return along(Ball(f) / sqrt(Ball(dot(x.direction, x.direction))) * balls(x.direction), x.is_moment);
  }
  ChosenWrench operator()(const LoadCases& x) const {
    ChosenWrench best;
    Ball most;
    for (const ExactWrench& w : x.wrenches) {
      const ChosenWrench one = {{Ball(w[0]), Ball(w[1]), Ball(w[2])}, {Ball(w[3]), Ball(w[4]), Ball(w[5])}};
      const Ball value = middle(dot(g_, one.force) + dot(m_, one.moment));
      if (&w != x.wrenches.data() && !certainly_positive(value - most)) continue;
      best = one;
      most = value;
    }
    return best;
  }

 private:
  Force g_, m_;
  const ExactVector& gravity_;
};

}  // namespace

StatedMachine::StatedMachine(const Problem& stated) : problem(stated), wrench(balls(stated.wrench)) {
  for (std::size_t i = 0; i < kCables; ++i) {
    base[i] = balls(stated.base_anchors[i]);
    platform[i] = balls(stated.platform_anchors[i]);
    for (std::size_t c = 0; c < 3; ++c) {
      arms[i][c] = Ball(mpq_class(stated.platform_anchors[i][c] - stated.load_point[c]));
    }
    tension_limits[i] = {Ball(stated.tension[i].lower), Ball(stated.tension[i].upper)};
  }
  if (stated.ellipsoid) {
    Ellipsoid& K = ellipsoid.emplace();
    for (std::size_t i = 0; i < 6; ++i) K.E[i] = balls((*stated.ellipsoid)[i]);
    K.near_inverse = approximate_inverse(K.E);
  }
  for (const LoadItem& item : stated.items) {
    Force& arm = item_arms.emplace_back();
    for (std::size_t c = 0; c < 3; ++c) arm[c] = Ball(mpq_class(item.at[c] - stated.load_point[c]));
  }
  if (stated.bodies) bodies.emplace(stated);
}

OutsideProof::OutsideProof(const StatedMachine& machine, std::span<const CellForm> parameters) : machine_(machine) {
  const Problem& problem = machine.problem;
  Vector6<CellForm> pose;
  for (std::size_t c = 0; c < 6; ++c) pose[c] = problem.pose[c].evaluate<CellForm>(parameters);
  p_ = {pose[0], pose[1], pose[2]};
  R_ = orientation(problem, pose);
  for (std::size_t i = 0; i < kCables; ++i) {
    d_[i] = multiply(R_, machine.platform[i]);
    for (std::size_t c = 0; c < 3; ++c) d_[i][c] += pose[c] - CellForm(machine.base[i][c]);
    squared_[i] = squared_norm(d_[i]);
  }
}

bool OutsideProof::holds(const OutsideReason& reason) {
  if (reason.kind == OutsideReason::Kind::kLength) return is_beyond_length(reason.cable, reason.side);
  return is_unbalanced(reason);
}

bool OutsideProof::is_beyond_length(std::size_t cable, std::size_t side) const {
  const Limits& limits = machine_.problem.length[cable];
  const Ball limit(side == 0 ? mpq_class(limits.lower * limits.lower) : mpq_class(limits.upper * limits.upper));
  const Ball squared = squared_[cable].range();
  return certainly_nonnegative(side == 0 ? limit - squared : squared - limit);
}

/// J, and the numbers that y is made of.
void OutsideProof::set_columns() {
  if (has_columns_) return;
  Matrix6<Ball> D;
  for (std::size_t j = 0; j < kCables; ++j) {
    if (!certainly_positive(squared_[j].range())) throw Undefined("a cable may have no length");
    const CellForm inverse = apply(Function::kInverse, apply(Function::kSqrt, squared_[j]));
    arm_[j] = multiply(R_, machine_.arms[j]);
    const Vector3<CellForm> moment = cross(arm_[j], d_[j]);
    for (std::size_t c = 0; c < 6; ++c) {
      const CellForm& entry = c < 3 ? d_[j][c] : moment[c - 3];
      J_[c][j] = entry * inverse;
      D[c][j] = middle(entry.at);
      for (std::size_t k = 0; k < kCellAxes; ++k) S_[k][c][j] = middle(entry.slope[k]);
    }
  }
  C_ = approximate_inverse(D);
  has_columns_ = true;
}

Vector6<CellForm> OutsideProof::row(const OutsideReason& reason) const {
  Vector6<Ball> row = C_[reason.cable];
  if (reason.side == 0) {
    for (Ball& y : row) y = -y;
  }
  Vector6<CellForm> result;
  for (std::size_t c = 0; c < 6; ++c) result[c].at = row[c];
  for (std::size_t k = 0; k < kCellAxes && reason.kind == OutsideReason::Kind::kFollowing; ++k) {
    Vector6<Ball> by_S, change;
    for (std::size_t c = 0; c < 6; ++c) {
      for (std::size_t l = 0; l < 6; ++l) by_S[c].add_product(row[l], S_[k][l][c]);
    }
    for (std::size_t c = 0; c < 6; ++c) {
      for (std::size_t l = 0; l < 6; ++l) change[c] -= by_S[l] * C_[l][c];
    }
    change = middles(change);
    for (std::size_t c = 0; c < 6; ++c) result[c].slope[k] = change[c];
  }
  return result;
}

/// y . w for a w of K, one at each u.
CellForm OutsideProof::work(const Vector6<CellForm>& y) const {
  Vector6<Ball> in_middle;
  for (std::size_t c = 0; c < 6; ++c) in_middle[c] = y[c].at;  // numbers
  Vector6<CellForm> w;
  for (std::size_t c = 0; c < 6; ++c) w[c] = CellForm(machine_.wrench[c]);
  if (machine_.ellipsoid) {
    const auto& [E, near_inverse] = *machine_.ellipsoid;
    const Vector6<Ball> e = middles(multiply(near_inverse, in_middle));
    const Vector6<Ball> Ee = multiply(E, e);
    Ball squared;
    for (std::size_t c = 0; c < 6; ++c) squared.add_product(e[c], Ee[c]);
    // w0 + e / sqrt(e' E e) is in K.
    for (std::size_t c = 0; c < 6 && certainly_positive(squared); ++c) w[c].at += e[c] / sqrt(squared);
  }
  Matrix3<Ball> R;  // numbers, close to the rotation in the middle: only to choose with
  for (std::size_t i = 0; i < 3; ++i) {
    for (std::size_t j = 0; j < 3; ++j) R[i][j] = middle(R_[i][j].at);
  }
  const Problem& problem = machine_.problem;
  for (std::size_t n = 0; n < problem.items.size(); ++n) {
    const LoadItem& item = problem.items[n];
    const bool turns = item.axes == Axes::kPlatform;
    const Force y_M = {in_middle[3], in_middle[4], in_middle[5]};
    const Force g = Force{in_middle[0], in_middle[1], in_middle[2]} + cross(y_M, multiply(R, machine_.item_arms[n]));
    const Matrix3<Ball> back = transposed(R);
    const auto in_its_axes = [&](const Force& x) { return middles(turns ? multiply(back, x) : x); };
    const ChosenWrench chosen = std::visit(Choice(in_its_axes(g), in_its_axes(y_M), problem.gravity), item.set);
    const auto in_W = [&](const Force& x) {
      return turns ? multiply(R_, x) : Vector3<CellForm>{CellForm(x[0]), CellForm(x[1]), CellForm(x[2])};
    };
    const Vector3<CellForm> force = in_W(chosen.force);
    const Vector3<CellForm> moment = in_W(chosen.moment) + cross(multiply(R_, machine_.item_arms[n]), force);
    for (std::size_t c = 0; c < 3; ++c) {
      w[c] += force[c];
      w[3 + c] += moment[c];
    }
  }
  CellForm result;
  for (std::size_t c = 0; c < 6; ++c) result += y[c] * w[c];
  return result;
}

bool OutsideProof::is_unbalanced(const OutsideReason& reason) {
  set_columns();
  const Vector6<CellForm> y = row(reason);
  CellForm left = work(y);
  for (std::size_t j = 0; j < kCables; ++j) {
    CellForm pull;
    for (std::size_t c = 0; c < 6; ++c) pull += y[c] * J_[c][j];
    const auto& [least, most] = machine_.tension_limits[j];
    const Ball over = pull.range();
    if (certainly_nonnegative(over)) {
      left -= most * pull;
    } else {
      left -= least * pull;
      const Ball highest_pull = highest(over);
      if (certainly_positive(highest_pull)) left -= CellForm(from_zero_to((most - least) * highest_pull));
    }
  }
  return certainly_positive(left.range());
}

// ---- Contact --------------------------------------------------------------------------------------------------------

namespace {

Vector3<Ball> mean(const std::vector<Vector3<Ball>>& points, const std::vector<mpq_class>& weights) {
  if (points.empty()) throw Undefined("nothing is said of contacts with meshes");
  Vector3<Ball> result;
  for (std::size_t k = 0; k < points.size(); ++k) {
    if (weights.at(k) != 0) result = result + Ball(weights[k]) * points[k];
  }
  return result;
}

Vector3<Ball> ranges(const Vector3<CellForm>& x) { return {x[0].range(), x[1].range(), x[2].range()}; }

/// Whether a ball about 0 with this radius is certainly in the hull of these, everywhere; for no radius, whether 0 is.
bool is_around_zero(const std::array<Vector3<CellForm>, 4>& v, const std::optional<Ball>& radius) {
  std::array<Ball, 4> shares, faces;
  for (std::size_t k = 0; k < 4; ++k) {
    const auto& [a, b, c] = kTetrahedronFaces[k];
    shares[k] = determinant(v[a], v[b], v[c]).range();
    if (radius) faces[k] = *radius * length_range(ranges(cross(v[b] - v[a], v[c] - v[a])));
  }
  const auto is_inside = [&](int side) {
    for (std::size_t k = 0; k < 4; ++k) {
      const Ball share = side > 0 ? shares[k] : -shares[k];
      if (!certainly_positive(share) || (radius && !certainly_nonnegative(share - faces[k]))) return false;
    }
    return true;
  };
  return is_inside(1) || is_inside(-1);
}

}  // namespace

Vector3<CellForm> OutsideProof::of_platform(const PlacedHull& hull, const std::vector<mpq_class>& weights) const {
  return p_ + multiply(R_, mean(hull.points, weights));
}

Vector3<CellForm> OutsideProof::of_cable(std::size_t i, const std::vector<mpq_class>& weights) const {
  const CellForm length = apply(Function::kSqrt, squared_[i]);
  const auto& [at_base, at_platform] = machine_.bodies->free_ends[i];
  if (!certainly_positive(length.range() - at_base - at_platform)) {
    throw Undefined("a cable may not be longer than its free ends");
  }
  const CellForm inverse = apply(Function::kInverse, length);
  const CellForm share =
      Ball(weights.at(0)) * at_base * inverse + Ball(weights.at(1)) * (CellForm(Ball(1)) - at_platform * inverse);
  Point result = share * d_[i];
  for (std::size_t c = 0; c < 3; ++c) result[c] += CellForm(machine_.base[i][c]);
  return result;
}

Vector3<CellForm> OutsideProof::first_point(const CheckedPair& pair, const ContactWeights& weights) const {
  const bool is_platform = pair.kind == PairKind::kPlatformObstacle;
  return is_platform ? of_platform(machine_.bodies->platform[pair.first], weights[0])
                     : of_cable(pair.first, weights[0]);
}

Vector3<CellForm> OutsideProof::second_point(const CheckedPair& pair, const ContactWeights& weights) const {
  if (pair.kind == PairKind::kCableCable) return of_cable(pair.second, weights[1]);
  if (pair.kind == PairKind::kCablePlatform) {
    return of_platform(machine_.bodies->platform[pair.second], weights[1]);
  }
  const Vector3<Ball> x = mean(std::get<PlacedHull>(machine_.bodies->obstacles[pair.second]).points, weights[1]);
  return {CellForm(x[0]), CellForm(x[1]), CellForm(x[2])};
}

bool OutsideProof::is_out_of_cone(std::size_t i, const PlacedExitCone& cone) const {
  if (!certainly_positive(squared_[i].range())) throw Undefined("a cable may have no length");
  Point d = d_[i];
  if (cone.end == Axes::kPlatform) {
    d = multiply(transposed(R_), d);
    for (CellForm& x : d) x = -x;
  }
  const Point n = {CellForm(cone.axis[0]), CellForm(cone.axis[1]), CellForm(cone.axis[2])};
  const Ball along = cone.sine * dot(cone.axis, d).range();
  return certainly_nonnegative(cone.cosine * length_range(ranges(cross(d, n))) - along);
}

bool OutsideProof::holds(const ContactReason& reason) const {
  const PlacedBodies& bodies = machine_.bodies.value();
  const CheckedPair& pair = bodies.pairs.at(reason.pair);
  if (pair.kind == PairKind::kExitCone) return is_out_of_cone(pair.first, bodies.exit_cones[pair.second]);
  const bool is_platform = pair.kind == PairKind::kPlatformObstacle;
  Ball allowed = bodies.required_at_least(reason.pair, ranges(p_)) +
                 (is_platform ? bodies.platform[pair.first].radius : bodies.cable_radius[pair.first]);
  if (is_platform || pair.kind == PairKind::kCableObstacle) {
    const auto& obstacle = bodies.obstacles[pair.second];
    if (const auto* half_space = std::get_if<PlacedHalfSpace>(&obstacle)) {
      const CellForm height =
          dot(half_space->normal, first_point(pair, reason.points.at(0))) - CellForm(half_space->offset);
      return certainly_nonnegative(allowed * sqrt(squared_norm(half_space->normal)) - height.range());
    }
    allowed += std::get<PlacedHull>(obstacle).radius;
  } else {
    allowed +=
        pair.kind == PairKind::kCableCable ? bodies.cable_radius[pair.second] : bodies.platform[pair.second].radius;
  }
  const auto apart = [&](std::size_t k) {
    return first_point(pair, reason.points.at(k)) - second_point(pair, reason.points.at(k));
  };
  const bool is_met_at_zero = certainly_nonnegative(allowed);
  if (reason.points.size() == 4) {
    return is_around_zero({apart(0), apart(1), apart(2), apart(3)},
                          is_met_at_zero ? std::nullopt : std::optional(-allowed));
  }
  return is_met_at_zero && certainly_nonnegative(allowed * allowed - squared_norm(apart(0)).range());
}

}  // namespace taut::checker
