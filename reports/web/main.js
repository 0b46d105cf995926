// SPDX-License-Identifier: GPL-3.0-or-later
// The script that the report's page runs in the reader's browser. It draws the plots and the robot into the places that
// the page has for them. Without it the page has its words, its tables and a still picture of the robot.
import { axes as usefulAxes } from "./axes.js";
import { barPlayer, closeMenuAfterUse } from "./bar.js";
import { onThemeChange } from "./colours.js";
import { Cursor } from "./cursor.js";
import { isDrawable, readData } from "./data.js";
import { planeFigure } from "./plane.js";
import { Player } from "./player.js";
import {
  clearancePanels, connect, legend, lengthPanels, marginPanels, posePanels, tensionPanels, winchPanels,
} from "./plots.js";
import { watchScrolling } from "./scrolling.js";
import style from "./style.css";
import { toleranceFigure } from "./tolerances.js";
import { element } from "./words.js";
import { makeViewer } from "./viewer.js";

const data = readData();
const cursor = new Cursor(Math.max(data.segments, 0));
const axes = usefulAxes(data);
const root = document.documentElement;
const place = (name) => document.querySelector(`[data-plot="${name}"]`);

document.head.append(element("style", {}, style));
root.classList.add("scripted");
watchScrolling();
closeMenuAfterUse(document.querySelector(".bar details"));

/// A stretch is violated at its first and its last named pose; nothing is claimed of those between.
const VIOLATED = data.reached === null ? "proved violations, open between them"
  : "violations, proved of poses in the stated tubes, open between them";
const marked = [
  ...(data.stretches.some((s) => s.violated) ? [["fill violated-stretch", VIOLATED]] : []),
  ...(data.stretches.some((s) => !s.violated) ? [["fill open-stretch", "left open"]] : []),
  ...(data.witness ? [["mark", data.witness.to === null ? "the witness" : "the two poses of the witness"]] : []),
];
const enclosed = data.bands && data.bands.from.length > 0;
const enclosure = ["fill band", "proved enclosure"];
const envelopeKeys = [
  ...(enclosed ? [enclosure] : []),
  ["fill envelope", "f₀ ± v, all loads in K (sampled)"],
  ["calm-line", "f₀, the centre load (sampled)"],
];
const limitKeys = [["limit", "limit"], ["fill forbidden", "beyond the limits"]];

const PATH_KEYS = {
  proved: [["proved-line", "path of the platform’s origin, proved"]],
  refuted: [
    ["proved-line", "path of the platform’s origin, where it is proved"],
    ["unknown-line", data.reached === null ? "where nothing is said of it"
      : "where it is not proved that the move goes there"],
  ],
  undecided: [["unknown-line", "path of the platform’s origin"]],
  unchecked: [["unknown-line", "path of the platform’s origin"]],
};

const panels = [];
let axis = axes[0];

/// They answer as soon as they are drawn.
function panelsAt(name, make, keys) {
  const holder = place(name);
  if (!holder || data.samples.position.length === 0) return;
  const made = make(data);
  panels.push(...made);
  for (const panel of made) panel.redraw(axis);
  const layout = made.length === 2 ? "panels two" : "panels";
  holder.append(legend(...keys, ...marked), element("div", { class: layout }, ...made.map((panel) => panel.figure)));
  connect(made, cursor, data.samples);
  if (cursor.position !== undefined) cursor.position = cursor.position;
  if (panels.length === made.length) offerAxes();
}

function redraw(chosen) {
  axis = chosen;
  for (const panel of panels) panel.redraw(axis);
  if (cursor.position !== undefined) cursor.position = cursor.position;
}

/// The choice of what the horizontal axes count, above the first of the plots.
function offerAxes() {
  if (axes.length < 2) return;
  const words = { time: "time", distance: "distance", turned: "angle turned", segment: "segments" };
  const choice = element("fieldset", { class: "axis-choice" }, element("legend", {}, "Plots along"));
  axes.forEach((offered, k) => {
    const input = element("input", { type: "radio", name: "axis", value: offered.name });
    input.checked = k === 0;
    input.addEventListener("change", () => redraw(offered));
    choice.append(element("label", {}, input, ` ${words[offered.name]}`));
  });
  document.querySelector("[data-plot] .panels").closest("[data-plot]").prepend(choice);
}

