// SPDX-License-Identifier: GPL-3.0-or-later
#include "reports/page/no_path_picture.h"

#include <fmt/format.h>

#include <cmath>
#include <nlohmann/json.hpp>

#include "map/separation.h"
#include "reports/page/map_frame.h"
#include "reports/summary/wording.h"

namespace taut {
namespace {

constexpr MapFrameSize kSize = {.left = 62, .top = 30, .right = 14, .width = 640};
constexpr double kBelow = 48;

/// What a letter of a certificate's tree says (docs/certificate-format.md): a length, a tension, the balance, contact.
CellKind kind_of(char letter) {
  if (letter == '.') return CellKind::kUndecided;
  if (letter == 'y') return CellKind::kContact;
  if (letter <= 'L') return CellKind::kLength;
  return letter <= 'l' ? CellKind::kTension : CellKind::kUnbalanced;
}

/// Reads the part of a tree that begins at `at` into a node. @returns what comes behind it
std::size_t read(const std::string& tree, std::size_t at, std::uint32_t node, std::vector<MapNode>& nodes) {
  const char what = tree.at(at++);
  if (what < '0' || what > '2') {
    nodes[node].kind = kind_of(what);
    return at;
  }
  const auto child = static_cast<std::uint32_t>(nodes.size());
  nodes[node].axis = static_cast<std::uint8_t>(what - '0');
  nodes[node].child = child;
  nodes.resize(nodes.size() + 2);
  return read(tree, read(tree, at, child, nodes), child + 1, nodes);
}

/// The certificate's tree. @pre the checker accepted it
CellMap map_of(const NoPathContent& content) {
  CellMap map;
  map.space = content.space;
  map.nodes.resize(1);
  read(content.certificate().at("map").at("tree").get_ref<const std::string&>(), 0, 0, map.nodes);
  return map;
}

/// A look of a cell, in the order in which they are drawn.
struct Look {
  const char* name;
  const char* legend;
  std::vector<Cell> cells = {};
};
enum : std::size_t { kFromStart, kFromGoal, kTensionWall, kUnbalancedWall, kLengthWall, kContactWall, kLooks };

/// Cells by look.
class Looks {
 public:
  explicit Looks(const NoPathContent& content) : map_(map_of(content)) {
    const auto& query = content.scene.certificate.problem.query;
    const auto reached = [&](std::size_t n) { return reached_leaves(map_, place_of(map_.space, query.at(n))); };
    from_start_ = reached(content.from);
    from_goal_ = reached(content.from + 1);
    gather(Cell(), 0);
  }

  [[nodiscard]] const std::array<Look, kLooks>& all() const { return looks_; }
  /// Whether some cells are too fine to be drawn one by one.
  [[nodiscard]] bool are_joined() const { return are_joined_; }

 private:
  /// The look of a leaf, if it has one.
  [[nodiscard]] std::optional<std::size_t> look(std::uint32_t leaf) const {
    switch (map_.nodes[leaf].kind) {
      case CellKind::kLength: return kLengthWall;
      case CellKind::kTension: return kTensionWall;
      case CellKind::kUnbalanced: return kUnbalancedWall;
      case CellKind::kContact: return kContactWall;
      case CellKind::kInside:
      case CellKind::kUndecided: break;
    }
    if (from_start_[leaf]) return kFromStart;
    if (from_goal_[leaf]) return kFromGoal;
    return std::nullopt;
  }

  /// Of a part that is too fine to be drawn cell by cell: its first wall, so that walls have no gaps.
  [[nodiscard]] std::optional<std::size_t> look_of_part(std::uint32_t node) const {
    const MapNode& here = map_.nodes[node];
    if (here.axis == MapNode::kLeaf) return look(node);
    const auto lower = look_of_part(here.child), upper = look_of_part(here.child + 1);
    if (lower && *lower >= kTensionWall) return lower;
    return upper ? upper : lower;
  }

