// SPDX-License-Identifier: GPL-3.0-or-later
// browser_test.mjs TAUT WRITE_SAMPLES CASES [SCREENSHOTS]: reports of planned, audited and made-up certificates, in
// Debian's Chromium. Needs npm's packages (scripts/install-web) and chromium; fails without them. Prints sizes and
// times; asserts none.
import assert from "node:assert/strict";
import { execFile, execFileSync } from "node:child_process";
import { copyFileSync, mkdirSync, mkdtempSync, readFileSync, rmSync, statSync, writeFileSync } from "node:fs";
import { createRequire } from "node:module";
import { tmpdir } from "node:os";
import { join } from "node:path";
import { after, before, test } from "node:test";
import { promisify } from "node:util";
import { chromium } from "playwright-core";

const [taut, writeSamples, cases, screenshots] = process.argv.slice(2);
const directory = mkdtempSync(join(tmpdir(), "taut-browser-"));
// What a graphics card would draw the processor draws, so only the robot is left to it.
const WEBGL = ["--use-angle=swiftshader", "--enable-unsafe-swiftshader", "--disable-gpu-rasterization"];
const NO_WEBGL = ["--disable-gpu", "--disable-3d-apis"];
const SECTIONS = ["assumptions", "inputs", "robot", "path", "recheck"];
const SECTIONS_OF_THEOREMS = ["theorem", ...SECTIONS];
/// A case with bodies that may not touch.
const STACK = "cranes/portal-20t-stack";
/// Its report, that no path exists, has no script.
const APART = "maps/robot1-sigma34-apart";
const DESKTOP = { width: 1100, height: 900 };
const PHONE = { width: 390, height: 844 };
const LONGEST_WAIT = 120_000; // [ms], on a busy machine
let withWebgl;
let withoutWebgl;

/// taut, whatever its verdict; anything else fails.
async function run(...args) {
  try {
    await promisify(execFile)(taut, args);
  } catch (error) {
    if (error.code !== 1 && error.code !== 2) throw error;
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
  twoHundredSegments();
  const plate = join(cases, "bodies", "thin-plate");
  const jobs = [
    ...[STACK, "cranes/portal-20t", "tutorial/04-tolerances", APART, "robot1-slice-qs-qg", "robot2-sphere-q2-q3",
      "robot2-sphere-sigma-free-q2-q3", "robot2-free-q2-q3", "robot2-implicit-rail", "tutorial/02-a-slack-start",
      "tutorial/03-a-smooth-move"].map((name) => () => plan(name)),
    () => run("audit", `${plate}.yaml`, `${plate}.csv`, "--out", join(directory, "thin-plate")),
    () => audit("robot1-geodesic", inAudits("robot1-geodesic.tum")),
    () => audit("robot1-cable-lengths", inAudits("robot1-cable-lengths.csv")),
    () => audit("robot1-straight-qs-qg", inAudits("robot1-straight-qs-qg.csv")),
    () => audit("robot1-planned", join(directory, "long.csv")),
  ];
  const work = async () => {
    while (jobs.length > 0) await jobs.shift()();
  };
  await Promise.all([work(), work()]);
});

after(async () => {
  await Promise.all([withWebgl, withoutWebgl].map((browser) => browser?.close()));
  rmSync(directory, { recursive: true });
});

/// Tabs that are free, by browser and by what they were made with. In a tab that has shown another report, one loads in
/// half the time that it takes in a new tab.
const tabs = new Map();

async function newTab(browser, options) {
  const page = await (await browser.newContext(options)).newPage();
  page.setDefaultTimeout(LONGEST_WAIT);
  page.on("console", (message) => page.complaints.push(message.text()));
  page.on("pageerror", (error) => page.complaints.push(String(error)));
  page.on("dialog", (dialog) => {
    page.complaints.push(`dialog: ${dialog.message()}`);
    dialog.dismiss();
  });
  page.on("request", (request) => {
    if (request.url() !== `file://${page.file}`) page.complaints.push(`asked for ${request.url()}`);
  });
  return page;
}

/// A page, loaded and drawn, with what went wrong on it in `page.complaints`.
async function open(name, { browser = withWebgl, viewport = DESKTOP, colorScheme = "light", ...options } = {}) {
  const kind = JSON.stringify([browser === withWebgl, options]);
  const page = tabs.get(kind)?.pop() ?? await newTab(browser, options);
  page.kind = kind;
  page.file = join(directory, name.endsWith(".html") ? name : join(name, "report.html"));
  page.complaints = [];
  await show(page, viewport, colorScheme);
  await page.goto(`file://${page.file}`);
  if (options.javaScriptEnabled !== false && name !== APART) {
    await page.waitForFunction(() => document.documentElement.classList.contains("drawn"));
  }
  return page;
}

/// On a screen of this size.
async function show(page, viewport = DESKTOP, colorScheme = "light") {
  await page.mouse.move(0, 0);
  await page.setViewportSize(viewport);
  await page.emulateMedia({ media: null, colorScheme });
}

function assertNoComplaints(page) {
  // WebGL's driver remarks on how fast it is.
  assert.deepEqual(page.complaints.filter((text) => !/GL Driver Message/.test(text)), []);
}

