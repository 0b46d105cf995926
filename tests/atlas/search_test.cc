// SPDX-License-Identifier: GPL-3.0-or-later
#include "atlas/search.h"

#include <gtest/gtest.h>

#include <queue>
#include <set>

#include "tests/atlas/surfaces.h"

namespace taut {
namespace {

using testing::coordinates;
using testing::kGreedy;
using testing::kPi;
using testing::options;

double euclidean(const Coordinates& a, const Coordinates& b) { return (a - b).norm(); }

double great_circle(const Coordinates& a, const Coordinates& b) {
  const Eigen::Vector3d p = testing::PolarSphere::at(a), q = testing::PolarSphere::at(b);
  return std::atan2(p.cross(q).norm(), p.dot(q));
}

SearchProblem problem(const Coordinates& start, const Coordinates& goal,
                      const std::function<double(const Coordinates&, const Coordinates&)>& cost = euclidean) {
  SearchProblem result;
  result.start = start;
  result.goal = goal;
  result.cost = cost;
  result.heuristic = cost;
  result.edge_ok = [](const Coordinates&, const Coordinates&) { return true; };
  return result;
}

// Shortest length on the charts' graph, by a search that knows nothing of goals or laziness.
double dijkstra(const Atlas& atlas, const SearchProblem& problem, int start, int goal) {
  const CoordinateSymmetry symmetry = atlas.manifold().symmetry();
  std::vector<double> distance(atlas.size(), std::numeric_limits<double>::infinity());
  std::set<std::pair<double, int>> open{{0, start}};
  distance[start] = 0;
  while (!open.empty()) {
    const int node = open.begin()->second;
    open.erase(open.begin());
    const Coordinates from = atlas.chart(node).frame.coordinates();
    for (const int next : atlas.neighbours(node)) {
      const Coordinates base = atlas.chart(next).frame.coordinates();
      const Coordinates to = symmetry.apply(base, symmetry.nearest_image(base, from));
      if (!problem.edge_ok(from, to)) continue;
      const double through = distance[node] + problem.cost(from, to);
      if (through >= distance[next]) continue;
      open.erase({distance[next], next});
      distance[next] = through;
      open.insert({through, next});
    }
  }
  return distance[goal];
}

// A path from the query's start to an image of its goal, each vertex an image of its base, of the length claimed.
void expect_sound(const SearchResult& result, const SearchProblem& problem, const Manifold& manifold) {
  ASSERT_EQ(result.status, SearchStatus::kFound);
  ASSERT_GE(result.path.size(), 2u);
  EXPECT_EQ(result.path.front().base, problem.start);
  EXPECT_EQ(result.path.front().coordinates, problem.start);
  EXPECT_EQ(result.path.front().image, Image{});
  EXPECT_EQ(result.path.back().base, problem.goal);
  const CoordinateSymmetry symmetry = manifold.symmetry();
  double cost = 0;
  for (std::size_t i = 0; i < result.path.size(); ++i) {
    const PathVertex& vertex = result.path[i];
    EXPECT_EQ(vertex.coordinates, symmetry.apply(vertex.base, vertex.image));
    if (i == 0) continue;
    const PathVertex& before = result.path[i - 1];
    EXPECT_EQ(vertex.image, symmetry.nearest_image(vertex.base, before.coordinates));
    EXPECT_TRUE(problem.edge_ok(before.coordinates, vertex.coordinates));
    cost += problem.cost(before.coordinates, vertex.coordinates);
  }
  EXPECT_NEAR(result.cost, cost, 1e-12);
}

TEST(Search, CrossesAPlaneAlmostStraight) {
  const testing::FlatSpace plane(2, [](const Coordinates& x) { return x.cwiseAbs().maxCoeff() <= 1; });
  for (const double weight : {1.0, 1.5, kGreedy}) {
    Atlas atlas(plane, options(0.1, 0.1));
    const SearchProblem query = problem(coordinates({-0.8, -0.7}), coordinates({0.8, 0.6}));
    const SearchResult result = search(atlas, query, {.weight = weight});
    expect_sound(result, query, plane);
    EXPECT_LT(result.cost, 1.3 * (query.goal - query.start).norm());
    EXPECT_EQ(result.charts, atlas.size());
    EXPECT_EQ(result.edges_checked, static_cast<int>(result.path.size()) - 1);
  }
}

TEST(Search, StraightToTheGoalNeedsNoChartsWhereNothingIsInTheWay) {
  const testing::FlatSpace plane(2, [](const Coordinates& x) { return x.cwiseAbs().maxCoeff() <= 1; });
  for (const double weight : {1.0, 1.5, kGreedy}) {
    Atlas atlas(plane, options(0.1, 0.1));
    SearchProblem query = problem(coordinates({-0.8, -0.7}), coordinates({0.8, 0.6}));
    query.straight_to_goal = true;
    const SearchResult result = search(atlas, query, {.weight = weight});
    expect_sound(result, query, plane);
    EXPECT_EQ(result.path.size(), 2u);
    EXPECT_NEAR(result.cost, (query.goal - query.start).norm(), 1e-12);
  }
}

// Walking round a wall, x = 0 for |y| <= 0.5, the goal comes into sight beyond its end.
TEST(Search, AGreedyPathStatesTheCostOfItsEdgeToTheGoal) {
  const testing::FlatSpace plane(2, [](const Coordinates& x) { return x.cwiseAbs().maxCoeff() <= 1; });
  for (const bool is_clear : {true, false}) {  // straight from the start, or from a chart on the way
    Atlas atlas(plane, options(0.1, 0.1));
    SearchProblem query = problem(coordinates({-0.8, -0.7}), coordinates({0.8, 0.6}));
    query.heuristic = [](const Coordinates& a, const Coordinates& b) { return 0.5 * euclidean(a, b); };
    query.straight_to_goal = true;
    query.edge_ok = [&](const Coordinates& a, const Coordinates& b) { return is_clear || (b - a).norm() < 0.5; };
    const SearchResult result = search(atlas, query, {.weight = kGreedy});
    expect_sound(result, query, plane);
    EXPECT_EQ(result.path.size() == 2, is_clear);
  }
}

TEST(Search, StraightToTheGoalShortensTheWayRoundAWall) {
  const testing::FlatSpace plane(2, [](const Coordinates& x) { return x.cwiseAbs().maxCoeff() <= 1; });
  const auto crosses = [](const Coordinates& a, const Coordinates& b) {
    if (a[0] * b[0] > 0) return false;
    return std::abs(a[1] + (b[1] - a[1]) * a[0] / (a[0] - b[0])) <= 0.5;
  };
  SearchProblem query = problem(coordinates({-0.6, 0.05}), coordinates({0.6, 0.05}));
  query.edge_ok = [&](const Coordinates& a, const Coordinates& b) { return !crosses(a, b); };
  for (const double weight : {1.0, kGreedy}) {
    Atlas centres_only(plane, options(0.1, 0.1));
    const SearchResult longer = search(centres_only, query, {.weight = weight});
    query.straight_to_goal = true;
    Atlas atlas(plane, options(0.1, 0.1));
    const SearchResult result = search(atlas, query, {.weight = weight});
    query.straight_to_goal = false;
    expect_sound(result, query, plane);
    EXPECT_LT(result.charts, longer.charts);
    if (weight == 1.0) {
      EXPECT_LT(result.cost, longer.cost);
    }
    EXPECT_GE(result.cost, 2 * std::hypot(0.6, 0.45) - 1e-12);
  }
}

TEST(Search, AStarIsShortestOnAFinishedAtlas) {
  const testing::FlatTorus torus({0, 0});
  for (int seed = 0; seed < 20; ++seed) {
    const SearchProblem query =
        problem(coordinates({0.3 * seed, 1}), coordinates({-2.0 + 0.7 * seed, -3.0 + 0.2 * seed}));
    Atlas atlas(torus, options(0.5, 0.2));
    const int start = *atlas.add(query.start), goal = *atlas.add(query.goal);
    ASSERT_TRUE(atlas.grow_all());
    const SearchResult result = search(atlas, query, {});
    expect_sound(result, query, torus);
    EXPECT_NEAR(result.cost, dijkstra(atlas, query, start, goal), 1e-12);
  }
}

// Edges refused by their geometry: a sieve that lets two thirds through, and one that lets those and half of the rest.
double sieve(const Coordinates& a, const Coordinates& b) {
  const double x = 40 * (std::cos(a[0]) + std::cos(b[0])) + 31 * (std::sin(a[1]) + std::sin(b[1]));
  return x - std::floor(x);
}
bool passes_sieve(const Coordinates& a, const Coordinates& b) { return sieve(a, b) < 0.67; }
bool passes_coarse_sieve(const Coordinates& a, const Coordinates& b) { return sieve(a, b) < 0.84; }

TEST(Search, AStarStaysShortestWhenEdgesFail) {
  const testing::FlatTorus torus({0, 0});
  int rejected = 0;
  for (int seed = 0; seed < 20; ++seed) {
    SearchProblem query = problem(coordinates({0.3 * seed, 1}), coordinates({-2.0 + 0.7 * seed, -3.0 + 0.2 * seed}));
    query.edge_ok = passes_sieve;
    if (seed % 2 == 1) query.edge_likely = passes_coarse_sieve;
    Atlas atlas(torus, options(0.5, 0.2));
    const int start = *atlas.add(query.start), goal = *atlas.add(query.goal);
    ASSERT_TRUE(atlas.grow_all());
    const double shortest = dijkstra(atlas, query, start, goal);
    for (const double weight : {1.0, 1.5, kGreedy}) {
      const SearchResult result = search(atlas, query, {.weight = weight});
      if (std::isinf(shortest)) {
        EXPECT_EQ(result.status, SearchStatus::kExhausted);
        continue;
      }
      expect_sound(result, query, torus);
      EXPECT_GE(result.cost, shortest - 1e-12);
      EXPECT_EQ(result.factor, weight);
      EXPECT_LE(result.cost, weight * shortest + 1e-12);
      rejected += result.edges_rejected;
    }
  }
  EXPECT_GT(rejected, 100);
}

TEST(Search, AStarOnAGrowingAtlasIsAsShortAsItsGraphAllows) {
  const testing::FlatTorus torus({0, 0});
  for (int seed = 0; seed < 10; ++seed) {
    SearchProblem query = problem(coordinates({0.3 * seed, 1}), coordinates({-2.0 + 0.7 * seed, -3.0 + 0.2 * seed}));
    query.edge_ok = passes_sieve;
    Atlas atlas(torus, options(0.3, 0.2));
    const SearchResult result = search(atlas, query, {});
    if (result.status == SearchStatus::kExhausted) continue;
    expect_sound(result, query, torus);
    EXPECT_LE(result.cost, dijkstra(atlas, query, 0, 1) + 1e-12);
  }
}

TEST(Search, GoesRoundAWallOfFailingEdges) {
  const testing::FlatSpace plane(2, [](const Coordinates& x) { return x.cwiseAbs().maxCoeff() <= 1; });
  for (const double weight : {1.0, 1.5, kGreedy}) {
    Atlas atlas(plane, options(0.1, 0.1));
    SearchProblem query = problem(coordinates({-0.8, 0}), coordinates({0.8, 0}));
    // A wall x = 0, y < 0.5 that the atlas does not know of.
    query.edge_ok = [](const Coordinates& a, const Coordinates& b) {
      if (a[0] * b[0] > 0) return true;
      const double t = a[0] / (a[0] - b[0]);
      return a[1] + t * (b[1] - a[1]) > 0.5;
    };
    const SearchResult result = search(atlas, query, {.weight = weight});
    expect_sound(result, query, plane);
    EXPECT_GT(result.edges_rejected, 5);
    EXPECT_GT(result.cost, 2 * std::hypot(0.8, 0.5));
  }
}

TEST(Search, ReportsAnExhaustedComponent) {
  const testing::FlatSpace two_discs(2, [](const Coordinates& x) {
    return (x - coordinates({-1, 0})).norm() < 0.6 || (x - coordinates({1, 0})).norm() < 0.6;
  });
  for (const double weight : {1.0, 1.5, kGreedy}) {
    Atlas atlas(two_discs, options(0.1, 0.1));
    const SearchResult result = search(atlas, problem(coordinates({-1, 0}), coordinates({1, 0})), {.weight = weight});
    EXPECT_EQ(result.status, SearchStatus::kExhausted);
    EXPECT_TRUE(result.path.empty());
    for (int id = 0; id < atlas.size(); ++id) {
      EXPECT_TRUE(id == 1 || atlas.chart(id).frame.point()[0] < 0) << "the goal's disc was entered";
    }
  }
}

TEST(Search, ReportsExhaustionWhenEveryEdgeFails) {
  const testing::FlatTorus circle({0});
  SearchProblem query = problem(coordinates({0}), coordinates({2}));
  query.edge_ok = [](const Coordinates&, const Coordinates&) { return false; };
  for (const double weight : {1.0, 1.5, kGreedy}) {
    Atlas atlas(circle, options(0.2, 0.1));
    const SearchResult result = search(atlas, query, {.weight = weight});
    EXPECT_EQ(result.status, SearchStatus::kExhausted);
    EXPECT_EQ(result.edges_rejected, 2);
  }
}

TEST(Search, ReportsTheChartLimitAndInterruption) {
  const testing::FlatSpace plane(2);
  const SearchProblem query = problem(coordinates({0, 0}), coordinates({100, 0}));
  AtlasOptions few = options(0.1, 0.1);
  few.max_charts = 50;
  for (const double weight : {1.0, 1.5, kGreedy}) {
    Atlas atlas(plane, few);
    const SearchResult limited = search(atlas, query, {.weight = weight});
    EXPECT_EQ(limited.status, SearchStatus::kChartLimit);
    EXPECT_EQ(limited.charts, 50);

    std::stop_source source;
    SearchProblem interrupted = query;
    interrupted.stop = source.get_token();
    int reports = 0;
    interrupted.progress = [&](const SearchProgress& progress) {
      EXPECT_GT(progress.lowest_heuristic, 0);
      if (++reports == 2) source.request_stop();
    };
    Atlas endless(plane, options(0.1, 0.1));
    EXPECT_EQ(search(endless, interrupted, {.weight = weight}).status, SearchStatus::kInterrupted);
    EXPECT_EQ(reports, 2);
  }
}

TEST(Search, ReportsAQueryOutsideTheDomain) {
  const testing::PolarSphere cap(0.5);
  Atlas atlas(cap, options(0.1, 0.1));
  EXPECT_EQ(search(atlas, problem(coordinates({0, 0}), coordinates({0, 0.6})), {}).status, SearchStatus::kOutside);
}

TEST(Search, CountsTheHalfTurnsToTheGoalsImage) {
  const testing::FlatTorus circle({0});
  const SearchProblem query = problem(coordinates({3}), coordinates({-2.5}));
  Atlas atlas(circle, options(0.1, 0.1));
  const SearchResult result = search(atlas, query, {});
  expect_sound(result, query, circle);
  EXPECT_EQ(result.path.back().image.half_turns[0], 2);
  EXPECT_DOUBLE_EQ(result.cost, 2 * kPi - 5.5);
}

TEST(Search, GoesOverThePoleAndFlips) {
  const testing::PolarSphere sphere;
  // Opposite each other near the pole theta = 0.
  const SearchProblem query = problem(coordinates({0.2, 0.9}), coordinates({0.2 + kPi, 0.8}), great_circle);
  for (const double weight : {1.0, 1.5, kGreedy}) {
    Atlas atlas(sphere, options(0.15, 0.1));
    const SearchResult result = search(atlas, query, {.weight = weight});
    expect_sound(result, query, sphere);
    EXPECT_GE(result.cost, 1.7 - 1e-9);
    EXPECT_TRUE(weight > 1 || result.cost < 1.15 * 1.7) << result.cost;
    const Image& image = result.path.back().image;
    EXPECT_EQ(image.flipped, image.half_turns[0] % 2 != 0);
  }
}

TEST(Search, JoinsAStartThatIsItsGoal) {
  const testing::PolarSphere sphere;
  Atlas atlas(sphere, options(0.2, 0.1));
  const SearchProblem query = problem(coordinates({0.5, 0.75}), coordinates({0.5 - kPi, -0.75}), great_circle);
  const SearchResult result = search(atlas, query, {});
  expect_sound(result, query, sphere);
  EXPECT_EQ(result.path.size(), 2u);
  EXPECT_TRUE(result.path.back().image.flipped);
  EXPECT_EQ(result.path.back().image.half_turns[0], 1);
}

TEST(Search, JoinsTheChartsAroundAGoalThatManyCover) {
  const testing::FlatTorus torus({0, 0});
  Atlas atlas(torus, options(0.3, 0.2));
  ASSERT_TRUE(atlas.add(coordinates({0, 0})).has_value());
  ASSERT_TRUE(atlas.grow_all());
  // Corners of polygons: as far from all centres as can be, so that several balls hold them.
  for (int id = 0; id < 20; ++id) {
    const Chart chart = atlas.chart(id);
    Coordinates goal(2);
    ASSERT_TRUE(torus.project(chart.frame, std::get<Polytope>(chart.polytope).corner(0), goal));
    const SearchProblem query = problem(coordinates({0, 0}), goal);
    const SearchResult result = search(atlas, query, {});
    expect_sound(result, query, torus);
    EXPECT_GE(atlas.neighbours(*atlas.add(goal)).size(), 3u);
  }
}

TEST(Search, SaysHowNearTheGoalItCame) {
  const testing::FlatSpace disc(2, [](const Coordinates& x) { return x.norm() < 1 || x[0] > 2; });
  for (const double weight : {1.0, 1.5, kGreedy}) {
    Atlas atlas(disc, options(0.1, 0.1));
    const SearchResult result = search(atlas, problem(coordinates({0, 0}), coordinates({3, 0})), {.weight = weight});
    ASSERT_EQ(result.status, SearchStatus::kExhausted);
    EXPECT_NEAR(result.nearest, 2, 0.1);
    EXPECT_TRUE(std::isinf(result.factor));
  }
}

TEST(Search, WantsOnlyPathsBelowTheBound) {
  const testing::FlatTorus torus({0, 0});
  const SearchProblem query = problem(coordinates({0, 1}), coordinates({2, -2}));
  Atlas atlas(torus, options(0.3, 0.2));
  ASSERT_TRUE(atlas.add(query.start) && atlas.add(query.goal) && atlas.grow_all());
  const SearchResult shortest = search(atlas, query, {});
  expect_sound(shortest, query, torus);
  EXPECT_EQ(search(atlas, query, {.cost_bound = shortest.cost}).status, SearchStatus::kExhausted);
  const SearchResult again = search(atlas, query, {.cost_bound = shortest.cost + 1e-9});
  expect_sound(again, query, torus);
  EXPECT_EQ(again.cost, shortest.cost);
}

TEST(AnytimeSearch, EndsWithTheShortestPathWhereItMay) {
  const testing::FlatTorus torus({0, 0});
  int improvements = 0;
  for (int seed = 0; seed < 20; ++seed) {
    SearchProblem query = problem(coordinates({0.3 * seed, 1}), coordinates({-2.0 + 0.7 * seed, -3.0 + 0.2 * seed}));
    query.edge_ok = passes_sieve;
    Atlas atlas(torus, options(0.5, 0.2));
    const int start = *atlas.add(query.start), goal = *atlas.add(query.goal);
    ASSERT_TRUE(atlas.grow_all());
    const double shortest = dijkstra(atlas, query, start, goal);
    double last = std::numeric_limits<double>::infinity();
    const SearchResult result = search_anytime(atlas, query, [&](const SearchResult& improved) {
      EXPECT_LT(improved.cost, last);
      last = improved.cost;
      ++improvements;
    });
    if (std::isinf(shortest)) {
      EXPECT_EQ(result.status, SearchStatus::kExhausted);
      continue;
    }
    expect_sound(result, query, torus);
    EXPECT_EQ(result.cost, last);
    EXPECT_EQ(result.factor, 1);
    EXPECT_NEAR(result.cost, shortest, 1e-12);
  }
  EXPECT_GT(improvements, 22);
}

TEST(AnytimeSearch, KeepsTheBestPathWhenChartsRunOut) {
  const testing::FlatSpace space(6, [](const Coordinates& x) { return x.cwiseAbs().maxCoeff() <= 1; });
  AtlasOptions few = options(0.15, 0.15);
  few.max_charts = 400;
  Atlas atlas(space, few);
  const SearchProblem query = problem(Coordinates::Constant(6, -0.5), Coordinates::Constant(6, 0.5));
  double first = 0;
  const SearchResult result = search_anytime(atlas, query, [&](const SearchResult& improved) {
    if (first == 0) first = improved.cost;
  });
  expect_sound(result, query, space);
  EXPECT_EQ(result.charts, 400);
  EXPECT_LE(result.cost, first);
  EXPECT_GT(result.factor, 1);
}

TEST(AnytimeSearch, KeepsTheBestPathWhenStopped) {
  const testing::FlatSpace plane(2);
  std::stop_source source;
  SearchProblem query = problem(coordinates({0, 0}), coordinates({2, 0}));
  query.stop = source.get_token();
  Atlas atlas(plane, options(0.1, 0.1));
  const SearchResult result = search_anytime(atlas, query, [&](const SearchResult&) { source.request_stop(); });
  query.stop = {};
  expect_sound(result, query, plane);
  EXPECT_TRUE(std::isinf(result.factor));
}

TEST(AnytimeSearch, TakesAnyPathWhereAllCostNothing) {
  const testing::FlatSpace space(4, [](const Coordinates& x) { return x.cwiseAbs().maxCoeff() <= 1; });
  Atlas atlas(space, options(0.15, 0.15));
  const SearchProblem query = problem(Coordinates::Constant(4, -0.5), Coordinates::Constant(4, 0.5),
                                      [](const Coordinates&, const Coordinates&) { return 0.0; });
  const SearchResult result = search_anytime(atlas, query, [](const SearchResult&) {});
  expect_sound(result, query, space);
  EXPECT_EQ(result.factor, 1);
  EXPECT_LT(result.charts, 100) << "the goal's direction is followed all the same";
}

TEST(AnytimeSearch, SaysWhenThereIsNoPath) {
  const testing::FlatSpace disc(2, [](const Coordinates& x) { return x.norm() < 1 || x[0] > 2; });
  Atlas atlas(disc, options(0.1, 0.1));
  const SearchResult result = search_anytime(atlas, problem(coordinates({0, 0}), coordinates({3, 0})),
                                             [](const SearchResult&) { FAIL() << "no path exists"; });
  EXPECT_EQ(result.status, SearchStatus::kExhausted);
}

TEST(Search, GreedyFindsItsWayInSixDimensions) {
  const testing::FlatSpace space(6, [](const Coordinates& x) { return x.cwiseAbs().maxCoeff() <= 1; });
  Atlas atlas(space, options(0.15, 0.15));
  const SearchProblem query = problem(Coordinates::Constant(6, -0.6), Coordinates::Constant(6, 0.6));
  const SearchResult result = search(atlas, query, {.weight = kGreedy});
  expect_sound(result, query, space);
  EXPECT_LT(result.charts, 500);
}

}  // namespace
}  // namespace taut
