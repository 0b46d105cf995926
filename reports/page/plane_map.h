// SPDX-License-Identifier: GPL-3.0-or-later
// The proved map of a plane of two parameters, as a report draws it behind the path. The program that makes the report
// proves it then, from the problem alone; no certificate states it.
#pragma once

#include <array>
#include <optional>
#include <string>
#include <vector>

#include "map/subdivision.h"
#include "reports/page/plane.h"

namespace taut {

struct PlaneMap {
  /// The union of all cells of a kind, as area_path() (map_frame.h) gives it: "inside", "tension", "unbalanced",
  /// "length", "undecided"; and on top of these "cut_off" (inside, but no motion from the query's first waypoint leads
  /// there), "both" (limits of tensions and of lengths are broken) and "singular" (cells that enclose det J = 0).
  struct Area {
    const char* kind;
    std::string path;
  };
  std::array<Span, 2> window;                      ///< from t = 0 to t = 1
  std::array<bool, 2> turns{};                     ///< along which parameters the map repeats after 2π
  std::optional<std::array<std::size_t, 2>> flip;  ///< the parameters φ and θ where (φ + π, −θ) is drawn as (φ, θ) is
  std::vector<Area> areas;
  std::array<double, kCellKinds> share{};  ///< of the window, by CellKind
  std::size_t cells = 0;
};

/// The map of the whole space, to cells of 1/512 of its axes or so many that a page can hold them; nothing where
/// the space has no map (map_space.h). The same for the same problem.
[[nodiscard]] std::optional<PlaneMap> plane_map(const ReportContext& scene);
/// The same of a part of the plane, in finer cells and without "cut_off".
[[nodiscard]] std::optional<PlaneMap> plane_map(const ReportContext& scene, const std::array<Span, 2>& window);

}  // namespace taut
