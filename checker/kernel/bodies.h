// SPDX-License-Identifier: GPL-3.0-or-later
// One problem's bodies as numbers at one precision.
#pragma once

#include <array>
#include <memory>
#include <optional>
#include <variant>
#include <vector>

#include "checker/kernel/linear.h"
#include "checker/kernel/statement.h"

namespace taut::checker {

/// The points at + R (unit f) of a mesh's points f, in its file's unit.
struct PlacedSurface {
  std::shared_ptr<const Surface> surface;
  Ball unit;  ///< [m]
  Vector3<Ball> at;
  Matrix3<Ball> R;
  [[nodiscard]] Vector3<Ball> place(const Surface::Point& f) const {
    return at + multiply(R, unit * Vector3<Ball>{Ball(f[0]), Ball(f[1]), Ball(f[2])});
  }
};
/// All points within `radius` of the convex hull of `points` [m]: of an obstacle in W, of a platform's body in P. Or,
/// if there is one, a mesh and nothing else.
struct PlacedHull {
  std::vector<Vector3<Ball>> points;
  Ball radius;
  std::optional<PlacedSurface> mesh{};
};
/// All x with normal . x <= offset, in W.
struct PlacedHalfSpace {
  Vector3<Ball> normal;
  Ball offset;
};

struct PlacedZone {
  Vector3<Ball> at;
  Ball within;
  Ball depth;
};

struct PlacedExitCone {
  Axes end;
  Vector3<Ball> axis;  ///< of length 1
  Ball sine, cosine;   ///< of the half-angle
};

struct PlacedBodies {
  /// Computes at the working precision. @throws Undefined where a rotation has no value, for a half-angle that may
  /// not be above 0 and below a right angle, and for a mesh that nobody read.
  explicit PlacedBodies(const Problem& problem);

  /// The first or the second body of a pair; null where it is a cable or a half-space.
  [[nodiscard]] const PlacedHull* hull(const CheckedPair& pair, bool is_first) const {
    if (is_first) return pair.kind == PairKind::kPlatformObstacle ? &platform[pair.first] : nullptr;
    if (pair.kind == PairKind::kCableCable || pair.kind == PairKind::kExitCone) return nullptr;
    return pair.kind == PairKind::kCablePlatform ? &platform[pair.second]
                                                 : std::get_if<PlacedHull>(&obstacles[pair.second]);
  }
  /// The first or the second body of a pair, if it is a mesh; else null.
  [[nodiscard]] const PlacedSurface* mesh(const CheckedPair& pair, bool is_first) const {
    const PlacedHull* const body = hull(pair, is_first);
    return body != nullptr && body->mesh ? &*body->mesh : nullptr;
  }

  /// What the bodies of pair k have to be farther apart than, the platform's origin being in p, is not more than the
  /// one and not less than the other [m].
  [[nodiscard]] Ball required_at_most(std::size_t k, const Vector3<Ball>& p) const;
  [[nodiscard]] Ball required_at_least(std::size_t k, const Vector3<Ball>& p) const;

  std::vector<PlacedHull> platform;
  std::vector<std::variant<PlacedHull, PlacedHalfSpace>> obstacles;
  std::array<Ball, kCables> cable_radius;              ///< [m]
  std::array<std::array<Ball, 2>, kCables> free_ends;  ///< at base and platform [m]
  std::vector<PlacedExitCone> exit_cones;
  std::vector<CheckedPair> pairs;
  std::vector<Ball> clearance;                 ///< of each pair [m]
  std::vector<std::vector<PlacedZone>> zones;  ///< of each pair
  /// Whether two cables have one anchor: their base anchors (0) or their platform anchors (1) are stated at the same
  /// place and with the same tolerance.
  std::array<std::array<std::array<bool, 2>, kCables>, kCables> shares{};
};

}  // namespace taut::checker
