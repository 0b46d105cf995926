#include "certify/motion.h"

#include <Eigen/LU>
#include <algorithm>
#include <boost/container/small_vector.hpp>
#include <cmath>
#include <limits>

#include "certify/neumann.h"
#include "kinematics/geometry.h"
#include "kinematics/input_error.h"

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
using Parameters = boost::container::small_vector<Centered<I>, kFewParameters>;

template <class I>
Centered<I> over_box(const Polynomial<I>& x, const I& range, const I& mid) {
  return {x.at(mid), x.slope(range), x.at(range)};
}

/// ℓ.
template <class I>
Parameters<I> line_over_box(const Segment& segment, const I& range, const I& mid, const I& offset) {
  Parameters<I> parameters;
  for (std::size_t j = 0; j < segment.control[0]->x.size(); ++j) {
    parameters.push_back(over_box(coordinate_polynomial<I>(segment, j), range, mid));
    if (segment.law != Interpolation::kStraight) parameters.back().tighten(offset);
  }
  return parameters;
}

/// Finds y(t), K = number of constraints. Symbols as in the header.
template <std::size_t K, class I>
class ImpliedMotion {
 public:
  ImpliedMotion(const typename MotionModel<I>::Constraints& constraints, const Segment& segment,
                const Parameters<I>& line, const I& range, const I& mid, const I& offset)
      : constraints_(constraints), line_(line), offset_(offset), tube_(segment.tube) {
    for (std::size_t j = 0; j < line.size(); ++j) {
      for (std::size_t i = 0; i < K; ++i) {
        normal_[j][i] = over_box(normal_polynomial<I>(segment, j * K + i), range, mid);
      }
    }
  }

  /// λ = ℓ + N y over T; nothing if (a) or (b) fails.
  [[nodiscard]] bool parameters(Parameters<I>& result) {
    if (!(tube_ > 0) || !std::isfinite(tube_) || !start_newton()) return false;
    Vector whole;
    whole.fill(I(-tube_, tube_));
    Vector inside;
    if (!stay_inside(krawczyk(whole), inside)) return false;
    const Step second = krawczyk(inside);
    Square<Upper, K> q;
    if (!neumann_bound<I>(magnitudes(second.rest), q)) return false;

    std::array<Centered<I>, K> y;
    for (std::size_t i = 0; i < K; ++i) {
      Upper error(0.0);
      for (std::size_t k = 0; k < K; ++k) error += q[i][k] * Upper(magnitude(second.drift[k]));
      y[i].range = intersect(second.image[i], inside[i]);
      y[i].slope = Scalars<I>::symmetric(error) - second.drift[i];
      y[i].at_mid = y[i].range;
    }
    enclose_at_mid(y);
    result = line_;
    for (std::size_t j = 0; j < result.size(); ++j) {
      for (std::size_t i = 0; i < K; ++i) result[j] = result[j] + normal_[j][i] * y[i];
      result[j].tighten(offset_);
    }
    return true;
  }

 private:
  using Point = typename Scalars<I>::Point;
  using Upper = UpperOf<I>;
  using Vector = std::array<I, K>;
  using Gradient = std::array<std::array<I, kMaxConstrainedParameters>, K>;
  using J = Jet<I, kMaxConstrainedParameters>;

  struct Step {
    Vector image;       ///< (c)
    Square<I, K> rest;  ///< I − A g_y
    Vector drift;       ///< A g_t
  };

  /// ℓ + N y, at m or over T.
  [[nodiscard]] std::array<I, kMaxConstrainedParameters> at(const Vector& y, I Centered<I>::*where) const {
    std::array<I, kMaxConstrainedParameters> lambda;
    for (std::size_t j = 0; j < line_.size(); ++j) {
      lambda[j] = line_[j].*where;
      for (std::size_t i = 0; i < K; ++i) lambda[j] = lambda[j] + normal_[j][i].*where * y[i];
    }
    return lambda;
  }