/// A test that fails before leaves its tab as it is, to nobody.
async function close(page) {
  assertNoComplaints(page);
  tabs.set(page.kind, [...(tabs.get(page.kind) ?? []), page]);
}

/// Tests that leave a report as it was, by report. Those of one report share its page, on a desktop's screen unless
/// they set another. They run after all other tests, of two reports at a time.
const looks = new Map();

function look(name, words, check) {
  looks.set(name, [...(looks.get(name) ?? []), [words, check]]);
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
  "robot2-sphere-q2-q3": { plane: true, panels: 17 },
  "robot2-free-q2-q3": { panels: 17 },
  "robot2-implicit-rail": { panels: 17 },
  "tutorial/03-a-smooth-move": { plane: true, panels: 17 },
  "tutorial/04-tolerances": { plane: true, panels: 17, tolerances: true },
  "robot1-geodesic": { panels: 17 },
  "robot1-cable-lengths": { panels: 17 },
  "robot1-straight-qs-qg": { plane: true, panels: 17, stretches: true },
  [STACK]: { panels: 24, tolerances: true },
  "bodies.html": { plane: true, panels: 24 },
  "contact.html": { plane: true, panels: 21 },
  "thin-plate": { panels: 19, stretches: true },
  "tutorial/02-a-slack-start": { plane: true, panels: 0 },
  "refuted.html": { plane: true, panels: 14 },
  "singular.html": { plane: true, panels: 14 },
  "undecided.html": { plane: true, panels: 14, stretches: true },
};

for (const [name, expected] of Object.entries(PAGES)) {
  look(name, "everything is drawn", async (page) => {
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
  });
}

look("no_path.html", "words and the plane, nothing to play", async (page) => {
  for (const id of SECTIONS) assert.ok(await has(page, `section#${id}`), id);
  assert.equal(await has(page, "section#theorem"), false);
  assert.equal(await has(page, ".controls"), false);
  assert.ok(await has(page, ".plane-figure svg"));
});

look(APART, "the certificate's cells part start and goal, in the case's units, without a script", async (page) => {
  for (const id of SECTIONS_OF_THEOREMS) assert.equal(await has(page, `section#${id}`), id !== "path", id);
  assert.equal(await has(page, "script"), false);
  assert.match(await page.textContent(".masthead"), /TAUT-/);
  assert.match(await page.textContent(".band"), /NO PATH EXISTS.*coordinates within their ranges/s);
  const scope = await page.textContent(".scope");
  for (const words of ["−1.8413 rad", "pz = 350 mm", "above 0.05 N and below 0.5 N"]) {
    assert.ok(scope.includes(words), words);
  }
  const found = await page.evaluate(() => {
    const [start, goal] = [...document.querySelectorAll(".walls circle.place")].map((disc) =>
      new DOMPoint(Number(disc.getAttribute("cx")), Number(disc.getAttribute("cy"))).matrixTransform(disc.getCTM()));
    const isIn = (kind, at) => {
      const path = document.querySelector(`.walls path.${kind}`);
      return path.isPointInFill(at.matrixTransform(path.getCTM().inverse()));
    };
    const names = [...document.querySelectorAll(".walls text.place")].map((text) => text.getBoundingClientRect());
    const apart = names[0].right <= names[1].left || names[1].right <= names[0].left ||
      names[0].bottom <= names[1].top || names[1].bottom <= names[0].top;
    return [...[start, goal].flatMap((at) => ["from-start", "from-goal"].map((kind) => isIn(kind, at))), apart];
  });
  assert.deepEqual(found, [true, false, false, true, true]);
  assert.equal(await page.locator(".ends .machine > svg").count(), 2);
  await picture(page, "no-path-exists");
});

/// In the page: the kinds of the plane's cells, from the signs in its data: 0 inside, 1 tension out, 2 length out, 3
/// both.
const cellKinds = () => {
  const { grid } = JSON.parse(document.getElementById("data").textContent).plane;
  const isOut = (text) => text.replace(/(\d+)([A-Za-z])/g, (_, count, letter) => letter.repeat(Number(count)))
    .split("").map((letter) => letter >= "a");
  const [tension, length] = [isOut(grid.tension), isOut(grid.length)];
  return { ...grid, kinds: tension.map((out, k) => Number(out) + 2 * Number(length[k])) };
};

/// The values of a grid of a case's map (docs/maps.md), made as the page makes its map.
async function gridOf(name, size) {
  const file = join(directory, `grid-${name}.npy`);
  await run("map", join(cases, `${name}.yaml`), "--cell", String(1 / 512), "--cells", "60000", "--grid", file,
    "--grid-size", String(size));
  const bytes = readFileSync(file);
  return [...bytes.subarray(10 + bytes.readUInt16LE(8))];
}

