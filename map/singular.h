// SPDX-License-Identifier: GPL-3.0-or-later
// Where J may be singular: cells that enclose det J = 0, for pictures.
#pragma once

#include <vector>

#include "map/subdivision.h"

namespace taut {

/// Cells no wider than `width` of any axis that together contain every singular pose of the space, but for those in
/// cells where a length is beyond its limit.
[[nodiscard]] std::vector<Cell> singular_cells(const Problem& problem, const CellMap& map, double width);

}  // namespace taut
