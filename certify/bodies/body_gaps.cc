// SPDX-License-Identifier: GPL-3.0-or-later
#include "certify/bodies/body_gaps.h"

#include <limits>
#include <stdexcept>

#include "certify/bodies/body_gaps_detail.h"

namespace taut {

using namespace body_gaps_detail;

template <class I, class Slope>
BodyGaps<I, Slope>::BodyGaps(const BodiesBox<I, Slope>& box) : box_(box) {
  if (box.tolerance != nullptr) {
    position_ = box.deviations->position;
    turn_ = box.deviations->turn;
    base_ = box.tolerance->base_anchor;
    platform_ = box.tolerance->platform_anchor;
  }
  for (std::size_t i = 0; i < kCables; ++i) {
    const auto& free = box.bodies.cable_free[i];
    if (!certainly_positive(box.length[i].range - length_change(i) - free[0] - free[1])) have_length_ = false;
  }
  platform_bodies_.resize(box.bodies.platform.size());
}

template <class I, class Slope>
I BodyGaps<I, Slope>::length_change(std::size_t i) const {
  if (box_.tolerance == nullptr) return I(0.0);
  return I(ProofScalarTraits<I>::to_double(box_.deviations->length[i]));
}

// Of a cable that may be longer, free ends are smaller shares.
template <class I, class Slope>
const typename BodyGaps<I, Slope>::Cut& BodyGaps<I, Slope>::cut(std::size_t i) const {
  if (cut_[i]) return *cut_[i];
  Cut& cut = cut_[i].emplace(Cut{{Form(0.0), Form(0.0)}});
  const Form longest = box_.length[i] + length_change(i);
  if (!certainly_positive(longest.range)) return cut;
  const Form inverse = reciprocal(longest);
  for (std::size_t end = 0; end < 2; ++end) {
    if (!box_.bodies.is_cut[i][end]) continue;
    cut.share[end] = inverse * box_.bodies.cable_free[i][end];
    cut.share[end].tighten(box_.offset);
  }
  return cut;
}

template <class I, class Slope>
const std::array<I, 2>& BodyGaps<I, Slope>::shares(std::size_t i) const {
  if (shares_[i]) return *shares_[i];
  const auto& free = box_.bodies.cable_free[i];
  const I longest = box_.length[i].range + length_change(i);
  const I inverse = certainly_positive(longest) ? reciprocal(longest) : I(0.0);
  return shares_[i].emplace(std::array<I, 2>{times_of_sign(inverse, free[0]), times_of_sign(inverse, free[1])});
}

template <class I, class Slope>
Vector3<I> BodyGaps<I, Slope>::range_in_world(const Vector3<I>& x_P) const {
  Vector3<I> x;
  for (int k = 0; k < 3; ++k) {
    x(k) = box_.p_WP(k).range + times_of_sign(box_.r_WP(k, 0).range, x_P(0)) +
           times_of_sign(box_.r_WP(k, 1).range, x_P(1)) + times_of_sign(box_.r_WP(k, 2).range, x_P(2));
  }
  return x;
}

template <class I, class Slope>
const Vector3<I>& BodyGaps<I, Slope>::platform_anchor(std::size_t i) const {
  if (!platform_anchors_[i]) platform_anchors_[i] = range_in_world(box_.model.p_PB[i]);
  return *platform_anchors_[i];
}

template <class I, class Slope>
const Vector3<I>& BodyGaps<I, Slope>::platform_body(std::size_t n) const {
  if (!platform_bodies_[n]) platform_bodies_[n] = range_in_world(box_around(box_.bodies.platform[n]));
  return *platform_bodies_[n];
}

template <class I, class Slope>
typename BodyGaps<I, Slope>::Turned BodyGaps<I, Slope>::turned(const std::array<I, 3>& u, bool in_platform) const {
  Turned result;
  result.u = u;
  for (int k = 0; k < 3; ++k) {
    const auto entry = [&](int i) { return in_platform ? box_.r_WP(k, i) : box_.r_WP(i, k); };
    result.other[static_cast<std::size_t>(k)] = entry(0) * u[0] + entry(1) * u[1] + entry(2) * u[2];
  }
  if (in_platform) {
    result.of_origin = result.other[0] * box_.p_WP(0) + result.other[1] * box_.p_WP(1) + result.other[2] * box_.p_WP(2);
  } else {
    result.of_origin = box_.p_WP(0) * u[0] + box_.p_WP(1) * u[1] + box_.p_WP(2) * u[2];
  }
  return result;
}

/// Whether a pair is told apart in the platform's axes.
template <class I, class Slope>
bool BodyGaps<I, Slope>::is_in_platform(const CheckedPair<I>& pair, const Direction& direction) const {
  check_axes(pair, direction);
  return direction.in_platform && pair.kind != PairClass::kCablesObstacles && half_space(box_.bodies, pair) == nullptr;
}

/// How far deviations move a point of an obstacle in the axes of the platform.
template <class I, class Slope>
typename BodyGaps<I, Slope>::Upper BodyGaps<I, Slope>::obstacle_shift(const Vector3<I>& x) const {
  if (box_.tolerance == nullptr) return Upper(0.0);
  Vector3<I> from_p;
  for (int k = 0; k < 3; ++k) from_p(k) = x(k) - box_.p_WP(k).range;
  return position_ + turn_ * norm_above(from_p);
}

/// How far deviations move the ends of a cable, base and platform, in the axes chosen. What two cables with a common
/// anchor share is counted at their other ends.
template <class I, class Slope>
std::array<UpperOf<I>, 2> BodyGaps<I, Slope>::end_shifts(const CheckedPair<I>& pair, std::size_t i,
                                                         bool in_platform) const {
  if (box_.tolerance == nullptr) return {Upper(0.0), Upper(0.0)};
  const Upper reach = norm_above(box_.model.p_PB[i]);
  if (in_platform) {
    const Upper lever = above(box_.length[i].range) + reach;  // |a_i − p|
    const Upper base = base_[i] + position_ + turn_ * lever;
    if (pair.shares_platform) return {base + platform_[i], Upper(0.0)};
    return {base, platform_[i]};
  }
  const Upper platform = position_ + turn_ * reach + platform_[i];
  if (pair.shares_base) return {Upper(0.0), platform + base_[i]};
  return {base_[i], platform};
}

template <class I, class Slope>
std::array<typename BodyGaps<I, Slope>::Projection, 2> BodyGaps<I, Slope>::cable(
    std::size_t i, const Turned& u, bool in_platform, const std::array<Upper, 2>& shifts) const {
  const Vector3<I>& a = box_.model.p_WA[i];
  const Vector3<I>& b = box_.model.p_PB[i];
  const Form base = in_platform ? dot(u.other, a) - u.of_origin : Form(dot(u.u, a));
  const Form platform = in_platform ? Form(dot(u.u, b)) : u.of_origin + dot(u.other, b);
  const Form along = platform - base;
  std::array<Projection, 2> ends{Projection{base, shifts[0]}, Projection{platform, shifts[1]}};
  for (std::size_t end = 0; end < 2; ++end) {
    if (!box_.bodies.is_cut[i][end]) continue;
    const Form& share = cut(i).share[end];
    ends[end].at = end == 0 ? base + share * along : platform - share * along;
    // (1 − λ) of the one end's shift and λ of the other's.
    ends[end].shift = above(I(I(1.0) - share.range)) * shifts[end] + above(share.range) * shifts[1 - end];
  }
  return ends;
}

template <class I, class Slope>
typename BodyGaps<I, Slope>::Projections BodyGaps<I, Slope>::platform_points(const ConvexBody<I>& body, const Turned& u,
                                                                             bool in_platform) const {
  Projections result;
  if (in_platform) {  // they stand still: the lowest one will do
    I lowest = dot(u.u, body.points.front());
    for (const Vector3<I>& x : body.points) lowest = lesser(lowest, dot(u.u, x));
    result.push_back({Form(lowest), Upper(0.0)});
    return result;
  }
  for (const Vector3<I>& x : body.points) {
    Upper shift(0.0);
    if (box_.tolerance != nullptr) shift = position_ + turn_ * norm_above(x);
    result.push_back({u.of_origin + dot(u.other, x), shift});
  }
  return result;
}

template <class I, class Slope>
typename BodyGaps<I, Slope>::Projections BodyGaps<I, Slope>::first(const CheckedPair<I>& pair, const Turned& u,
                                                                   bool in_platform) const {
  if (pair.kind == PairClass::kPlatformObstacles)
    return platform_points(box_.bodies.platform[pair.first], u, in_platform);
  const auto ends = cable(pair.first, u, in_platform, end_shifts(pair, pair.first, in_platform));
  Projections result;
  for (const Projection& end : ends) result.push_back(end);
  return result;
}

template <class I, class Slope>
std::array<I, 3> BodyGaps<I, Slope>::vector(const CheckedPair<I>& pair, const Direction& direction) const {
  if (const auto* half = half_space(box_.bodies, pair)) return {half->normal(0), half->normal(1), half->normal(2)};
  check_axes(pair, direction);
  const std::array<double, 3> u = components(direction);
  return {I(u[0]), I(u[1]), I(u[2])};
}

template <class I, class Slope>
RequiredDistance<I> BodyGaps<I, Slope>::required(const CheckedPair<I>& pair, bool only_at_mid) const {
  if (pair.zones.empty()) return {pair.clearance, pair.clearance};
  Vector3<I> p;
  for (int k = 0; k < 3; ++k) p(k) = only_at_mid ? box_.p_WP(k).at_mid : box_.p_WP(k).range;
  return required_distance(pair, p);
}

template <class I, class Slope>
SlopeForm<I, Slope> BodyGaps<I, Slope>::in_cone(const CheckedPair<I>& pair) const {
  const ExitCone<I>& cone = box_.bodies.exit_cones[pair.second];
  const Vector3<I>& b = box_.model.p_PB[pair.first];
  std::array<Form, 3> d;  // in W, from A to B
  for (int k = 0; k < 3; ++k) {
    d[static_cast<std::size_t>(k)] = box_.p_WP(k) - Form(box_.model.p_WA[pair.first](k)) + box_.r_WP(k, 0) * b(0) +
                                     box_.r_WP(k, 1) * b(1) + box_.r_WP(k, 2) * b(2);
  }
  if (cone.end == CableEnd::kPlatform) {
    const std::array<Form, 3> in_world = d;
    for (int k = 0; k < 3; ++k) {
      d[static_cast<std::size_t>(k)] =
          -(box_.r_WP(0, k) * in_world[0] + box_.r_WP(1, k) * in_world[1] + box_.r_WP(2, k) * in_world[2]);
    }
  }
  for (Form& x : d) x.tighten(box_.offset);
  Form result = distance_in_cone<Form>(cone, d);
  result.tighten(box_.offset);
  return result;
}

template <class I, class Slope>
double BodyGaps<I, Slope>::rough(const CheckedPair<I>& pair, const Direction& direction) const {
  if (pair.kind == PairClass::kExitCones) return -std::numeric_limits<double>::infinity();  // along() is quick
  if (half_space(box_.bodies, pair) != nullptr) return rough(pair, vector(pair, direction), false);
  return rough(pair, components(direction), is_in_platform(pair, direction));
}

template <class I, class Slope>
template <class Number>
double BodyGaps<I, Slope>::rough(const CheckedPair<I>& pair, const std::array<Number, 3>& u, bool in_platform) const {
  std::array<I, 3> u_W;
  for (int k = 0; in_platform && k < 3; ++k) {
    u_W[static_cast<std::size_t>(k)] =
        times(u[0], box_.r_WP(k, 0).range) + times(u[1], box_.r_WP(k, 1).range) + times(u[2], box_.r_WP(k, 2).range);
  }
  // Where things of W are along u, in the axes of the platform.
  const auto in_axes_of_platform = [&](const Vector3<I>& x) {
    Vector3<I> from_origin;
    for (int k = 0; k < 3; ++k) from_origin(k) = x(k) - box_.p_WP(k).range;
    return dot(u_W, from_origin);
  };
  Upper lost(0.0);  // to deviations
  // From where to where a cable's checked part reaches along u.
  const auto cable_range = [&](std::size_t i) {
    if (box_.tolerance != nullptr) {
      const auto shifts = end_shifts(pair, i, in_platform);
      lost += shifts[0] + shifts[1];
    }
    const Vector3<I>& a = box_.model.p_WA[i];
    // Both ends of the part from the anchor that stands still in these axes, so that the other one counts once.
    const std::size_t still = in_platform ? 1 : 0;
    const I from = in_platform ? dot(u, box_.model.p_PB[i]) : dot(u, a);
    const I along = (in_platform ? in_axes_of_platform(a) : dot(u, platform_anchor(i))) - from;
    const auto share = [&](std::size_t end) { return shares(i)[end]; };
    const I near = box_.bodies.is_cut[i][still] ? from + times_of_sign(along, share(still)) : from;
    const I far =
        from + (box_.bodies.is_cut[i][1 - still] ? times_of_sign(along, I(I(1.0) - share(1 - still))) : along);
    return hull(near, far);
  };
  I first, second;
  if (pair.kind == PairClass::kPlatformObstacles) {
    const ConvexBody<I>& body = box_.bodies.platform[pair.first];
    if (box_.tolerance != nullptr && !in_platform) {
      lost += position_ + turn_ * (norm_above(body.centre) + above(body.reach));
    }
    first = in_platform ? dot(u, box_around(body)) : dot(u, platform_body(pair.first));
  } else {
    first = cable_range(pair.first);
  }
  if (const auto* half = half_space(box_.bodies, pair)) {
    second = half->offset;
  } else if (pair.kind == PairClass::kCablesCables) {
    second = cable_range(pair.second);
  } else {
    const ConvexBody<I>& body = second_hull(box_.bodies, pair);
    const bool is_moving = in_platform && pair.kind == PairClass::kPlatformObstacles;
    if (is_moving && box_.tolerance != nullptr) lost += obstacle_shift(body.centre) + turn_ * above(body.reach);
    second = is_moving ? in_axes_of_platform(box_around(body)) : dot(u, box_around(body));
  }
  const I gap =
      times_of_sign(I(first - second), reciprocal(norm_of<I>(u))) - pair.radii - required(pair, false).at_most;
  return lower_bound(I(gap + ProofScalarTraits<I>::symmetric(lost)));
}

template <class I, class Slope>
GapBound<I, Slope> BodyGaps<I, Slope>::along(const CheckedPair<I>& pair, const Direction& direction) const {
  if (pair.kind == PairClass::kExitCones) {
    const bool is_at_platform = box_.bodies.exit_cones[pair.second].end == CableEnd::kPlatform;
    const std::array<Upper, 2> shifts = end_shifts(pair, pair.first, is_at_platform);
    const Form value = in_cone(pair);
    return {value, value.range + ProofScalarTraits<I>::symmetric(shifts[0] + shifts[1])};
  }
  const auto* half = half_space(box_.bodies, pair);
  const bool in_platform = is_in_platform(pair, direction);
  const std::array<I, 3> u = vector(pair, direction);
  const Turned turned_u = turned(u, in_platform);
  const I inverse_norm = reciprocal(euclidean_norm(u[0], u[1], u[2]));

  // The second body: constants, or two ends of a cable that move with the platform, too.
  Projections second;
  const I needed = pair.radii + required(pair, false).at_most;
  if (half != nullptr) {
    second.push_back({Form(half->offset), Upper(0.0)});
  } else if (pair.kind == PairClass::kCablesCables) {
    const auto ends = cable(pair.second, turned_u, in_platform, end_shifts(pair, pair.second, in_platform));
    for (const Projection& end : ends) second.push_back(end);
  } else if (in_platform && pair.kind == PairClass::kPlatformObstacles) {
    const ConvexBody<I>& body = second_hull(box_.bodies, pair);
    for (const Vector3<I>& x : body.points) {
      second.push_back({dot(turned_u.other, x) - turned_u.of_origin, obstacle_shift(x)});
    }
  } else {
    const ConvexBody<I>& body = second_hull(box_.bodies, pair);
    std::optional<I> farthest;
    for (const Vector3<I>& x : body.points) {
      const I at = dot(turned_u.u, x);
      farthest = farthest ? larger(*farthest, at) : at;
    }
    second.push_back({Form(farthest.value()), Upper(0.0)});
  }

  std::optional<GapBound<I, Slope>> result;
  for (const Projection& a : first(pair, turned_u, in_platform)) {
    for (const Projection& b : second) {
      Form value = (a.at - b.at) * inverse_norm - needed;
      value.tighten(box_.offset);
      const I disturbed = value.range + ProofScalarTraits<I>::symmetric(a.shift + b.shift);
      result = result ? GapBound<I, Slope>{lesser(result->value, value), lesser(result->disturbed, disturbed)}
                      : GapBound<I, Slope>{value, disturbed};
    }
  }
  return result.value();
}

/// The points of a body over T, in W; of a cable the ends of its checked part, of a mesh those of an element.
template <class I, class Slope>
std::vector<Vector3<SlopeForm<I, Slope>>> BodyGaps<I, Slope>::points(
    const CheckedPair<I>& pair, bool is_first, const std::optional<std::uint32_t>& element) const {
  const auto of_platform = [&](const Vector3<I>& x) {
    Vector3<Form> y;
    for (int k = 0; k < 3; ++k) {
      y(k) = box_.p_WP(k) + box_.r_WP(k, 0) * x(0) + box_.r_WP(k, 1) * x(1) + box_.r_WP(k, 2) * x(2);
    }
    return y;
  };
  std::vector<Vector3<Form>> result;
  const std::size_t n = is_first ? pair.first : pair.second;
  const bool is_cable = is_first ? pair.kind != PairClass::kPlatformObstacles : pair.kind == PairClass::kCablesCables;
  if (is_cable) {
    const Vector3<Form> end = of_platform(box_.model.p_PB[n]);
    std::array<Vector3<Form>, 2> ends;
    for (int k = 0; k < 3; ++k) {
      const Form base(box_.model.p_WA[n](k));
      const Form along = end(k) - base;
      for (std::size_t side = 0; side < 2; ++side) {
        Form share(0.0);  // of the undisturbed cable
        if (box_.bodies.is_cut[n][side]) share = reciprocal(box_.length[n]) * box_.bodies.cable_free[n][side];
        ends[side](k) = side == 0 ? base + share * along : end(k) - share * along;
      }
    }
    return {ends[0], ends[1]};
  }
  const bool is_of_platform = is_first || pair.kind == PairClass::kCablesPlatform;
  const ConvexBody<I>& body =
      is_of_platform ? box_.bodies.platform[n] : std::get<ConvexBody<I>>(box_.bodies.obstacles[n]);
  const auto add = [&](const Vector3<I>& x) {
    result.push_back(is_of_platform ? of_platform(x) : Vector3<Form>{Form(x(0)), Form(x(1)), Form(x(2))});
  };
  if (body.mesh != nullptr) {
    for (const auto& corner : body.mesh->mesh->points(element.value())) add(body.mesh->place(corner));
  } else {
    for (const Vector3<I>& x : body.points) add(x);
  }
  return result;
}

template <class I, class Slope>
Vector3<SlopeForm<I, Slope>> BodyGaps<I, Slope>::mean(const std::vector<Vector3<Form>>& points,
                                                      const std::vector<std::int64_t>& shares) {
  if (shares.size() != points.size()) throw std::logic_error("shares of other points");
  Vector3<Form> sum(Form(0.0), Form(0.0), Form(0.0));
  for (std::size_t n = 0; n < points.size(); ++n) {
    if (shares[n] == 0) continue;
    const I share(static_cast<double>(shares[n]) / static_cast<double>(PointPair::kWhole));  // exact
    for (int k = 0; k < 3; ++k) sum(k) = sum(k) + points[n](k) * share;
  }
  return sum;
}

template <class I, class Slope>
I BodyGaps<I, Slope>::distance(const CheckedPair<I>& pair, const PointPair& shares, bool only_at_mid) const {
  const auto known = [&](Form& x) {
    x.tighten(box_.offset);
    return only_at_mid ? x.at_mid : x.range;
  };
  if (pair.kind == PairClass::kExitCones) {
    const Form value = in_cone(pair);
    return only_at_mid ? value.at_mid : value.range;
  }
  const Vector3<Form> a = mean(points(pair, true, shares.elements[0]), shares.first);
  const I near = pair.radii + required(pair, only_at_mid).at_least;
  if (const auto* half = half_space(box_.bodies, pair)) {
    const Vector3<I>& n = half->normal;
    Form height = a(0) * n(0) + a(1) * n(1) + a(2) * n(2) - half->offset;
    return known(height) / euclidean_norm(n(0), n(1), n(2)) - near;
  }
  const Vector3<Form> b = mean(points(pair, false, shares.elements[1]), shares.second);
  Vector3<Form> apart;
  for (int k = 0; k < 3; ++k) apart(k) = a(k) - b(k);
  return euclidean_norm(known(apart(0)), known(apart(1)), known(apart(2))) - near;
}

/// With v_k the four vectors, Σ_k c_k v_k = 0 for c_0 = det(v_1 v_2 v_3), c_1 = −det(v_0 v_2 v_3) and so on. If all c_k
/// have one sign, 0 is a convex combination of the v_k, and the same one of either body's points is a common point.
/// |c_k| is then the distance of 0 from the plane of the three others times the length of the normal
/// (v_b − v_a) × (v_c − v_a). If none of these distances is below r, differences of the bodies' points fill a ball of
/// radius r about 0: the two can't be told apart by a shorter translation than r and both radii together.
template <class I, class Slope>
bool BodyGaps<I, Slope>::meet(const CheckedPair<I>& pair, const std::array<PointPair, 4>& shares) const {
  const std::vector<Vector3<Form>> first = points(pair, true, {}), second = points(pair, false, {});
  std::array<Vector3<Form>, 4> v;
  for (std::size_t n = 0; n < 4; ++n) {
    const Vector3<Form> a = mean(first, shares[n].first), b = mean(second, shares[n].second);
    for (int k = 0; k < 3; ++k) {
      v[n](k) = a(k) - b(k);
      v[n](k).tighten(box_.offset);
    }
  }
  const I deep = -(pair.radii + required(pair, false).at_least);
  const bool may_overlap = !(upper_bound(deep) <= 0);
  int positive = 0, negative = 0;
  for (std::size_t n = 0; n < 4; ++n) {
    const Vector3<Form>&a = v[n == 0 ? 1 : 0], &b = v[n <= 1 ? 2 : 1], &c = v[n <= 2 ? 3 : 2];
    Form determinant =
        a(0) * (b(1) * c(2) - b(2) * c(1)) + a(1) * (b(2) * c(0) - b(0) * c(2)) + a(2) * (b(0) * c(1) - b(1) * c(0));
    determinant.tighten(box_.offset);
    const I share = n % 2 == 0 ? determinant.range : I(-determinant.range);
    positive += certainly_positive(share) ? 1 : 0;
    negative += certainly_positive(I(-share)) ? 1 : 0;
    if (!may_overlap) continue;
    Vector3<I> to_b, to_c;
    for (int k = 0; k < 3; ++k) {
      to_b(k) = (b(k) - a(k)).range;
      to_c(k) = (c(k) - a(k)).range;
    }
    const I normal = euclidean_norm(to_b(1) * to_c(2) - to_b(2) * to_c(1), to_b(2) * to_c(0) - to_b(0) * to_c(2),
                                    to_b(0) * to_c(1) - to_b(1) * to_c(0));
    const I least = deep * normal;
    if (!certainly_positive(I(share - least)) && !certainly_positive(I(-share - least))) return false;
  }
  return positive == 4 || negative == 4;
}

template class BodyGaps<Interval>;
template class BodyGaps<MpInterval>;
template class BodyGaps<Interval, Gradient<Interval, 2>>;
template class BodyGaps<Interval, Gradient<Interval, 3>>;

}  // namespace taut
