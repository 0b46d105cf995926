// SPDX-License-Identifier: GPL-3.0-or-later
#include "reports/summary/samples.h"

#include <gtest/gtest.h>

#include <limits>
#include <numbers>

#include "certificate/certificate_reader.h"
#include "tests/reports/sample_certificates.h"

namespace taut {
namespace {

TEST(Samples, HitEveryWaypointAndBothEnds) {
  const Certificate certificate = read_certificate(sample::proved());
  const std::vector<PathSample> samples = Sampler(certificate.problem).along(certificate.path, 20);
  ASSERT_EQ(samples.size(), 21u);
  EXPECT_EQ(samples[0].parameters, resolved(certificate.path.waypoints[0]));
  EXPECT_EQ(samples[10].parameters, resolved(certificate.path.waypoints[1]));
  EXPECT_EQ(samples[20].parameters, resolved(certificate.path.waypoints[2]));
}

TEST(Samples, KeepToTheirBudgetOnALongPath) {
  Certificate certificate = read_certificate(sample::proved());
  certificate.path.waypoints.resize(5000, certificate.path.waypoints[0]);
  const std::vector<PathSample> samples = Sampler(certificate.problem).along(certificate.path, 100);
  EXPECT_LE(samples.size(), 101u);
  EXPECT_EQ(samples.back().position, 4999);
}

TEST(Samples, AddHalfTurns) {
  EXPECT_EQ(resolved({{1.0, 2.0}, {-2, 0}}), (std::vector<double>{1.0 - 2 * std::numbers::pi, 2.0}));
}

TEST(Samples, TellHowFarAPoseIsInsideTheLimits) {
  const Certificate certificate = read_certificate(sample::proved());
  const Sampler sampler(certificate.problem);
  const auto at = [&](double phi, double theta) {
    return reserves(sampler.model(), statics(sampler.model(), sampler.pose({phi, theta})));
  };
  for (const Reserves& inside : {at(-2.3, 1.6), at(0.5, 0.0)}) {
    EXPECT_GT(inside.tension, 0);
    EXPECT_GT(inside.length, 0);
    EXPECT_LT(inside.tension, 0.5);
    EXPECT_LT(inside.length, 0.5);
  }
  EXPECT_LT(at(-2.3, 3.0).tension, 0);
  EXPECT_GT(at(-2.3, 3.0).length, 0);
}

TEST(Samples, ReserveIsThatOfTheWorstCable) {
  const Certificate certificate = read_certificate(sample::proved());
  const Sampler sampler(certificate.problem);
  Statics<double> s = statics(sampler.model(), sampler.pose({-2.3, 1.6}));
  s.tension.fill(0.2);
  s.tension_below.fill(0.01);
  s.tension_above.fill(0.02);
  s.length.fill(0.4);
  s.length[2] = 0.505;
  Reserves left = reserves(sampler.model(), s);
  EXPECT_NEAR(left.tension, (0.19 - 0.05) / 0.45, 1e-12);
  EXPECT_NEAR(left.length, 0.045 / 0.45, 1e-12);
  s.tension[4] = 0.49;
  s.length[5] = 0.0;
  left = reserves(sampler.model(), s);
  EXPECT_NEAR(left.tension, -0.01 / 0.45, 1e-12);
  EXPECT_NEAR(left.length, -0.1 / 0.45, 1e-12);
  s.tension[0] = std::numeric_limits<double>::quiet_NaN();
  EXPECT_EQ(reserves(sampler.model(), s).tension, -std::numeric_limits<double>::infinity());
  s.regular = false;
  s.tension.fill(0.2);
  EXPECT_EQ(reserves(sampler.model(), s).tension, -std::numeric_limits<double>::infinity());
}

class SampledViolations : public ::testing::Test {
 protected:
  /// Tensions 0.2 ± 0.01 N within (0.05, 0.5) N; lengths as they are, within (0.1, 0.55) m.
  [[nodiscard]] PathSample sample(double position) const {
    PathSample sample = sampler_.at(certificate_.path, position);
    sample.statics.tension.fill(0.2);
    sample.statics.tension_below.fill(0.01);
    sample.statics.tension_above.fill(0.01);
    sample.statics.determinant = 1;
    return sample;
  }
  Certificate certificate_ = read_certificate(sample::proved());
  Sampler sampler_{certificate_.problem};
};

TEST_F(SampledViolations, AreNoneWithinLimits) {
  EXPECT_FALSE(worst_violation(sampler_.model(), {sample(0), sample(1)}));
}

TEST_F(SampledViolations, AreComparedByTheWidthBetweenLimits) {
  PathSample slack = sample(0.5);
  slack.statics.tension[3] = 0.02;  // 0.01 N, 0.04 N below: 0.09 widths
  PathSample longer = sample(1);
  longer.statics.length[4] = 0.57;  // 0.02 m beyond: 0.04 widths
  const auto worst = worst_violation(sampler_.model(), {longer, slack, sample(2)});
  ASSERT_TRUE(worst);
  EXPECT_EQ(worst->cable, 3);
  EXPECT_FALSE(worst->is_length);
  EXPECT_FALSE(worst->is_upper);
  EXPECT_NEAR(worst->value, 0.01, 1e-12);
  EXPECT_EQ(worst->position, 0.5);

  const auto length = worst_violation(sampler_.model(), {longer});
  ASSERT_TRUE(length);
  EXPECT_TRUE(length->is_length);
  EXPECT_TRUE(length->is_upper);
  EXPECT_EQ(length->cable, 4);
}

TEST_F(SampledViolations, AtASingularPoseAreOfLengthsOnly) {
  PathSample singular = sample(0);
  singular.statics.regular = false;
  singular.statics.tension[0] = -1e9;
  EXPECT_FALSE(worst_violation(sampler_.model(), {singular}));
}

TEST_F(SampledViolations, BetweenSignsOfTheDeterminantAreSingularPoses) {
  std::vector<PathSample> samples = {sample(0), sample(0.5), sample(1), sample(1.5), sample(2)};
  EXPECT_TRUE(sign_changes(samples).empty());
  samples[2].statics.determinant = -1;
  samples[3].statics.regular = false;  // no sign: 0, or near it
  EXPECT_EQ(sign_changes(samples), (std::vector<double>{1, 2}));
}

}  // namespace
}  // namespace taut
