// SPDX-License-Identifier: GPL-3.0-or-later
// Rounds a path's corners: its straight segments become a cubic B-spline, twice continuously differentiable, with the
// path's vertices as control points. Every segment of the spline is proved again. If a proof fails, more control points
// are put on the edges around the segment, which pulls the spline towards the proved path.
#pragma once

#include <functional>
#include <optional>
#include <stop_token>
#include <vector>

#include "certify/path_proof.h"

namespace taut {

struct SmoothProblem {
  const Prover& prover;
  double clearance = 0;  ///< as Prover::prove
  /// Length of a path by the case's cost.
  std::function<double(const Path&)> length;
  /// The waypoint halfway between two; if there are constraints, it is on them and has normals.
  std::function<Waypoint(const Waypoint&, const Waypoint&)> halfway;
  std::stop_token stop = {};
};

struct SmoothPath {
  Path path;
  PathProof proof;
  double length = 0;
  int segments_judged = 0;
};

/// A proved spline not longer than `straight` that passes through the waypoints `stops` (ascending indices, including
/// the first and the last), where the motion comes to rest; nothing if none was found. The motion is C² in s.
/// @pre `straight` has no time law: proofs are of segments at rest
[[nodiscard]] std::optional<SmoothPath> smooth(const Path& straight, const std::vector<std::size_t>& stops,
                                               const SmoothProblem& problem);

}  // namespace taut
