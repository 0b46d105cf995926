// SPDX-License-Identifier: GPL-3.0-or-later
#include "planner/path_length.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>
#include <random>

#include "base/input_error.h"
#include "kinematics/geometry.h"
#include "tests/atlas/surfaces.h"
#include "tests/support/robots.h"

namespace taut {
namespace {

using testing::coordinates;

TEST(PathLength, OfATurnAboutOneAxisIsItsAngle) {
  const PoseSampler sampler(testing::robot1_slice());
  const PathLength length(sampler, Cost::kRotation, {coordinates({0, 0})});
  // Along theta, at any phi, the platform turns about one axis.
  EXPECT_NEAR(length.distance(coordinates({0.3, 0.2}), coordinates({0.3, 1.4})), 1.2, 1e-12);
  EXPECT_NEAR(length.along(coordinates({0.3, 0.2}), coordinates({0.3, 1.4})), 1.2, 1e-12);
}

TEST(PathLength, OfALevelTurnOfPhiAloneIsZeroAtTheta0) {
  const PoseSampler sampler(testing::robot1_slice());
  const PathLength length(sampler, Cost::kRotation, {coordinates({0, 0})});
  EXPECT_NEAR(length.along(coordinates({-2, 0}), coordinates({1, 0})), 0.0, 1e-7);
}

TEST(PathLength, OfAnEdgeOfInfiniteLengthComesToAnEnd) {
  const PoseSampler sampler(testing::robot1_slice());
  const PathLength length(sampler, Cost::kRotation, {coordinates({0, 0})});
  // As a damaged atlas file may have it: its length in the parameters overflows. Under UBSan a conversion to int would
  // show.
  EXPECT_GE(length.along(coordinates({-1e308, 1e308}), coordinates({1e308, -1e308})), 0);
}

TEST(PathLength, AlongIsTheSumOfManySmallDistances) {
  std::mt19937 random(3);
  std::uniform_real_distribution<double> coordinate(-1.5, 1.5);
  const PoseSampler slice(testing::robot1_slice());
  const PoseSampler sphere(testing::robot2_sphere());
  const PathLength turn(slice, Cost::kRotation, {coordinates({0, 0})});
  const PathLength way(sphere, Cost::kGreatCircle, {coordinates({0.5, 1.0})});
  for (int repeat = 0; repeat < 50; ++repeat) {
    const Coordinates a = coordinates({coordinate(random), coordinate(random)});
    const Coordinates b = coordinates({coordinate(random), coordinate(random)});
    for (const PathLength* length : {&turn, &way}) {
      constexpr int kPieces = 2000;
      double sum = 0;
      for (int k = 0; k < kPieces; ++k) {
        sum += length->distance(a + (b - a) * (1.0 * k / kPieces), a + (b - a) * ((k + 1.0) / kPieces));
      }
      EXPECT_NEAR(length->along(a, b), sum, 2e-3 * sum);
      EXPECT_GE(length->along(a, b), length->distance(a, b) * (1 - 1e-12));
    }
  }
}

TEST(PathLength, ThroughAPointIsTheSumOfBothEdges) {
  std::mt19937 random(5);
  std::uniform_real_distribution<double> coordinate(-1.5, 1.5);
  const PoseSampler slice(testing::robot1_slice());
  const PoseSampler sphere(testing::robot2_sphere());
  const PathLength turn(slice, Cost::kRotation, {coordinates({0, 0})});
  const PathLength way(sphere, Cost::kGreatCircle, {coordinates({0.5, 1.0})});
  const PathLength parameters(slice, Cost::kParameters, {coordinates({0, 0})});
  for (int repeat = 0; repeat < 50; ++repeat) {
    const Coordinates a = coordinates({coordinate(random), coordinate(random)});
    const Coordinates b = coordinates({coordinate(random), coordinate(random)});
    const Coordinates x = coordinates({coordinate(random), coordinate(random)});
    for (const PathLength* length : {&turn, &way, &parameters}) {
      EXPECT_NEAR(PathLength::Through(*length, a, b)(x), length->along(a, x) + length->along(x, b), 1e-7);
    }
  }
}

TEST(PathLength, OnTheSphereIsTheArcOfItsRadius) {
  const PoseSampler sampler(testing::robot2_sphere());
  const PathLength length(sampler, Cost::kGreatCircle, {coordinates({0.55, 0.75}), coordinates({2.63, 0.75})});
  EXPECT_NEAR(length.along(coordinates({0.55, 0.2}), coordinates({0.55, 1.2})), 0.13,
              1e-9);  // a meridian, radius 130 mm
}

TEST(PathLength, OfTravelIsTheWayOfThePointPlusALengthPerRadian) {
  const PoseSampler sampler(testing::free_flying(testing::robot1_slice()));
  const Coordinates a = coordinates({0, 0, 0.35, 0, 0.2, 0});
  const Coordinates moved = coordinates({0.03, -0.04, 0.35, 0, 0.2, 0});
  const Coordinates turned = coordinates({0, 0, 0.35, 0, 0.9, 0});  // about the axis y
  const PathLength of_origin(sampler, Cost::kTravel, {a}, {.point_m = {}, .per_radian_m = 0.5});
  EXPECT_NEAR(of_origin.along(a, moved), 0.05, 1e-12);
  EXPECT_NEAR(of_origin.along(a, turned), 0.5 * 0.7, 1e-12);
  // 0.2 m above the origin: the point moves on an arc of 0.7 rad, and its two places are a chord apart.
  const PathLength of_point(sampler, Cost::kTravel, {a}, {.point_m = {0, 0, 0.2}, .per_radian_m = 0});
  EXPECT_NEAR(of_point.along(a, turned), 0.2 * 0.7, 1e-6);
  EXPECT_NEAR(of_point.distance(a, turned), 2 * 0.2 * std::sin(0.35), 1e-12);
  EXPECT_NEAR(of_point.along(a, moved), 0.05, 1e-12);
}

TEST(PathLength, OfTravelCountsARadianAsTheMeanDistanceOfTheAnchors) {
  const PoseSampler sampler(testing::robot1_slice());  // its anchors lie on a circle of 130 mm
  const PathLength length(sampler, Cost::kTravel, {coordinates({0, 0})});
  EXPECT_NEAR(length.along(coordinates({0.3, 0.2}), coordinates({0.3, 1.4})), 0.13 * 1.2, 1e-7);
}

TEST(PathLength, SaysWhatItMeasures) {
  const PoseSampler sampler(testing::robot2_sphere());
  const auto words = [&](Cost cost, const TravelCost& travel = {}) {
    const PathLength length(sampler, cost, {coordinates({0.55, 0.75})}, travel);
    return std::string(length.unit()) + "; " + length.measure();
  };
  EXPECT_EQ(words(Cost::kRotation), "rad; the angle that the platform turns");
  EXPECT_EQ(words(Cost::kGreatCircle), "m; how far the platform's origin moves on its sphere");
  EXPECT_EQ(words(Cost::kParameters), "; the distance in the case's parameters (in m and rad)");
  EXPECT_EQ(words(Cost::kTravel, {.point_m = {}, .per_radian_m = 0.5}),
            "m; how far the platform's origin moves, plus 0.5 m for each radian that the platform turns");
  EXPECT_EQ(words(Cost::kTravel, {.point_m = {0.1, 0, -0.2}, .per_radian_m = 0}),
            "m; how far the platform's point (0.1, 0, -0.2) m moves");
}

TEST(PathLength, RefusesAGreatCircleWherePositionsLieOnNoSphere) {
  const PoseSampler sampler(testing::free_flying(testing::robot1_slice()));
  EXPECT_THROW(PathLength(sampler, Cost::kGreatCircle, {Coordinates::Zero(6)}), InputError);
}

}  // namespace
}  // namespace taut
