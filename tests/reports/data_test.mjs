// SPDX-License-Identifier: GPL-3.0-or-later
// What the page's script does with its data. Run by node --test.
import assert from "node:assert/strict";
import { test } from "node:test";
import { nearestPair, nearestPoints } from "../../reports/web/bodies.js";
import { clipped, outOfLimits, readField } from "../../reports/web/contours.js";
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

test("fields are read with their signs, and with sizes on a logarithmic scale", () => {
  assert.deepEqual(readField("3ZA2z").map((x) => Number(x.toFixed(12))), [1, 1, 1, 1e-4, -1, -1]);
  assert.deepEqual(readField("").length, 0);
  assert.ok(Math.abs(readField("Tz")[0] - 10 ** -0.96) < 1e-12);
});

test("contours run where the field is zero, and beyond the edges where the region goes on", () => {
  const columns = 40;
  const rows = 30;
  const cells = Array.from({ length: columns * rows }, (_, k) => [(k % columns) + 0.5, Math.floor(k / columns) + 0.5]);
  const outside = cells.map(([x, y]) => Math.hypot(x - 20, y - 15) - 8); // not positive inside a circle
  const rings = outOfLimits(outside, columns, rows);
  assert.equal(rings.length, 1);
  for (const [x, y] of rings[0]) assert.ok(Math.abs(Math.hypot(x - 20, y - 15) - 8) < 0.05, `${x}, ${y}`);
  const left = outOfLimits(cells.map(([x]) => x - 10.3), columns, rows); // not positive left of a line
  const at = (c) => left.flat().map((point) => point[c]);
  const isInGrid = ([x, y]) => x > 0 && x < columns && y > 0 && y < rows;
  const inGrid = left.flat().filter(isInGrid);
  assert.ok(inGrid.length > 20 && inGrid.every(([x]) => Math.abs(x - 10.3) < 1e-9));
  assert.equal(Math.min(...at(1)), -1);
  assert.equal(Math.max(...at(1)), rows + 1);
  assert.deepEqual(outOfLimits(cells.map(() => 1), columns, rows), []);
});

test("polygons are cut at the window", () => {
  const window = [[0, 10], [0, 5]];
  const square = [[1, 1], [2, 1], [2, 2], [1, 2]];
  assert.deepEqual(clipped(square, window), square);
  assert.deepEqual(clipped([[11, 1], [12, 1], [12, 2]], window), []);
  const cut = clipped([[8, 3], [12, 3], [12, 7], [8, 7]], window);
  assert.deepEqual(cut.map(([x]) => x).sort((a, b) => a - b), [8, 8, 10, 10]);
  assert.deepEqual(cut.map(([, y]) => y).sort((a, b) => a - b), [3, 3, 5, 5]);
});

test("the nearest pair is that of the nearer sample, and runs on between two with the same", () => {
  const nearest = {
    pair: [3, 3, 5], distance: [1, 2, 0.5], clearance: [0.2, 0.2, 0.1], cone: [0, 0, 1],
    first: [[0, 1, 7], [0, 0, 0], [0, 0, 0]], second: [[1, 3, 9], [0, 0, 0], [0, 0, 0]],
  };
  const names = { 3: "hook / post", 5: "cable 1 / post" };
  assert.deepEqual(nearestPair({ nearest, names }, [0, 0.25]),
    { name: "hook / post", distance: 1.25, clearance: 0.2, isCone: false });
  assert.deepEqual(nearestPair({ nearest, names }, [1, 0.4]),
    { name: "hook / post", distance: 2, clearance: 0.2, isCone: false });
  assert.deepEqual(nearestPair({ nearest, names }, [1, 0.6]),
    { name: "cable 1 / post", distance: 0.5, clearance: 0.1, isCone: true });
  assert.deepEqual(nearestPoints(nearest, [0, 0.5]), [[0.5, 0, 0], [2, 0, 0]]);
  assert.deepEqual(nearestPoints(nearest, [1, 0.6]), [[7, 0, 0], [9, 0, 0]]);
  assert.deepEqual(nearestPoints(nearest, [2, 0]), [[7, 0, 0], [9, 0, 0]]);
});
