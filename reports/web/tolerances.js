// SPDX-License-Identifier: GPL-3.0-or-later
// The critical tolerances: the stated value of each as a fraction of what it alone could be.
import * as Plot from "@observablehq/plot";
import { atMost, degrees, element, text } from "./words.js";

const NAMES = {
  base_anchors: "base anchors",
  platform_anchors: "platform anchors",
  load_point: "load point",
  load: "load",
  position: "position",
  orientation: "orientation",
  cable_length: "cable length",
};

/// `digits`: the function that turns a number into text.
function shown(x, unit, digits) {
  if (unit === "m") return `${digits(x * 1000)} mm`;
  if (unit === "rad") return `${digits(degrees(x))}°`;
  return `${digits(x)} ${unit === "N, N m" ? "N or N·m" : unit}`;
}

const stated = (x) => text(x, 6); // as it was typed, in usual cases

export function toleranceFigure(data) {
  const rows = data.tolerances
    .map((t) => ({ ...t, label: NAMES[t.name] ?? t.name, used: t.proved > 0 ? (100 * t.stated) / t.proved : 0 }))
    .sort((a, b) => b.used - a.used);
  const words = (t) => t.stated > 0 ? `${shown(t.stated, t.unit, stated)} of ${shown(t.proved, t.unit, atMost)}`
    : `none stated; ${shown(t.proved, t.unit, atMost)} would do`;
  const plot = Plot.plot({
    width: 750,
    height: 46 + 26 * rows.length,
    marginLeft: 112,
    marginRight: 220,
    marginBottom: 36,
    style: "background: none; color: inherit;",
    x: { domain: [0, 100], label: "stated, as a share of what is proved to be possible alone [%]", labelArrow: "none",
      labelAnchor: "center", grid: true, ticks: 5 },
    y: { domain: rows.map((t) => t.label), label: null },
    marks: [
      Plot.barX(rows, { x: "used", y: "label", fill: "var(--curve)", insetTop: 3, insetBottom: 3, clip: true }),
      Plot.ruleX([0], { stroke: "var(--soft)" }),
      Plot.ruleX([100], { stroke: "var(--limit)" }),
      Plot.text(rows, { x: 100, y: "label", text: words, dx: 6, textAnchor: "start", fill: "currentColor" }),
    ],
  });
  plot.setAttribute("aria-hidden", "true"); // the figure says what it shows
  const description = "Tolerances, the tightest first: " + rows.map((t) => `${t.label} ${words(t)}`).join("; ") + ".";
  return element("figure", { class: "tolerance-figure" },
    element("div", { role: "img", "aria-label": description }, plot));
}
