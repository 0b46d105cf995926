// SPDX-License-Identifier: GPL-3.0-or-later
// Words of the page's script: what is proved never looks better than it is. Run by node --test.
import assert from "node:assert/strict";
import { test } from "node:test";
import { atLeast, atMost, fixedAtLeast, fixedAtMost, symbol, text } from "../../reports/web/words.js";

const number = (words) => Number(words.replace("−", "-"));

/// Numbers of all sizes and signs, the same at every run.
function* numbers(count) {
  let state = 12345;
  const random = () => (state = (state * 1103515245 + 12345) % 2 ** 31) / 2 ** 31;
  const digits = () => 1 + 9 * random();
  for (let i = 0; i < count; ++i) yield (random() < 0.5 ? -1 : 1) * digits() * 10 ** Math.floor(random() * 16 - 8);
}

test("rounded to the side that keeps the sentence true, by a digit at most", () => {
  for (const x of numbers(20000)) {
    const [low, high] = [number(atMost(x)), number(atLeast(x))];
    assert.ok(low <= x && x <= high, `${x}: ${low} ${high}`);
    assert.ok(high - low <= 0.1001 * Math.abs(x), `${x}: ${low} ${high}`);
    for (const decimals of [0, 3, 9]) {
      const [below, above] = [number(fixedAtMost(x, decimals)), number(fixedAtLeast(x, decimals))];
      const room = 1.0001 * 10 ** -decimals + 1e-15 * Math.abs(x);
      assert.ok(below <= x && x <= above && above - below <= room, `${x}, ${decimals} decimals: ${below} ${above}`);
    }
  }
});

test("what needs no rounding is not rounded", () => {
  for (const x of [0, 0.5, -2, 100, 1e-6, 99.5]) {
    assert.equal(atMost(x), text(x, 3));
    assert.equal(atLeast(x), text(x, 3));
  }
  assert.equal(atMost(NaN), "–");
  assert.equal(fixedAtMost(0.25, 2), "0.25");
});

test("names of Greek letters are shown as letters", () => {
  assert.equal(symbol("phi"), "φ");
  assert.equal(symbol("alpha2"), "α₂");
  assert.equal(symbol("theta_10"), "θ₁₀");
  for (const name of ["px", "s", "tilt", "phi_dot", "Phi", "constructor", "", "2"]) assert.equal(symbol(name), name);
});
