// SPDX-License-Identifier: GPL-3.0-or-later
// browser_test.mjs TAUT WRITE_SAMPLES CASES [SCREENSHOTS]: reports of planned, audited and made-up certificates, in
// Debian's Chromium. Needs npm's packages (scripts/install-web) and chromium; fails without them. Prints sizes and
// times; asserts none.
import assert from "node:assert/strict";
import { execFileSync } from "node:child_process";
import { mkdirSync, mkdtempSync, readFileSync, rmSync, statSync, writeFileSync } from "node:fs";
import { createRequire } from "node:module";
import { tmpdir } from "node:os";
import { join } from "node:path";
import { after, before, test } from "node:test";
import { chromium } from "playwright-core";

const [taut, writeSamples, cases, screenshots] = process.argv.slice(2);
const directory = mkdtempSync(join(tmpdir(), "taut-browser-"));
const WEBGL = ["--use-angle=swiftshader", "--enable-unsafe-swiftshader"];
const NO_WEBGL = ["--disable-gpu", "--disable-3d-apis"];
const SECTIONS = ["assumptions", "inputs", "robot", "path", "recheck"];
const SECTIONS_OF_THEOREMS = ["theorem", ...SECTIONS];
let withWebgl;
let withoutWebgl;

/// taut, whatever its verdict; anything else fails.
function run(...args) {
  try {
    execFileSync(taut, args, { stdio: "pipe" });
  } catch (error) {
    if (error.status !== 1 && error.status !== 2) throw error;
  }
}

const plan = (name) => run("plan", join(cases, `${name}.yaml`), "--out", join(directory, name));
const audit = (name, path, ...options) =>
  run("audit", join(cases, "audits", `${name}.yaml`), path, "--out", join(directory, name), ...options);
const inAudits = (file) => join(cases, "audits", file);

/// The planned path in 200 pieces, as a table.
function twoHundredSegments() {
  const [, ...lines] = readFileSync(inAudits("robot1-planned.csv"), "utf8").trim().split("\n");
  const points = lines.map((line) => line.split(",").map(Number)).map((r) => [r[1] + Math.PI * r[3], r[2]]);
  const rows = ["t[s],phi[rad],theta[rad]"];
  for (let i = 0; i <= 200; ++i) {
    const x = (i / 200) * (points.length - 1);
    const k = Math.min(Math.floor(x), points.length - 2);
    const at = (j) => points[k][j] + (x - k) * (points[k + 1][j] - points[k][j]);
    rows.push(`${i / 10},${at(0)},${at(1)}`);
  }
  writeFileSync(join(directory, "long.csv"), rows.join("\n"));
}

before(async () => {
  execFileSync(writeSamples, [directory]);
  const launch = (args) => chromium.launch({
    executablePath: "/usr/bin/chromium",
    args: ["--no-sandbox", "--host-resolver-rules=MAP * ~NOTFOUND", ...args],
  });
  [withWebgl, withoutWebgl] = await Promise.all([launch(WEBGL), launch(NO_WEBGL)]);
  for (const name of ["robot1-slice-qs-qg", "robot2-sphere-sigma-free-q2-q3", "robot2-free-q2-q3",
    "robot2-implicit-rail", "tutorial/02-a-slack-start", "tutorial/03-a-smooth-move",
    "tutorial/04-tolerances"]) plan(name);
  audit("robot1-geodesic", inAudits("robot1-geodesic.tum"));
  audit("robot1-cable-lengths", inAudits("robot1-cable-lengths.csv"));
  audit("robot1-straight-qs-qg", inAudits("robot1-straight-qs-qg.csv"));
  twoHundredSegments();
  audit("robot1-planned", join(directory, "long.csv"));
});

after(async () => {
  await Promise.all([withWebgl, withoutWebgl].map((browser) => browser?.close()));
  rmSync(directory, { recursive: true });
});