for (const name of ["robot2-sphere-q2-q3", "robot1-slice-qs-qg"]) {
  look(name, "behind the path is the map that taut map proves, and its legend has what is there", async (page) => {
    const size = 64;
    const seen = await page.evaluate((size) => {
      const { map } = JSON.parse(document.getElementById("data").textContent).plane.grid;
      const paths = Object.fromEntries([...document.querySelectorAll(".plane-figure svg .area")].map((path) =>
        [path.dataset.kind, path]));
      const kinds = [];
      for (let i = 0; i < size; ++i) {
        for (let j = 0; j < size; ++j) {
          const at = new DOMPoint(((i + 0.5) * map.units) / size, ((j + 0.5) * map.units) / size);
          kinds.push(Object.keys(paths).filter((kind) => paths[kind].isPointInFill(at)));
        }
      }
      const disc = document.querySelector(".plane-figure .start circle");
      const start = new DOMPoint(Number(disc.getAttribute("cx")), Number(disc.getAttribute("cy")))
        .matrixTransform(disc.getCTM());
      const isInside = [...document.querySelectorAll('.plane-figure svg .area[data-kind="inside"]')].some((path) =>
        path.isPointInFill(start.matrixTransform(path.getCTM().inverse())));
      return { kinds, isInside, all: Object.keys(map.areas), legend: document.querySelector(".plane-figure .legend")
        .textContent, note: document.querySelector(".plane-figure .source").textContent };
    }, size);
    const checked = Array(6).fill(0);
    (await gridOf(name, size)).forEach((value, k) => {
      const kinds = seen.kinds[k];
      const isOutside = ["tension", "length", "unbalanced"].some((kind) => kinds.includes(kind));
      ++checked[value];
      if (value === 2) assert.ok(isOutside && !kinds.includes("inside"), `${k}: ${kinds}`);
      if ([1, 3, 5].includes(value)) assert.ok(kinds.includes("inside") && !isOutside, `${k}: ${kinds}`);
      if ([3, 5].includes(value)) assert.equal(kinds.includes("cut_off"), value === 5, `${k}: ${kinds}`);
    });
    assert.ok(checked[2] > 300 && checked[3] > 100, String(checked));
    assert.ok(seen.isInside, "the path starts inside");
    const words = { inside: "inside: all limits kept", tension: "a tension out", length: "a length out",
      unbalanced: "can't be balanced", undecided: "undecided", both: "tensions and lengths", cut_off: "no motion from",
      singular: "encloses det J = 0" };
    for (const [kind, text] of Object.entries(words)) {
      assert.equal(seen.legend.includes(text), seen.all.includes(kind), kind);
    }
    assert.ok(seen.legend.includes("charts of the atlas"));
    assert.match(seen.note, /taut-check has not confirmed it/);
    assert.equal(/witness|violated|left open|enlarged/.test(seen.legend), false);
  });
}

test("the plane says what is proved under the pointer", async () => {
  const page = await open("robot1-slice-qs-qg");
  await page.locator(".plane-figure").scrollIntoViewIfNeeded();
  const box = await page.locator(".plane-figure .start circle").boundingBox();
  await page.mouse.move(box.x + box.width / 2 + 14, box.y + box.height / 2 + 30);
  assert.match(await page.textContent(".plane-figure .readout"), /φ = .*inside: all limits kept \(proved\)/);
  await close(page);
});

for (const name of ["unchecked.html"]) {
  look(name, "the plane's contours agree with the samples, and its legend with the plane", async (page) => {
    const { checked, wrong, present, isHatched } = await page.evaluate(({ rows, columns, kinds }) => {
      const svg = document.querySelector(".plane-figure svg");
      const frame = svg.querySelector(".plane rect.inside");
      const [x, y, width, height] = ["x", "y", "width", "height"].map((a) => Number(frame.getAttribute(a)));
      const regions = ["tension", "length"].map((kind) => svg.querySelector(`.plane path.${kind}`));
      const result = { checked: [0, 0, 0, 0], wrong: [], present: [0, 1, 2, 3].filter((k) => kinds.includes(k)) };
      for (let row = 1; row + 1 < rows; row += 3) {
        for (let column = 1; column + 1 < columns; column += 3) {
          const kind = kinds[row * columns + column];
          let isAtContour = false;
          for (const r of [-1, 0, 1]) {
            for (const c of [-1, 0, 1]) isAtContour ||= kinds[(row + r) * columns + column + c] !== kind;
          }
          if (isAtContour) continue;
          const at = new DOMPoint(x + (width * (column + 0.5)) / columns, y + (height * (row + 0.5)) / rows);
          const found = regions.reduce((sum, path, k) => sum + (path.isPointInFill(at) ? 1 << k : 0), 0);
          ++result.checked[kind];
          if (found !== kind) result.wrong.push([row, column, kind, found]);
        }
      }
      return { ...result, isHatched: svg.querySelector(".hatched") !== null };
    }, await page.evaluate(cellKinds));
    assert.deepEqual(wrong, []);
    for (const kind of present) assert.ok(checked[kind] > 10 || kind === 2, `${checked[kind]} of ${kind}`);
    assert.ok(checked.reduce((a, b) => a + b) > 2000);
    const words = ["in C", "a tension out", "a length out", "both out"];
    const legend = await page.textContent(".plane-figure .legend");
    words.forEach((text, kind) => assert.equal(legend.includes(text), present.includes(kind), text));
    assert.equal(isHatched, present.includes(3));
    assert.ok(legend.includes("charts of the atlas"));
    assert.equal(/witness|violated|left open/.test(legend), false);
  });
}

