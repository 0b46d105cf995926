#include "atlas/search.h"

#include <gtest/gtest.h>

#include <limits>
#include <queue>
#include <set>

#include "tests/atlas/surfaces.h"

namespace taut {
namespace {

using testing::coordinates;
using testing::kPi;

AtlasOptions options(double radius, double epsilon) {
  AtlasOptions result;
  result.radius = radius;
  result.epsilon = epsilon;
  return result;
}

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
  for (const Strategy strategy : {Strategy::kAStar, Strategy::kGreedyBestFirst}) {
    Atlas atlas(plane, options(0.1, 0.1));
    const SearchProblem query = problem(coordinates({-0.8, -0.7}), coordinates({0.8, 0.6}));
    const SearchResult result = search(atlas, query, strategy);
    expect_sound(result, query, plane);
    EXPECT_LT(result.cost, 1.3 * (query.goal - query.start).norm());
    EXPECT_EQ(result.charts, atlas.size());
    EXPECT_EQ(result.edges_checked, static_cast<int>(result.path.size()) - 1);
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
    const SearchResult result = search(atlas, query, Strategy::kAStar);
    expect_sound(result, query, torus);
    EXPECT_NEAR(result.cost, dijkstra(atlas, query, start, goal), 1e-12);
  }
}

// Edges refused by their geometry: a sieve that lets two thirds through.
bool passes_sieve(const Coordinates& a, const Coordinates& b) {
  const double x = 40 * (std::cos(a[0]) + std::cos(b[0])) + 31 * (std::sin(a[1]) + std::sin(b[1]));
  return x - std::floor(x) < 0.67;
}

TEST(Search, AStarStaysShortestWhenEdgesFail) {
  const testing::FlatTorus torus({0, 0});
  int rejected = 0;
  for (int seed = 0; seed < 20; ++seed) {
    SearchProblem query = problem(coordinates({0.3 * seed, 1}), coordinates({-2.0 + 0.7 * seed, -3.0 + 0.2 * seed}));
    query.edge_ok = passes_sieve;
    Atlas atlas(torus, options(0.5, 0.2));
    const int start = *atlas.add(query.start), goal = *atlas.add(query.goal);
    ASSERT_TRUE(atlas.grow_all());
    const double shortest = dijkstra(atlas, query, start, goal);
    for (const Strategy strategy : {Strategy::kAStar, Strategy::kGreedyBestFirst}) {
      const SearchResult result = search(atlas, query, strategy);
      if (std::isinf(shortest)) {
        EXPECT_EQ(result.status, SearchStatus::kExhausted);
        continue;
      }
      expect_sound(result, query, torus);
      EXPECT_GE(result.cost, shortest - 1e-12);
      EXPECT_TRUE(strategy != Strategy::kAStar || result.cost <= shortest + 1e-12);
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
    const SearchResult result = search(atlas, query, Strategy::kAStar);
    if (result.status == SearchStatus::kExhausted) continue;
    expect_sound(result, query, torus);
    EXPECT_LE(result.cost, dijkstra(atlas, query, 0, 1) + 1e-12);
  }
}

TEST(Search, GoesRoundAWallOfFailingEdges) {
  const testing::FlatSpace plane(2, [](const Coordinates& x) { return x.cwiseAbs().maxCoeff() <= 1; });
  for (const Strategy strategy : {Strategy::kAStar, Strategy::kGreedyBestFirst}) {
    Atlas atlas(plane, options(0.1, 0.1));
    SearchProblem query = problem(coordinates({-0.8, 0}), coordinates({0.8, 0}));
    // A wall x = 0, y < 0.5 that the atlas does not know of.
    query.edge_ok = [](const Coordinates& a, const Coordinates& b) {
      if (a[0] * b[0] > 0) return true;
      const double t = a[0] / (a[0] - b[0]);
      return a[1] + t * (b[1] - a[1]) > 0.5;
    };
    const SearchResult result = search(atlas, query, strategy);
    expect_sound(result, query, plane);
    EXPECT_GT(result.edges_rejected, 5);
    EXPECT_GT(result.cost, 2 * std::hypot(0.8, 0.5));
  }
}

TEST(Search, ReportsAnExhaustedComponent) {
  const testing::FlatSpace two_discs(2, [](const Coordinates& x) {
    return (x - coordinates({-1, 0})).norm() < 0.6 || (x - coordinates({1, 0})).norm() < 0.6;
  });
  for (const Strategy strategy : {Strategy::kAStar, Strategy::kGreedyBestFirst}) {
    Atlas atlas(two_discs, options(0.1, 0.1));
    const SearchResult result = search(atlas, problem(coordinates({-1, 0}), coordinates({1, 0})), strategy);
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
  for (const Strategy strategy : {Strategy::kAStar, Strategy::kGreedyBestFirst}) {
    Atlas atlas(circle, options(0.2, 0.1));
    const SearchResult result = search(atlas, query, strategy);
    EXPECT_EQ(result.status, SearchStatus::kExhausted);
    EXPECT_EQ(result.edges_rejected, 2);
  }
}

TEST(Search, ReportsTheChartLimitAndInterruption) {
  const testing::FlatSpace plane(2);
  const SearchProblem query = problem(coordinates({0, 0}), coordinates({100, 0}));
  AtlasOptions few = options(0.1, 0.1);
  few.max_charts = 50;
  for (const Strategy strategy : {Strategy::kAStar, Strategy::kGreedyBestFirst}) {
    Atlas atlas(plane, few);
    const SearchResult limited = search(atlas, query, strategy);
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
    EXPECT_EQ(search(endless, interrupted, strategy).status, SearchStatus::kInterrupted);
    EXPECT_EQ(reports, 2);
  }
}

TEST(Search, ReportsAQueryOutsideTheDomain) {
  const testing::PolarSphere cap(0.5);
  Atlas atlas(cap, options(0.1, 0.1));
  EXPECT_EQ(search(atlas, problem(coordinates({0, 0}), coordinates({0, 0.6})), Strategy::kAStar).status,
            SearchStatus::kOutside);
}

TEST(Search, CountsTheHalfTurnsToTheGoalsImage) {
  const testing::FlatTorus circle({0});
  const SearchProblem query = problem(coordinates({3}), coordinates({-2.5}));
  Atlas atlas(circle, options(0.1, 0.1));
  const SearchResult result = search(atlas, query, Strategy::kAStar);
  expect_sound(result, query, circle);
  EXPECT_EQ(result.path.back().image.half_turns[0], 2);
  EXPECT_DOUBLE_EQ(result.cost, 2 * kPi - 5.5);
}

TEST(Search, GoesOverThePoleAndFlips) {
  const testing::PolarSphere sphere;
  // Opposite each other near the pole theta = 0.
  const SearchProblem query = problem(coordinates({0.2, 0.9}), coordinates({0.2 + kPi, 0.8}), great_circle);
  for (const Strategy strategy : {Strategy::kAStar, Strategy::kGreedyBestFirst}) {
    Atlas atlas(sphere, options(0.15, 0.1));
    const SearchResult result = search(atlas, query, strategy);
    expect_sound(result, query, sphere);
    EXPECT_GE(result.cost, 1.7 - 1e-9);
    EXPECT_TRUE(strategy != Strategy::kAStar || result.cost < 1.15 * 1.7) << result.cost;
    const Image& image = result.path.back().image;
    EXPECT_EQ(image.flipped, image.half_turns[0] % 2 != 0);
  }
}

TEST(Search, JoinsAStartThatIsItsGoal) {
  const testing::PolarSphere sphere;
  Atlas atlas(sphere, options(0.2, 0.1));
  const SearchProblem query = problem(coordinates({0.5, 0.75}), coordinates({0.5 - kPi, -0.75}), great_circle);
  const SearchResult result = search(atlas, query, Strategy::kAStar);
  expect_sound(result, query, sphere);
  EXPECT_EQ(result.path.size(), 2u);
  EXPECT_TRUE(result.path.back().image.flipped);
  EXPECT_EQ(result.path.back().image.half_turns[0], 1);
}

TEST(Search, GreedyFindsItsWayInSixDimensions) {
  const testing::FlatSpace space(6, [](const Coordinates& x) { return x.cwiseAbs().maxCoeff() <= 1; });
  Atlas atlas(space, options(0.15, 0.15));
  const SearchProblem query = problem(Coordinates::Constant(6, -0.6), Coordinates::Constant(6, 0.6));
  const SearchResult result = search(atlas, query, Strategy::kGreedyBestFirst);
  expect_sound(result, query, space);
  EXPECT_LT(result.charts, 500);
}

}  // namespace
}  // namespace taut
