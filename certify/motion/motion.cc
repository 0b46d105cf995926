// SPDX-License-Identifier: GPL-3.0-or-later
#include "certify/motion/motion.h"

#include <algorithm>
#include <boost/container/small_vector.hpp>
#include <cmath>
#include <limits>
#include <type_traits>

#include "base/input_error.h"
#include "certify/motion/parametric_krawczyk.h"
#include "kinematics/geometry.h"
#include "kinematics/quaternion.h"

namespace taut {
namespace {

constexpr mpfr_prec_t kRangePrecision = 256;

std::vector<std::array<double, 2>> inner_ranges(const Problem& problem) {
  constexpr double kEverything = std::numeric_limits<double>::infinity();
  const PrecisionScope precision(kRangePrecision);
  std::vector<std::array<double, 2>> ranges;
  for (const Parameter& parameter : problem.space.parameters) {
    ranges.push_back({-kEverything, kEverything});
    if (parameter.kind != ParameterKind::kRange) continue;
    Faults<MpInterval>::clear();
    ranges.back() = {upper_bound(evaluate_constant<MpInterval>(parameter.range_lower)),
                     lower_bound(evaluate_constant<MpInterval>(parameter.range_upper))};
    if (Faults<MpInterval>::raised()) {
      throw InputError("space.parameters." + parameter.name + ": got a range whose ends are not defined");
    }
  }
  return ranges;
}

/// Parameters of a space that need no allocation.
constexpr std::size_t kFewParameters = 8;

template <class I>
using Parameters = boost::container::small_vector<SlopeForm<I>, kFewParameters>;

template <class I>
SlopeForm<I> over_box(const Polynomial<I>& x, const I& range, const I& mid) {
  return {x.at(mid), x.slope(range), x.at(range)};
}

/// ℓ.
template <class I>
Parameters<I> line_over_box(const Segment& segment, const I& range, const I& mid, const I& offset) {
  Parameters<I> parameters;
  const std::size_t count = segment.control[0]->parameters().x.size();
  for (std::size_t j = 0; j < count; ++j) {
    parameters.push_back(over_box(coordinate_polynomial<I>(segment, j), range, mid));
    if (segment.law != Interpolation::kStraight) parameters.back().tighten(offset);
  }
  return parameters;
}

/// g(y, t) = C(ℓ(t) + N(t) y).
template <std::size_t K, class I>
class ConstraintSystem {
 public:
  using Vector = std::array<I, K>;

  ConstraintSystem(const ConstraintModel<I>& constraints, const Segment& segment, const Parameters<I>& line,
                   const I& range, const I& mid)
      : constraints_(constraints), line_(line) {
    for (std::size_t j = 0; j < line.size(); ++j) {
      for (std::size_t i = 0; i < K; ++i) {
        normal_[j][i] = over_box(normal_polynomial<I>(segment, j * K + i), range, mid);
      }
    }
  }

  [[nodiscard]] Vector values(const Vector& y) const {
    const auto lambda = at(y, &SlopeForm<I>::at_mid);
    Vector result;
    constraints_.values.evaluate(std::span<const I>(lambda.data(), line_.size()), result);
    return result;
  }

  [[nodiscard]] Square<I, K> derivatives(const Vector& y, EvaluationDomain domain) const {
    const auto where = domain == EvaluationDomain::kAtMid ? &SlopeForm<I>::at_mid : &SlopeForm<I>::range;
    const std::array<J, K> c = jets(at(y, where));
    Square<I, K> result;
    for (auto& row : result) row.fill(I(0.0));
    for (std::size_t j = 0; j < line_.size(); ++j) {
      for (std::size_t e = 0; e < K; ++e) {
        for (std::size_t i = 0; i < K; ++i) result[e][i] = result[e][i] + c[e].partial[j] * (normal_[j][i].*where);
      }
    }
    return result;
  }

  [[nodiscard]] EquationSlopes<K, I> slopes(const Vector& y) const {
    const std::array<J, K> c = jets(at(y, &SlopeForm<I>::range));
    EquationSlopes<K, I> result;
    result.by_t.fill(I(0.0));
    result.bend.fill(I(0.0));
    for (std::size_t j = 0; j < line_.size(); ++j) {
      I slope = line_[j].slope;
      for (std::size_t i = 0; i < K; ++i) slope = slope + normal_[j][i].slope * y[i];
      for (std::size_t e = 0; e < K; ++e) result.by_t[e] = result.by_t[e] + c[e].partial[j] * slope;
    }
    return result;
  }

