// SPDX-License-Identifier: GPL-3.0-or-later
// The report's appendix: the certificate's exact numbers, and how to check them again. A section that has nothing to
// say is empty.
#pragma once

#include "reports/page/markup.h"
#include "reports/summary/scene.h"

namespace taut {

/// Centre and matrix of the ellipsoid of loads, where there is one.
[[nodiscard]] Html exact_load(const ReportContext& scene);
/// The space of poses, as the case states it.
[[nodiscard]] Html space(const Certificate& certificate);
/// The path's waypoints, to the last bit.
[[nodiscard]] Html exact_path(const ReportContext& scene);
/// Where the stretches that are not proved, and their witnesses, begin and end.
[[nodiscard]] Html exact_stretches(const ReportContext& scene);
/// What the certificate is made from, with digests.
[[nodiscard]] Html inputs(const Certificate& certificate);
/// How to check the certificate again.
[[nodiscard]] Html recheck(const ReportContext& scene);

}  // namespace taut
