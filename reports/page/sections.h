// SPDX-License-Identifier: GPL-3.0-or-later
// The report's sections behind its first page: what a certificate says, in full, in words and tables. Some are empty where there is
// nothing to say.
#pragma once

#include "reports/page/markup.h"
#include "reports/summary/scene.h"

namespace taut {

/// The claim, word by word and in formulas, with its symbols.
[[nodiscard]] Html theorem(const Certificate& certificate);
[[nodiscard]] Html tolerances(const ReportContext& scene);
[[nodiscard]] Html assumptions(const Problem& problem);
/// What the certificate is made from, with digests.
[[nodiscard]] Html inputs(const Certificate& certificate);
/// Robot, load and space of poses.
[[nodiscard]] Html robot(const ReportContext& scene);
/// The path's waypoints.
[[nodiscard]] Html path_section(const ReportContext& scene);
/// Where an audited path is not proved.
[[nodiscard]] Html stretches(const ReportContext& scene);
/// Proved margins of each segment; of a long path, of blocks of segments and of the segments with the least.
[[nodiscard]] Html margins(const ReportContext& scene);
/// How to check the certificate again.
[[nodiscard]] Html recheck(const ReportContext& scene);

}  // namespace taut
