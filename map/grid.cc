// SPDX-License-Identifier: GPL-3.0-or-later
#include "map/grid.h"

namespace taut {
namespace {

/// The kinds of parts that a box has.
enum Part : std::uint8_t {
  kInsideReachable = 1,
  kInsideOpen = 2,
  kInsideBeyond = 4,  ///< cut off
  kOutsidePart = 8,
  kUndecidedOpen = 16,
  kUndecidedBeyond = 32,
};

Part part_of(CellKind kind, const std::optional<MapRegion>& region, std::uint32_t node) {
  using Reach = MapRegion::Reach;
  if (is_outside(kind)) return kOutsidePart;
  const Reach reach = region ? region->reach(node) : Reach::kOpen;
  if (kind == CellKind::kUndecided) return reach == Reach::kCutOff ? kUndecidedBeyond : kUndecidedOpen;
  switch (reach) {
    case Reach::kReachable: return kInsideReachable;
    case Reach::kCutOff: return kInsideBeyond;
    case Reach::kOpen: break;
  }
  return kInsideOpen;
}

GridValue value_of(unsigned parts) {
  const auto has_only = [&](unsigned allowed) { return (parts & ~allowed) == 0; };
  if (has_only(kInsideReachable)) return GridValue::kReachable;
  if (has_only(kInsideBeyond)) return GridValue::kInsideCutOff;
  if (has_only(kInsideReachable | kInsideOpen | kInsideBeyond)) return GridValue::kInside;
  if (has_only(kOutsidePart)) return GridValue::kOutside;
  if (has_only(kOutsidePart | kInsideBeyond | kUndecidedBeyond)) return GridValue::kCutOff;
  return GridValue::kOpen;
}

/// The boxes along an axis whose interiors meet that of a cell: [first, end).
struct Range {
  std::uint64_t first = 0, end = 1;
};

Range range_of(const Cell& cell, std::size_t axis, std::uint32_t size) {
  const std::uint64_t lower = std::uint64_t{cell.k[axis]} * size, upper = lower + size;
  const std::uint64_t unit = std::uint64_t{1} << cell.depth[axis];
  return {lower / unit, (upper + unit - 1) / unit};
}

}  // namespace

std::vector<GridValue> grid_of(const CellMap& map, const std::optional<MapRegion>& region, const GridSize& size) {
  std::vector<GridValue> values(std::size_t{size[0]} * size[1] * size[2]);
  // Until all is gathered, each has the parts of its box.
  map.for_each_leaf([&](const Cell& cell, std::uint32_t node) {
    const Part part = part_of(map.nodes[node].kind, region, node);
    const std::array<Range, kMaxMapAxes> range = {range_of(cell, 0, size[0]), range_of(cell, 1, size[1]),
                                                  range_of(cell, 2, size[2])};
    for (std::uint64_t i = range[0].first; i < range[0].end; ++i) {
      for (std::uint64_t j = range[1].first; j < range[1].end; ++j) {
        for (std::uint64_t l = range[2].first; l < range[2].end; ++l) {
          GridValue& value = values[(i * size[1] + j) * size[2] + l];
          value = static_cast<GridValue>(static_cast<unsigned>(value) | part);
        }
      }
    }
  });
  for (GridValue& value : values) value = value_of(static_cast<unsigned>(value));
  return values;
}

}  // namespace taut
