// SPDX-License-Identifier: GPL-3.0-or-later
// The space that a map is made of: two or three free coordinates, each an interval or a whole turn.
//
// Coordinate j is λ_j = lower_j + t_j (upper_j − lower_j) with t_j in [0, 1], exactly.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "map/cell.h"
#include "problem/problem.h"

namespace taut {

struct MapAxis {
  enum class Kind {
    kRange,  ///< a parameter's range, whose ends are walls: maps speak of motions within it
    kTurn,   ///< all of a parameter that is periodic by 2π: from −π to π, and t = 0 and t = 1 are one
    kTilt,   ///< θ from 0 to π, where (φ, θ) and (φ + π, −θ) are one pose
  };
  std::string name;
  Kind kind = Kind::kRange;
  ExpressionText lower, upper;  ///< constant expressions, SI
};

struct MapSpace {
  /// The axes of φ and θ, and of σ where that is free, too: see topology.h for what they make neighbours.
  struct Flip {
    std::size_t phi, theta;
    std::optional<std::size_t> sigma;
  };
  std::vector<MapAxis> axes;
  std::optional<Flip> flip;

  [[nodiscard]] std::size_t size() const { return axes.size(); }
};

/// The whole space of a problem.
/// @throws FieldError where it has not two or three free coordinates, one of them is unbounded, or it has constraints.
[[nodiscard]] MapSpace make_map_space(const SpaceText& space);

}  // namespace taut
