// SPDX-License-Identifier: GPL-3.0-or-later
// The picture data of a search, for reports: charts and counts, in floating point. Proves nothing.
#pragma once

#include <nlohmann/json.hpp>

#include "planner/planner.h"

namespace taut {

/// The `illustration` of a certificate: charts' centres and polygons where n = 2, and the search's counts.
[[nodiscard]] nlohmann::json illustrate(const Problem& problem, const Atlas& atlas, const PlanStatistics& statistics);

}  // namespace taut
