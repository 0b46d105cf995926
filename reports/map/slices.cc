// SPDX-License-Identifier: GPL-3.0-or-later
#include "reports/map/slices.h"

#include <nlohmann/json.hpp>
#include <utility>

#include "reports/page/markup.h"

namespace taut {
namespace {

constexpr std::size_t kMostNodes = 1'500'000;  ///< of the page, a digit each

/// A node in the page is a digit, or the character behind '9': the axis that was halved, or kLeafDigit and what is
/// shown of a leaf.
constexpr int kLeafDigit = 3;
enum Shown { kUndecided, kInside, kLength, kTension, kUnbalanced, kContact, kReachable, kInsideCutOff };
static_assert(kContact == static_cast<int>(CellKind::kContact));

int shown(const MapResult& result, std::uint32_t node) {
  const CellKind kind = result.map.nodes[node].kind;
  if (kind == CellKind::kInside && result.region) {
    switch (result.region->reach(node)) {
      case MapRegion::Reach::kReachable: return kReachable;
      case MapRegion::Reach::kCutOff: return kInsideCutOff;
      case MapRegion::Reach::kOpen: break;
    }
  }
  return static_cast<int>(kind);
}

/// The tree in preorder, without the parts of cells of so many halvings.
void add_node(const MapResult& result, std::uint32_t node, int halvings, int deepest, std::string& digits) {
  const MapNode& here = result.map.nodes[node];
  const bool is_leaf = here.axis == MapNode::kLeaf;
  if (!is_leaf && halvings < deepest) {
    digits += static_cast<char>('0' + here.axis);
    for (unsigned side = 0; side < 2; ++side) add_node(result, here.child + side, halvings + 1, deepest, digits);
    return;
  }
  digits += static_cast<char>('0' + kLeafDigit + (is_leaf ? shown(result, node) : kUndecided));
}

/// The most halvings with which the tree has no more than kMostNodes.
int halvings_shown(const CellMap& map) {
  std::array<std::size_t, kMaxCellHalvings + 1> leaves{};
  map.for_each_leaf([&](const Cell& cell, std::uint32_t) { ++leaves[static_cast<std::size_t>(cell.halvings())]; });
  // Of a binary tree, the nodes of each size are the leaves there and half of the nodes that are one halving finer.
  std::array<std::size_t, kMaxCellHalvings + 2> nodes{};
  for (std::size_t n = leaves.size(); n-- > 0;) nodes[n] = leaves[n] + nodes[n + 1] / 2;
  std::size_t sum = 0;
  int deepest = -1;
  for (std::size_t n = 0; n < leaves.size() && sum + nodes[n] <= kMostNodes; ++n) {
    sum += nodes[n];
    ++deepest;
  }
  return deepest;
}

/// JSON inside a script element: "<" can't end it.
std::string script_json(const nlohmann::json& document) {
  std::string text = document.dump(-1, ' ', true);
  for (std::size_t at = text.find('<'); at != std::string::npos; at = text.find('<', at))
    text.replace(at, 1, "\\u003c");
  return text;
}

constexpr const char* kSlicesStyle = R"css(
body { font: 16px/1.45 sans-serif; margin: 1.5rem auto; max-width: 60rem; padding: 0 1rem; color: #1a1a1a; }
h1 { font-size: 1.4rem; margin: 0 0 .3rem; }
canvas { width: 100%; border: 1px solid #222; display: block; }
.plot { display: grid; grid-template-columns: auto 1fr; gap: .2rem .5rem; align-items: center; }
.plot .y { display: flex; flex-direction: column; justify-content: space-between; height: 100%; text-align: right; }
.plot .x { grid-column: 2; display: flex; justify-content: space-between; }
.controls { display: grid; grid-template-columns: auto 1fr; gap: .4rem .8rem; align-items: center; margin: .8rem 0; }
input[type=range] { width: 100%; }
ul { list-style: none; padding: 0; display: flex; flex-wrap: wrap; gap: .2rem 1.2rem; }
.swatch { display: inline-block; width: 1em; height: 1em; border: 1px solid #222; vertical-align: -.15em;
  margin-right: .4em; }
)css";

constexpr const char* kScript = R"js(
"use strict";
const data = JSON.parse(document.getElementById("data").textContent);
const digits = Uint8Array.from(data.tree, (c) => c.charCodeAt(0) - 48);
const canvas = document.getElementById("slice");
const context = canvas.getContext("2d");
const slider = document.getElementById("third");
const choice = document.getElementById("axis");
const byId = (id) => document.getElementById(id);

function hatched(colour, line) {
  const tile = document.createElement("canvas");
  tile.width = tile.height = 8;
  const pen = tile.getContext("2d");
  pen.fillStyle = colour;
  pen.fillRect(0, 0, 8, 8);
  pen.strokeStyle = line;
  pen.beginPath();
  for (const x of [-8, 0, 8]) { pen.moveTo(x, 8); pen.lineTo(x + 8, 0); }
  pen.stroke();
  return context.createPattern(tile, "repeat");
}
const fills = data.looks.map(({ colour, line }) => (line ? hatched(colour, line) : colour));

/// Calls draw(look, lower, upper) for each cell that the slice at t of an axis meets.
function forEachCell(axis, t, draw) {
  let at = 0;
  const lower = [0, 0, 0], upper = [1, 1, 1];
  const visit = (isMet) => {
    const digit = digits[at++];
    if (digit >= 3) {
      if (isMet) draw(digit - 3, lower, upper);
      return;
    }
    const [from, to] = [lower[digit], upper[digit]];
    const middle = (from + to) / 2;
    upper[digit] = middle;
    visit(isMet && (digit !== axis || t < middle));
    upper[digit] = to;
    lower[digit] = middle;
    visit(isMet && (digit !== axis || t >= middle));
    lower[digit] = from;
  };
  visit(true);
}

const number = (x) => String(Number(x.toPrecision(4))).replace("-", "\u2212");
const value = (axis, t) => data.axes[axis].lower + t * (data.axes[axis].upper - data.axes[axis].lower);
const title = ({ name, unit }) => name + (unit ? ` [${unit}]` : "");

function draw() {
  const axis = Number(choice.value);
  const [u, v] = [0, 1, 2].filter((k) => k !== axis);
  const t = Math.min(Number(slider.value) / Number(slider.max), 1 - 1e-9);
  const { width, height } = canvas;
  const shares = data.looks.map(() => 0);
  forEachCell(axis, t, (look, lower, upper) => {
    shares[look] += (upper[u] - lower[u]) * (upper[v] - lower[v]);
    const [x0, x1] = [lower[u], upper[u]].map((x) => Math.round(x * width));
    const [y0, y1] = [lower[v], upper[v]].map((y) => Math.round((1 - y) * height));
    context.fillStyle = fills[look];
    context.fillRect(x0, y1, x1 - x0, y0 - y1);
  });
  for (const { name, t: place } of data.marks) {
    const isHere = Math.abs(place[axis] - t) <= 0.5 / Number(slider.max) + 1e-9;
    const [x, y] = [place[u] * width, (1 - place[v]) * height];
    context.globalAlpha = isHere ? 1 : 0.7;
    context.beginPath();
    context.arc(x, y, 7, 0, 7);
    context.fillStyle = "#fff";
    context.fill();
    context.lineWidth = 3;
    context.strokeStyle = "#000";
    context.stroke();
    context.font = "20px sans-serif";
    context.textAlign = x > 0.85 * width ? "right" : "left";
    context.strokeStyle = "#fff";
    const label = isHere ? name : `(${name})`;  // in another slice
    const left = x + (x > 0.85 * width ? -12 : 12);
    context.strokeText(label, left, y - 9);
    context.fillStyle = "#000";
    context.fillText(label, left, y - 9);
    context.globalAlpha = 1;
  }
  const unit = data.axes[axis].unit;
  const here = `${data.axes[axis].name} = ${number(value(axis, t))}${unit ? " " + unit : ""}`;
  byId("here").textContent = here;
  slider.setAttribute("aria-valuetext", here);
  byId("xlow").textContent = number(data.axes[u].lower);
  byId("xname").textContent = title(data.axes[u]);
  byId("xhigh").textContent = number(data.axes[u].upper);
  byId("yhigh").textContent = number(data.axes[v].upper);
  byId("yname").textContent = title(data.axes[v]);
  byId("ylow").textContent = number(data.axes[v].lower);
  const parts = data.looks.map(({ text }, k) => [shares[k], text]).filter(([share]) => share > 0);
  canvas.setAttribute("aria-label", `Slice at ${here}: ` +
    parts.map(([share, text]) => `${(100 * share).toFixed(1)} % ${text}`).join("; "));
  document.querySelectorAll("#legend li").forEach((item, k) => {
    item.hidden = shares[k] === 0;
    item.querySelector(".share").textContent = ` (${(100 * shares[k]).toFixed(1)} %)`;
  });
}

data.axes.forEach((axis, k) => choice.add(new Option(axis.name, k, false, k === 2)));
data.looks.forEach(({ text, colour, line }) => {
  const item = document.createElement("li");
  const swatch = document.createElement("span");
  swatch.className = "swatch";
  swatch.style.background = line
    ? `repeating-linear-gradient(135deg, ${colour} 0 3px, ${line} 3px 4px)` : colour;
  const share = document.createElement("span");
  share.className = "share";
  item.append(swatch, text, share);
  byId("legend").append(item);
});
if (data.marks.length > 0) slider.value = Math.round(data.marks[0].t[2] * Number(slider.max));
slider.addEventListener("input", draw);
choice.addEventListener("input", () => {
  if (data.marks.length > 0) slider.value = Math.round(data.marks[0].t[Number(choice.value)] * Number(slider.max));
  draw();
});
draw();
)js";

nlohmann::json looks(bool has_region) {
  nlohmann::json result = nlohmann::json::array();
  const auto add = [&](const char* text, const char* colour, const char* line) {
    result.push_back({{"text", text}, {"colour", colour}, {"line", line}});
  };
  add("undecided", "#4d4d4d", "");
  add(has_region ? "inside; whether the start reaches it is open" : "inside (proved)", "#b5d8a8", "");
  add("a length limit is violated (proved)", "#f6b26b", "");
  add("a tension limit is violated (proved)", "#8fbce6", "");
  add("some load can't be balanced (proved)", "#8fbce6", "#4a86b8");
  add("bodies are too near (proved)", "#c9a3d4", "");
  add("reachable from the start (proved)", "#7fbc7a", "");
  add("inside, but no motion from the start leads there (proved)", "#b5d8a8", "#204020");
  return result;
}

}  // namespace

std::string slices_page(const MapResult& result, const std::vector<SliceMark>& marks) {
  const int deepest = halvings_shown(result.map);
  std::string digits;
  add_node(result, 0, 0, deepest, digits);
  const bool is_whole = digits.size() == result.map.nodes.size();
  nlohmann::json data = {{"axes", nlohmann::json::array()},
                         {"marks", nlohmann::json::array()},
                         {"looks", looks(result.region.has_value())},
                         {"tree", std::move(digits)}};
  for (const ShownAxis& axis : result.axes) {
    data["axes"].push_back({{"name", axis.name}, {"unit", axis.unit}, {"lower", axis.lower}, {"upper", axis.upper}});
  }
  for (const SliceMark& mark : marks) data["marks"].push_back({{"name", mark.name}, {"t", mark.t}});
  Html notes;
  for (const std::string& sentence : meaning(result)) notes += html("<p>{}</p>\n", sentence);
  if (result.region) notes += html("<p>The start is {}.</p>\n", result.start);
  for (const std::string& line : result.load) notes += html("<p>Load: {}</p>\n", line);
  if (!is_whole) {
    notes += html("<p>{}</p>\n",
                  "The finest cells of the map are left out here to keep the page small, and what they divide is shown "
                  "as undecided.");
  }
  const std::string body = html(R"(<h1>{}</h1>
<p>One slice of the map of three coordinates at a time. The slider, which the arrow keys move, too, sets the third.
Poses whose names are in parentheses are in other slices.</p>
<div class="controls"><label for="axis">Slice along</label><select id="axis"></select>
<label for="third" id="here"></label><input type="range" id="third" min="0" max="256" step="1" value="128"></div>
<div class="plot"><div class="y"><span id="yhigh"></span><span id="yname"></span><span id="ylow"></span></div>
<canvas id="slice" width="1024" height="1024" role="img"></canvas>
<div class="x"><span id="xlow"></span><span id="xname"></span><span id="xhigh"></span></div></div>
<ul id="legend"></ul>
{}<noscript><p>This page draws its slices with a script.</p></noscript>
)",
                                result.title, notes)
                               .str();
  return "<!DOCTYPE html>\n<html lang=\"en\"><head><meta charset=\"utf-8\">"
         "<meta http-equiv=\"Content-Security-Policy\" content=\"default-src 'none'; style-src 'unsafe-inline'; "
         "script-src 'unsafe-inline'\"><meta name=\"viewport\" content=\"width=device-width, "
         "initial-scale=1\"><title>" +
         escape(result.title) + "</title>\n<style>" + kSlicesStyle + "</style></head>\n<body>\n" + body +
         "<script type=\"application/json\" id=\"data\">" + script_json(data) + "</script>\n<script>" + kScript +
         "</script>\n</body></html>\n";
}

}  // namespace taut
