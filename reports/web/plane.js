// SPDX-License-Identifier: GPL-3.0-or-later
// The plane of two parameters: where the limits are kept, the line det J = 0, the atlas, the path.
import * as Plot from "@observablehq/plot";
import { between, locate } from "./data.js";
import { key } from "./plots.js";
import { element, fixed, text } from "./words.js";

const KINDS = [
  ["inside", "in C: all limits kept"],
  ["tension", "a tension out of limits"],
  ["length", "a length out of limits"],
  ["both", "both out of limits"],
];
const MARGINS = { marginLeft: 56, marginRight: 16, marginTop: 12, marginBottom: 40 };
const WIDTH = 900;

function svg(name, attributes, ...children) {
  const result = document.createElementNS("http://www.w3.org/2000/svg", name);
  for (const [attribute, value] of Object.entries(attributes)) result.setAttribute(attribute, value);
  result.append(...children);
  return result;
}

/// Runs of equal cells, row by row, as one path a kind; in units of a cell.
function cellPaths({ rows, columns, cells }) {
  const paths = ["", "", "", ""];
  for (let row = 0; row < rows; ++row) {
    for (let column = 0; column < columns; ) {
      const kind = cells[row * columns + column];
      let end = column + 1;
      while (end < columns && cells[row * columns + end] === kind) ++end;
      paths[Number(kind)] += `M${column} ${row}h${end - column}v1h${column - end}z`;
      column = end;
    }
  }
  return paths;
}

const round = (x) => Math.round(x * 10) / 10;

function polyline(points, close = "") {
  let result = "";
  for (const [x, y] of points) result += `${result ? "L" : "M"}${round(x)} ${round(y)}`;
  return result + close;
}

/// Points of the path between two positions, ends included.
function piece({ position, parameters }, from, to) {
  const at = (p) => parameters.map((column) => between(column, locate(position, p)));
  const inner = [];
  position.forEach((p, k) => {
    if (p > from && p < to) inner.push(parameters.map((column) => column[k]));
  });
  return [at(from), ...inner, at(to)];
}

