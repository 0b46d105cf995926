// SPDX-License-Identifier: GPL-3.0-or-later
#include "planner/sampled_motion_validator.h"

#include <gtest/gtest.h>

#include <cmath>

#include "tests/atlas/surfaces.h"
#include "tests/support/robots.h"

namespace taut {
namespace {

using testing::coordinates;

class ClearEdgeTest : public ::testing::Test {
 protected:
  PoseSampler sampler_{testing::robot1_slice()};

  [[nodiscard]] double clearance(const Coordinates& q) const {
    return sampler_.clearance(sampler_.statics(sampler_.pose({q.data(), static_cast<std::size_t>(q.size())})));
  }
};

// The paper's q_s and q_g: feasible both, and the straight way between them is not.
const Coordinates kStart = coordinates({-2.3, 1.6});
const Coordinates kGoal = coordinates({1.7, 1.7});

TEST_F(ClearEdgeTest, AcceptsASmallMoveAmongFeasiblePoses) {
  EXPECT_TRUE(SampledMotionValidator(sampler_, 0)(coordinates({-2.0, 0.1}), coordinates({-2.0, 0.4})));
}

TEST_F(ClearEdgeTest, RefusesAWayThatLeavesTheLimitsBetweenItsEnds) {
  ASSERT_GT(clearance(kStart), 0);
  ASSERT_GT(clearance(kGoal), 0);
  EXPECT_FALSE(SampledMotionValidator(sampler_, 0)(kStart, kGoal));
}

TEST_F(ClearEdgeTest, RefusesEitherEndWithinTheClearance) {
  const Coordinates near = coordinates({-2.0, 0.1});
  const double room = std::min(clearance(near), clearance(kStart));
  EXPECT_TRUE(SampledMotionValidator(sampler_, 0.99 * room)(kStart, kStart));
  EXPECT_FALSE(SampledMotionValidator(sampler_, 1.01 * clearance(kStart))(kStart, near));
  EXPECT_FALSE(SampledMotionValidator(sampler_, 1.01 * clearance(kStart))(near, kStart));
}

TEST_F(ClearEdgeTest, FindsAWindowOfTwoStepsThatIsOutOfLimits) {
  // Across the boundary and back by way of an infeasible pose: walk from the start until it is left.
  Coordinates out = kStart;
  while (clearance(out) > 0) out += 0.01 * (kGoal - kStart).normalized();
  const Coordinates beyond = out + 0.1 * (kGoal - kStart).normalized();
  EXPECT_FALSE(SampledMotionValidator(sampler_, 0)(kStart, beyond));
}

}  // namespace
}  // namespace taut
