// SPDX-License-Identifier: GPL-3.0-or-later
// The frame of a picture of a map of two coordinates: where a place is drawn, values along the axes, marked places.
#pragma once

#include <array>
#include <string>
#include <vector>

#include "map/cell.h"
#include "reports/page/map_axis.h"
#include "reports/page/markup.h"

namespace taut {

/// A place with a name.
struct MapMark {
  std::string name;
  std::array<double, 2> t;
};

/// Where the frame is in the picture [px].
struct MapFrameSize {
  double left, top, right;  ///< margins
  double width;             ///< of the picture
};

class MapFrame {
 public:
  MapFrame(std::array<ShownAxis, 2> axes, const MapFrameSize& size);

  /// Of the frame itself [px].
  [[nodiscard]] double width() const { return width_; }
  [[nodiscard]] double height() const { return height_; }
  /// Of a place in the picture [px].
  [[nodiscard]] double x(double t) const { return left_ + t * width_; }
  [[nodiscard]] double y(double t) const { return top_ + (1 - t) * height_; }

  /// The frame's outline, values along both axes and their names, as SVG.
  [[nodiscard]] Html axes() const;
  /// Discs with names, as SVG. A name stands where it hides no disc and no other name, if there is such a place.
  [[nodiscard]] Html marks(const std::vector<MapMark>& marks) const;

 private:
  std::array<ShownAxis, 2> axes_;
  double left_, top_, width_, height_;
};

/// Whole units along an axis from t = 0 to t = 1, in which area_path() counts.
inline constexpr int kAreaDepth = 11;
inline constexpr int kAreaUnits = 1 << kAreaDepth;

/// The union of cells as the data of an SVG path, to be filled by the rule evenodd: t = x / kAreaUnits, y upward.
/// @pre no two cells overlap, and no axis is halved more than kAreaDepth times
[[nodiscard]] std::string area_path(const std::vector<Cell>& cells);

}  // namespace taut
