// SPDX-License-Identifier: GPL-3.0-or-later
#include "reports/page/map_frame.h"

#include <fmt/format.h>

#include <algorithm>
#include <utility>

#include "map/outline.h"

namespace taut {
namespace {

constexpr double kLetter = 7.6;  ///< mean width of a letter, generously [px]
constexpr double kDisc = 7;      ///< radius of a mark with its outline [px]

struct Box {
  double left, top, right, bottom;
};

bool overlap(const Box& a, const Box& b) {
  return a.left < b.right && b.left < a.right && a.top < b.bottom && b.top < a.bottom;
}

/// A name beside its disc.
struct Label {
  double x, y;  ///< of the text's baseline
  bool is_right;

  [[nodiscard]] Box box(const std::string& name) const {
    const double length = kLetter * static_cast<double>(name.size());
    return {is_right ? x : x - length, y - 12, is_right ? x + length : x, y + 4};
  }
};

/// The first of four places beside (x, y) that is free and within the picture; else the first.
Label place(double x, double y, const std::string& name, const std::vector<Box>& taken, const Box& bounds) {
  const std::array<Label, 4> all = {Label{x + 9, y - 7, true}, Label{x - 9, y - 7, false}, Label{x + 9, y + 17, true},
                                    Label{x - 9, y + 17, false}};
  for (const Label& label : all) {
    const Box box = label.box(name);
    const bool is_within =
        box.left >= bounds.left && box.right <= bounds.right && box.top >= bounds.top && box.bottom <= bounds.bottom;
    if (is_within && std::ranges::none_of(taken, [&](const Box& other) { return overlap(box, other); })) return label;
  }
  return all[0];
}

}  // namespace

MapFrame::MapFrame(std::array<ShownAxis, 2> axes, const MapFrameSize& size)
    : axes_(std::move(axes)), left_(size.left), top_(size.top), width_(size.width - size.left - size.right) {
  const auto extent = [&](std::size_t k) { return axes_.at(k).upper - axes_.at(k).lower; };
  const double ratio = std::clamp(extent(1) / extent(0), 0.3, 1.2);  // of unlike units, whatever fits a page
  height_ = width_ * ratio;
}

Html MapFrame::axes() const {
  Html out = html(
      "<rect x=\"{:.6g}\" y=\"{:.6g}\" width=\"{:.6g}\" height=\"{:.6g}\" fill=\"none\" stroke=\"#222\" "
      "class=\"frame\"/>\n",
      x(0), y(1), width_, height_);
  constexpr int kTicks = 4;
  for (int n = 0; n <= kTicks; ++n) {
    const double t = static_cast<double>(n) / kTicks;
    out +=
        html("<text x=\"{:.6g}\" y=\"{:.6g}\" text-anchor=\"middle\">{:.4g}</text>\n", x(t), y(0) + 20, axes_[0].at(t));
    out +=
        html("<text x=\"{:.6g}\" y=\"{:.6g}\" text-anchor=\"end\">{:.4g}</text>\n", x(0) - 6, y(t) + 5, axes_[1].at(t));
  }
  out +=
      html("<text x=\"{:.6g}\" y=\"{:.6g}\" text-anchor=\"middle\">{}</text>\n", x(0.5), y(0) + 40, axes_[0].title());
  return out + html("<text x=\"{:.6g}\" y=\"{:.6g}\">{}</text>\n", x(0), y(1) - 10, axes_[1].title());
}

Html MapFrame::marks(const std::vector<MapMark>& marks) const {
  std::vector<Box> taken;
  for (const MapMark& mark : marks) {
    const double u = x(mark.t[0]), v = y(mark.t[1]);
    taken.push_back({u - kDisc, v - kDisc, u + kDisc, v + kDisc});
  }
  const Box bounds = {x(0), y(1), x(1), y(0)};
  Html discs, names;
  for (const MapMark& mark : marks) {
    const double u = x(mark.t[0]), v = y(mark.t[1]);
    discs += html(
        "<circle class=\"place\" cx=\"{:.6g}\" cy=\"{:.6g}\" r=\"5\" fill=\"#fff\" stroke=\"#000\" "
        "stroke-width=\"2\"/>\n",
        u, v);
    const Label label = place(u, v, mark.name, taken, bounds);
    taken.push_back(label.box(mark.name));
    names += html(
        "<text class=\"place\" x=\"{:.6g}\" y=\"{:.6g}\" text-anchor=\"{}\" stroke=\"#fff\" stroke-width=\"3\" "
        "paint-order=\"stroke\">{}</text>\n",
        label.x, label.y, label.is_right ? "start" : "end", mark.name);
  }
  return discs + names;
}

std::string area_path(const std::vector<Cell>& cells) {
  constexpr int kShift = kMaxCellDepth - kAreaDepth;
  std::string path;
  const auto add = [&](const OutlineRing& ring) {
    std::array<int, 2> at = {static_cast<int>(ring[0][0] >> kShift), static_cast<int>(ring[0][1] >> kShift)};
    path += fmt::format("M{},{}", at[0], at[1]);
    for (std::size_t n = 1; n < ring.size(); ++n) {
      const std::size_t k = ring[n][0] == ring[n - 1][0] ? 1 : 0;
      const int to = static_cast<int>(ring[n][k] >> kShift);
      path += fmt::format("{}{}", k == 0 ? 'h' : 'v', to - at.at(k));
      at.at(k) = to;
    }
    path += 'z';
  };
  for (const OutlinePolygon& polygon : outline(cells)) {
    add(polygon.outer);
    for (const OutlineRing& hole : polygon.holes) add(hole);
  }
  return path;
}

}  // namespace taut
