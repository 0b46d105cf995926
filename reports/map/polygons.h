// SPDX-License-Identifier: GPL-3.0-or-later
// A map of two coordinates as polygons, in the form of GeoJSON.
#pragma once

#include <string>

#include "reports/map/map_result.h"

namespace taut {

/// A FeatureCollection (RFC 7946, but for its coordinates, which are those of the space in people's units). Its
/// features are MultiPolygons that overlap nowhere and cover all of the space: each component of inside cells, what is
/// outside by reason, what is undecided; and where the result has a region, what of them is reachable or cut off.
/// docs/maps.md has the properties. @pre the map has two axes
[[nodiscard]] std::string polygons_text(const MapResult& result);

}  // namespace taut
