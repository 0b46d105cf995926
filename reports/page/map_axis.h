// SPDX-License-Identifier: GPL-3.0-or-later
// The axes of a map as people read them, and what is said of all of its outputs.
#pragma once

#include <string>
#include <vector>

#include "map/cell_proof.h"
#include "map/map_space.h"
#include "reports/summary/display_units.h"

namespace taut {

/// A coordinate, with the values of its ends in a unit that people read.
struct ShownAxis {
  std::string name;
  std::string unit;  ///< "rad", "deg", "mm"; empty where the case does not tell what the coordinate is
  double lower = 0, upper = 1;
  double per_si = 1;  ///< the unit's values per SI's

  /// The value at t, rounded.
  [[nodiscard]] double at(double t) const { return lower + t * (upper - lower); }
  [[nodiscard]] std::string title() const { return unit.empty() ? name : name + " [" + unit + "]"; }
};

/// "-105.5 deg", "350 mm": a value in the axis' unit, rounded.
[[nodiscard]] std::string value_text(const ShownAxis& axis, double value);

/// "range", "turn" or "tilt".
[[nodiscard]] const char* axis_kind_name(MapAxis::Kind kind);
/// "undecided", "inside", "length", "tension", "unbalanced" or "contact".
[[nodiscard]] const char* cell_kind_name(CellKind kind);

/// All axes of a map of a problem's space.
[[nodiscard]] std::vector<ShownAxis> shown_axes(const SpaceText& text, const MapSpace& space,
                                                const DisplayUnits& units);

/// The unit of the volume: "rad²", "mm·deg", "" where none has a unit.
[[nodiscard]] std::string volume_unit(const std::vector<ShownAxis>& axes);
/// The volume of the whole space in that unit, rounded.
[[nodiscard]] double whole_volume(const std::vector<ShownAxis>& axes);

}  // namespace taut
