// SPDX-License-Identifier: GPL-3.0-or-later
#include "atlas/manifold.h"

#include <gtest/gtest.h>

#include <random>

#include "tests/atlas/surfaces.h"

namespace taut {
namespace {

using testing::coordinates;
using testing::kPi;

CoordinateSymmetry tilt_and_torsion() { return testing::PolarSphere().symmetry(); }

TEST(CoordinateSymmetry, LeavesPlainCoordinatesAlone) {
  const CoordinateSymmetry none;
  const Coordinates x = coordinates({0.1, 700.0, -3.0});
  EXPECT_EQ(none.nearest_image(x, coordinates({100, 0, 0})), Image{});
  EXPECT_EQ(none.apply(x, Image{}), x);
}

TEST(CoordinateSymmetry, CountsTurnsAcrossTheCut) {
  CoordinateSymmetry symmetry;
  symmetry.periodic[0] = true;
  const Image image = symmetry.nearest_image(coordinates({-3.1}), coordinates({3.1 + 4 * kPi}));
  EXPECT_EQ(image.half_turns[0], 6);
  EXPECT_FALSE(image.flipped);
  EXPECT_DOUBLE_EQ(symmetry.apply(coordinates({-3.1}), image)[0], -3.1 + 6 * kPi);
}

TEST(CoordinateSymmetry, FlipsToGoStraightThroughThePole) {
  const Image image = tilt_and_torsion().nearest_image(coordinates({3.0, 0.05}), coordinates({0.0, 0.05}));
  EXPECT_TRUE(image.flipped);
  EXPECT_EQ(image.half_turns[0], -1);
  EXPECT_EQ(image.half_turns[1], 0);
  const Coordinates x = tilt_and_torsion().apply(coordinates({3.0, 0.05}), image);
  EXPECT_DOUBLE_EQ(x[0], 3.0 - kPi);
  EXPECT_EQ(x[1], -0.05);
}

TEST(CoordinateSymmetry, KeepsAPointsOwnName) {
  EXPECT_EQ(tilt_and_torsion().nearest_image(coordinates({0.5, 0}), coordinates({0.5, 0})), Image{});
}

TEST(CoordinateSymmetry, ImagesAreTheSamePointAndNoOtherImageIsNearer) {
  std::mt19937 random(7);
  std::uniform_real_distribution<double> angle(-10, 10);
  const CoordinateSymmetry symmetry = tilt_and_torsion();
  for (int trial = 0; trial < 2000; ++trial) {
    const Coordinates base = coordinates({angle(random), angle(random)});
    const Coordinates near = coordinates({angle(random), angle(random)});
    const Coordinates image = symmetry.apply(base, symmetry.nearest_image(base, near));
    EXPECT_LT((testing::PolarSphere::at(base) - testing::PolarSphere::at(image)).norm(), 1e-13);
    for (const bool flipped : {false, true}) {
      for (int a = -8; a <= 8; ++a) {
        for (int b = -8; b <= 8; b += 2) {
          if ((a % 2 != 0) != flipped) continue;
          Image other;
          other.flipped = flipped;
          other.half_turns[0] = a;
          other.half_turns[1] = b;
          EXPECT_GE((symmetry.apply(base, other) - near).norm(), (image - near).norm() - 1e-12);
        }
      }
    }
  }
}

}  // namespace
}  // namespace taut
