// SPDX-License-Identifier: GPL-3.0-or-later
#include "reports/map/picture.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <iterator>
#include <string_view>

#include "map/outline.h"
#include "reports/page/map_frame.h"
#include "reports/page/markup.h"

namespace taut {
namespace {

constexpr double kWidth = 960, kLeft = 64, kTop = 64, kBottom = 136, kRight = 24;
/// Cells narrower than this along both axes are drawn with their neighbours. [px]
constexpr double kLeastPart = 0.1;

/// What a part of the picture is shown as: kinds of cells, and two that are drawn on top of them.
enum Look : std::size_t {
  kUndecidedLook,
  kInsideLook,
  kLengthLook,
  kTensionLook,
  kUnbalancedLook,
  kContactLook,
  kBothLook,
  kLooks
};
static_assert(kContactLook == static_cast<std::size_t>(CellKind::kContact) && kBothLook == kCellKinds);

struct Style {
  Look look;
  const char* name;
  const char* fill;
  const char* legend;
};
constexpr std::array<Style, kLooks> kStyles = {{
    {kInsideLook, "inside", "#7fbc7a", "inside (proved)"},
    {kTensionLook, "tension", "#8fbce6", "a tension limit is violated"},
    {kUnbalancedLook, "unbalanced", "url(#unbalanced)", "some load can't be balanced"},
    {kContactLook, "contact", "#c9a3d4", "bodies are too near"},
    {kLengthLook, "length", "#f6b26b", "a length limit is violated"},
    {kBothLook, "both", "url(#both)", "both kinds of limits are violated"},
    {kUndecidedLook, "undecided", "#4d4d4d", "undecided"},
}};
constexpr const char* kCutOff = "url(#cut-off)";
constexpr const char* kSingular = "#d7191c";
constexpr const char* kChartEdge = "#14324f";

constexpr const char* kPatterns = R"(<defs>
<pattern id="unbalanced" width="8" height="8" patternUnits="userSpaceOnUse"><rect width="8" height="8" fill="#8fbce6"/>
<path d="M0,4 h8" stroke="#4a86b8" stroke-width="0.8"/></pattern>
<pattern id="both" width="8" height="8" patternUnits="userSpaceOnUse"><rect width="8" height="8" fill="#8fbce6"/>
<path d="M-2,2 l4,-4 M0,8 l8,-8 M6,10 l4,-4" stroke="#f6b26b" stroke-width="2.8"/></pattern>
<pattern id="cut-off" width="9" height="9" patternUnits="userSpaceOnUse">
<path d="M0,9 l9,-9" stroke="#204020" stroke-width="0.9"/></pattern>
</defs>
)";

/// Lengths in pixels need no more than hundredths.
std::string pixels(double x) { return fmt::format("{:.6g}", std::round(100 * x) / 100); }

MapFrame frame_of(const MapResult& result) {
  return {{result.axes[0], result.axes[1]}, {.left = kLeft, .top = kTop, .right = kRight, .width = kWidth}};
}
double height_of(const MapFrame& frame) { return std::ceil(kTop + frame.height() + kBottom); }

class Drawing {
 public:
  Drawing(const MapResult& result, const MapOverlay& overlay)
      : result_(result), overlay_(overlay), frame_(frame_of(result)), height_(height_of(frame_)) {
    gather(Cell(), 0);
    for (const Cell& cell : overlay.both) cells_[kBothLook].push_back(cell);
  }

  std::string draw() {
    std::string out = fmt::format(
        R"(<svg xmlns="http://www.w3.org/2000/svg" viewBox="0 0 {0:.0f} {1:.0f}" width="{0:.0f}" height="{1:.0f}" )"
        R"(font-family="sans-serif" font-size="14">)"
        "\n<title>{2}</title>\n<rect width=\"100%\" height=\"100%\" fill=\"#fff\"/>\n",
        kWidth, height_, escape(result_.title));
    out += kPatterns;
    out += fmt::format("<text x=\"{:.0f}\" y=\"28\" font-size=\"18\">{}</text>\n", kLeft, escape(result_.title));
    for (const Style& style : kStyles) out += area(style.name, style.fill, "#333", cells_[style.look]);
    out += area("cut-off", kCutOff, "none", cut_off_);
    out += area("singular", kSingular, kSingular, overlay_.singular);
    out += charts() + path() + frame_.axes().str() + frame_.marks(overlay_.marks).str() + legend();
    return out + "</svg>\n";
  }

 private:
  [[nodiscard]] double x(double t) const { return frame_.x(t); }
  [[nodiscard]] double y(double t) const { return frame_.y(t); }

  /// Leaves by look; parts that are too small to be seen apart as one undecided cell.
  void gather(const Cell& cell, std::uint32_t node) {
    const MapNode& here = result_.map.nodes[node];
    const bool is_small =
        2 * cell.radius(0) * frame_.width() < kLeastPart && 2 * cell.radius(1) * frame_.height() < kLeastPart;
    if (here.axis != MapNode::kLeaf && !is_small) {
      for (unsigned side = 0; side < 2; ++side) gather(cell.half(here.axis, side), here.child + side);
      return;
    }
    const CellKind kind = here.axis == MapNode::kLeaf ? here.kind : CellKind::kUndecided;
    cells_[static_cast<std::size_t>(kind)].push_back(cell);
    if (kind == CellKind::kInside && result_.region && result_.region->reach(node) == MapRegion::Reach::kCutOff) {
      cut_off_.push_back(cell);
    }
  }

