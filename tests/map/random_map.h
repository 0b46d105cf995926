// SPDX-License-Identifier: GPL-3.0-or-later
// Cells, points of cells, and maps of which nothing is proved.
#pragma once

#include <functional>
#include <random>
#include <utility>
#include <variant>
#include <vector>

#include "map/subdivision.h"

namespace taut::testing {

using Random = std::mt19937_64;

/// A point of a cell, as shares of the ranges: a corner, on an edge, or anywhere.
inline std::vector<double> random_point(Random& random, const Cell& cell, std::size_t axes) {
  std::vector<double> t;
  for (std::size_t k = 0; k < axes; ++k) {
    const double share = std::uniform_real_distribution<double>(0, 1)(random);
    const double inner = cell.lower(k) + share * (cell.upper(k) - cell.lower(k));
    t.push_back(random() % 3 == 0 ? (random() % 2 == 0 ? cell.lower(k) : cell.upper(k)) : inner);
  }
  return t;
}

/// A tree of halvings. `judge` says of a cell either its kind or the axis along which to halve it.
inline CellMap tree_of(const MapSpace& space,
                       const std::function<std::variant<CellKind, std::size_t>(const Cell&)>& judge) {
  CellMap map;
  map.space = space;
  map.nodes.emplace_back();
  std::vector<std::pair<Cell, std::uint32_t>> open = {{Cell(), 0}};
  while (!open.empty()) {
    const auto [cell, node] = open.back();
    open.pop_back();
    const auto answer = judge(cell);
    if (const auto* const kind = std::get_if<CellKind>(&answer)) {
      map.nodes[node].kind = *kind;
      continue;
    }
    const std::size_t axis = std::get<std::size_t>(answer);
    map.nodes[node].axis = static_cast<std::uint8_t>(axis);
    map.nodes[node].child = static_cast<std::uint32_t>(map.nodes.size());
    for (unsigned side = 0; side < 2; ++side) {
      open.emplace_back(cell.half(axis, side), static_cast<std::uint32_t>(map.nodes.size()));
      map.nodes.emplace_back();
    }
  }
  return map;
}

/// A random tree of at most kDepth halvings of each axis, with random verdicts.
inline constexpr int kDepth = 3;
inline CellMap random_map(Random& random, const MapSpace& space, double inside, double outside) {
  return tree_of(space, [&](const Cell& cell) -> std::variant<CellKind, std::size_t> {
    const std::size_t axis = random() % space.size();
    if (cell.depth[axis] != kDepth && random() % 5 != 0) return axis;
    const double draw = std::uniform_real_distribution<double>(0, 1)(random);
    if (draw < inside) return CellKind::kInside;
    return draw < inside + outside ? CellKind::kTension : CellKind::kUndecided;
  });
}

}  // namespace taut::testing
