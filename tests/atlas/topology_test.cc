// SPDX-License-Identifier: GPL-3.0-or-later
#include "tests/atlas/topology.h"

#include <gtest/gtest.h>

#include "tests/atlas/surfaces.h"

namespace taut {
namespace {

using testing::coordinates;
using testing::kPi;
using testing::options;

// Reference by another route: area of f = 0 from marching tetrahedra on a grid of [0, 1.2]^3, one of eight octants
// alike.
double octant_area(const testing::ImplicitSurface& surface, int cells) {
  const double h = 1.2 / cells;
  const int corners[8][3] = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {1, 1, 0}, {0, 0, 1}, {1, 0, 1}, {0, 1, 1}, {1, 1, 1}};
  const int tetrahedra[6][4] = {{0, 1, 3, 7}, {0, 3, 2, 7}, {0, 2, 6, 7}, {0, 6, 4, 7}, {0, 4, 5, 7}, {0, 5, 1, 7}};
  double total = 0;
  for (int i = 0; i < cells; ++i) {
    for (int j = 0; j < cells; ++j) {
      for (int k = 0; k < cells; ++k) {
        Eigen::Vector3d x[8];
        double f[8];
        int below = 0;
        for (int c = 0; c < 8; ++c) {
          x[c] = h * Eigen::Vector3d(i + corners[c][0], j + corners[c][1], k + corners[c][2]);
          f[c] = surface.value(x[c]);
          below += f[c] < 0;
        }
        if (below == 0 || below == 8) continue;
        for (const auto& tetrahedron : tetrahedra) {
          std::vector<int> in, out;
          for (const int c : tetrahedron) (f[c] < 0 ? in : out).push_back(c);
          const auto crossing = [&](int a, int b) -> Eigen::Vector3d {
            return x[a] + f[a] / (f[a] - f[b]) * (x[b] - x[a]);
          };
          const auto triangle = [](const Eigen::Vector3d& a, const Eigen::Vector3d& b, const Eigen::Vector3d& c) {
            return (b - a).cross(c - a).norm() / 2;
          };
          if (in.size() == 3) std::swap(in, out);
          if (in.size() == 1) {
            total += triangle(crossing(in[0], out[0]), crossing(in[0], out[1]), crossing(in[0], out[2]));
          } else if (in.size() == 2) {
            const Eigen::Vector3d a = crossing(in[0], out[0]), b = crossing(in[0], out[1]);
            const Eigen::Vector3d c = crossing(in[1], out[1]), d = crossing(in[1], out[0]);
            total += triangle(a, b, c) + triangle(a, c, d);
          }
        }
      }
    }
  }
  return total;
}

TEST(Topology, OfASphere) {
  const auto sphere = testing::unit_sphere();
  Atlas atlas(sphere, options(0.15, 0.05));
  atlas.add(coordinates({0, 0, 1}));
  ASSERT_TRUE(atlas.grow_all());
  EXPECT_EQ(euler_characteristic(atlas), 2);
  EXPECT_NEAR(area(atlas), 4 * kPi, 0.01 * 4 * kPi);
}

TEST(Topology, OfASphereWhateverTheRadius) {
  const auto sphere = testing::unit_sphere();
  for (const double radius : {0.05, 0.11, 0.3, 0.5}) {
    Atlas atlas(sphere, options(radius, 0.5));
    atlas.add(coordinates({0.6, 0.8, 0}));
    ASSERT_TRUE(atlas.grow_all());
    EXPECT_EQ(euler_characteristic(atlas), 2) << radius;
  }
}

TEST(Topology, OfATorus) {
  const auto torus = testing::torus();
  Atlas atlas(torus, options(0.08, 0.02));
  atlas.add(coordinates({1 + testing::kTubeRadius, 0, 0}));
  ASSERT_TRUE(atlas.grow_all());
  EXPECT_EQ(euler_characteristic(atlas), 0);
  const double expected = 4 * kPi * kPi * testing::kTubeRadius;
  EXPECT_NEAR(area(atlas), expected, 0.01 * expected);
}

TEST(Topology, OfATorusWhateverTheRadiusAndEpsilon) {
  const auto torus = testing::torus();
  for (const double epsilon : {0.01, 0.1}) {
    for (const double radius : {0.08, 0.119, 0.159, 0.276, 0.317}) {  // some of them have many near-ties
      Atlas atlas(torus, options(radius, epsilon));
      atlas.add(coordinates({1 + testing::kTubeRadius, 0, 0}));
      ASSERT_TRUE(atlas.grow_all());
      EXPECT_EQ(euler_characteristic(atlas), 0) << radius << ' ' << epsilon;
    }
  }
}

TEST(Topology, OfTheChmutovSurface) {
  const auto chmutov = testing::chmutov();
  Atlas atlas(chmutov, options(0.06, 0.01));
  // On the diagonal: 3 (8 x^4 - 8 x^2 + 1) = 0.
  const double x = std::sqrt((2 + std::sqrt(2.0)) / 4);
  atlas.add(coordinates({x, x, x}));
  ASSERT_TRUE(atlas.grow_all());
  EXPECT_EQ(euler_characteristic(atlas), -8);
  const double coarse = 8 * octant_area(chmutov, 40);
  const double expected = 8 * octant_area(chmutov, 80);
  ASSERT_NEAR(coarse, expected, 0.002 * expected) << "the reference has not converged";
  EXPECT_NEAR(area(atlas), expected, 0.01 * expected);
}

TEST(Topology, OfADiscAndOfAnAnnulus) {
  for (const double hole : {0.0, 0.4}) {
    const testing::FlatSpace plane(
        2, [hole](const Coordinates& x) { return x.norm() <= 1 && (hole == 0 || x.norm() >= hole); });
    Atlas atlas(plane, options(0.1, 0.1));
    atlas.add(coordinates({0.5, 0.3}));
    ASSERT_TRUE(atlas.grow_all());
    EXPECT_EQ(euler_characteristic(atlas), hole > 0 ? 0 : 1);
    const double expected = kPi * (1 - hole * hole);
    EXPECT_GT(area(atlas), 0.97 * expected);
    EXPECT_LT(area(atlas), 1.3 * expected) << "balls reach beyond the boundary by less than a radius";
  }
}

TEST(Topology, OfFlatTorusCylinderAndMoebiusStrip) {
  const testing::FlatTorus torus({0, 0});
  Atlas on_torus(torus, options(0.2, 0.1));
  on_torus.add(coordinates({3, 3}));
  ASSERT_TRUE(on_torus.grow_all());
  EXPECT_EQ(euler_characteristic(on_torus), 0);
  EXPECT_NEAR(area(on_torus), 4 * kPi * kPi, 0.01 * 4 * kPi * kPi);

  const testing::FlatTorus cylinder({0, 0.7});
  Atlas on_cylinder(cylinder, options(0.2, 0.1));
  on_cylinder.add(coordinates({3, 0.1}));
  ASSERT_TRUE(on_cylinder.grow_all());
  EXPECT_EQ(euler_characteristic(on_cylinder), 0);

  const testing::MoebiusStrip strip(0.5);
  Atlas on_strip(strip, options(0.15, 0.1));
  on_strip.add(coordinates({0.2, 0.1}));
  ASSERT_TRUE(on_strip.grow_all());
  EXPECT_EQ(euler_characteristic(on_strip), 0);
  EXPECT_GT(area(on_strip), 0.95 * 2 * kPi);
  EXPECT_LT(area(on_strip), 1.4 * 2 * kPi) << "covered once, not twice";
}

TEST(Topology, OfASphereNamedByTiltAndTorsionAngles) {
  const testing::PolarSphere sphere;
  Atlas atlas(sphere, options(0.15, 0.05));
  atlas.add(coordinates({-2.0, 0}));
  ASSERT_TRUE(atlas.grow_all());
  EXPECT_EQ(euler_characteristic(atlas), 2);
  EXPECT_NEAR(area(atlas), 4 * kPi, 0.01 * 4 * kPi);

  const testing::PolarSphere cap(1.0);
  Atlas on_cap(cap, options(0.1, 0.05));
  on_cap.add(coordinates({0.3, 0.4}));
  ASSERT_TRUE(on_cap.grow_all());
  EXPECT_EQ(euler_characteristic(on_cap), 1);
}

TEST(Topology, RefusesWhatIsNoSurface) {
  const testing::FlatTorus circle({0});
  Atlas atlas(circle, options(0.2, 0.1));
  EXPECT_THROW(static_cast<void>(area(atlas)), std::invalid_argument);
  EXPECT_THROW(static_cast<void>(euler_characteristic(atlas)), std::invalid_argument);
}

}  // namespace
}  // namespace taut
