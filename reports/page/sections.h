// SPDX-License-Identifier: GPL-3.0-or-later
// The report's sections after its first page and before its appendix: the certificate's content in words and tables.
// A section that has nothing to say is empty.
#pragma once

#include "reports/page/markup.h"
#include "reports/summary/scene.h"

namespace taut {

/// What stands in the way of a proof, or by how much it succeeds, as the certificate's illustration says.
[[nodiscard]] Html headroom(const ReportContext& scene);
/// The stretches of an audited path that are not proved.
[[nodiscard]] Html stretches(const ReportContext& scene);
/// Robot, limits and load, as the case states them.
[[nodiscard]] Html machine(const ReportContext& scene);
[[nodiscard]] Html tolerances(const ReportContext& scene);
[[nodiscard]] Html assumptions(const Certificate& certificate);
/// The path's waypoints as poses, rounded.
[[nodiscard]] Html path_section(const ReportContext& scene);
/// The claim, word by word and in formulas, with its symbols.
[[nodiscard]] Html theorem(const Certificate& certificate);

}  // namespace taut
