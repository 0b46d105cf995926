// SPDX-License-Identifier: GPL-3.0-or-later
// The first page's part of the style sheet: one sheet of A4, and as wide or narrow as the screen.
#pragma once

namespace taut {

inline constexpr const char* kFirstPageStyle = R"css(
.masthead {
  display: flex; flex-wrap: wrap; justify-content: space-between; gap: 4px 28px;
  font-size: 13px; color: var(--soft);
}
.masthead p, .masthead dl { margin: 0; }
.masthead dl { display: flex; flex-wrap: wrap; gap: 4px 20px; }
.masthead dl > div { display: flex; gap: 6px; }
.masthead dd { margin: 0; color: var(--ink); font-weight: 600; }
.blank { display: inline-block; min-width: 70px; border-bottom: 1px solid var(--soft); }
.unverified { font-size: 12px; margin: -8px 0 8px; }
.scope { margin: 10px 0 14px; font-size: 13.5px; line-height: 1.4; }
.scope > div { display: grid; grid-template-columns: 84px 1fr; gap: 10px; padding: 2px 0; }
.scope dt { color: var(--soft); font-weight: 600; }
.scope dd { margin: 0; overflow-wrap: anywhere; }
.band {
  display: grid; grid-template-columns: auto minmax(0, 1fr) fit-content(36%); align-items: center; gap: 10px 24px;
  border-radius: 10px; padding: 14px 22px; color: #fff;
}
.band.proved { background: #15653c; }
.band.refuted { background: #a61b14; }
.band.undecided, .band.unchecked { background: #835300; }
.band p { margin: 0; max-width: none; }
.band .word { font-size: 29px; line-height: 1.1; font-weight: 750; letter-spacing: 0.01em; white-space: nowrap; }
.band .icon { width: 30px; height: 30px; margin-right: 10px; vertical-align: -5px; }
.band .icon path { fill: none; stroke: currentColor; stroke-width: 3.4; stroke-linecap: round; stroke-linejoin: round; }
.band .headline { font-size: 16px; line-height: 1.35; }
.checks {
  list-style: none; margin: 0; padding: 0 0 0 20px; border-left: 1px solid rgb(255 255 255 / 0.5);
  font-size: 13px; line-height: 1.35;
}
.checks li { margin: 3px 0; }
.tiles { display: grid; grid-template-columns: repeat(auto-fit, minmax(225px, 1fr)); gap: 12px; margin: 14px 0; }
.tiles:has(.tile:nth-child(5)) { grid-template-columns: repeat(auto-fit, minmax(178px, 1fr)); }
.tiles:has(.tile:nth-child(5)) .value { font-size: 19px; }
.tile {
  border: 1px solid var(--line); border-top: 4px solid var(--calm); border-radius: 10px; padding: 9px 14px 10px;
}
.tile.near { border-top-color: var(--near); }
.tile.close, .tile.out { border-top-color: var(--close); }
.tile dt { font-size: 13px; color: var(--soft); }
.tile dd { margin: 0; }
.tile .value { font-size: 22px; line-height: 1.25; font-weight: 700; font-variant-numeric: tabular-nums; }
.tile .detail { font-size: 13px; line-height: 1.35; }
.tile.out .value { color: var(--out); }
.rates { margin: 0 0 12px; padding-left: 18px; max-width: none; columns: 2; column-gap: 22px; font-size: 13px; }
.rates li { margin: 1px 0; break-inside: avoid; }
.rates .out { color: var(--out); font-weight: 700; }
.details { margin: 12px 0; font-size: 14.5px; }
.details p { max-width: none; margin: 5px 0; }
.duo > div > :first-child { margin-top: 0; }
.duo { display: grid; grid-template-columns: minmax(0, 1fr); gap: 18px; }
.duo:has(> figure) { grid-template-columns: minmax(0, 43fr) minmax(0, 57fr); }
.cables { width: 100%; }
.cables caption { font-size: 14.5px; }
.cables td, .cables th { padding: 6px 10px 6px 0; vertical-align: middle; white-space: nowrap; }
.cables thead th { white-space: normal; vertical-align: bottom; line-height: 1.25; }
.cables td:last-child, .cables th:last-child { padding-right: 0; }
.cables .near { color: var(--near-ink); font-weight: 700; }
.cables .close, .cables .out { color: var(--close); font-weight: 700; }
.first .note { max-width: none; font-size: 12.5px; line-height: 1.4; }
.use { display: block; width: 100%; min-width: 110px; height: 13px; }
.use .rail { stroke: var(--line); stroke-width: 4; }
.use rect { fill: var(--accent); }
.use.near rect { fill: var(--near); }
.use.close rect, .use.out rect { fill: var(--close); }
.use .limit { stroke: var(--limit); stroke-width: 1.2; fill: none; vector-effect: non-scaling-stroke; }
.broken { width: 100%; font-size: 13.5px; }
.broken td { padding: 5px 12px 5px 0; line-height: 1.35; }
.broken td b { color: inherit; }
.facts { margin: 14px 0; font-size: 14.5px; line-height: 1.45; }
.facts > div { display: grid; grid-template-columns: 110px 1fr; gap: 4px 16px; padding: 5px 0; }
.facts dt { color: var(--soft); font-weight: 600; }
.facts dd { margin: 0; overflow-wrap: anywhere; }
.cable-plot { max-width: 760px; }
.cable-plot figcaption { font-size: 13px; margin: 4px 0; }
.cable-plot svg { width: 100%; height: auto; display: block; }
.cable-plot text { font-size: 12px; fill: var(--soft); }
.cable-plot .end { text-anchor: end; }
.cable-plot .forbidden { fill: var(--forbidden); }
.cable-plot .band {
  fill: var(--curve); fill-opacity: 0.4; stroke: var(--curve); stroke-width: 1.4; stroke-linejoin: round;
}
.cable-plot .limit { stroke: var(--limit); stroke-width: 1.3; fill: none; }
.cable-plot .mark { stroke: var(--ink); stroke-width: 1.4; stroke-dasharray: 5 4; fill: none; }
.cable-plot .frame { fill: none; stroke: var(--soft); stroke-width: 0.8; }
.uncovered {
  border: 1.5px solid var(--near); border-radius: 10px; padding: 9px 16px 10px; margin: 12px 0; font-size: 13.5px;
  background: color-mix(in srgb, var(--near) 9%, var(--paper));
}
.uncovered p { margin: 0 0 4px; max-width: none; }
.uncovered ul { columns: 2; column-gap: 22px; margin: 0; padding-left: 18px; max-width: none; }
.uncovered li { margin: 2px 0; break-inside: avoid; }
.declaration { max-width: none; font-size: 14px; line-height: 1.5; }
.signatures { display: grid; grid-template-columns: repeat(3, minmax(0, 1fr)); gap: 12px; margin-top: 8px; }
.signatures > div {
  border: 1px solid var(--soft); border-radius: 8px; min-height: 84px; padding: 6px 12px; position: relative;
  font-size: 13px;
}
.signatures span { color: var(--soft); display: block; }
.signatures small { position: absolute; left: 12px; bottom: 4px; font-size: 11px; color: var(--soft); }
@media screen and (max-width: 760px) {
  .band { grid-template-columns: minmax(0, 1fr); padding: 14px 16px; }
  .band .word { font-size: 25px; white-space: normal; }
  .checks { border-left: none; border-top: 1px solid rgb(255 255 255 / 0.5); padding: 8px 0 0; }
  .duo:has(> figure) { grid-template-columns: minmax(0, 1fr); }
  .scope > div, .facts > div { grid-template-columns: minmax(0, 1fr); gap: 0; }
  .tiles, .tiles:has(.tile:nth-child(5)) { grid-template-columns: repeat(2, minmax(0, 1fr)); gap: 8px; }
  .tile { padding: 7px 10px 8px; }
  .tile .value, .tiles:has(.tile:nth-child(5)) .value { font-size: 16px; }
  .uncovered ul, .rates { columns: 1; }
  .signatures { grid-template-columns: minmax(0, 1fr); }
}
@media print {
  .first { break-after: page; font-size: 8.4pt; line-height: 1.34; }
  .first p { margin: 2.5pt 0; }
  .masthead { font-size: 7.2pt; gap: 2pt 10pt; } .masthead dl { gap: 2pt 9pt; } .blank { min-width: 34pt; }
  .first figcaption { font-size: 8.4pt; }
  .scope { font-size: 7.9pt; line-height: 1.3; margin: 3pt 0 6pt; }
  .scope > div { grid-template-columns: 50pt 1fr; gap: 6pt; padding: 0.8pt 0; }
  .scope .digest { font-size: 6.4pt; }
  .unverified { font-size: 6.8pt; margin: -3pt 0 2pt !important; }
  .band { padding: 6pt 12pt; gap: 4pt 14pt; border-radius: 6pt; print-color-adjust: exact; }
  .band .word { font-size: 17pt; } .band .icon { width: 17pt; height: 17pt; vertical-align: -3pt; }
  .band .headline { font-size: 9.6pt; }
  .checks { font-size: 7.8pt; padding-left: 10pt; } .checks li { margin: 1.5pt 0; }
  .tiles { grid-template-columns: repeat(4, minmax(0, 1fr)); gap: 6pt; margin: 7pt 0; }
  .tiles:has(.tile:nth-child(5)) { grid-template-columns: repeat(5, minmax(0, 1fr)); }
  .first:has(.tile:nth-child(5)) .headline { font-size: 8.4pt; line-height: 1.25; }
  .first:has(.tile:nth-child(5)) :is(.uncovered, .scope) { font-size: 7.6pt; line-height: 1.3; }
  .first:has(.tile:nth-child(5)) .cables :is(td, th) { padding-top: 1.5pt; padding-bottom: 1.5pt; }
  .first:has(.tile:nth-child(5)) :is(.note, .declaration) { font-size: 7pt; line-height: 1.25; }
  .tile { padding: 4pt 7pt 5pt; border-radius: 6pt; border-top-width: 2.5pt; }
  .tile dt, .tile .detail { font-size: 7.4pt; } .tile .value { font-size: 12pt; }
  .tiles:has(.tile:nth-child(5)) .value { font-size: 9.5pt; }
  .tiles:has(.tile:nth-child(5)) .detail { font-size: 6.8pt; }
  .rates { font-size: 7pt; line-height: 1.25; margin: -3pt 0 4pt; }
  .details { font-size: 7.8pt; line-height: 1.3; margin: 3pt 0; } .details p { margin: 2pt 0; }
  .duo { gap: 10pt; }
  .duo:has(> figure) { grid-template-columns: minmax(0, 41fr) minmax(0, 59fr); }
  .facts { font-size: 8.4pt; line-height: 1.34; margin: 6pt 0; }
  .facts > div { grid-template-columns: 58pt 1fr; gap: 8pt; padding: 2.2pt 0; }
  .broken { font-size: 7.2pt; } .broken td { padding: 1.4pt 5pt 1.4pt 0; line-height: 1.25; }
  .cable-plot figcaption { font-size: 7.2pt; margin: 2pt 0; } .cable-plot { max-width: 92mm; }
  .cables caption { white-space: normal; font-size: 8.4pt; }
  .first .cables td, .first .cables th { padding: 2.2pt 5pt 2.2pt 0; font-size: 7.6pt; }
  .use { min-width: 60pt; height: 8pt; print-color-adjust: exact; }
  .first .note { font-size: 7pt; line-height: 1.28; max-width: none; }
  .uncovered { padding: 4pt 9pt 4pt; margin: 4pt 0; font-size: 7.8pt; border-radius: 6pt; print-color-adjust: exact; }
  .declaration { font-size: 8pt; line-height: 1.3; }
  .signatures { gap: 7pt; margin-top: 3pt; } .signatures > div { min-height: 34pt; font-size: 7.6pt; }
  .signatures small { font-size: 6.4pt; }
}
)css";

}  // namespace taut
