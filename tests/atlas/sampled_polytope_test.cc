// SPDX-License-Identifier: GPL-3.0-or-later
#include "atlas/sampled_polytope.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <limits>
#include <random>
#include <set>
#include <vector>

namespace taut {
namespace {

constexpr double kSingle = 1e-6;  // relative error of a reach

TangentVector random_unit(int n, std::mt19937& random) {
  std::normal_distribution<double> normal;
  TangentVector u(n);
  for (double& x : u) x = normal(random);
  return u.normalized();
}

TEST(SampledPolytope, BeginsAsABall) {
  for (int n = 1; n <= kMaxDimension; ++n) {
    const SampledPolytope ball(n, 0.5);
    EXPECT_EQ(ball.corners(), 2 * n * n);
    EXPECT_TRUE(ball.cutting_facets().empty());
    EXPECT_EQ(ball.circumradius(), 0.5);
    for (int ray = 0; ray < ball.corners(); ++ray) {
      EXPECT_EQ(ball.distance(ray), 0.5);
      EXPECT_NEAR(ball.corner(ray).norm(), 0.5, kSingle);
    }
  }
}

TEST(SampledPolytope, RaysLookEverywhere) {
  std::mt19937 random(3);
  for (int n = 2; n <= kMaxDimension; ++n) {
    const SampledPolytope ball(n, 1.0);
    double worst = 1;
    for (int trial = 0; trial < 4000; ++trial) {
      const TangentVector u = random_unit(n, random);
      double best = -1;
      for (int ray = 0; ray < ball.corners(); ++ray) best = std::max(best, ball.corner(ray).dot(u));
      worst = std::min(worst, best);
    }
    EXPECT_GT(worst, std::cos(54.8 / 180 * 3.14159)) << n;
  }
}

TEST(SampledPolytope, ReachesAlongEachRayAsFarAsTheNearestCut) {
  std::mt19937 random(4);
  for (int n = 2; n <= kMaxDimension; ++n) {
    const SampledPolytope ball(n, 1.0);
    SampledPolytope polytope = ball;
    std::vector<TangentVector> normals;
    std::vector<double> reach(ball.corners(), 1.0);
    std::vector<int> facet(ball.corners(), -1);
    for (int f = 0; f < 10 * n; ++f) {
      normals.push_back((0.5 + 0.05 * f) * random_unit(n, random));
      const double offset = normals[f].squaredNorm() / 2;
      bool cut = false;
      for (int ray = 0; ray < ball.corners(); ++ray) {
        const double along = normals[f].dot(ball.corner(ray));
        if (along * reach[ray] <= offset) continue;
        reach[ray] = offset / along;
        facet[ray] = f;
        cut = true;
      }
      EXPECT_EQ(polytope.clip(normals[f], offset, f), cut);
    }
    std::set<int> facets;
    for (int ray = 0; ray < ball.corners(); ++ray) {
      EXPECT_NEAR(polytope.distance(ray), reach[ray], kSingle);
      EXPECT_LT((polytope.corner(ray) - reach[ray] * ball.corner(ray)).norm(), kSingle);
      if (facet[ray] >= 0) facets.insert(facet[ray]);
    }
    EXPECT_NEAR(polytope.circumradius(), *std::max_element(reach.begin(), reach.end()), kSingle);
    EXPECT_EQ(polytope.cutting_facets(), std::vector<int>(facets.begin(), facets.end()));
    for (int f = 0; f < 10 * n; ++f) EXPECT_EQ(polytope.has_facet(f), facets.contains(f));
  }
}

TEST(SampledPolytope, IgnoresAHalfSpaceThatHoldsIt) {
  SampledPolytope polytope(4, 1.0);
  EXPECT_FALSE(polytope.clip(TangentVector::Ones(4), 2.0, 0));
  EXPECT_FALSE(polytope.has_facet(0));
}

TEST(SampledPolytope, KeepsMarksOfRaysThatAreCut) {
  SampledPolytope polytope(6, 1.0);
  for (int ray = 0; ray < polytope.corners(); ++ray) {
    EXPECT_FALSE(polytope.is_marked(ray));
    polytope.mark(ray);
  }
  ASSERT_TRUE(polytope.clip(TangentVector::Ones(6), 0.5, 0));
  for (int ray = 0; ray < polytope.corners(); ++ray) EXPECT_TRUE(polytope.is_marked(ray));
}

}  // namespace
}  // namespace taut
