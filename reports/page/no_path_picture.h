// SPDX-License-Identifier: GPL-3.0-or-later
// The picture of a proof that no path exists: the cells of the certificate's own tree.
#pragma once

#include "reports/page/markup.h"
#include "reports/page/no_path_content.h"

namespace taut {

/// The walls, by the reasons that the checker has confirmed; which part of the space they close off around start and
/// goal; the two places. A part finer than 1/kAreaUnits of an axis (map_frame.h) is drawn as one cell with the look of
/// its first wall, and the caption then says so. A sentence where the space has three coordinates.
/// @pre content.is_proved()
[[nodiscard]] Html no_path_picture(const NoPathContent& content);

/// The part of the style sheet that is for it.
inline constexpr const char* kNoPathStyle = R"css(
:root {
  --from-start: #d8eadb; --from-goal: #f3e6c8;
  --wall-tension: #2a6ab0; --wall-unbalanced: #6b4aa3; --wall-length: #c56a00; --wall-contact: #a03070;
}
@media screen and (prefers-color-scheme: dark) {
  :root {
    --from-start: #22402d; --from-goal: #4a3d1c; --wall-tension: #6fb1f0; --wall-unbalanced: #b79af0;
    --wall-length: #f0a044; --wall-contact: #e58fc0;
  }
}
.walls { margin: 16px 0; }
.walls > svg { max-width: 860px; }
.walls svg text { font-size: 12.5px; fill: var(--soft); stroke: none; }
.walls svg text.place { fill: var(--ink); font-weight: 650; stroke: var(--paper); }
.walls svg circle.place { fill: var(--start); stroke: var(--path); }
.walls svg .frame { stroke: var(--soft); }
.walls svg path { vector-effect: non-scaling-stroke; stroke-width: 1; }
.walls svg .from-start { fill: var(--from-start); }
.walls svg .from-goal { fill: var(--from-goal); }
.walls svg .wall-tension { fill: var(--wall-tension); stroke: var(--wall-tension); }
.walls svg .wall-unbalanced { fill: var(--wall-unbalanced); stroke: var(--wall-unbalanced); }
.walls svg .wall-length { fill: var(--wall-length); stroke: var(--wall-length); }
.walls svg .wall-contact { fill: var(--wall-contact); stroke: var(--wall-contact); }
.walls .keys { display: flex; flex-wrap: wrap; gap: 4px 20px; margin: 6px 0; }
.walls .keys .key svg { width: 14px; height: 14px; }
.walls .keys .key { white-space: normal; }
.walls .keys .key rect { stroke: var(--soft); stroke-width: 0.8; }
.ends { display: grid; grid-template-columns: repeat(auto-fit, minmax(min(300px, 100%), 1fr)); gap: 14px 24px; }
@media screen and (max-width: 760px) { .walls svg text { font-size: 17px; } }
@media print {
  .walls { margin: 6pt 0; } .walls > svg { max-width: 150mm; } .walls .keys { gap: 2pt 12pt; }
  .ends { grid-template-columns: 1fr 1fr; } .ends .machine > svg { max-height: 74mm; }
  .first.no-path { break-after: auto; } .no-path ~ #move { break-inside: avoid; }
}
)css";

}  // namespace taut