/// A page, loaded and drawn, with what went wrong on it in `page.complaints`.
async function open(name, { browser = withWebgl, ...options } = {}) {
  const file = join(directory, name.endsWith(".html") ? name : join(name, "report.html"));
  const context = await browser.newContext({ viewport: { width: 1100, height: 900 }, ...options });
  const page = await context.newPage();
  page.complaints = [];
  page.on("console", (message) => page.complaints.push(message.text()));
  page.on("pageerror", (error) => page.complaints.push(String(error)));
  page.on("dialog", (dialog) => {
    page.complaints.push(`dialog: ${dialog.message()}`);
    dialog.dismiss();
  });
  page.on("request", (request) => {
    if (request.url() !== `file://${file}`) page.complaints.push(`asked for ${request.url()}`);
  });
  page.file = file;
  await page.goto(`file://${file}`);
  if (options.javaScriptEnabled !== false) {
    await page.waitForFunction(() => document.documentElement.classList.contains("drawn"), null, { timeout: 30_000 });
  }
  return page;
}

async function close(page) {
  // WebGL's driver remarks on how fast it is.
  assert.deepEqual(page.complaints.filter((text) => !/GL Driver Message/.test(text)), []);
  await page.context().close();
}

async function picture(page, name, options = {}) {
  if (!screenshots) return;
  mkdirSync(screenshots, { recursive: true });
  await page.screenshot({ path: join(screenshots, `${name}.png`), fullPage: true, ...options });
}

const has = async (page, selector) => (await page.locator(selector).count()) > 0;
const shown = (page, selector) => page.locator(selector).first().isVisible();

/// Where the labels of the six cables stand: they move with the robot.
const labels = (page) => page.$$eval(".labels .cable", (spans) => spans.map((span) => span.style.transform));
const cursors = (page) => page.$$eval(".cursor", (lines) => lines.map((line) => Number(line.getAttribute("x1"))));
const frames = (page) =>
  page.evaluate(() => new Promise((done) => requestAnimationFrame(() => requestAnimationFrame(done))));

test("console errors and requests are noticed", async () => {
  writeFileSync(join(directory, "broken.html"), `<!DOCTYPE html><html class="drawn"><title>x</title><img src="x.png">
    <script>throw new Error("seen")</script>`);
  const page = await open("broken.html");
  await page.waitForTimeout(100);
  assert.ok(page.complaints.some((text) => text.includes("seen")));
  assert.ok(page.complaints.some((text) => text.includes("x.png")));
  await page.context().close();
});

const PAGES = {
  "robot1-slice-qs-qg": { plane: true, panels: 17 },
  "robot2-sphere-sigma-free-q2-q3": { panels: 17 },
  "robot2-free-q2-q3": { panels: 17 },
  "robot2-implicit-rail": { panels: 17 },
  "tutorial/03-a-smooth-move": { plane: true, panels: 17 },
  "tutorial/04-tolerances": { plane: true, panels: 17, tolerances: true },
  "robot1-geodesic": { panels: 17 },
  "robot1-cable-lengths": { panels: 17 },
  "robot1-straight-qs-qg": { plane: true, panels: 17, stretches: true },
  "tutorial/02-a-slack-start": { plane: true, panels: 14 },
  "refuted.html": { plane: true, panels: 14 },
  "singular.html": { plane: true, panels: 14 },
  "undecided.html": { plane: true, panels: 14, stretches: true },
};

for (const [name, expected] of Object.entries(PAGES)) {
  test(`${name}: everything is drawn`, async () => {
    const page = await open(name);
    for (const id of SECTIONS) assert.ok(await has(page, `section#${id}`), id);
    assert.equal(await has(page, "section#theorem"), name !== "undecided.html", "a claim, where one is proved");
    assert.ok(await shown(page, ".stage canvas"), "the robot");
    const still = await has(page, ".still") && await shown(page, ".still");
    assert.equal(still, false, "no still picture beside the moving one");
    assert.equal(await page.locator(".panel .drawing svg").count(), expected.panels);
    assert.equal(await has(page, ".plane-figure svg"), expected.plane === true, "plane");
    assert.equal(await has(page, ".tolerance-figure svg"), expected.tolerances === true, "tolerances");
    const drawings = page.locator(".drawing svg");
    assert.equal(await drawings.evaluateAll((plots) => plots.some((p) => /NaN|Infinity/.test(p.outerHTML))), false);
    assert.equal(await has(page, '.drawing [aria-label="rect"] rect[fill^="var(--mark)"], ' +
      '.drawing [aria-label="rect"] rect[fill^="var(--undecided)"]'),
      expected.stretches === true, "stretches");
    assert.equal(await has(page, "p.unscripted:visible"), false);
    await picture(page, name.replaceAll("/", "-"));
    await close(page);
  });
}

