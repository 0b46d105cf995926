// SPDX-License-Identifier: GPL-3.0-or-later
// Numbers as text.

/// Four significant digits, no exponent if it is readable without, a real minus sign.
export function text(x, digits = 4) {
  if (typeof x !== "number" || !Number.isFinite(x)) return "–";
  const size = Math.abs(x);
  if (size !== 0 && (size < 1e-5 || size >= 1e7)) return x.toExponential(digits - 2).replace("-", "−");
  const rounded = Number(x.toPrecision(digits));
  return String(rounded).replace("-", "−");
}

/// A fixed number of decimals, so that a value that changes while one looks does not jump.
export function fixed(x, decimals) {
  if (!Number.isFinite(x)) return "–";
  return (Math.abs(x) < 0.5 * 10 ** -decimals ? 0 : x).toFixed(decimals).replace("-", "−");
}

/// As text() and fixed(), but never more than x, or never less, for proved values, which must not look better than they
/// are.
export const atMost = (x, digits = 3) => towards(x, -1, (y) => text(y, digits), 0.05 * Math.abs(x));
export const atLeast = (x, digits = 3) => towards(x, 1, (y) => text(y, digits), 0.05 * Math.abs(x));
export const fixedAtMost = (x, decimals) => towards(x, -1, (y) => fixed(y, decimals), 10 ** -decimals);
export const fixedAtLeast = (x, decimals) => towards(x, 1, (y) => fixed(y, decimals), 10 ** -decimals);

/// Applies `shown`, which rounds to nearest, to a number next to x in a direction, 1 or -1, such that the result is not
/// on the wrong side of x. `step` is about the size of the last digit.
function towards(x, direction, shown, step) {
  let result = shown(x);
  for (let part = 0.001; part < 4 && direction * (Number(result.replace("−", "-")) - x) < 0; part *= 1.5) {
    result = shown(x + direction * part * step);
  }
  return result;
}

/// Decimals that show a thousandth of `range`.
export function decimalsFor(range) {
  if (!(range > 0)) return 3;
  return Math.min(9, Math.max(0, 3 - Math.ceil(Math.log10(range))));
}

const GREEK = {
  alpha: "α", beta: "β", gamma: "γ", delta: "δ", epsilon: "ε", zeta: "ζ", eta: "η", theta: "θ", kappa: "κ", lambda: "λ",
  mu: "μ", nu: "ν", xi: "ξ", rho: "ρ", sigma: "σ", tau: "τ", phi: "φ", chi: "χ", psi: "ψ", omega: "ω",
};

/// A name as it is written in formulas: "phi" is φ, "alpha2" α₂; others stay as they are.
export function symbol(name) {
  const [, letter, index] = name.match(/^([a-z]+)_?(\d*)$/) ?? [];
  if (!Object.hasOwn(GREEK, letter ?? "")) return name;
  return GREEK[letter] + index.replace(/\d/g, (digit) => String.fromCodePoint(0x2080 + Number(digit)));
}

export const degrees = (radians) => (radians * 180) / Math.PI;

/// An element with attributes and children; text stays text.
export function element(name, attributes = {}, ...children) {
  const result = document.createElement(name);
  for (const [key, value] of Object.entries(attributes)) {
    if (value !== undefined && value !== null) result.setAttribute(key, value);
  }
  result.append(...children);
  return result;
}
