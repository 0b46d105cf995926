// SPDX-License-Identifier: GPL-3.0-or-later
// The assurance case, drawn in Goal Structuring Notation and as nested lists, and the topics of a lift plan.
#pragma once

#include <vector>

#include "reports/page/markup.h"
#include "reports/summary/summary.h"

namespace taut {

/// Two figures, each of about half a sheet of A4: what has to hold for the top goal, and how the claim is shown. Their
/// layout is computed; their text is the nodes' labels. Nothing where there are no nodes.
/// @pre the nodes are those of assurance_case()
[[nodiscard]] Html assurance_drawing(const std::vector<AssuranceNode>& nodes);

/// The drawing and the whole text as nested lists; where nothing is proved, a sentence that says so.
[[nodiscard]] Html assurance_section(const ReportContext& scene, const Summary& summary);

/// The table of what a lift plan asks for: what this report fills in and what stays open.
[[nodiscard]] Html lift_plan_section(const ReportContext& scene, const Summary& summary);

/// The style sheet's part for these sections.
inline constexpr const char* kAssuranceStyle = R"css(
/* Assurance case and lift plan */
.gsn { max-width: 860px; margin: 12px 0; }
.gsn svg { width: 100%; min-width: 620px; height: auto; display: block; }
.gsn .shape { fill: var(--paper); stroke: var(--ink); stroke-width: 1.1; }
.gsn .claimed .shape { fill: var(--tile); stroke-width: 1.6; }
.gsn .open .shape { stroke-dasharray: 4 2.5; } .gsn .open .diamond { stroke-dasharray: none; }
.gsn .link { fill: none; stroke: var(--soft); stroke-width: 1; }
.gsn .solid { fill: var(--soft); stroke: var(--soft); } .gsn .hollow { fill: var(--paper); stroke: var(--soft); }
.gsn text { font-size: 11.5px; fill: var(--ink); text-anchor: middle; }
.gsn text .id { font-weight: 700; }
.gsn text.kind { font-weight: 700; font-size: 12px; }
.argument, .argument ul { list-style: none; padding-left: 18px; margin: 4px 0; }
.argument > li { margin-left: -18px; }
.argument b { font-weight: 680; }
.lift-plan th[scope="rowgroup"] { color: var(--ink); padding-top: 14px; }
.lift-plan { width: 100%; }
.lift-plan td { min-width: 130px; } .lift-plan td:first-child { width: 22%; } .lift-plan td:last-child { width: 38%; }
@media print {
  .gsn { break-inside: avoid; max-width: none; }
  .gsn svg { min-width: 0; }
  #assurance details { display: none; }  /* the drawings have it in fewer words */
  .lift-plan { font-size: 7.4pt; line-height: 1.3; } .lift-plan td, .lift-plan th { padding: 1.6pt 8pt 1.6pt 0; }
  .lift-plan th[scope="rowgroup"] { padding-top: 5pt; }
}
)css";

}  // namespace taut
