// SPDX-License-Identifier: GPL-3.0-or-later
// A map on a regular grid as a NumPy file, for other planners, and a JSON file that says what its numbers mean.
#pragma once

#include <string>

#include "map/grid.h"
#include "reports/map/map_result.h"

namespace taut {

/// A .npy file (format 1.0) of unsigned bytes, one a box, in C order: array[i, j] or array[i, j, l].
/// @pre size is that of grid_of()
[[nodiscard]] std::string grid_npy(const std::vector<GridValue>& values, const GridSize& size, std::size_t axes);

/// Its meaning: axes with their units, ends and steps, the values in words with their counts, the start.
/// @param array  the name of the .npy file
[[nodiscard]] std::string grid_meaning(const MapResult& result, const std::vector<GridValue>& values,
                                       const GridSize& size, const std::string& array);

}  // namespace taut
