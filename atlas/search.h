// SPDX-License-Identifier: GPL-3.0-or-later
// Searches an atlas, growing it on the way, for shortest paths or for paths that are found quickly.
//
// A path runs from the start through centres of neighbouring charts to the goal. Start and goal are centres of charts
// of their own, made first; the goal is reached when charts grown from the start meet its chart.
//
// Edges are validated lazily: `edge_ok`, which may cost a hundred times as much as a chart, is called only for edges of
// a path that would be the answer, the last edge first. An edge that fails is removed for good (in both directions),
// the search tree is repaired below it, and the search goes on. If the heuristic is consistent, |h(a) - h(b)| <=
// cost(a, b) and h(goal) = 0, a path found with weight 1 is the shortest of those on the charts' graph whose edges are
// ok; one found with weight w is at most w times as long.
//
// With a weight above 1 the charts around a node are made one at a time, in the goal's direction first, as long as no
// other candidate is more promising than the node: the number of a chart's neighbours grows exponentially with the
// dimension, and few are needed. With weight 1 no neighbour can be more promising than its node, so all are made.
//
// A greedy search may pass along an obstacle from chart to chart, where two long edges would go around it. So after a
// few charts it tries some points by which the way would not be much longer than the straight one
// (SearchProblem::detours).
//
// Sources: J. M. Porta, L. Jaillet, O. Bohigas 2012; O. Bohigas, M. Manubens, L. Ros (greedy best-first, A*);
// C. Dellin, S. Srinivasa, "A unifying formalism for shortest path problems with expensive edge evaluations", 2016;
// S. Richter, J. Thayer, W. Ruml, "The joy of forgetting: faster anytime search via restarting", 2010.
#pragma once

#include <functional>
#include <limits>
#include <stop_token>
#include <vector>

#include "atlas/atlas.h"

namespace taut {

struct SearchProgress {
  int charts = 0;
  int nodes_expanded = 0;
  double lowest_heuristic = 0;
};

/// The query. Coordinate vectors passed to the functions are unwrapped: `b` is the image nearest to `a`.
struct SearchProblem {
  Coordinates start;
  Coordinates goal;
  /// Length of the edge from a to b: non-negative, and the same for equivalent pairs.
  std::function<double(const Coordinates& a, const Coordinates& b)> cost;
  /// Lower bound of the length from a to `goal`, the image of the goal nearest to a.
  std::function<double(const Coordinates& a, const Coordinates& goal)> heuristic;
  /// Whether the robot may go straight from a to b. Called only for edges of a candidate path.
  std::function<bool(const Coordinates& a, const Coordinates& b)> edge_ok;
  /// A cheap necessary condition of edge_ok; may be empty. Once an edge of a candidate path has failed, it is called
  /// for every edge that is about to join the search tree, so that fewer edges have to be removed from it later.
  std::function<bool(const Coordinates& a, const Coordinates& b)> edge_likely;
  /// Adds to the charts' graph an edge from every chart straight to the goal. Most are not ok; one that is saves all
  /// charts beyond it. `edge_ok` is then called often and should refuse quickly.
  bool straight_to_goal = false;
  /// Points by which a greedy search with straight_to_goal tries to reach the goal in two edges, in the order in which
  /// they are tried, when the straight edge and the first charts have not led there. Called once; may be empty.
  std::function<std::vector<Coordinates>(const Coordinates& start, const Coordinates& goal)> detours;
  std::function<void(const SearchProgress&)> progress;  ///< may be empty
  std::stop_token stop;                                 ///< checked before each expansion and each edge_ok of a path
};

/// Candidates are taken in the order of cost from the start + weight * heuristic.
struct SearchOptions {
  /// 1 is A* and finds the shortest path. A larger weight finds one sooner that is at most `weight` times as long.
  /// Infinity is greedy best-first search, in the order of the heuristic alone.
  double weight = 1;
  /// Only paths shorter than this are looked for. kExhausted then means that none on the charts' graph is shorter than
  /// cost_bound / weight.
  double cost_bound = std::numeric_limits<double>::infinity();

  /// @throws std::invalid_argument naming the field at fault.
  void validate() const;
};

/// A chart's centre, or a detour's point, as a vertex of the path. `base` is its coordinates bit for bit (the query's
/// own for start and goal); `image` says exactly by how many half turns they were shifted to make the path continuous.
/// The first vertex is the start, unshifted; the last is the image of the goal that was reached.
struct PathVertex {
  Coordinates base;
  Image image;
  Coordinates coordinates;  ///< of the image, rounded
};

enum class SearchStatus {
  kFound,
  kExhausted,    ///< all charts that can be reached were made and all edges tried; this proves nothing about the robot
  kChartLimit,   ///< there is no path on the charts made so far, and max_charts is reached
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
  double nearest = std::numeric_limits<double>::infinity();  ///< least heuristic of a node other than the goal's
  /// The path is at most `factor` times as long as the shortest on the charts' graph; 1 if it is the shortest.
  double factor = std::numeric_limits<double>::infinity();
};

/// Searches `atlas`, growing it as needed; charts made before are used.
/// @pre all three functions of `problem` are set.
[[nodiscard]] SearchResult search(Atlas& atlas, const SearchProblem& problem, const SearchOptions& options);

/// Finds a path soon and shorter ones later: a greedy best-first search is followed by searches with weights that halve
/// their distance to 1, each for a path shorter than the last, all on the same atlas. Calls `improved` with each path
/// found, which says whether a shorter one is wanted. Ends when none is, when the last path is known to be the shortest
/// on the charts' graph, or with `factor` > 1 when max_charts is reached or `stop` is requested.
/// @returns the last path found, with counts over all searches.
[[nodiscard]] SearchResult search_anytime(Atlas& atlas, const SearchProblem& problem,
                                          const std::function<bool(const SearchResult&)>& improved);

}  // namespace taut
