// SPDX-License-Identifier: GPL-3.0-or-later
#include "planner/path_length.h"

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>

#include "base/input_error.h"
#include "kinematics/geometry.h"
#include "planner/edge_motion.h"

namespace taut {
namespace {

std::span<const double> span_of(const Coordinates& q) { return {q.data(), static_cast<std::size_t>(q.size())}; }

/// Of an arc of a circle, from its chord.
double arc(double chord, double radius) { return 2.0 * radius * std::asin(std::min(1.0, chord / (2.0 * radius))); }

}  // namespace

PathLength::PathLength(const PoseSampler& sampler, Cost cost, const std::vector<Coordinates>& near)
    : sampler_(sampler), cost_(cost) {
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
  const double misfit = (equations * solution - squares).lpNorm<Eigen::Infinity>();
  if (!(misfit <= 1e-9 * squares.lpNorm<Eigen::Infinity>()) || !(sphere_radius_ > 0)) {
    throw InputError("planner.cost: got 'great_circle', expected a space whose positions p lie on one sphere");
  }
}

PathLength::PlatformPose PathLength::platform_pose(const Coordinates& q) const {
  return platform_pose(sampler_.pose(span_of(q)));
}

PathLength::PlatformPose PathLength::platform_pose(const Pose<double>& pose) const {
  if (cost_ == Cost::kGreatCircle) return {pose.p_WP, {}};
  return {pose.p_WP, rotation(pose.phi, pose.theta, pose.sigma)};
}

double PathLength::between(const PlatformPose& a, const PlatformPose& b) const {
  if (cost_ == Cost::kGreatCircle) return arc((a.p_WP - b.p_WP).norm(), sphere_radius_);
  return rotation_angle(a.r_WP, b.r_WP);
}

double PathLength::distance(const Coordinates& a, const Coordinates& b) const {
  if (cost_ == Cost::kParameters) return (b - a).norm();
  return between(platform_pose(a), platform_pose(b));
}

double PathLength::along(const Coordinates& a, const Coordinates& b) const {
  if (cost_ == Cost::kParameters) return (b - a).norm();
  // Sums over pieces fall short by the square of their length: Richardson's extrapolation of the sums over double
  // pieces and over single ones. A double piece is at most this long in the parameters.
  constexpr double kDoublePiece = 0.4;
  constexpr int kMostPieces = 1000;
  const double wanted = std::ceil((b - a).norm() / kDoublePiece);  // not finite where an atlas file says so
  const int pieces = 2 * (wanted < kMostPieces ? std::max(1, static_cast<int>(wanted)) : kMostPieces);
  double coarse = 0;
  double fine = 0;
  const EdgeMotion motion(sampler_, a, b);
  PlatformPose even = platform_pose(motion.pose(0));
  for (int k = 1; k < pieces; k += 2) {
    const PlatformPose middle = platform_pose(motion.pose(static_cast<double>(k) / pieces));
    const PlatformPose end = platform_pose(motion.pose(static_cast<double>(k + 1) / pieces));
    coarse += between(even, end);
    fine += between(even, middle) + between(middle, end);
    even = end;
  }
  return fine + (fine - coarse) / 3.0;
}

}  // namespace taut
