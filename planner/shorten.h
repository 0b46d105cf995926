// SPDX-License-Identifier: GPL-3.0-or-later
// Shortens a path: what a search through chart centres leaves jerky is pulled taut.
//
// Alternates three moves on the vertices between start and goal, as long as they pay: a vertex is left out; a vertex is
// moved towards where its neighbours want it; a long edge is divided, so that a path may follow a geodesic that is not
// straight in the coordinates. What counts as long is halved from half the path down to a sixteenth: the path finds its
// way as a whole first. A move is made only if it lowers the cost and every new edge is ok. So the result is never
// longer than what came in, up to the error of `cost`, and its edges are as good as `edge_ok` says.
#pragma once

#include <functional>
#include <stop_token>
#include <vector>

#include "atlas/manifold.h"

namespace taut {

struct ShortenOptions {
  double edges = 16;         ///< edges longer than the whole path divided by this are divided, in the end
  double least_gain = 1e-4;  ///< a sweep that lowers the cost by less than this share is the last
  int max_sweeps = 60;
  int max_edges_checked = 4000;
};

struct ShortenProblem {
  /// Length of the edge from a to b; what is minimised.
  std::function<double(const Coordinates& a, const Coordinates& b)> cost;
  /// Whether the robot may go straight from a to b.
  std::function<bool(const Coordinates& a, const Coordinates& b)> edge_ok;
  std::stop_token stop;
  /// Moves a vertex onto the manifold, where straight lines between its points leave it; false where that fails. May be
  /// empty.
  std::function<bool(Coordinates& vertex)> project = {};
};

struct ShortenResult {
  double cost_before = 0;
  double cost_after = 0;
  int edges_checked = 0;
};

/// Shortens `path` in place; its first and last vertex stay. @pre every edge of `path` is ok; at least one vertex.
ShortenResult shorten(std::vector<Coordinates>& path, const ShortenProblem& problem,
                      const ShortenOptions& options = {});

}  // namespace taut
