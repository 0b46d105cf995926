// SPDX-License-Identifier: GPL-3.0-or-later
#include "reports/page/map_picture.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <iterator>

#include "map/topology.h"
#include "reports/page/markup.h"

namespace taut {
namespace {

constexpr double kWidth = 960, kLeft = 64, kTop = 64, kBottom = 96, kRight = 24;
constexpr double kLeastPart = 0.1;  // [px]

struct Class {
  CellKind kind;
  const char* name;
  const char* fill;
  const char* legend;
};
constexpr std::array<Class, kCellKinds> kClasses = {{
    {CellKind::kInside, "inside", "#7fbc7a", "inside (proved)"},
    {CellKind::kTension, "tension", "url(#tension)", "a tension limit is violated"},
    {CellKind::kUnbalanced, "unbalanced", "url(#unbalanced)", "some load can't be balanced"},
    {CellKind::kLength, "length", "url(#length)", "a length limit is violated"},
    {CellKind::kUndecided, "undecided", "#4d4d4d", "undecided"},
}};

constexpr const char* kPatterns = R"(<defs>
<pattern id="tension" width="8" height="8" patternUnits="userSpaceOnUse"><rect width="8" height="8" fill="#a9cbe8"/>
<path d="M-2,2 l4,-4 M0,8 l8,-8 M6,10 l4,-4" stroke="#4a86b8" stroke-width="0.8"/></pattern>
<pattern id="unbalanced" width="8" height="8" patternUnits="userSpaceOnUse"><rect width="8" height="8" fill="#cfdcec"/>
<path d="M0,4 h8" stroke="#4a86b8" stroke-width="0.8"/></pattern>
<pattern id="length" width="8" height="8" patternUnits="userSpaceOnUse"><rect width="8" height="8" fill="#f6c48a"/>
<path d="M-2,6 l4,4 M0,0 l8,8 M6,-2 l4,4" stroke="#b96a12" stroke-width="0.8"/></pattern>
</defs>
)";

class Drawing {
 public:
  Drawing(const CellMap& map, const MapPicture& picture) : map_(map), picture_(picture) {
    const double x = picture.axes[0].upper - picture.axes[0].lower;
    const double y = picture.axes[1].upper - picture.axes[1].lower;
    const double ratio = std::clamp(y / x, 0.3, 1.2);  // of unlike units, whatever fits a page
    scale_ = {kWidth - kLeft - kRight, (kWidth - kLeft - kRight) * ratio};
    height_ = kTop + scale_[1] + kBottom;
  }

  std::string draw() {
    std::string out = fmt::format(
        R"(<svg xmlns="http://www.w3.org/2000/svg" viewBox="0 0 {0:.0f} {1:.0f}" width="{0:.0f}" height="{1:.0f}" )"
        R"(font-family="sans-serif" font-size="14">)"
        "\n<title>{2}</title>\n<rect width=\"100%\" height=\"100%\" fill=\"#fff\"/>\n",
        kWidth, height_, escape(picture_.title));
    out += kPatterns;
    out += fmt::format("<text x=\"{:.0f}\" y=\"28\" font-size=\"18\">{}</text>\n", kLeft, escape(picture_.title));
    if (const CellKind all = draw_node(MapBox(), 0); all != kMixed) add(MapBox(), all);
    for (const Class& of : kClasses) {
      const std::string& path = paths_[static_cast<std::size_t>(of.kind)];
      if (path.empty()) continue;
      out += fmt::format("<path class=\"{}\" fill=\"{}\" shape-rendering=\"crispEdges\" d=\"{}\"/>\n", of.name, of.fill,
                         path);
    }
    out += singular();
    out += axes();
    out += marks();
    out += legend();
    return out + "</svg>\n";
  }

 private:
  /// Stands for parts that were added to paths_ already.
  static constexpr auto kMixed = static_cast<CellKind>(0xFF);

  [[nodiscard]] double x(double t) const { return kLeft + t * scale_[0]; }
  [[nodiscard]] double y(double t) const { return kTop + (1 - t) * scale_[1]; }

  void rectangle(std::string& path, const MapBox& box) const {
    fmt::format_to(std::back_inserter(path), "M{:.6g},{:.6g}H{:.6g}V{:.6g}H{:.6g}z", x(box.lower[0]), y(box.lower[1]),
                   x(box.upper[0]), y(box.upper[1]), x(box.lower[0]));
  }
  void add(const MapBox& box, CellKind kind) { rectangle(paths_[static_cast<std::size_t>(kind)], box); }

  /// Adds what is below a node, unless it is of one kind, which is returned.
  CellKind draw_node(const MapBox& box, std::uint32_t node) {
    const MapNode& here = map_.nodes[node];
    if (here.axis == MapNode::kLeaf) return here.kind;
    if ((box.upper[0] - box.lower[0]) * scale_[0] < kLeastPart &&
        (box.upper[1] - box.lower[1]) * scale_[1] < kLeastPart) {
      return CellKind::kUndecided;
    }
    std::array<MapBox, 2> half = {box, box};
    half[0].upper[here.axis] = half[1].lower[here.axis] = 0.5 * (box.lower[here.axis] + box.upper[here.axis]);
    const std::array<CellKind, 2> kind = {draw_node(half[0], here.child), draw_node(half[1], here.child + 1)};
    if (kind[0] == kind[1]) return kind[0];
    for (std::size_t side = 0; side < 2; ++side) {
      if (kind[side] != kMixed) add(half[side], kind[side]);
    }
    return kMixed;
  }