const stage = element("div", {
  class: "stage", tabindex: "0", role: "img",
  "aria-label": "The machine in three dimensions. Drag, or use the arrow keys, to look from elsewhere; Ctrl and the " +
    "wheel, or plus and minus, to come nearer; space to play.",
});
let player;
let viewer;

/// What is beside and below the robot, and room for it. The robot itself takes as long as all plots, and comes last.
function furnishMove() {
  const holder = place("move");
  if (!holder || data.samples.position.length === 0) return;
  const scene = element("div", { class: "scene" }, stage); // and beside it, what is in it in numbers
  holder.append(scene);
  if (data.is_found) {
    player = new Player(data, cursor, axes);
    scene.append(player.controls, player.readout.element);
    if (data.segments > 0) place("bar")?.append(barPlayer(player, cursor, axes));
    else player.controls.replaceChildren(); // a single pose: there is nothing to play
  }
  root.classList.toggle("has-viewer", isDrawable(data));
}

function drawRobot() {
  if (!stage.isConnected) return;
  const holder = place("move");
  viewer = isDrawable(data) ? makeViewer(stage, data) : undefined;
  root.classList.toggle("has-viewer", Boolean(viewer));
  if (!viewer) {
    stage.remove();
    holder.append(element("p", { class: "note" }, isDrawable(data)
      ? "This browser shows no three-dimensional pictures (WebGL); the still pictures stand in."
      : "The machine's numbers are too large, too small or too far from its origin to be drawn."));
    return;
  }
  stage.before(views());
  if (data.verdict === "refuted" && data.witness && cursor.position === undefined) {
    cursor.position = data.witness.position;
  }
  if (cursor.position !== undefined) viewer.show(cursor.position);
  cursor.onMove((position) => viewer.show(position));
  onThemeChange(() => viewer.setTheme());
  stage.addEventListener("keydown", (event) => {
    const turn = { ArrowLeft: [-0.1, 0], ArrowRight: [0.1, 0], ArrowUp: [0, 0.1], ArrowDown: [0, -0.1],
      "+": [0, 0, 0.87], "-": [0, 0, 1.15] }[event.key];
    if (turn) viewer.orbit(...turn);
    else if (event.key === " " && player && data.segments > 0) player.toggle();
    else return;
    event.preventDefault();
  });
  explainPicture(holder);
}

/// Buttons for the directions from which people draw machines, and for the place that matters most.
function views() {
  const group = element("div", { class: "views", role: "group", "aria-label": "Views" });
  const offer = (words, onClick) => {
    const button = element("button", { type: "button" }, words);
    button.addEventListener("click", onClick);
    group.append(button);
  };
  offer("Oblique", () => viewer.resetView());
  offer("Front", () => viewer.look(0, 0));
  offer("Side", () => viewer.look(Math.PI / 2, 0));
  offer("Top", () => viewer.look(0, Math.PI / 2));
  if (data.worst !== null && data.is_found) {
    offer("Worst place", () => {
      player.stop();
      cursor.position = data.worst;
      viewer.resetView();
    });
  }
  return group;
}

