// SPDX-License-Identifier: GPL-3.0-or-later
// Outlines against a brute force: squares of a fine grid that are in cells, and in polygons by counting edges.
#include "map/outline.h"

#include <gtest/gtest.h>

#include <set>

#include "tests/map/problems.h"
#include "tests/map/random_map.h"

namespace taut::testing {
namespace {

constexpr int kSide = 1 << kDepth;  ///< squares along an axis
using Squares = std::set<std::pair<int, int>>;

/// The squares within a ring: those with an odd number of vertical edges on their left.
Squares within(const OutlineRing& ring) {
  Squares result;
  const double unit = static_cast<double>(kOutlineUnits) / kSide;
  for (int x = 0; x < kSide; ++x) {
    for (int y = 0; y < kSide; ++y) {
      int crossed = 0;
      for (std::size_t n = 0; n < ring.size(); ++n) {
        const auto& a = ring[n];
        const auto& b = ring[(n + 1) % ring.size()];
        if (a[0] != b[0] || a[0] > (x + 0.5) * unit) continue;
        crossed += std::min(a[1], b[1]) < (y + 0.5) * unit && (y + 0.5) * unit < std::max(a[1], b[1]) ? 1 : 0;
      }
      if (crossed % 2 == 1) result.insert({x, y});
    }
  }
  return result;
}

Squares within(const Cell& cell) {
  Squares result;
  for (int x = 0; x < kSide; ++x) {
    for (int y = 0; y < kSide; ++y) {
      const double u = (x + 0.5) / kSide, v = (y + 0.5) / kSide;
      if (cell.lower(0) < u && u < cell.upper(0) && cell.lower(1) < v && v < cell.upper(1)) result.insert({x, y});
    }
  }
  return result;
}

Squares within(const OutlinePolygon& polygon) {
  Squares result = within(polygon.outer);
  for (const OutlineRing& hole : polygon.holes) {
    for (const auto& square : within(hole)) EXPECT_EQ(result.erase(square), 1);
  }
  return result;
}

/// How many parts squares make that share sides.
int parts(Squares squares) {
  int count = 0;
  for (; !squares.empty(); ++count) {
    std::vector<std::pair<int, int>> open = {*squares.begin()};
    squares.erase(squares.begin());
    while (!open.empty()) {
      const auto [x, y] = open.back();
      open.pop_back();
      for (const auto& next : {std::pair(x + 1, y), {x - 1, y}, {x, y + 1}, {x, y - 1}}) {
        if (squares.erase(next) == 1) open.push_back(next);
      }
    }
  }
  return count;
}

void expect_simple(const OutlineRing& ring) {
  EXPECT_GE(ring.size(), 4);
  EXPECT_EQ(std::set(ring.begin(), ring.end()).size(), ring.size()) << "a corner twice";
  for (std::size_t n = 0; n < ring.size(); ++n) {
    const auto& a = ring[n];
    const auto& b = ring[(n + 1) % ring.size()];
    const auto& c = ring[(n + 2) % ring.size()];
    const bool is_vertical = a[0] == b[0], next_is_vertical = b[0] == c[0];
    EXPECT_NE(is_vertical, a[1] == b[1]);
    EXPECT_NE(is_vertical, next_is_vertical) << "a corner in the middle of an edge";
  }
}

TEST(Outline, IsTheUnionOfItsCells) {
  Random random(22);
  const MapSpace space = make_map_space(robot1_slice().space);
  int holes = 0, touching = 0;
  for (int trial = 0; trial < 1500; ++trial) {
    const CellMap map = random_map(random, space, 0.2 + 0.6 * static_cast<double>(trial) / 1500, 0.1);
    std::vector<Cell> cells;
    Squares expected;
    double area = 0;
    map.for_each_leaf([&](const Cell& cell, std::uint32_t node) {
      if (map.nodes[node].kind != CellKind::kInside) return;
      cells.push_back(cell);
      expected.merge(within(cell));
      area += cell.volume();
    });
    const std::vector<OutlinePolygon> polygons = outline(cells);
    EXPECT_EQ(polygons.size(), parts(expected));
    Squares found;
    double found_area = 0;
    for (const OutlinePolygon& polygon : polygons) {
      expect_simple(polygon.outer);
      for (const OutlineRing& hole : polygon.holes) expect_simple(hole);
      Squares squares = within(polygon);
      EXPECT_EQ(parts(squares), 1);
      EXPECT_TRUE(squares.contains(*within(cells[polygon.cell]).begin()));
      EXPECT_EQ(polygon.area(), static_cast<double>(squares.size()) / (kSide * kSide));
      found_area += polygon.area();
      holes += static_cast<int>(polygon.holes.size());
      found.merge(squares);
      EXPECT_TRUE(squares.empty()) << "polygons overlap";
    }
    EXPECT_EQ(found, expected);
    EXPECT_EQ(found_area, area);
    touching += polygons.size() > 1 ? 1 : 0;
  }
  EXPECT_GT(holes, 100);
  EXPECT_GT(touching, 100);
}

Cell cell(std::uint32_t x, std::uint32_t y, std::uint8_t depth) { return {{x, y}, {depth, depth}}; }

TEST(Outline, OfEverythingIsOneRing) {
  const std::vector<OutlinePolygon> polygons = outline({Cell()});
  ASSERT_EQ(polygons.size(), 1);
  constexpr std::uint32_t kEnd = kOutlineUnits;
  EXPECT_EQ(polygons[0].outer, (OutlineRing{{0, 0}, {kEnd, 0}, {kEnd, kEnd}, {0, kEnd}}));
  EXPECT_TRUE(polygons[0].holes.empty());
  EXPECT_EQ(polygons[0].area(), 1);
  EXPECT_TRUE(outline({}).empty());
}

TEST(Outline, OfCellsThatMeetInACornerIsTwoPolygons) {
  const std::vector<OutlinePolygon> polygons = outline({cell(1, 1, 1), cell(0, 0, 1)});
  ASSERT_EQ(polygons.size(), 2);
  constexpr std::uint32_t kHalf = kOutlineUnits / 2;
  EXPECT_EQ(polygons[0].outer, (OutlineRing{{0, 0}, {kHalf, 0}, {kHalf, kHalf}, {0, kHalf}}));
  EXPECT_EQ(polygons[0].cell, 1);
}

TEST(Outline, HasTheFinestCells) {
  const Cell corner = cell(kOutlineUnits - 1, 0, kMaxCellDepth);
  const std::vector<OutlinePolygon> polygons = outline({corner});
  ASSERT_EQ(polygons.size(), 1);
  EXPECT_EQ(polygons[0].outer[1], (std::array{kOutlineUnits, 0U}));
  EXPECT_EQ(polygons[0].area(), corner.volume());
}

}  // namespace
}  // namespace taut::testing