export function planeFigure(data, cursor) {
  const { plane, samples, stretches, witness } = data;
  const [[left, right], [bottom, top]] = plane.window;
  const innerWidth = WIDTH - MARGINS.marginLeft - MARGINS.marginRight;
  const height = Math.round((innerWidth * plane.rows) / plane.columns) + MARGINS.marginTop + MARGINS.marginBottom;
  const label = (j) => plane.names[j] + (plane.units[j] ? ` [${plane.units[j]}]` : "");
  const hasPath = samples.position.length > 0;
  let place; // from parameters to pixels

  const drawing = (index, scales, values, { width }) => {
    place = ([x, y]) => [scales.x(x), scales.y(y)];
    const [x0, y0] = place([left, top]);
    const [x1, y1] = place([right, bottom]);
    const group = svg("g", { class: "plane" });
    const raster = svg("g", {
      class: "raster",
      transform: `translate(${x0} ${y0}) scale(${(x1 - x0) / plane.columns} ${(y1 - y0) / plane.rows})`,
    });
    cellPaths(plane).forEach((d, kind) => raster.append(svg("path", { class: KINDS[kind][0], d })));
    const clip = svg("svg", {
      x: x0, y: y0, width: x1 - x0, height: y1 - y0, viewBox: `${x0} ${y0} ${x1 - x0} ${y1 - y0}`,
    });
    const pairs = (list) => list.flatMap((_, k) => (k % 2 ? [] : [place([list[k], list[k + 1]])]));
    const charts = plane.charts.map((corners) => polyline(pairs(corners), "Z"));
    clip.append(svg("path", { class: "chart", d: charts.join("") }));
    let locus = "";
    for (let k = 0; k < plane.singular.length; k += 4) locus += polyline(pairs(plane.singular.slice(k, k + 4)));
    clip.append(svg("path", { class: "singular", d: locus }));
    group.append(raster, clip);
    if (!hasPath) return group;
    const way = polyline(piece(samples, 0, cursor.last).map(place));
    clip.append(svg("path", { class: "casing", d: way }), svg("path", { class: "path", d: way }));
    for (const s of stretches) {
      const d = polyline(piece(samples, s.from, s.to).map(place));
      clip.append(svg("path", { class: s.violated ? "violated" : "opening", d }));
    }
    const dots = plane.waypoints.map((w) => place(w)).map(([cx, cy]) => svg("circle", { cx, cy, r: 2.4 }));
    clip.append(svg("g", { class: "waypoints" }, ...dots));
    const disc = (position, kind, letter) => {
      const [cx, cy] = place(piece(samples, position, position)[0]);
      const words = svg("text", { class: "letter", x: cx, y: cy + 4 });
      words.textContent = letter;
      group.append(svg("g", { class: kind }, svg("circle", { cx, cy, r: 9 }), words));
    };
    disc(cursor.last, "goal", "G");
    disc(0, "start", "S");
    for (const position of witness ? [witness.position, witness.to].filter((p) => p !== null) : []) {
      const [x, y] = place(piece(samples, position, position)[0]);
      group.append(svg("path", { class: "witness", transform: `translate(${x} ${y})`, d: "M-8 -8L8 8M-8 8L8 -8" }));
    }
    return group;
  };

  const plot = Plot.plot({
    width: WIDTH,
    height,
    ...MARGINS,
    style: "background: none; color: inherit; font-size: 12px;",
    x: { domain: [left, right], label: label(0), labelArrow: "none", labelAnchor: "center", ticks: 9 },
    y: { domain: [bottom, top], label: label(1), labelArrow: "none", labelAnchor: "center", ticks: 7 },
    marks: [drawing, Plot.frame({ stroke: "var(--soft)" })],
  });
  plot.setAttribute("aria-hidden", "true"); // the figure says what it shows
  const shares = KINDS.map((_, kind) => plane.cells.split(String(kind)).length - 1);
  const description = `The plane of ${plane.names[0]} and ${plane.names[1]}: ` +
    `${text((100 * shares[0]) / plane.cells.length, 2)} % of what is shown ` +
    `keeps all limits${hasPath ? "; the path leads through it from S to G" : ""}.`;
  const marker = svg("circle", { class: "here", r: 6 });
  plot.append(marker);
  cursor.onMove((position) => {
    const [x, y] = place(piece(samples, position, position)[0]);
    marker.setAttribute("cx", x);
    marker.setAttribute("cy", y);
    marker.classList.add("shown");
  });

  const readout = element("span", { class: "readout" }, "");
  const pointed = (event) => {
    const box = plot.getBoundingClientRect();
    const px = ((event.clientX - box.left) / box.width) * WIDTH;
    const py = ((event.clientY - box.top) / box.height) * height;
    return [px, py];
  };
  plot.addEventListener("pointermove", (event) => {
    const [px, py] = pointed(event);
    const u = (px - MARGINS.marginLeft) / innerWidth;
    const v = (py - MARGINS.marginTop) / (height - MARGINS.marginTop - MARGINS.marginBottom);
    if (u < 0 || u >= 1 || v < 0 || v >= 1) return;
    const kind = plane.cells[Math.floor(v * plane.rows) * plane.columns + Math.floor(u * plane.columns)];
    readout.textContent =
      `${plane.names[0]} = ${fixed(left + u * (right - left), 3)}, ` +
      `${plane.names[1]} = ${fixed(top - v * (top - bottom), 3)}: ${KINDS[Number(kind)][1]}`;
  });
  plot.addEventListener("pointerdown", (event) => {
    if (!hasPath) return;
    const [px, py] = pointed(event);
    let best = Infinity;
    let nearest = 0;
    samples.position.forEach((position, k) => {
      const [x, y] = place(samples.parameters.map((column) => column[k]));
      const distance = Math.hypot(x - px, y - py);
      if (distance < best) [best, nearest] = [distance, position];
    });
    if (best < 24) cursor.position = nearest;
  });

  const keys = KINDS.map(([kind, words]) => key(`fill ${kind}`, words));
  keys.push(key("singular", "det J = 0"));
  if (hasPath) keys.push(key("path", "path, S to G"));
  if (plane.charts.length > 0) keys.push(key("chart", `charts of the atlas (${plane.all_charts})`));
  if (witness) keys.push(key("witness", "witness"));
  if (stretches.some((s) => s.violated)) keys.push(key("violated", "violated"));
  if (stretches.some((s) => !s.violated)) keys.push(key("opening", "left open"));
  return element("figure", { class: "plane-figure" }, element("div", { role: "img", "aria-label": description }, plot),
    element("figcaption", {}, element("span", { class: "legend" }, ...keys), readout));
}
