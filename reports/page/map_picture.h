// SPDX-License-Identifier: GPL-3.0-or-later
// A map of two coordinates as an SVG picture.
#pragma once

#include <array>
#include <string>
#include <vector>

#include "map/subdivision.h"

namespace taut {

struct MapPicture {
  /// An axis as people read it: a title with its unit, and the values of its ends in that unit.
  struct Axis {
    std::string title;
    double lower = 0, upper = 1;
  };
  /// A pose, with its place t.
  struct Mark {
    std::string name;
    std::array<double, 2> t;
  };
  std::string title;
  std::array<Axis, 2> axes;
  std::vector<Cell> singular;  ///< cells that enclose det J = 0
  std::vector<Mark> marks;
};

/// Cells are drawn exactly, in one colour and hatching for each thing that is proved of them; equal halves are drawn as
/// one. Parts finer than a tenth of a pixel are drawn as undecided. @pre the map has two axes
[[nodiscard]] std::string map_svg(const CellMap& map, const MapPicture& picture);

}  // namespace taut
