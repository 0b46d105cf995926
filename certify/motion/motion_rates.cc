// SPDX-License-Identifier: GPL-3.0-or-later
#include "certify/motion/motion_rates.h"

#include <vector>

#include "certify/motion/enclosed_inverse.h"
#include "certify/motion/length_controlled_motion.h"
#include "kinematics/implied_rates.h"

namespace taut {
namespace {

/// A number of the range, as an interval, and all that a place of the range may be beyond it.
template <class I>
struct Middle {
  I mid, offset;

  explicit Middle(const I& range) : mid(ProofScalarTraits<I>::point(range)), offset(range - mid) {}
};

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

template <class I>
std::optional<PathRates<I>> along_geodesic(const Segment& segment, const I& range) {
  const Middle<I> at(range);
  const std::optional<Geodesic<I>> geodesic = enclose_geodesic(segment, range, at.mid, at.offset);
  if (!geodesic) return std::nullopt;
  PathRates<I> result;
  result.p = ranges(geodesic->p_WP);
  result.r_WP = ranges(geodesic->r_WP);
  result.w = geodesic->turn;
  for (int k = 0; k < 3; ++k) {
    result.p1(k) = geodesic->p_WP(k).slope;  // p is straight
    result.p2(k) = result.w1(k) = I(0.0);
  }
  return result;
}

template <class I>
std::optional<PathRates<I>> of_lengths(const Model<I>& model, const Segment& segment, const I& range) {
  const Middle<I> at(range);
  const MotionEnclosure<I> motion = forward_kinematics(model, segment, range, at.mid, at.offset);
  if (!motion.is_enclosed()) return std::nullopt;
  const Vector3<I> p = ranges(motion.p_WP);
  const Matrix3<I> r = ranges(motion.r_WP);
  EnclosedInverse<I> inverse;
  if (!inverse.set(length_gradients(model, p, r))) return std::nullopt;
  return rates_of_lengths(model, p, r, segment, range, [&](const Vector6<I>& v) { return inverse.times(v); });
}

}  // namespace

template <class I>
MotionRates<I>::MotionRates(const Problem& problem) : poses_(problem) {
  if (problem.space.constraints.empty()) return;
  constraints_.emplace(make_constraint_model<I>(problem));
  constraint_jets_.emplace(constraint_tape(problem));
}

template <class I>
std::optional<PathRates<I>> MotionRates<I>::on_constraints(const Segment& segment, const I& range) const {
  const Middle<I> at(range);
  const std::optional<ImpliedParameters<I>> found =
      enclose_implied_parameters(*constraints_, segment, range, at.mid, at.offset);
  if (!found) return std::nullopt;
  const ConstrainedCurve<I> curve(segment, constraints_->count, range);
  EnclosedInverse<I> inverse;
  if (!inverse.set(curve.by_unknowns(constraints_->jets, found->lambda))) return std::nullopt;
  std::vector<SecondJet<I>> parameters =
      implied_parameters(*constraint_jets_, curve, found->y, [&](const Vector6<I>& v) { return inverse.times(v); });
  for (std::size_t j = 0; j < parameters.size(); ++j) parameters[j].value.value = found->lambda[j];
  return poses_.of(parameters);
}

template <class I>
std::optional<PathRates<I>> MotionRates<I>::over(const Model<I>& model, const Segment& segment, const I& range) const {
  switch (segment.law) {
    case Interpolation::kGeodesic: return along_geodesic(segment, range);
    case Interpolation::kCableLengths: return of_lengths(model, segment, range);
    case Interpolation::kStraight:
    case Interpolation::kCubicBSpline: break;
  }
  if (!constraints_) return poses_.along_curve(segment, range);
  return on_constraints(segment, range);
}

template class MotionRates<Interval>;
template class MotionRates<MpInterval>;

}  // namespace taut