/// What colours and lines mean.
function explainPicture(holder) {
  const cables = [["calm-cable", "cable, calm"], ["near-cable", "from 75 % of a limit"],
    ["close-cable", "from 95 %"], ["out-cable", "out of its limits (!)"]];
  const path = [...PATH_KEYS[data.verdict],
    ...(data.stretches.some((s) => s.violated) ? [["violated", VIOLATED]] : []),
    ...(data.stretches.some((s) => !s.violated) ? [["opening", "left open"]] : []),
    ["load-line", "path of the load point"],
    ...(data.tube_m !== null && !viewer.tubeIsThin ? [["fill tube", "where the origin may be"]] : []),
    ...(data.worst !== null ? [["fill worst-dot", data.witness ? "the witness" : "worst place"]] : []),
    ...(data.witness ? [["fill witness-pose", "platform at the witness"]] : [])];
  if (Object.keys(data.decoration).length > 0) cables.push(["fill shown", "drawn only, not checked"]);
  if (data.bodies) {
    const listed = (shapes) => shapes.slice(0, 4).map(({ name }) => name).join(", ") +
      (shapes.length > 4 ? ` and ${shapes.length - 4} more` : "");
    for (const [kind, words, shapes] of [
      ["obstacle", "obstacles", data.bodies.shapes.filter((shape) => shape.is_obstacle)],
      ["carried", "on the platform", data.bodies.shapes.filter((shape) => !shape.is_obstacle)]]) {
      if (shapes.length > 0) cables.push([`fill ${kind}`, `${words}: ${listed(shapes)} (checked)`]);
    }
    if (viewer.bodies.link) cables.push(["apart", "the pair that is nearest to its clearance"]);
  }
  if (data.weights.length > 0) cables.push(["fill weight", "centre of gravity of a weight"]);
  const ends = ["ghost-line", "platform at the start (S) and at the goal (G)"];
  holder.append(legend(...(data.is_found ? [...cables, ends, ...path] : [ends])));
  const note = (...words) => holder.append(element("p", { class: "note" }, ...words));
  if (!data.is_found) note("No path was found: only the start and the goal are shown.");
  else {
    const ground = data.decoration.frame ? "The ground stands" : "Posts and ground stand";
    note("Colours are of this place, in floating point, by the limit that is nearer: of tension over all loads, or " +
      `of length. ${ground} for whatever carries the anchors; the grid is level.`);
  }
  if (viewer.bodies?.cablesAreThin) {
    note("Cables are checked with their diameters, which are too thin to be seen here.");
  }
  if (data.tube_m === null || !data.is_found) return;
  const size = `${data.tube_m * data.lengthUnit.factor} ${data.lengthUnit.name}`;
  note(viewer.tubeIsThin
    ? `The origin may be up to ${size} from the path: too little to be seen at this scale.`
    : `The tube around the path, to scale: the origin may be up to ${size} from it.`);
}

// One after the other, so that the page answers between them; and none before the words and tables are on the screen.
const jobs = [
  furnishMove,
  () => panelsAt("tensions", tensionPanels, [...envelopeKeys, ...limitKeys]),
  () => performance.mark("interactive"), // of what is read first; the rest answers as it is drawn
  () => panelsAt("lengths", lengthPanels,
    [...(enclosed ? [enclosure] : []), ["calm-line", "length (sampled)"], ...limitKeys]),
  ...Object.keys(data.winches ?? {}).map((kind) => () =>
    panelsAt(kind, (all) => winchPanels(all, kind), [["calm-line", "sampled"], ...limitKeys])),
  () => data.bodies && panelsAt("clearances", clearancePanels, [
    ...(data.margins.from.length > 0 ? [["curve", "proved lower bound of each segment"]] : []),
    ["dashed", "sampled, of all pairs"], ["calm-line", "distance of a pair (sampled)"],
    ["limit", "clearance"], ["fill forbidden", "nearer than the clearance"]]),
  () => data.margins.from.length > 0 &&
    panelsAt("margins", marginPanels, [["curve", "proved lower bound of each segment"], ["dashed", "sampled"]]),
  () => panelsAt("pose", posePanels, []),
  () => data.plane && place("plane")?.append(planeFigure(data, cursor)),
  () => data.tolerances.length > 0 && place("tolerances")?.append(toleranceFigure(data)),
  drawRobot,
  watchScrolling, // what was drawn meanwhile
];

/// Whether there is more to do.
function step() {
  jobs.shift()?.();
  if (jobs.length > 0) return true;
  if (!root.classList.contains("drawn")) {
    root.classList.add("drawn");
    performance.mark("drawn");
  }
  return false;
}

function drawAll() {
  if (step()) setTimeout(drawAll);
}

const LONGEST_BLANK = 1000; // [ms]
let isBegun = false;
function begin() {
  if (isBegun) return;
  isBegun = true;
  performance.mark("readable");
  drawAll();
}
// After the first picture of the page, or without one, where nobody looks.
if (globalThis.PerformanceObserver?.supportedEntryTypes?.includes("paint")) {
  new PerformanceObserver((seen) => {
    // The first paint may be of the background alone.
    if (seen.getEntriesByName("first-contentful-paint").length > 0) begin();
  }).observe({ type: "paint", buffered: true });
}
setTimeout(begin, LONGEST_BLANK);
addEventListener("beforeprint", () => {
  while (step());
});
