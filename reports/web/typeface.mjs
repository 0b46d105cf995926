// SPDX-License-Identifier: GPL-3.0-or-later
// typeface.mjs OUT.cc: makes the @font-face rules that reports/page/typeface.h declares, as a C++ source: fonts of npm
// packages with no more letters than reports need.
import { readFileSync, writeFileSync } from "node:fs";
import { basename, dirname, resolve } from "node:path";
import { fileURLToPath } from "node:url";
import subsetFont from "subset-font";

const out = resolve(process.argv[2]);
const packages = resolve(dirname(fileURLToPath(import.meta.url)), "../../node_modules");

const range = (first, last) =>
  Array.from({ length: last - first + 1 }, (_, k) => String.fromCodePoint(first + k)).join("");

/// What is written in Europe's Latin letters and in Greek, with punctuation, and the signs of formulas and buttons.
const LETTERS = range(0x20, 0x7e) + range(0xa0, 0x17f) + range(0x384, 0x3ce) + range(0x2010, 0x2027) +
  range(0x2030, 0x203a) + range(0x2070, 0x209c) + "€ℓ←↑→↓↗↘⟹−√≠≤≥≈∞∑∂✓✗▶◀▲▼●○⚠";

const FACES = [
  {
    name: "Inter",
    package: "inter-ui",
    font: "variable/InterVariable.woff2",
    licence: "LICENSE.txt",
    weight: "400 700",
    text: LETTERS,
    options: {
      keepFeatures: ["kern", "mark", "mkmk", "ccmp", "locl", "tnum"],
      variationAxes: { opsz: 14, wght: { min: 400, max: 700 } },
    },
  },
  {
    name: "Noto Sans Math",
    package: "@fontsource/noto-sans-math",
    font: "files/noto-sans-math-latin-400-normal.woff2",
    licence: "LICENSE",
    weight: "400",
    text: "∀∃∈∉",
    options: { keepFeatures: [] },
  },
];

const NAMES_OF_AUTHOR_AND_LICENCE = [0, 13, 14]; // of OpenType's table "name"

async function rule(face) {
  const file = readFileSync(resolve(packages, face.package, face.font));
  const font = await subsetFont(file, face.text, {
    targetFormat: "woff2", noHinting: true, preserveNameIds: NAMES_OF_AUTHOR_AND_LICENCE, ...face.options,
  });
  return `@font-face { font-family: "${face.name}"; font-weight: ${face.weight}; ` +
    `src: url(data:font/woff2;base64,${font.toString("base64")}) format("woff2"); }`;
}

/// {the line that says whose it is, the licence below it}
function licence(face) {
  const [owner, ...terms] = readFileSync(resolve(packages, face.package, face.licence), "utf8").split(/\r?\n/);
  if (!owner.startsWith("Copyright")) throw new Error(`${face.package}: the licence begins with ${owner}`);
  if (!terms.join("\n").includes("SIL OPEN FONT LICENSE Version 1.1")) throw new Error(`${face.package}: not the OFL`);
  return { owner: `${face.name}: ${owner}`, terms: terms.map((line) => line.trim()).join("\n").trim() };
}

const licences = FACES.map(licence);
const notice = `/*! ${licences.map(({ owner }) => owner).join("\n")}\n\n${licences[0].terms}\n*/`;
const style = `${notice}\n${(await Promise.all(FACES.map(rule))).join("\n")}\n`;
if (style.toLowerCase().includes("</style") || style.indexOf("*/") !== notice.length - 2) {
  throw new Error("the licence would end the style sheet or its comment");
}
/// The text as adjacent raw string literals, because a single one may be too long for some compilers.
const literal = style.match(/[^]{1,60000}/g).map((piece) => `R"taut-css(${piece})taut-css"`).join("\n");
writeFileSync(
  out,
  `// Made by reports/web/typeface.mjs. NOLINTBEGIN
#include "reports/page/typeface.h"
namespace taut {
std::string_view page_typeface() { return ${literal}; }
}  // namespace taut
// NOLINTEND
`,
);
const names = FACES.map(({ name }) => name).join(" and ");
console.log(`${basename(out)}: ${Math.round(style.length / 1024)} kB of ${names}`);