  [[nodiscard]] Vector values(const Vector& y) const {
    const auto lambda = at(y, &Centered<I>::at_mid);
    Vector result;
    constraints_.values.evaluate(std::span<const I>(lambda.data(), line_.size()), result);
    return result;
  }

  [[nodiscard]] Gradient gradient(const Vector& y, I Centered<I>::*where) const {
    const auto lambda = at(y, where);
    std::array<J, kMaxConstrainedParameters> jets;
    for (std::size_t j = 0; j < line_.size(); ++j) jets[j] = J(lambda[j], static_cast<int>(j));
    std::array<J, K> c;
    constraints_.jets.evaluate(std::span<const J>(jets.data(), line_.size()), c);
    Gradient result;
    for (std::size_t i = 0; i < K; ++i) result[i] = c[i].partial;
    return result;
  }

  /// A g_y from the gradient of C.
  [[nodiscard]] Square<I, K> preconditioned(const Gradient& gradient, I Centered<I>::*where) const {
    Square<I, K> result;
    for (std::size_t i = 0; i < K; ++i) {
      for (std::size_t k = 0; k < K; ++k) {
        I sum(0.0);
        for (std::size_t j = 0; j < line_.size(); ++j) sum = sum + gradient[i][j] * (normal_[j][k].*where);
        result[i][k] = sum;
      }
    }
    return times_a(result);
  }

  [[nodiscard]] Square<I, K> times_a(const Square<I, K>& x) const {
    Square<I, K> result;
    for (std::size_t i = 0; i < K; ++i) {
      for (std::size_t k = 0; k < K; ++k) {
        result[i][k] = a_[i][0] * x[0][k];
        for (std::size_t l = 1; l < K; ++l) result[i][k] = result[i][k] + a_[i][l] * x[l][k];
      }
    }
    return result;
  }

  [[nodiscard]] Vector times_a(const Vector& x) const {
    Vector result;
    for (std::size_t i = 0; i < K; ++i) {
      result[i] = a_[i][0] * x[0];
      for (std::size_t l = 1; l < K; ++l) result[i] = result[i] + a_[i][l] * x[l];
    }
    return result;
  }

  static Square<I, K> one_minus(Square<I, K> x) {
    for (std::size_t i = 0; i < K; ++i) {
      for (std::size_t k = 0; k < K; ++k) x[i][k] = I(i == k ? 1.0 : 0.0) - x[i][k];
    }
    return x;
  }

  static Square<Upper, K> magnitudes(const Square<I, K>& x) {
    Square<Upper, K> result;
    for (std::size_t i = 0; i < K; ++i) {
      for (std::size_t k = 0; k < K; ++k) result[i][k] = Upper(magnitude(x[i][k]));
    }
    return result;
  }

  /// Chooses A and ŷ: any choice is sound, a good one is near g_y^-1 and y(m).
  [[nodiscard]] bool start_newton() {
    centre_.fill(I(0.0));
    for (auto& row : a_) row.fill(I(0.0));
    for (std::size_t i = 0; i < K; ++i) a_[i][i] = I(1.0);
    const Square<I, K> g_y = preconditioned(gradient(centre_, &Centered<I>::at_mid), &Centered<I>::at_mid);
    Eigen::Matrix<double, static_cast<int>(K), static_cast<int>(K)> mid;
    for (std::size_t i = 0; i < K; ++i) {
      for (std::size_t k = 0; k < K; ++k) {
        mid(static_cast<int>(i), static_cast<int>(k)) = 0.5 * (lower_bound(g_y[i][k]) + upper_bound(g_y[i][k]));
      }
    }
    const auto inverse = mid.inverse().eval();
    if (!inverse.allFinite()) return false;
    for (std::size_t i = 0; i < K; ++i) {
      for (std::size_t k = 0; k < K; ++k) a_[i][k] = I(inverse(static_cast<int>(i), static_cast<int>(k)));
    }
    // Simplified Newton: each step gains the digits that the curvature over the tube leaves, or those of a binary64.
    constexpr int kMostSteps = 60;
    double last = std::numeric_limits<double>::infinity();
    for (int step = 0; step < kMostSteps; ++step) {
      const Vector correction = times_a(values(centre_));
      double size = 0;
      for (std::size_t i = 0; i < K; ++i) {
        const Point y = Scalars<I>::point(centre_[i] - correction[i]);
        centre_[i] = I(y);
        const double moved = Scalars<I>::to_double(Upper(magnitude(correction[i])));
        size = std::max(size, moved);
        if (!(Scalars<I>::to_double(Upper(magnitude(centre_[i]))) < tube_)) return false;
      }
      if (!(size < 0.5 * last)) break;  // what is left is the width of the enclosures
      last = size;
    }
    residual_ = times_a(values(centre_));
    return true;
  }

