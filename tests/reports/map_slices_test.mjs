// SPDX-License-Identifier: GPL-3.0-or-later
// map_slices_test.mjs TAUT CASES [SCREENSHOTS]: the page of slices of a map of three coordinates, in Debian's Chromium.
// Needs npm's packages (scripts/install-web) and chromium; fails without them.
import assert from "node:assert/strict";
import { execFileSync } from "node:child_process";
import { mkdtempSync, readFileSync, rmSync } from "node:fs";
import { tmpdir } from "node:os";
import { join } from "node:path";
import { after, before, test } from "node:test";
import { chromium } from "playwright-core";

const [taut, cases, screenshots] = process.argv.slice(2);
const directory = mkdtempSync(join(tmpdir(), "taut-slices-"));
const file = join(directory, "map.html");
const SIZE = 32; // of the grid, a power of two
const complaints = [];
let browser;
let page;

before(async () => {
  execFileSync(taut, ["map", join(cases, "robot2-sphere-sigma-free-q2-q3.yaml"), "--undecided", "50%",
    "--out", directory, "--grid", join(directory, "g.npy"), "--grid-size", String(SIZE)]);
  browser = await chromium.launch({
    executablePath: "/usr/bin/chromium", args: ["--no-sandbox", "--host-resolver-rules=MAP * ~NOTFOUND"],
  });
  page = await (await browser.newContext({ viewport: { width: 1000, height: 1400 } })).newPage();
  page.on("console", (message) => {  // the remark is about this test, which reads the picture
    if (!/willReadFrequently/.test(message.text())) complaints.push(message.text());
  });
  page.on("pageerror", (error) => complaints.push(String(error)));
  page.on("request", (request) => {
    if (request.url() !== `file://${file}`) complaints.push(`asked for ${request.url()}`);
  });
  await page.goto(`file://${file}`);
});

after(async () => {
  await browser?.close();
  rmSync(directory, { recursive: true });
});

/// The bytes of the grid.
function grid() {
  const bytes = readFileSync(join(directory, "g.npy"));
  return bytes.subarray(10 + bytes.readUInt16LE(8));
}

/// The colour at the middle of a box of a slice along the third axis.
const colourAt = (i, j) => page.evaluate(([x, y]) => {
  const canvas = document.getElementById("slice");
  const pixel = canvas.getContext("2d").getImageData(x * canvas.width, (1 - y) * canvas.height, 1, 1).data;
  return [...pixel.subarray(0, 3)].map((c) => c.toString(16).padStart(2, "0")).join("");
}, [(i + 0.5) / SIZE, (j + 0.5) / SIZE]);

async function setSlider(value) {
  await page.locator("#third").evaluate((slider, v) => {
    slider.value = v;
    slider.dispatchEvent(new Event("input"));
  }, value);
}

test("starts at the start's slice, and keys move the slider", async () => {
  assert.match(await page.locator("h1").textContent(), /free to turn/);
  assert.equal(await page.locator("#here").textContent(), "sigma = 0 rad");
  await page.keyboard.press("Tab");
  await page.keyboard.press("Tab");
  assert.equal(await page.evaluate(() => document.activeElement.id), "third");
  for (let n = 0; n < 8; ++n) await page.keyboard.press("ArrowRight");
  assert.equal(await page.locator("#here").textContent(), "sigma = 0.1963 rad");
  assert.equal(await page.locator("#third").getAttribute("aria-valuetext"), "sigma = 0.1963 rad");
  const label = await page.locator("#slice").getAttribute("aria-label");
  assert.match(label, /% inside; whether the start reaches it is open/);
  if (screenshots) await page.screenshot({ path: join(screenshots, "slices.png"), fullPage: true });
});

test("the picture is the map: wherever a box of the grid is of one kind, it has that kind's colour", async () => {
  const values = grid();
  const colours = { 1: "b5d8a8", 3: "7fbc7a" };
  let checked = 0;
  for (const l of [0, 5, 16, 31]) {
    await setSlider(((l + 0.5) / SIZE) * 256);
    for (let i = 0; i < SIZE; i += 3) {
      for (let j = 0; j < SIZE; ++j) {
        const value = values[(i * SIZE + j) * SIZE + l];
        if (!(value in colours)) continue;
        assert.equal(await colourAt(i, j), colours[value], `${i}, ${j}, ${l}`);
        ++checked;
      }
    }
  }
  assert.ok(checked > 20, String(checked));
});

test("shares of a slice add up to one, along every axis", async () => {
  for (const axis of ["0", "1", "2"]) {
    await page.locator("#axis").selectOption(axis);
    const text = await page.locator("#legend").textContent();
    const shares = [...text.matchAll(/\(([\d.]+) %\)/g)].map((match) => Number(match[1]));
    assert.ok(Math.abs(shares.reduce((a, b) => a + b) - 100) < 0.5, text);
  }
});

test("nothing went wrong, and nothing was asked for", () => assert.deepEqual(complaints, []));
