// SPDX-License-Identifier: GPL-3.0-or-later
// One problem's bodies as numbers at one precision.
#pragma once

#include <array>
#include <variant>
#include <vector>

#include "checker/kernel/linear.h"
#include "checker/kernel/statement.h"

namespace taut::checker {

/// All points within `radius` of the convex hull of `points` [m]: of an obstacle in W, of a platform's body in P.
struct PlacedHull {
  std::vector<Vector3<Ball>> points;
  Ball radius;
};
/// All x with normal . x <= offset, in W.
struct PlacedHalfSpace {
  Vector3<Ball> normal;
  Ball offset;
};

struct PlacedBodies {
  /// Computes at the working precision. @throws Undefined where a rotation has no value.
  explicit PlacedBodies(const Problem& problem);

  std::vector<PlacedHull> platform;
  std::vector<std::variant<PlacedHull, PlacedHalfSpace>> obstacles;
  std::array<Ball, kCables> cable_radius;              ///< [m]
  std::array<std::array<Ball, 2>, kCables> free_ends;  ///< at base and platform [m]
  std::vector<CheckedPair> pairs;
  std::vector<Ball> clearance;  ///< of each pair [m]
  /// Whether two cables have one anchor: their base anchors (0) or their platform anchors (1) are stated at the same
  /// place and with the same tolerance.
  std::array<std::array<std::array<bool, 2>, kCables>, kCables> shares{};
};

}  // namespace taut::checker
