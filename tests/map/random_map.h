// SPDX-License-Identifier: GPL-3.0-or-later
// Maps of which nothing is proved: random trees.
#pragma once

#include <random>
#include <utility>
#include <vector>

#include "map/subdivision.h"

namespace taut::testing {

using Random = std::mt19937_64;

/// A random tree of at most kDepth halvings of each axis, with random verdicts.
inline constexpr int kDepth = 3;
inline CellMap random_map(Random& random, const MapSpace& space, double inside, double outside) {
  CellMap map;
  map.space = space;
  map.nodes.emplace_back();
  std::vector<std::pair<Cell, std::uint32_t>> open = {{Cell(), 0}};
  while (!open.empty()) {
    const auto [cell, node] = open.back();
    open.pop_back();
    const std::size_t axis = random() % space.size();
    if (cell.depth[axis] == kDepth || random() % 5 == 0) {
      const double draw = std::uniform_real_distribution<double>(0, 1)(random);
      map.nodes[node].kind = draw < inside             ? CellKind::kInside
                             : draw < inside + outside ? CellKind::kTension
                                                       : CellKind::kUndecided;
      continue;
    }
    map.nodes[node].axis = static_cast<std::uint8_t>(axis);
    map.nodes[node].child = static_cast<std::uint32_t>(map.nodes.size());
    for (unsigned side = 0; side < 2; ++side) {
      open.emplace_back(cell.half(axis, side), static_cast<std::uint32_t>(map.nodes.size()));
      map.nodes.emplace_back();
    }
  }
  return map;
}

}  // namespace taut::testing
