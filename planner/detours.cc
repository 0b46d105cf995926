// SPDX-License-Identifier: GPL-3.0-or-later
#include "planner/detours.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <utility>

namespace taut {
namespace {

std::span<const double> span_of_coordinates(const Coordinates& q) {
  return {q.data(), static_cast<std::size_t>(q.size())};
}

/// The steps of an additive recurrence in [0, 1)^n: powers of 1/φ, where φ > 1 solves φ^(n+1) = φ + 1 (M. Roberts, "The
/// unreasonable effectiveness of quasirandom sequences", 2018).
Coordinates recurrence_steps(Eigen::Index n) {
  double phi = 1.5;
  for (int k = 0; k < 30; ++k) phi = std::pow(1.0 + phi, 1.0 / static_cast<double>(n + 1));
  Coordinates steps(n);
  for (Eigen::Index j = 0; j < n; ++j) steps[j] = std::pow(phi, -static_cast<double>(j + 1));
  return steps;
}

}  // namespace

Detours::Detours(const SpaceText& space, const PoseSampler& sampler, const PathLength& length,
                 const CoordinateSymmetry& symmetry)
    : space_(space), sampler_(sampler), length_(length), symmetry_(symmetry) {}

/// Once around for a periodic parameter; else beyond start and goal by some radians, where moving by the platform's
/// size counts as one.
std::vector<Detours::Range> Detours::box_around(const Coordinates& start, const Coordinates& goal) const {
  constexpr double kReach = 2.0;
  constexpr double kStep = 1e-3;  // of a difference quotient
  const Vector3<double> p_WP = sampler_.pose(span_of_coordinates(start)).p_WP;
  std::vector<Range> box;
  for (Eigen::Index j = 0; j < start.size(); ++j) {
    const Parameter& parameter = space_.parameters[static_cast<std::size_t>(j)];
    if (parameter.kind == ParameterKind::kPeriodic) {
      box.push_back({start[j] - std::numbers::pi, start[j] + std::numbers::pi});
      continue;
    }
    Coordinates beside = start;
    beside[j] += kStep;
    const double moved = (sampler_.pose(span_of_coordinates(beside)).p_WP - p_WP).norm() / kStep;
    const double reach = kReach / (1.0 + moved / sampler_.model().characteristic_length);
    Range range{std::min(start[j], goal[j]) - reach, std::max(start[j], goal[j]) + reach};
    if (parameter.kind == ParameterKind::kRange) {
      range[0] = std::max(range[0], evaluate_constant<double>(parameter.range_lower));
      range[1] = std::min(range[1], evaluate_constant<double>(parameter.range_upper));
    }
    box.push_back(range);
  }
  return box;
}

/// The length of an edge from its ends and its middle.
double Detours::rough_length(const Coordinates& a, const Coordinates& b) const {
  const Coordinates middle = 0.5 * (a + b);
  return length_.distance(a, middle) + length_.distance(middle, b);
}

std::vector<Coordinates> Detours::operator()(const Coordinates& start, const Coordinates& goal) const {
  constexpr int kPoints = 32;
  constexpr double kMostExcess = 1.25;  // of the length, over that of the shortest motion without limits
  const double most = kMostExcess * length_.distance(start, goal);
  const std::vector<Range> box = box_around(start, goal);
  const Coordinates steps = recurrence_steps(start.size());
  std::vector<std::pair<double, Coordinates>> points;
  for (int k = 1; k <= kPoints; ++k) {
    Coordinates q(start.size());
    for (Eigen::Index j = 0; j < q.size(); ++j) {
      const double share = 0.5 + k * steps[j];
      const Range& range = box[static_cast<std::size_t>(j)];
      q[j] = range[0] + (share - std::floor(share)) * (range[1] - range[0]);
    }
    const Coordinates end = symmetry_.apply(goal, symmetry_.nearest_image(goal, q));
    const double length = rough_length(start, q) + rough_length(q, end);
    if (length <= most) points.emplace_back(length, q);
  }
  std::ranges::stable_sort(points, {}, &std::pair<double, Coordinates>::first);
  std::vector<Coordinates> result;
  for (const auto& [length, q] : points) result.push_back(q);
  return result;
}

}  // namespace taut
