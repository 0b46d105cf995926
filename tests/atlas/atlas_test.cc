// SPDX-License-Identifier: GPL-3.0-or-later
#include "atlas/atlas.h"

#include <gtest/gtest.h>

#include <random>
#include <stdexcept>

#include "tests/atlas/surfaces.h"

namespace taut {
namespace {

using testing::coordinates;
using testing::kPi;
using testing::options;

TEST(Atlas, CoversACircle) {
  const testing::FlatTorus circle({0});
  Atlas atlas(circle, options(0.2, 0.1));
  atlas.add(coordinates({1}));
  ASSERT_TRUE(atlas.grow_all());
  for (int id = 0; id < atlas.size(); ++id) EXPECT_EQ(atlas.neighbours(id).size(), 2u);
  EXPECT_GE(atlas.size(), static_cast<int>(2 * kPi / 0.4));
  EXPECT_LE(atlas.size(), static_cast<int>(2 * kPi / 0.19) + 2);
}

TEST(Atlas, LeavesNoPointOfTheSphereUncovered) {
  const auto sphere = testing::unit_sphere();
  const double radius = 0.3;
  Atlas atlas(sphere, options(radius, 0.1));
  atlas.add(coordinates({1, 0, 0}));
  ASSERT_TRUE(atlas.grow_all());
  std::mt19937 random(5);
  std::normal_distribution<double> normal;
  for (int trial = 0; trial < 2000; ++trial) {
    const Eigen::VectorXd x = Eigen::Vector3d(normal(random), normal(random), normal(random)).normalized();
    double least = 10;
    for (int id = 0; id < atlas.size(); ++id) {
      if (atlas.chart(id).frame.point().dot(x) < 0) continue;
      least = std::min(least, atlas.chart(id).frame.tangent_coordinates(x).norm());
    }
    EXPECT_LE(least, 1.05 * radius);
  }
}

TEST(Atlas, CoversThreeDimensions) {
  const testing::FlatTorus box({0, 0.5, 0.4});
  Atlas atlas(box, options(0.4, 0.2));
  atlas.add(coordinates({3, 0, 0}));
  ASSERT_TRUE(atlas.grow_all());
  std::mt19937 random(6);
  std::uniform_real_distribution<double> unit(-1, 1);
  Frame frame;
  for (int trial = 0; trial < 1000; ++trial) {
    ASSERT_TRUE(box.frame_at(coordinates({kPi * unit(random), 0.4 * unit(random), 0.3 * unit(random)}), frame));
    double least = 10;
    for (int id = 0; id < atlas.size(); ++id) {
      least = std::min(least, (atlas.chart(id).frame.point() - frame.point()).norm());
    }
    EXPECT_LE(least, 0.45);
  }
}

// Above three dimensions nothing is claimed of a single point, only of most.
TEST(Atlas, CoversNearlyAllOfFourDimensionsAndMore) {
  for (const std::vector<double>& half_widths :
       {std::vector<double>{0.5, 0.5, 0.5, 0.5}, {0.4, 0.4, 0.4, 0.4, 0.4}, {0.35, 0.35, 0.35, 0.35, 0.35, 0.35}}) {
    const int n = static_cast<int>(half_widths.size());
    const testing::FlatTorus box(half_widths);
    Atlas atlas(box, options(0.4, 0.2));
    atlas.add(Coordinates::Zero(n));
    ASSERT_TRUE(atlas.grow_all());
    std::mt19937 random(6);
    std::uniform_real_distribution<double> unit(-1, 1);
    Frame frame;
    int uncovered = 0;
    double worst = 0;
    constexpr int kTrials = 2000;
    for (int trial = 0; trial < kTrials; ++trial) {
      Coordinates x(n);
      for (int j = 0; j < n; ++j) x[j] = 0.9 * half_widths[j] * unit(random);
      ASSERT_TRUE(box.frame_at(x, frame));
      double least = 10;
      for (int id = 0; id < atlas.size(); ++id) {
        least = std::min(least, (atlas.chart(id).frame.point() - frame.point()).norm());
      }
      uncovered += least > 0.4;
      worst = std::max(worst, least);
    }
    EXPECT_LT(uncovered, kTrials / 100) << n;
    EXPECT_LT(worst, 0.6) << n;
  }
}

// Neighbours are those that end each other's rays: fewer than there are, but enough to get everywhere.
TEST(Atlas, ConnectsAllChartsOfFourDimensionsAndMore) {
  for (const int n : {4, 5, 6}) {
    const testing::FlatTorus box(std::vector<double>(static_cast<std::size_t>(n), 0.45));
    AtlasOptions few = options(0.4, 0.2);
    few.max_charts = 2000;
    Atlas atlas(box, few);
    atlas.add(Coordinates::Zero(n));
    atlas.grow_all();
    std::vector<int> reached{0};
    std::vector<bool> seen(static_cast<std::size_t>(atlas.size()));
    seen[0] = true;
    for (std::size_t k = 0; k < reached.size(); ++k) {
      for (const int next : atlas.neighbours(reached[k])) {
        if (seen[static_cast<std::size_t>(next)]) continue;
        seen[static_cast<std::size_t>(next)] = true;
        reached.push_back(next);
      }
    }
    EXPECT_EQ(static_cast<int>(reached.size()), atlas.size()) << n;
  }
}

TEST(Atlas, KeepsChartsWithinEpsilonByShrinkingThem) {
  const auto torus = testing::torus();
  Atlas atlas(torus, options(0.3, 0.02));  // the tube's curvature is 2.5: 0.02 is left at about 0.126
  atlas.add(coordinates({1 + testing::kTubeRadius, 0, 0}));
  ASSERT_TRUE(atlas.grow_all());
  double smallest = 1;
  for (int id = 0; id < atlas.size(); ++id) smallest = std::min(smallest, atlas.chart(id).radius);
  EXPECT_LT(smallest, 0.2);
  EXPECT_GT(smallest, 0.3 / 16);
  for (int id = 0; id < atlas.size(); ++id) {
    const Chart& chart = atlas.chart(id);
    for (const int other : atlas.neighbours(id)) {
      const Frame& frame = atlas.chart(other).frame;
      const double along = chart.frame.tangent_coordinates(frame.point()).norm();
      const double across =
          std::sqrt(std::max(0.0, (frame.point() - chart.frame.point()).squaredNorm() - along * along));
      EXPECT_LE(across, 4 * 0.02);
    }
  }
}

TEST(Atlas, KeepsCloseSheetsApart) {
  // Two parallel planes, 0.02 apart: z^2 = 0.01^2, within a cylinder.
  const testing::ImplicitSurface planes([](const Eigen::Vector3d& x) { return x[2] * x[2] - 1e-4; },
                                        [](const Eigen::Vector3d& x) -> Eigen::Vector3d {
                                          return {0, 0, 2 * x[2]};
                                        });
  AtlasOptions few = options(0.1, 0.001);
  few.max_charts = 300;
  Atlas atlas(planes, few);
  const int below = *atlas.add(coordinates({0, 0, -0.01}));
  const int above = *atlas.add(coordinates({0, 0, 0.01}));
  EXPECT_FALSE(atlas.grow_all());
  EXPECT_EQ(atlas.size(), 300);
  EXPECT_EQ(atlas.neighbours(below).size(), atlas.neighbours(above).size());
  for (int id = 0; id < atlas.size(); ++id) {
    for (const int other : atlas.neighbours(id)) {
      EXPECT_EQ(atlas.chart(id).frame.point()[2], atlas.chart(other).frame.point()[2]);
    }
  }
}

TEST(Atlas, FinishesAtTheBoundaryOfTheDomain) {
  const testing::FlatSpace disc(2, [](const Coordinates& x) { return x.norm() <= 1; });
  Atlas atlas(disc, options(0.1, 0.1));
  atlas.add(coordinates({0, 0}));
  ASSERT_TRUE(atlas.grow_all());
  EXPECT_LT(atlas.size(), 1500);
  std::mt19937 random(8);
  std::uniform_real_distribution<double> unit(-1, 1);
  for (int trial = 0; trial < 2000; ++trial) {
    const Coordinates x = coordinates({unit(random), unit(random)});
    if (x.norm() > 0.95) continue;
    double least = 10;
    for (int id = 0; id < atlas.size(); ++id) least = std::min(least, (atlas.chart(id).frame.point() - x).norm());
    EXPECT_LE(least, 0.1 + 1e-9);
  }
}

TEST(Atlas, RecognisesAPointByAnotherName) {
  const testing::PolarSphere sphere;
  Atlas atlas(sphere, options(0.2, 0.1));
  const auto first = atlas.add(coordinates({0.5, 0.75}));
  EXPECT_EQ(atlas.add(coordinates({0.5 + 2 * kPi, 0.75})), first);
  EXPECT_EQ(atlas.add(coordinates({0.5 - kPi, -0.75})), first);
  EXPECT_NE(atlas.add(coordinates({0.5, -0.75})), first);
  EXPECT_EQ(atlas.size(), 2);
}

TEST(Atlas, AddsNothingOutsideTheDomain) {
  const testing::PolarSphere cap(0.5);
  Atlas atlas(cap, options(0.2, 0.1));
  EXPECT_FALSE(atlas.add(coordinates({0, 0.6})).has_value());
  EXPECT_EQ(atlas.size(), 0);
}

TEST(Atlas, StopsAtItsBudgetAndGoesOnFromThere) {
  const auto sphere = testing::unit_sphere();
  Atlas atlas(sphere, options(0.2, 0.1));
  const int first = *atlas.add(coordinates({0, 0, 1}));
  const int target = *atlas.add(coordinates({1, 0, 0}));
  EXPECT_FALSE(atlas.expand(first, 1, target));
  ASSERT_EQ(atlas.size(), 3);
  EXPECT_GT(atlas.chart(2).frame.point()[0], 0.1) << "towards the target";
  EXPECT_TRUE(atlas.expand(first));
  EXPECT_TRUE(atlas.chart(first).complete);
  EXPECT_GE(atlas.neighbours(first).size(), 3u);
}

TEST(Atlas, GrowsInNLogN) {
  const auto sphere = testing::unit_sphere();
  double per_chart[2];
  int size[2];
  const double radii[2] = {0.1, 0.02};
  for (int i = 0; i < 2; ++i) {
    Atlas atlas(sphere, options(radii[i], 0.1));
    atlas.add(coordinates({0, 0, 1}));
    ASSERT_TRUE(atlas.grow_all());
    size[i] = atlas.size();
    per_chart[i] = static_cast<double>(atlas.distance_evaluations()) / atlas.size();
  }
  ASSERT_GT(size[1], 20 * size[0]);
  EXPECT_LT(per_chart[1], per_chart[0] * 2.5 * std::log(size[1]) / std::log(size[0]));
}

TEST(Atlas, DependsOnNothingButItsInput) {
  const auto torus = testing::torus();
  Atlas a(torus, options(0.15, 0.05)), b(torus, options(0.15, 0.05));
  for (Atlas* atlas : {&a, &b}) {
    atlas->add(coordinates({1 + testing::kTubeRadius, 0, 0}));
    ASSERT_TRUE(atlas->grow_all());
  }
  ASSERT_EQ(a.size(), b.size());
  for (int id = 0; id < a.size(); ++id) EXPECT_EQ(a.chart(id).frame.point(), b.chart(id).frame.point());
}

TEST(AtlasOptions, NamesTheFieldAtFault) {
  AtlasOptions bad;
  bad.step = 2.5;
  try {
    bad.validate();
    FAIL() << "accepted";
  } catch (const std::invalid_argument& error) {
    EXPECT_NE(std::string(error.what()).find("step"), std::string::npos);
  }
  const testing::FlatSpace seven(7);
  EXPECT_THROW(Atlas(seven, AtlasOptions{}), std::invalid_argument);
}

}  // namespace
}  // namespace taut
