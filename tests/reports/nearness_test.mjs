// SPDX-License-Identifier: GPL-3.0-or-later
// The page's rule of nearness is that of reports/summary/nearness.cc; the numbers are those of nearness_test.cc.
import assert from "node:assert/strict";
import { test } from "node:test";
import { nearness } from "../../reports/web/nearness.js";

const middle = [50, [0, 100]];
const ofTension = (least, greatest, limits) => nearness([least, greatest], limits, ...middle);

test("of the greatest tension to its upper limit", () => {
  assert.equal(ofTension(0.2, 0.374, [0.05, 0.5]), "calm");
  assert.equal(ofTension(0.2, 0.375, [0.05, 0.5]), "near");
  assert.equal(ofTension(0.2, 0.4751, [0.05, 0.5]), "close");
  assert.equal(ofTension(0.2, 0.5, [0.05, 0.5]), "out");
  assert.equal(ofTension(0.2, NaN, [0.05, 0.5]), "out");
});

test("of the least tension to its lower limit", () => {
  assert.equal(ofTension(1.4, 5, [1, 10]), "calm");
  assert.equal(ofTension(1.3, 5, [1, 10]), "near");
  assert.equal(ofTension(1.05, 5, [1, 10]), "close");
  assert.equal(ofTension(1, 5, [1, 10]), "out");
  assert.equal(ofTension(NaN, 5, [1, 10]), "out");
});

test("to a lower limit of zero by the width", () => {
  assert.equal(ofTension(3, 5, [0, 10]), "calm");
  assert.equal(ofTension(2, 5, [0, 10]), "near");
  assert.equal(ofTension(0.4, 5, [0, 10]), "close");
  assert.equal(ofTension(0, 5, [0, 10]), "out");
});

test("of a length to the nearer limit", () => {
  const ofLength = (length, slack) => nearness([4, 5], [1, 10], length, [0, 100], slack);
  assert.equal(ofLength(80), "calm");
  assert.equal(ofLength(96), "near");
  assert.equal(ofLength(1), "close");
  assert.equal(ofLength(0), "out");
  assert.equal(ofLength(0, 0.01), "close", "within the rounding of samples");
  assert.equal(ofLength(NaN), "out");
});