test("no path: words and the plane, nothing to play", async () => {
  const page = await open("no_path.html");
  for (const id of SECTIONS) assert.ok(await has(page, `section#${id}`), id);
  assert.equal(await has(page, "section#theorem"), false);
  assert.equal(await has(page, ".controls"), false);
  assert.ok(await has(page, ".plane-figure svg"));
  await close(page);
});

test("playing moves the robot and the plots' cursor, and ends", async () => {
  const page = await open("robot2-free-q2-q3");
  const start = await labels(page);
  assert.equal(start.length, 6);
  // So that it is still playing when it is paused, on a slow machine, too.
  await page.selectOption(".controls select", "60");
  await page.click(".controls .play");
  // These wait until it is so: a slow machine may take a while for a frame.
  await page.waitForFunction((was) => document.querySelector(".labels .cable").style.transform !== was, start[0]);
  const cursorIsBeyond = (x) => page.waitForFunction(
    (least) => Number(document.querySelector(".cursor").getAttribute("x1")) > least, x);
  await cursorIsBeyond(54); // the axis
  await cursorIsBeyond((await cursors(page))[0]);
  await page.click(".controls .play");
  await frames(page);
  const stopped = await cursors(page);
  await page.waitForTimeout(200);
  assert.deepEqual(await cursors(page), stopped, "until it is paused");
  await page.$eval(".controls input[type=range]", (slider) => {
    slider.value = "990";
    slider.dispatchEvent(new Event("input"));
  });
  await page.click(".controls .play");
  await page.waitForFunction(() => document.querySelector(".controls .play").textContent.includes("Play"));
  assert.equal(await page.$eval(".controls input[type=range]", (slider) => slider.value), "1000", "to the end");
  await close(page);
});

test("scrubbing by mouse, keys and plots; stepping; orbiting", async () => {
  const page = await open("robot1-planned");
  const slider = page.locator(".controls input[type=range]");
  const where = () => page.textContent(".where");
  await slider.scrollIntoViewIfNeeded();
  const box = await slider.boundingBox();
  await page.mouse.click(box.x + box.width / 2, box.y + box.height / 2);
  assert.match(await where(), /^Segment (9\d|10\d), /);
  await slider.focus();
  const before = Number(await slider.inputValue());
  await page.keyboard.press("ArrowRight");
  assert.equal(Number(await slider.inputValue()), before + 1);
  const segment = Number((await where()).match(/^Segment (\d+)/)[1]);
  await page.click('button[aria-label="Next segment"]');
  assert.match(await where(), new RegExp(`^Segment ${segment + 1}, s = 0.000`));
  await page.click('button[aria-label="Previous segment"]');
  assert.match(await where(), new RegExp(`^Segment ${segment}, s = 0.000`));

  const drawing = page.locator("#tensions .drawing").first();
  await drawing.scrollIntoViewIfNeeded();
  const plot = await drawing.boundingBox();
  const robot = await labels(page);
  await page.mouse.move(plot.x + plot.width * 0.8, plot.y + plot.height / 2);
  await frames(page);
  assert.notDeepEqual(await labels(page), robot, "pointing at a plot moves the robot");
  const all = await cursors(page);
  assert.ok(all.length > 10 && Math.min(...all) > 200, "and the cursors of all plots");
  assert.match(await page.textContent("#tensions .readout"), /N$/);
  await drawing.focus();
  await page.keyboard.press("ArrowLeft");
  assert.ok((await cursors(page))[0] < all[0], "so do keys");

  await page.focus(".stage");
  const view = await labels(page);
  await page.keyboard.press("ArrowLeft");
  await frames(page);
  const turned = await labels(page);
  assert.notDeepEqual(turned, view, "keys look from elsewhere");
  const stage = await page.locator(".stage").boundingBox();
  await page.mouse.move(stage.x + 200, stage.y + 200);
  await page.mouse.down();
  await page.mouse.move(stage.x + 300, stage.y + 230, { steps: 4 });
  await page.mouse.up();
  await frames(page);
  assert.notDeepEqual(await labels(page), turned, "and so does the mouse");
  await page.focus(".stage");
  await page.keyboard.press(" ");
  assert.match(await page.textContent(".controls .play"), /Pause/);
  await close(page);
});

