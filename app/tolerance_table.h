// SPDX-License-Identifier: GPL-3.0-or-later
// How far tolerances may grow, for people and for machines.
#pragma once

#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "certify/tolerance_limits.h"
#include "reports/summary/display_units.h"

namespace taut {

/// Lines of text; none without limits.
[[nodiscard]] std::string tolerance_table(const std::vector<ToleranceLimit>& limits, const DisplayUnits& units = {});

/// A list of {"tolerance", "stated", "proved", "unit"}: strings, in SI.
[[nodiscard]] nlohmann::json to_json(const std::vector<ToleranceLimit>& limits);

}  // namespace taut
