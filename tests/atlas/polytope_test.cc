// SPDX-License-Identifier: GPL-3.0-or-later
#include "atlas/polytope.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <random>
#include <set>
#include <vector>

namespace taut {
namespace {

TangentVector vector(std::initializer_list<double> values) {
  TangentVector result(values.size());
  std::copy(values.begin(), values.end(), result.data());
  return result;
}

struct HalfSpace {
  TangentVector normal;
  double offset;
};

// Whether each vertex has n different facets and lies on them, inside all the others, and n edges, each to a vertex
// that shares the other facets and points back.
void expect_sound(const Polytope& polytope, double half_side, const std::vector<HalfSpace>& cuts) {
  const int n = polytope.dimension();
  const auto& vertices = polytope.vertices();
  const double tolerance = 1e-9;
  for (int v = 0; v < static_cast<int>(vertices.size()); ++v) {
    const TangentVector x = polytope.corner(v);
    EXPECT_NEAR(vertices[v].squared_norm, x.squaredNorm(), 1e-12);
    EXPECT_LE(x.cwiseAbs().maxCoeff(), half_side + tolerance);
    for (const HalfSpace& cut : cuts) EXPECT_LE(cut.normal.dot(x) - cut.offset, tolerance);
    std::set<int> facets;
    for (int k = 0; k < n; ++k) {
      const int facet = vertices[v].facets[k];
      facets.insert(facet);
      if (facet >= 0) {
        EXPECT_NEAR(cuts[facet].normal.dot(x), cuts[facet].offset, tolerance);
      } else {
        EXPECT_NEAR(x[(-facet - 1) / 2], (-facet - 1) % 2 ? half_side : -half_side, tolerance);
      }
      const Polytope::Vertex& neighbour = vertices.at(vertices[v].neighbours[k]);
      const auto end = neighbour.neighbours.begin() + n;
      EXPECT_EQ(std::count(neighbour.neighbours.begin(), end, v), 1);
      for (int j = 0; j < n; ++j) {
        const bool shared = std::count(neighbour.facets.begin(), neighbour.facets.begin() + n, vertices[v].facets[j]);
        EXPECT_EQ(shared, j != k);
      }
    }
    EXPECT_EQ(static_cast<int>(facets.size()), n);
  }
}

// Vertices by brute force: each choice of n facets, solved and tested.
int count_vertices_of_polygon(double half_side, std::vector<HalfSpace> cuts) {
  for (int k = 0; k < 2; ++k) {
    for (const double sign : {-1.0, 1.0}) cuts.push_back({sign * TangentVector(TangentVector::Unit(2, k)), half_side});
  }
  int count = 0;
  for (std::size_t i = 0; i < cuts.size(); ++i) {
    for (std::size_t j = i + 1; j < cuts.size(); ++j) {
      const auto &a = cuts[i].normal, &b = cuts[j].normal;
      const double det = a[0] * b[1] - a[1] * b[0];
      if (std::abs(det) < 1e-12) continue;
      const TangentVector x = vector({(cuts[i].offset * b[1] - a[1] * cuts[j].offset) / det,
                                      (a[0] * cuts[j].offset - cuts[i].offset * b[0]) / det});
      count += std::all_of(cuts.begin(), cuts.end(),
                           [&](const HalfSpace& cut) { return cut.normal.dot(x) <= cut.offset + 1e-11; });
    }
  }
  return count;
}

TEST(Polytope, BeginsAsACube) {
  for (int n = 1; n <= Polytope::kMaxDimension; ++n) {
    const Polytope cube(n, 0.5);
    EXPECT_EQ(static_cast<int>(cube.vertices().size()), 1 << n);
    EXPECT_TRUE(cube.cutting_facets().empty());
    expect_sound(cube, 0.5, {});
  }
}

TEST(Polytope, ClipsASegment) {
  Polytope segment(1, 1.0);
  EXPECT_TRUE(segment.clip(vector({2}), 1, 0));
  EXPECT_EQ(segment.vertices().size(), 2u);
  EXPECT_TRUE(segment.has_facet(0));
  EXPECT_TRUE(segment.clip(vector({-1}), 0.25, 1));
  EXPECT_EQ(segment.cutting_facets(), (std::vector<int>{0, 1}));
  expect_sound(segment, 1.0, {{vector({2}), 1}, {vector({-1}), 0.25}});
}

TEST(Polytope, ClipsACubeToASimplex) {
  for (int n = 2; n <= Polytope::kMaxDimension; ++n) {
    Polytope polytope(n, 1.0);
    std::vector<HalfSpace> cuts;
    // sum u <= 0.4 and u_k >= -0.1: all the cube's facets go.
    cuts.push_back({TangentVector::Ones(n), 0.4});
    for (int k = 0; k < n; ++k) cuts.push_back({-TangentVector(TangentVector::Unit(n, k)), 0.1});
    for (int f = 0; f <= n; ++f) EXPECT_TRUE(polytope.clip(cuts[f].normal, cuts[f].offset, f));
    EXPECT_EQ(static_cast<int>(polytope.vertices().size()), n + 1);
    EXPECT_EQ(static_cast<int>(polytope.cutting_facets().size()), n + 1);
    expect_sound(polytope, 1.0, cuts);
  }
}

TEST(Polytope, IgnoresAHalfSpaceThatHoldsIt) {
  Polytope polytope(3, 1.0);
  EXPECT_FALSE(polytope.clip(vector({1, 1, 1}), 3.5, 0));
  EXPECT_FALSE(polytope.has_facet(0));
}

TEST(Polytope, SparesAVertexThatACutOnlyTouches) {
  Polytope polytope(2, 1.0);
  EXPECT_FALSE(polytope.clip(vector({1, 1}), 2.0, 0));
  EXPECT_EQ(polytope.vertices().size(), 4u);
  EXPECT_TRUE(polytope.clip(vector({1, 0}), 0.5, 1));
  EXPECT_FALSE(polytope.clip(vector({2, 0}), 1.0, 2)) << "the same facet twice";
  expect_sound(polytope, 1.0, {{vector({1, 1}), 2.0}, {vector({1, 0}), 0.5}, {vector({2, 0}), 1.0}});
}

TEST(Polytope, StaysSimpleUnderDegenerateCuts) {
  for (int n = 2; n <= Polytope::kMaxDimension; ++n) {
    // All bisectors of the integer lattice's neighbours: many pass through common vertices.
    Polytope polytope(n, 2.0);
    std::vector<HalfSpace> cuts;
    int points = 1;
    for (int k = 0; k < n; ++k) points *= 3;
    for (int code = 0; code < points; ++code) {
      TangentVector u(n);
      for (int k = 0, rest = code; k < n; ++k, rest /= 3) u[k] = rest % 3 - 1;
      if (u.squaredNorm() == 0) continue;
      cuts.push_back({u, u.squaredNorm() / 2});
      polytope.clip(u, u.squaredNorm() / 2, static_cast<int>(cuts.size()) - 1);
    }
    expect_sound(polytope, 2.0, cuts);
    // The unit cube, each corner as often as it takes for each to be on n facets only.
    std::set<std::vector<int>> corners;
    for (int v = 0; v < static_cast<int>(polytope.vertices().size()); ++v) {
      std::vector<int> corner;
      for (const double x : polytope.corner(v)) corner.push_back(static_cast<int>(std::lround(2 * x)));
      corners.insert(corner);
      EXPECT_NEAR(polytope.vertices()[v].squared_norm, n * 0.25, 1e-12);
    }
    EXPECT_EQ(static_cast<int>(corners.size()), 1 << n);
  }
}

TEST(Polytope, AgreesWithBruteForceInThePlane) {
  std::mt19937 random(1);
  std::normal_distribution<double> normal;
  for (int trial = 0; trial < 200; ++trial) {
    Polytope polytope(2, 1.0);
    std::vector<HalfSpace> cuts;
    for (int f = 0; f < 20; ++f) {
      const TangentVector u = vector({normal(random), normal(random)});
      cuts.push_back({u, u.squaredNorm() / 2});
      polytope.clip(u, u.squaredNorm() / 2, f);
    }
    expect_sound(polytope, 1.0, cuts);
    ASSERT_EQ(static_cast<int>(polytope.vertices().size()), count_vertices_of_polygon(1.0, cuts));
  }
}

TEST(Polytope, KeepsEulersRelationAfterRandomCuts) {
  std::mt19937 random(2);
  std::normal_distribution<double> normal;
  for (int trial = 0; trial < 20; ++trial) {
    constexpr int n = 3;
    Polytope polytope(n, 1.0);
    std::vector<HalfSpace> cuts;
    for (int f = 0; f < 18; ++f) {
      TangentVector u(n);
      for (int k = 0; k < n; ++k) u[k] = normal(random);
      u.normalize();
      cuts.push_back({u, 0.7});
      polytope.clip(u, 0.7, f);
    }
    expect_sound(polytope, 1.0, cuts);
    // f-vector: a k-face of a simple polytope is named by the n - k facets around it.
    int alternating = 0;
    for (int k = 0; k < n; ++k) {
      std::set<std::set<int>> faces;
      for (const auto& vertex : polytope.vertices()) {
        for (int choice = 0; choice < 1 << n; ++choice) {
          if (__builtin_popcount(unsigned(choice)) != n - k) continue;
          std::set<int> face;
          for (int j = 0; j < n; ++j) {
            if (choice >> j & 1) face.insert(vertex.facets[j]);
          }
          faces.insert(face);
        }
      }
      alternating += (k % 2 ? -1 : 1) * static_cast<int>(faces.size());
    }
    EXPECT_EQ(alternating, 2);
  }
}

TEST(Polytope, ForgetsMarksOnlyOnNewVertices) {
  Polytope polytope(2, 1.0);
  for (int v = 0; v < 4; ++v) polytope.mark(v);
  polytope.clip(vector({1, 1}), 1.5, 0);
  int unmarked = 0;
  for (const auto& vertex : polytope.vertices()) unmarked += !vertex.marked;
  EXPECT_EQ(unmarked, 2);
}

}  // namespace
}  // namespace taut