/// The length that the scale bar states, over its length in pixels: the less, the nearer.
const metresPerPixel = (page) => page.$eval(".scale-bar", (bar) => parseFloat(bar.textContent) / bar.offsetWidth);

test("the page scrolls over the machine; Ctrl and the wheel zoom", async () => {
  const page = await open("robot1-slice-qs-qg");
  await page.locator(".stage").scrollIntoViewIfNeeded();
  await frames(page);
  const stage = await page.locator(".stage").boundingBox();
  await page.mouse.move(stage.x + stage.width / 2, stage.y + stage.height / 2);
  const [before, scale] = [await page.evaluate(() => scrollY), await metresPerPixel(page)];
  await page.mouse.wheel(0, 120);
  await page.waitForFunction((was) => scrollY > was + 60, before);
  await frames(page);
  assert.equal(await metresPerPixel(page), scale, "nothing zooms");
  assert.match(await page.textContent(".hint.shown"), /Ctrl/);
  const scrolled = await page.evaluate(() => scrollY);
  await page.keyboard.down("Control");
  for (let k = 0; k < 4; ++k) await page.mouse.wheel(0, -120);
  await page.keyboard.up("Control");
  await page.waitForFunction((was) => {
    const bar = document.querySelector(".scale-bar");
    return parseFloat(bar.textContent) / bar.offsetWidth < 0.9 * was;
  }, scale);
  assert.equal(await page.evaluate(() => scrollY), scrolled, "the page stays");
  await close(page);
});

test("one finger scrolls the page over the machine", async () => {
  const page = await open("robot1-slice-qs-qg", { viewport: { width: 390, height: 844 }, hasTouch: true });
  const touched = await page.$eval(".stage canvas", (canvas) => getComputedStyle(canvas).touchAction);
  assert.equal(touched, "pan-y");
  await page.locator(".stage").scrollIntoViewIfNeeded();
  const [stage, slider] = [await page.locator(".stage").boundingBox(),
    await page.locator(".controls input[type=range]").boundingBox()];
  assert.ok(slider.y + slider.height - stage.y < 844, "the slider is in view with the picture");
  const view = await labels(page);
  const session = await page.context().newCDPSession(page);
  const touch = (type, ...points) => session.send("Input.dispatchTouchEvent", {
    type, touchPoints: points.map(([x, y], id) => ({ x: stage.x + x, y: stage.y + y, id })),
  });
  await touch("touchStart", [150, 150]);
  for (const x of [160, 180, 200]) await touch("touchMove", [x, 150]);
  await touch("touchEnd");
  await frames(page);
  assert.deepEqual(await labels(page), view, "one finger turns nothing");
  assert.match(await page.textContent(".hint"), /two fingers/);
  await touch("touchStart", [120, 150]);
  await touch("touchStart", [120, 150], [220, 150]);
  for (const x of [10, 25, 40]) await touch("touchMove", [120 + x, 150], [220 + x, 150]);
  await touch("touchEnd");
  await frames(page);
  assert.notDeepEqual(await labels(page), view, "two fingers do");
  await close(page);
});

test("buttons look from the front, the side and above, and go to the worst place", async () => {
  const page = await open("robot1-slice-qs-qg");
  const views = { Oblique: await labels(page) };
  assert.equal(await page.locator(".triad .axis").count(), 3);
  const names = await page.$$eval(".labels .name", (tags) => tags.map((tag) => tag.textContent));
  assert.deepEqual(names, ["A1 A2", "A3 A4", "A5 A6"]);
  for (const name of ["Front", "Side", "Top"]) {
    await page.click(`.views button:text-is("${name}")`);
    await frames(page);
    const seen = await labels(page);
    for (const [other, was] of Object.entries(views)) assert.notDeepEqual(seen, was, `${name} is not ${other}`);
    views[name] = seen;
    await picture(page, `view-${name}`, { fullPage: false });
  }
  // From above, the load pulls along the view: z has no length in the picture.
  const z = await page.$eval(".triad .z", (path) => path.getAttribute("d").match(/L([-\d.]+) ([-\d.]+)/).slice(1));
  assert.ok(Math.hypot(...z.map(Number)) < 0.1);
  await page.click('.views button:text-is("Oblique")');
  await frames(page);
  assert.deepEqual(await labels(page), views.Oblique);
  await page.click('.views button:text-is("Worst place")');
  await frames(page);
  assert.notDeepEqual(await labels(page), views.Oblique);
  const [share, value] = await page.$eval(".track", (track) => [
    Number(track.querySelector(".worst-mark").style.getPropertyValue("--share")), Number(track.firstChild.value)]);
  assert.ok(share > 0 && Math.abs(share * 1000 - value) <= 1, "it is marked on the slider");
  await close(page);
});

