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

TEST(PathLength, OnTheSphereIsTheArcOfItsRadius) {
  const PoseSampler sampler(testing::robot2_sphere());
  const PathLength length(sampler, Cost::kGreatCircle, {coordinates({0.55, 0.75}), coordinates({2.63, 0.75})});
  EXPECT_NEAR(length.along(coordinates({0.55, 0.2}), coordinates({0.55, 1.2})), 0.13,
              1e-9);  // a meridian, radius 130 mm
}

TEST(PathLength, RefusesAGreatCircleWherePositionsLieOnNoSphere) {
  const PoseSampler sampler(testing::free_flying(testing::robot1_slice()));
  EXPECT_THROW(PathLength(sampler, Cost::kGreatCircle, {Coordinates::Zero(6)}), InputError);
}

}  // namespace
}  // namespace taut
