#!/usr/bin/env node
// SPDX-License-Identifier: GPL-3.0-or-later
// pages.mjs RESULTS TAUT: how large the reports of each kind of result are, how many sheets of A4 they fill, and how
// soon a browser that is already running shows them: text and tables (first contentful paint), plots and controls,
// and everything with the machine in three dimensions. Medians of several loads. Writes RESULTS/pages.md.
import { execFileSync } from "node:child_process";
import { mkdtempSync, readFileSync, rmSync, statSync, writeFileSync } from "node:fs";
import { tmpdir } from "node:os";
import { dirname, join, resolve } from "node:path";
import { fileURLToPath } from "node:url";
import { chromium } from "playwright-core";

const LOADS = 5;
const cases = resolve(dirname(fileURLToPath(import.meta.url)), "../cases");
const [results, taut] = process.argv.slice(2).map((path) => resolve(path));
const directory = mkdtempSync(join(tmpdir(), "taut-pages-"));

/// taut, whatever its verdict; anything else fails.
function run(...args) {
  try {
    return execFileSync(taut, args, { stdio: "pipe" });
  } catch (error) {
    if (error.status !== 1 && error.status !== 2) throw error;
    return error.stdout;
  }
}

const changed = (name, from, to) => {
  const text = readFileSync(join(cases, name), "utf8");
  if (!from.test(text)) throw new Error(`${name} has no ${from}`);
  const file = join(directory, name.replaceAll("/", "-"));
  writeFileSync(file, text.replace(from, to));
  return file;
};

/// The planned path in `count` pieces, as a table.
function manyRows(count) {
  const [, ...lines] = readFileSync(join(cases, "audits/robot1-planned.csv"), "utf8").trim().split("\n");
  const points = lines.map((line) => line.split(",").map(Number)).map((r) => [r[1] + Math.PI * r[3], r[2]]);
  const rows = ["t[s],phi[rad],theta[rad]"];
  for (let i = 0; i <= count; ++i) {
    const x = (i / count) * (points.length - 1);
    const k = Math.min(Math.floor(x), points.length - 2);
    const at = (j) => points[k][j] + (x - k) * (points[k + 1][j] - points[k][j]);
    rows.push(`${i / 100},${at(0)},${at(1)}`);
  }
  const file = join(directory, `rows-${count}.csv`);
  writeFileSync(file, rows.join("\n"));
  return file;
}

const plan = (file) => (out) => run("plan", file, "--out", out);
const audit = (file, path) => (out) => run("audit", file, resolve(cases, "audits", path), "--out", out);
const inCases = (name) => join(cases, `${name}.yaml`);
const KINDS = {
  "proved": plan(inCases("robot1-slice-qs-qg")),
  "proved with tolerances, frame and payload shown": plan(inCases("cranes/portal-20t")),
  "refuted, a limit": audit(inCases("audits/robot1-straight-qs-qg"), "robot1-straight-qs-qg.csv"),
  "refuted, singular": audit(inCases("audits/robot1-bridging"), "robot1-bridging.csv"),
  "refuted by a deviation": audit(inCases("audits/robot1-cable-lengths-too-loose"), "robot1-cable-lengths.csv"),
  "undecided": audit(changed("audits/robot1-cable-lengths-tolerances.yaml", /cable_length: [\d.]+/,
    "cable_length: 0.5 mm"), "robot1-cable-lengths.csv"),
  "no path": plan(changed("robot1-slice-qs-qg.yaml", /waypoints:\n(?:\s+-.*\n)+/,
    "waypoints:\n    - {phi: -114.9 deg, theta: 72 deg}\n    - {phi: -90.5 deg, theta: 86.5 deg}\n")),
  "audit of 20 000 segments": audit(inCases("audits/robot1-planned"), manyRows(20_000)),
};

const median = (list) => [...list].sort((a, b) => a - b)[Math.floor(list.length / 2)];

async function times(browser, file) {
  const loads = [];
  for (let k = 0; k <= LOADS; ++k) {
    const page = await browser.newPage({ viewport: { width: 1240, height: 1000 } });
    await page.goto(`file://${file}`);
    await page.waitForFunction(() => document.documentElement.classList.contains("drawn"), null, { timeout: 60_000 });
    loads.push(await page.evaluate(() => ["first-contentful-paint", "interactive", "drawn"].map(
      (mark) => performance.getEntriesByName(mark)[0]?.startTime ?? NaN)));
    await page.close();
  }
  loads.shift(); // the first load warms the browser
  return [0, 1, 2].map((i) => Math.round(median(loads.map((load) => load[i]))));
}

const browser = await chromium.launch({
  executablePath: "/usr/bin/chromium",
  args: ["--no-sandbox", "--use-angle=swiftshader", "--enable-unsafe-swiftshader"],
});
const rows = [];
for (const [kind, make] of Object.entries(KINDS)) {
  const out = join(directory, kind.replaceAll(/\W+/g, "-"));
  make(out);
  const file = join(out, "report.html");
  run("report", join(out, "certificate.json"), "--pdf", "--out", join(out, "report.pdf"));
  const sheets = execFileSync("pdfinfo", [join(out, "report.pdf")]).toString().match(/Pages:\s+(\d+)/)[1];
  const band = run("report", join(out, "certificate.json"), "--text").toString().split(":")[0];
  rows.push([kind, band, (statSync(file).size / 1e6).toFixed(2), sheets, ...(await times(browser, file))]);
  process.stderr.write(`${rows.at(-1).join(" | ")}\n`);
}
await browser.close();
rmSync(directory, { recursive: true });
const head = ["kind", "verdict", "MB", "sheets of A4", "text, ms", "plots and controls, ms", "all with 3-D, ms"];
const table = [head, head.map((_, i) => (i < 2 ? "---" : "---:")), ...rows].map((row) => `| ${row.join(" | ")} |`);
writeFileSync(join(results, "pages.md"), `# Reports: sizes and times

Chromium with WebGL in software, warm; medians of ${LOADS} loads, from the navigation's begin.

${table.join("\n")}
`);
