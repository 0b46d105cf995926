// SPDX-License-Identifier: GPL-3.0-or-later
// Paths as lines on a map, for pictures.
#pragma once

#include <array>
#include <string>
#include <vector>

#include "map/map_space.h"

namespace taut {

/// The path of a file of the case's parameters, such as path.csv, as lines of places t in the space; a new line begins
/// where the path crosses the end of a turn or θ = 0. In floating point.
/// @throws InputError for a file that can't be read, or whose rows are poses or cable lengths.
[[nodiscard]] std::vector<std::vector<std::array<double, 2>>> path_on_map(const std::string& file,
                                                                          const Problem& problem,
                                                                          const MapSpace& space);

}  // namespace taut
