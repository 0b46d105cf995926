// SPDX-License-Identifier: GPL-3.0-or-later
// A waypoint that is typed apart from the case file, in the words of the case's query.
#pragma once

#include <string>
#include <vector>

#include "case/case_file.h"

namespace taut {

/// Coordinates that were typed apart: one constant expression for each parameter of the case's space (SI).
using TypedWaypoint = std::vector<ExpressionText>;

/// Reads a case file, and `text`, such as "phi: 10 deg, theta: 0.3", as one of its query's waypoints: with the names of
/// its space's parameters, its units, and within its ranges.
/// @param name  what stands for the text in messages: an option
/// @param waypoint  is set before `check` is called
/// @throws InputError with its place, in the file or in the text, the value seen and what was expected.
[[nodiscard]] Case load_case_and_waypoint(const std::string& path, const std::string& text, const std::string& name,
                                          TypedWaypoint& waypoint, const CaseCheck& check = {});

}  // namespace taut
