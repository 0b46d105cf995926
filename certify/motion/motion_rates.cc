// SPDX-License-Identifier: GPL-3.0-or-later
#include "certify/motion/motion_rates.h"

#include <vector>

#include "certify/motion/enclosed_inverse.h"
#include "certify/motion/forms_in_lanes.h"
#include "certify/motion/length_controlled_motion.h"
#include "kinematics/implied_rates.h"

namespace taut {
namespace {

template <class I>
Vector3<I> ranges(const Vector3<SlopeForm<I>>& x) {
  return {x(0).range, x(1).range, x(2).range};
}

template <class I>
Matrix3<I> ranges(const Matrix3<SlopeForm<I>>& x) {
  Matrix3<I> result;
  for (int k = 0; k < 9; ++k) result(k) = x(k).range;
  return result;
}

/// @param mid, offset  a number of the range, and all that a place of it may be beyond that
template <int N, class I>
std::optional<PathRatesOf<I, N>> along_geodesic(const Segment& segment, const I& range, const I& mid, const I& offset) {
  const std::optional<Geodesic<I>> geodesic = enclose_geodesic(segment, range, mid, offset);
  if (!geodesic) return std::nullopt;
  PathRatesOf<I, N> result;
  result.p = ranges(geodesic->p_WP);
  result.r_WP = ranges(geodesic->r_WP);
  result.w = geodesic->turn;
  for (int k = 0; k < 3; ++k) {
    result.p1(k) = geodesic->p_WP(k).slope;  // p is straight
    result.p2(k) = result.w1(k) = I(0.0);
    if constexpr (N == 3) result.p3(k) = result.w2(k) = I(0.0);
  }
  return result;
}

template <int N, class I>
std::optional<PathRatesOf<I, N>> of_lengths(const Model<I>& model, const Segment& segment, const I& range,
                                            const Vector3<I>& p, const Matrix3<I>& r) {
  EnclosedInverse<I> inverse;
  if (!inverse.set(length_gradients(model, p, r))) return std::nullopt;
  return rates_of_lengths<N>(model, p, r, segment, range, [&](const Vector6<I>& v) { return inverse.times(v); });
}

}  // namespace

template <class I>
template <int N>
MotionRates<I>::Derivatives<N>::Derivatives(const Problem& problem) : poses(problem) {
  if (!problem.space.constraints.empty()) constraints.emplace(constraint_tape(problem));
}

template <class I>
MotionRates<I>::MotionRates(const Problem& problem) : second_(problem), third_(problem) {
  if (!problem.space.constraints.empty()) constraints_.emplace(make_constraint_model<I>(problem));
  if constexpr (std::is_same_v<I, Interval>) lanes_ = make_lanes_machine(make_model_without_ellipsoid<I>(problem));
}

template <class I>
template <int N>
std::optional<PathRatesOf<I, N>> MotionRates<I>::on_constraints(const Derivatives<N>& of, const Segment& segment,
                                                                const I& range,
                                                                const typename ImpliedParameters<I>::Where& implied,
                                                                const Matrix3<I>* known) const {
  const ConstrainedCurve<I, N> curve(segment, constraints_->count, range);
  EnclosedInverse<I> inverse;
  const std::span<const I> lambda(implied.lambda.data(), implied.lambda.size());
  const auto gradients = curve.gradients(constraints_->jets, lambda);
  if (!inverse.set(curve.by_unknowns(gradients))) return std::nullopt;
  auto parameters = implied_parameters(*of.constraints, curve, gradients, implied.y,
                                       [&](const Vector6<I>& v) { return inverse.times(v); });
  for (std::size_t j = 0; j < parameters.size(); ++j) parameters[j].d[0] = lambda[j];
  return of.poses.of(std::span<const Taylor<I, N>>(parameters.data(), parameters.size()), known);
}

template <class I>
auto MotionRates<I>::over(const Model<I>& model, const Segment& segment, const I& range,
                          const KnownMotion<I>* known) const -> std::optional<Over> {
  Over result{range, known != nullptr ? known->mid : I(ProofScalarTraits<I>::point(range)), {}, {}, {}};
  const I offset = range - result.mid;
  const MotionEnclosure<I>* motion = known != nullptr ? &known->motion : nullptr;
  MotionEnclosure<I> of_lengths_found;
  if (motion == nullptr && segment.law == Interpolation::kCableLengths) {
    of_lengths_found = forward_kinematics(model, segment, range, result.mid, offset);
    if (!of_lengths_found.is_enclosed()) return std::nullopt;
    motion = &of_lengths_found;
  }
  Vector3<I> p;
  Matrix3<I> r_WP;
  if (motion != nullptr) {
    p = ranges(motion->p_WP);
    r_WP = ranges(motion->r_WP);
    result.at_mid.emplace();
    for (int k = 0; k < 3; ++k) result.at_mid->p(k) = motion->p_WP(k).at_mid;
    for (int k = 0; k < 9; ++k) result.at_mid->r_WP(k) = motion->r_WP(k).at_mid;
  }
  const Matrix3<I>* turned = motion != nullptr ? &r_WP : nullptr;
  std::optional<ThirdPathRates<I>> path;
  switch (segment.law) {
    case Interpolation::kGeodesic: path = along_geodesic<3>(segment, range, result.mid, offset); break;
    case Interpolation::kCableLengths: path = of_lengths<3>(model, segment, range, p, r_WP); break;
    case Interpolation::kStraight:
    case Interpolation::kCubicBSpline:
      if (!constraints_) {
        path = third_.poses.along_curve(segment, range, turned);
        break;
      }
      result.implied = motion != nullptr
                           ? motion->implied
                           : enclose_implied_parameters(*constraints_, segment, range, result.mid, offset);
      if (result.implied) path = on_constraints(third_, segment, range, result.implied->over, turned);
  }
  if (!path) return std::nullopt;
  if (motion != nullptr) path->p = p;
  result.path = *std::move(path);
  return result;
}

template <class I>
std::optional<PathRates<I>> MotionRates<I>::at_middle(const Model<I>& model, const Segment& segment,
                                                      const Over& over) const {
  const I &mid = over.mid, none(0.0);
  const Matrix3<I>* turned = over.at_mid ? &over.at_mid->r_WP : nullptr;
  switch (segment.law) {
    case Interpolation::kGeodesic: return along_geodesic<2>(segment, mid, mid, none);
    case Interpolation::kCableLengths: return of_lengths<2>(model, segment, mid, over.at_mid->p, over.at_mid->r_WP);
    case Interpolation::kStraight:
    case Interpolation::kCubicBSpline: break;
  }
  if (!constraints_) return second_.poses.along_curve(segment, mid, turned);
  return on_constraints(second_, segment, mid, over.implied->at_mid, turned);
}

template class MotionRates<Interval>;
template class MotionRates<MpInterval>;

}  // namespace taut