  /// The box ŷ ± w of (b), where it is inside the tube and ρ < 1.
  [[nodiscard]] bool stay_inside(const Step& over_tube, Vector& box) const {
    Upper rho(0.0);
    Upper largest(0.0);
    for (std::size_t i = 0; i < K; ++i) {
      Upper row_sum(0.0);
      for (const I& x : over_tube.rest[i]) row_sum += Upper(magnitude(x));
      if (!(row_sum < Upper(1.0))) return false;  // also where a NaN slipped in, which max() would drop
      rho = std::max(rho, row_sum);
      largest = std::max(largest, Upper(magnitude(residual_[i])) + Upper(magnitude(over_tube.drift[i] * offset_)));
    }
    const Upper gap = Scalars<I>::one_minus_lower(rho);
    if (!(Upper(0.0) < gap)) return false;
    const I w = Scalars<I>::symmetric(largest / gap);
    for (std::size_t i = 0; i < K; ++i) {
      box[i] = centre_[i] + w;
      if (!(lower_bound(box[i]) > -tube_ && upper_bound(box[i]) < tube_)) return false;
    }
    return true;
  }

  /// (c) for a box Z that contains ŷ.
  [[nodiscard]] Step krawczyk(const Vector& box) const {
    const Gradient over = gradient(box, &Centered<I>::range);
    Step step;
    step.rest = one_minus(preconditioned(over, &Centered<I>::range));
    Vector g_t;
    g_t.fill(I(0.0));
    for (std::size_t j = 0; j < line_.size(); ++j) {
      I slope = line_[j].slope;
      for (std::size_t i = 0; i < K; ++i) slope = slope + normal_[j][i].slope * box[i];
      for (std::size_t i = 0; i < K; ++i) g_t[i] = g_t[i] + over[i][j] * slope;
    }
    step.drift = times_a(g_t);
    for (std::size_t i = 0; i < K; ++i) {
      I image = centre_[i] - residual_[i] - step.drift[i] * offset_;
      for (std::size_t k = 0; k < K; ++k) image = image + step.rest[i][k] * (box[k] - centre_[k]);
      step.image[i] = image;
    }
    return step;
  }

  /// Narrows y(m) by a Krawczyk test at m alone in a box ŷ ± δ within the tube: the zero in it is the one in the tube.
  void enclose_at_mid(std::array<Centered<I>, K>& y) const {
    constexpr double kRoom = 4.0;
    double largest = 0;
    for (const I& r : residual_) largest = std::max(largest, Scalars<I>::to_double(Upper(magnitude(r))));
    const double delta = kRoom * largest + std::numeric_limits<double>::min();
    Vector box;
    for (std::size_t i = 0; i < K; ++i) {
      box[i] = centre_[i] + I(-delta, delta);
      if (!(lower_bound(box[i]) > -tube_ && upper_bound(box[i]) < tube_)) return;
    }
    const Square<I, K> rest = one_minus(preconditioned(gradient(box, &Centered<I>::at_mid), &Centered<I>::at_mid));
    Vector image;
    for (std::size_t i = 0; i < K; ++i) {
      I step = I(0.0) - residual_[i];
      for (std::size_t k = 0; k < K; ++k) step = step + rest[i][k] * I(-delta, delta);
      if (!(lower_bound(step) > -delta && upper_bound(step) < delta)) return;
      image[i] = centre_[i] + step;
    }
    for (std::size_t i = 0; i < K; ++i) y[i].at_mid = intersect(image[i], y[i].range);
  }

