// SPDX-License-Identifier: GPL-3.0-or-later
// The plane of two parameters: where the limits are kept, the line det J = 0, the atlas, the path. Behind them is a
// proved map, or, where there is none, contours between samples on a grid.
import * as Plot from "@observablehq/plot";
import { clipped, outOfLimits, readField } from "./contours.js";
import { between, locate } from "./data.js";
import { key } from "./plots.js";
import { decimalsFor, element, fixed, symbol, text } from "./words.js";

const KINDS = [
  ["inside", "in C: all limits kept"],
  ["tension", "a tension out of limits"],
  ["length", "a length out of limits"],
  ["both", "both out of limits"],
];
/// Of a proved map, in the order in which they are drawn.
const AREAS = [
  ["inside", "inside: all limits kept (proved)"],
  ["tension", "a tension out of limits (proved)"],
  ["unbalanced", "some load can't be balanced (proved)"],
  ["length", "a length out of limits (proved)"],
  ["both", "tensions and lengths out of limits (proved)"],
  ["contact", "bodies are too near (proved)"],
  ["undecided", "undecided"],
  ["cut_off", "inside, but no motion from the start leads there (proved)"],
  ["singular", "encloses det J = 0"],
];
const MARGINS = { marginLeft: 58, marginRight: 16, marginTop: 12, marginBottom: 40 };
const WIDE = 900;
const BESIDE = { main: 560, detail: 400 }; // where there is an enlarged part beside it
const NARROW = 380;
const narrow = matchMedia("(max-width: 640px)");

function svg(name, attributes, ...children) {
  const result = document.createElementNS("http://www.w3.org/2000/svg", name);
  for (const [attribute, value] of Object.entries(attributes)) result.setAttribute(attribute, value);
  result.append(...children);
  return result;
}

const round = (x) => Math.round(x * 10) / 10;

