// SPDX-License-Identifier: GPL-3.0-or-later
// Where one may go, and the grid of it, against floods over leaves and boxes looked at one by one.
#include "map/region.h"

#include <gtest/gtest.h>

#include <set>

#include "map/grid.h"
#include "tests/map/problems.h"
#include "tests/map/random_map.h"

namespace taut::testing {
namespace {

using Reach = MapRegion::Reach;

MapSpace space_of(bool has_sigma) {
  return make_map_space(has_sigma ? robot1_sigma_free().space : robot1_slice().space);
}

std::vector<Cell> cells_of(const CellMap& map) {
  std::vector<Cell> cells(map.nodes.size());
  map.for_each_leaf([&](const Cell& cell, std::uint32_t node) { cells[node] = cell; });
  return cells;
}

/// The leaves to which chains of leaves with `may_pass` lead from these.
template <class MayPass>
std::set<std::uint32_t> flood(const MapTopology& topology, const std::vector<Cell>& cells,
                              const std::vector<std::uint32_t>& from, const MayPass& may_pass) {
  std::set<std::uint32_t> reached;
  std::vector<std::uint32_t> open;
  const auto reach = [&](std::uint32_t node) {
    if (may_pass(node) && reached.insert(node).second) open.push_back(node);
  };
  for (const std::uint32_t node : from) reach(node);
  while (!open.empty()) {
    const std::uint32_t node = open.back();
    open.pop_back();
    for (const std::uint32_t other : topology.neighbours(cells[node])) reach(other);
  }
  return reached;
}

MapBox point(Random& random, int halves) {
  MapBox box;
  for (std::size_t k = 0; k < kMaxMapAxes; ++k) {
    box.lower[k] = box.upper[k] = static_cast<double>(random() % static_cast<unsigned>(halves + 1)) / halves;
  }
  return box;
}

TEST(Region, IsAFloodFromThePlace) {
  Random random(5);
  int reachable = 0, cut_off = 0, outside = 0;
  for (int trial = 0; trial < 300; ++trial) {
    const CellMap map = random_map(random, space_of(trial % 3 == 0), 0.55, 0.3);
    const std::vector<Cell> cells = cells_of(map);
    const MapTopology topology(map);
    const std::vector<MapBox> place = {point(random, 32)};
    const MapRegion region(topology, place);
    const auto from = topology.leaves_at(place);
    const auto kind = [&](std::uint32_t node) { return map.nodes[node].kind; };
    const auto is_inside = [&](std::uint32_t node) { return kind(node) == CellKind::kInside; };
    const auto is_possible = [&](std::uint32_t node) { return !is_outside(kind(node)); };
    const auto possible = flood(topology, cells, from, is_possible);
    std::set<std::uint32_t> sure;
    if (std::ranges::all_of(from, is_inside)) sure = flood(topology, cells, {from.front()}, is_inside);
    const bool is_one = std::ranges::all_of(from, [&](std::uint32_t node) { return sure.contains(node); });
    double sure_share = 0, possible_share = 0;
    map.for_each_leaf([&](const Cell& cell, std::uint32_t node) {
      const Reach expected = is_one && sure.contains(node) ? Reach::kReachable
                             : possible.contains(node)     ? Reach::kOpen
                                                           : Reach::kCutOff;
      EXPECT_EQ(region.reach(node), expected);
      if (expected == Reach::kReachable) sure_share += cell.volume();
      if (expected != Reach::kCutOff) possible_share += cell.volume();
      EXPECT_TRUE(!is_outside(kind(node)) || expected == Reach::kCutOff);
    });
    EXPECT_EQ(region.reachable(), sure_share);
    EXPECT_EQ(region.possible(), possible_share);
    EXPECT_EQ(region.starts_outside(), std::ranges::none_of(from, is_possible));
    reachable += sure_share > 0 ? 1 : 0;
    cut_off += possible_share < 0.6 ? 1 : 0;
    outside += region.starts_outside() ? 1 : 0;
  }
  EXPECT_GT(reachable, 50);
  EXPECT_GT(cut_off, 20);
  EXPECT_GT(outside, 20);
}

/// What a value says of a leaf.
bool is_true_of(GridValue value, CellKind kind, Reach reach) {
  switch (value) {
    case GridValue::kInside: return kind == CellKind::kInside;
    case GridValue::kOutside: return is_outside(kind);
    case GridValue::kReachable: return kind == CellKind::kInside && reach == Reach::kReachable;
    case GridValue::kCutOff: return reach == Reach::kCutOff;
    case GridValue::kInsideCutOff: return kind == CellKind::kInside && reach == Reach::kCutOff;
    case GridValue::kOpen: break;
  }
  return true;
}

/// The strongest value that is true of all leaves that a box meets.
GridValue strongest(const std::vector<std::pair<CellKind, Reach>>& parts) {
  for (const GridValue value :
       {GridValue::kReachable, GridValue::kInsideCutOff, GridValue::kInside, GridValue::kOutside, GridValue::kCutOff}) {
    if (std::ranges::all_of(parts, [&](const auto& part) { return is_true_of(value, part.first, part.second); })) {
      return value;
    }
  }
  return GridValue::kOpen;
}

TEST(Grid, SaysOfABoxWhatIsTrueOfAllOfIt) {
  Random random(7);
  std::array<int, 6> times{};
  for (int trial = 0; trial < 60; ++trial) {
    const bool has_sigma = trial % 3 == 0;
    const CellMap map = random_map(random, space_of(has_sigma), 0.6, 0.25);
    const MapTopology topology(map);
    std::optional<MapRegion> region;
    if (trial % 4 != 0) region.emplace(topology, std::vector{point(random, 32)});
    // Finer than cells, coarser, and not in step with them.
    const GridSize size = {1 + static_cast<std::uint32_t>(random() % 21), 1 + static_cast<std::uint32_t>(random() % 21),
                           has_sigma ? 5U : 1U};
    const std::vector<GridValue> values = grid_of(map, region, size);
    ASSERT_EQ(values.size(), size[0] * size[1] * size[2]);
    for (std::uint32_t box = 0; box < values.size(); ++box) {
      const std::array<std::uint32_t, 3> place = {box / size[2] / size[1], box / size[2] % size[1], box % size[2]};
      std::vector<std::pair<CellKind, Reach>> parts;
      map.for_each_leaf([&](const Cell& cell, std::uint32_t node) {
        for (std::size_t k = 0; k < map.space.size(); ++k) {
          const double n = size[k];  // of which products with dyadic ends are exact
          if (cell.lower(k) * n >= place[k] + 1 || cell.upper(k) * n <= place[k]) return;
        }
        parts.emplace_back(map.nodes[node].kind, region                             ? region->reach(node)
                                                 : is_outside(map.nodes[node].kind) ? Reach::kCutOff
                                                                                    : Reach::kOpen);
      });
      EXPECT_EQ(values[box], strongest(parts));
      ++times[static_cast<std::size_t>(values[box])];
    }
  }
  for (const int count : times) EXPECT_GT(count, 20);
}

}  // namespace
}  // namespace taut::testing
