// SPDX-License-Identifier: GPL-3.0-or-later
// The controls below the robot: play, scrub, step through segments; and the numbers at the cursor.
import { nearestPair } from "./bodies.js";
import { between, locate, status } from "./data.js";
import { decimalsFor, degrees, element, fixed, text } from "./words.js";

const STATUS = {
  proved: "proved here",
  open: "left open here",
  violated: "violations are proved at both ends of this stretch, between them it is open",
  unknown: "",
};

const IMPLIED_VIOLATION = "violations are proved of poses in the tubes of this stretch";

/// The clock of playing: seconds if the path has times, else how far the robot moves and turns, so that it neither
/// races nor stands still.
function pace(data) {
  const { position, time, distance, turned } = data.samples;
  if (time.length > 0) return { values: time, seconds: time[time.length - 1] - time[0] };
  const reach = Math.max(...data.robot.platform.map((b) => Math.hypot(...b)), 1e-9);
  const moved = position.map((_, k) => distance[k] / reach + turned[k]);
  return { values: moved[moved.length - 1] > 0 ? moved : position, seconds: undefined };
}

/// A bar between two limits with a range on it.
class Meter {
  constructor() {
    this.range = element("span", { class: "range" });
    this.tick = element("span", { class: "tick" });
    this.bar = element("span", { class: "meter", "aria-hidden": "true" }, this.range, this.tick);
  }

  show(low, at, high, [lower, upper]) {
    const share = (x) => Math.min(Math.max(((x - lower) / (upper - lower)) * 100, 0), 100) || 0;
    this.range.style.left = `${share(low)}%`;
    this.range.style.width = `${Math.max(share(high) - share(low), 0)}%`;
    this.tick.style.left = `${share(at)}%`;
    const out = !(low > lower && high < upper);
    this.bar.classList.toggle("out", out);
    return out;
  }
}

class Readout {
  constructor(data) {
    this.data = data;
    this.where = element("p", { class: "where" });
    this.pose = element("p", { class: "pose" });
    this.bodies = element("p", { class: "bodies" });
    this.rows = data.robot.tension.map((_, i) => {
      const row = { tension: element("td", { class: "n" }), length: element("td", { class: "n" }),
        f: new Meter(), d: new Meter(), flag: element("td", { class: "flag" }) };
      row.element = element("tr", {}, element("th", { scope: "row" }, String(i + 1)), row.tension,
        element("td", {}, row.f.bar), row.length, element("td", {}, row.d.bar), row.flag);
      return row;
    });
    const head = (words, attributes = {}) => element("th", { scope: "col", ...attributes }, words);
    this.element = element("div", { class: "readout-table" }, this.where, this.pose,
      ...(data.bodies?.nearest.pair.length > 0 ? [this.bodies] : []),
      element("table", {},
        element("caption", {}, "Cables at this place, and where that is between their limits (floating point)"),
        element("thead", {}, element("tr", {}, head("Cable"), head(`Tension [${data.forceUnit.name}]`, { colspan: 2 }),
          head(`Length [${data.lengthUnit.name}]`, { colspan: 2 }), element("td"))),
        element("tbody", {}, ...this.rows.map((row) => row.element))));
  }

  show(position, axes) {
    const { samples, robot, lengthUnit, forceUnit, segments } = this.data;
    const where = locate(samples.position, position);
    const segment = Math.min(Math.floor(position), Math.max(segments - 1, 0));
    const says = axes.filter((axis) => axis.name !== "segment").map((axis) => axis.says(position));
    const kind = status(this.data, position);
    const state = kind === "violated" && this.data.reached !== null ? IMPLIED_VIOLATION : STATUS[kind];
    const at = `Segment ${segment}, s = ${fixed(position - segment, 3)}`;
    this.where.textContent = [at, ...says, state].filter(Boolean).join(" · ");
    const places = decimalsFor(1e-2 * lengthUnit.factor);
    const p = samples.p.map((column) => fixed(between(column, where) * lengthUnit.factor, places));
    const angles = samples.angles.map((column) => fixed(degrees(between(column, where)), 2));
    const names = samples.angle_names.join(", ");
    this.pose.textContent =
      `p = (${p.join(", ")}) ${lengthUnit.name}; ${names} = ${angles.map((a) => `${a}°`).join(", ")}`;
    this.showBodies(where);
    this.rows.forEach((row, i) => {
      const f = between(samples.tension[i], where) * forceUnit.factor;
      const low = f - between(samples.tension_below[i], where) * forceUnit.factor;
      const high = f + between(samples.tension_above[i], where) * forceUnit.factor;
      const d = between(samples.length[i], where) * lengthUnit.factor;
      const [lower, upper] = robot.tension[i].map((x) => x * forceUnit.factor);
      const decimals = decimalsFor(upper - lower);
      row.tension.textContent = `${fixed(low, decimals)} to ${fixed(high, decimals)}`;
      row.length.textContent = fixed(d, decimalsFor((robot.length[i][1] - robot.length[i][0]) * lengthUnit.factor));
      const limits = robot.length[i].map((x) => x * lengthUnit.factor);
      const slackOrOver = row.f.show(low, f, high, [lower, upper]);
      const tooLong = row.d.show(d, d, d, limits);
      row.flag.textContent = slackOrOver || tooLong ? "out" : "";
    });
  }

