// SPDX-License-Identifier: GPL-3.0-or-later
// Time laws that are proposed: against closed forms, and within their limits at samples between those of the search.
#include "planner/time_optimal.h"

#include <gtest/gtest.h>

#include <cmath>

#include "kinematics/rates_sampler.h"
#include "tests/support/robots.h"

namespace taut {
namespace {

Waypoint at(double x, double y, double z, double phi = 0, double theta = 0, double sigma = 0) {
  return {{x, y, z, phi, theta, sigma}, std::vector<int>(6, 0)};
}

MovingBody<double> body(double mass, double radius) {
  MovingBody<double> result;
  result.mass = mass;
  result.p_PC = result.p_MC = {0, 0, 0.01};
  result.inertia = 0.4 * mass * radius * radius * Matrix3<double>::Identity();
  return result;
}

/// The largest usage at places and times between those of the search.
double greatest_usage(const Path& path, const TimedPathProblem& problem, const TimeLaw& law) {
  const PoseSampler sampler(problem.problem);
  const RatesSampler rates(problem.problem);
  double most = 0;
  constexpr int kTimes = 5000;
  for (int k = 0; k <= kTimes; ++k) {
    const LawPoint now = at_time(law, law.duration_s() * k / kTimes);
    const std::size_t segment = std::min(static_cast<std::size_t>(std::max(now.s, 0.0)), path.segments() - 1);
    most = std::max(most, usage(problem, sampler, rates.at(path.segment(segment), now.s - static_cast<double>(segment)),
                                now.rate, now.acceleration));
  }
  return most;
}

/// The largest jerk of the load point, from differences of its acceleration between close times [m/s³].
double greatest_jerk(const Path& path, const TimedPathProblem& problem, const TimeLaw& law) {
  const PoseSampler sampler(problem.problem);
  const RatesSampler rates(problem.problem);
  const double h = law.step_s / 8;
  Vector3<double> before = Vector3<double>::Zero();
  double most = 0;
  for (int k = 0; k * h <= law.duration_s(); ++k) {
    const LawPoint now = at_time(law, k * h);
    const std::size_t segment = std::min(static_cast<std::size_t>(std::max(now.s, 0.0)), path.segments() - 1);
    const PathRates<double> by_s = rates.at(path.segment(segment), now.s - static_cast<double>(segment));
    const Vector3<double> acceleration =
        acceleration_at(by_time(by_s, now.rate, now.acceleration), Vector3<double>(by_s.r_WP * sampler.model().p_PM));
    if (k > 0) most = std::max(most, (acceleration - before).norm() / h);
    before = acceleration;
  }
  return most;
}

Path turning_spline() {
  const Waypoint a = at(-0.03, 0, 0.3), b = at(0, 0.03, 0.32, 0.3, 0.1, 0.2), c = at(0.03, 0.01, 0.28, 0.2, 0.2);
  return Path{{a, a, a, b, c, c, c}, Interpolation::kCubicBSpline};
}

TEST(TimeOptimal, ALineTakesAsLongAsItsTrapezoid) {
  const Problem problem = testing::free_flying(testing::robot2_sphere());
  const Path path{{at(-0.03, 0, 0.3), at(0.03, 0, 0.3)}};
  TimedPathProblem timed{problem, {}, {}};
  timed.limits.speed = 0.02;
  timed.limits.acceleration = 0.05;
  timed.slack = 0;
  const auto move = time_optimal(path, timed);
  ASSERT_TRUE(move);
  const double expected = 0.06 / 0.02 + 0.02 / 0.05;
  EXPECT_NEAR(move->fastest_s, expected, 0.001 * expected);
  Path timed_path = path;
  timed_path.timing = move->law;
  EXPECT_EQ(complaint(timed_path), "");
  EXPECT_LT(move->law.duration_s(), 1.02 * expected);
  EXPECT_LE(greatest_usage(path, timed, move->law), 1.005);
  EXPECT_EQ(at_time(move->law, 0).rate, 0);
  EXPECT_EQ(at_time(move->law, move->law.duration_s()).rate, 0);
}

TEST(TimeOptimal, ASplineKeepsAllLimitsBetweenSamples) {
  const Problem problem = testing::free_flying(testing::robot2_sphere());
  const Path path = turning_spline();
  TimedPathProblem timed{problem, {body(0.5, 0.05)}, {}};
  timed.limits.speed = 0.2;
  timed.limits.acceleration = 0.4;
  timed.limits.angular_speed = 2;
  timed.limits.angular_acceleration = 3;
  timed.limits.winch_speed.fill(0.15);
  timed.limits.winch_acceleration.fill(0.5);
  double without = 0;
  for (const double jerk : {TimeLimits::kNone, 20.0, 4.0}) {
    timed.limits.jerk = jerk;
    const auto move = time_optimal(path, timed);
    ASSERT_TRUE(move);
    Path timed_path = path;
    timed_path.timing = move->law;
    EXPECT_EQ(complaint(timed_path), "");
    EXPECT_LE(greatest_usage(path, timed, move->law), 1) << jerk;
    EXPECT_GT(greatest_usage(path, timed, move->law), 0.9) << jerk;
    if (without == 0) without = move->fastest_s;
    EXPECT_EQ(move->fastest_s, without);
    EXPECT_LT(move->law.duration_s(), (jerk < 5 ? 1.25 : jerk < 21 ? 1.05 : 1.02) * without) << jerk;
    EXPECT_LT(greatest_jerk(path, timed, move->law), 1.05 * jerk) << jerk;
  }
}

/// Where tightening does not get there, the whole law is slowed down.
TEST(TimeOptimal, KeepsALimitOfJerkThatIsFarBelowWhatTheOtherLimitsAllow) {
  const Problem problem = testing::free_flying(testing::robot2_sphere());
  const Path path = turning_spline();
  TimedPathProblem timed{problem, {body(0.5, 0.05)}, {}};
  timed.limits.speed = 0.2;
  timed.limits.acceleration = 0.4;
  for (const double jerk : {0.4, 0.04, 0.004, 0.0004}) {
    timed.limits.jerk = jerk;
    const auto move = time_optimal(path, timed);
    ASSERT_TRUE(move);
    EXPECT_LT(greatest_jerk(path, timed, move->law), 1.1 * jerk) << jerk;
  }
}

TEST(TimeOptimal, TensionsAloneBoundTheSpeedWhereTheLoadHasMass) {
  const Problem problem = testing::free_flying(testing::robot2_sphere());
  const Path path{{at(-0.03, 0, 0.3), at(0.03, 0, 0.3), at(0.03, 0.03, 0.3)}};
  TimedPathProblem timed{problem, {body(0.5, 0.05)}, {}};
  const auto move = time_optimal(path, timed);
  ASSERT_TRUE(move);
  EXPECT_LT(move->law.duration_s(), 1.06 * move->fastest_s);
  EXPECT_LE(greatest_usage(path, timed, move->law), 1);
  EXPECT_FALSE(time_optimal(path, {problem, {}, {}}));  // nothing bounds it
}

TEST(TimeOptimal, WinchesKeepTheirPowerWithInertia) {
  const Problem problem = testing::free_flying(testing::robot2_sphere());
  const Path path{{at(-0.03, 0, 0.3), at(0.03, 0, 0.3), at(0.03, 0.03, 0.33)}};
  TimedPathProblem timed{problem, {body(0.2, 0.05)}, {}};
  const auto unlimited = time_optimal(path, timed);
  ASSERT_TRUE(unlimited);
  constexpr double kPower = 0.02;
  timed.limits.winch_power.fill(kPower);
  timed.limits.acceleration = 0.5;
  const auto move = time_optimal(path, timed);
  ASSERT_TRUE(move);
  EXPECT_GT(move->fastest_s, 1.2 * unlimited->fastest_s);
  // Tensions and speeds once more, from the pose at each time.
  const PoseSampler sampler(problem);
  const RatesSampler path_rates(problem);
  double most = 0;
  constexpr int kTimes = 2000;
  for (int k = 0; k <= kTimes; ++k) {
    const LawPoint now = at_time(move->law, move->law.duration_s() * k / kTimes);
    const std::size_t segment = std::min(static_cast<std::size_t>(std::max(now.s, 0.0)), path.segments() - 1);
    const PathRates<double> by_s = path_rates.at(path.segment(segment), now.s - static_cast<double>(segment));
    const Rates<double> rates = by_time(by_s, now.rate, now.acceleration);
    Model<double> moving = sampler.model();
    moving.wrench = moving.wrench - inertial_wrench(timed.bodies, by_s.r_WP, rates);
    const Statics<double> statics = taut::statics(moving, by_s.p, by_s.r_WP);
    const WinchRates<double> winches = winch_rates(moving, by_s.p, by_s.r_WP, rates);
    for (std::size_t i = 0; i < kCables; ++i) {
      most = std::max(most, (statics.tension[i] + statics.tension_above[i]) * std::abs(winches.speed[i]));
    }
  }
  EXPECT_LE(most, kPower);
  EXPECT_GT(most, 0.9 * kPower);
}

TEST(TimeOptimal, PassesThroughAStopWithinASpline) {
  const Problem problem = testing::free_flying(testing::robot2_sphere());
  const Waypoint a = at(-0.03, 0, 0.3), b = at(0, 0.03, 0.32), c = at(0.03, 0.01, 0.28);
  const Path path{{a, a, a, b, b, b, c, c, c}, Interpolation::kCubicBSpline};
  TimedPathProblem timed{problem, {}, {}};
  timed.limits.speed = 0.2;
  timed.limits.acceleration = 0.4;
  const auto move = time_optimal(path, timed);
  ASSERT_TRUE(move);
  Path timed_path = path;
  timed_path.timing = move->law;
  EXPECT_EQ(complaint(timed_path), "");
  EXPECT_LE(greatest_usage(path, timed, move->law), 1);
  // Legs are straight, and too short for the greatest speed: half of each speeds up, half slows down.
  double expected = 0;
  for (const double length : {std::hypot(0.03, 0.03, 0.02), std::hypot(0.03, 0.02, 0.04)}) {
    expected += 2 * std::sqrt(length / 0.4);
  }
  EXPECT_LT(move->law.duration_s(), 1.05 * expected);
  EXPECT_GT(move->law.duration_s(), expected);
}

TEST(TimeOptimal, ALineIsAsFastInAllDirections) {
  const Problem problem = testing::free_flying(testing::robot2_sphere());
  // By its parameter the curve speeds up along itself, so that the two parts of the acceleration are parallel.
  for (const Waypoint& b : {at(0.06, 0, 0.3), at(0.03, 0.04, 0.33), at(0.031, 0.017, 0.293)}) {
    const Waypoint a = at(0, 0, 0.3);
    const Path path{{a, a, a, b, b, b}, Interpolation::kCubicBSpline};
    TimedPathProblem timed{problem, {}, {}};
    timed.limits.acceleration = 0.4;
    const double length = std::hypot(b.parameters().x[0], b.parameters().x[1], b.parameters().x[2] - 0.3),
                 expected = 2 * std::sqrt(length / 0.4);
    const auto move = time_optimal(path, timed);
    ASSERT_TRUE(move);
    EXPECT_NEAR(move->fastest_s, expected / std::sqrt(0.99), 0.005 * expected);
    EXPECT_LT(move->law.duration_s(), 1.03 * expected);
    Path timed_path = path;
    timed_path.timing = move->law;
    EXPECT_EQ(complaint(timed_path), "");
    EXPECT_LE(greatest_usage(path, timed, move->law), 1);
  }
}

TEST(TimeOptimal, LeavesAloneWhatItIsTold) {
  const Problem problem = testing::free_flying(testing::robot2_sphere());
  const Path path{{at(-0.03, 0, 0.3), at(0.03, 0, 0.3)}};
  TimedPathProblem timed{problem, {body(0.5, 0.05)}, {}};
  const auto all = time_optimal(path, timed);
  ASSERT_TRUE(all);
  timed.tightened.push_back({0, 1, 4});  // speeds and accelerations halved, and a quarter
  const auto less = time_optimal(path, timed);
  ASSERT_TRUE(less);
  EXPECT_NEAR(less->fastest_s, 2 * all->fastest_s, 1e-3 * all->fastest_s);
  EXPECT_NEAR(less->law.duration_s(), 2 * all->law.duration_s(), 0.02 * all->law.duration_s());
  timed.tightened = {{0.7, 0.8, 4}};  // only there
  const auto locally = time_optimal(path, timed);
  ASSERT_TRUE(locally);
  EXPECT_GT(locally->law.duration_s(), 1.02 * all->law.duration_s());
  EXPECT_LT(locally->law.duration_s(), 1.5 * all->law.duration_s());
  timed.tightened.clear();
  TensionLoss loss;
  for (auto& sides : loss.newtons) sides = {0.02, 0.02};  // [N], of some tenths
  timed.tension_loss.assign(timed.grid + 1, loss);
  const auto lost = time_optimal(path, timed);
  ASSERT_TRUE(lost);
  EXPECT_GT(lost->fastest_s, 1.005 * all->fastest_s);
  for (TensionLoss& at_place : timed.tension_loss) at_place.turn = 0.1;
  const auto turned = time_optimal(path, timed);
  ASSERT_TRUE(turned);
  EXPECT_GT(turned->fastest_s, 1.005 * lost->fastest_s);
}

}  // namespace
}  // namespace taut
