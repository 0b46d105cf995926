// SPDX-License-Identifier: GPL-3.0-or-later
// Plots along the path: tensions, lengths, margins and pose, each a panel with one shared cursor.
import * as Plot from "@observablehq/plot";
import { between, extent, locate } from "./data.js";
import { atLeast, atMost, decimalsFor, degrees, element, fixed, fixedAtLeast, fixedAtMost, text } from "./words.js";

const NARROW = { width: 340, height: 210 };
const WIDE = { width: 520, height: 230 };
const MARGINS = { marginLeft: 54, marginRight: 42, marginTop: 10, marginBottom: 34 };

/// The limits and slightly more; up to half of their width beyond if the data go there.
function limitedDomain([lower, upper], data) {
  const width = upper - lower;
  const [least, greatest] = data ?? [lower, upper];
  return [
    Math.max(Math.min(lower - 0.1 * width, least - 0.04 * width), lower - 0.5 * width),
    Math.min(Math.max(upper + 0.1 * width, greatest + 0.04 * width), upper + 0.5 * width),
  ];
}

function paddedDomain(data) {
  const [least, greatest] = data ?? [0, 1];
  const pad = Math.max(0.06 * (greatest - least), 1e-3 * Math.max(Math.abs(greatest), Math.abs(least)), 1e-9);
  return [least - pad, greatest + pad];
}

/// Corners of steps from `lower` to `upper` over each box, with gaps where the boxes have gaps.
function steps(from, to, lower, upper, x) {
  const result = [];
  for (let k = 0; k < from.length; ++k) {
    if (k > 0 && from[k] > to[k - 1]) result.push({ x: x(to[k - 1]), lower: NaN, upper: NaN });
    const low = lower ? lower[k] : null;
    const high = upper ? upper[k] : null;
    result.push({ x: x(from[k]), lower: low ?? NaN, upper: high ?? NaN });
    result.push({ x: x(to[k]), lower: low ?? NaN, upper: high ?? NaN });
  }
  return result;
}

/// Rows of a curve, broken where det J changes sign, because tensions have a pole there.
function curve({ samples }, axis, ...columns) {
  const rows = [];
  samples.position.forEach((position, k) => {
    const broken = k > 0 && samples.sign[k] !== samples.sign[k - 1];
    if (broken) rows.push({ x: axis.values[k], y: columns.map(() => NaN) });
    rows.push({ x: axis.values[k], y: columns.map((column) => column[k] ?? NaN) });
  });
  return rows;
}

/// Where the path is not proved, and the witness: behind and before everything else.
function marks(data, axis, [bottom, top]) {
  const at = (position) => axis.at(position);
  const behind = Plot.rect(data.stretches, {
    x1: (s) => at(s.from),
    x2: (s) => at(s.to),
    y1: bottom,
    y2: top,
    fill: (s) => (s.violated ? "var(--mark)" : "var(--undecided)"),
    stroke: (s) => (s.violated ? "var(--mark)" : "var(--undecided)"),
    fillOpacity: 0.16,
    strokeOpacity: 0.5,
    strokeWidth: 1,
    clip: true,
  });
  const places = data.witness ? [data.witness.position, data.witness.to].filter((x) => x !== null) : [];
  const before = Plot.ruleX(places.map(at), {
    stroke: "var(--mark)", strokeWidth: 1.6, strokeDasharray: "3 3", clip: true,
  });
  return { behind, before };
}

function limitLines(limits) {
  return Plot.ruleY(limits, { stroke: "var(--limit)", strokeWidth: 1, strokeOpacity: 0.7, clip: true });
}

function beyondLimits([lower, upper], [bottom, top], [left, right], label) {
  return [
    Plot.rect([[bottom, lower], [upper, top]], {
      x1: left, x2: right, y1: (d) => d[0], y2: (d) => d[1], fill: "var(--forbidden)", clip: true,
    }),
    limitLines([lower, upper]),
    Plot.text([lower, upper], {
      x: right, y: (d) => d, text: label, dx: 4, textAnchor: "start", fill: "var(--limit)", clip: false,
    }),
  ];
}

