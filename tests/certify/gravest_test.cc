// SPDX-License-Identifier: GPL-3.0-or-later
#include "certify/gravest.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "certify/path_proof.h"
#include "certify/severity.h"
#include "tests/support/robots.h"

namespace taut::testing {
namespace {

/// Robot 1 tilted across the singular poses of its slice: det J changes its sign between s = 7/64 and 1/8.
class Gravest : public ::testing::Test {
 protected:
  [[nodiscard]] double determinant(const Dyadic& s) const {
    return sampler_.statics(sampler_.rigid_pose(segment_, s.approx())).determinant;
  }
  Problem problem_ = robot1_slice();
  PoseSampler sampler_{problem_};
  Waypoint begin_{{-2.3, 1.6}, {0, 0}}, end_{{-0.3, 1.65}, {0, 0}};
  Segment segment_ = Segment::straight(begin_, end_);
};

TEST_F(Gravest, FindsAChangeOfSignAndNarrowsIt) {
  const auto found = sample_violations(sampler_, segment_, {0, 0}, {7, 5}, 16);
  ASSERT_TRUE(found.singular);
  EXPECT_GE(found.singular->from, (Dyadic{0, 0}));
  EXPECT_LE(found.singular->from, (Dyadic{1, 3}));
  EXPECT_GE(found.singular->to, (Dyadic{7, 6}));
  EXPECT_LT(determinant(found.singular->from) * determinant(found.singular->to), 0);
  const SuspectedViolation closer = narrowed(sampler_, segment_, *found.singular);
  EXPECT_GE(closer.from, found.singular->from);
  EXPECT_LE(closer.to, found.singular->to);
  EXPECT_LT(closer.to.approx() - closer.from.approx(), 1e-5);
  EXPECT_LT(determinant(closer.from) * determinant(closer.to), 0);
}

TEST_F(Gravest, FindsNoneWhereTheSignStays) {
  EXPECT_FALSE(sample_violations(sampler_, segment_, {0, 0}, {1, 5}, 16).singular);
  EXPECT_FALSE(sample_violations(sampler_, segment_, {1, 3}, {1, 3}, 16).singular);
}

TEST_F(Gravest, FindsWhereALimitIsBrokenMost) {
  constexpr double kWidth = 0.45;  // 0.05 to 0.5 N, 0.1 to 0.55 m
  double worst = 0;
  Dyadic where;
  for (int k = 1; k <= 7; ++k) {
    const Dyadic s{k, 5};
    const Statics<double> at = sampler_.statics(sampler_.rigid_pose(segment_, s.approx()));
    for (const MarginId margin : all_margins()) {
      const double beyond = -slack(sampler_.model(), limited_quantity(at, margin), margin) / kWidth;
      if (beyond > worst) where = s;
      worst = std::max(worst, beyond);
    }
  }
  const auto found = sample_violations(sampler_, segment_, {1, 5}, {7, 5}, 6).worst;
  ASSERT_TRUE(found);
  EXPECT_EQ(found->at, where);
  EXPECT_NEAR(found->severity, worst, 1e-9 * worst);
  EXPECT_LT(found->from, found->at);
  EXPECT_GT(found->to, found->at);
  const SuspectedViolation closer = narrowed(sampler_, segment_, *found);
  EXPECT_GT(closer.severity, found->severity);
  EXPECT_GE(closer.at, found->from);
  EXPECT_LE(closer.at, found->to);
}

TEST_F(Gravest, SaysHowNearALimitIsThatIsKept) {
  const auto found = worst_margin(sampler_, segment_, {0, 0});
  ASSERT_TRUE(found);
  EXPECT_LT(found->severity, 0);
  EXPECT_GT(found->severity, -0.5);
}

TEST_F(Gravest, LooksAtBothEndsHoweverNarrowTheStretch) {
  const Dyadic begin{(1 << 20) - 1, 30}, end{1 << 20, 30};
  const auto found = sample_violations(sampler_, segment_, begin, end, 256);
  ASSERT_TRUE(found.worst);
  EXPECT_GE(found.worst->at, begin);
  EXPECT_LE(found.worst->at, end);
}

TEST(GravestOfAnUndefinedPose, IsNoNumber) {
  const PoseSampler sampler(robot1_slice());
  Waypoint nowhere{{std::nan(""), 1.6}, {0, 0}};
  const auto found = sample_violations(sampler, Segment::straight(nowhere, nowhere), {0, 0}, {1, 0}, 8);
  EXPECT_FALSE(found.singular);
  EXPECT_FALSE(found.worst);
}

PathWitness broken(MarginKind kind, const char* low, const char* high) {
  PathWitness witness;
  witness.margin = {kind, 2};
  witness.value_lower = low;
  witness.value_upper = high;
  return witness;
}

TEST(Severity, IsAShareOfTheWidthBetweenTheLimits) {
  const RobotText robot = robot1_slice().robot;  // 0.05 to 0.5 N, 0.1 to 0.55 m
  EXPECT_NEAR(severity(broken(MarginKind::kTensionMin, "-0.5", "-0.4"), robot), 1, 1e-12);
  EXPECT_NEAR(severity(broken(MarginKind::kTensionMax, "0.545", "0.6"), robot), 0.1, 1e-12);
  EXPECT_NEAR(severity(broken(MarginKind::kLengthMin, "0", "0.055"), robot), 0.1, 1e-12);
  EXPECT_NEAR(severity(broken(MarginKind::kLengthMax, "1", "1.1"), robot), 1, 1e-12);
  PathWitness singular;
  singular.singular = true;
  EXPECT_TRUE(std::isinf(severity(singular, robot)));
}

TEST(RefuteWaypoint, NamesTheLimitThatIsBrokenMost) {
  Problem problem = robot1_slice();
  for (Limits& limits : problem.robot.length_m) limits.upper = "0.3";  // 0.2 m between limits
  const Prover prover(problem);
  const Waypoint waypoint{{-1.3, 1.65}, {0, 0}};
  Reason undecided;
  const auto witness = refute_waypoint(prover, waypoint, 0, undecided);
  ASSERT_TRUE(witness);
  const double grave = severity(*witness, problem.robot);
  const PoseSampler sampler(problem);
  const Statics<double> at = sampler.statics(sampler.rigid_pose(Segment::straight(waypoint, waypoint), 0));
  double worst = 0;
  for (const MarginId margin : all_margins()) {
    const double beyond = -slack(sampler.model(), limited_quantity(at, margin), margin);
    worst = std::max(worst, beyond / (is_length(margin) ? 0.2 : 0.45));
  }
  EXPECT_NEAR(grave, worst, 1e-9 * worst);
}

}  // namespace
}  // namespace taut::testing
