// SPDX-License-Identifier: GPL-3.0-or-later
// The bar that stays at the top of the screen: the verdict, the player, for which the script has a place there, and the
// page's contents. Paper has none.
#pragma once

#include <vector>

#include "reports/page/markup.h"
#include "reports/summary/scene.h"

namespace taut {

struct ContentsLink {
  const char* id;     ///< of the section
  const char* title;  ///< a word or two
};

[[nodiscard]] Html sticky_bar(const ReportContext& scene, const std::vector<ContentsLink>& contents);

inline constexpr const char* kStickyBarStyle = R"css(
/* The bar at the top of the screen. Its ground reaches across the whole window without making the page wider. */
html { scroll-padding-top: 64px; }
.bar {
  position: sticky; top: 0; z-index: 20; display: flex; align-items: center; gap: 8px 16px;
  min-height: 48px; margin: -24px 0 16px; padding: 6px 0; font-size: 14px;
  border-image: linear-gradient(var(--paper) calc(100% - 1px), var(--line) 0) fill 0 / 0 / 0 100vw;
}
.bar .state {
  flex: none; padding: 5px 12px; border-radius: 6px; font-weight: 700; letter-spacing: 0.02em; white-space: nowrap;
  text-decoration: none; color: var(--paper); background: var(--undecided);
}
.bar .state.proved { background: var(--proved); } .bar .state.refuted { background: var(--refuted); }
.bar [data-plot="bar"] { flex: 1 1 auto; min-width: 0; }
.bar nav { display: flex; align-items: center; flex: none; flex-wrap: nowrap; gap: 0 16px; margin: 0 0 0 auto; }
.bar .quick { display: flex; gap: 0 16px; }
.bar nav a { white-space: nowrap; }
.bar details { position: relative; margin: 0; }
.bar summary {
  list-style: none; border: 1px solid var(--soft); border-radius: 6px; padding: 5px 12px; color: var(--ink);
  background: var(--tile); white-space: nowrap;
}
.bar summary::-webkit-details-marker { display: none; }
.bar details > div {
  position: absolute; right: 0; top: calc(100% + 6px); display: grid; min-width: 190px; padding: 8px;
  max-height: calc(100vh - 72px); overflow-y: auto;
  background: var(--paper); border: 1px solid var(--soft); border-radius: 8px; box-shadow: 0 6px 24px #0004;
}
.bar details a { padding: 8px 10px; border-radius: 6px; }
.bar details a:hover { background: var(--tile); }
@media (max-width: 900px) { .bar .quick { display: none; } }
@media (max-width: 560px) {
  .bar { gap: 8px; }
  .bar .state { padding: 5px 8px; font-size: 12.5px; letter-spacing: 0; }
  .bar summary { padding: 5px 10px; }
  .bar summary .word { position: absolute; width: 1px; height: 1px; overflow: hidden; clip-path: inset(50%); }
}
@media print { .bar { display: none; } }
)css";

}  // namespace taut
