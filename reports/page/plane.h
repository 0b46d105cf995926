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

/// Three signed fields, sampled at the centres of the cells of a grid over a window: row by row from the greatest value
/// of the second parameter down, and each row from the least value of the first one up. (Not at its edges, where a
/// parametrisation may degenerate.)
struct PlaneGrid {
  std::array<Span, 2> window;
  int columns = 0;
  int rows = 0;
  std::vector<double> tension;      ///< Reserves::tension, at least −1: positive where all tensions keep their limits
  std::vector<double> length;       ///< Reserves::length
  std::vector<double> determinant;  ///< det J; its zeros are the singular poses
};

struct Plane {
  PlaneGrid grid;                   ///< its window includes the whole path
  std::optional<PlaneGrid> detail;  ///< around the path, where that is small compared with the window
  std::vector<std::vector<std::array<double, 2>>> charts;  ///< polygons that reach into the window
};

/// A field as text, for contours at zero: for each cell a letter, upper case where the field is positive, lower case
/// elsewhere (NaN included), after the number of equal letters in a run of several. A is least and Z greatest in
/// magnitude, on a logarithmic scale: |x| is within 21 % of scale · 10^((letter − 25) · 0.16), letters counted from 0,
/// as far as the scale reaches. `scale` is the greatest magnitude next to a change of sign. Cells that have no
/// neighbour, diagonal ones included, of the other sign are Z or z, whatever their magnitude, because no contour
/// depends on it.
[[nodiscard]] std::string contour_text(const std::vector<double>& field, int columns);

/// The plane of a report; nothing if there is none, or if its window would have no finite size.
/// @param has_fields  whether the fields are sampled; else they are empty, and a proved map (plane_map.h) stands in
[[nodiscard]] std::optional<Plane> sample_plane(const ReportContext& scene, bool has_fields = true);

}  // namespace taut