  /// The pair that is nearest to its clearance here.
  showBodies(where) {
    const { bodies, lengthUnit: { name: unit, factor } } = this.data;
    if (!bodies || bodies.nearest.pair.length === 0) return;
    const { name, distance, clearance, isCone } = nearestPair(bodies, where);
    const size = `${text(Math.abs(distance) * factor, 3)} ${unit}`;
    const apart = isCone ? `${size} ${distance < 0 ? "outside" : "inside"}`
      : distance < 0 ? `in each other, about ${size} deep` : `${size} apart`;
    const allowed = clearance < 0 ? `may be ${text(-clearance * factor)} ${unit} deep here`
      : `clearance ${text(clearance * factor)} ${unit}`;
    const asked = isCone ? "it has to be inside" : allowed;
    this.bodies.textContent = `Nearest bodies: ${name}, ${apart} (${asked})`;
    this.bodies.className = `bodies ${distance > clearance ? "" : "out"}`;
  }
}

export class Player {
  constructor(data, cursor, axes) {
    Object.assign(this, { data, cursor, axes });
    this.pace = pace(data);
    this.playing = false;
    this.play = element("button", { type: "button", class: "play" }, "▶ Play");
    this.previous = element("button", { type: "button", "aria-label": "Previous segment" }, "◀ Segment");
    this.next = element("button", { type: "button", "aria-label": "Next segment" }, "Segment ▶");
    this.slider = element("input", {
      type: "range", min: 0, max: 1000, step: 1, value: 0, "aria-label": "Place along the move",
    });
    this.duration = element("select", { "aria-label": "Duration of the whole move when played" });
    const offer = (seconds, words) => this.duration.append(element("option", { value: seconds }, words));
    if (this.pace.seconds > 0) offer(this.pace.seconds, `as timed (${text(this.pace.seconds, 3)} s)`);
    for (const seconds of [10, 5, 20, 60]) offer(seconds, `whole move in ${seconds} s`);
    this.readout = new Readout(data);
    this.controls = element("div", { class: "player controls", role: "group", "aria-label": "Playing the move" },
      this.play, this.previous, this.track(this.slider), this.next, this.duration);

    this.play.addEventListener("click", () => this.toggle());
    this.slider.addEventListener("input", () => {
      this.stop();
      this.goTo(Number(this.slider.value) / 1000);
    });
    this.previous.addEventListener("click", () => this.step(-1));
    this.next.addEventListener("click", () => this.step(1));
    cursor.onMove((position) => this.show(position));
    this.show(cursor.position ?? 0);
  }

  /// A slider, with a mark at the worst place.
  track(slider) {
    const track = element("span", { class: "track" }, slider);
    const { worst, witness } = this.data;
    if (worst === null) return track;
    const words = witness ? "the witness" : "worst place";
    const mark = element("span", { class: "worst-mark", title: words, "aria-hidden": "true" });
    mark.style.setProperty("--share", this.shareOf(worst).toFixed(4));
    track.append(mark);
    return track;
  }

  /// 0 at the start of the move, 1 at its end.
  get share() {
    return this.shareOf(this.cursor.position ?? 0);
  }

  shareOf(position) {
    const { values } = this.pace;
    const [first, last] = [values[0], values[values.length - 1]];
    const at = between(values, locate(this.data.samples.position, position));
    return last > first ? (at - first) / (last - first) : 0;
  }

  goTo(share) {
    const { values } = this.pace;
    const value = values[0] + share * (values[values.length - 1] - values[0]);
    this.cursor.position = share >= 1 ? this.cursor.last : between(this.data.samples.position, locate(values, value));
  }

  /// Steps to the next end of a segment, forward or backward.
  step(direction) {
    this.stop();
    const position = this.cursor.position ?? 0;
    this.cursor.position = direction > 0 ? Math.floor(position + 1e-9) + 1 : Math.ceil(position - 1e-9) - 1;
  }

  toggle() {
    if (this.playing) {
      this.stop();
      return;
    }
    this.playing = true;
    this.play.textContent = "❚❚ Pause";
    this.onPlaying?.(true);
    if (this.share >= 1) this.goTo(0);
    let last = performance.now();
    // The clock runs on while the platform stands still, unless somebody points at another place.
    let share = this.share;
    let position = this.cursor.position;
    const frame = (now) => {
      if (!this.playing) return;
      if (this.cursor.position !== position) share = this.share;
      share += (now - last) / 1000 / Number(this.duration.value);
      last = now;
      this.goTo(Math.min(share, 1));
      position = this.cursor.position;
      if (share >= 1) this.stop();
      else requestAnimationFrame(frame);
    };
    requestAnimationFrame(frame);
  }

  stop() {
    this.playing = false;
    this.play.textContent = "▶ Play";
    this.onPlaying?.(false);
  }

  show(position) {
    this.slider.value = String(Math.round(this.share * 1000));
    this.slider.setAttribute("aria-valuetext", this.axes[0].says(position));
    this.readout.show(position, this.axes);
  }
}
