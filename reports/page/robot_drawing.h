// SPDX-License-Identifier: GPL-3.0-or-later
// A drawing of a case's robot, which people can look at before anything is planned.
#pragma once

#include <string>

#include "reports/summary/case_summary.h"

namespace taut {

/// The robot at the first waypoint, from the front, from the side and along the load, as an SVG document with numbered
/// cables, named anchors, the load's direction, the world's axes and a scale bar. @throws InputError if the case has no
/// query.
[[nodiscard]] std::string robot_drawing(const CaseSummary& summary);

}  // namespace taut