/// A figure with its plot and a line that says what is at the cursor.
class Panel {
  /// draw: (axis) → marks; says: (where in the samples, position) → text at the cursor; rest: what is said of the whole
  /// path.
  constructor({ title, keys, description, rest, size = NARROW, domain, label, log = false, draw, says }) {
    Object.assign(this, { size, domain, label, log, draw, says, description });
    this.readout = element("span", { class: "readout" });
    this.holder = element("div", {
      class: "drawing", tabindex: "0", role: "img", "aria-label": `${description} Arrow keys move the cursor.`,
    });
    this.figure = element("figure", { class: "panel" },
      element("figcaption", {}, element("span", { class: "title" }, title), keys ?? "",
        rest ? element("span", { class: "range" }, rest) : "", this.readout), this.holder);
  }

  redraw(axis) {
    this.axis = axis;
    const across = extent(axis.values) ?? [0, 1];
    const plot = Plot.plot({
      ...this.size,
      ...MARGINS,
      style: "background: none; color: inherit;",
      x: { domain: across[0] < across[1] ? across : [across[0], across[0] + 1], label: axis.label, labelArrow: "none",
        labelAnchor: "center", ticks: 6, nice: false },
      y: { domain: this.domain, label: null, ticks: 5, type: this.log ? "log" : "linear", tickFormat: (y) => text(y),
        grid: true },
      marks: [...this.draw(axis, across), Plot.frame({ stroke: "var(--soft)", strokeOpacity: 0.7 })],
    });
    plot.setAttribute("aria-hidden", "true"); // the holder says what it shows
    this.scale = plot.scale("x");
    this.line = document.createElementNS("http://www.w3.org/2000/svg", "line");
    this.line.setAttribute("class", "cursor");
    this.line.setAttribute("y1", MARGINS.marginTop);
    this.line.setAttribute("y2", this.size.height - MARGINS.marginBottom);
    plot.append(this.line);
    const unit = document.createElementNS("http://www.w3.org/2000/svg", "text");
    unit.setAttribute("class", "unit");
    unit.setAttribute("transform", `translate(11 ${this.size.height / 2 - 12}) rotate(-90)`);
    unit.textContent = this.label;
    plot.append(unit);
    this.holder.replaceChildren(plot);
    this.svg = plot;
  }

  /// The position under the pointer.
  positionAt(event) {
    const box = this.svg.getBoundingClientRect();
    const x = ((event.clientX - box.left) / box.width) * this.size.width;
    return this.axis.position(this.scale.invert(x));
  }

  show(position, where) {
    const x = this.scale.apply(this.axis.at(position));
    this.line.setAttribute("x1", x);
    this.line.setAttribute("x2", x);
    this.line.classList.add("shown");
    this.readout.textContent = this.says(where, position);
  }
}

/// "0.08 to 0.42 N"
const span = (range, unit) => (range ? `${atMost(range[0])} to ${atLeast(range[1])} ${unit}` : "");

function bandAt(band, bands, position) {
  if (!bands || bands.from.length === 0) return undefined;
  const [k] = locate(bands.from, position);
  return position <= bands.to[k] ? [band.lower[k], band.upper[k]] : undefined;
}

const NEARNESS = { calm: "", near: "near limit", close: "close to limit", out: "out of limits" };

/// The range over the whole path, and whether it is proved or sampled; "" if nothing is known.
function wholeRange(data, { index, name, uses, unit, factor, limits }) {
  if (!uses) return "";
  const { is_proved: isProved } = data.cables;
  const signs = data.samples.sign;
  if (name === "tension" && data.witness?.kind === "singular") return "no bound: a singular pose is on the way";
  if (!isProved && name === "tension" && signs.some((sign) => sign !== signs[0])) {
    return "no bound: det J = 0 on the way (sampled)";
  }
  const range = uses.ranges[index].map((x) => x * factor);
  if (isProved) return `proved ${span(range, unit)}`;
  // Towards the limits, as on the first page.
  const [least, greatest] = range.map((x, end) => (x > limits[end] ? atMost : atLeast)(x));
  return least === greatest ? `sampled ${least} ${unit}` : `sampled ${least} to ${greatest} ${unit}`;
}

