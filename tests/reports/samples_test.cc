#include "reports/samples.h"

#include <gtest/gtest.h>

#include "reports/certificate_view.h"
#include "tests/reports/sample_certificates.h"

namespace taut {
namespace {

constexpr double kPi = 3.14159265358979323846;

TEST(Samples, HitEveryWaypointAndBothEnds) {
  const CertificateView view = read_certificate(sample::proved());
  const std::vector<PathSample> samples = Sampler(view.problem).along(view.path, 20);
  ASSERT_EQ(samples.size(), 21u);
  EXPECT_EQ(samples[0].parameters, resolved(view.path.waypoints[0]));
  EXPECT_EQ(samples[10].parameters, resolved(view.path.waypoints[1]));
  EXPECT_EQ(samples[20].parameters, resolved(view.path.waypoints[2]));
}

TEST(Samples, KeepToTheirBudgetOnALongPath) {
  CertificateView view = read_certificate(sample::proved());
  view.path.waypoints.resize(5000, view.path.waypoints[0]);
  const std::vector<PathSample> samples = Sampler(view.problem).along(view.path, 100);
  EXPECT_LE(samples.size(), 101u);
  EXPECT_EQ(samples.back().position, 4999);
}

TEST(Samples, AddHalfTurns) { EXPECT_EQ(resolved({{1.0, 2.0}, {-2, 0}}), (std::vector<double>{1.0 - 2 * kPi, 2.0})); }

TEST(Samples, TellWhichLimitsAPoseBreaks) {
  const CertificateView view = read_certificate(sample::proved());
  const Sampler sampler(view.problem);
  const auto at = [&](double phi, double theta) {
    return feasibility(sampler.model(), statics(sampler.model(), sampler.pose({phi, theta})));
  };
  EXPECT_EQ(at(-2.3, 1.6), Feasibility::kInside);
  EXPECT_EQ(at(0.5, 0.0), Feasibility::kInside);
  EXPECT_EQ(at(-2.3, 3.0), Feasibility::kTensionOut);
}

TEST(Samples, FindTheClosestLimit) {
  const CertificateView view = read_certificate(sample::proved());
  Sampler sampler(view.problem);
  PathSample sample = sampler.at(view.path, 0);
  sample.statics.tension = {0.2, 0.2, 0.2, 0.45, 0.2, 0.2};
  sample.statics.variation = {0.01, 0.01, 0.01, 0.02, 0.01, 0.01};
  const std::optional<Closest> closest = closest_tension(sampler.model(), {sample});
  ASSERT_TRUE(closest);
  EXPECT_EQ(closest->cable, 3);
  EXPECT_TRUE(closest->upper);
  EXPECT_NEAR(closest->margin, 0.03, 1e-12);
  EXPECT_NEAR(closest->fraction, 0.03 / 0.45, 1e-12);
}

}  // namespace
}  // namespace taut
