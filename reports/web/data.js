// SPDX-License-Identifier: GPL-3.0-or-later
// The report's data, as report_data.cc writes them into the page. Units are SI and radians. Columns are lists of
// numbers, with null for missing ones.
//
//   verdict     "unchecked" if it is not known; then none of the certificate's claims is in here
//   segments, is_spline
//   units       length, force: name and factor of the units that are shown
//   robot       base, platform: six points; load_point; force (of w0, in the world); tension, length: six pairs of
//               limits
//   samples     columns along the path, floating point: position (in segments: 3.5 is the middle of segment 3),
//               distance, turned, time (may be empty), p (3), q (4: x y z w), angles (3, or 1), angle_names,
//               length (6), tension (6: f0), force (3, of w0; none where it is robot's all along), tension_below,
//               tension_above (6 each), wrench_scale, sign (of det J), parameters (2, if there is a plane)
//   bands       proved ranges, or null: from, to (positions), tension and length: six times lower and upper
//   margins     proved, for groups of consecutive segments: from, to, tension_N, length_m, wrench_scale
//               where there are bodies also clearance_m: how much farther than its clearance every pair is apart
//               wrench_scale is missing of a move in time, as is what samples have of it
//   winches     of a move in time, else null: winch_speed, winch_acceleration and, where it is limited, winch_power;
//               each limits (six, or null where none is stated) and values (six columns, as samples)
//   bodies      null, or shapes: name, is_obstacle (in the world; else on the platform, in its axes), and points and
//               radius (all within it of their convex hull), or plane (four corners of what is shown of a half-space),
//               or corners and triangles; box: corners of a box around it. cable_radius, free_ends (six pairs: at the
//               base, at the platform), has_cables (whether they are checked); nearest: of the pair with the least left
//               at each sample its number, distance (below 0: how deep), clearance (below 0: how deep they may be),
//               cone (1: a cable and its exit cone), and points of either (3 columns each); names of pairs by their
//               numbers; pairs: those that come nearest, name, clearance and distance (columns)
//   stretches   the parts of the path that are not proved: from, to, violated (else open)
//   witness     position, to, kind, cable; or null
//   weights     centres of gravity of the load's weights, in the axes of the platform
//   decoration  bodies that are only shown: frame (in the world) and payload (in the axes of the platform), each with
//               corners and triangles (flat lists), if the case has them
//   is_found    whether there is a path; else the samples are of the query's waypoints
//   worst       position of the place that the pictures show first; or null
//   view        of all pictures: across and up (axes of the picture when seen from the front, in the world), azimuth
//               and elevation; ground (its height along up), step, columns and rows of its grid; load (its words);
//               or null if the machine can't be drawn
//   tube_m      how far the platform's origin may be from the path; or null
//   reached     where poses are implied: up to which position the move is proved to pass what is proved; else null
//   tolerances  what, words, used: the stated one in percent of what it alone could be
//   cables      of the whole path, or null: is_proved (else sampled), tension and length: ranges (six pairs), nearness
//               (six words, as nearness.h has them), order (the cables' indices, the nearest to its limits first)
//   plane       of two parameters, or null: axes (name, unit, factor to it), grid and detail (or null) with window,
//               columns, rows, map (or null), and without a map three fields as contour_text() packs them: tension,
//               length, det_J; charts, all_charts, waypoints. A map (plane_map.h) has its window, turns, flip (or
//               null), areas by kind (paths of SVG in whole units, of which `units` are as long as an axis), cells,
//               and of the window the shares inside and undecided

export function readData() {
  const data = JSON.parse(document.getElementById("data").textContent);
  data.lengthUnit = data.units.length;
  data.forceUnit = data.units.force;
  return data;
}

const finite = (x) => typeof x === "number" && Number.isFinite(x);

/// Whether the data contain all that a picture of the robot needs.
export function isDrawable({ robot, samples, view }) {
  const numbers = [robot.base, robot.platform, [robot.load_point], samples.p, samples.q].flat(2);
  return view !== null && samples.position.length > 0 && numbers.every((x) => finite(x) && Math.abs(x) < 1e15);
}

/// The least and greatest of the finite numbers; nothing if there is none.
export function extent(...lists) {
  let least = Infinity;
  let greatest = -Infinity;
  for (const list of lists) {
    for (const x of list) {
      if (!finite(x)) continue;
      if (x < least) least = x;
      if (x > greatest) greatest = x;
    }
  }
  return least <= greatest ? [least, greatest] : undefined;
}

/// The place of `x` in an ascending list: the index before it and the fraction of the way to the next.
export function locate(list, x) {
  let low = 0;
  let high = list.length - 1;
  if (!(x > list[0])) return [0, 0];
  if (x >= list[high]) return [high, 0];
  while (high - low > 1) {
    const mid = (low + high) >> 1;
    if (list[mid] <= x) low = mid;
    else high = mid;
  }
  return [low, (x - list[low]) / (list[high] - list[low])];
}

/// The points of a curve, leaving out those within `least` of the point before.
export function spaced(points, least) {
  const kept = [];
  for (const p of points) if (kept.length === 0 || p.distanceTo(kept[kept.length - 1]) > least) kept.push(p);
  return kept;
}

/// A column interpolated between its entries; NaN next to a missing one.
export function between(list, [k, t]) {
  const a = list[k] ?? NaN;
  return t === 0 ? a : a + t * ((list[k + 1] ?? NaN) - a);
}

/// The state at a position: "proved", "open", "violated", or "unknown" if nothing is claimed of the move there.
export function status(data, position) {
  if (data.verdict === "unchecked") return "unknown";
  for (const { from, to, violated } of data.stretches) {
    if (position >= from && position <= to) return violated ? "violated" : "open";
  }
  if (data.verdict === "proved") return "proved";
  if (data.reached !== null && position > data.reached) return "unknown";
  const bands = data.bands;
  if (!bands || bands.from.length === 0) return "unknown";
  const [k] = locate(bands.from, position);
  return position >= bands.from[k] && position <= bands.to[k] ? "proved" : "unknown";
}
