// SPDX-License-Identifier: GPL-3.0-or-later
// The report's style sheet: light or dark by the reader's choice, and black on white in print. Colours of the curves in
// a plot differ in lightness as well as in hue, so that they can be distinguished in grey and by colour-blind readers.
#pragma once

namespace taut {

inline constexpr const char* kStyle = R"css(
:root {
  color-scheme: light dark;
  --paper: #fdfdfb; --ink: #1d2329; --soft: #59636e; --line: #d9dde1; --tile: #f3f4f2; --accent: #1f5f99;
  --proved: #1b7a4b; --refuted: #b3261e; --undecided: #8a5a00;
  --band: #9cc3e6; --curve: #1f5f99; --limit: #b3261e; --forbidden: #f9ece9; --mark: #b3261e;
  --c1: #c2570c; --c2: #5b4a9e;
  --inside: #84c99a; --tension: #92b8e6; --length: #f5b14c; --contact: #c9a3d4; --singular: #c4161c; --chart: #26323b;
  --path: #101418; --casing: #ffffff; --start: #ffffff; --goal: #101418; --open-cell: #4d545c;
  --base: #8b949e; --platform: #cfe0f1;
  --calm: #3f4b57; --near: #cf8500; --near-ink: #855600; --close: #c2410c; --out: #b3261e;
}
@media screen and (prefers-color-scheme: dark) {
  :root {
    --paper: #14181c; --ink: #e4e7ea; --soft: #9aa5b0; --line: #323a42; --tile: #1d2329; --accent: #7db7ec;
    --proved: #58c48e; --refuted: #ff8a80; --undecided: #f0b94d;
    --band: #2b5378; --curve: #8cc4f5; --limit: #ff8a80; --forbidden: #2c1f20; --mark: #ff8a80;
    --c1: #f0a35e; --c2: #b3a4f0;
    --inside: #2f7d52; --tension: #2b4f7d; --length: #96621a; --contact: #6d4a7d; --singular: #ff6b62; --chart: #dfe6ec;
    --path: #ffffff; --casing: #101418; --start: #101418; --goal: #ffffff; --open-cell: #06080a;
    --base: #77818b; --platform: #2b5378;
    --calm: #aeb8c2; --near: #e0a030; --near-ink: #f0b94d; --close: #ff8f5c; --out: #ff8a80;
  }
}
* { box-sizing: border-box; }
html { background: var(--paper); color: var(--ink); -webkit-text-size-adjust: 100%; }
body {
  max-width: 1160px; margin: 0 auto; padding: 40px 28px 72px;
  font: 16px/1.55 Inter, "Noto Sans Math", system-ui, "Liberation Sans", "DejaVu Sans", sans-serif;
}
h1 small { font-size: 14px; font-weight: 400; }
h1 { font-size: 30px; line-height: 1.2; margin: 6px 0 14px; letter-spacing: -0.01em; overflow-wrap: anywhere; }
h2 { font-size: 20px; margin: 52px 0 10px; padding-top: 14px; border-top: 1px solid var(--line); }
h3 { font-size: 15px; margin: 26px 0 6px; }
p, ul, ol { max-width: 76ch; margin: 8px 0; }
li { margin: 5px 0; }
a { color: var(--accent); }
code, pre, .digest { font: 13px/1.5 ui-monospace, "SF Mono", Menlo, "Liberation Mono", "DejaVu Sans Mono", monospace; }
code, .digest, td { overflow-wrap: anywhere; }
pre { background: var(--tile); padding: 12px 14px; border-radius: 6px; white-space: pre-wrap; overflow-wrap: anywhere; }
.soft, .note { color: var(--soft); }
.note { font-size: 14px; }
.unseen { position: absolute; width: 1px; height: 1px; overflow: hidden; clip-path: inset(50%); white-space: nowrap; }
caption { text-align: left; font-size: 13px; font-weight: 600; color: var(--soft); padding: 6px 0 4px; }
nav { font-size: 14px; display: flex; flex-wrap: wrap; gap: 4px 18px; margin-top: 20px; }
nav a { text-decoration: none; }
blockquote { margin: 12px 0; padding: 12px 18px; background: var(--tile); border-radius: 8px; max-width: 84ch; }
.formulas { font-style: italic; font-size: 16px; line-height: 1.9; }
.formulas p { max-width: none; margin: 10px 0; padding-left: 18px; }
.formulas .up, .formulas sub, .formulas sup { font-style: normal; }
sub, sup { font-size: 70%; line-height: 0; }
.scroll { position: relative; overflow-x: auto; margin: 10px 0; }
/* Where a box scrolls sideways: a shade at the side that goes on, and a word. */
.overflows {
  --shade: color-mix(in srgb, var(--ink) 28%, transparent);
  background:
    linear-gradient(to right, var(--paper) 40%, transparent) left / 40px 100% no-repeat local,
    linear-gradient(to left, var(--paper) 40%, transparent) right / 40px 100% no-repeat local,
    linear-gradient(to right, var(--shade), transparent) left / 12px 100% no-repeat scroll,
    linear-gradient(to left, var(--shade), transparent) right / 12px 100% no-repeat scroll;
}
.overflows::before {
  content: "scroll sideways →"; display: block; position: sticky; left: 0; width: max-content;
  font-size: 12px; color: var(--soft);
}
table { border-collapse: collapse; font-size: 14px; font-variant-numeric: tabular-nums; }
th, td { text-align: left; vertical-align: top; padding: 5px 18px 5px 0; border-bottom: 1px solid var(--line); }
th { font-weight: 600; color: var(--soft); white-space: nowrap; }
td.n, th.n { text-align: right; }
td.n { white-space: nowrap; }
td b { font-weight: 680; color: var(--accent); }
td.digest { font-size: 12.5px; }
details { margin: 10px 0; }
summary { cursor: pointer; color: var(--accent); font-size: 14px; }
figure { margin: 0; }
figcaption { font-size: 13px; color: var(--soft); }
.panels { display: grid; grid-template-columns: repeat(3, 1fr); gap: 18px 16px; margin: 14px 0; }
.panels.two { grid-template-columns: repeat(2, 1fr); }
.panel figcaption { font-weight: 600; color: var(--ink); margin: 0 0 2px 4px; }
.panel figcaption > span { font-weight: 400; color: var(--soft); margin-left: 8px; }
.key { white-space: nowrap; display: inline-flex; align-items: center; gap: 7px; font-weight: 400; }
.key svg { width: 24px; height: 10px; flex: none; }
figure > svg { display: block; overflow: visible; width: 100%; height: auto; }
svg text { font-size: 11px; fill: var(--soft); }
.still path, .key path, .plane path { fill: none; vector-effect: non-scaling-stroke; }
svg svg { overflow: hidden; }
.forbidden { fill: var(--forbidden); }
.limit { stroke: var(--limit); stroke-width: 1.2; }
svg .band { fill: var(--band); stroke: var(--band); stroke-width: 0.6; }
.curve { stroke: var(--curve); stroke-width: 1.5; stroke-linejoin: round; }
.curve.c1 { stroke: var(--c1); stroke-dasharray: 6 3; }
.curve.c2 { stroke: var(--c2); stroke-dasharray: 2 2.5; }
.mark { stroke: var(--mark); stroke-width: 1.5; stroke-dasharray: 3 3; }
svg .inside { fill: var(--inside); } svg .tension { fill: var(--tension); }
svg .length { fill: var(--length); }
.singular { stroke: var(--singular); stroke-width: 1.7; }
.chart { stroke: var(--chart); stroke-width: 0.5; opacity: 0.55; }
.casing { stroke: var(--casing); stroke-width: 5; stroke-linejoin: round; opacity: 0.85; }
.path { stroke: var(--path); stroke-width: 2.4; stroke-linejoin: round; }
.waypoints { fill: var(--path); }
.start { fill: var(--start); stroke: var(--path); stroke-width: 1.6; }
.goal { fill: var(--goal); stroke: var(--casing); stroke-width: 1.2; }
svg .letter { font-weight: 700; font-size: 10px; text-anchor: middle; fill: var(--path); }
svg .letter.dark { fill: var(--ink); }
.witness { stroke: var(--mark); stroke-width: 3; }
.opening { stroke: var(--undecided); stroke-width: 6; stroke-linecap: round; }
svg .base { stroke: var(--base); stroke-width: 2; fill: var(--base); fill-opacity: 0.12; }
svg .platform { stroke: var(--curve); stroke-width: 1.6; fill: var(--platform); fill-opacity: 0.65; }
.cable { stroke: var(--soft); stroke-width: 1.2; }
.cable.marked { stroke: var(--mark); stroke-width: 2.6; }
.tag { fill: var(--paper); stroke: var(--soft); stroke-width: 0.8; }
.load { fill: var(--mark); }
@media screen and (max-width: 760px) {
  .panels, .panels.two { grid-template-columns: 1fr; }
}
@media print {
  @page {
    size: A4; margin: 16mm 15mm 14mm;
    font: 8pt Inter, "Noto Sans Math", sans-serif; color: #454c53;
    @top-left { text-align: left; width: 60%; } @top-right { text-align: right; }
    @bottom-left { text-align: left; } @bottom-right { text-align: right; }
  }
  @page :first { margin-top: 12mm; @top-left { content: none; } @top-right { content: none; } }
  :root { color-scheme: light; --paper: #ffffff; --ink: #000000; --soft: #454c53; --line: #c9ced3; }
  * { print-color-adjust: exact; -webkit-print-color-adjust: exact; }
  body { max-width: none; padding: 0; font-size: 8.8pt; line-height: 1.37; }
  nav, .more { display: none; }
  h1 { font-size: 17pt; margin: 4pt 0 6pt; }
  h2 { font-size: 12.5pt; margin: 12pt 0 4pt; padding-top: 6pt; } h3 { font-size: 10pt; margin: 10pt 0 3pt; }
  p, ul, ol { margin: 4pt 0; max-width: none; } li { margin: 2pt 0; }
  h2, h3, caption, summary { break-after: avoid; }
  p { orphans: 3; widows: 3; }
  .note { font-size: 8pt; }
  h2, figure, tr, blockquote, .formulas p, .band, .signatures, pre, li { break-inside: avoid; }
  thead { display: table-header-group; }
  .scroll { overflow: visible; margin: 5pt 0; background: none; }
  .scroll:not(:has(tbody tr:nth-child(9))) { break-inside: avoid; }
  .overflows::before { content: none; }
  .panels { grid-template-columns: repeat(3, 1fr); gap: 3mm 5mm; margin: 4pt 0; }
  .panels.two { grid-template-columns: repeat(2, 1fr); }
  table { font-size: 7.5pt; max-width: 100%; } caption { font-size: 8pt; padding: 3pt 0 2pt; }
  th, td { padding: 1.3pt 7pt 1.3pt 0; } td.n { white-space: normal; }
  .cables td.n { white-space: nowrap; }
  blockquote { margin: 5pt 0; padding: 6pt 10pt; max-width: none; }
  .formulas { font-size: 9.5pt; line-height: 1.5; } .formulas p { margin: 3pt 0; padding-left: 8pt; }
  code, pre, .digest { font-size: 7.5pt; } pre { padding: 5pt 7pt; }
  td code, th code, td.digest, td .digest { font-size: inherit; }
  details { margin: 4pt 0; }
  details::details-content { content-visibility: visible; block-size: auto; }
  summary { display: none; }
  .panels.robots { grid-template-columns: repeat(3, 1fr) !important; }
  a { color: inherit; text-decoration: none; }
  td:first-child { overflow-wrap: normal; }
  th { white-space: normal; }
  #path > details { columns: 2; column-gap: 8mm; }
  #path > details:not(:has(tr:nth-child(25))) { break-inside: avoid; }
  p:has(+ .scroll), p:has(+ details) { break-after: avoid; }
  /* What is broken: the plot stands below the picture, or beside one that bodies are explained under, so that all fits
     the first page. */
  .duo:has(.broken) {
    grid-template-columns: minmax(0, 34fr) minmax(0, 66fr); grid-template-rows: min-content min-content 1fr auto;
    row-gap: 0;
  }
  .duo:has(.broken) > div { display: contents; }
  .duo:has(.broken) > .machine { grid-area: 1 / 1 / span 3; }
  .duo:has(.broken) > .machine > svg { max-height: 52mm; }
  .duo:has(.broken) .cable-plot { grid-area: 4 / 1; }
  .duo:has(.broken) .scroll { grid-area: 1 / 2; }
  .duo:has(.broken) .note { grid-area: 2 / 2; }
  .duo:has(.broken) .details { grid-area: 3 / 2 / span 2; }
  .duo:has(.broken):has(> .machine > .note) > .machine { grid-row: 1 / span 4; }
  .duo:has(.broken):has(> .machine > .note) .cable-plot { grid-area: 4 / 2; }
  .duo:has(.broken):has(> .machine > .note) .cable-plot > svg { max-height: 15mm; }
  .duo:has(.broken):has(> .machine > .note) .details { grid-row: 3; }
  .first:has(.machine > .note):has(.broken) .uncovered { font-size: 7.4pt; padding: 3pt 9pt; }
  .first .broken { font-size: 6.9pt; line-height: 1.22; }
  .first .broken td { overflow-wrap: break-word; padding: 1.2pt 6pt 1.2pt 0; }
  .first:has(.broken) .uncovered li { margin: 0; }
  .first:has(.broken) .signatures > div { min-height: 34pt; }
  .uncovered { break-inside: avoid; }
  .scopes { display: grid; grid-template-columns: 1fr 1fr; gap: 8mm; }
  .scopes h3 { margin-top: 3pt; } .scopes li { margin: 1pt 0; }
  /* The exact numbers, in two columns. Long lists of them are in the certificate, which page 1 names; the margins of
     the segments are plotted. */
  #margins, #exact-path, #exact-margins :is(details, .scroll) { display: none; }
  .appendix { columns: 2; column-gap: 8mm; font-size: 8pt; margin-top: 14pt; }
  .appendix h2 { font-size: 10pt; margin-top: 5pt; padding-top: 4pt; }
  .appendix > section:first-child > h2 { margin-top: 0; }
  .appendix table { font-size: 6.8pt; } .appendix pre { font-size: 6pt; padding: 3pt 5pt; }
  .appendix th, .appendix td { padding: 0.8pt 4pt 0.8pt 0; }
  #exact-load td.n { white-space: nowrap; }
  .appendix .wide { column-span: all; }
}
/* Appendix A, B, …: those that there are. */
.appendix { counter-reset: appendix; }
.appendix > section > h2::before {
  counter-increment: appendix; content: "Appendix " counter(appendix, upper-alpha) ". "; color: var(--soft);
}
)css";

}  // namespace taut