look("robot2-sphere-q2-q3", "the plane: Greek letters", async (page) => {
  assert.match(await page.textContent(".plane-figure svg [aria-label='x-axis label']"), /α₁/);
  assert.equal(await page.locator(".plane-figure svg").count() > 0, true);
  assert.equal(await page.locator(".maps > svg").count(), 1);
});

look("proved.html", "the plane: a short path is enlarged", async (page) => {
  assert.equal(await page.locator(".maps > svg").count(), 2);
  assert.ok(await shown(page, ".plane-figure rect.enlarged"));
  assert.match(await page.textContent(".plane-figure .legend"), /enlarged/);
  assert.equal(await page.locator(".maps > svg:nth-child(2) .start").count(), 1);
});

look("no_path_of_query.html", "the plane: what was asked for, where no path was found", async (page) => {
  assert.equal(await has(page, ".plane-figure .path[d]:not(.key *)"), false);
  assert.equal(await page.locator(".plane-figure .start").count(), 1);
  assert.doesNotMatch(await page.textContent(".plane-figure .legend"), /path, S to G/);
  for (const gone of ["#tensions", "#lengths", "#pose", ".controls", ".bar-player"]) {
    assert.equal(await has(page, gone), false, gone);
  }
});

for (const name of ["robot1-slice-qs-qg", "robot1-straight-qs-qg", "refuted.html", "tutorial/04-tolerances"]) {
  look(name, "six plots share a scale, and the nearest to its limit is first", async (page) => {
    const { tension, length, is_proved: isProved } = await page.evaluate(() =>
      JSON.parse(document.getElementById("data").textContent).cables);
    for (const [id, uses] of [["tensions", tension], ["lengths", length]]) {
      const panels = page.locator(`#${id} .panel`);
      const scales = await panels.evaluateAll((all) => all.map((panel) =>
        [...panel.querySelectorAll('[aria-label="y-axis tick label"] text')].map((text) =>
          `${text.textContent} at ${text.getAttribute("transform")}`).join()));
      assert.equal(scales.length, 6);
      assert.equal(new Set(scales).size, 1, scales.join("\n"));
      const titles = await panels.locator(".title").allTextContents();
      assert.deepEqual(titles, uses.order.map((cable) => `Cable ${cable + 1}`));
      const rank = (cable) => ["calm", "near", "close", "out"].indexOf(uses.nearness[cable]);
      for (let k = 1; k < 6; ++k) assert.ok(rank(uses.order[k - 1]) >= rank(uses.order[k]));
      for (const range of await panels.locator(".range").allTextContents()) {
        assert.match(range, isProved ? /^proved / : /^sampled |^no bound: /);
      }
    }
  });
}

