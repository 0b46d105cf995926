// SPDX-License-Identifier: GPL-3.0-or-later
// `taut map`: which poses of a whole space are proved feasible, and which are proved not to be.
#pragma once

#include <CLI/CLI.hpp>
#include <cstddef>
#include <limits>
#include <optional>
#include <string>

#include "cli/parts_options.h"

namespace taut {

struct MapArguments {
  std::string case_path;
  std::string undecided;              ///< "1 %", "0.01"; empty: 1 % of two coordinates, 10 % of three
  std::optional<double> least_width;  ///< without it 0.0005
  double seconds = std::numeric_limits<double>::infinity();
  std::optional<std::size_t> most_cells;
  std::string from;       ///< a waypoint's number, or coordinates; empty: the query's first
  std::string out;        ///< folder for map.svg or map.html, or empty
  bool png = false;       ///< map.png beside map.svg
  std::string path;       ///< of the file of a path that is drawn
  std::string atlas;      ///< of the file of charts that are drawn
  std::string polygons;   ///< file, or empty
  std::string grid;       ///< file.npy, or empty
  std::string grid_size;  ///< "1024" or "720,360"; empty: 1024 of two coordinates, 128 of three
  bool json = false;
  PartsArguments parts;
};

void add_map_options(CLI::App& command, MapArguments& arguments);

/// @returns the exit code: 0 where the map was made, as far as it was asked for; 2 where it was interrupted.
/// @throws InputError for a case that has no map
[[nodiscard]] int run_map(const MapArguments& arguments);

}  // namespace taut