/// `cable`: low, middle, high: samples; limits and band in the shown unit; domain: of all six.
function cablePanel(data, cable) {
  const { index, name, unit, limits, low, middle, high, band, domain, uses } = cable;
  const [bottom, top] = limits;
  const decimals = decimalsFor(top - bottom);
  const isBand = low !== high;
  const range = wholeRange(data, cable);
  const nearness = uses ? uses.nearness[index] : "calm";
  const colour = `var(--${nearness})`;
  const violated = data.witness && data.witness.cable === index + 1 && data.witness.kind.startsWith(name);
  const noun = { tension: "Tension", length: "Length" }[name];
  return new Panel({
    title: `Cable ${index + 1}`,
    keys: NEARNESS[nearness] ? element("span", { class: `nearness ${nearness}` }, NEARNESS[nearness]) : undefined,
    rest: range,
    description:
      `${noun} of cable ${index + 1} along the move: ` +
      `${range ? `${range}, ` : ""}limits ${text(bottom)} and ${text(top)} ${unit}.` +
      (violated ? " It is proved to be out of its limits." : ""),
    domain,
    label: `${name} [${unit}]`,
    draw: (axis, across) => {
      const { behind, before } = marks(data, axis, domain);
      const rows = curve(data, axis, low, middle, high);
      const drawn = [...beyondLimits(limits, domain, across, (d) => text(d)), behind];
      if (band) {
        drawn.push(Plot.areaY(steps(data.bands.from, data.bands.to, band.lower, band.upper, axis.at), {
          x: "x", y1: "lower", y2: "upper", fill: "var(--band)", clip: true,
        }));
      }
      if (isBand) {
        drawn.push(Plot.areaY(rows, {
          x: "x", y1: (d) => d.y[0], y2: (d) => d.y[2], fill: colour, fillOpacity: 0.28, clip: true,
        }));
      }
      drawn.push(Plot.lineY(rows, { x: "x", y: (d) => d.y[1], stroke: colour, strokeWidth: 1.8, clip: true }));
      if (rows.length === 1) { // a single pose has no line
        if (isBand) {
          drawn.push(Plot.ruleX(rows, {
            x: "x", y1: (d) => d.y[0], y2: (d) => d.y[2], stroke: colour, strokeWidth: 5, strokeOpacity: 0.5,
            clip: true,
          }));
        }
        drawn.push(Plot.dot(rows, { x: "x", y: (d) => d.y[1], fill: colour, r: 3, clip: true }));
      }
      drawn.push(before);
      return drawn;
    },
    says: (where, position) => {
      const at = fixed(between(middle, where), decimals);
      const found = band && bandAt(band, data.bands, position);
      const spread = found
        ? ` (proved ${fixedAtMost(found[0], decimals)} to ${fixedAtLeast(found[1], decimals)})`
        : isBand ? ` (${fixed(between(low, where), decimals)} to ${fixed(between(high, where), decimals)})` : "";
      return `here ${at}${spread} ${unit}`;
    },
  });
}

/// The panels of six cables on one scale, those nearest to their limits first.
function cablePanels(data, { name, unit: { name: unit, factor }, limits, columns, bands }) {
  const uses = data.cables?.[name];
  const scaled = (list) => list.map((x) => (x === null ? NaN : x * factor));
  const cables = limits.map((pair, index) => {
    const band = bands && { lower: scaled(bands[index].lower), upper: scaled(bands[index].upper) };
    return { index, name, unit, factor, uses, limits: pair.map((x) => x * factor), band, ...columns(index) };
  });
  const all = cables.flatMap(({ low, high, band }) => [low, high, ...(band ? [band.lower, band.upper] : [])]);
  const domain = limitedDomain(extent(...cables.map((cable) => cable.limits)), extent(...all));
  const order = uses?.order ?? cables.map(({ index }) => index);
  return order.map((index) => cablePanel(data, { ...cables[index], domain }));
}

export function tensionPanels(data) {
  const { samples, forceUnit: unit, bands } = data;
  return cablePanels(data, {
    name: "tension", unit, limits: data.robot.tension, bands: bands?.from.length ? bands.tension : undefined,
    columns: (i) => {
      const middle = samples.tension[i].map((x) => (x ?? NaN) * unit.factor);
      const low = middle.map((f, k) => f - samples.tension_below[i][k] * unit.factor);
      const high = middle.map((f, k) => f + samples.tension_above[i][k] * unit.factor);
      return { low, middle, high };
    },
  });
}