for (const name of ["robot1-slice-qs-qg", "robot1-straight-qs-qg", "tutorial/02-a-slack-start", "proved.html"]) {
  look(name, "no plot draws outside its frame", async (page) => {
    const outside = await page.evaluate(() => {
      const within = (a, b) => a.x >= b.x - 1 && a.y >= b.y - 1 && a.x + a.width <= b.x + b.width + 1 &&
        a.y + a.height <= b.y + b.height + 1;
      const found = [];
      for (const svg of document.querySelectorAll(".drawing > svg, .maps > svg")) {
        const frame = svg.querySelector('[aria-label="frame"]').getBBox();
        const clip = (shape) => {
          const holder = shape.closest("[clip-path]");
          if (!holder) return undefined;
          const id = holder.getAttribute("clip-path").match(/#([^")]+)/)[1];
          return document.getElementById(id)?.firstElementChild?.getBBox();
        };
        for (const shape of svg.querySelectorAll("path, rect, circle, line")) {
          if (shape.closest("defs, clipPath, [aria-label*='axis'], .start, .goal, .here, .cursor, .witness")) continue;
          const box = clip(shape) ?? shape.getBBox();
          if (!within(box, frame)) found.push(shape.outerHTML.slice(0, 200));
        }
      }
      return found;
    });
    assert.deepEqual(outside, []);
  });
}

for (const [device, viewport] of [["desktop", DESKTOP], ["phone", PHONE]]) {
  test(`the bar stays at the top of a ${device}: verdict, player, contents`, async () => {
    const page = await open("robot1-slice-qs-qg", { viewport });
    await page.evaluate(() => scrollTo(0, document.documentElement.scrollHeight));
    await frames(page);
    const box = await page.locator(".bar").boundingBox();
    assert.ok(box.y >= -1 && box.y < 1 && box.height < 64, JSON.stringify(box));
    assert.match(await page.textContent(".bar .state"), /PROVED/);
    for (const part of [".state", ".bar-play", "input[type=range]", "summary"]) {
      const inner = await page.locator(`.bar ${part}`).boundingBox();
      assert.ok(inner.y >= 0 && inner.y + inner.height <= 64 && inner.x >= 0 && inner.x + inner.width <= viewport.width,
        `${part}: ${JSON.stringify(inner)}`);
    }
    assert.ok(await page.evaluate(() => document.documentElement.scrollWidth) <= viewport.width, "nothing sticks out");
    await page.$eval(".bar input[type=range]", (slider) => {
      slider.value = "500";
      slider.dispatchEvent(new Event("input"));
    });
    assert.ok((await cursors(page))[0] > 100, "it moves the plots' cursor");
    assert.equal(await page.$eval(".controls input[type=range]", (slider) => slider.value), "500");
    await page.click(".bar .bar-play");
    assert.equal(await page.getAttribute(".bar .bar-play", "aria-label"), "Pause");
    await page.click(".bar .bar-play");
    await page.click(".bar summary");
    await page.click(".bar details a[href='#lengths']");
    assert.equal(await page.$eval(".bar details", (menu) => menu.open), false, "the menu closes");
    const title = await page.locator("#lengths h2").boundingBox();
    assert.ok(title.y > 40 && title.y < 400, `the section is below the bar: ${title.y}`);
    await page.emulateMedia({ media: "print" });
    assert.equal(await shown(page, ".bar"), false);
    await close(page);
  });
}

test("the bar without a script has verdict and contents", async () => {
  const still = await open("robot1-slice-qs-qg", { javaScriptEnabled: false });
  assert.ok(await shown(still, ".bar .state"));
  assert.ok(await shown(still, ".bar .quick a"));
  assert.equal(await has(still, ".bar input"), false);
  await close(still);
});

for (const [name, words] of [["no_path.html", /NO PATH FOUND/], ["tutorial/02-a-slack-start", /DO NOT RUN/]]) {
  look(name, "without a move the bar has no player", async (page) => {
    assert.match(await page.textContent(".bar .state"), words);
    assert.equal(await has(page, ".bar-player, .controls .play"), false);
  });
}

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
  assert.match(await page.textContent("#tensions .readout"), /^here .*N$/);
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
  const hint = page.waitForSelector(".hint.shown"); // for two seconds, which a busy machine may take for a frame
  await page.mouse.wheel(0, 120);
  await page.waitForFunction((was) => scrollY > was + 60, before);
  await frames(page);
  assert.equal(await metresPerPixel(page), scale, "nothing zooms");
  assert.match(await (await hint).textContent(), /Ctrl/);
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
  const page = await open("robot1-slice-qs-qg", { viewport: PHONE, hasTouch: true });
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
  const marks = await page.$$eval(".track", (tracks) => tracks.map((track) => [
    Number(track.querySelector(".worst-mark").style.getPropertyValue("--share")), Number(track.firstChild.value)]));
  assert.equal(marks.length, 2, "of the player and of the bar");
  for (const [share, value] of marks) {
    assert.ok(share > 0 && Math.abs(share * 1000 - value) <= 1, "it is marked on the slider");
  }
  await close(page);
});

look("cranes/portal-20t", "a frame and a payload that it shows are drawn, and said to be unchecked", async (page) => {
  assert.match(await page.textContent("figure.machine .note"), /frame and the payload .* not checked/);
  assert.match(await page.textContent('#move'), /drawn only, not checked/);
  const still = (kind) => page.$eval(`figure.machine .${kind}`, (path) => path.getAttribute("d").match(/M/g).length);
  assert.equal(await still("shown.edges"), 12, "of a container, the edges");
  assert.ok(await still("shown") > 80, "of a frame of eight bars, some edges of which coincide");
});

test("bodies are drawn, named, said to be checked, and the nearest pair is shown at the cursor", async () => {
  const page = await open(STACK);
  assert.match(await page.innerText("[data-plot=move] .legend"), /obstacles: floor, stack \(checked\)/);
  assert.match(await page.innerText("[data-plot=move] .legend"), /on the platform: container \(checked\)/);
  const said = async () => (await page.innerText(".readout-table .bodies"));
  assert.match(await said(), /^Nearest bodies: .+ \/ .+, [0-9.]+ m apart \(clearance 0\.[0-9]+ m\)$/);
  const before = await said();
  await page.locator(".controls input[type=range]").first().fill("500");
  await frames(page);
  assert.notEqual(await said(), before);
  // The container is somewhere in the picture.
  const box = await page.locator(".stage canvas").boundingBox();
  const names = new Set();
  for (let x = 0.05; x < 1; x += 0.05) {
    for (let y = 0.05; y < 1; y += 0.05) {
      await page.mouse.move(box.x + x * box.width, box.y + y * box.height);
      const tag = page.locator(".labels .pointed.shown");
      if (await tag.count() > 0) names.add(await tag.innerText());
    }
  }
  assert.deepEqual([...names].sort(), ["container (checked)", "floor (checked)", "stack (checked)"]);
  await picture(page, "bodies-in-the-middle");
  await close(page);
});

look("contact.html", "a contact is named with pair, place and depth, and the move opens where it is", async (page) => {
  assert.match(await page.innerText(".headline"), /'plate' and 'post' touch; the clearance asked for is 30 mm/);
  assert.match(await page.innerText("table.broken"), /plate \/ post in each other\s+about [0-9.]+ mm deep/);
  assert.match(await page.innerText(".readout-table .bodies.out"),
    /plate \/ post, in each other, about [0-9.]+ mm deep/);
  assert.match(await page.innerText(".checks"), /not checked: cables among each other, cables and platform/);
});