  /// λ = ℓ + N y.
  [[nodiscard]] Parameters<I> parameters(const std::array<SlopeForm<I>, K>& y, const I& offset) const {
    Parameters<I> result = line_;
    for (std::size_t j = 0; j < result.size(); ++j) {
      for (std::size_t i = 0; i < K; ++i) result[j] = result[j] + normal_[j][i] * y[i];
      result[j].tighten(offset);
    }
    return result;
  }

 private:
  using J = Jet<I, kMaxConstrainedParameters>;

  /// C and its gradient.
  [[nodiscard]] std::array<J, K> jets(const std::array<I, kMaxConstrainedParameters>& lambda) const {
    std::array<J, kMaxConstrainedParameters> jets;
    for (std::size_t j = 0; j < line_.size(); ++j) jets[j] = J(lambda[j], static_cast<int>(j));
    std::array<J, K> c;
    constraints_.jets.evaluate(std::span<const J>(jets.data(), line_.size()), c);
    return c;
  }

  /// ℓ + N y, at m or over T.
  [[nodiscard]] std::array<I, kMaxConstrainedParameters> at(const Vector& y, I SlopeForm<I>::*where) const {
    std::array<I, kMaxConstrainedParameters> lambda;
    for (std::size_t j = 0; j < line_.size(); ++j) {
      lambda[j] = line_[j].*where;
      for (std::size_t i = 0; i < K; ++i) lambda[j] = lambda[j] + normal_[j][i].*where * y[i];
    }
    return lambda;
  }