  void gather(const Cell& cell, std::uint32_t node) {
    const MapNode& here = map_.nodes[node];
    if (here.axis != MapNode::kLeaf && cell.depth.at(here.axis) < kAreaDepth) {
      for (unsigned side = 0; side < 2; ++side) gather(cell.half(here.axis, side), here.child + side);
      return;
    }
    if (here.axis != MapNode::kLeaf) are_joined_ = true;
    if (const auto found = look_of_part(node)) looks_.at(*found).cells.push_back(cell);
  }

  CellMap map_;
  std::vector<bool> from_start_, from_goal_;  ///< by node
  bool are_joined_ = false;
  std::array<Look, kLooks> looks_ = {
      {{"from-start", "what no feasible motion from the start leaves"},
       {"from-goal", "what no feasible motion from the goal leaves"},
       {"wall-tension", "no feasible pose: a tension is beyond its limit (proved)"},
       {"wall-unbalanced", "no feasible pose: some load can't be balanced (proved)"},
       {"wall-length", "no feasible pose: a cable's length is beyond its limit (proved)"},
       {"wall-contact", "no feasible pose: two bodies are too near (proved)"}}};
};

std::array<double, 2> middle(const MapBox& box) {
  return {0.5 * (box.lower[0] + box.upper[0]), 0.5 * (box.lower[1] + box.upper[1])};
}

/// The cells, drawn in units of area_path() and scaled into the frame.
Html areas(const Looks& looks, const MapFrame& frame) {
  Html out = html("<g transform=\"translate({:.6g} {:.6g}) scale({:.8g} {:.8g})\">\n", frame.x(0), frame.y(0),
                  frame.width() / kAreaUnits, -frame.height() / kAreaUnits);
  for (const Look& look : looks.all()) {
    if (look.cells.empty()) continue;
    out += html("<path class=\"{}\" fill-rule=\"evenodd\" d=\"{}\"/>\n", look.name, area_path(look.cells));
  }
  return out + html("</g>\n");
}

Html legend(const Looks& looks) {
  Html keys;
  for (const Look& look : looks.all()) {
    if (look.cells.empty()) continue;
    keys += html(
        "<span class=\"key\"><svg viewBox=\"0 0 14 14\" aria-hidden=\"true\"><rect class=\"{}\" x=\"1\" y=\"1\" "
        "width=\"12\" height=\"12\"/></svg>{}</span>\n",
        look.name, look.legend);
  }
  return keys;
}

std::string caption(const Looks& looks) {
  const std::string joined = fmt::format(
      " Where cells are narrower than 1/{} of an axis, a place of that width has the colour of one of them: "
      "of a wall, if there is one.",
      kAreaUnits);
  return fmt::format(
      "These are the cells of the certificate, as the checker has proved them; edges are edges of cells.{} What has no "
      "colour did not have to be decided.",
      looks.are_joined() ? joined : "");
}

}  // namespace

Html no_path_picture(const NoPathContent& content) {
  if (content.space.size() != 2) {
    return html(
        "<p class=\"note\">The space has three coordinates, so that the cells have no flat picture: <code>taut map "
        "CASE --out FOLDER</code> shows slices of a map.</p>\n");
  }
  const Looks looks(content);
  const MapFrame frame({content.axes[0], content.axes[1]}, kSize);
  const auto& query = content.scene.certificate.problem.query;
  const auto place = [&](std::size_t n) { return middle(place_of(content.space, query.at(n)).front()); };
  const std::vector<MapMark> marks = {{"start", place(content.from)}, {"goal", place(content.from + 1)}};
  return html(
      "<figure class=\"walls\"><svg viewBox=\"0 0 {} {}\" role=\"img\" aria-label=\"The space of {} and {}: cells "
      "without a feasible pose part start and goal.\">\n{}{}{}</svg>\n<figcaption><span "
      "class=\"keys\">{}</span>{}</figcaption></figure>\n",
      kSize.width, std::ceil(frame.y(0) + kBelow), content.axes[0].name, content.axes[1].name, areas(looks, frame),
      frame.axes(), frame.marks(marks), legend(looks), caption(looks));
}

}  // namespace taut
