// SPDX-License-Identifier: GPL-3.0-or-later
#include "planner/shorten.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "tests/atlas/surfaces.h"

namespace taut {
namespace {

using testing::coordinates;

/// A plane with a disc of radius 1 about the origin that must not be entered.
struct DiscWorld {
  int asked = 0;

  ShortenProblem problem() {
    return {[](const Coordinates& a, const Coordinates& b) { return (a - b).norm(); },
            [this](const Coordinates& a, const Coordinates& b) {
              ++asked;
              return clear(a, b);
            },
            {}};
  }
  static bool clear(const Coordinates& a, const Coordinates& b) {
    const Coordinates d = b - a;
    const double t = d.squaredNorm() > 0 ? std::clamp(-a.dot(d) / d.squaredNorm(), 0.0, 1.0) : 0.0;
    return (a + t * d).norm() >= 1.0;
  }
};

std::vector<Coordinates> jagged_detour() {
  std::vector<Coordinates> path = {coordinates({-2, 0})};
  for (int k = 1; k < 40; ++k) {
    const double angle = std::numbers::pi * (1.0 - k / 40.0);
    const double radius = 2.0 + 0.15 * (k % 2 == 0 ? 1 : -1);
    path.push_back(coordinates({radius * std::cos(angle), radius * std::sin(angle)}));
  }
  path.push_back(coordinates({2, 0}));
  return path;
}

double length(const std::vector<Coordinates>& path) {
  double sum = 0;
  for (std::size_t k = 1; k < path.size(); ++k) sum += (path[k] - path[k - 1]).norm();
  return sum;
}

TEST(Shorten, PullsADetourTautAroundADisc) {
  DiscWorld world;
  std::vector<Coordinates> path = jagged_detour();
  const ShortenResult result = shorten(path, world.problem());
  // Two tangents from distance 2 and the arc between: 2√3 + π/3.
  const double best = 2 * std::numbers::sqrt3 + std::numbers::pi / 3;
  EXPECT_GE(result.cost_after, best - 1e-9);
  EXPECT_LE(result.cost_after, 1.01 * best);
  EXPECT_NEAR(result.cost_after, length(path), 1e-9);
  EXPECT_EQ(result.edges_checked, world.asked);
}

TEST(Shorten, KeepsTheEndsAndEveryEdgeOk) {
  DiscWorld world;
  std::vector<Coordinates> path = jagged_detour();
  (void)shorten(path, world.problem());
  EXPECT_EQ(path.front(), coordinates({-2, 0}));
  EXPECT_EQ(path.back(), coordinates({2, 0}));
  for (std::size_t k = 1; k < path.size(); ++k) EXPECT_TRUE(DiscWorld::clear(path[k - 1], path[k]));
}

TEST(Shorten, NeverLengthens) {
  DiscWorld world;
  std::vector<Coordinates> path = {coordinates({-2, 0}), coordinates({-1, 1.2}), coordinates({1, 1.2}),
                                   coordinates({2, 0})};
  const double before = length(path);
  const ShortenResult result = shorten(path, world.problem());
  EXPECT_NEAR(result.cost_before, before, 1e-12);
  EXPECT_LE(length(path), before);
}

TEST(Shorten, FollowsAGeodesicThatIsNotStraightInTheCoordinates) {
  // Polar coordinates (radius, angle): the straight way in the plane is curved in them, and one edge has to be divided.
  const auto place = [](const Coordinates& q) { return Eigen::Vector2d(q[0] * std::cos(q[1]), q[0] * std::sin(q[1])); };
  const auto along = [&](const Coordinates& a, const Coordinates& b) {
    constexpr int kPieces = 50;
    double sum = 0;
    for (int k = 0; k < kPieces; ++k) {
      sum += (place(a + (b - a) * (1.0 * k / kPieces)) - place(a + (b - a) * ((k + 1.0) / kPieces))).norm();
    }
    return sum;
  };
  std::vector<Coordinates> path = {coordinates({1, 0}), coordinates({1, 2})};
  const ShortenResult result = shorten(path, {along, [](const Coordinates&, const Coordinates&) { return true; }, {}});
  const double best = (place(path.front()) - place(path.back())).norm();
  EXPECT_GE(result.cost_after, best);
  EXPECT_LE(result.cost_after, 1.005 * best);
}

TEST(Shorten, AStraightPathStaysStraight) {
  DiscWorld world;
  std::vector<Coordinates> path = {coordinates({-2, 2}), coordinates({0, 2}), coordinates({2, 2})};
  EXPECT_NEAR(shorten(path, world.problem()).cost_after, 4.0, 1e-12);
}

TEST(Shorten, LeavesAPathAloneThatCanHardlyBeShorter) {
  DiscWorld world;
  ShortenProblem problem = world.problem();
  std::vector<Coordinates> path = {coordinates({-2, 2}), coordinates({2, 2})};
  problem.least_cost = 4.0;
  (void)shorten(path, problem);
  EXPECT_EQ(world.asked, 0);
  problem.least_cost = 3.9;  // it may be shorter
  (void)shorten(path, problem);
  EXPECT_GT(world.asked, 0);
}

TEST(Shorten, AsksTheCostThroughAVertexWhereThatIsGiven) {
  DiscWorld world;
  std::vector<Coordinates> path = jagged_detour();
  std::vector<Coordinates> same = path;
  ShortenProblem problem = world.problem();
  const double expected = shorten(same, problem).cost_after;
  int times = 0;
  problem.cost_through = [&](const Coordinates& before, const Coordinates& after) {
    ++times;
    return [=](const Coordinates& x) { return (x - before).norm() + (after - x).norm(); };
  };
  EXPECT_EQ(shorten(path, problem).cost_after, expected);
  EXPECT_EQ(path, same);
  EXPECT_GT(times, 10);
}

TEST(Shorten, LeavesAPathAloneThatNoMoveMayTouch) {
  DiscWorld world;
  ShortenProblem problem = world.problem();
  problem.edge_ok = [](const Coordinates&, const Coordinates&) { return false; };
  std::vector<Coordinates> path = jagged_detour();
  const std::vector<Coordinates> before = path;
  (void)shorten(path, problem);
  EXPECT_EQ(path, before);
}

TEST(Shorten, KeepsItsBudgetOfEdges) {
  DiscWorld world;
  std::vector<Coordinates> path = jagged_detour();
  ShortenOptions options;
  options.max_edges_checked = 10;
  (void)shorten(path, world.problem(), options);
  EXPECT_LE(world.asked, 12);
}

TEST(Shorten, StopsWhenAsked) {
  DiscWorld world;
  std::stop_source source;
  source.request_stop();
  ShortenProblem problem = world.problem();
  problem.stop = source.get_token();
  std::vector<Coordinates> path = jagged_detour();
  (void)shorten(path, problem);
  EXPECT_EQ(world.asked, 0);
}

TEST(Shorten, APathOfOneVertexIsLeftAlone) {
  DiscWorld world;
  std::vector<Coordinates> path = {coordinates({2, 0})};
  EXPECT_EQ(shorten(path, world.problem()).cost_after, 0.0);
}

}  // namespace
}  // namespace taut
