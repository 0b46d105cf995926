// SPDX-License-Identifier: GPL-3.0-or-later
// bundle.mjs OUT.cc: bundles main.js and what it imports into one script, and writes it as a C++ source that defines
// what reports/page/page_script.h declares. OUT.cc.d says what it was made from. The script opens with the licences of
// all packages in it.
import { build } from "esbuild";
import { createHash } from "node:crypto";
import { readFileSync, readdirSync, writeFileSync } from "node:fs";
import { basename, dirname, resolve } from "node:path";
import { fileURLToPath } from "node:url";

const out = resolve(process.argv[2]);
const here = dirname(fileURLToPath(import.meta.url));
const root = resolve(here, "../..");

/// The script with `banner` in front, the files that were read for it, and those used in it, as paths from the root.
async function bundled(banner) {
  const result = await build({
    absWorkingDir: root,
    entryPoints: [resolve(here, "main.js")],
    bundle: true,
    minify: true,
    format: "iife",
    target: "es2020",
    legalComments: "none", // the banner has them, in full
    banner: { js: banner },
    metafile: true,
    loader: { ".css": "text" },
    write: false,
  });
  const [output] = Object.values(result.metafile.outputs);
  return {
    script: result.outputFiles[0].text,
    read: Object.keys(result.metafile.inputs),
    used: Object.keys(output.inputs).filter((input) => output.inputs[input].bytesInOutput > 0),
  };
}

/// "node_modules/@scope/name/src/x.js" → "@scope/name"; nothing for our own files.
function packageOf(path) {
  return path.match(/^node_modules\/((?:@[^/]+\/)?[^/]+)\//)?.[1];
}

function licenceOf(name) {
  const folder = resolve(root, "node_modules", name);
  const { version, license } = JSON.parse(readFileSync(resolve(folder, "package.json"), "utf8"));
  const file = readdirSync(folder).find((entry) => /^licen[cs]e/i.test(entry));
  const text = file && readFileSync(resolve(folder, file), "utf8");
  return { title: `${name} ${version} (${license})`, text: text ?? `Licence: ${license}` };
}

const kOwnNotice = `This script is part of a report that taut made. Copyright the taut authors.
Output of taut, with the parts of taut that it contains, is not covered by the GPL: you may use, copy, change and pass
on this page under terms of your choice, by the output exception of taut's licence (LICENSE-EXCEPTION), as long as the
notices below are kept.`;

/// A comment with the licence of each package; a text that several share is written once, below all their copyrights.
function notices(packages) {
  const groups = new Map();
  for (const name of packages) {
    const { title, text } = licenceOf(name);
    const lines = text.split(/\r?\n/).map((line) => line.trim());
    const isOwner = (line) => /^copyright (\(c\)|©|\d)/i.test(line);
    const terms = lines.filter((line) => !isOwner(line)).join("\n").trim().replace(/\n{2,}/g, "\n");
    const owners = lines.filter(isOwner).join("; ");
    groups.set(terms, [...(groups.get(terms) ?? []), `${title}. ${owners}`]);
  }
  const body = [...groups].map(([terms, owners]) => `${owners.join("\n")}\n\n${terms}`).join("\n\n----\n\n");
  return `/*!\n${kOwnNotice}\nIt contains the following works.\n\n${body.replaceAll("*/", "* /")}\n*/`;
}

/// The text as adjacent raw string literals, because a single one may be too long for some compilers.
function literal(text) {
  const pieces = text.match(/[^]{1,60000}/g) ?? [""];
  return pieces.map((piece) => `R"taut-js(${piece})taut-js"`).join("\n");
}

const { read, used } = await bundled("");
const packages = [...new Set(used.map(packageOf).filter(Boolean))].sort();
const { script } = await bundled(notices(packages));

// Text that would end the page's script element early, or that a browser would read differently from what was hashed.
for (const forbidden of ["</script", "<!--", "<script", "\r", ")taut-js\""]) {
  if (script.toLowerCase().includes(forbidden)) throw new Error(`the bundle contains ${JSON.stringify(forbidden)}`);
}
const digest = createHash("sha256").update(script, "utf8").digest("base64");

writeFileSync(
  out,
  `// Made by reports/web/bundle.mjs. NOLINTBEGIN
#include "reports/page/page_script.h"
namespace taut {
std::string_view page_script() { return ${literal(script)}; }
std::string_view page_script_sha256() { return "${digest}"; }
}  // namespace taut
// NOLINTEND
`,
);
const sources = [...read.map((input) => resolve(root, input)), resolve(root, "package-lock.json")];
writeFileSync(`${out}.d`, `${out}: ${sources.join(" \\\n  ")}\n`);
console.log(`${basename(out)}: ${Math.round(script.length / 1024)} kB of script from ${packages.length} packages`);
