// SPDX-License-Identifier: GPL-3.0-or-later
// Where both kinds of limits are violated: for pictures, since a cell of a map has one reason.
#pragma once

#include <vector>

#include "map/subdivision.h"

namespace taut {

/// Cells of which it is proved that at every pose a length is beyond a limit, and that at every pose tensions are: one
/// of them, or, whatever lengths are, no tensions within limits balance some load. They are parts of outside cells,
/// which are halved for that until they are no wider than `width`, and overlap nowhere. There may be more such poses.
[[nodiscard]] std::vector<Cell> cells_beyond_both(const Problem& problem, const CellMap& map, double width);

}  // namespace taut
