// SPDX-License-Identifier: GPL-3.0-or-later
#include "map/singular.h"

#include <gtest/gtest.h>

#include <set>

#include "tests/map/problems.h"

namespace taut::testing {
namespace {

/// Wherever the determinant changes its sign between two points of a raster, a cell that encloses det J = 0 touches the
/// way between them.
TEST(SingularCells, EncloseEveryChangeOfSign) {
  const Problem problem = robot1_slice();
  const MapSpace space = make_map_space(problem.space);
  const CellMap map = subdivide(problem, space, {.undecided_share = 0.1});
  constexpr int kDepth = 7, kSide = 1 << kDepth;
  const std::vector<Cell> cells = singular_cells(problem, map, 1.0 / kSide);
  std::set<std::array<std::uint32_t, 2>> singular;
  for (const Cell& cell : cells) {
    // Leaves of the map may be smaller than that along an axis.
    ASSERT_GE(cell.depth[0], kDepth);
    ASSERT_GE(cell.depth[1], kDepth);
    singular.insert({cell.k[0] >> (cell.depth[0] - kDepth), cell.k[1] >> (cell.depth[1] - kDepth)});
  }
  EXPECT_LT(singular.size(), kSide * kSide / 7);

  const campaign::Machine<double> machine = campaign::make_machine<double>(problem);
  const auto is_positive = [&](int column, int row) {  // in the middles of cells
    constexpr double kPi = 3.14159265358979323846;
    const double phi = (2 * (column + 0.5) / kSide - 1) * kPi, theta = (row + 0.5) / kSide * kPi;
    const campaign::RigidPose<double> pose{{0, 0, 0.35}, campaign::orientation(phi, theta, 34 * kPi / 180)};
    return campaign::statics(machine, pose).determinant > 0;
  };
  int changes = 0;
  const auto expect_between = [&](std::array<std::uint32_t, 2> a, std::array<std::uint32_t, 2> b) {
    ++changes;
    EXPECT_TRUE(singular.contains(a) || singular.contains(b)) << a[0] << ", " << a[1];
  };
  for (std::uint32_t column = 0; column + 1 < kSide; ++column) {
    for (std::uint32_t row = 0; row + 1 < kSide; ++row) {
      const auto x = static_cast<int>(column), y = static_cast<int>(row);
      if (is_positive(x, y) != is_positive(x + 1, y)) expect_between({column, row}, {column + 1, row});
      if (is_positive(x, y) != is_positive(x, y + 1)) expect_between({column, row}, {column, row + 1});
    }
  }
  EXPECT_GT(changes, 200);
}

/// The enclosure is as thin as cells are, also near theta = pi, where several rows of D depend on each other: halving
/// the width doubles the number of cells, where a band would make it four times as many.
TEST(SingularCells, AreALineAndNoBand) {
  const Problem problem = robot1_slice();
  const CellMap map = subdivide(problem, make_map_space(problem.space), {.undecided_share = 0.1});
  const auto count = [&](double width) { return static_cast<double>(singular_cells(problem, map, width).size()); };
  const double coarse = count(1.0 / 256), fine = count(1.0 / 512);
  EXPECT_LT(fine, 2.5 * coarse);
  EXPECT_LT(fine, 20 * 512);
}

/// Of three coordinates, too: determinants on both sides of every gap between cells of the enclosure have one sign.
TEST(SingularCells, OfThreeCoordinatesEncloseEveryChangeOfSign) {
  const Problem problem = robot1_sigma_free();
  const MapSpace space = make_map_space(problem.space);
  const CellMap map = subdivide(problem, space, {.least_width = 0.05, .undecided_share = 0});
  constexpr int kDepth = 6, kSide = 1 << kDepth;
  std::set<std::array<std::uint32_t, 3>> singular;
  for (const Cell& cell : singular_cells(problem, map, 1.0 / kSide)) {
    std::array<std::uint32_t, 3> place{};
    for (std::size_t k = 0; k < 3; ++k) place.at(k) = cell.k[k] >> (cell.depth[k] - kDepth);
    singular.insert(place);
  }
  EXPECT_LT(singular.size(), 2 * kSide * kSide * kSide / 3);
  const campaign::Machine<double> machine = campaign::make_machine<double>(problem);
  const auto is_positive = [&](const std::array<std::uint32_t, 3>& place) {
    constexpr double kPi = 3.14159265358979323846;
    const auto t = [&](std::size_t k) { return (place.at(k) + 0.5) / kSide; };
    const campaign::RigidPose<double> pose{
        {0, 0, 0.35}, campaign::orientation((2 * t(0) - 1) * kPi, t(1) * kPi, (2 * t(2) - 1) * kPi)};
    return campaign::statics(machine, pose).determinant > 0;
  };
  int changes = 0;
  for (std::uint32_t n = 0; n < kSide * kSide * kSide; ++n) {
    const std::array<std::uint32_t, 3> here = {n / kSide / kSide, n / kSide % kSide, n % kSide};
    for (std::size_t k = 0; k < 3; ++k) {
      std::array<std::uint32_t, 3> next = here;
      if (++next.at(k) == kSide || is_positive(here) == is_positive(next)) continue;
      ++changes;
      EXPECT_TRUE(singular.contains(here) || singular.contains(next)) << here[0] << ", " << here[1] << ", " << here[2];
    }
  }
  EXPECT_GT(changes, 200);
}

}  // namespace
}  // namespace taut::testing
