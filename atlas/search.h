// Shortest and quickly found paths on an atlas that is grown while it is searched.
//
// A path runs from the start through centres of neighbouring charts to the goal. Start and goal are centres of charts
// of their own, made first; the goal is reached when charts grown from the start meet its chart.
//
// Edges are validated lazily: only those of a path that would be the answer are put to `edge_ok`, which may cost a
// hundred times a chart. One that fails is struck out for good (both ways), the search tree is repaired below it, and
// the search goes on. The paths found with kAStar are shortest among those on the charts' graph whose edges are ok, if
// the heuristic is consistent: |h(a) - h(b)| <= cost(a, b), h(goal) = 0.
//
// Sources: J. M. Porta, L. Jaillet, O. Bohigas 2012; O. Bohigas, M. Manubens, L. Ros (greedy best-first, A*);
// C. Dellin, S. Srinivasa, "A unifying formalism for shortest path problems with expensive edge evaluations", 2016.
#pragma once

#include <functional>
#include <stop_token>
#include <vector>

#include "atlas/atlas.h"
#include "kinematics/case_file.h"

namespace taut {

struct SearchProgress {
  int charts = 0;
  int nodes_expanded = 0;
  double lowest_heuristic = 0;
};

/// What is searched for. Coordinate vectors passed in are unwrapped: `b` is the image nearest to `a`.
struct SearchProblem {
  Coordinates start;
  Coordinates goal;
  /// Length of the edge from a to b, non-negative and the same for equivalent pairs.
  std::function<double(const Coordinates& a, const Coordinates& b)> cost;
  /// Lower bound of the length from a to the goal, here its image nearest to a.
  std::function<double(const Coordinates& a, const Coordinates& goal)> heuristic;
  /// Whether the robot may go straight from a to b. Called only for edges of a candidate path.
  std::function<bool(const Coordinates& a, const Coordinates& b)> edge_ok;
  std::function<void(const SearchProgress&)> progress;  ///< may be empty
  std::stop_token stop;                                 ///< looked at before each expansion and each edge_ok
};

/// A centre of a chart as the path passes through it. `base` is the centre's coordinates bit for bit (the query's own
/// for start and goal); `image` says exactly by how many half turns they were shifted, so that the path is continuous.
/// The first vertex is the start, unshifted; the last is the image of the goal that was reached.
struct PathVertex {
  Coordinates base;
  Image image;
  Coordinates coordinates;  ///< of the image, rounded
};

enum class SearchStatus {
  kFound,
  kExhausted,    ///< all charts that can be reached were made, all edges tried; says nothing about the robot
  kChartLimit,   ///< no path on the charts made
  kInterrupted,  ///< by `stop`
  kOutside,      ///< start or goal is not in the manifold's domain
};

struct SearchResult {
  SearchStatus status = SearchStatus::kExhausted;
  std::vector<PathVertex> path;  ///< at least two vertices if found, else empty
  double cost = 0;               ///< of the path [cost's unit]
  int charts = 0;                ///< of the atlas, at the end
  int nodes_expanded = 0;
  int edges_checked = 0;
  int edges_rejected = 0;
};

/// Searches `atlas`, growing it as needed; charts made before are used.
/// @pre all three functions of `problem` are set.
[[nodiscard]] SearchResult search(Atlas& atlas, const SearchProblem& problem, Strategy strategy);

}  // namespace taut
