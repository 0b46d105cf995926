// SPDX-License-Identifier: GPL-3.0-or-later
// The plane of two parameters: which of its poses keep the limits, where J is singular, and the charts of the atlas. Sampled on a
// grid in floating point: for a picture.
#pragma once

#include <array>
#include <optional>
#include <string>
#include <vector>

#include "reports/summary/scene.h"

namespace taut {

/// Whether any values of the space's parameters, which are two, give a pose: then there is a plane to draw.
[[nodiscard]] bool is_plane(const SpaceText& space);

/// Values on an axis.
struct Span {
  double lower = 0;
  double upper = 1;

  [[nodiscard]] double length() const { return upper - lower; }
  /// Widened to contain x; NaN and infinities are ignored.
  void include(double x);
};

struct Plane {
  std::array<Span, 2> window;  ///< what is shown of each parameter; all of the path is in it
  int columns = 0;
  int rows = 0;
  /// '0' + Feasibility of each cell's middle, row by row from the greatest value of the second parameter down.
  std::string cells;
  /// Pieces of the line det J = 0: from and to, (x, y, x, y), where the determinant changes sign between neighbouring cells.
  std::vector<std::array<double, 4>> singular;
  std::vector<std::vector<std::array<double, 2>>> charts;  ///< polygons that reach into the window
};

/// Nothing unless is_plane, or where there is no window of finite size.
[[nodiscard]] std::optional<Plane> sample_plane(const ReportContext& scene);

}  // namespace taut
