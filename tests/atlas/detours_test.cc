// SPDX-License-Identifier: GPL-3.0-or-later
#include "planner/detours.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "atlas/wrench_feasible_manifold.h"
#include "tests/atlas/surfaces.h"
#include "tests/support/robots.h"

namespace taut {
namespace {

using testing::coordinates;

struct DetourCase {
  Problem problem;
  Cost cost;
  Coordinates start, goal;
};

std::vector<DetourCase> detour_cases() {
  return {{testing::robot1_slice(), Cost::kRotation, coordinates({-2.3, 1.6}), coordinates({1.7, 1.7})},
          {testing::robot1_slice(), Cost::kParameters, coordinates({0.4, 1.0}), coordinates({0.9, -1.2})},
          {testing::robot2_sphere(), Cost::kGreatCircle, coordinates({0.55, 0.75}), coordinates({2.63, 0.75})}};
}

TEST(Detours, GoByPointsThatAreHardlyOutOfTheWayTheNearestFirst) {
  for (const DetourCase& of : detour_cases()) {
    const PoseSampler sampler(of.problem);
    const CoordinateSymmetry symmetry = make_wrench_feasible_manifold(of.problem, sampler)->symmetry();
    const PathLength length(sampler, of.cost, {of.start, of.goal});
    const std::vector<Coordinates> points = Detours(of.problem.space, sampler, length, symmetry)(of.start, of.goal);
    ASSERT_GT(points.size(), 3u);
    EXPECT_LE(points.size(), 32u);
    const double straight = length.distance(of.start, of.goal);
    double last = 0;
    for (const Coordinates& q : points) {
      ASSERT_EQ(q.size(), of.start.size());
      const Coordinates end = symmetry.apply(of.goal, symmetry.nearest_image(of.goal, q));
      const double by = length.distance(of.start, q) + length.distance(q, end);
      EXPECT_LE(by, 1.25 * straight * (1 + 1e-9));
      EXPECT_NEAR(length.along(of.start, q) + length.along(q, end), std::max(last, by), 0.5 * straight);
      last = std::max(last, by);
    }
  }
}

TEST(Detours, KeepTheRangesOfTheParameters) {
  Problem problem = testing::robot1_slice();
  Parameter& theta = problem.space.parameters.at(1);
  theta.kind = ParameterKind::kRange;
  theta.range_lower = "-0.25";
  theta.range_upper = "1.75";
  problem.space.flip.reset();
  const PoseSampler sampler(problem);
  const Coordinates start = coordinates({0.4, 1.0}), goal = coordinates({1.5, 1.2});
  const PathLength length(sampler, Cost::kParameters, {start});
  const std::vector<Coordinates> points = Detours(problem.space, sampler, length, {})(start, goal);
  ASSERT_FALSE(points.empty());
  for (const Coordinates& q : points) {
    EXPECT_LE(std::abs(q[0] - start[0]), std::numbers::pi);
    EXPECT_GE(q[1], -0.25);
    EXPECT_LE(q[1], 1.75);
  }
}

TEST(Detours, AreTheSameEachTime) {
  const DetourCase of = detour_cases().front();
  const PoseSampler sampler(of.problem);
  const PathLength length(sampler, of.cost, {of.start});
  const Detours detours(of.problem.space, sampler, length, {});
  EXPECT_EQ(detours(of.start, of.goal), detours(of.start, of.goal));
}

}  // namespace
}  // namespace taut
