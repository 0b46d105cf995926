// SPDX-License-Identifier: GPL-3.0-or-later
// Rounds a path's corners: its straight segments become a cubic B-spline, twice continuously differentiable, with the
// path's vertices as control points. Every segment of the spline is proved again; where one is not, more control points
// are put on the edges around it, which pulls the spline to the path that is known to be good.
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
  /// The waypoint halfway; on the constraints, and with normals, where there are any.
  std::function<Waypoint(const Waypoint&, const Waypoint&)> halfway;
  std::stop_token stop = {};
};

struct SmoothPath {
  Path path;
  PathProof proof;
  double length = 0;
  int segments_judged = 0;
};

/// A proved spline not longer than `straight` that passes through the waypoints `stops` (ascending indices, the first
/// and the last among them), where the motion comes to rest; nothing if none was found. The motion is C² in s.
[[nodiscard]] std::optional<SmoothPath> smooth(const Path& straight, const std::vector<std::size_t>& stops,
                                               const SmoothProblem& problem);

}  // namespace taut
