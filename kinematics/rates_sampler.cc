// SPDX-License-Identifier: GPL-3.0-or-later
#include "kinematics/rates_sampler.h"

#include <Eigen/LU>

#include "kinematics/implied_rates.h"

namespace taut {

RatesSampler::RatesSampler(const Problem& problem) : poses_(problem), rates_(problem) {
  if (problem.space.constraints.empty()) return;
  const ExpressionTape tape = constraint_tape(problem);
  constraints_.emplace(
      Constraints{Evaluator<Jet<double, kMaxConstrainedParameters>>(tape), Evaluator<Taylor<double, 2>>(tape)});
}

PathRates<double> RatesSampler::at(const Segment& segment, double s) const {
  switch (segment.law) {
    case Interpolation::kGeodesic: return along_geodesic(segment, s);
    case Interpolation::kCableLengths: return of_lengths(segment, s);
    case Interpolation::kStraight:
    case Interpolation::kCubicBSpline: break;
  }
  return constraints_ ? on_constraints(segment, s) : rates_.along_curve(segment, s);
}

PathRates<double> RatesSampler::on_constraints(const Segment& segment, double s) const {
  const std::optional<ConstraintFunctions>& functions = poses_.constraints();
  const ConstrainedCurve<double, 2> curve(segment, static_cast<std::size_t>(functions->count()), s);
  Vector6<double> y = Vector6<double>::Zero();
  if (const auto found = functions->unknowns(segment, s)) y.head(found->size()) = *found;
  std::array<Taylor<double, 2>, 6> unknowns;
  for (std::size_t i = 0; i < 6; ++i) unknowns[i] = Taylor<double, 2>(y(static_cast<int>(i)));
  std::vector<double> lambda;
  for (const Taylor<double, 2>& x : curve.at(unknowns)) lambda.push_back(x.d[0]);
  const auto gradients = curve.gradients(constraints_->gradients, lambda);
  const Eigen::PartialPivLU<Matrix6<double>> by_y(curve.by_unknowns(gradients));
  const auto parameters = implied_parameters(constraints_->derivatives, curve, gradients, y,
                                             [&](const Vector6<double>& v) { return Vector6<double>(by_y.solve(v)); });
  return rates_.of(std::span(parameters.data(), parameters.size()));
}

PathRates<double> RatesSampler::along_geodesic(const Segment& segment, double s) const {
  const PoseNumbers &from = segment.control[0]->pose(), &to = segment.control[1]->pose();
  const RigidPose now = pose_between(segment, s);
  const Eigen::Quaterniond begin = pose_between(segment, 0).q, end = pose_between(segment, 1).q;
  PathRates<double> result;
  result.r_WP = now.q.toRotationMatrix();
  result.p = now.p;
  result.p1 = Vector3<double>(to[0] - from[0], to[1] - from[1], to[2] - from[2]);
  const Eigen::AngleAxisd turn(begin.conjugate() * end);
  result.w = begin * Vector3<double>(turn.angle() * turn.axis());
  result.p2 = result.w1 = Vector3<double>::Zero();
  return result;
}

PathRates<double> RatesSampler::of_lengths(const Segment& segment, double s) const {
  const RigidPose pose = poses_.rigid_pose(segment, s);
  const Matrix3<double> r_WP = pose.q.toRotationMatrix();
  const Eigen::PartialPivLU<Matrix6<double>> gradients(length_gradients(poses_.model(), pose.p, r_WP));
  return rates_of_lengths<2>(poses_.model(), pose.p, r_WP, segment, s,
                             [&](const Vector6<double>& v) { return Vector6<double>(gradients.solve(v)); });
}

}  // namespace taut
