// SPDX-License-Identifier: GPL-3.0-or-later
// The plane of two parameters: which of its poses keep the limits, where J is singular, and the charts of the atlas. It
// is sampled on a grid in floating point and only serves to draw a picture.
#pragma once

#include <array>
#include <optional>
#include <string>
#include <vector>

#include "reports/summary/scene.h"

namespace taut {

/// Whether the space has two parameters, all values of which give a pose; only then is there a plane to draw.
[[nodiscard]] bool is_plane(const SpaceText& space);

/// An interval on an axis.
struct Span {
  double lower = 0;
  double upper = 1;

  [[nodiscard]] double length() const { return upper - lower; }
  /// Widened to contain x; NaN and infinities are ignored.
  void include(double x);
};

struct Plane {
  std::array<Span, 2> window;  ///< the values of each parameter that are shown, which include the whole path
  int columns = 0;
  int rows = 0;
  /// '0' + Feasibility at the centre of each cell, row by row from the greatest value of the second parameter down.
  std::string cells;
  /// Pieces of the line det J = 0, from (x, y) to (x, y): the determinant changes sign between neighbouring cells.
  std::vector<std::array<double, 4>> singular;
  std::vector<std::vector<std::array<double, 2>>> charts;  ///< polygons that reach into the window
};

/// The plane of a report; nothing if there is none, or if its window would have no finite size.
[[nodiscard]] std::optional<Plane> sample_plane(const ReportContext& scene);

}  // namespace taut
