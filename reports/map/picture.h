// SPDX-License-Identifier: GPL-3.0-or-later
// A map of two coordinates as a picture, in the manner of the paper's Figs. 7 and 8.
#pragma once

#include <array>
#include <string>
#include <vector>

#include "map/subdivision.h"
#include "reports/map/map_result.h"
#include "reports/page/map_frame.h"

namespace taut {

/// A line of places t in the space.
using MapLine = std::vector<std::array<double, 2>>;

/// What is drawn on top of a map.
struct MapOverlay {
  std::vector<Cell> singular;   ///< cells that enclose det J = 0
  std::vector<Cell> both;       ///< where a length and the tensions are beyond limits
  std::vector<MapLine> path;    ///< lines in t
  std::vector<MapLine> charts;  ///< of an atlas, likewise
  std::vector<MapMark> marks;
};

/// Cells are drawn exactly, in one colour and hatching for each thing that is proved of them, and outlined along their
/// edges. Cells finer than a tenth of a pixel are drawn with what is around them, as undecided. @pre the map has two
/// axes
[[nodiscard]] std::string map_svg(const MapResult& result, const MapOverlay& overlay);
/// Its width and height [px].
[[nodiscard]] std::array<int, 2> map_picture_size(const MapResult& result);

}  // namespace taut