export function lengthPanels(data) {
  const { samples, lengthUnit: unit, bands } = data;
  return cablePanels(data, {
    name: "length", unit, limits: data.robot.length, bands: bands?.from.length ? bands.length : undefined,
    columns: (i) => {
      const middle = samples.length[i].map((x) => (x === null ? NaN : x * unit.factor));
      return { low: middle, middle, high: middle };
    },
  });
}

const RATES = {
  winch_speed: { title: "speed", label: "speed", unit: (length) => `${length}/s`, isSigned: true },
  winch_acceleration: {
    title: "acceleration",
    label: "acceleration",
    unit: (length) => `${length}/s²`,
    isSigned: true,
  },
  winch_power: { title: "power", label: "power", unit: () => "kW", factor: 1e-3, isSigned: false },
};

/// What the six winches do during a move in time, on one scale: samples, and limits where they are stated.
export function winchPanels(data, kind) {
  const rate = RATES[kind];
  const { limits, values } = data.winches[kind];
  const factor = rate.factor ?? data.lengthUnit.factor;
  const unit = rate.unit(data.lengthUnit.name);
  const scaled = values.map((column) => column.map((x) => (x === null ? NaN : x * factor)));
  const stated = limits.map((limit) => (limit === null ? undefined : limit * factor));
  const bounds = stated.filter((limit) => limit !== undefined);
  const range = extent(...scaled, bounds, rate.isSigned ? bounds.map((x) => -x) : [0]);
  return scaled.map((column, index) =>
    winchPanel(data, { index, rate, unit, column, limit: stated[index], domain: paddedDomain(range) }));
}

function winchPanel(data, { index, rate, unit, column, limit, domain }) {
  const range = extent(column) ?? [0, 0];
  const size = Math.max(Math.abs(range[0]), Math.abs(range[1]));
  const isKept = limit === undefined || size < limit;
  const shown = isKept ? atLeast(size) : atMost(size);
  const limits = limit === undefined ? undefined : [rate.isSigned ? -limit : domain[0], limit];
  const decimals = decimalsFor(domain[1] - domain[0]);
  const colour = isKept ? "var(--calm)" : "var(--out)";
  return new Panel({
    title: `Cable ${index + 1}`,
    keys: isKept ? undefined : element("span", { class: "nearness out" }, NEARNESS.out),
    rest: `sampled, at most ${shown} ${unit}`,
    description: `Winch of cable ${index + 1}, ${rate.title} during the move: sampled, at most ${shown} ${unit}` +
      `${limit === undefined ? "" : `; limit ${text(limit)} ${unit}`}.`,
    domain,
    label: `${rate.label} [${unit}]`,
    draw: (axis, across) => {
      const { behind, before } = marks(data, axis, domain);
      const rows = axis.values.map((x, k) => ({ x, y: column[k] }));
      return [
        ...(limits ? beyondLimits(limits, domain, across, (d) => (d === domain[0] ? "" : text(d))) : []),
        behind,
        Plot.lineY(rows, { x: "x", y: "y", stroke: colour, strokeWidth: 1.8, clip: true }),
        before,
      ];
    },
    says: (where) => `here ${fixed(between(column, where), decimals)} ${unit}`,
  });
}

/// The least distance of any cable from its nearer limit, from samples.
function leastReserve(data, low, high, limits) {
  return data.samples.position.map((_, k) => {
    let least = Infinity;
    for (let i = 0; i < 6; ++i) {
      const reserve = Math.min(low(i, k) - limits[i][0], limits[i][1] - high(i, k));
      if (!(reserve >= least)) least = reserve;
    }
    return least;
  });
}

export function marginPanels(data) {
  const { samples, robot, margins, lengthUnit, forceUnit } = data;
  const number = (x) => x ?? NaN;
  const tension = leastReserve(data, (i, k) => number(samples.tension[i][k]) - number(samples.tension_below[i][k]),
    (i, k) => number(samples.tension[i][k]) + number(samples.tension_above[i][k]), robot.tension)
    .map((x) => x * forceUnit.factor);
  const length = leastReserve(data, (i, k) => number(samples.length[i][k]), (i, k) => number(samples.length[i][k]),
    robot.length).map((x) => x * lengthUnit.factor);
  const scaled = (list, { factor }) => list.map((x) => (x === null ? null : x * factor));
  return [
    marginPanel(data, "Tension", forceUnit.name, scaled(margins.tension_N, forceUnit), tension, 0),
    marginPanel(data, "Length", lengthUnit.name, scaled(margins.length_m, lengthUnit), length, 0),
    // Of a move in time it is not claimed.
    ...(margins.wrench_scale
      ? [marginPanel(data, "Load: wrench_scale", "×", margins.wrench_scale, samples.wrench_scale.map(number), 1)] : []),
  ];
}

