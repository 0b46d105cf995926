// SPDX-License-Identifier: GPL-3.0-or-later
#include "kinematics/pose_sampler.h"

#include <gtest/gtest.h>

#include <array>
#include <cmath>

#include "kinematics/pose_conversion.h"
#include "tests/support/robots.h"

namespace taut {
namespace {

TEST(PoseSampler, ClearanceIsTheLeastDistanceOverHalfTheRange) {
  const PoseSampler sampler(testing::robot1_slice());
  Statics<double> statics;
  statics.regular = true;
  statics.length.fill(0.325);   // of (0.1, 0.55) m: the middle
  statics.tension.fill(0.275);  // of (0.05, 0.5) N: the middle
  statics.tension_below.fill(0.0);
  statics.tension_above.fill(0.0);
  EXPECT_NEAR(sampler.clearance(statics), 1.0, 1e-12);
  statics.length[3] = 0.145;  // a tenth of the range from the lower limit
  EXPECT_NEAR(sampler.clearance(statics), 0.2, 1e-12);
  statics.tension[1] = 0.14;  // a fifth of the range, less the tension_radius
  statics.tension_below[1] = 0.0675;
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

TEST(PoseSampler, FollowsLawsOfPoses) {
  Problem problem = testing::robot1_slice();
  problem.space = coordinate_space();  // of every path under such a law
  problem.query.clear();
  const PoseSampler sampler(problem);
  const RigidPose a = rigid_pose({Vector3<double>(0, 0, 0.35), -1.5, 1.4, 0.6});
  const RigidPose b = rigid_pose({Vector3<double>(0.01, 0.02, 0.34), -1.3, 1.5, 0.7});
  const auto waypoint = [&](const RigidPose& pose, double sign, bool with_lengths) {
    const PoseNumbers x = pose_numbers({pose.p, Eigen::Quaterniond(sign * pose.q.coeffs())});
    return with_lengths ? Waypoint(LengthsPoint{x, cable_lengths(sampler.model(), pose)}) : Waypoint(PosePoint{x});
  };
  // Geodesic: from a, the turn to b has the same angle at either half, whatever the signs of the quaternions.
  for (const double sign : {1.0, -1.0}) {
    const Waypoint from = waypoint(a, 1, false), to = waypoint(b, sign, false);
    const Segment segment = Segment::between(Interpolation::kGeodesic, from, to);
    const Pose<double> middle = sampler.pose(sampler.parameters(segment, 0.5));
    EXPECT_LT((middle.p_WP - (a.p + b.p) / 2).norm(), 1e-15);
    const Eigen::Quaterniond q = sampler.rigid_pose(middle).q;
    EXPECT_NEAR(q.angularDistance(a.q), a.q.angularDistance(b.q) / 2, 1e-12);
    EXPECT_NEAR(q.angularDistance(b.q), a.q.angularDistance(b.q) / 2, 1e-12);
  }
  // Cable lengths: the pose has the lengths that are commanded.
  const Waypoint from = waypoint(a, 1, true), to = waypoint(b, 1, true);
  const Segment segment = Segment::between(Interpolation::kCableLengths, from, to);
  const auto lengths =
      cable_lengths(sampler.model(), sampler.rigid_pose(sampler.pose(sampler.parameters(segment, 0.25))));
  for (std::size_t i = 0; i < 6; ++i)
    EXPECT_NEAR(lengths[i], 0.75 * from.lengths_m()[i] + 0.25 * to.lengths_m()[i], 1e-12);
}

}  // namespace
}  // namespace taut
