// SPDX-License-Identifier: GPL-3.0-or-later
#include "reports/page/assurance_drawing.h"

#include <algorithm>
#include <cmath>
#include <map>

namespace taut {
namespace {

using Kind = AssuranceNode::Kind;

// Lengths in units of the drawings; on A4, 760 of them are 180 mm.
constexpr double kWidth = 760;
constexpr double kFont = 11.5;
constexpr double kLine = 14.2;  ///< from line to line
constexpr double kPad = 8;
constexpr double kGap = 9;    ///< between nodes of a column
constexpr double kStep = 26;  ///< from a node to those that support it
constexpr double kSlant = 14;
constexpr double kDiamond = 6;  ///< half the height of the mark of an undeveloped goal
constexpr double kArrow = 7;
constexpr double kLeastOval = 36;
constexpr double kBus = 13;  ///< from a column to the line along it

/// About how wide a text is in the page's typeface, and a little more.
double text_width(std::string_view text) {
  double width = 0;
  for (const char c : text) {
    const auto byte = static_cast<unsigned char>(c);
    if ((byte & 0xC0U) == 0x80U) continue;  // not the first byte of a character
    const bool is_narrow = std::string_view("ijlft.,:;'|!()[] ").find(c) != std::string_view::npos;
    const bool is_wide = std::string_view("mwMW@%").find(c) != std::string_view::npos || byte >= 0x80U;
    const bool is_tall = (c >= 'A' && c <= 'Z') || (c >= '0' && c <= '9');
    width += is_narrow ? 0.34 : is_wide ? 0.92 : is_tall ? 0.68 : 0.58;
  }
  return width * kFont;
}

/// The text broken between words; words that are wider than a line are broken, too.
std::vector<std::string> broken(const std::string& text, double width) {
  std::vector<std::string> lines = {""};
  const auto add = [&](std::string word) {
    std::string& line = lines.back();
    if (!line.empty() && text_width(line + " " + word) > width) return lines.push_back(std::move(word));
    line += (line.empty() ? "" : " ") + word;
  };
  for (std::size_t at = 0; at < text.size();) {
    const std::size_t begin = std::min(text.find_first_not_of(' ', at), text.size());
    const std::size_t end = std::min(text.find(' ', begin), text.size());
    std::string word;
    for (std::size_t i = begin; i < end;) {
      std::size_t next = i + 1;
      while (next < end && (static_cast<unsigned char>(text[next]) & 0xC0U) == 0x80U) ++next;
      const std::string letter = text.substr(i, next - i);
      if (!word.empty() && text_width(word + letter) > width) {
        add(word);
        word.clear();
      }
      word += letter;
      i = next;
    }
    if (!word.empty()) add(word);
    at = end;
  }
  return lines;
}

/// A node with its place. x and y are of the middle of its frame.
struct Placed {
  const AssuranceNode* node = nullptr;
  std::vector<std::string> lines;
  double x = 0, y = 0, width = 0, height = 0;

  [[nodiscard]] double top() const { return y - height / 2; }
  [[nodiscard]] double bottom() const { return y + height / 2; }
  /// With the mark of an undeveloped goal.
  [[nodiscard]] double foot() const { return bottom() + (node->is_undeveloped ? 2 * kDiamond : 0); }
};

bool is_oval(Kind kind) { return kind == Kind::kAssumption || kind == Kind::kJustification; }

/// The share of a shape's width that text may take.
double text_share(Kind kind) {
  if (is_oval(kind)) return 0.8;
  return kind == Kind::kSolution ? 0.84 : 1;
}

/// A node of such a width, as high as its text asks for. A solution is a circle, at least of that diameter.
Placed sized(const AssuranceNode& node, double width) {
  Placed placed{&node, {}, 0, 0, width, 0};
  const double side = node.kind == Kind::kStrategy ? kPad + kSlant : is_oval(node.kind) ? 0 : kPad;
  const double room = text_share(node.kind) * width - 2 * side;
  placed.lines = broken(node.id + " " + node.label, room);
  const double text = static_cast<double>(placed.lines.size()) * kLine;
  placed.height = is_oval(node.kind) ? std::max(text / 0.6 + 2, kLeastOval) : text + 2 * kPad - 2;
  if (node.kind == Kind::kSolution) placed.height = width;
  return placed;
}

/// Nodes with their places, and the links between them.
struct Drawing {
  std::map<std::string, Placed> nodes;
  Html links;

