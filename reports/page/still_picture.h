// SPDX-License-Identifier: GPL-3.0-or-later
// A still picture of the robot in a few poses, for paper and for browsers that draw no moving picture. It is computed
// in floating point.
#pragma once

#include "reports/page/markup.h"
#include "reports/summary/scene.h"

namespace taut {

/// The robot at the first and the last waypoint, and at the witness if there is one, seen from the side; nothing if
/// there is no path.
[[nodiscard]] Html still_picture(const ReportContext& scene);

}  // namespace taut