function polyline(points, close = "") {
  let result = "";
  for (const [x, y] of points) result += `${result ? "L" : "M"}${round(x)} ${round(y)}`;
  return points.length > 0 ? result + close : "";
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

/// A grid of the data with its fields, and what they say of a cell: an index of KINDS.
function readGrid(grid) {
  if (grid.map) return grid;
  const tension = readField(grid.tension);
  const length = readField(grid.length);
  const determinant = readField(grid.det_J);
  const kind = (k) => (tension[k] > 0 ? 0 : 1) + (length[k] > 0 ? 0 : 2);
  const counts = [0, 0, 0, 0];
  tension.forEach((_, k) => ++counts[kind(k)]);
  return { ...grid, tension, length, determinant, kind, counts };
}

/// Ticks at round angles, which powers of ten are not.
function angleTicks([lower, upper], about) {
  const step = [1, 2, 5, 10, 15, 30, 45, 60, 90, 180, 360].find((s) => (upper - lower) / s <= about);
  if (!step || (upper - lower) / step < 2) return about;
  const first = Math.ceil(lower / step - 1e-9);
  const count = Math.floor(upper / step + 1e-9) - first + 1;
  return Array.from({ length: count }, (_, k) => (first + k) * step);
}

/// Orange stripes on blue, for where both kinds of limits are broken.
function hatching() {
  return svg("defs", {}, svg("pattern", {
    id: "plane-hatching", width: 8, height: 8, patternUnits: "userSpaceOnUse", patternTransform: "rotate(45)",
  }, svg("rect", { width: 8, height: 8, class: "tension" }), svg("rect", { width: 4, height: 8, class: "length" })));
}

let clips = 0;

/// The copies of a map that reach into a window: turns of periodic parameters, and (φ + π, −θ) for (φ, θ).
function images(map, window) {
  const turn = 2 * Math.PI;
  const turns = map.turns.map((isTurn) => (isTurn ? [-3, -2, -1, 0, 1, 2, 3] : [0]));
  const all = turns[0].flatMap((i) => turns[1].flatMap((j) => {
    const straight = { sign: [1, 1], offset: [i * turn, j * turn] };
    if (!map.flip) return [straight];
    const [phi, theta] = map.flip;
    const flipped = { sign: [1, 1], offset: [...straight.offset] };
    flipped.sign[theta] = -1;
    flipped.offset[phi] += Math.PI;
    return [straight, flipped];
  }));
  return all.filter(({ sign, offset }) => [0, 1].every((k) => {
    const ends = map.window[k].map((x) => sign[k] * x + offset[k]);
    const least = 1e-9 * (window[k][1] - window[k][0]);
    return Math.min(...ends) < window[k][1] - least && Math.max(...ends) > window[k][0] + least;
  }));
}

/// Stripes for areas that are drawn in units of a map, which `scale` brings to pixels.
function mapPatterns(prefix, scale) {
  const stripes = (kind, angle, ...parts) => svg("pattern", {
    id: `${prefix}-${kind}`, width: 8, height: 8, patternUnits: "userSpaceOnUse",
    patternTransform: `scale(${1 / scale[0]} ${1 / scale[1]}) rotate(${angle})`,
  }, ...parts);
  const all = { width: 8, height: 8 };
  const stripe = (height) => svg("rect", { width: 8, height, y: 3, class: "stripe" });
  return svg("defs", {},
    stripes("unbalanced", 0, svg("rect", { ...all, class: "tension" }), stripe(0.8)),
    stripes("both", 45, svg("rect", { ...all, class: "tension" }), svg("rect", { ...all, width: 4, class: "length" })),
    stripes("cut_off", 45, stripe(1.3)));
}

/// One map: the plane in the window of a grid. Of a detail, the path's ends are labelled there and not on the whole.
class PlaneMap {
  constructor(data, cursor, grid, width, { detail, isDetail = false } = {}) {
    Object.assign(this, { data, cursor, grid, width, detail, isDetail });
    const { plane } = data;
    this.window = grid.window.map((span, j) => span.map((x) => x * plane.axes[j].factor));
    const innerWidth = width - MARGINS.marginLeft - MARGINS.marginRight;
    this.height = Math.round((innerWidth * grid.rows) / grid.columns) + MARGINS.marginTop + MARGINS.marginBottom;
    const label = ({ name, unit }) => symbol(name) + (unit ? ` [${unit}]` : "");
    const axis = (j, ticks) => ({
      domain: this.window[j], label: label(plane.axes[j]), labelArrow: "none", labelAnchor: "center",
      ticks: plane.axes[j].unit === "°" ? angleTicks(this.window[j], ticks) : ticks, tickFormat: (x) => text(x),
    });
    this.svg = Plot.plot({
      width, height: this.height, ...MARGINS,
      style: "background: none; color: inherit; font-size: 12px;",
      x: axis(0, Math.round(width / 90)),
      y: axis(1, Math.max(3, Math.round(this.height / 60))),
      marks: [(index, scales) => this.draw(scales), Plot.frame({ stroke: "var(--soft)" })],
    });
    this.svg.setAttribute("aria-hidden", "true"); // the figure says what it shows
    this.marker = svg("circle", { class: "here", r: 6 });
    this.svg.append(this.marker);
  }

  /// From parameters to pixels.
  place([x, y]) {
    const [{ factor: u }, { factor: v }] = this.data.plane.axes;
    return [this.scales.x(x * u), this.scales.y(y * v)];
  }

  draw(scales) {
    this.scales = scales;
    const { data, grid } = this;
    const [[left, right], [bottom, top]] = grid.window;
    const [x0, y0] = this.place([left, top]);
    const [x1, y1] = this.place([right, bottom]);
    const frame = { x: x0, y: y0, width: x1 - x0, height: y1 - y0 };
    const id = `plane-clip-${++clips}`;
    const inFrame = svg("g", { class: "in-frame", "clip-path": `url(#${id})` });
    const group = svg("g", { class: "plane" },
      svg("defs", {}, svg("clipPath", { id }, svg("rect", frame))), hatching(), inFrame);
    const kinds = AREAS.map(([kind]) => kind);
    const determinant = grid.map ? undefined : this.drawFields(inFrame, frame);
    if (grid.map) this.drawAreas(inFrame, kinds.slice(0, -1));
    const charts = data.plane.charts.map((corners) => {
      const points = corners.flatMap((_, k) => (k % 2 ? [] : [[corners[k], corners[k + 1]]]));
      return polyline(clipped(points, grid.window).map((p) => this.place(p)), "Z");
    });
    inFrame.append(svg("path", { class: "chart", d: charts.join("") }));
    if (grid.map) this.drawAreas(inFrame, kinds.slice(-1));
    else inFrame.append(svg("path", { class: "singular", d: determinant }));
    if (this.detail) this.drawDetailFrame(inFrame);
    if (hasPathIn(data)) this.drawPath(inFrame, group);
    else this.drawEnds(group, data.plane.waypoints[0], data.plane.waypoints.at(-1));
    return group;
  }

  /// Some kinds of areas of the proved map.
  drawAreas(parent, kinds) {
    const { map, window } = this.grid;
    for (const { sign, offset } of images(map, window)) {
      const corner = (end) => this.place([0, 1].map((k) => sign[k] * map.window[k][end] + offset[k]));
      const [x0, y0] = corner(0);
      const [x1, y1] = corner(1);
      const scale = [(x1 - x0) / map.units, (y1 - y0) / map.units];
      const prefix = `plane-map-${++clips}`;
      const group = svg("g", { transform: `matrix(${scale[0]} 0 0 ${scale[1]} ${x0} ${y0})` },
        mapPatterns(prefix, scale));
      for (const kind of kinds) {
        if (!map.areas[kind]) continue;
        const path = svg("path", { class: `area ${kind}-area`, "data-kind": kind, d: map.areas[kind] });
        if (["unbalanced", "both", "cut_off"].includes(kind)) path.style.fill = `url(#${prefix}-${kind})`;
        group.append(path);
      }
      parent.append(group);
    }
  }

  /// What was sampled on a grid. Returns the contour of det J.
  drawFields(inFrame, frame) {
    const { grid } = this;
    const toPixels = ([c, r]) =>
      [frame.x + (c / grid.columns) * frame.width, frame.y + (r / grid.rows) * frame.height];
    const region = (field) =>
      outOfLimits(field, grid.columns, grid.rows).map((ring) => polyline(ring.map(toPixels), "Z")).join("");
    const tension = region(grid.tension);
    const length = region(grid.length);
    const both = region(grid.tension.map((x, k) => Math.max(x, grid.length[k])));
    inFrame.append(svg("rect", { class: "inside", ...frame }), svg("path", { class: "tension", d: tension }),
      svg("path", { class: "length", d: length }));
    if (both) inFrame.append(svg("path", { class: "hatched", d: both }));
    inFrame.append(svg("path", { class: "border", d: tension + length }));
    return region(grid.determinant);
  }

  drawDetailFrame(parent) {
    const [[left, right], [bottom, top]] = this.detail.window;
    const [x, y] = this.place([left, top]);
    const [x1, y1] = this.place([right, bottom]);
    parent.append(svg("rect", { class: "enlarged", x, y, width: x1 - x, height: y1 - y }));
  }

  drawPath(inFrame, group) {
    const { samples, plane, stretches, witness } = this.data;
    const way = polyline(piece(samples, 0, this.cursor.last).map((p) => this.place(p)));
    inFrame.append(svg("path", { class: "casing", d: way }), svg("path", { class: "path", d: way }));
    for (const s of stretches) {
      const d = polyline(piece(samples, s.from, s.to).map((p) => this.place(p)));
      inFrame.append(svg("path", { class: s.violated ? "violated" : "opening", d }));
    }
    if (this.detail) return; // which has the rest
    const dots = plane.waypoints.map((w) => this.place(w)).map(([cx, cy]) => svg("circle", { cx, cy, r: 2.4 }));
    inFrame.append(svg("g", { class: "waypoints" }, ...dots));
    this.drawEnds(group, ...[0, this.cursor.last].map((position) => piece(samples, position, position)[0]));
    for (const position of witness ? [witness.position, witness.to].filter((p) => p !== null) : []) {
      const [x, y] = this.place(piece(samples, position, position)[0]);
      group.append(svg("path", { class: "witness", transform: `translate(${x} ${y})`, d: "M-8 -8L8 8M-8 8L8 -8" }));
    }
  }

  drawEnds(group, start, goal) {
    const disc = (at, kind, letter) => {
      if (!at) return;
      const [cx, cy] = this.place(at);
      const words = svg("text", { class: "letter", x: cx, y: cy + 4 });
      words.textContent = letter;
      group.append(svg("g", { class: kind }, svg("circle", { cx, cy, r: 9 }), words));
    };
    if (this.data.segments > 0) disc(goal, "goal", "G");
    disc(start, "start", "S");
  }

  /// The point of the window under the pointer, as shares of its width and height from the left and from the top.
  pointed(event) {
    const box = this.svg.getBoundingClientRect();
    const px = ((event.clientX - box.left) / box.width) * this.width;
    const py = ((event.clientY - box.top) / box.height) * this.height;
    const u = (px - MARGINS.marginLeft) / (this.width - MARGINS.marginLeft - MARGINS.marginRight);
    const v = (py - MARGINS.marginTop) / (this.height - MARGINS.marginTop - MARGINS.marginBottom);
    return { px, py, u, v };
  }

  /// What is under the pointer, in words; nothing outside the frame.
  says(event) {
    const { u, v } = this.pointed(event);
    if (!(u >= 0 && u < 1 && v >= 0 && v < 1)) return undefined;
    const { grid, data: { plane } } = this;
    const cell = Math.floor(v * grid.rows) * grid.columns + Math.floor(u * grid.columns);
    const [x, y] = [u, 1 - v].map((share, j) => {
      const [lower, upper] = this.window[j];
      const { name, unit } = plane.axes[j];
      const space = unit && unit !== "°" ? " " : "";
      return `${symbol(name)} = ${fixed(lower + share * (upper - lower), decimalsFor(upper - lower))}${space}${unit}`;
    });
    if (!grid.map) return `${x}, ${y}: ${KINDS[grid.kind(cell)][1]}`;
    const kind = AREAS.find(([name]) => name === event.target.dataset?.kind);
    return kind ? `${x}, ${y}: ${kind[1]}` : `${x}, ${y}`;
  }

  /// The position of the path next to the pointer, if it is near.
  nearest(event) {
    const { px, py } = this.pointed(event);
    const { samples } = this.data;
    let best = 24;
    let nearest;
    samples.position.forEach((position, k) => {
      const [x, y] = this.place(samples.parameters.map((column) => column[k]));
      const distance = Math.hypot(x - px, y - py);
      if (distance < best) [best, nearest] = [distance, position];
    });
    return nearest;
  }

  show(position) {
    const [x, y] = this.place(piece(this.data.samples, position, position)[0]);
    this.marker.setAttribute("cx", x);
    this.marker.setAttribute("cy", y);
    this.marker.classList.add("shown");
  }
}

/// Whether the samples are of a path; of a plan that was not found they are of the query's waypoints.
function hasPathIn(data) {
  return data.is_found && data.samples.position.length > 0;
}

/// Of proved maps: the kinds of areas that there are.
function areaKeys(grids) {
  return AREAS.flatMap(([kind, words]) =>
    (grids.some(({ map }) => map.areas[kind]) ? [key(`fill key-area ${kind}-area`, words)] : []));
}

/// Of sampled fields.
function fieldKeys(grids) {
  const isThere = (kind) => grids.some((grid) => grid.counts[kind] > 0);
  const keys = KINDS.flatMap(([kind, words], k) => (isThere(k) ? [key(`fill ${kind}`, words)] : []));
  const isSingular = grids.some(({ determinant }) => determinant.some((x) => x > 0) && determinant.some((x) => x <= 0));
  return isSingular ? [...keys, key("singular", "det J = 0")] : keys;
}

/// What the colours are, and what they are not.
function sourceNote({ map }) {
  if (!map) {
    return "Borders and the line det J = 0 are drawn between samples on a grid, in floating point: they prove " +
      "nothing, and can miss what is smaller than the grid.";
  }
  const percent = (share) => `${(100 * share).toFixed(1)} %`;
  return `The colours are a map that this program has proved in interval arithmetic, in ${map.cells} cells: ` +
    `${percent(map.inside)} of the space is inside, ${percent(1 - map.inside - map.undecided)} outside, ` +
    `${percent(map.undecided)} undecided. No certificate states the map, so that taut-check has not confirmed it. ` +
    "Shares are of the parameters; red encloses det J = 0, but where lengths are out of limits.";
}

/// The legend: what is there, and nothing else.
function legendKeys(data, grids) {
  const { plane, samples, stretches, witness } = data;
  const keys = grids[0].map ? areaKeys(grids) : fieldKeys(grids);
  if (hasPathIn(data) && samples.position.length > 1) keys.push(key("path", "path, S to G"));
  else if (hasPathIn(data)) keys.push(element("span", { class: "key" }, "S: the pose"));
  else if (plane.waypoints.length > 0) keys.push(element("span", { class: "key" }, "S, G: what was asked for"));
  const charts = plane.charts.filter((corners) => clipped(
    corners.flatMap((_, k) => (k % 2 ? [] : [[corners[k], corners[k + 1]]])), grids[0].window).length > 0);
  if (charts.length > 0) keys.push(key("chart", `charts of the atlas (${plane.all_charts})`));
  if (witness) keys.push(key("witness", "witness"));
  if (stretches.some((s) => s.violated)) keys.push(key("violated", "violated"));
  if (stretches.some((s) => !s.violated)) keys.push(key("opening", "left open"));
  if (grids.length > 1) keys.push(key("enlarged", "enlarged part"));
  return keys;
}

export function planeFigure(data, cursor) {
  const { plane } = data;
  const hasPath = hasPathIn(data);
  const grid = readGrid(plane.grid);
  const detail = plane.detail ? readGrid(plane.detail) : undefined;
  const grids = detail ? [grid, detail] : [grid];
  const share = grid.map ? 100 * grid.map.inside : (100 * grid.counts[0]) / grid.tension.length;
  const [x, y] = plane.axes.map(({ name }) => symbol(name));
  const holder = element("div", {
    class: detail ? "maps with-detail" : "maps", role: "img",
    "aria-label": `The plane of ${x} and ${y}: ${grid.map ? "in" : "at"} ${text(share, 2)} % of ` +
      `${grid.map ? "the space all limits are kept, which is proved" : "the sampled places all limits are kept"}` +
      `${hasPath ? "; the path leads through it from S to G" : ""}.`,
  });
  const readout = element("span", { class: "readout" }, "");
  let maps = [];

  const show = (position) => maps.forEach((map) => map.show(position));
  const draw = () => {
    const widths = narrow.matches ? [NARROW, NARROW] : detail ? [BESIDE.main, BESIDE.detail] : [WIDE];
    maps = [new PlaneMap(data, cursor, grid, widths[0], { detail })];
    if (detail) maps.push(new PlaneMap(data, cursor, detail, widths[1], { isDetail: true }));
    holder.replaceChildren(...maps.map((map) => map.svg));
    for (const map of maps) {
      map.svg.addEventListener("pointermove", (event) => {
        readout.textContent = map.says(event) ?? readout.textContent;
      });
      map.svg.addEventListener("pointerdown", (event) => {
        const nearest = map.nearest(event);
        if (nearest !== undefined) cursor.position = nearest;
      });
    }
    if (hasPath && cursor.position !== undefined) show(cursor.position);
  };
  draw();
  narrow.addEventListener("change", draw);
  if (hasPath) cursor.onMove(show);
  return element("figure", { class: "plane-figure" }, holder,
    element("figcaption", {}, element("span", { class: "legend" }, ...legendKeys(data, grids)), readout,
      element("p", { class: "note source" }, sourceNote(grid))));
}
