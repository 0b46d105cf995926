// SPDX-License-Identifier: GPL-3.0-or-later
// Colours that depend on the reader's theme, and the scale of the cables.

/// A custom property of the page's style, as three.js reads colours: "#1f5f99".
export function themed(name) {
  return getComputedStyle(document.documentElement).getPropertyValue(name).trim() || "#888888";
}

export function onThemeChange(listener) {
  for (const query of ["(prefers-color-scheme: dark)"]) matchMedia(query).addEventListener("change", listener);
}

// From blue over grey to red (ColorBrewer's RdBu): distinguishable with any colour vision, darker towards both ends.
const STOPS = [
  [0, [33, 102, 172]],
  [0.25, [103, 169, 207]],
  [0.5, [170, 170, 170]],
  [0.75, [239, 138, 98]],
  [1, [178, 24, 43]],
];

/// The colour of a tension that is `share` of the way from its lower to its upper limit.
export function tensionColour(share) {
  const x = Math.min(Math.max(Number.isFinite(share) ? share : 1, 0), 1);
  const k = Math.max(STOPS.findIndex(([stop]) => x <= stop), 1);
  const [[from, a], [to, b]] = [STOPS[k - 1], STOPS[k]];
  const t = (x - from) / (to - from);
  return `rgb(${a.map((value, c) => Math.round(value + t * (b[c] - value))).join(", ")})`;
}