  /// The union of cells, as one path.
  [[nodiscard]] std::string area(const char* name, const char* fill, const char* stroke,
                                 const std::vector<Cell>& cells) const {
    if (cells.empty()) return "";
    std::string path;
    for (const OutlinePolygon& polygon : outline(cells)) {
      add(path, polygon.outer);
      for (const OutlineRing& hole : polygon.holes) add(path, hole);
    }
    return fmt::format(
        "<path class=\"{}\" fill=\"{}\" fill-rule=\"evenodd\" stroke=\"{}\" stroke-width=\"0.3\" d=\"{}\"/>\n", name,
        fill, stroke, path);
  }

  void add(std::string& path, const OutlineRing& ring) const {
    const auto t = [](std::uint32_t corner) { return static_cast<double>(corner) / kOutlineUnits; };
    path += "M" + pixels(x(t(ring[0][0]))) + "," + pixels(y(t(ring[0][1])));
    for (std::size_t n = 1; n < ring.size(); ++n) {
      const bool is_vertical = ring[n][0] == ring[n - 1][0];
      path += is_vertical ? "V" + pixels(y(t(ring[n][1]))) : "H" + pixels(x(t(ring[n][0])));
    }
    path += 'z';
  }

  [[nodiscard]] std::string lines(const std::vector<MapLine>& all) const {
    std::string path;
    for (const auto& line : all) {
      for (std::size_t n = 0; n < line.size(); ++n) {
        path += (n == 0 ? "M" : "L") + pixels(x(line[n][0])) + "," + pixels(y(line[n][1]));
      }
    }
    return path;
  }

  [[nodiscard]] std::string charts() const {
    if (overlay_.charts.empty()) return "";
    return fmt::format(
        "<clipPath id=\"space\"><rect x=\"{}\" y=\"{}\" width=\"{}\" height=\"{}\"/></clipPath>\n"
        "<path class=\"charts\" clip-path=\"url(#space)\" fill=\"none\" stroke=\"{}\" stroke-width=\"0.7\" "
        "stroke-opacity=\"0.8\" "
        "stroke-linejoin=\"round\" d=\"{}\"/>\n",
        pixels(x(0)), pixels(y(1)), pixels(frame_.width()), pixels(frame_.height()), kChartEdge,
        lines(overlay_.charts));
  }

  [[nodiscard]] std::string path() const {
    const std::string path = lines(overlay_.path);
    if (path.empty()) return "";
    return fmt::format(
        "<path fill=\"none\" stroke=\"#fff\" stroke-width=\"5\" d=\"{0}\"/>\n"
        "<path class=\"way\" fill=\"none\" stroke=\"#000\" stroke-width=\"2.5\" stroke-linejoin=\"round\" "
        "d=\"{0}\"/>\n",
        path);
  }

  [[nodiscard]] std::string legend() const {
    std::string out;
    double left = kLeft;
    double top = height_ - 80;
    const auto entry = [&](std::string_view fill, std::string_view text) {
      constexpr double kLetter = 6.9;  // mean width [px]
      const double width = 36 + kLetter * static_cast<double>(text.size());
      if (left + width > kWidth) {
        left = kLeft;
        top += 24;
      }
      out += fmt::format(
          "<rect x=\"{:.6g}\" y=\"{:.6g}\" width=\"14\" height=\"14\" fill=\"{}\" stroke=\"#222\" "
          "stroke-width=\"0.5\"/>"
          "<text x=\"{:.6g}\" y=\"{:.6g}\" font-size=\"13\">{}</text>\n",
          left, top, fill, left + 20, top + 12, text);
      left += width;
    };
    for (const Style& style : kStyles) {
      if (!cells_[style.look].empty()) entry(style.fill, style.legend);
    }
    if (!cut_off_.empty()) entry(kCutOff, "inside, but no motion from the start leads there (proved)");
    if (!overlay_.singular.empty()) entry(kSingular, "encloses det J = 0");
    if (!overlay_.charts.empty()) entry(kChartEdge, "charts of the atlas (nothing is proved of them)");
    return out;
  }

  const MapResult& result_;
  const MapOverlay& overlay_;
  MapFrame frame_;
  double height_;
  std::array<std::vector<Cell>, kLooks> cells_;
  std::vector<Cell> cut_off_;  ///< inside
};

}  // namespace

std::array<int, 2> map_picture_size(const MapResult& result) {
  return {static_cast<int>(kWidth), static_cast<int>(height_of(frame_of(result)))};
}

std::string map_svg(const MapResult& result, const MapOverlay& overlay) { return Drawing(result, overlay).draw(); }

}  // namespace taut