test("a refuted move opens at its witness, where the cable is out of its limits", async () => {
  const page = await open("robot1-straight-qs-qg");
  await frames(page);
  assert.match(await page.textContent(".where"), /violation/);
  assert.ok(await has(page, ".labels .cable.out"));
  assert.match(await page.textContent(".labels .cable.out"), /!/);
  await close(page);
});

test("of a plan that was not found, start and goal are shown and nothing plays", async () => {
  const page = await open("not_found.html");
  assert.ok(await shown(page, ".stage canvas"));
  for (const part of [".play", "input[type=range]", ".readout-table"]) {
    assert.equal(await has(page, `#move ${part}`), false, part);
  }
  assert.equal(await page.locator(".labels .cable:visible").count(), 0);
  assert.deepEqual(await page.$$eval(".labels .end", (tags) => tags.map((tag) => tag.textContent)), ["S", "G"]);
  assert.doesNotMatch(await page.locator('#move > [data-plot="move"]').innerText(), /proved|path of/);
  assert.equal(await has(page, '.views button:text-is("Worst place")'), false);
  await close(page);
});

test("the plots' axis: time, angle, segments", async () => {
  const page = await open("robot1-planned");
  const label = () => page.textContent("#tensions .drawing svg [aria-label='x-axis label']");
  assert.match(await label(), /time \[s\]/);
  await page.check('input[name="axis"][value="turned"]');
  assert.match(await label(), /\[°\]/);
  await page.check('input[name="axis"][value="segment"]');
  assert.match(await label(), /segment/);
  await close(page);
});

test("long tables are folded, and unfold", async () => {
  const page = await open("robot1-planned");
  const folded = page.locator("details:not([open])").first();
  const table = folded.locator("table").first();
  assert.equal(await table.isVisible(), false);
  await folded.locator("summary").click();
  assert.ok(await page.locator("details[open] table").first().isVisible());
  await close(page);
});

test("without WebGL the still picture stands in", async () => {
  const page = await open("robot1-slice-qs-qg", { browser: withoutWebgl });
  assert.ok(await shown(page, ".still svg"));
  assert.equal(await has(page, ".stage"), false);
  assert.equal(await page.locator(".panel .drawing svg").count(), 17);
  await page.click('button[aria-label="Next segment"]');
  assert.match(await page.textContent(".where"), /^Segment 1/);
  await close(page);
});

test("without a script there are words, tables and the still picture", async () => {
  const page = await open("robot1-slice-qs-qg", { javaScriptEnabled: false });
  for (const id of [...SECTIONS_OF_THEOREMS, "move", "tensions", "lengths", "plane"]) {
    assert.ok(await shown(page, `#${id} h2`), id);
  }
  assert.ok(await shown(page, ".still svg"));
  assert.ok(await shown(page, ".unscripted"));
  await close(page);
});

test("in the dark, and on a narrow screen", async () => {
  const page = await open("robot1-slice-qs-qg", { colorScheme: "dark", viewport: { width: 390, height: 844 } });
  const brightness = (colour) => colour.match(/\d+/g).slice(0, 3).reduce((sum, c) => sum + Number(c), 0);
  assert.ok(brightness(await page.$eval("html", (html) => getComputedStyle(html).backgroundColor)) < 150);
  assert.ok(brightness(await page.$eval(".drawing svg text", (words) => getComputedStyle(words).fill)) > 400);
  assert.ok(await page.evaluate(() => document.documentElement.scrollWidth) <= 390, "nothing sticks out");
  await picture(page, "dark-narrow");
  await close(page);
});

