// Which tolerance bites: how much of what each alone could be is used up by what is stated.
import * as Plot from "@observablehq/plot";
import { degrees, element, text } from "./words.js";

const NAMES = {
  base_anchors: "base anchors",
  platform_anchors: "platform anchors",
  load_point: "load point",
  load: "load",
  position: "position",
  orientation: "orientation",
  cable_length: "cable length",
};

function shown(x, unit) {
  if (unit === "m") return `${text(x * 1000, 3)} mm`;
  if (unit === "rad") return `${text(degrees(x), 3)}°`;
  return `${text(x, 3)} ${unit === "N, N m" ? "N or N·m" : unit}`;
}

export function toleranceFigure(data) {
  const rows = data.tolerances
    .map((t) => ({ ...t, label: NAMES[t.name] ?? t.name, used: t.proved > 0 ? (100 * t.stated) / t.proved : 0 }))
    .sort((a, b) => b.used - a.used);
  const words = (t) => t.stated > 0 ? `${shown(t.stated, t.unit)} of ${shown(t.proved, t.unit)}`
    : `none stated; ${shown(t.proved, t.unit)} would do`;
  const plot = Plot.plot({
    width: 700,
    height: 46 + 26 * rows.length,
    marginLeft: 112,
    marginRight: 170,
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
  return element("figure", { class: "tolerance-figure" }, element("div", { role: "img", "aria-label": description }, plot));
}