look("robot1-straight-qs-qg", "it opens at its witness, where the cable is out of its limits", async (page) => {
  await frames(page);
  assert.match(await page.textContent(".where"), /violation/);
  assert.ok(await has(page, ".labels .cable.out"));
  assert.match(await page.textContent(".labels .cable.out"), /!/);
});

look("no_path_of_query.html", "no path was found: start and goal are shown and nothing plays", async (page) => {
  assert.ok(await shown(page, ".stage canvas"));
  for (const part of [".play", "input[type=range]", ".readout-table"]) {
    assert.equal(await has(page, `#move ${part}`), false, part);
  }
  assert.equal(await page.locator(".labels .cable:visible").count(), 0);
  assert.deepEqual(await page.$$eval(".labels .end", (tags) => tags.map((tag) => tag.textContent)), ["S", "G"]);
  assert.doesNotMatch(await page.locator('#move > [data-plot="move"]').innerText(), /proved|path of/);
  assert.equal(await has(page, '.views button:text-is("Worst place")'), false);
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

look("robot1-slice-qs-qg", "in the dark, and on a narrow screen", async (page) => {
  await show(page, PHONE, "dark");
  const brightness = (colour) => colour.match(/\d+/g).slice(0, 3).reduce((sum, c) => sum + Number(c), 0);
  assert.ok(brightness(await page.$eval("html", (html) => getComputedStyle(html).backgroundColor)) < 150);
  assert.ok(brightness(await page.$eval(".drawing svg text", (words) => getComputedStyle(words).fill)) > 400);
  assert.ok(await page.evaluate(() => document.documentElement.scrollWidth) <= 390, "nothing sticks out");
  await picture(page, "dark-narrow");
});

for (const name of ["robot1-slice-qs-qg", "robot1-straight-qs-qg", "undecided.html"]) {
  look(name, "on paper: all sections, still picture, plots", async (page) => {
    await page.emulateMedia({ media: "print" });
    assert.ok(await shown(page, ".still svg"));
    assert.equal(await shown(page, ".stage"), false);
    for (const section of await page.$$("section:not(#margins, #exact-path)")) assert.ok(await section.isVisible());
    assert.ok(await shown(page, ".drawing svg"));
  });
}

look("tutorial/04-tolerances", "the assurance case: words within their shapes, shapes apart, and a list of them all",
  async (page) => {
    const drawn = await page.$$eval(".gsn svg", (drawings) => drawings.map((svg) =>
      [...svg.querySelectorAll("g")].map((g) => {
        const [shape, text] = [".shape", "text:not(.kind)"].map((selector) => {
          const { x, y, width, height } = g.querySelector(selector).getBBox();
          return { x, y, width, height };
        });
        return { id: g.querySelector(".id").textContent, shape, text };
      })));
    assert.equal(drawn.length, 2);
    const right = (box) => box.x + box.width;
    const foot = (box) => box.y + box.height;
    const inside = (a, b) => a.x >= b.x && a.y >= b.y && right(a) <= right(b) && foot(a) <= foot(b);
    const apart = (a, b) => right(a) <= b.x || right(b) <= a.x || foot(a) <= b.y || foot(b) <= a.y;
    for (const nodes of drawn) {
      nodes.forEach(({ id, shape, text }, k) => {
        assert.ok(inside(text, shape), `the words of ${id} stay in its shape`);
        for (const other of nodes.slice(k + 1)) assert.ok(apart(shape, other.shape), `${id} and ${other.id} overlap`);
      });
    }
    const ids = new Set(drawn.flat().map(({ id }) => id));
    const listed = await page.$$eval(".argument li > b", (marks) => marks.map((mark) => mark.textContent));
    assert.deepEqual(listed.sort(), [...ids].sort());
    await picture(page, "assurance-case");
  });

look("undecided.html", "of what is not decided there is no assurance case", async (page) => {
  assert.equal(await has(page, ".gsn"), false);
  assert.match(await page.textContent("#assurance"), /There is no assurance case/);
});

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

look("unchecked.html", "of a certificate that was not checked, nothing is drawn as proved", async (page) => {
  assert.ok(await shown(page, ".stage canvas"));
  assert.equal(await page.locator(".panel .drawing svg").count(), 14, "no margins");
  for (const place of ["#move", "#tensions"]) {
    assert.doesNotMatch(await page.locator(`${place} > [data-plot]`).innerText(), /proved/);
  }
});

/// What axe says of the page as it is now, through the debugger, which the page's policy does not bind.
async function axe(page, options = {}) {
  page.debugger ??= await page.context().newCDPSession(page);
  const source = readFileSync(createRequire(import.meta.url).resolve("axe-core/axe.min.js"), "utf8");
  await page.debugger.send("Runtime.evaluate", { expression: `globalThis.axe ?? (() => { ${source} })()` });
  const asked = JSON.stringify({ resultTypes: ["violations"], ...options });
  const { result, exceptionDetails } = await page.debugger.send("Runtime.evaluate", {
    expression: `axe.run(${asked}).then(({ violations }) => JSON.stringify(violations.map((v) =>
      [v.id, v.nodes.map((n) => n.html.slice(0, 160)).slice(0, 4)])))`,
    awaitPromise: true,
    returnByValue: true,
  });
  assert.equal(exceptionDetails, undefined);
  return JSON.parse(result.value);
}

const KINDS = [...Object.keys(PAGES), APART, "proved.html", "no_path.html", "unchecked.html", "hostile.html"];

test("axe notices what is wrong", async () => {
  writeFileSync(join(directory, "bad.html"), `<!DOCTYPE html><html class="drawn" lang="en"><title>x</title><main>
    <h1>x</h1><p style="color:#aaa;background:#fff">pale</p></main>`);
  const page = await open("bad.html");
  assert.deepEqual((await axe(page)).map(([id]) => id), ["color-contrast"]);
  await page.context().close();
});

for (const name of KINDS) {
  look(name, "axe finds nothing, and nothing sticks out, on desktop and phone, light and dark", async (page) => {
    for (const viewport of [DESKTOP, PHONE]) {
      await page.setViewportSize(viewport);
      await frames(page);
      const width = await page.evaluate(() => document.documentElement.scrollWidth);
      assert.ok(width <= viewport.width, `${width} px wide on a screen of ${viewport.width}`);
      assert.deepEqual(await axe(page), [], `${viewport.width} px`);
    }
    await page.emulateMedia({ colorScheme: "dark" });
    assert.deepEqual(await axe(page, { runOnly: ["color-contrast"] }), [], "dark");
    await picture(page, `phone-dark-${name.replaceAll("/", "-")}`);
  });
}

test("wide tables scroll in their own box, which says so and answers to keys; others are no stop", async () => {
  const page = await open("robot1-planned", { viewport: PHONE });
  for (const details of await page.$$("details:not([open]) > summary")) await details.click();
  await frames(page);
  const boxes = await page.$$eval(".scroll, .readout-table", (all) => all
    .filter((box) => box.checkVisibility())
    .map((box) => ({
      wide: box.scrollWidth > box.clientWidth + 1,
      focusable: box.tabIndex === 0,
      name: box.getAttribute("role") === "region" && box.getAttribute("aria-label"),
      hint: getComputedStyle(box, "::before").content,
    })));
  assert.ok(boxes.some(({ wide }) => wide) && boxes.some(({ wide }) => !wide));
  for (const box of boxes) {
    assert.equal(box.focusable, box.wide);
    assert.equal(Boolean(box.name), box.wide);
    assert.equal(box.hint.includes("scroll sideways"), box.wide);
  }
  const wide = page.locator(".overflows").first();
  await wide.focus();
  await page.keyboard.press("ArrowRight");
  await page.waitForFunction(() => document.activeElement.scrollLeft > 0);
  await close(page);
});

/// The fonts of the words that stand in the selected elements themselves.
async function fonts(page, selector) {
  page.debugger ??= await page.context().newCDPSession(page);
  const { root } = await page.debugger.send("DOM.getDocument");
  await page.debugger.send("CSS.enable");
  const { nodeIds } = await page.debugger.send("DOM.querySelectorAll", { nodeId: root.nodeId, selector });
  const found = await Promise.all(
    nodeIds.map((nodeId) => page.debugger.send("CSS.getPlatformFontsForNode", { nodeId })));
  return found.flatMap((answer) => answer.fonts);
}

async function assertTypeface(page) {
  const used = await fonts(page, "h1 bdi, h2, p, li, dd, th, caption, .formulas *, .still text, .drawing text, " +
    "tr:nth-child(2) td");
  assert.ok(used.filter((font) => font.isCustomFont && /^Inter/.test(font.familyName)).length > 50);
  for (const { isCustomFont, familyName } of used) assert.ok(isCustomFont || /Mono/.test(familyName), familyName);
}

for (const name of ["robot1-slice-qs-qg", "tutorial/04-tolerances", "refuted.html"]) {
  look(name, "the page brings its typeface", assertTypeface);
  test(`${name}: the page brings its typeface without a script, too`, async () => {
    const page = await open(name, { javaScriptEnabled: false });
    await assertTypeface(page);
    await close(page);
  });
}

look("robot1-slice-qs-qg", "the typeface has what reports write, and equal figures", async (page) => {
  await page.evaluate(() => document.querySelector("main").insertAdjacentHTML("afterbegin",
    `<div id="added"><p id="signs">≤ ≥ − ° · √ ± × ² ½ ⟹ → ≠ φ θ σ λ π Σ ₀ ℓ é ß Ł ő ✓ ⚠</p>
    <p id="logic">∀ ∃ ∈ ∉</p><p style="font-variant-numeric: tabular-nums"><span id="ones">1111</span><br>
    <span id="eights">8888</span></p></div>`));
  await page.evaluate(() => document.fonts.ready);
  for (const [selector, family] of [["#signs", /^Inter/], ["#logic", /^(Inter|Noto Sans Math)/]]) {
    for (const font of await fonts(page, selector)) {
      assert.ok(font.isCustomFont, `${selector}: ${font.familyName}`);
      assert.match(font.familyName, family);
    }
  }
  const [ones, eights] = await page.$$eval("#ones, #eights", (all) => all.map((x) => x.getBoundingClientRect().width));
  await page.$eval("#added", (added) => added.remove());
  assert.ok(Math.abs(ones - eights) < 0.01, `${ones} and ${eights} px`);
});

look("robot1-slice-qs-qg", "on paper: colours of light paper, whatever the reader's choice", async (page) => {
  const colours = async (colorScheme) => {
    await page.emulateMedia({ media: "print", colorScheme });
    return page.evaluate(() => {
      const style = getComputedStyle(document.documentElement);
      const names = [...document.styleSheets].flatMap((sheet) => [...sheet.cssRules])
        .flatMap((rule) => (rule.selectorText === ":root" ? [...rule.style].filter((x) => x.startsWith("--")) : []));
      return [style.backgroundColor, ...names.map((name) => `${name}: ${style.getPropertyValue(name)}`)];
    });
  };
  const light = await colours("light");
  assert.equal(light[0], "rgb(255, 255, 255)");
  assert.ok(light.length > 20);
  assert.deepEqual(await colours("dark"), light);
});

/// Each page of a PDF, from the top of what is printed between head and foot: how far down there is ink, from 0 to 1.
function fills(pdf) {
  const A4 = 297; // [mm]
  const [top, bottom] = [16, 14]; // margins [mm]
  const pages = execFileSync("pdftoppm", ["-r", "30", "-gray", pdf], { maxBuffer: 1 << 28 });
  const result = [];
  for (let at = 0; at < pages.length;) {
    const [head, width, height] = pages.toString("latin1", at, at + 40).match(/^P5\s+(\d+)\s+(\d+)\s+255\s/);
    const pixels = pages.subarray(at + head.length, at + head.length + width * height);
    const [first, last] = [top, A4 - bottom].map((mm) => Math.round((height * mm) / A4));
    let lowest = first;
    for (let row = first; row < last; ++row) {
      if (pixels.subarray(row * width, (row + 1) * width).some((grey) => grey < 215)) lowest = row;
    }
    result.push((lowest - first) / (last - first));
    at += head.length + width * height;
  }
  return result;
}

/// The words of each page, in lines.
const wordsOf = (pdf) => execFileSync("pdftotext", ["-layout", pdf, "-"], { encoding: "utf8", maxBuffer: 1 << 28 })
  .split("\f").slice(0, -1).map((page) => page.split("\n").map((line) => line.trim()).filter(Boolean));

const PAPER = {
  "robot1-slice-qs-qg": { verdict: "PROVED", most: 9 },
  "tutorial/04-tolerances": { verdict: "PROVED", most: 10 },
  "robot1-straight-qs-qg": { verdict: "DO NOT RUN", most: 10 },
  [STACK]: { verdict: "PROVED", most: 11 },
  "contact.html": { verdict: "DO NOT RUN", most: 10 },
  "robot1-planned": { verdict: "PROVED", most: 10 },
  "undecided.html": { verdict: "NO DECISION", most: 9 },
  "tutorial/02-a-slack-start": { verdict: "DO NOT RUN", most: 7 },
  [APART]: { verdict: "NO PATH EXISTS", least: 3, most: 5 },
};

for (const [name, expected] of Object.entries(PAPER)) {
  look(name, "on paper: head and foot on each page, and no page half empty", async (page) => {
    await show(page, DESKTOP, "dark");
    const pdf = join(directory, `paper-${name.replaceAll("/", "-")}.pdf`);
    await page.pdf({ path: pdf, preferCSSPageSize: true });
    const number = await page.textContent(".masthead dd");
    const pages = wordsOf(pdf);
    console.log(`${name} on paper: ${fills(pdf).map((x) => `${Math.round(100 * x)} %`).join(", ")}`);
    if (screenshots) copyFileSync(pdf, join(screenshots, `${name.replaceAll("/", "-")}.pdf`));
    assert.ok(pages.length >= (expected.least ?? 4) && pages.length <= expected.most, `${pages.length} pages`);
    pages.forEach((lines, k) => {
      assert.match(lines.at(-1), new RegExp(`Page ${k + 1} of ${pages.length}$`));
      if (k > 0) assert.ok(lines[0].includes(`${expected.verdict} · ${number}`), lines[0]);
    });
    for (const fill of fills(pdf).slice(1, -1)) assert.ok(fill > 0.5, `filled to ${fill}`);
  });
}

look("robot1-planned", "200 segments: how large, how soon", async (page) => {
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
});

test("looks", { concurrency: 2 }, async (all) => {
  const checkReport = ([name, checks]) => all.test(name, async (one) => {
    const page = await open(name);
    for (const [words, check] of checks) {
      await one.test(words, async () => {
        await show(page);
        await check(page);
        assertNoComplaints(page);
      });
    }
    await close(page);
  });
  await Promise.all([...looks].map(checkReport));
});
