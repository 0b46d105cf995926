// SPDX-License-Identifier: GPL-3.0-or-later
// Spaces of poses with their exact pose functions, and random segments through them.
#pragma once

#include <functional>
#include <vector>

#include "kinematics/segment.h"
#include "tests/oracle/oracle_at_origin.h"
#include "tests/support/exact.h"
#include "tests/support/robots.h"

namespace taut::testing {

/// A problem, and its pose written a second time, for BigFloat.
struct Space {
  Problem problem;
  std::function<oracle::Big6(const std::vector<BigFloat>&)> pose;
  std::vector<Operand> box;  ///< where waypoints are drawn from
};

inline Space slice_space() {
  return {robot1_slice(),
          [](const std::vector<BigFloat>& x) {
            const BigFloat sigma = oracle::pi() * BigFloat(34.0) / BigFloat(180.0);
            return oracle::Big6{BigFloat(0.0), BigFloat(0.0), oracle::big("0.35"), x[0], x[1], sigma};
          },
          {{-3.2, 3.2}, {-0.3, 2.0}}};
}

inline Space sphere_space() {
  return {robot2_sphere(),
          [](const std::vector<BigFloat>& x) {
            const BigFloat rs = oracle::big("0.13");
            return oracle::Big6{
                rs * cos(x[1]) * cos(x[0]), rs * cos(x[1]) * sin(x[0]),          oracle::big("0.306") - rs * sin(x[1]),
                x[0] - oracle::pi(),        oracle::pi() / BigFloat(2.0) - x[1], BigFloat(0.0)};
          },
          {{-3.2, 3.2}, {0.2, 1.8}}};
}

inline Space free_space(const Problem& problem) {
  return {free_flying(problem),
          [](const std::vector<BigFloat>& x) { return oracle::Big6{x[0], x[1], x[2], x[3], x[4], x[5]}; },
          {{-0.12, 0.12}, {-0.12, 0.12}, {0.12, 0.42}, {-3.2, 3.2}, {-0.2, 1.9}, {-0.8, 0.8}}};
}

/// Every function of the grammar at once.
inline Space curved_space() {
  Problem problem = robot1_slice();
  problem.space = SpaceText{};
  problem.space.parameters = {{"u", ParameterKind::kReal, "", ""}, {"w", ParameterKind::kReal, "", ""}};
  problem.space.constants = {{"k", "0.07"}};
  problem.space.pose = {
      "k*sin(u)*exp(-w^2)",         "k*u/(2 + w^2)", "sqrt(0.1 + k*u^2)", "atan2(sin(u), 2 + cos(u)) + pi/3", "u*w",
      "log(1.5 + w^2) - tan(w/4)^3"};
  return {problem,
          [](const std::vector<BigFloat>& x) {
            const BigFloat k = oracle::big("0.07");
            const BigFloat &u = x[0], &w = x[1];
            const BigFloat t = tan(w / BigFloat(4.0));
            return oracle::Big6{k * sin(u) * exp(-(w * w)),
                                k * u / (BigFloat(2.0) + w * w),
                                sqrt(oracle::big("0.1") + k * u * u),
                                atan2(sin(u), BigFloat(2.0) + cos(u)) + oracle::pi() / BigFloat(3.0),
                                u * w,
                                log(BigFloat(1.5) + w * w) - t * t * t};
          },
          {{-1.0, 1.0}, {-1.5, 1.5}}};
}

/// λ(s) = (1−s) λ_a + s λ_b.
inline std::vector<BigFloat> parameters_at(const Waypoint& a, const Waypoint& b, const BigFloat& s) {
  std::vector<BigFloat> result;
  for (std::size_t j = 0; j < a.parameters().x.size(); ++j) {
    const BigFloat from = BigFloat(a.parameters().x[j]) + oracle::pi() * BigFloat(a.parameters().half_turns[j]);
    const BigFloat to = BigFloat(b.parameters().x[j]) + oracle::pi() * BigFloat(b.parameters().half_turns[j]);
    result.push_back((BigFloat(1.0) - s) * from + s * to);
  }
  return result;
}

struct RandomSegment {
  Waypoint a, b;
};

/// From far across the space down to a point; sometimes a half turn apart, or with an angle next to 0.
inline RandomSegment random_segment(const Space& space, Operands& operands) {
  static constexpr double kSizes[] = {1.0, 0.3, 0.1, 0.1, 0.02, 1e-3, 1e-7, 1e-12, 0.0};
  const double size = kSizes[operands.pick(9)];
  RandomSegment segment;
  for (const auto& [lower, upper] : space.box) {
    double x = operands.uniform(lower, upper);
    if (lower < 0 && operands.pick(8) == 0) x *= 1e-9;
    if (lower < 0 && operands.pick(16) == 0) x = 0;
    const double y = x + size * operands.uniform(-1, 1) * (upper - lower);
    const int turns = upper > 3 && operands.pick(3) == 0 ? operands.pick(7) - 3 : 0;
    segment.a.parameters().x.push_back(x);
    segment.b.parameters().x.push_back(y);
    segment.a.parameters().half_turns.push_back(turns);
    segment.b.parameters().half_turns.push_back(turns +
                                                (upper > 3 && operands.pick(20) == 0 ? operands.pick(3) - 1 : 0));
  }
  return segment;
}

}  // namespace taut::testing
