// SPDX-License-Identifier: GPL-3.0-or-later
#include "kinematics/segment.h"

#include <gtest/gtest.h>

#include <cmath>
#include <random>

#include "kinematics/motion_length.h"

namespace taut {
namespace {

Waypoint at(std::vector<double> x, int half_turns = 0) {
  std::vector<int> turns(x.size(), 0);
  turns[0] = half_turns;
  return {std::move(x), std::move(turns)};
}

double flat_distance(const std::vector<double>& a, const std::vector<double>& b) {
  double square = 0;
  for (std::size_t j = 0; j < a.size(); ++j) square += (a[j] - b[j]) * (a[j] - b[j]);
  return std::sqrt(square);
}

TEST(Segment, OfASplineIsTheFormulaOfTheFormat) {
  std::mt19937_64 random(3);
  std::uniform_real_distribution<double> number(-2, 2);
  for (int trial = 0; trial < 200; ++trial) {
    std::array<Waypoint, 4> q;
    for (Waypoint& w : q) w = at({number(random), number(random)}, static_cast<int>(random() % 5) - 2);
    const Segment segment{Interpolation::kCubicBSpline, {&q[0], &q[1], &q[2], &q[3]}, 0};
    const double s = std::abs(number(random)) / 2;
    for (std::size_t j = 0; j < 2; ++j) {
      std::array<double, 4> v;
      for (std::size_t i = 0; i < 4; ++i)
        v[i] = q[i].parameters().x[j] + ScalarTraits<double>::pi() * q[i].parameters().half_turns[j];
      const double expected = (std::pow(1 - s, 3) * v[0] + (3 * s * s * s - 6 * s * s + 4) * v[1] +
                               (-3 * s * s * s + 3 * s * s + 3 * s + 1) * v[2] + s * s * s * v[3]) /
                              6;
      EXPECT_NEAR(coordinate_polynomial<double>(segment, j).at(s), expected, 1e-14 * (1 + std::abs(expected)) * 20);
    }
  }
}

TEST(Segment, SplinesJoinWithTwoContinuousDerivativesAndPassTriples) {
  Path path{{at({0, 0}), at({0, 0}), at({0, 0}), at({1, 2}), at({3, -1}), at({3, -1}), at({3, -1})},
            Interpolation::kCubicBSpline,
            {}};
  ASSERT_EQ(path.segments(), 4u);
  for (std::size_t k = 0; k + 1 < path.segments(); ++k) {
    for (std::size_t j = 0; j < 2; ++j) {
      const auto left = coordinate_polynomial<double>(path.segment(k), j);
      const auto right = coordinate_polynomial<double>(path.segment(k + 1), j);
      EXPECT_NEAR(left.at(1), right.at(0), 1e-15);
      EXPECT_NEAR(left.slope(1), right.slope(0), 1e-15);
      EXPECT_NEAR(2 * left.c[2] + 6 * left.c[3], 2 * right.c[2], 1e-14);
    }
  }
  EXPECT_EQ(curve_parameters(path.segment(0), 0), (std::vector<double>{0, 0}));
  EXPECT_EQ(curve_parameters(path.segment(3), 1), (std::vector<double>{3, -1}));
}

TEST(Waypoint, IsWhatItsLawSays) {
  const Waypoint parameters{{1, 2}, {0, 2}};
  EXPECT_EQ(parameters.parameters().half_turns[1], 2);
  EXPECT_THROW(static_cast<void>(parameters.pose()), std::bad_variant_access);
  const std::vector<double> pose = {1, 2, 3, 0, 0, 0.6, 0.8};
  const Waypoint of_geodesic = waypoint_of(Interpolation::kGeodesic, pose, {});
  EXPECT_EQ(of_geodesic.pose()[6], 0.8);
  EXPECT_THROW(static_cast<void>(of_geodesic.parameters()), std::bad_variant_access);
  EXPECT_THROW(static_cast<void>(of_geodesic.lengths_m()), std::bad_variant_access);
  EXPECT_THROW(static_cast<void>(waypoint_of(Interpolation::kCableLengths, pose, {})), std::logic_error);
}

TEST(Waypoint, HasItsNumbersInARow) {
  std::vector<double> row = {1, 2, 3, 0, 0, 0.6, 0.8, 11, 12, 13, 14, 15, 16};
  const Waypoint with_lengths = waypoint_of(Interpolation::kCableLengths, row, {});
  EXPECT_EQ(numbers(with_lengths), row);
  EXPECT_EQ(with_lengths.lengths_m()[5], 16);
  EXPECT_EQ(number_count(Interpolation::kCableLengths, 2), 13u);
  EXPECT_TRUE(half_turns(with_lengths).empty());
  row.resize(7);
  EXPECT_EQ(numbers(waypoint_of(Interpolation::kGeodesic, row, {})), row);
  EXPECT_EQ(numbers(waypoint_of(Interpolation::kStraight, {5, 6}, {0, 1})), (std::vector<double>{5, 6}));
}

TEST(Path, CountsSegmentsByItsLaw) {
  Path path{{at({0.0}), at({1.0}), at({2.0}), at({3.0})}};
  EXPECT_EQ(path.segments(), 3u);
  path.interpolation = Interpolation::kCubicBSpline;
  EXPECT_EQ(path.segments(), 1u);
  path.waypoints.pop_back();
  EXPECT_EQ(path.segments(), 0u);
}

TEST(MotionLength, OfStraightSegmentsIsTheirSum) {
  const Path path{{at({0, 0}), at({3, 4}), at({3, 5})}};
  EXPECT_NEAR(motion_length(path, curve_parameters, flat_distance), 6, 1e-12);
}

TEST(MotionLength, OfAnArcIsExtrapolatedFromChords) {
  const Path path{{at({0.0}), at({3.0})}};
  const ParametersAt circle = [](const Segment& segment, double s) {
    const double angle = curve_parameters(segment, s)[0];
    return std::vector<double>{std::cos(angle), std::sin(angle)};
  };
  EXPECT_NEAR(motion_length(path, circle, flat_distance), 3, 1e-5);
}

}  // namespace
}  // namespace taut