/// What is left of all clearances, and the distances of the pairs that come nearest.
export function clearancePanels(data) {
  const { margins, lengthUnit: { name: unit, factor }, bodies: { nearest, pairs } } = data;
  const scale = (list) => list.map((x) => (x === null || x === undefined ? NaN : x * factor));
  const left = scale(nearest.distance.map((d, k) => d - nearest.clearance[k]));
  const proved = (margins.clearance_m ?? []).map((x) => (x === null ? null : x * factor));
  return [
    marginPanel(data, "Left of all clearances", unit, proved, left, 0),
    ...pairs.map((pair) => pairPanel(data, pair.name, scale(pair.distance), scale(pair.clearance))),
  ];
}

function pairPanel(data, name, distance, clearance) {
  const unit = data.lengthUnit.name;
  const range = extent(distance) ?? [0, 1];
  const asked = extent(clearance) ?? [0, 0];  // one number but where the two may touch
  const domain = paddedDomain([Math.min(range[0], asked[0], 0), Math.max(range[1], asked[1])]);
  const decimals = decimalsFor(domain[1] - domain[0]);
  return new Panel({
    title: name,
    rest: `sampled, at least ${text(range[0], 3)} ${unit}`,
    description: `Distance of ${name} along the move: sampled, at least ${text(range[0], 3)} ${unit}; clearance ` +
      `${asked[0] < asked[1] ? `from ${text(asked[0])} to ` : ""}${text(asked[1])} ${unit}.`,
    domain,
    label: `apart [${unit}]`,
    draw: (axis, across) => {
      const { behind, before } = marks(data, axis, domain);
      return [
        Plot.areaY(axis.values.map((x, k) => ({ x, y: clearance[k] ?? NaN })), {
          x: "x", y1: domain[0], y2: "y", curve: "step", fill: "var(--forbidden)", clip: true,
        }),
        limitLines([...new Set(clearance)]), behind,
        Plot.lineY(axis.values.map((x, k) => ({ x, y: distance[k] ?? NaN })), {
          x: "x", y: "y", stroke: "var(--calm)", strokeWidth: 1.8, clip: true,
        }),
        before,
      ];
    },
    says: (where) => `here ${fixed(between(distance, where), decimals)} ${unit}`,
  });
}

/// Proved lower bounds as steps, the sampled margin as a line; the claim needs more than `needed`.
function marginPanel(data, title, unit, proved, sampled, needed) {
  const all = extent(proved, sampled);
  const provedSpan = extent(proved);
  const positive = extent(proved, sampled.filter((x) => x > 0));
  const log = Boolean(all && all[0] > 0 && positive[1] / positive[0] > 30);
  const domain = log ? [positive[0] / 1.5, positive[1] * 1.5]
    : [Math.min(needed, all ? Math.max(all[0], needed - (all[1] - needed)) : needed),
      all ? all[1] + 0.08 * (all[1] - needed) : 1];
  if (!(domain[1] > domain[0])) domain[1] = domain[0] + 1;
  return new Panel({
    title,
    rest: provedSpan
      ? `${data.verdict === "proved" ? "" : "where proved, "}at least ${atMost(provedSpan[0])} ${unit}` : "",
    description: `${title} margin along the move: ` +
      (provedSpan ? `proved to be at least ${atMost(provedSpan[0])} ${unit}; it has to exceed ${needed}.`
        : "not proved."),
    domain,
    log,
    label: unit === "×" ? "factor" : `margin [${unit}]`,
    draw: (axis, across) => {
      const { behind, before } = marks(data, axis, domain);
      const floor = domain[0];
      const starts = proved.map((x) => (x === null ? null : log ? floor : needed));
      const bounds = steps(data.margins.from, data.margins.to, starts, proved, axis.at);
      const drawn = [behind];
      if (!log && floor < needed) {
        drawn.push(Plot.rect([0], {
          x1: across[0], x2: across[1], y1: floor, y2: needed, fill: "var(--forbidden)", clip: true,
        }));
      }
      drawn.push(
        Plot.areaY(bounds, { x: "x", y1: "lower", y2: "upper", fill: "var(--band)", clip: true }),
        Plot.lineY(bounds, { x: "x", y: "upper", stroke: "var(--curve)", strokeWidth: 1.6, clip: true }),
        Plot.lineY(curve(data, axis, sampled), {
          x: "x", y: (d) => (log && !(d.y[0] > 0) ? NaN : d.y[0]), stroke: "var(--c1)", strokeWidth: 1.2,
          strokeDasharray: "5 3", clip: true,
        }));
      if (!log) drawn.push(limitLines([needed]));
      return [...drawn, before];
    },
    says: (where, position) => {
      const [k] = locate(data.margins.from, position);
      const bound = proved[k];
      return (bound === null || bound === undefined ? "" : `proved ≥ ${atMost(bound)} ${unit}; `) +
        `sampled ${text(between(sampled, where), 3)} ${unit}`;
    },
  });
}

