// SPDX-License-Identifier: GPL-3.0-or-later
// Paths and charts as lines on a map, for pictures.
#pragma once

#include <string>
#include <vector>

#include "case/case_file.h"
#include "map/map_space.h"
#include "reports/map/picture.h"

namespace taut {

/// The path of a file of the case's parameters, such as path.csv, as lines of places t in the space; a new line begins
/// where the path crosses the end of a turn or θ = 0. In floating point.
/// @throws InputError for a file that can't be read, or whose rows are poses or cable lengths.
[[nodiscard]] std::vector<MapLine> path_on_map(const std::string& file, const Problem& problem, const MapSpace& space);

/// The outlines of all charts of an atlas file, likewise.
/// @throws InputError as chart_outlines()
[[nodiscard]] std::vector<MapLine> charts_on_map(const std::string& file, const Case& the_case, const MapSpace& space);

}  // namespace taut
