// SPDX-License-Identifier: GPL-3.0-or-later
// Which cells of a map share a pose, and what hangs together.
//
// Two closed cells are neighbours if they share a point (of a face, an edge or a corner). Beyond that:
//   kTurn    t = 0 and t = 1 are one;
//   kRange   an end is a wall;
//   flip     on θ = 0 the orientation depends on σ alone, whatever φ is: cells there share a pose if they share the
//            other coordinates; on θ = π it depends on σ − 2φ alone: they share one if they share σ − 2φ (mod 2π) and
//            the coordinates besides φ and σ. Where σ is fixed, that is φ and φ + π.
// A component of inside cells is joined for certain; two components of cells that are not outside are apart for
// certain: no motion of the coordinates within the space leads from one to the other. Proof: docs/theory.md, "Maps".
#pragma once

#include <array>
#include <cstdint>
#include <limits>
#include <vector>

#include "map/subdivision.h"

namespace taut {

/// A closed box of t; [0, 1] along axes that the space does not have.
struct MapBox {
  std::array<double, kMaxMapAxes> lower{}, upper{1, 1, 1};
};
[[nodiscard]] MapBox box_of(const Cell& cell);

/// Boxes that contain all places at which coordinates may be, one expression each: they are enclosed, brought into the
/// space's turn, and where (φ, θ) flip, to θ in [0, π]. Rounding may make it more than one box.
[[nodiscard]] std::vector<MapBox> place_of(const MapSpace& space, const std::vector<ExpressionText>& coordinates);

/// The leaves that may hold a place.
[[nodiscard]] std::vector<std::uint32_t> leaves_at(const CellMap& map, const std::vector<MapBox>& place);
/// The leaves that share a pose with a cell, itself among them, in no order, some more than once.
[[nodiscard]] std::vector<std::uint32_t> neighbours(const CellMap& map, const Cell& cell);

struct MapComponent {
  double volume = 0;      ///< the share of the space
  std::size_t cells = 0;  ///< leaves
};

/// What hangs together. Refers to the map, which outlives it.
class MapTopology {
 public:
  static constexpr std::uint32_t kNone = std::numeric_limits<std::uint32_t>::max();

  explicit MapTopology(const CellMap& map);

  /// Of inside cells, and of all that are not outside: the largest first.
  [[nodiscard]] const std::vector<MapComponent>& inside() const { return inside_; }
  [[nodiscard]] const std::vector<MapComponent>& possible() const { return possible_; }
  /// The component of a leaf by its node, or kNone where it is not of that kind.
  [[nodiscard]] std::uint32_t inside_component(std::uint32_t node) const { return inside_of_[node]; }
  [[nodiscard]] std::uint32_t possible_component(std::uint32_t node) const { return possible_of_[node]; }

  [[nodiscard]] std::vector<std::uint32_t> leaves_at(const std::vector<MapBox>& place) const {
    return taut::leaves_at(map_, place);
  }
  [[nodiscard]] std::vector<std::uint32_t> neighbours(const Cell& cell) const { return taut::neighbours(map_, cell); }

  enum class Connection {
    kJoined,   ///< inside cells join them: a motion exists, every pose of which is feasible
    kApart,    ///< no cells that are not outside do: there is no such motion of the coordinates
    kOutside,  ///< one of them is itself in outside cells alone
    kOpen,     ///< neither is proved
  };
  [[nodiscard]] Connection connection(const std::vector<MapBox>& from, const std::vector<MapBox>& to) const;

 private:
  const CellMap& map_;
  std::vector<std::uint32_t> inside_of_, possible_of_;  ///< by node
  std::vector<MapComponent> inside_, possible_;
};

}  // namespace taut
