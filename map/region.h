// SPDX-License-Identifier: GPL-3.0-or-later
// Where one may go from a place: what of a map is reached for certain, and what is not.
//
//   reachable  inside cells joined to the place: a motion from it to each of their poses exists, of which every pose is
//              feasible;
//   cut off    cells that no chain of cells that are not outside joins to the place: no motion of the coordinates
//              within the space, of which every pose is feasible, reaches any of their poses. Outside cells are, too;
//   open       the rest.
// Proof: docs/theory.md, "Maps".
#pragma once

#include <vector>

#include "map/topology.h"

namespace taut {

/// Refers to the topology, which outlives it.
class MapRegion {
 public:
  enum class Reach { kReachable, kOpen, kCutOff };

  /// @param from  boxes one of which holds the place, as place_of() gives them
  MapRegion(const MapTopology& topology, const std::vector<MapBox>& from);

  /// Of all poses of a leaf.
  [[nodiscard]] Reach reach(std::uint32_t node) const;
  /// Shares of the space: of what is reachable, and of what is not cut off. Exact sums.
  [[nodiscard]] double reachable() const { return reachable_; }
  [[nodiscard]] double possible() const { return possible_; }
  /// Whether the place itself is proved infeasible: then all is cut off.
  [[nodiscard]] bool starts_outside() const { return from_possible_.empty(); }

 private:
  const MapTopology& topology_;
  std::uint32_t from_inside_ = MapTopology::kNone;
  std::vector<std::uint32_t> from_possible_;  ///< components, sorted
  double reachable_ = 0, possible_ = 0;
};

}  // namespace taut
