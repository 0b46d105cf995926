// SPDX-License-Identifier: GPL-3.0-or-later
// The style sheet of the pictures of the machine. Cables near their limits differ in width and dashes as well as in
// colour.
#pragma once

namespace taut {

inline constexpr const char* kMachineStyle = R"css(
:root {
  --warm: #f0c36a; --warm-half: #dfae52; --warm-dim: #c4923a; --warm-edge: #4d3a05; --steel: #66707d; --post: #c3cad2;
  --ground: #dde1e5; --anchor: #39434d;
  --obstacle: #8595a6; --obstacle-edge: #41566b; --carried: #7fae9f; --carried-edge: #24594b;
}
@media (prefers-color-scheme: dark) {
  :root {
    --warm: #b98a34; --warm-half: #a1762a; --warm-dim: #855f1f; --warm-edge: #f3d89c; --steel: #8b97a3;
    --post: #4b5560; --ground: #2c343b; --anchor: #c3ccd4;
    --obstacle: #5d7083; --obstacle-edge: #a9bccf; --carried: #3f7363; --carried-edge: #9bd3c0;
  }
}
@media print {
  :root {
    --warm: #f0c36a; --warm-half: #dfae52; --warm-dim: #c4923a; --warm-edge: #4d3a05; --steel: #66707d;
    --post: #c3cad2; --ground: #dde1e5; --anchor: #39434d;
    --obstacle: #8595a6; --obstacle-edge: #41566b; --carried: #7fae9f; --carried-edge: #24594b;
    --calm: #3f4b57; --near: #cf8500; --near-ink: #855600; --close: #c2410c; --out: #b3261e;
  }
}
.machine figcaption { font-weight: 600; color: var(--ink); }
.machine svg { display: block; width: 100%; height: auto; max-height: 82vh; overflow: hidden; }
.machine svg path { fill: none; stroke-linecap: round; stroke-linejoin: round; }
.machine svg text {
  font-size: 15px; text-anchor: middle; fill: var(--soft);
  paint-order: stroke; stroke: var(--paper); stroke-width: 4; stroke-linejoin: round;
}
.machine .grid { stroke: var(--ground); stroke-width: 1; }
.machine svg .fixed { fill: var(--steel); fill-opacity: 0.07; stroke: none; }
.machine .hatch { stroke: var(--steel); stroke-width: 0.8; opacity: 0.45; }
.machine .frame { stroke: var(--steel); stroke-width: 5; }
.machine .shown { stroke: var(--steel); stroke-width: 0.9; opacity: 0.6; }
.machine svg .shown.payload { fill: var(--warm-edge); fill-opacity: 0.12; stroke: none; opacity: 1; }
.machine .shown.edges { stroke: var(--warm-edge); opacity: 0.8; }
.machine svg .body { fill: var(--obstacle); fill-opacity: 0.38; stroke: none; }
.machine svg .body.carried { fill: var(--carried); fill-opacity: 0.5; }
.machine svg .body.half-space { fill-opacity: 0.16; stroke: var(--obstacle-edge); stroke-width: 0.8; }
.machine .body-edges { stroke: var(--obstacle-edge); stroke-width: 1.1; }
.machine .body-edges.carried { stroke: var(--carried-edge); }
.machine .body-edges.unseen { opacity: 0.35; stroke-dasharray: 3 3; }
.machine svg .body-name { font-size: 13px; fill: var(--obstacle-edge); }
.machine svg .body-name.carried { fill: var(--carried-edge); }
.machine .apart { stroke: var(--ink); stroke-width: 1.8; }
.machine .apart-casing { stroke: var(--paper); stroke-width: 5; opacity: 0.8; }
.machine svg .apart-end { fill: var(--ink); }
.machine .post { stroke: var(--post); stroke-width: 6; }
.machine .foot { stroke: var(--post); stroke-width: 4; }
.machine svg .anchor { fill: var(--anchor); }
.machine svg .side { stroke: var(--warm-edge); stroke-width: 1.6; fill-opacity: 0.93; }
.machine svg .lit { fill: var(--warm); } .machine svg .half-lit { fill: var(--warm-half); }
.machine svg .dim { fill: var(--warm-dim); }
.machine .ghost { stroke: var(--soft); stroke-width: 1.5; stroke-dasharray: 5 4; }
.machine svg .ghost.fill { stroke: none; fill: var(--soft); fill-opacity: 0.07; }
.machine .ghost.faint { opacity: 0.45; }
.machine .tube { stroke: var(--curve); opacity: 0.22; }
.machine .track-casing { stroke: var(--paper); stroke-width: 4.4; opacity: 0.75; }
.machine .track { stroke: var(--curve); stroke-width: 2.2; }
.machine .unseen-casing { stroke: none; }
.machine .cable-casing { stroke: var(--paper); stroke-width: 5; stroke-linecap: butt; }
.machine .cable { stroke: var(--calm); stroke-width: 2; stroke-linecap: butt; }
.machine .cable.near { stroke: var(--near); stroke-width: 2.6; }
.machine .cable.close { stroke: var(--close); stroke-width: 3.6; stroke-dasharray: 10 5; }
.machine .cable.out { stroke: var(--out); stroke-width: 4.4; stroke-dasharray: 5 5; }
.machine .joint { fill: var(--warm-edge); }
.machine .disc { fill: var(--paper); stroke: var(--calm); stroke-width: 1.8; }
.machine .disc.near { stroke: var(--near); }
.machine .disc.close { fill: var(--close); stroke: var(--close); }
.machine .disc.out { fill: var(--out); stroke: var(--out); }
.machine svg .number { font-weight: 700; fill: var(--ink); stroke: none; }
.machine svg .number.near { fill: var(--near-ink); }
.machine svg .number.close, .machine svg .number.out { fill: var(--paper); }
.machine .leader { stroke: var(--soft); stroke-width: 1; }
.machine svg .load { fill: var(--ink); } .machine .load-shaft { stroke: var(--ink); stroke-width: 4; }
.machine .load-casing { stroke: var(--paper); stroke-width: 8; opacity: 0.7; }
.machine .stalk { stroke: var(--warm-edge); stroke-width: 2; stroke-dasharray: 2 4; }
.machine .gravity { fill: var(--paper); stroke: var(--ink); stroke-width: 1.4; }
.machine svg .quarters { fill: var(--ink); }
.machine svg .load-words { font-weight: 650; fill: var(--ink); }
.machine svg .end { font-weight: 700; }
.machine .scale { stroke: var(--soft); stroke-width: 1.6; }
.machine svg .scale-words { text-anchor: start; }
.machine .axis { stroke: var(--soft); stroke-width: 2; }
.machine .axis.x { stroke: #c03a2b; } .machine .axis.y { stroke: #2c8a4b; } .machine .axis.z { stroke: #3b78c2; }
.dimensioned svg { display: block; width: 100%; min-width: 640px; height: auto; }
.dimensioned figcaption { font-weight: 600; color: var(--ink); }
.dimensioned svg path { fill: none; }
.dimensioned svg text { font-size: 12px; text-anchor: middle; fill: var(--soft); }
.dimensioned .base { stroke: var(--steel); stroke-width: 1.6; }
.dimensioned svg .platform { stroke: var(--warm-dim); stroke-width: 2; }
.dimensioned .cable { stroke: var(--calm); stroke-width: 1; }
.dimensioned .tag { fill: var(--paper); stroke: var(--soft); stroke-width: 0.9; }
.dimensioned svg .number { font-weight: 650; fill: var(--ink); }
.dimensioned .extension { stroke: var(--post); stroke-width: 0.8; }
.dimensioned .dimension { stroke: var(--soft); stroke-width: 0.9; }
.dimensioned svg .measure { fill: var(--ink); }
.dimensioned .load { stroke: var(--out); stroke-width: 2.2; }
.dimensioned .axis, .dimensioned .scale { stroke: var(--soft); stroke-width: 1.4; }
.dimensioned svg .title { font-size: 13px; font-weight: 650; text-anchor: start; fill: var(--ink); }
@media print { .dimensioned { break-inside: avoid; } .dimensioned svg { min-width: 0; } }
)css";

}  // namespace taut
