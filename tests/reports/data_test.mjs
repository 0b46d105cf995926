// SPDX-License-Identifier: GPL-3.0-or-later
// What the page's script does with its data. Run by node --test.
import assert from "node:assert/strict";
import { test } from "node:test";
import { between, locate, spaced } from "../../reports/web/data.js";

const point = (x) => ({ x, distanceTo: (other) => Math.abs(x - other.x) });

test("of many points close together some remain all along the way, as the tube needs", () => {
  const points = Array.from({ length: 1001 }, (_, k) => point(k / 1000));
  const kept = spaced(points, 0.05).map((p) => p.x);
  assert.equal(kept[0], 0);
  assert.ok(kept[kept.length - 1] > 0.94);
  for (let k = 1; k < kept.length; ++k) assert.ok(kept[k] - kept[k - 1] > 0.05 && kept[k] - kept[k - 1] < 0.053);
  assert.equal(spaced([point(1), point(1), point(1)], 0.05).length, 1);
});

test("places between samples", () => {
  const positions = [0, 1, 3];
  assert.deepEqual(locate(positions, -1), [0, 0]);
  assert.deepEqual(locate(positions, 2), [1, 0.5]);
  assert.deepEqual(locate(positions, 9), [2, 0]);
  assert.equal(between([10, 20, 40], locate(positions, 2)), 30);
  assert.ok(Number.isNaN(between([10, null, 40], locate(positions, 2))));
});