  const ConstraintModel<I>& constraints_;
  const Parameters<I>& line_;
  std::array<std::array<SlopeForm<I>, K>, kMaxConstrainedParameters> normal_;
};

/// Whether each control point has a finite entry of N for each of `count` constraints: intervals must not be made of
/// anything else.
bool has_normals(const Segment& segment, std::size_t count) {
  return std::ranges::all_of(segment.controls(), [&](const Waypoint* waypoint) {
    const auto& [x, half_turns, normals] = waypoint->parameters();
    return normals.size() == x.size() * count &&
           std::ranges::all_of(normals, [](double entry) { return std::isfinite(entry); });
  });
}

template <class I, std::size_t K = 1>
bool implied_parameters(const ConstraintModel<I>& constraints, const Segment& segment, const I& range, const I& mid,
                        const I& offset, Parameters<I>& parameters, ImpliedParameters<I>& result) {
  if (constraints.count == K) {
    const Parameters<I> line = parameters;
    const ConstraintSystem<K, I> system(constraints, segment, line, range, mid);
    std::array<SlopeForm<I>, K> y;
    if (!ParametricKrawczyk<K, I, ConstraintSystem<K, I>>(system, offset, segment.tube).enclose(y)) return false;
    parameters = system.parameters(y, offset);
    result.over.y.fill(I(0.0));
    result.at_mid.y.fill(I(0.0));
    for (std::size_t i = 0; i < K; ++i) {
      result.over.y(static_cast<int>(i)) = y[i].range;
      result.at_mid.y(static_cast<int>(i)) = y[i].at_mid;
    }
    for (const SlopeForm<I>& x : parameters) {
      result.over.lambda.push_back(x.range);
      result.at_mid.lambda.push_back(x.at_mid);
    }
    return true;
  }
  if constexpr (K + 1 < kMaxConstrainedParameters) {
    return implied_parameters<I, K + 1>(constraints, segment, range, mid, offset, parameters, result);
  }
  return false;
}

template <class I>
typename MotionEnclosure<I>::Status within_ranges(const MotionModel<I>& model, const Parameters<I>& parameters) {
  using Status = typename MotionEnclosure<I>::Status;
  const auto inside = [](const I& x, const std::array<double, 2>& range) {
    return range[0] <= lower_bound(x) && upper_bound(x) <= range[1];
  };
  Status status = Status::kKnown;
  for (std::size_t j = 0; j < parameters.size(); ++j) {
    if (!inside(parameters[j].at_mid, model.ranges[j])) return Status::kOutOfRange;
    if (!inside(parameters[j].range, model.ranges[j])) status = Status::kRangeWide;
  }
  return status;
}

}  // namespace

namespace {

/// make_angles(), for Interval rounding upward.
template <class I>
Angles<I> make_angles_enclosed(const AnglesText& text) {
  if constexpr (std::is_same_v<I, Interval>) {
    Angles<I> result;
    const bool is_bounded = run_upward([&] { result = make_angles<I>(text); });
    if (!is_bounded) throw InputError("space.angles.axis: got a number beyond the range of binary64");
    return result;
  } else {
    return make_angles<I>(text);
  }
}

}  // namespace

template <class I>
ConstraintModel<I> make_constraint_model(const Problem& problem) {
  const ExpressionTape tape = constraint_tape(problem);
  return {Evaluator<I>(tape), Evaluator<Jet<I, kMaxConstrainedParameters>>(tape), problem.space.constraints.size()};
}

template <class I>
MotionModel<I> make_motion_model(const Problem& problem) {
  MotionModel<I> model{Evaluator<SlopeForm<I>>(pose_tape(problem)), make_angles_enclosed<I>(problem.space.angles),
                       std::nullopt, inner_ranges(problem)};
  if (!problem.space.constraints.empty()) model.constraints.emplace(make_constraint_model<I>(problem));
  return model;
}

namespace {

template <class I, template <class> class Pose>
void tighten(Pose<I>& motion, const I& offset) {
  for (int i = 0; i < 3; ++i) {
    motion.p_WP(i).tighten(offset);
    for (int j = 0; j < 3; ++j) motion.r_WP(i, j).tighten(offset);
  }
}

/// Quaternion of a waypoint, exact.
template <class I>
Quaternion<I> orientation(const Waypoint& waypoint) {
  const PoseNumbers& x = waypoint.pose();
  return {I(x[3]), I(x[4]), I(x[5]), I(x[6])};
}

/// The angle α of (g) in theory.md, from tan(α/2) = norm / c.
template <class I>
I double_atan2(const I& norm, const I& c) {
  const I tangent = norm / c;
  I half;
  if constexpr (std::is_same_v<I, Interval>) {
    constexpr double kSmall = 0.25;
    constexpr int kTerms = 13;  // the next is below 0.25^27 / 27 < 2^-58
    if (tangent.upper() <= kSmall) {
      // Alternating, with terms that fall: the rest lies between 0 and the first that is left out.
      const I square = sqr(tangent);
      I sum = I(0.0, 1.0) / I(2.0 * kTerms + 1);
      for (int k = kTerms - 1; k >= 0; --k) sum = I(1.0) / I(2.0 * k + 1) - square * sum;
      half = tangent * sum;
      return half + half;
    }
  }
  half = atan2(norm, c);
  return half + half;
}

/// Sets R and the turn; false where it may be half a turn.
template <class I>
bool follow_geodesic(const Segment& segment, const I& range, const I& mid, Geodesic<I>& motion) {
  const Quaternion<I> first = orientation<I>(*segment.control[0]);
  Quaternion<I> turn = conjugate(first) * orientation<I>(*segment.control[1]);
  if (certainly_positive(-turn.w)) turn = {-turn.x, -turn.y, -turn.z, -turn.w};
  if (!certainly_positive(turn.w)) return false;  // nearly so: not one geodesic
  const std::array<I, 3> v = {turn.x, turn.y, turn.z};
  const I square = sqr(v[0]) + sqr(v[1]) + sqr(v[2]);
  const I norm = sqrt(square);
  std::array<I, 3> n;
  n.fill(I(-1.0, 1.0));
  if (certainly_positive(norm)) {
    const I inverse = reciprocal(norm);
    for (std::size_t k = 0; k < 3; ++k) n[k] = intersect(n[k], v[k] * inverse);
  }
  const I angle = double_atan2(norm, turn.w);
  const SinCos<SlopeForm<I>> sc = sincos(SlopeForm<I>(angle * mid, angle, angle * range));
  const SlopeForm<I> versine = -sc.cos + I(1.0);
  const Matrix3<I> r_start = rotation(first);
  for (int i = 0; i < 3; ++i) {
    motion.turn(i) = angle * (r_start(i, 0) * n[0] + r_start(i, 1) * n[1] + r_start(i, 2) * n[2]);
  }
  Matrix3<SlopeForm<I>> about;  // I + sin [n] + (1 − cos) [n]^2, and [n]^2 = n n^T − 1
  for (int i = 0; i < 3; ++i) {
    const auto a = static_cast<std::size_t>(i);
    const auto b = static_cast<std::size_t>((i + 1) % 3);
    const auto c = static_cast<std::size_t>((i + 2) % 3);
    about(i, i) = versine * (-(sqr(n[b]) + sqr(n[c]))) + I(1.0);
    const SlopeForm<I> product = versine * (n[a] * n[b]);
    about(i, static_cast<int>(b)) = product - sc.sin * n[c];
    about(static_cast<int>(b), i) = product + sc.sin * n[c];
  }
  for (int i = 0; i < 3; ++i) {
    for (int j = 0; j < 3; ++j) {
      motion.r_WP(i, j) = about(0, j) * r_start(i, 0) + about(1, j) * r_start(i, 1) + about(2, j) * r_start(i, 2);
    }
  }
  return true;
}

}  // namespace

template <class I>
std::optional<Geodesic<I>> enclose_geodesic(const Segment& segment, const I& range, const I& mid, const I& offset) {
  Geodesic<I> result;
  for (int i = 0; i < 3; ++i) {
    result.p_WP(i) = over_box(position_polynomial<I>(segment, static_cast<std::size_t>(i)), range, mid);
  }
  if (!follow_geodesic(segment, range, mid, result)) return std::nullopt;
  tighten(result, offset);
  return result;
}

template <class I>
std::optional<ImpliedParameters<I>> enclose_implied_parameters(const ConstraintModel<I>& constraints,
                                                               const Segment& segment, const I& range, const I& mid,
                                                               const I& offset) {
  if (!has_normals(segment, constraints.count)) return std::nullopt;
  Parameters<I> parameters = line_over_box(segment, range, mid, offset);
  std::optional<ImpliedParameters<I>> result(std::in_place);
  if (!implied_parameters(constraints, segment, range, mid, offset, parameters, *result)) result.reset();
  return result;
}

template <class I>
MotionEnclosure<I> enclose_motion(const MotionModel<I>& model, const Segment& segment, const I& range, const I& mid,
                                  const I& offset) {
  using Status = typename MotionEnclosure<I>::Status;
  MotionEnclosure<I> result;
  if (has_poses(segment.law)) {
    if (std::optional<Geodesic<I>> geodesic = enclose_geodesic(segment, range, mid, offset)) {
      result = {Status::kKnown, std::move(geodesic->p_WP), std::move(geodesic->r_WP)};
    }
    return result;
  }
  Parameters<I> parameters = line_over_box(segment, range, mid, offset);
  result.status = Status::kKnown;
  if (model.constraints) {
    result.implied.emplace();
    if (!has_normals(segment, model.constraints->count) ||
        !implied_parameters(*model.constraints, segment, range, mid, offset, parameters, *result.implied)) {
      return {};
    }
    result.status = within_ranges(model, parameters);
  }
  const Pose<SlopeForm<I>> pose =
      evaluate_pose(model.pose, std::span<const SlopeForm<I>>(parameters.data(), parameters.size()));
  result.p_WP = pose.p_WP;
  result.r_WP = rotation(model.angles, pose.angles);
  tighten(result, offset);
  return result;
}

template ConstraintModel<Interval> make_constraint_model(const Problem&);
template ConstraintModel<MpInterval> make_constraint_model(const Problem&);
template std::optional<ImpliedParameters<Interval>> enclose_implied_parameters(const ConstraintModel<Interval>&,
                                                                               const Segment&, const Interval&,
                                                                               const Interval&, const Interval&);
template std::optional<ImpliedParameters<MpInterval>> enclose_implied_parameters(const ConstraintModel<MpInterval>&,
                                                                                 const Segment&, const MpInterval&,
                                                                                 const MpInterval&, const MpInterval&);
template std::optional<Geodesic<Interval>> enclose_geodesic(const Segment&, const Interval&, const Interval&,
                                                            const Interval&);
template std::optional<Geodesic<MpInterval>> enclose_geodesic(const Segment&, const MpInterval&, const MpInterval&,
                                                              const MpInterval&);
template MotionModel<Interval> make_motion_model(const Problem&);
template MotionModel<MpInterval> make_motion_model(const Problem&);
template MotionEnclosure<Interval> enclose_motion(const MotionModel<Interval>&, const Segment&, const Interval&,
                                                  const Interval&, const Interval&);
template MotionEnclosure<MpInterval> enclose_motion(const MotionModel<MpInterval>&, const Segment&, const MpInterval&,
                                                    const MpInterval&, const MpInterval&);

}  // namespace taut
