// SPDX-License-Identifier: GPL-3.0-or-later
// The critical uncertainties: each as it is stated, as a share of what it alone could be.
import * as Plot from "@observablehq/plot";
import { element } from "./words.js";

export function toleranceFigure(data) {
  const rows = [...data.tolerances].sort((a, b) => b.used - a.used);
  const plot = Plot.plot({
    width: 750,
    height: 46 + 26 * rows.length,
    marginLeft: 150,
    marginRight: 240,
    marginBottom: 36,
    style: "background: none; color: inherit;",
    x: { domain: [0, 100], label: "stated, as a share of what is proved to be possible alone [%]", labelArrow: "none",
      labelAnchor: "center", grid: true, ticks: 5 },
    y: { domain: rows.map((t) => t.what), label: null },
    marks: [
      Plot.barX(rows, { x: "used", y: "what", fill: "var(--curve)", insetTop: 3, insetBottom: 3, clip: true }),
      Plot.ruleX([0], { stroke: "var(--soft)" }),
      Plot.ruleX([100], { stroke: "var(--limit)" }),
      Plot.text(rows, { x: 100, y: "what", text: "words", dx: 6, textAnchor: "start", fill: "currentColor" }),
    ],
  });
  plot.setAttribute("aria-hidden", "true"); // the figure says what it shows
  const description = "Uncertainties, the tightest first: " + rows.map((t) => `${t.what}: ${t.words}`).join("; ") + ".";
  return element("figure", { class: "tolerance-figure" },
    element("div", { role: "img", "aria-label": description }, plot));
}