export function posePanels(data) {
  const { name: unit, factor } = data.lengthUnit;
  const make = (title, names, label, columns) => {
    const range = extent(...columns);
    const decimals = decimalsFor(range ? range[1] - range[0] : 0);
    const keys = element("span", { class: "keys" });
    names.forEach((name, c) => keys.append(key(`curve c${c}`, name)));
    return new Panel({
      title,
      keys,
      rest: "",
      size: WIDE,
      description: `${title} along the move: ` +
        names.map((name, c) => `${name} ${span(extent(columns[c]), label)}`).join(", ") + ".",
      domain: paddedDomain(range),
      label: `[${label}]`,
      draw: (axis) => {
        const { behind, before } = marks(data, axis, paddedDomain(range));
        const rows = axis.values.map((x, k) => ({ x, y: columns.map((column) => column[k] ?? NaN) }));
        const dashes = [undefined, "6 3", "2 2.5"];
        return [behind, ...columns.map((_, c) => Plot.lineY(rows, {
          x: "x", y: (d) => d.y[c], stroke: ["var(--curve)", "var(--c1)", "var(--c2)"][c], strokeWidth: 1.6,
          strokeDasharray: dashes[c], clip: true,
        })), before];
      },
      says: (where) =>
        names.map((name, c) => `${name} ${fixed(between(columns[c], where), decimals)}`).join(", ") + ` ${label}`,
    });
  };
  const scaled = (columns, f) => columns.map((column) => column.map((x) => (x === null ? NaN : f(x))));
  return [
    make("Position", ["px", "py", "pz"], unit, scaled(data.samples.p, (x) => x * factor)),
    make("Orientation", data.samples.angle_names, "°", scaled(data.samples.angles, degrees)),
  ];
}

/// A line of a legend.
export function key(kind, words) {
  const svg = document.createElementNS("http://www.w3.org/2000/svg", "svg");
  svg.setAttribute("viewBox", "0 0 24 10");
  svg.setAttribute("aria-hidden", "true");
  const path = document.createElementNS("http://www.w3.org/2000/svg", "path");
  path.setAttribute("class", kind);
  path.setAttribute("d", kind.startsWith("fill ") ? "M0 0H24V10H0Z" : "M0 5H24");
  svg.append(path);
  return element("span", { class: "key" }, svg, words);
}

export function legend(...keys) {
  return element("p", { class: "legend" }, ...keys.map(([kind, words]) => key(kind, words)));
}

/// Panels that share a cursor: pointing at one, or arrow keys on it, moves all of them.
export function connect(panels, cursor, samples) {
  for (const panel of panels) {
    const point = (event) => {
      cursor.position = panel.positionAt(event);
    };
    panel.holder.addEventListener("pointermove", point);
    panel.holder.addEventListener("pointerdown", point);
    panel.holder.addEventListener("keydown", (event) => {
      const step = { ArrowLeft: -1, ArrowRight: 1, PageDown: -10, PageUp: 10 }[event.key];
      if (step === undefined) return;
      event.preventDefault();
      const x = panel.axis.at(cursor.position ?? 0);
      const [left, right] = extent(panel.axis.values) ?? [0, 0];
      cursor.position = panel.axis.position(x + (step * (right - left)) / 100);
    });
  }
  cursor.onMove((position) => {
    const where = locate(samples.position, position);
    for (const panel of panels) panel.show(position, where);
  });
}