  [[nodiscard]] std::string singular() const {
    std::vector<MapBox> boxes;
    for (const Cell& cell : picture_.singular) boxes.push_back(box_of(cell));
    std::ranges::sort(boxes, {}, [](const MapBox& box) {
      return std::array{box.lower[1], box.upper[1], box.lower[0]};
    });
    std::string path;
    for (std::size_t n = 0; n < boxes.size(); ++n) {
      MapBox row = boxes[n];  // of all that follow each other
      for (; n + 1 < boxes.size() && boxes[n + 1].lower[1] == row.lower[1] && boxes[n + 1].upper[1] == row.upper[1] &&
             boxes[n + 1].lower[0] == row.upper[0];
           ++n) {
        row.upper[0] = boxes[n + 1].upper[0];
      }
      rectangle(path, row);
    }
    if (path.empty()) return "";
    return fmt::format("<path class=\"singular\" fill=\"#d7191c\" shape-rendering=\"crispEdges\" d=\"{}\"/>\n", path);
  }

  [[nodiscard]] std::string axes() const {
    std::string out = fmt::format(
        "<rect x=\"{:.6g}\" y=\"{:.6g}\" width=\"{:.6g}\" height=\"{:.6g}\" fill=\"none\" stroke=\"#222\"/>\n", x(0),
        y(1), scale_[0], scale_[1]);
    constexpr int kTicks = 4;
    for (int n = 0; n <= kTicks; ++n) {
      const double t = static_cast<double>(n) / kTicks;
      const auto value = [&](const MapPicture::Axis& axis) {
        return fmt::format("{:.4g}", axis.lower + t * (axis.upper - axis.lower));
      };
      out += fmt::format("<text x=\"{:.6g}\" y=\"{:.6g}\" text-anchor=\"middle\">{}</text>\n", x(t), y(0) + 20,
                         value(picture_.axes[0]));
      out += fmt::format("<text x=\"{:.6g}\" y=\"{:.6g}\" text-anchor=\"end\">{}</text>\n", x(0) - 6, y(t) + 5,
                         value(picture_.axes[1]));
    }
    out += fmt::format("<text x=\"{:.6g}\" y=\"{:.6g}\" text-anchor=\"middle\">{}</text>\n", x(0.5), y(0) + 40,
                       escape(picture_.axes[0].title));
    out += fmt::format("<text x=\"{:.6g}\" y=\"{:.6g}\">{}</text>\n", x(0), y(1) - 10, escape(picture_.axes[1].title));
    return out;
  }

  [[nodiscard]] std::string marks() const {
    std::string out;
    for (const MapPicture::Mark& mark : picture_.marks) {
      const bool is_right = mark.t[0] > 0.9;
      out += fmt::format(
          "<circle cx=\"{:.6g}\" cy=\"{:.6g}\" r=\"5\" fill=\"#fff\" stroke=\"#000\" stroke-width=\"2\"/>\n",
          x(mark.t[0]), y(mark.t[1]));
      out += fmt::format(
          "<text x=\"{:.6g}\" y=\"{:.6g}\" text-anchor=\"{}\" stroke=\"#fff\" stroke-width=\"3\" "
          "paint-order=\"stroke\">{}</text>\n",
          x(mark.t[0]) + (is_right ? -9 : 9), y(mark.t[1]) - 7, is_right ? "end" : "start", escape(mark.name));
    }
    return out;
  }

  [[nodiscard]] std::string legend() const {
    std::string out;
    double left = kLeft;
    const double top = height_ - 34;
    const auto entry = [&](const char* fill, const char* text) {
      constexpr double kLetter = 6.9;  // mean width [px]
      out += fmt::format(
          "<rect x=\"{:.6g}\" y=\"{:.6g}\" width=\"14\" height=\"14\" fill=\"{}\" stroke=\"#222\" "
          "stroke-width=\"0.5\"/>"
          "<text x=\"{:.6g}\" y=\"{:.6g}\" font-size=\"13\">{}</text>\n",
          left, top, fill, left + 20, top + 12, text);
      left += 36 + kLetter * static_cast<double>(std::string_view(text).size());
    };
    for (const Class& of : kClasses) {
      if (map_.share[static_cast<std::size_t>(of.kind)] > 0) entry(of.fill, of.legend);
    }
    if (!picture_.singular.empty()) entry("#d7191c", "encloses det J = 0");
    return out;
  }

  const CellMap& map_;
  const MapPicture& picture_;
  std::array<double, 2> scale_{};
  double height_ = 0;
  std::array<std::string, kCellKinds> paths_;
};

}  // namespace

std::string map_svg(const CellMap& map, const MapPicture& picture) { return Drawing(map, picture).draw(); }

}  // namespace taut