  const Placed& add(const AssuranceNode& node, double x, double y, double width) {
    Placed placed = sized(node, width);
    placed.x = x;
    placed.y = y + placed.height / 2;
    return nodes[node.id] = placed;
  }
  /// Puts nodes below one another. @returns the lower end of the last
  double stack(const std::vector<const AssuranceNode*>& column, double x, double width, double y) {
    for (const AssuranceNode* node : column) y = add(*node, x, y, width).foot() + kGap;
    return y - kGap;
  }
};

const AssuranceNode& find(const std::vector<AssuranceNode>& nodes, const std::string& id) {
  return *std::ranges::find(nodes, id, &AssuranceNode::id);
}

std::vector<const AssuranceNode*> all(const std::vector<AssuranceNode>& nodes, const std::vector<std::string>& ids) {
  std::vector<const AssuranceNode*> result;
  for (const std::string& id : ids) result.push_back(&find(nodes, id));
  return result;
}

// ---- Links: SupportedBy with a solid head, InContextOf with a hollow one.

Html line(double x1, double y1, double x2, double y2) {
  return html("<path class=\"link\" d=\"M{:.1f} {:.1f}L{:.1f} {:.1f}\"/>", x1, y1, x2, y2);
}

/// From the foot of a node to the top of one that supports it.
Html down(const Placed& from, const Placed& to) {
  return line(from.x, from.bottom(), to.x, to.top() - kArrow) +
         html("<path class=\"solid\" d=\"M{:.1f} {:.1f}l{} {}h{}z\"/>", to.x, to.top(), -kArrow / 2, -kArrow, kArrow);
}

/// From a vertical line into the side of a node.
Html into_side(double bus, const Placed& to, bool supports) {
  const double sign = bus < to.x ? 1 : -1;
  const double slant = to.node->kind == Kind::kStrategy ? kSlant / 2 : 0;
  const double tip = to.x - sign * (to.width / 2 - slant);
  return line(bus, to.y, tip - sign * kArrow, to.y) + html("<path class=\"{}\" d=\"M{:.1f} {:.1f}l{} {}v{}z\"/>",
                                                           supports ? "solid" : "hollow", tip, to.y, -sign * kArrow,
                                                           -kArrow / 2, kArrow);
}

/// From the side of a node along a vertical line to the nodes of its context.
Html to_context(const Placed& from, const Drawing& drawing, const std::vector<const AssuranceNode*>& context) {
  if (context.empty()) return {};
  const Placed& first = drawing.nodes.at(context.front()->id);
  const double sign = first.x < from.x ? -1 : 1;
  const double bus = first.x - sign * (first.width / 2 + kBus);
  const double slant = from.node->kind == Kind::kStrategy ? kSlant / 2 : 0;
  Html result = line(from.x + sign * (from.width / 2 - slant), from.y, bus, from.y);
  double top = from.y, bottom = from.y;
  for (const AssuranceNode* node : context) {
    const Placed& to = drawing.nodes.at(node->id);
    top = std::min(top, to.y);
    bottom = std::max(bottom, to.y);
    result += into_side(bus, to, false);
  }
  return result + line(bus, top, bus, bottom);
}

// ---- Layout.

/// What has to hold for the top goal: the claim, and the goals left to others, in three columns.
Drawing overview(const std::vector<AssuranceNode>& nodes) {
  constexpr double kWide = 470;
  constexpr std::size_t kColumns = 3;
  constexpr double kColumn = (kWidth - kColumns * kBus - (kColumns - 1) * kGap) / kColumns;
  const AssuranceNode& strategy = find(nodes, nodes.front().supported_by.front());
  Drawing drawing;
  const Placed top = drawing.add(nodes.front(), kWidth / 2, 0, kWide);
  const Placed by = drawing.add(strategy, kWidth / 2, top.bottom() + kStep, kWide);
  const std::vector<const AssuranceNode*> goals = all(nodes, strategy.supported_by);
  const std::size_t rows = (goals.size() + kColumns - 1) / kColumns;
  const double bus = by.bottom() + kStep / 2;
  drawing.links = down(top, by) + line(by.x, by.bottom(), by.x, bus) +
                  line(0.5, bus, 0.5 + (kColumns - 1) * (kColumn + kBus + kGap), bus);
  for (std::size_t c = 0; c < kColumns; ++c) {
    const double left = static_cast<double>(c) * (kColumn + kBus + kGap);
    double y = bus + kStep / 2;
    double end = bus;
    for (std::size_t k = c * rows; k < std::min(goals.size(), (c + 1) * rows); ++k) {
      const Placed& placed = drawing.add(*goals[k], left + kBus + kColumn / 2, y, kColumn);
      y = placed.foot() + kGap;
      end = placed.y;
      drawing.links += into_side(left + 0.5, placed, true);
    }
    drawing.links += line(left + 0.5, bus, left + 0.5, end);
  }
  return drawing;
}

/// How the claim is shown: the argument in the middle, contexts and justifications at its left, assumptions at its
/// right.
Drawing proof(const std::vector<AssuranceNode>& nodes) {
  constexpr double kLeft = 218, kMiddle = 216, kRight = 262;
  constexpr double kMiddleX = kLeft + (kWidth - kLeft - kMiddle - kRight) / 2 + kMiddle / 2;
  const AssuranceNode& claim = find(nodes, find(nodes, nodes.front().supported_by.front()).supported_by.front());
  const AssuranceNode& strategy = find(nodes, claim.supported_by.front());
  const AssuranceNode& each = find(nodes, strategy.supported_by.front());
  std::vector<const AssuranceNode*> contexts = all(nodes, claim.in_context_of), assumptions;
  const auto rest = std::ranges::stable_partition(contexts, [](auto* node) { return node->kind == Kind::kContext; });
  assumptions.assign(rest.begin(), rest.end());
  contexts.erase(rest.begin(), rest.end());
  const std::vector<const AssuranceNode*> justifications = all(nodes, strategy.in_context_of);

  Drawing drawing;
  const double left_end = drawing.stack(contexts, kLeft / 2, kLeft, 0);
  drawing.stack(assumptions, kWidth - kRight / 2, kRight, 0);
  const Placed at_claim = drawing.add(claim, kMiddleX, 0, kMiddle);
  const double y = std::max(at_claim.bottom() + kStep, left_end + 2 * kGap);  // one bus must not pass another
  drawing.stack(justifications, kLeft / 2, kLeft, y);
  const Placed by = drawing.add(strategy, kMiddleX, y, kMiddle);
  const Placed at_each = drawing.add(each, kMiddleX, by.bottom() + kStep, kMiddle);
  drawing.links = to_context(at_claim, drawing, contexts) + to_context(at_claim, drawing, assumptions) +
                  to_context(by, drawing, justifications) + down(at_claim, by) + down(by, at_each);
  const std::vector<const AssuranceNode*> evidence = all(nodes, each.supported_by);
  const auto count = static_cast<double>(evidence.size());
  const double width = (kMiddle - kGap * (count - 1)) / count;
  double x = kMiddleX - kMiddle / 2 + width / 2;
  for (const AssuranceNode* node : evidence) {
    drawing.links += down(at_each, drawing.add(*node, x, at_each.bottom() + kStep, width));
    x += width + kGap;
  }
  return drawing;
}

// ---- Shapes.

Html frame(const Placed& p) {
  const double left = p.x - p.width / 2, right = p.x + p.width / 2;
  switch (p.node->kind) {
    case Kind::kGoal: break;
    case Kind::kStrategy:
      return html("<path class=\"shape\" d=\"M{:.1f} {:.1f}H{:.1f}L{:.1f} {:.1f}H{:.1f}Z\"/>", left + kSlant, p.top(),
                  right, right - kSlant, p.bottom(), left);
    case Kind::kSolution:
      return html("<circle class=\"shape\" cx=\"{:.1f}\" cy=\"{:.1f}\" r=\"{:.1f}\"/>", p.x, p.y, p.width / 2);
    case Kind::kContext:
      return html("<rect class=\"shape\" x=\"{:.1f}\" y=\"{:.1f}\" width=\"{:.1f}\" height=\"{:.1f}\" rx=\"{:.1f}\"/>",
                  left, p.top(), p.width, p.height, std::min(p.height / 2, 18.0));
    case Kind::kAssumption:
    case Kind::kJustification:
      return html(
          "<ellipse class=\"shape\" cx=\"{:.1f}\" cy=\"{:.1f}\" rx=\"{:.1f}\" ry=\"{:.1f}\"/>"
          "<text class=\"kind\" x=\"{:.1f}\" y=\"{:.1f}\">{}</text>",
          p.x, p.y, p.width / 2, p.height / 2, right - 8, p.bottom() - 2,
          p.node->kind == Kind::kAssumption ? "A" : "J");
  }
  const Html diamond = p.node->is_undeveloped
                           ? html("<path class=\"shape diamond\" d=\"M{:.1f} {:.1f}l{} {}l{} {}l{} {}z\"/>", p.x,
                                  p.bottom(), kDiamond, kDiamond, -kDiamond, kDiamond, -kDiamond, -kDiamond)
                           : Html();
  return html("<rect class=\"shape\" x=\"{:.1f}\" y=\"{:.1f}\" width=\"{:.1f}\" height=\"{:.1f}\"/>{}", left, p.top(),
              p.width, p.height, diamond);
}

Html drawn(const Placed& p) {
  Html text;
  const double first = p.y - (static_cast<double>(p.lines.size()) - 1) * kLine / 2 + 0.35 * kFont;
  for (std::size_t k = 0; k < p.lines.size(); ++k) {
    const std::string& line = p.lines[k];
    const std::string id = k == 0 ? p.node->id : "";
    text += html("<tspan x=\"{:.1f}\" y=\"{:.1f}\">{}{}</tspan>", p.x, first + static_cast<double>(k) * kLine,
                 id.empty() ? Html() : html("<tspan class=\"id\">{}</tspan>", id), line.substr(id.size()));
  }
  const char* const kind = p.node->is_undeveloped ? "open" : p.node->kind == Kind::kGoal ? "claimed" : "";
  return html("<g class=\"{}\">{}<text>{}</text></g>\n", kind, frame(p), text);
}

Html svg(const Drawing& drawing, const char* title) {
  double height = 0;
  Html shapes;
  for (const auto& [id, placed] : drawing.nodes) {
    height = std::max(height, placed.foot());
    shapes += drawn(placed);
  }
  constexpr double kMargin = 2;
  return html(
      "<figure class=\"gsn\"><div class=\"scroll\" role=\"region\" tabindex=\"0\" aria-label=\"Drawing: {}\"><svg "
      "viewBox=\"{} {} {} {:.0f}\" role=\"img\" "
      "aria-label=\"{}. The list below has the same "
      "content.\">\n{}{}</svg></div><figcaption>{}</figcaption></figure>\n",
      title, -kMargin, -kMargin, kWidth + 2 * kMargin, std::ceil(height) + 2 * kMargin, title, drawing.links, shapes,
      title);
}

// ---- The same as nested lists.

const char* kind_text(const AssuranceNode& node) {
  switch (node.kind) {
    case Kind::kGoal: return node.is_undeveloped ? "Goal, to be shown by others" : "Goal";
    case Kind::kStrategy: return "Strategy";
    case Kind::kSolution: return "Evidence";
    case Kind::kContext: return "Context";
    case Kind::kAssumption: return "Assumption";
    case Kind::kJustification: break;
  }
  return "Justification";
}

Html listed(const std::vector<AssuranceNode>& nodes, const AssuranceNode& node) {
  Html inner;
  for (const AssuranceNode* context : all(nodes, node.in_context_of)) inner += listed(nodes, *context);
  for (const AssuranceNode* by : all(nodes, node.supported_by)) inner += listed(nodes, *by);
  return html("<li><b>{}</b> {}: <bdi>{}</bdi>{}</li>\n", node.id, kind_text(node), node.text,
              inner.empty() ? inner : html("\n<ul>\n{}</ul>", inner));
}

}  // namespace

Html assurance_drawing(const std::vector<AssuranceNode>& nodes) {
  if (nodes.empty()) return {};
  return svg(overview(nodes), "What has to hold: the goal that taut shows, and those left to others") +
         svg(proof(nodes), "How the goal that taut shows is supported, in which context and under which assumptions");
}

Html assurance_section(const ReportContext& scene, const Summary& summary) {
  const std::vector<AssuranceNode>& nodes = summary.assurance_case;
  if (nodes.empty()) {
    const char* const why = scene.verdict == "refuted"     ? "the move was proved to break its limits"
                            : scene.verdict == "undecided" ? "nothing was decided about the move"
                                                           : "the certificate was not checked";
    return section("assurance", "Assurance case",
                   html("<p>There is no assurance case for this move: {}. What would have to be shown is listed under "
                        "<a href=\"#assumptions\">assumptions</a>.</p>\n",
                        why));
  }
  return section(
      "assurance", "Assurance case",
      html(
          "<p>What is claimed, by which argument and on which evidence, in Goal Structuring Notation. The goals with a "
          "diamond and a dashed frame are not shown here: they are left to those who sign the lift plan, and {} holds "
          "only if they are shown as well.</p>\n{}{}",
          nodes.front().id, assurance_drawing(nodes),
          folded(true, html("The same in full, as a list"),
                 html("<ul class=\"argument\">\n{}</ul>\n", listed(nodes, nodes.front())))));
}

Html lift_plan_section(const ReportContext& /*scene*/, const Summary& summary) {
  Html rows;
  const char* group = "";
  for (const LiftPlanItem& item : summary.lift_plan) {
    if (std::string_view(item.group) != group) {
      group = item.group;
      rows += html("<tr><th scope=\"rowgroup\" colspan=\"3\">{}</th></tr>\n", group);
    }
    rows += html("<tr><td>{}</td><td><bdi>{}</bdi></td><td>{}</td></tr>\n", item.topic,
                 item.filled.empty() ? "—" : item.filled, item.open);
  }
  return section(
      "lift-plan", "For the lift plan",
      html("<p>Topics of a plan for a critical lift, as ASME P30.1-2014 arranges them. Only the topics are named here; "
           "what each requires is in the standard. This report is an appendix to such a plan and fills in a part of "
           "it.</p>\n<div class=\"scroll\" tabindex=\"0\" role=\"region\" aria-label=\"Topics of a lift plan\"><table "
           "class=\"lift-plan\"><caption>What this report fills in, and what stays open</caption>\n<thead><tr><th "
           "scope=\"col\">Topic</th><th scope=\"col\">From this report</th><th scope=\"col\">Open: to be filled in "
           "by</th></tr></thead>\n<tbody>{}</tbody></table></div>\n",
           rows));
}

}  // namespace taut
