// SPDX-License-Identifier: GPL-3.0-or-later
#include "planner/path_length.h"

#include <fmt/format.h>

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>
#include <utility>

#include "base/input_error.h"
#include "kinematics/geometry.h"
#include "planner/edge_motion.h"

namespace taut {
namespace {

std::span<const double> span_of(const Coordinates& q) { return {q.data(), static_cast<std::size_t>(q.size())}; }

/// Length of an arc of a circle, from its chord.
double arc(double chord, double radius) { return 2.0 * radius * std::asin(std::min(1.0, chord / (2.0 * radius))); }

/// Mean distance of the platform's anchors from a point, both in the platform's axes.
double mean_reach(const Model<double>& model, const Vector3<double>& point) {
  double sum = 0;
  for (const Vector3<double>& from_load_point : model.p_MB) sum += (model.p_PM + from_load_point - point).norm();
  return sum / kCables;
}

}  // namespace

PathLength::PathLength(const PoseSampler& sampler, Cost cost, const std::vector<Coordinates>& near,
                       const TravelCost& travel)
    : sampler_(sampler),
      cost_(cost),
      point_P_(travel.point_m[0], travel.point_m[1], travel.point_m[2]),
      per_radian_(travel.per_radian_m.value_or(mean_reach(sampler.model(), point_P_))) {
  if (cost == Cost::kGreatCircle) fit_sphere(near);
}

/// A point of the space in that direction.
Coordinates PathLength::point_near(const Coordinates& centre, const Coordinates& away) const {
  constexpr double kReach = 0.7;
  constexpr double kLeastReach = 1e-3;
  const auto& constraints = sampler_.constraints();
  if (!constraints) return centre + kReach * away;
  for (double reach = kReach; reach > kLeastReach; reach *= 0.7) {
    if (const auto reached = constraints->nearest(centre + reach * away)) return *reached;
  }
  return centre;
}

void PathLength::fit_sphere(const std::vector<Coordinates>& near) {
  constexpr int kSamples = 24;
  Eigen::MatrixXd equations(kSamples, 4);
  Eigen::VectorXd squares(kSamples);
  for (int k = 0; k < kSamples; ++k) {
    const Coordinates& centre = near[static_cast<std::size_t>(k) % near.size()];
    Coordinates away(centre.size());
    for (int j = 0; j < away.size(); ++j) away[j] = std::sin(1.0 + 2.3 * k + 5.1 * j);
    const Vector3<double> p = sampler_.pose(span_of(point_near(centre, away))).p_WP;
    equations.row(k) << 2.0 * p.transpose(), 1.0;
    squares[k] = p.squaredNorm();
  }
  const Eigen::Vector4d solution = equations.colPivHouseholderQr().solve(squares);
  sphere_radius_ = std::sqrt(std::max(0.0, solution[3] + solution.head<3>().squaredNorm()));
  const Eigen::VectorXd misfits = equations * solution - squares;
  const double misfit = misfits.lpNorm<Eigen::Infinity>();
  if (!(misfit <= 1e-9 * squares.lpNorm<Eigen::Infinity>()) || !(sphere_radius_ > 0)) {
    throw InputError("planner.cost: got 'great_circle', expected a space whose positions p lie on one sphere");
  }
}

const char* PathLength::unit() const {
  switch (cost_) {
    case Cost::kRotation: return "rad";
    case Cost::kGreatCircle:
    case Cost::kTravel: return "m";
    case Cost::kParameters: break;
  }
  return "";
}

std::string PathLength::measure() const {
  switch (cost_) {
    case Cost::kRotation: return "the angle that the platform turns";
    case Cost::kGreatCircle: return "how far the platform's origin moves on its sphere";
    case Cost::kParameters: return "the distance in the case's parameters (in m and rad)";
    case Cost::kTravel: break;
  }
  const std::string point = point_P_.isZero() ? "the platform's origin"
                                              : fmt::format("the platform's point ({:.4g}, {:.4g}, {:.4g}) m",
                                                            point_P_[0], point_P_[1], point_P_[2]);
  const std::string turning =
      per_radian_ > 0 ? fmt::format(", plus {:.4g} m for each radian that the platform turns", per_radian_) : "";
  return fmt::format("how far {} moves{}", point, turning);
}

PathLength::RigidTransform PathLength::transform(const Coordinates& q) const {
  return transform(sampler_.pose(span_of(q)));
}

PathLength::RigidTransform PathLength::transform(const Pose<double>& pose) const {
  if (cost_ == Cost::kGreatCircle) return {pose.p_WP, {}};
  const Matrix3<double> r_WP = sampler_.rotation(pose);
  return {cost_ == Cost::kTravel ? Vector3<double>(pose.p_WP + r_WP * point_P_) : pose.p_WP, r_WP};
}

double PathLength::between(const RigidTransform& a, const RigidTransform& b) const {
  if (cost_ == Cost::kGreatCircle) return arc((a.p_W - b.p_W).norm(), sphere_radius_);
  if (cost_ == Cost::kTravel) return (a.p_W - b.p_W).norm() + per_radian_ * rotation_angle(a.r_WP, b.r_WP);
  return rotation_angle(a.r_WP, b.r_WP);
}

double PathLength::distance(const Coordinates& a, const Coordinates& b) const {
  if (cost_ == Cost::kParameters) return (b - a).norm();
  return between(transform(a), transform(b));
}

double PathLength::along(const Coordinates& a, const Coordinates& b) const {
  if (cost_ == Cost::kParameters) return (b - a).norm();
  const EdgeMotion motion(sampler_, a, b);
  return along(a, transform(motion.pose(0)), b, transform(motion.pose(1)));
}

double PathLength::along(const Coordinates& a, const RigidTransform& at_a, const Coordinates& b,
                         const RigidTransform& at_b) const {
  // The error of a sum over pieces is of second order in their length. Richardson's extrapolation combines the sums
  // over single and over double pieces. A double piece is at most this long in the parameters.
  constexpr double kDoublePiece = 0.4;
  constexpr int kMostPieces = 1000;
  const double wanted = std::ceil((b - a).norm() / kDoublePiece);  // not finite if an atlas file is malicious
  const int pieces = 2 * (wanted < kMostPieces ? std::max(1, static_cast<int>(wanted)) : kMostPieces);
  double coarse = 0;
  double fine = 0;
  const EdgeMotion motion(sampler_, a, b);
  RigidTransform even = at_a;
  for (int k = 1; k < pieces; k += 2) {
    const RigidTransform middle = transform(motion.pose(static_cast<double>(k) / pieces));
    const RigidTransform end = k + 1 < pieces ? transform(motion.pose(static_cast<double>(k + 1) / pieces)) : at_b;
    coarse += between(even, end);
    fine += between(even, middle) + between(middle, end);
    even = end;
  }
  return fine + (fine - coarse) / 3.0;
}

PathLength::Through::Through(const PathLength& length, Coordinates a, Coordinates b)
    : length_(length), a_(std::move(a)), b_(std::move(b)) {
  if (length_.cost_ == Cost::kParameters || length_.sampler_.constraints()) return;
  at_a_ = length_.transform(a_);
  at_b_ = length_.transform(b_);
}

double PathLength::Through::operator()(const Coordinates& x) const {
  // On constraints a pose depends on the edge by which it is reached, within rounding of the coordinates.
  if (length_.cost_ == Cost::kParameters || length_.sampler_.constraints()) {
    return length_.along(a_, x) + length_.along(x, b_);
  }
  const RigidTransform at_x = length_.transform(x);
  return length_.along(a_, at_a_, x, at_x) + length_.along(x, at_x, b_, at_b_);
}

}  // namespace taut