  const typename MotionModel<I>::Constraints& constraints_;
  const Parameters<I>& line_;
  std::array<std::array<Centered<I>, K>, kMaxConstrainedParameters> normal_;
  const I& offset_;
  double tube_;
  Square<I, K> a_;   ///< A, thin
  Vector centre_;    ///< ŷ, thin
  Vector residual_;  ///< A g(ŷ, m)
};

/// Whether each control point has a finite entry of N for each of `count` constraints: intervals must not be made of anything
/// else.
bool has_normals(const Segment& segment, std::size_t count) {
  return std::ranges::all_of(segment.controls(), [&](const Waypoint* waypoint) {
    return waypoint->normals.size() == waypoint->x.size() * count &&
           std::ranges::all_of(waypoint->normals, [](double x) { return std::isfinite(x); });
  });
}

template <class I, std::size_t K = 1>
bool implied_parameters(const MotionModel<I>& model, const Segment& segment, const I& range, const I& mid,
                        const I& offset, Parameters<I>& parameters) {
  if (model.constraints->count == K) {
    const Parameters<I> line = parameters;
    return ImpliedMotion<K, I>(*model.constraints, segment, line, range, mid, offset).parameters(parameters);
  }
  if constexpr (K + 1 < kMaxConstrainedParameters) {
    return implied_parameters<I, K + 1>(model, segment, range, mid, offset, parameters);
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

template <class I>
MotionModel<I> make_motion_model(const Problem& problem) {
  MotionModel<I> model{Evaluator<Centered<I>>(pose_tape(problem)), std::nullopt, inner_ranges(problem)};
  if (const std::size_t count = problem.space.constraints.size(); count > 0) {
    const ExpressionTape tape = constraint_tape(problem);
    model.constraints.emplace(typename MotionModel<I>::Constraints{
        Evaluator<I>(tape), Evaluator<Jet<I, kMaxConstrainedParameters>>(tape), count});
  }
  return model;
}

template <class I>
MotionEnclosure<I> enclose_motion(const MotionModel<I>& model, const Segment& segment, const I& range, const I& mid,
                                  const I& offset) {
  using Status = typename MotionEnclosure<I>::Status;
  MotionEnclosure<I> result;
  if (has_poses(segment.law)) return result;
  Parameters<I> parameters = line_over_box(segment, range, mid, offset);
  result.status = Status::kKnown;
  if (model.constraints) {
    if (!has_normals(segment, model.constraints->count) ||
        !implied_parameters(model, segment, range, mid, offset, parameters)) {
      result.status = Status::kUnproved;
      return result;
    }
    result.status = within_ranges(model, parameters);
  }
  const Pose<Centered<I>> pose =
      evaluate_pose(model.pose, std::span<const Centered<I>>(parameters.data(), parameters.size()));
  result.p_WP = pose.p_WP;
  result.r_WP = rotation(pose.phi, pose.theta, pose.sigma);
  for (int i = 0; i < 3; ++i) {
    result.p_WP(i).tighten(offset);
    for (int j = 0; j < 3; ++j) result.r_WP(i, j).tighten(offset);
  }
  return result;
}

template MotionModel<Interval> make_motion_model(const Problem&);
template MotionModel<MpInterval> make_motion_model(const Problem&);
template MotionEnclosure<Interval> enclose_motion(const MotionModel<Interval>&, const Segment&, const Interval&,
                                                  const Interval&, const Interval&);
template MotionEnclosure<MpInterval> enclose_motion(const MotionModel<MpInterval>&, const Segment&, const MpInterval&,
                                                    const MpInterval&, const MpInterval&);

}  // namespace taut
