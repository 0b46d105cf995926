// SPDX-License-Identifier: GPL-3.0-or-later
// Moves that are fitted to tables: a spline's own samples, rounded ones, and tables to which no move is near.
#include "planner/move_fit.h"

#include <gtest/gtest.h>

#include <cmath>
#include <random>

#include "kinematics/time_law.h"
#include "tests/support/robots.h"

namespace taut {
namespace {

constexpr double kDuration = 8;
constexpr RowRounding kRounding{1e-4, 1e-3};

Problem flying() { return testing::free_flying(testing::robot2_sphere()); }

/// From rest to rest along x, by 4 m, while the platform turns and dips.
Path true_move() {
  Path path;
  path.interpolation = Interpolation::kCubicBSpline;
  TimeLaw law{kDuration / 8, {}};
  const std::vector<double> way = {0, 0, 0, 0.3, 0.9, 1.7, 2.6, 3.4, 4, 4, 4};
  for (std::size_t i = 0; i < way.size(); ++i) {
    const double x = way[i];
    path.waypoints.push_back(
        {{x, 0.1 * x * x, 0.3 - 0.05 * std::sin(x * 0.7), 0.2, 0.3 + 0.1 * x, 0.05 * x}, std::vector<int>(6, 0)});
    law.controls.push_back(static_cast<double>(i) - 1);
  }
  path.timing = law;
  return path;
}

std::vector<double> parameters_at(const Path& path, double time_s) {
  const double s = std::clamp(time_s / path.timing->step_s, 0.0, static_cast<double>(path.segments()));
  const std::size_t k = std::min(static_cast<std::size_t>(s), path.segments() - 1);
  std::vector<double> result;
  for (std::size_t j = 0; j < 6; ++j) {
    result.push_back(coordinate_polynomial<double>(path.segment(k), j).at(s - static_cast<double>(k)));
  }
  return result;
}

/// @param unit  to whose multiples numbers are rounded; 0: they are not
std::vector<TimedRow> sampled(const Path& path, double spacing_s, double unit = 0) {
  std::vector<TimedRow> rows;
  const auto count = static_cast<int>(std::lround(kDuration / spacing_s));
  for (int i = 0; i <= count; ++i) {
    TimedRow row{i * spacing_s, parameters_at(path, i * spacing_s)};
    for (double& x : row.parameters) x = unit > 0 ? std::round(x / unit) * unit : x;
    rows.push_back(row);
  }
  return rows;
}

double greatest_acceleration(const Path& path) {
  const double h = path.timing->step_s;
  double most = 0;
  for (std::size_t i = 2; i < path.waypoints.size(); ++i) {
    const auto x = [&](std::size_t k) { return path.waypoints[k].parameters().x[0]; };
    most = std::max(most, std::abs(x(i) - 2 * x(i - 1) + x(i - 2)) / (h * h));
  }
  return most;
}

double farthest(const Path& a, const Path& b) {
  double most = 0;
  for (int i = 0; i <= 1000; ++i) {
    const std::vector<double> x = parameters_at(a, kDuration * i / 1000), y = parameters_at(b, kDuration * i / 1000);
    for (std::size_t j = 0; j < 6; ++j) most = std::max(most, std::abs(x[j] - y[j]));
  }
  return most;
}

TEST(MoveFit, RecoversASplineFromItsSamples) {
  const MoveFit fit = fit_move(flying(), sampled(true_move(), 0.05), 8, kRounding);
  EXPECT_LE(fit.worst.share, 0.01);
  EXPECT_LT(farthest(fit.path, true_move()), 2e-6);
  EXPECT_LT(fit.path.segments(), 80U);
  EXPECT_EQ(complaint(fit.path), "");
  EXPECT_DOUBLE_EQ(fit.path.timing->duration_s(), kDuration);
}

TEST(MoveFit, DoesNotFollowTheDigitsOfRoundedRows) {
  const MoveFit fit = fit_move(flying(), sampled(true_move(), 0.01, 1e-4), 8, kRounding);
  EXPECT_LE(fit.worst.share, 1);
  EXPECT_GT(fit.worst.share, 0.3);  // rounding moves rows by up to half a unit each way
  EXPECT_LT(farthest(fit.path, true_move()), 5e-5);
  // Second differences of the rows themselves would be noise of 1 m/s^2.
  EXPECT_NEAR(greatest_acceleration(fit.path), greatest_acceleration(true_move()),
              0.03 * greatest_acceleration(true_move()));
  EXPECT_EQ(complaint(fit.path), "");
}

TEST(MoveFit, TakesRowsThatAreNotEvenlySpaced) {
  std::mt19937 random(7);
  std::uniform_real_distribution<double> some(0.004, 0.05);
  std::vector<TimedRow> rows = {{0, parameters_at(true_move(), 0)}};
  for (double t = some(random); t < kDuration; t += some(random)) {
    if (t < 3 || t > 3.4) rows.push_back({t, parameters_at(true_move(), t)});  // a gap
  }
  rows.push_back({kDuration, parameters_at(true_move(), kDuration)});
  const MoveFit fit = fit_move(flying(), rows, 8, kRounding);
  EXPECT_LE(fit.worst.share, 0.1);
  EXPECT_LT(farthest(fit.path, true_move()), 1e-3);
}

TEST(MoveFit, FindsTheRowThatIsWrong) {
  std::vector<TimedRow> rows = sampled(true_move(), 0.05);
  rows[70].parameters[2] += 0.01;
  const MoveFit fit = fit_move(flying(), rows, 8, kRounding);
  EXPECT_EQ(fit.worst.row, 70U);
  EXPECT_GT(fit.worst.share, 10);
  EXPECT_LE(fit.worst.position_m, 0.01);
}

TEST(MoveFit, FindsAJump) {
  std::vector<TimedRow> rows = sampled(true_move(), 0.05);
  for (std::size_t i = 70; i < rows.size(); ++i) rows[i].parameters[0] += 0.01;
  const MoveFit fit = fit_move(flying(), rows, 8, kRounding);
  EXPECT_NEAR(static_cast<double>(fit.worst.row), 69.5, 2.5);
  EXPECT_GT(fit.worst.share, 5);
}

TEST(MoveFit, KeepsAPlatformThatStays) {
  std::vector<TimedRow> rows = sampled(true_move(), 0.5);
  for (TimedRow& row : rows) row.parameters = rows.front().parameters;
  const MoveFit fit = fit_move(flying(), rows, 8, kRounding);
  EXPECT_EQ(fit.worst.share, 0);
  for (const Waypoint& control : fit.path.waypoints) EXPECT_EQ(control.parameters().x, rows.front().parameters);
}

TEST(MoveFit, IsNearNothingThatIsNoNumber) {
  std::vector<TimedRow> rows = sampled(true_move(), 0.5);
  rows[5].parameters[0] = 1e300;
  EXPECT_FALSE(fit_move(flying(), rows, 8, kRounding).worst.share <= 1);
}

TEST(MoveFit, SeesWhichEndMoves) {
  EXPECT_FALSE(moving_end(flying(), sampled(true_move(), 0.05), kRounding));
  EXPECT_FALSE(moving_end(flying(), sampled(true_move(), 0.01, 1e-4), kRounding));
  std::vector<TimedRow> rows;
  for (int i = 0; i < 40; ++i) {
    TimedRow& row = rows.emplace_back(TimedRow{0.1 * i, parameters_at(true_move(), 0)});
    row.parameters[1] += 0.02 * i;
  }
  const auto begin = moving_end(flying(), rows, kRounding);
  ASSERT_TRUE(begin);
  EXPECT_FALSE(begin->is_last);
  EXPECT_NEAR(begin->speed_m_s, 0.2, 1e-9);
  std::vector<TimedRow> cut = sampled(true_move(), 0.05);
  cut.resize(100);
  const auto end = moving_end(flying(), cut, kRounding);
  ASSERT_TRUE(end);
  EXPECT_TRUE(end->is_last);
  EXPECT_GT(end->angular_speed_rad_s, 0);
}

}  // namespace
}  // namespace taut
