// SPDX-License-Identifier: GPL-3.0-or-later
#include "atlas/neighbour_index.h"

#include <gtest/gtest.h>

#include <random>
#include <set>

namespace taut {
namespace {

TEST(NeighbourIndex, FindsWhatALookAtAllPointsFinds) {
  std::mt19937 random(3);
  std::uniform_real_distribution<double> place(0, 1), reach(0.01, 0.3);
  NeighbourIndex index;
  std::vector<std::pair<NeighbourIndex::Point, double>> all;
  for (int id = 0; id < 1000; ++id) {
    NeighbourIndex::Point point{place(random), place(random), place(random)};
    const double own = reach(random);
    std::set<int> expected;
    for (int other = 0; other < id; ++other) {
      double squared = 0;
      for (int k = 0; k < 3; ++k) squared += std::pow(point[k] - all[other].first[k], 2);
      if (std::sqrt(squared) <= std::max(own, all[other].second)) expected.insert(other);
    }
    std::set<int> found;
    index.visit(point, own, [&](int other, double) { EXPECT_TRUE(found.insert(other).second) << "visited twice"; });
    ASSERT_EQ(found, expected);
    index.insert(id, point, own);
    all.emplace_back(point, own);
  }
}

TEST(NeighbourIndex, LooksAtFewPointsOfAGrowingLine) {
  NeighbourIndex index;
  constexpr int kCount = 100000;
  int visited = 0;
  for (int id = 0; id < kCount; ++id) {
    const NeighbourIndex::Point point{static_cast<double>(id)};
    index.visit(point, 1.5, [&](int, double) { ++visited; });
    index.insert(id, point, 1.5);
  }
  EXPECT_EQ(visited, kCount - 1);
  EXPECT_LT(index.distance_evaluations(), 128L * kCount);
}

TEST(NeighbourIndex, LocatesByTheFirstCoordinates) {
  Eigen::VectorXd ambient = Eigen::VectorXd::LinSpaced(12, 0, 11);
  EXPECT_EQ(NeighbourIndex::locate(ambient), (NeighbourIndex::Point{0, 1, 2, 3, 4, 5, 6, 7}));
  EXPECT_EQ(NeighbourIndex::locate(ambient.head(2)), (NeighbourIndex::Point{0, 1}));
}

}  // namespace
}  // namespace taut
