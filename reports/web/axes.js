// SPDX-License-Identifier: GPL-3.0-or-later
// The quantity on the plots' horizontal axis: segments, metres, degrees or seconds into the move.
import { between, locate } from "./data.js";
import { degrees, text } from "./words.js";

/// The axes that suit this path, the best first.
export function axes(data) {
  const { position, distance, turned, time } = data.samples;
  const make = (name, label, words, values) => ({
    name,
    label,
    values,
    /// From a position in segments to a value on the axis, and back.
    at: (p) => between(values, locate(position, p)),
    position: (x) => between(position, locate(values, x)),
    says: (p) => words(text(between(values, locate(position, p)))),
  });
  const all = [
    make("time", "time [s]", (x) => `${x} s`, time),
    make("distance", "distance of the platform’s origin into the move [m]", (x) => `${x} m moved`, distance),
    make("turned", "angle that the platform has turned [°]", (x) => `${x}° turned`, turned.map(degrees)),
    make("segment", "segment", (x) => `segment ${x}`, position),
  ];
  const useful = all.filter(({ values }) => values.length > 1 && values[values.length - 1] > values[0]);
  if (useful.length === 0) return [all[3]];
  // An axis on which the robot stands still for some of the move would hide that part, so such axes come last.
  return useful.filter((axis) => isSteady(axis.values)).concat(useful.filter((axis) => !isSteady(axis.values)));
}

function isSteady(values) {
  const step = (values[values.length - 1] - values[0]) / (values.length - 1);
  let still = 0;
  for (let k = 1; k < values.length; ++k) {
    if (!(values[k] - values[k - 1] > step / 50)) ++still;
  }
  return still < values.length / 50;
}
