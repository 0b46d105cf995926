// SPDX-License-Identifier: GPL-3.0-or-later
// Signed fields on a grid of cells, as plane.cc packs them, and the regions where they are not positive.
import { contours } from "d3-contour";

/// The field of a text of contour_text() (reports/page/plane.h): right in sign in every cell, and in size, up to a
/// common factor, where a contour at zero depends on it.
export function readField(text) {
  const values = [];
  for (const [, count, letter] of text.matchAll(/(\d*)([A-Za-z])/g)) {
    const isPositive = letter < "a";
    const level = letter.charCodeAt(0) - (isPositive ? 65 : 97);
    const value = (isPositive ? 1 : -1) * 10 ** (0.16 * (level - 25));
    for (let k = Number(count || 1); k > 0; --k) values.push(value);
  }
  return values;
}

/// The border of the region where the field is not positive: closed rings, holes included, of points [column, row] in
/// cells, 0 and `columns` being the grid's edges. They run at the zeros of the linear interpolation between the cells'
/// centres and, where the region goes on to an edge, beyond it.
export function outOfLimits(field, columns, rows) {
  const { coordinates } = contours().size([columns, rows]).contour(field.map((x) => -x), 0);
  const beyond = (x, end) => (x <= 0 ? -1 : x >= end ? end + 1 : x);
  return coordinates.flat().map((ring) => ring.map(([x, y]) => [beyond(x, columns), beyond(y, rows)]));
}

/// The part of a convex or simple polygon that is in a box [[left, right], [bottom, top]]; empty if there is none.
export function clipped(polygon, box) {
  let points = polygon;
  box.forEach((limits, c) => limits.forEach((limit, isUpper) => {
    const inside = (p) => (isUpper ? p[c] <= limit : p[c] >= limit);
    const crossing = (p, q) => {
      const t = (limit - p[c]) / (q[c] - p[c]);
      return p.map((x, k) => (k === c ? limit : x + t * (q[k] - x)));
    };
    points = points.flatMap((p, k) => {
      const q = points[(k + 1) % points.length];
      const kept = inside(p) ? [p] : [];
      return inside(p) === inside(q) ? kept : [...kept, crossing(p, q)];
    });
  }));
  return points;
}
