#include "kinematics/pose_sampler.h"

#include <gtest/gtest.h>

#include <array>
#include <cmath>

#include "tests/support/robots.h"

namespace taut {
namespace {

TEST(PoseSampler, ClearanceIsTheLeastDistanceOverHalfTheRange) {
  const PoseSampler sampler(testing::robot1_slice());
  Statics<double> statics;
  statics.regular = true;
  statics.length.fill(0.325);   // of (0.1, 0.55) m: the middle
  statics.tension.fill(0.275);  // of (0.05, 0.5) N: the middle
  statics.variation.fill(0.0);
  EXPECT_NEAR(sampler.clearance(statics), 1.0, 1e-12);
  statics.length[3] = 0.145;  // a tenth of the range from the lower limit
  EXPECT_NEAR(sampler.clearance(statics), 0.2, 1e-12);
  statics.tension[1] = 0.14;  // a fifth of the range, less the variation
  statics.variation[1] = 0.0675;
  EXPECT_NEAR(sampler.clearance(statics), 0.1, 1e-12);
  statics.tension[5] = 0.55;
  EXPECT_NEAR(sampler.clearance(statics), -2.0 * 0.05 / 0.45, 1e-12);
}

TEST(PoseSampler, ASingularPoseHasNoClearance) {
  const PoseSampler sampler(testing::robot1_slice());
  Statics<double> statics;
  statics.length.fill(0.325);
  EXPECT_LT(sampler.clearance(statics), 0);
}

TEST(PoseSampler, ThePublishedStartAndGoalAreClear) {
  const PoseSampler sampler(testing::robot1_slice());
  for (const std::array<double, 2> q : {std::array{-2.3, 1.6}, std::array{1.7, 1.7}, std::array{-2.0, 0.0}}) {
    EXPECT_GT(sampler.clearance(sampler.statics(sampler.pose(q))), 0);
  }
}

}  // namespace
}  // namespace taut
