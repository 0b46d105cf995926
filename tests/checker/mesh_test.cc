// SPDX-License-Identifier: GPL-3.0-or-later
// Meshes in the checker's kernel: the bound of (2) in mesh_clearance.h against all elements one by one, in 200 bits,
// and sides of closed meshes.
#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <random>

#include "certify/arithmetic/mp_interval.h"
#include "checker/kernel/mesh_clearance.h"
#include "checker/kernel/mesh_inside.h"
#include "tests/checker/kernel.h"
#include "tests/support/meshes.h"

namespace taut::checker {
namespace {

using taut::testing::box_mesh;
using taut::testing::joined_meshes;
using taut::testing::one_sided_mesh;
using taut::testing::sphere_mesh;
using taut::testing::twice_wound_mesh;

std::shared_ptr<const Surface> surface_of(const TriangleMesh& mesh) {
  return std::make_shared<const Surface>(mesh.vertices, mesh.triangles, mesh.needles);
}

Matrix3<Ball> identity() {
  Matrix3<Ball> R;
  for (std::size_t c = 0; c < 3; ++c) R[c][c] = Ball(1);
  return R;
}

using Vec = std::array<double, 3>;
constexpr int kOracleBits = 200;

Vec random_vector(std::mt19937_64& random, double size) {
  std::uniform_real_distribution<double> coordinate(-size, size);
  return {coordinate(random), coordinate(random), coordinate(random)};
}

/// Triangles in no order, and a few needles.
TriangleMesh soup(std::mt19937_64& random) {
  TriangleMesh mesh;
  const std::uint32_t count = 1 + static_cast<std::uint32_t>(random() % 60);
  for (std::uint32_t t = 0; t < count; ++t) {
    const Vec centre = random_vector(random, 2);
    for (int corner = 0; corner < 3; ++corner) {
      const Vec off = random_vector(random, 0.3);
      mesh.vertices.push_back({centre[0] + off[0], centre[1] + off[1], centre[2] + off[2]});
    }
    if (t > 0 && random() % 8 == 0) {
      mesh.needles.push_back({3 * t, 3 * t + 1});
    } else {
      mesh.triangles.push_back({3 * t, 3 * t + 1, 3 * t + 2});
    }
  }
  return mesh;
}

using Corners = std::vector<Vec>;

/// min over x of u.x, or max, in 200 bits.
BigFloat extreme(const Corners& points, const std::array<int, 3>& u, bool is_least) {
  BigFloat result;
  for (std::size_t k = 0; k < points.size(); ++k) {
    BigFloat value(0.0);
    for (std::size_t c = 0; c < 3; ++c) value = value + BigFloat(points[k][c]) * BigFloat(static_cast<double>(u[c]));
    if (k == 0 || (is_least ? value < result : result < value)) result = value;
  }
  return result;
}

std::vector<Corners> elements_of(const TriangleMesh& mesh) {
  std::vector<Corners> result;
  for (const auto& [a, b, c] : mesh.triangles) {
    result.push_back({mesh.vertices[a], mesh.vertices[b], mesh.vertices[c]});
  }
  for (const auto& [a, b] : mesh.needles) result.push_back({mesh.vertices[a], mesh.vertices[b]});
  return result;
}

/// The right side of (2), element by element.
double expected(const std::vector<Corners>& first, const std::vector<Corners>& second,
                const std::vector<std::array<int, 3>>& along) {
  const PrecisionScope precision(kOracleBits);
  double least = std::numeric_limits<double>::infinity();
  for (const Corners& a : first) {
    for (const Corners& b : second) {
      double best = -std::numeric_limits<double>::infinity();
      for (const auto& u : along) {
        const double size = std::sqrt(static_cast<double>(u[0] * u[0] + u[1] * u[1] + u[2] * u[2]));
        const BigFloat apart = extreme(a, u, true) - extreme(b, u, false);
        best = std::max(best, apart.to_double() / size);
      }
      least = std::min(least, best);
    }
  }
  return least;
}

SideAlong mesh_along(const PlacedSurface& mesh, const std::array<int, 3>& u) {
  const Ball size = sqrt(Ball(u[0] * u[0] + u[1] * u[1] + u[2] * u[2]));
  return along(mesh, MeanValueForm(),
               {MeanValueForm(Ball(u[0]) / size), MeanValueForm(Ball(u[1]) / size), MeanValueForm(Ball(u[2]) / size)});
}

TEST(MeshClearance, IsTheLeastOfAllElements) {
  const WorkingPrecision precision(64);
  std::mt19937_64 random(1);
  int positive = 0;
  for (int trial = 0; trial < 200; ++trial) {
    const TriangleMesh a = soup(random), b = soup(random);
    const PlacedSurface first{surface_of(a), Ball(1), {}, identity()};
    PlacedSurface second{surface_of(b), Ball(1), {}, identity()};
    // Far away, near by, or among each other.
    const int away = trial % 3 == 0 ? 6 : trial % 3 == 1 ? 4 : 0;
    second.at[0] = Ball(away);
    std::vector<Corners> elements_b = elements_of(b);
    for (Corners& corners : elements_b) {
      for (Vec& x : corners) x[0] += away;
    }
    const bool is_hull = random() % 2 == 0;  // then the first body is one element
    const std::vector<Corners> elements_a = is_hull ? std::vector<Corners>{elements_of(a).front()} : elements_of(a);
    std::vector<std::array<int, 3>> directions = {{-1, 0, 0}};
    for (unsigned n = 0; n < random() % 12; ++n) {
      const auto component = [&] { return static_cast<int>(random() % 255) - 127; };
      directions.push_back({component(), component(), 1 + static_cast<int>(random() % 100)});
    }
    std::vector<BothAlong> both;
    for (const auto& u : directions) {
      BothAlong& of_u = both.emplace_back();
      of_u[1] = mesh_along(second, u);
      if (is_hull) {
        const double size = std::sqrt(static_cast<double>(u[0] * u[0] + u[1] * u[1] + u[2] * u[2]));
        of_u[0].extreme = lowest(Ball(extreme(elements_a[0], u, true).to_double()) / Ball(size) - Ball(1e-12));
      } else {
        of_u[0] = mesh_along(first, u);
      }
    }
    const double truth = expected(elements_a, elements_b, directions);
    const Ball found = mesh_margin(is_hull ? nullptr : &first, &second, both, {}, Ball(), std::nullopt);
    EXPECT_LE(approx(found), truth + 1e-11) << trial;
    if (truth > 0.01) {
      ++positive;
      EXPECT_GE(approx(found), 0.98 * truth - 1e-11) << trial;
      // No more than is asked for, but that surely.
      const Ball asked = Ball(0.5 * truth);
      EXPECT_TRUE(
          certainly_nonnegative(mesh_margin(is_hull ? nullptr : &first, &second, both, {}, Ball(), asked) - asked));
    } else {
      EXPECT_LE(approx(found), std::max(truth, 0.0) + 1e-11) << trial;
    }
    // What is needed is taken off.
    EXPECT_LE(approx(mesh_margin(is_hull ? nullptr : &first, &second, both, {}, Ball(10), std::nullopt)), truth - 9.9);
  }
  EXPECT_GT(positive, 50);
}

TEST(MeshClearance, CountsHowFarDeviationsMoveThePlatformsPoints) {
  const WorkingPrecision precision(64);
  // A cube of half side 1 at x = 10, seen along -x from a point at 20: 9, less what may move its points.
  const PlacedSurface cube{surface_of(box_mesh({1, 1, 1})), Ball(1), {Ball(10), Ball(), Ball()}, identity()};
  BothAlong along;
  along[0] = mesh_along(cube, {-1, 0, 0});
  along[1].extreme = Ball(-20);
  const auto margin = [&](const Ball& position, const Ball& turn) {
    return approx(mesh_margin(&cube, nullptr, std::span(&along, 1), {position, turn}, Ball(), std::nullopt));
  };
  EXPECT_NEAR(margin(Ball(), Ball()), 9, 1e-7);
  EXPECT_NEAR(margin(Ball(mpq_class(1, 4)), Ball()), 8.75, 1e-7);
  EXPECT_NEAR(margin(Ball(), Ball(mpq_class(1, 100))), 9 - 0.01 * std::sqrt(11 * 11 + 2), 1e-7);
}

Side side(const std::shared_ptr<const Surface>& surface, const Vec& x) {
  return side_of(*surface, {Ball(x[0]), Ball(x[1]), Ball(x[2])});
}

TEST(MeshInside, IsWhatASphereAndABoxContain) {
  const WorkingPrecision precision(64);
  std::mt19937_64 random(2);
  const auto sphere = surface_of(sphere_mesh(1, 4));
  const auto box = surface_of(box_mesh({0.5, 0.7, 0.9}));
  ASSERT_TRUE(sphere->is_closed());
  ASSERT_TRUE(box->is_closed());
  int inside = 0;
  for (int trial = 0; trial < 2000; ++trial) {
    const Vec x = random_vector(random, 1.2);
    const double radius = std::hypot(x[0], x[1], x[2]);
    if (radius < 0.99 || radius > 1.001) {
      EXPECT_EQ(side(sphere, x), radius < 1 ? Side::kInside : Side::kOutside) << trial;
    }
    const bool in_box = std::abs(x[0]) < 0.5 && std::abs(x[1]) < 0.7 && std::abs(x[2]) < 0.9;
    EXPECT_EQ(side(box, x), in_box ? Side::kInside : Side::kOutside) << trial;
    inside += in_box ? 1 : 0;
  }
  EXPECT_GT(inside, 200);
  // The surface is neither; nor is a ball of points around it.
  EXPECT_EQ(side(box, {0.5, 0, 0}), Side::kUnknown);
  EXPECT_EQ(side_of(*box, {plus_minus(Ball(mpq_class(1, 2)), Ball(mpq_class(1, 10))), Ball(), Ball()}), Side::kUnknown);
  EXPECT_EQ(side(box, {0, 0, 0}), Side::kInside);
}

TEST(MeshInside, IsWhereverSomePartIs) {
  const WorkingPrecision precision(64);
  const auto apart = surface_of(joined_meshes(box_mesh({1, 1, 1}), box_mesh({1, 1, 1}), {1, 0.1, 0.2}));
  ASSERT_TRUE(apart->is_closed());
  EXPECT_EQ(side(apart, {0.5, 0.1, 0.1}), Side::kInside);  // of both
  EXPECT_EQ(side(apart, {-0.5, 0.1, 0.1}), Side::kInside);
  EXPECT_EQ(side(apart, {1.5, 0.1, 0.1}), Side::kInside);
  EXPECT_EQ(side(apart, {1.5, -0.95, 0.1}), Side::kOutside);
  const auto nested = surface_of(joined_meshes(sphere_mesh(2, 3), sphere_mesh(1, 3), {0, 0, 0}));
  ASSERT_TRUE(nested->is_closed());
  EXPECT_EQ(nested->parts().size(), 2U);
  EXPECT_EQ(side(nested, {0.1, 0.2, 0.3}), Side::kInside);
  EXPECT_EQ(side(nested, {1.5, 0.1, 0}), Side::kInside);
  EXPECT_EQ(side(nested, {2.5, 0, 0}), Side::kOutside);
}

TEST(MeshInside, IsWhereAPartWindsTwice) {
  const WorkingPrecision precision(64);
  TriangleMesh wheel = twice_wound_mesh();
  for (int reversed = 0; reversed < 2; ++reversed) {
    const auto surface = surface_of(wheel);
    ASSERT_TRUE(surface->is_closed());
    EXPECT_EQ(side(surface, {0.3, 0.2, 0.1}), Side::kInside);
    EXPECT_EQ(side(surface, {-0.2, 0.1, -0.7}), Side::kInside);
    EXPECT_EQ(side(surface, {2.5, 0.1, 0.1}), Side::kOutside);
    EXPECT_EQ(side(surface, {0.1, 0.1, 1.5}), Side::kOutside);
    // Which way round each triangle is listed does not matter.
    for (std::size_t t = 0; t < wheel.triangles.size(); t += 3) std::swap(wheel.triangles[t][0], wheel.triangles[t][1]);
  }
}

TEST(Surface, IsClosedIfEachEdgeHasTwoTriangles) {
  EXPECT_TRUE(surface_of(box_mesh({1, 1, 1}))->is_closed());
  TriangleMesh open = box_mesh({1, 1, 1});
  open.triangles.pop_back();
  EXPECT_FALSE(surface_of(open)->is_closed());
  TriangleMesh fin = box_mesh({1, 1, 1});  // three triangles on one edge
  fin.vertices.push_back({3, 3, 3});
  fin.triangles.push_back({fin.triangles[0][0], fin.triangles[0][1], 8});
  EXPECT_FALSE(surface_of(fin)->is_closed());
  EXPECT_FALSE(surface_of(one_sided_mesh())->is_closed());
}

TEST(Surface, RefusesWhatIsNoMesh) {
  EXPECT_THROW((void)Surface({{0, 0, 0}}, {}, {}), Undefined);
  EXPECT_THROW((void)Surface({{0, 0, 0}, {1, 0, 0}}, {{0, 1, 2}}, {}), Undefined);
  EXPECT_THROW((void)Surface({{0, 0, 0}, {1, 0, 0}, {0, std::nan(""), 0}}, {{0, 1, 2}}, {}), Undefined);
}

}  // namespace
}  // namespace taut::checker
