// SPDX-License-Identifier: GPL-3.0-or-later
// A map and all that its outputs say of it.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "map/region.h"
#include "reports/page/map_axis.h"

namespace taut {

/// Refers to a map, its topology and a place, which outlive it.
struct MapResult {
  const Problem& problem;
  const CellMap& map;
  const MapTopology& topology;
  std::string title;              ///< of the case
  std::vector<std::string> load;  ///< the load said again
  std::vector<ShownAxis> axes;
  std::optional<MapRegion> region;  ///< where one may go
  std::string start;                ///< from where, in words: "waypoint 0 of the query"; empty without a region
};

/// What inside and outside mean, in a sentence each, of this problem: for the heads of files.
[[nodiscard]] std::vector<std::string> meaning(const MapResult& result);

}  // namespace taut
