// SPDX-License-Identifier: GPL-3.0-or-later
// The report's sections after its first page: the certificate's content in full, in words and tables. A section that
// has nothing to say is empty.
#pragma once

#include "reports/page/markup.h"
#include "reports/summary/scene.h"

namespace taut {

/// The claim, word by word and in formulas, with its symbols.
[[nodiscard]] Html theorem(const Certificate& certificate);
[[nodiscard]] Html tolerances(const ReportContext& scene);
/// What stands in the way of a proof, or by how much it succeeds, as the certificate's illustration says.
[[nodiscard]] Html headroom(const ReportContext& scene);
[[nodiscard]] Html assumptions(const Certificate& certificate);
/// What the certificate is made from, with digests.
[[nodiscard]] Html inputs(const Certificate& certificate);
/// Robot, load and space of poses.
[[nodiscard]] Html robot(const ReportContext& scene);
/// The path's waypoints.
[[nodiscard]] Html path_section(const ReportContext& scene);
/// The stretches of an audited path that are not proved.
[[nodiscard]] Html stretches(const ReportContext& scene);
/// Proved margins of each segment; for a long path, those of blocks of segments and of the segments with the least.
[[nodiscard]] Html margins(const ReportContext& scene);
/// How to check the certificate again.
[[nodiscard]] Html recheck(const ReportContext& scene);

}  // namespace taut
