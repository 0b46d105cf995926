// SPDX-License-Identifier: GPL-3.0-or-later
// Shortens a path: a search through chart centres gives a jagged path, which is pulled taut.
//
// Three moves on the vertices between start and goal alternate as long as they lower the cost: a vertex is left out; a
// vertex is moved downhill on the cost of its two edges; a long edge is divided, so that the path can follow a geodesic
// that is not straight in the coordinates. The length above which an edge is divided is halved from half the path down
// to a sixteenth, so that the path takes its overall shape first. A move is made only if it lowers the cost and every
// new edge is ok. Therefore the result is never longer than the input, up to the error of `cost`, and `edge_ok` has
// accepted all its new edges.
#pragma once

#include <functional>
#include <stop_token>
#include <vector>

#include "atlas/manifold.h"

namespace taut {

struct ShortenOptions {
  double edges = 16;         ///< edges longer than the whole path divided by this are divided, in the end
  double least_gain = 1e-4;  ///< a sweep that lowers the cost by less than this fraction is the last
  int max_sweeps = 60;
  int max_edges_checked = 4000;
};

struct ShortenProblem {
  /// Length of the edge from a to b; what is minimised.
  std::function<double(const Coordinates& a, const Coordinates& b)> cost;
  /// Whether the robot may go straight from a to b.
  std::function<bool(const Coordinates& a, const Coordinates& b)> edge_ok;
  std::stop_token stop;
  /// Moves a vertex onto the manifold, if straight lines between its points leave it; returns false if that fails. May
  /// be empty.
  std::function<bool(Coordinates& vertex)> project = {};
  /// No path costs less: one that nearly costs no more than this is left as it is.
  double least_cost = 0;
  /// The function x -> cost(before, x) + cost(x, after), which is asked for many x; empty: made of `cost`.
  std::function<std::function<double(const Coordinates& x)>(const Coordinates& before, const Coordinates& after)>
      cost_through = {};
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
