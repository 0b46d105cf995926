// SPDX-License-Identifier: GPL-3.0-or-later
// Dimensioned drawings of a robot: before anything is planned, and in the report.
#pragma once

#include <string>

#include "reports/page/markup.h"
#include "reports/summary/case_summary.h"
#include "reports/summary/scene.h"

namespace taut {

/// The robot at the first waypoint, from the front, from the side and from above, as an SVG document with numbered
/// cables, named anchors, bodies, overall dimensions in the case's unit, the load's direction, the world's axes and a
/// scale bar. @throws InputError if the case has no query.
[[nodiscard]] std::string robot_drawing(const CaseSummary& summary);

/// The same three views at the start of the path, for the report; nothing if there is no path, or where the numbers
/// can't be drawn.
[[nodiscard]] Html dimensioned_views(const ReportContext& scene);

}  // namespace taut
