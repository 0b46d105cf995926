// SPDX-License-Identifier: GPL-3.0-or-later
// What is written over the picture of the machine: numbers of cables, names of anchors, load, scale and axes.
import { element, text } from "./words.js";

const APART = 21; // [px] between the middles of numbers
const PLACES = [0.42, 0.5, 0.34, 0.58, 0.28, 0.66, 0.74, 0.2];
const NS = "http://www.w3.org/2000/svg";

const svg = (name, attributes, ...children) => {
  const result = document.createElementNS(NS, name);
  for (const [key, value] of Object.entries(attributes)) result.setAttribute(key, value);
  result.append(...children);
  return result;
};

/// The greatest of 1, 2 and 5 times a power of ten that is not above `most`.
export function roundLength(most) {
  const power = 10 ** Math.floor(Math.log10(most));
  return [5, 2, 1].find((step) => step * power <= most * (1 + 1e-9)) * power;
}

export class Overlay {
  /// @param anchors [{name, at}], points in the scene  @param marks the same: start, goal, worst place
  /// @param bodies [{name, kind}]
  constructor(data, anchors, marks, bodies) {
    const span = (kind, words) => element("span", { class: kind }, words);
    this.data = data;
    this.anchors = anchors.map(({ name, at }) => ({ at, tag: span("name", name) }));
    this.marks = marks.map(({ name, at, kind }) => ({ at, tag: span(`mark-name ${kind ?? ""}`, name) }));
    this.bodies = bodies.map(({ name, kind }) => span(`body-name ${kind}`, name));
    this.pointed = span("pointed", "");
    this.load = span("load-words", data.view.load);
    this.cables = data.robot.base.map((_, i) => ({ tag: span("cable calm", String(i + 1)), at: PLACES[0] }));
    this.bar = element("div", { class: "scale-bar" });
    this.axes = ["x", "y", "z"].map((name) => ({
      line: svg("path", { class: `axis ${name}` }), name: svg("text", {}, name),
    }));
    this.triad = svg("svg", { class: "triad", viewBox: "-38 -38 76 76" },
      ...this.axes.flatMap(({ line, name }) => [line, name]));
    // In the order of the cables first.
    this.element = element("div", { class: "labels", "aria-hidden": "true" },
      ...[...this.cables, ...this.anchors, ...this.marks].map(({ tag }) => tag), ...this.bodies, this.load, this.bar,
      this.triad, this.pointed);
  }

  /// @param project from a point of the scene to pixels  @param lines [[from, to]] of the cables, points in the scene
  /// @param tip of the load's arrow, or undefined  @param pixels of a metre  @param directions of the axes, in pixels
  /// @param bodies where their names stand, points in the scene
  update({ project, lines, tip, pixels, directions, width, bodies }) {
    const taken = [];
    const put = (tag, [x, y]) => {
      tag.style.transform = `translate(-50%, -50%) translate(${x.toFixed(1)}px, ${y.toFixed(1)}px)`;
      taken.push([x, y, tag.textContent.length > 3 ? 15 : 0]);
    };
    for (const { at, tag } of this.anchors) {
      const [x, y] = project(at);
      put(tag, [x, y - 15]);
    }
    for (const { at, tag } of this.marks) {
      const [x, y] = project(at);
      put(tag, [x, y - 13]);
    }
    this.bodies.forEach((tag, i) => {
      const at = project(bodies[i]);
      // Of names that would cover each other the first is shown.
      const isFree = taken.every(([u, v, w]) => Math.max(Math.abs(at[0] - u) - w, Math.abs(at[1] - v)) > 15);
      tag.style.display = isFree ? "" : "none";
      if (isFree) put(tag, at);
    });
    this.load.style.display = tip ? "" : "none";
    if (tip) {
      const [x, y] = project(tip);
      const half = this.load.offsetWidth / 2 + 14;
      put(this.load, [x + half + 8 > width ? x - half : x + half, y - 4]);
    }
    lines.forEach(([from, to], i) => {
      const cable = this.cables[i];
      const [a, b] = [project(from), project(to)];
      const at = (t) => [a[0] + t * (b[0] - a[0]), a[1] + t * (b[1] - a[1])];
      const room = (t) => {
        const [x, y] = at(t);
        return Math.min(...taken.map(([u, v, w]) => Math.max(Math.abs(x - u) - w, Math.abs(y - v))), APART);
      };
      // It stays where it was as long as there is room, so that numbers don't jump.
      const places = [cable.at, ...PLACES];
      cable.at = places.find((t) => room(t) >= APART) ??
        places.reduce((best, t) => (room(t) > room(best) ? t : best));
      put(cable.tag, at(cable.at));
    });
    this.scale(pixels, width);
    this.axes.forEach(({ line, name }, c) => {
      const [x, y] = directions[c].map((v) => 24 * v);
      const size = Math.hypot(x, y);
      line.setAttribute("d", `M0 0L${x.toFixed(1)} ${y.toFixed(1)}`);
      const out = size > 5 ? 1 + 8 / size : 0;
      name.setAttribute("x", (out ? out * x : 8).toFixed(1));
      name.setAttribute("y", ((out ? out * y : -8) + 4).toFixed(1));
    });
  }

  /// The numbers go back to where they are put first.
  reset() {
    for (const cable of this.cables) cable.at = PLACES[0];
  }

  scale(pixels, width) {
    const { lengthUnit } = this.data;
    const length = roundLength((0.22 * width) / pixels);
    if (!Number.isFinite(length)) return;
    this.bar.style.width = `${(length * pixels).toFixed(1)}px`;
    const words = `${text(length * lengthUnit.factor)} ${lengthUnit.name}`;
    if (this.bar.textContent !== words) this.bar.textContent = words;
  }
}
