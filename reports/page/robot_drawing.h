// SPDX-License-Identifier: GPL-3.0-or-later
// The robot of a case as a picture for people, before anything is planned.
#pragma once

#include <string>

#include "reports/summary/case_summary.h"

namespace taut {

/// The robot at the first waypoint, from the front, from the side and along the load, as an SVG document: cables numbered, anchors named, the load's
/// direction, the world's axes, a scale bar. @throws InputError where the case has no query.
[[nodiscard]] std::string robot_drawing(const CaseSummary& summary);

}  // namespace taut
