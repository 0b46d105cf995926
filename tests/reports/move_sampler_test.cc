// SPDX-License-Identifier: GPL-3.0-or-later
#include "kinematics/move_sampler.h"

#include <gtest/gtest.h>

#include <cmath>

#include "kinematics/pose_sampler.h"
#include "tests/reports/sample_certificates.h"

namespace taut {
namespace {

constexpr double kStep = 1e-4;  // [s], of differences

class MoveSamples : public ::testing::Test {
 protected:
  /// What differences of positions in time say: of a point of the platform.
  [[nodiscard]] Vector3<double> place(double t, const Vector3<double>& of_platform) const {
    const RigidPose pose = pose_at(t);
    return pose.p + pose.q * of_platform;
  }
  [[nodiscard]] RigidPose pose_at(double t) const {
    const double s = std::min(at_time(*certificate_.path.timing, t).s, 2.0);
    const auto k = static_cast<std::size_t>(std::min(std::floor(s), 1.0));
    return poses_.rigid_pose(certificate_.path.segment(k), s - static_cast<double>(k));
  }
  [[nodiscard]] Vector3<double> velocity(double t, const Vector3<double>& c) const {
    return (place(t + kStep, c) - place(t - kStep, c)) / (2 * kStep);
  }
  [[nodiscard]] Vector3<double> acceleration(double t, const Vector3<double>& c) const {
    return (place(t + kStep, c) - 2 * place(t, c) + place(t - kStep, c)) / (kStep * kStep);
  }
  [[nodiscard]] double length(double t, std::size_t i) const {
    return (place(t, poses_.model().p_PB[i]) - poses_.model().p_WA[i]).norm();
  }

  Certificate certificate_ = sample::timed();
  PoseSampler poses_{certificate_.problem};
  MoveSampler sampler_{certificate_.problem};
};

TEST_F(MoveSamples, HaveTheRatesOfDifferences) {
  const Vector3<double> load_point = poses_.model().p_PM;
  double fastest = 0;
  for (const double t : {0.4, 1.1, 1.9, 2.7, 3.3, 4.6}) {
    const MoveSample sample = sampler_.at_time(certificate_.path, t);
    EXPECT_EQ(sample.time_s, t);
    EXPECT_NEAR(sample.load_speed, velocity(t, load_point).norm(), 1e-7);
    EXPECT_NEAR(sample.load_acceleration, acceleration(t, load_point).norm(), 1e-5);
    for (std::size_t i = 0; i < kCables; ++i) {
      const double speed = (length(t + kStep, i) - length(t - kStep, i)) / (2 * kStep);
      const double rise = (length(t + kStep, i) - 2 * length(t, i) + length(t - kStep, i)) / (kStep * kStep);
      EXPECT_NEAR(sample.winches.speed[i], speed, 1e-7);
      EXPECT_NEAR(sample.winches.acceleration[i], rise, 1e-5);
      EXPECT_EQ(sample.size({RateKind::kWinchSpeed, static_cast<int>(i)}), std::abs(sample.winches.speed[i]));
      fastest = std::max(fastest, std::abs(speed));
    }
    const Eigen::AngleAxisd turn(pose_at(t + kStep).q * pose_at(t - kStep).q.conjugate());
    EXPECT_NEAR(sample.load_angular_speed, std::abs(turn.angle()) / (2 * kStep), 1e-6);
  }
  EXPECT_GT(fastest, 1e-3) << "else nothing was compared";
}

TEST_F(MoveSamples, HaveTensionsThatMoveTheWeights) {
  // Σ f u = w − Σ m a, with the middle masses: 21 g and 10 g, and the force of 1 N upwards.
  double largest = 0;
  for (const double t : {0.4, 1.1, 2.9, 3.3}) {
    const MoveSample sample = sampler_.at_time(certificate_.path, t);
    const Vector3<double> force = 0.021 * acceleration(t, {0, 0, -0.02}) + 0.01 * acceleration(t, {0.03, 0, 0});
    Vector3<double> carried(0, 0, 0);
    for (std::size_t i = 0; i < kCables; ++i) {
      const Vector3<double> d = place(t, poses_.model().p_PB[i]) - poses_.model().p_WA[i];
      carried += sample.statics.tension[i] * d.normalized();
    }
    const Vector3<double> expected = Vector3<double>(0, 0, 1) - force;
    for (int k = 0; k < 3; ++k) EXPECT_NEAR(carried(k), expected(k), 1e-7) << t;
    largest = std::max(largest, force.norm());
  }
  EXPECT_GT(largest, 1e-5) << "else nothing was compared";
}

TEST_F(MoveSamples, FindTheTimeOfAPlace) {
  const TimeLaw& law = *certificate_.path.timing;
  for (const double s : {0.01, 0.5, 1.3, 1.99}) {
    EXPECT_NEAR(at_time(law, MoveSampler::time_of(law, s)).s, s, 1e-12);
    EXPECT_NEAR(sampler_.at_place(certificate_.path, s).place.s, s, 1e-12);
  }
}

TEST(RateLimits, AreThoseThatAreStated) {
  const std::vector<RateLimit> limits = rate_limits(*sample::timed().problem.time);
  ASSERT_EQ(limits.size(), 9u);
  EXPECT_EQ(limits[5].id, (RateId{RateKind::kWinchSpeed, 5}));
  EXPECT_EQ(limits[6].id, (RateId{RateKind::kWinchPower, 2}));
  EXPECT_EQ(limits[6].value, 2);
  EXPECT_EQ(limits[8].text, "(30)*pi/180");
  EXPECT_NEAR(limits[8].value, 0.5235987755982988, 1e-15);
}

TEST(IsInTime, NeedsLimitsAndALaw) {
  const Certificate certificate = sample::timed();
  EXPECT_TRUE(is_in_time(certificate.problem, certificate.path));
  Path at_rest = certificate.path;
  at_rest.timing.reset();
  EXPECT_FALSE(is_in_time(certificate.problem, at_rest));
  Problem slow = certificate.problem;
  slow.time.reset();
  EXPECT_FALSE(is_in_time(slow, certificate.path));
  Path pose = certificate.path;
  pose.waypoints.resize(1);
  EXPECT_FALSE(is_in_time(certificate.problem, pose));
}

}  // namespace
}  // namespace taut
