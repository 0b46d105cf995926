// SPDX-License-Identifier: GPL-3.0-or-later
// A map on a regular grid, for programs that want one: what is proved of every pose of each of its boxes.
#pragma once

#include <array>
#include <optional>
#include <vector>

#include "map/region.h"

namespace taut {

/// What is proved of all poses of a closed box; the numbers are those of files and stay. The start is where one goes
/// from.
enum class GridValue : std::uint8_t {
  kOpen = 0,          ///< nothing
  kInside = 1,        ///< feasible; whether they are reached from the start is open, or there is no start
  kOutside = 2,       ///< infeasible
  kReachable = 3,     ///< feasible, and motions from the start reach them, every pose of which is feasible
  kCutOff = 4,        ///< no such motion reaches one of them; some may be feasible
  kInsideCutOff = 5,  ///< feasible, and no such motion reaches one of them
};

/// Boxes per axis; 1 along axes that the space does not have.
using GridSize = std::array<std::uint32_t, kMaxMapAxes>;
inline constexpr std::uint32_t kMaxGridSize = std::uint32_t{1} << 20;

/// Box (i, j, l) is the product of [i/n, (i+1)/n] and so on in t; its value is at (i · size[1] + j) · size[2] + l. A
/// box that has parts of several kinds is of the kind that is true of all of them.
/// @pre 1 <= size[k] <= kMaxGridSize
[[nodiscard]] std::vector<GridValue> grid_of(const CellMap& map, const std::optional<MapRegion>& region,
                                             const GridSize& size);

}  // namespace taut
