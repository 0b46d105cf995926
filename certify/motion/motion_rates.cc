// SPDX-License-Identifier: GPL-3.0-or-later
#include "certify/motion/motion_rates.h"

#include <vector>

#include "certify/motion/enclosed_inverse.h"
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
std::optional<PathRatesOf<I, N>> of_lengths(const Model<I>& model, const Segment& segment, const I& range, const I& mid,
                                            const I& offset) {
  const MotionEnclosure<I> motion = forward_kinematics(model, segment, range, mid, offset);
  if (!motion.is_enclosed()) return std::nullopt;
  const Vector3<I> p = ranges(motion.p_WP);
  const Matrix3<I> r = ranges(motion.r_WP);
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
}

template <class I>
template <int N>
std::optional<PathRatesOf<I, N>> MotionRates<I>::on_constraints(
    const Derivatives<N>& of, const Segment& segment, const I& range,
    const typename ImpliedParameters<I>::Where& implied) const {
  const ConstrainedCurve<I, N> curve(segment, constraints_->count, range);
  EnclosedInverse<I> inverse;
  if (!inverse.set(curve.by_unknowns(constraints_->jets, implied.lambda))) return std::nullopt;
  std::vector<Taylor<I, N>> parameters =
      implied_parameters(*of.constraints, curve, implied.y, [&](const Vector6<I>& v) { return inverse.times(v); });
  for (std::size_t j = 0; j < parameters.size(); ++j) parameters[j].d[0] = implied.lambda[j];
  return of.poses.of(parameters);
}

template <class I>
auto MotionRates<I>::over(const Model<I>& model, const Segment& segment, const I& range) const -> std::optional<Over> {
  Over result{range, ProofScalarTraits<I>::point(range), {}, std::nullopt};
  const I offset = range - result.mid;
  std::optional<ThirdPathRates<I>> path;
  switch (segment.law) {
    case Interpolation::kGeodesic: path = along_geodesic<3>(segment, range, result.mid, offset); break;
    case Interpolation::kCableLengths: path = of_lengths<3>(model, segment, range, result.mid, offset); break;
    case Interpolation::kStraight:
    case Interpolation::kCubicBSpline:
      if (!constraints_) {
        path = third_.poses.along_curve(segment, range);
        break;
      }
      result.implied = enclose_implied_parameters(*constraints_, segment, range, result.mid, offset);
      if (result.implied) path = on_constraints(third_, segment, range, result.implied->over);
  }
  if (!path) return std::nullopt;
  result.path = *std::move(path);
  return result;
}

template <class I>
std::optional<PathRates<I>> MotionRates<I>::at_middle(const Model<I>& model, const Segment& segment,
                                                      const Over& over) const {
  const I &mid = over.mid, none(0.0);
  switch (segment.law) {
    case Interpolation::kGeodesic: return along_geodesic<2>(segment, mid, mid, none);
    case Interpolation::kCableLengths: return of_lengths<2>(model, segment, mid, mid, none);
    case Interpolation::kStraight:
    case Interpolation::kCubicBSpline: break;
  }
  if (!constraints_) return second_.poses.along_curve(segment, mid);
  return on_constraints(second_, segment, mid, over.implied->at_mid);
}

template class MotionRates<Interval>;
template class MotionRates<MpInterval>;

}  // namespace taut
