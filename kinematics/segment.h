// Paths: exact waypoints and the law that joins them.
//
// Waypoint k is the parameter vector λ_k with λ_kj = x_kj + π half_turns_kj: binary64 numbers and integers, so that a pose
// reached the other way round a periodic angle is still exactly the pose that was asked for.
#pragma once

#include <vector>

namespace taut {

struct Waypoint {
  std::vector<double> x;        ///< one a parameter [m, rad], finite
  std::vector<int> half_turns;  ///< one a parameter; non-zero only where it is periodic
  bool operator==(const Waypoint&) const = default;
};

/// Straight in the parameters between consecutive waypoints: γ_k(s) = pose((1−s) λ_k + s λ_{k+1}).
struct Path {
  std::vector<Waypoint> waypoints;
};

}  // namespace taut
