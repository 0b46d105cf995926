// SPDX-License-Identifier: GPL-3.0-or-later
// Bounds of how far rows are from a move: above what they are, and by little.
#include "certify/row_distance.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <random>

#include "base/input_error.h"
#include "kinematics/pose_conversion.h"
#include "kinematics/pose_sampler.h"
#include "problem/decimal.h"
#include "tests/support/robots.h"

namespace taut {
namespace {

Problem flying(AngleKind kind = AngleKind::kTiltAndTorsion) {
  Problem problem = testing::free_flying(testing::robot2_sphere());
  problem.space = coordinate_space({kind});
  return problem;
}

Path some_move() {
  Path path;
  path.interpolation = Interpolation::kCubicBSpline;
  TimeLaw law{0.3, {}};
  for (int i = 0; i < 9; ++i) {
    const double x = i < 3 ? 0 : i > 5 ? 4 : i - 2;
    path.waypoints.push_back({{x, -x, 0.5 * x, 0.1 * x, 0.4 + 0.1 * x, 2 - x}, std::vector<int>(6, 0)});
    law.controls.push_back(i - 1);
  }
  path.timing = law;
  return path;
}

Rational exactly(const char* decimal) { return Decimal::parse(decimal).rational(); }

std::vector<double> parameters_at(const Path& path, double s) {
  const auto k = static_cast<std::size_t>(s);
  std::vector<double> result;
  for (std::size_t j = 0; j < 6; ++j) {
    result.push_back(coordinate_polynomial<double>(path.segment(k), j).at(s - static_cast<double>(k)));
  }
  return result;
}

TEST(RowDistance, IsNextToNothingOfARowOnTheMove) {
  for (const AngleKind kind : {AngleKind::kTiltAndTorsion, AngleKind::kRollPitchYaw, AngleKind::kZyz}) {
    const Problem problem = flying(kind);
    const Path path = some_move();
    const RowDistances distances(problem, path);
    const auto off = distances.at(
        exactly("0.66"), {RowPose::Form::kParameters, parameters_at(path, 0.66 / 0.3), std::vector<int>(6, 0)});
    ASSERT_TRUE(off);
    EXPECT_GT(off->position_m, 0);
    EXPECT_LT(off->position_m, 1e-13);
    EXPECT_LT(off->angle_rad, 1e-13);
  }
}

TEST(RowDistance, IsAboveTheDistanceAndByLittle) {
  const Problem problem = flying(AngleKind::kRollPitchYaw);
  const Path path = some_move();
  const RowDistances distances(problem, path);
  const PoseSampler sampler(problem);
  std::mt19937 random(3);
  std::uniform_real_distribution<double> some(-1, 1);
  for (int i = 0; i < 400; ++i) {
    const double size = std::pow(10, 4 * some(random) - 5);
    const std::string time = std::to_string(0.9 + 0.8 * some(random));
    const Rational time_s = exactly(time.c_str());
    const double s = Rational(time_s / Rational(0.3)).convert_to<double>();
    const RigidPose on = sampler.rigid_pose(sampler.pose(parameters_at(path, s)));
    const Vector3<double> shift = size * Vector3<double>(some(random), some(random), some(random));
    const Vector3<double> axis = Vector3<double>(some(random), some(random), some(random)).normalized();
    const double angle = std::min(size, 3.0);
    const double length = 1 + 0.3 * some(random);  // of the quaternion: any
    Eigen::Quaterniond q = Eigen::Quaterniond(Eigen::AngleAxisd(angle, axis)) * on.q;
    q.coeffs() *= length;
    const Vector3<double> p = on.p + shift;
    const auto off =
        distances.at(time_s, {RowPose::Form::kQuaternion, {p(0), p(1), p(2), q.x(), q.y(), q.z(), q.w()}, {}});
    ASSERT_TRUE(off);
    constexpr double kRounding = 1e-14;  // of this test's own numbers
    EXPECT_GE(off->position_m, shift.norm() - kRounding);
    EXPECT_LE(off->position_m, shift.norm() + 1e-13);
    EXPECT_GE(off->angle_rad, angle - kRounding);
    EXPECT_LE(off->angle_rad, angle + 1e-13 + 1e-12 / std::cos(angle / 2));
  }
}

TEST(RowDistance, TakesTheEndsBeforeAndAfterTheMove) {
  const Problem problem = flying();
  const Path path = some_move();
  const RowDistances distances(problem, path);
  const RowPose first{RowPose::Form::kParameters, path.waypoints.front().parameters().x, std::vector<int>(6, 0)};
  const RowPose last{RowPose::Form::kParameters, path.waypoints.back().parameters().x, std::vector<int>(6, 0)};
  EXPECT_LT(distances.at(0, first)->position_m, 1e-14);
  EXPECT_LT(distances.at(-1, first)->position_m, 1e-14);
  // 6 h, with h next to 0.3: the exact time is not the law's.
  for (const char* time : {"1.8", "1.79999999999999999999", "1.80000000000000000001", "2", "1e20"}) {
    EXPECT_LT(distances.at(exactly(time), last)->position_m, 1e-14) << time;
    EXPECT_GT(distances.at(exactly(time), first)->position_m, 5.9) << time;
  }
}

TEST(RowDistance, CountsHalfTurns) {
  const Problem problem = flying();
  const Path path = some_move();
  RowPose row{RowPose::Form::kParameters, path.waypoints.front().parameters().x, std::vector<int>(6, 0)};
  row.half_turns[5] = 2;
  EXPECT_LT(RowDistances(problem, path).at(0, row)->angle_rad, 1e-13);
  row.half_turns[5] = 1;
  EXPECT_GE(RowDistances(problem, path).at(0, row)->angle_rad, 3.14159265);
}

TEST(RowDistance, OfLengthsIsAboveThatOfEachCableAndByLittle) {
  const Problem problem = flying(AngleKind::kRollPitchYaw);
  const Path path = some_move();
  const RowDistances distances(problem, path);
  const PoseSampler sampler(problem);
  std::mt19937 random(4);
  std::uniform_real_distribution<double> some(-1, 1);
  for (int i = 0; i < 400; ++i) {
    const std::string time = std::to_string(0.9 + 0.8 * some(random));
    const RigidPose pose = sampler.rigid_pose(sampler.pose(parameters_at(path, std::stod(time) / 0.3)));
    const std::array<double, kCables> lengths = cable_lengths(sampler.model(), pose);
    RowPose row{RowPose::Form::kLengths, {lengths.begin(), lengths.end()}, {}};
    double most = 0;
    for (double& x : row.x) {
      const double off = std::pow(10, 4 * some(random) - 5) * some(random);
      x += off;
      most = std::max(most, std::abs(off));
    }
    const auto found = distances.at(exactly(time.c_str()), row);
    ASSERT_TRUE(found);
    EXPECT_EQ(found->position_m, 0);
    EXPECT_GT(found->length_m, most - 1e-14);
    EXPECT_LT(found->length_m, most + 1e-12);
  }
  RowPose beyond{RowPose::Form::kLengths, std::vector<double>(6, 1), {}};
  beyond.x[4] = std::numeric_limits<double>::infinity();
  EXPECT_FALSE(distances.at(1, beyond));
}

TEST(RowDistance, SaysNothingOfWhatItCannotEnclose) {
  const Problem problem = flying();
  const Path path = some_move();
  RowPose row{RowPose::Form::kParameters, path.waypoints.front().parameters().x, std::vector<int>(6, 0)};
  row.x[0] = 1e300;
  EXPECT_FALSE(RowDistances(problem, path).at(0, row));
}

TEST(RowDistance, RefusesALawThatIsNotEven) {
  const Problem problem = flying();
  Path path = some_move();
  path.timing->controls[4] += 1e-9;
  EXPECT_THROW(RowDistances(problem, path), InputError);
}

}  // namespace
}  // namespace taut
