// SPDX-License-Identifier: GPL-3.0-or-later
// The outlines of cells of two coordinates, as polygons with holes whose edges are edges of cells.
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "map/cell.h"

namespace taut {

/// What corners of outlines are counted in: t = corner / 2^30, exactly.
inline constexpr std::uint32_t kOutlineUnits = std::uint32_t{1} << kMaxCellDepth;

/// Corners in order, the first not repeated; each edge is parallel to an axis, and no corner is in the middle of one.
using OutlineRing = std::vector<std::array<std::uint32_t, 2>>;

/// A polygon whose interior hangs together: cells that share edges. Rings have no corner twice; rings of one polygon,
/// and polygons, meet in single corners at most. The cells are on the left of each edge: the outer ring runs
/// anticlockwise, holes run clockwise.
struct OutlinePolygon {
  OutlineRing outer;
  std::vector<OutlineRing> holes;
  std::size_t cell = 0;  ///< the number of one of its cells

  /// The share of the whole space. Exact: a multiple of 2^-60 that fits binary64 wherever sums of cells do.
  [[nodiscard]] double area() const;
};

/// The union of cells of two axes no two of which overlap. Polygons are ordered by their outer rings' lowest corners.
[[nodiscard]] std::vector<OutlinePolygon> outline(const std::vector<Cell>& cells);

}  // namespace taut