for (const name of ["robot1-slice-qs-qg", "robot1-straight-qs-qg", "undecided.html"]) {
  test(`${name} on paper: all sections, still picture, plots`, async () => {
    const page = await open(name);
    const pdf = join(directory, "report.pdf");
    await page.pdf({ path: pdf, preferCSSPageSize: true });
    if (screenshots) writeFileSync(join(screenshots, `${name}.pdf`), readFileSync(pdf));
    const pages = readFileSync(pdf, "latin1").match(/\/Type\s*\/Page[^s]/g).length;
    assert.ok(pages >= 4 && pages <= 24, `${pages} pages`);
    await page.emulateMedia({ media: "print" });
    assert.ok(await shown(page, ".still svg"));
    assert.equal(await shown(page, ".stage"), false);
    for (const section of await page.$$("section")) assert.ok(await section.isVisible());
    assert.ok(await shown(page, ".drawing svg"));
    await close(page);
  });
}

test("a hostile certificate runs nothing", async () => {
  const page = await open("hostile.html");
  assert.equal(await page.evaluate(() => window.attacked), undefined);
  assert.equal(await has(page, "img"), false);
  assert.equal(await page.locator("script").count(), 2);
  assert.match(await page.textContent("h1"), /<script>/, "its name is shown as it is");
  assert.deepEqual(page.complaints, []);
  // Were markup to get in, the policy would not let it run.
  await page.evaluate(() => {
    document.body.insertAdjacentHTML("beforeend", `<img src="data:," onerror="window.attacked = 1">`);
    const script = document.createElement("script");
    script.textContent = "window.attacked = 2";
    document.body.append(script);
  });
  await page.waitForTimeout(100);
  assert.equal(await page.evaluate(() => window.attacked), undefined);
  assert.ok(page.complaints.some((text) => /Content Security Policy/.test(text)));
  await page.context().close();
});

test("of a certificate that was not checked, nothing is drawn as proved", async () => {
  const page = await open("unchecked.html");
  assert.ok(await shown(page, ".stage canvas"));
  assert.equal(await page.locator(".panel .drawing svg").count(), 14, "no margins");
  for (const place of ["#move", "#tensions"]) {
    assert.doesNotMatch(await page.locator(`${place} > [data-plot]`).innerText(), /proved/);
  }
  await close(page);
});

test("axe finds nothing to complain about", async () => {
  const axe = readFileSync(createRequire(import.meta.url).resolve("axe-core/axe.min.js"), "utf8");
  for (const options of [{}, { colorScheme: "dark" }]) {
    const page = await open("tutorial/04-tolerances", options);
    const session = await page.context().newCDPSession(page); // which the page's policy does not bind
    await session.send("Runtime.evaluate", { expression: axe });
    const { result } = await session.send("Runtime.evaluate", {
      expression: "axe.run().then(({ violations }) => JSON.stringify(violations.map((v) => " +
        "[v.id, v.nodes.map((n) => n.html.slice(0, 160)).slice(0, 4)])))",
      awaitPromise: true,
      returnByValue: true,
    });
    assert.deepEqual(JSON.parse(result.value), []);
    await close(page);
  }
});

test("200 segments: how large, how soon", async () => {
  const page = await open("robot1-planned");
  const times = await page.evaluate(() => {
    const at = (mark) => performance.getEntriesByName(mark)[0]?.startTime ?? NaN;
    return {
      read: at("first-contentful-paint"), begun: at("readable"), interactive: at("interactive"), drawn: at("drawn"),
    };
  });
  const size = statSync(page.file).size;
  console.log(`200 segments: ${(size / 1e6).toFixed(2)} MB, text and tables after ${Math.round(times.read)} ms, ` +
    `plots and controls answer after ${Math.round(times.interactive)} ms, all drawn after ` +
    `${Math.round(times.drawn)} ms`);
  assert.ok(size < 3e6);
  // A second after the page was read nobody waits any longer.
  assert.ok(times.read <= times.begun || times.begun >= 1000,
    "text and tables are on the screen before anything is drawn");
  await close(page);
});
