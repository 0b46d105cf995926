// SPDX-License-Identifier: GPL-3.0-or-later
#include "atlas/search.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <limits>
#include <queue>
#include <stdexcept>
#include <unordered_set>

namespace taut {
namespace {

constexpr int kNone = -1;
constexpr int kProgressPeriod = 256;  // expansions between two reports
// The weights of an anytime search begin with infinity and kFirstWeight; the one after a weight up to kLastWeight is 1.
constexpr double kFirstWeight = 2.0;
constexpr double kLastWeight = 1.03;
// A greedy search that would end sooner is left alone.
constexpr int kExpansionsBeforeDetours = 10;

struct Node {
  bool closed = false;
  bool edge_accepted = false;  // the edge from the parent
  int parent = kNone;
  double cost = 0;          // from the start; for closed nodes
  double heuristic = -1;    // negative if it and `remaining` are not computed yet
  double remaining = 0;     // distance to the goal in the coordinates
  Image image;              // for closed nodes
  Coordinates coordinates;  // unwrapped, for closed nodes
};

// An edge to a node; or, with child == parent, a node around which charts are still to be made.
struct Candidate {
  double priority;
  double remaining;  // of the child
  double cost;       // of the child, from the start
  double parent_cost;
  int child;
  int parent;

  // Among candidates of equal priority, the one nearer to the goal in the coordinates comes first. There are many such
  // candidates if the heuristic knows only a part of the pose, such as the angle left to turn. The next criterion is
  // the larger cost from the start; ids make the order total.
  bool operator<(const Candidate& other) const {
    if (priority != other.priority) return priority > other.priority;
    if (remaining != other.remaining) return remaining > other.remaining;
    if (cost != other.cost) return cost < other.cost;
    if (child != other.child) return child > other.child;
    return parent > other.parent;
  }
};

class Search {
 public:
  Search(Atlas& atlas, const SearchProblem& problem, const SearchOptions& options)
      : atlas_(atlas),
        problem_(problem),
        options_(options),
        greedy_(std::isinf(options.weight)),
        symmetry_(atlas.manifold().symmetry()) {}

  SearchResult run() {
    result_.status = status_of_run();
    result_.charts = atlas_.size();
    result_.nearest = lowest_heuristic_;
    if (result_.status == SearchStatus::kFound) result_.factor = start_ == goal_ ? 1.0 : options_.weight;
    return std::move(result_);
  }

 private:
  SearchStatus status_of_run() {
    const auto start = atlas_.add(problem_.start);
    const auto goal = atlas_.add(problem_.goal);
    if (!start || !goal) return SearchStatus::kOutside;
    start_ = *start;
    goal_ = *goal;
    nodes_.resize(atlas_.size());
    if (start_ == goal_) return join_equal_ends();

    Node& root = nodes_[start_];
    root.coordinates = problem_.start;
    close(start_);
    while (!open_.empty()) {
      if (problem_.stop.stop_requested()) return SearchStatus::kInterrupted;
      const Candidate candidate = open_.top();
      open_.pop();
      if (!is_current(candidate)) continue;
      if (candidate.child == candidate.parent) {
        if (may_go_by_detour() && find_detour()) return SearchStatus::kFound;
        expand(candidate.child);
        continue;
      }
      adopt(candidate);
      const bool is_goal = candidate.child == goal_;
      if (is_goal ? !accept_edge(goal_) : !is_likely(candidate.child)) {
        reject(candidate.child);
        continue;
      }
      if (!is_goal) {
        close(candidate.child);
        continue;
      }
      nodes_[goal_].closed = true;
      closed_.push_back(goal_);
      const int broken = first_broken_edge();
      if (problem_.stop.stop_requested()) return SearchStatus::kInterrupted;
      if (broken == kNone) {
        write_path();
        return SearchStatus::kFound;
      }
      repair(broken);
    }
    return chart_limit_hit_ ? SearchStatus::kChartLimit : SearchStatus::kExhausted;
  }

  Coordinates base(int node) const {
    if (node == start_) return problem_.start;
    if (node == goal_) return problem_.goal;
    return atlas_.coordinates(node);
  }

  // Start and goal are the same point, perhaps with different coordinates: the path has one edge.
  SearchStatus join_equal_ends() {
    const Image image = symmetry_.nearest_image(problem_.goal, problem_.start);
    const Coordinates end = symmetry_.apply(problem_.goal, image);
    ++result_.edges_checked;
    if (!problem_.edge_ok(problem_.start, end)) {
      ++result_.edges_rejected;
      return SearchStatus::kExhausted;
    }
    result_.cost = problem_.cost(problem_.start, end);
    result_.path = {{problem_.start, {}, problem_.start}, {problem_.goal, image, end}};
    return SearchStatus::kFound;
  }

  bool may_go_by_detour() const {
    return greedy_ && problem_.straight_to_goal && problem_.detours &&
           result_.nodes_expanded == kExpansionsBeforeDetours;
  }

  // Sets the path if there is a point by which two edges lead to the goal.
  bool find_detour() {
    const auto is_edge_ok = [&](const Coordinates& a, const Coordinates& b) {
      ++result_.edges_checked;
      const bool is_ok = problem_.edge_ok(a, b);
      if (!is_ok) ++result_.edges_rejected;
      return is_ok;
    };
    for (const Coordinates& by : problem_.detours(problem_.start, problem_.goal)) {
      if (problem_.stop.stop_requested()) return false;
      const Image image = symmetry_.nearest_image(problem_.goal, by);
      const Coordinates end = symmetry_.apply(problem_.goal, image);
      if (!is_edge_ok(problem_.start, by) || !is_edge_ok(by, end)) continue;
      result_.cost = problem_.cost(problem_.start, by) + problem_.cost(by, end);
      result_.path = {{problem_.start, {}, problem_.start}, {by, {}, by}, {problem_.goal, image, end}};
      return true;
    }
    return false;
  }

  bool is_current(const Candidate& candidate) const {
    const Node& parent = nodes_[candidate.parent];
    if (!parent.closed || parent.cost != candidate.parent_cost) return false;
    if (candidate.child == candidate.parent) return true;
    return !nodes_[candidate.child].closed && !is_rejected(candidate.parent, candidate.child);
  }

  void adopt(const Candidate& candidate) {
    Node& node = nodes_[candidate.child];
    node.parent = candidate.parent;
    node.cost = candidate.cost;
    node.edge_accepted = false;
    node.image = symmetry_.nearest_image(base(candidate.child), nodes_[candidate.parent].coordinates);
    node.coordinates = symmetry_.apply(base(candidate.child), node.image);
  }

  // Makes the node part of the tree, and its neighbours candidates.
  void close(int node) {
    nodes_[node].closed = true;
    closed_.push_back(node);
    for (const int neighbour : atlas_.neighbours(node)) offer(node, neighbour);
    if (!problem_.straight_to_goal) return expand(node);
    offer(node, goal_);
    if (!atlas_.complete(node)) postpone(node);
  }

  // Queues the node again, to make the rest of the charts around it.
  void postpone(int node) { push(node, node, nodes_[node].cost, nodes_[node].cost); }

  // Makes charts around a closed node and offers them to every closed neighbour that they have.
  void expand(int node) {
    if (result_.nodes_expanded++ % kProgressPeriod == 0 && problem_.progress) {
      problem_.progress({atlas_.size(), result_.nodes_expanded, lowest_heuristic_});
    }
    const int first_new = atlas_.size();
    const bool complete = options_.weight > 1 ? atlas_.expand(node, 1, goal_) : atlas_.expand(node);
    nodes_.resize(atlas_.size());
    for (int chart = first_new; chart < atlas_.size(); ++chart) {
      for (const int neighbour : atlas_.neighbours(chart)) offer(neighbour, chart);
    }
    if (complete) return;
    if (atlas_.size() >= atlas_.options().max_charts) {
      chart_limit_hit_ = true;
      return;
    }
    postpone(node);
  }

  void offer(int parent, int child) {
    if (!nodes_[parent].closed || nodes_[child].closed || is_rejected(parent, child)) return;
    const Coordinates& from = nodes_[parent].coordinates;
    const Coordinates to = symmetry_.apply(base(child), symmetry_.nearest_image(base(child), from));
    const double parent_cost = nodes_[parent].cost;
    // A greedy search looks at the cost of an edge to the goal only where it decides nothing, and measuring a long edge
    // takes long, so a lower bound does until the path is found.
    const double edge = greedy_ && child == goal_ ? heuristic(parent) : problem_.cost(from, to);
    const double cost = parent_cost + edge;
    if (cost + heuristic(child) >= options_.cost_bound) return;
    push(parent, child, parent_cost, cost);
  }

  void push(int parent, int child, double parent_cost, double cost) {
    const double priority = greedy_ ? heuristic(child) : cost + options_.weight * heuristic(child);
    open_.push({priority, nodes_[child].remaining, cost, parent_cost, child, parent});
  }

  double heuristic(int node) {
    double& value = nodes_[node].heuristic;
    if (value < 0) {
      const Coordinates& at = base(node);
      const Coordinates goal = symmetry_.apply(problem_.goal, symmetry_.nearest_image(problem_.goal, at));
      value = problem_.heuristic(at, goal);
      nodes_[node].remaining = (goal - at).norm();
      if (node != goal_) lowest_heuristic_ = std::min(lowest_heuristic_, value);
    }
    return value;
  }

  // Asks edge_likely about the edge above an adopted node, once an edge of a path has failed.
  bool is_likely(int node) const {
    if (!problem_.edge_likely || !tree_edge_failed_) return true;
    return problem_.edge_likely(nodes_[nodes_[node].parent].coordinates, nodes_[node].coordinates);
  }

  void reject(int node) {
    ++result_.edges_rejected;
    rejected_.insert(key(nodes_[node].parent, node));
  }

  // Checks the edges of the path from the start to the goal. Returns the node below the first that fails.
  int first_broken_edge() {
    std::vector<int> nodes;
    for (int node = goal_; node != start_; node = nodes_[node].parent) nodes.push_back(node);
    for (auto it = nodes.rbegin(); it != nodes.rend(); ++it) {
      if (problem_.stop.stop_requested()) return kNone;
      if (!accept_edge(*it)) return *it;
    }
    return kNone;
  }

  // Asks edge_ok about the edge from the node's parent, unless it was accepted before.
  bool accept_edge(int child) {
    Node& node = nodes_[child];
    if (node.edge_accepted) return true;
    ++result_.edges_checked;
    return node.edge_accepted = problem_.edge_ok(nodes_[node.parent].coordinates, node.coordinates);
  }

  // Removes the edge above `broken` and opens the subtree below it again. All other closed nodes keep their cost, since
  // removing edges makes no path shorter.
  void repair(int broken) {
    reject(broken);
    tree_edge_failed_ = true;
    std::vector<int> kept;
    std::vector<int> subtree;
    for (const int node : closed_) {  // parents come before their children
      const int parent = nodes_[node].parent;
      if (node == broken || (parent != kNone && !nodes_[parent].closed)) {
        nodes_[node].closed = false;
        subtree.push_back(node);
      } else {
        kept.push_back(node);
      }
    }
    closed_ = std::move(kept);
    for (const int node : subtree) {
      for (const int neighbour : atlas_.neighbours(node)) offer(neighbour, node);
    }
  }

  void write_path() {
    for (int node = goal_; node != kNone; node = nodes_[node].parent) {
      result_.path.push_back({base(node), nodes_[node].image, nodes_[node].coordinates});
    }
    std::reverse(result_.path.begin(), result_.path.end());
    const Node& before = nodes_[nodes_[goal_].parent];
    result_.cost = before.cost + problem_.cost(before.coordinates, nodes_[goal_].coordinates);
  }

  static std::uint64_t key(int a, int b) {
    return (std::uint64_t(std::uint32_t(std::min(a, b))) << 32) | std::uint32_t(std::max(a, b));
  }
  bool is_rejected(int a, int b) const { return !rejected_.empty() && rejected_.contains(key(a, b)); }

  Atlas& atlas_;
  const SearchProblem& problem_;
  const SearchOptions options_;
  const bool greedy_;
  const CoordinateSymmetry symmetry_;
  int start_ = kNone;
  int goal_ = kNone;
  std::vector<Node> nodes_;  // by chart
  std::vector<int> closed_;  // in the order of closing
  std::priority_queue<Candidate> open_;
  std::unordered_set<std::uint64_t> rejected_;
  bool tree_edge_failed_ = false;  // an edge of a path that had reached the goal was removed
  bool chart_limit_hit_ = false;
  double lowest_heuristic_ = std::numeric_limits<double>::infinity();
  SearchResult result_;
};

double next_weight(double weight) { return weight > kLastWeight ? (1 + weight) / 2 : 1; }

}  // namespace

void SearchOptions::validate() const {
  if (!(weight >= 1)) throw std::invalid_argument("SearchOptions: weight must be at least 1");
  if (!(cost_bound >= 0)) throw std::invalid_argument("SearchOptions: cost_bound must not be negative");
}

SearchResult search(Atlas& atlas, const SearchProblem& problem, const SearchOptions& options) {
  options.validate();
  return Search(atlas, problem, options).run();
}

SearchResult search_anytime(Atlas& atlas, const SearchProblem& problem,
                            const std::function<bool(const SearchResult&)>& improved) {
  SearchResult best = search(atlas, problem, {.weight = std::numeric_limits<double>::infinity()});
  bool ended = best.status != SearchStatus::kFound || !improved(best);
  for (double weight = kFirstWeight; !ended && best.factor > 1; weight = next_weight(weight)) {
    SearchResult next = search(atlas, problem, {.weight = weight, .cost_bound = best.cost});
    next.nodes_expanded += best.nodes_expanded;
    next.edges_checked += best.edges_checked;
    next.edges_rejected += best.edges_rejected;
    next.nearest = std::min(next.nearest, best.nearest);
    const SearchStatus status = next.status;
    if (status != SearchStatus::kFound) {
      ended = status != SearchStatus::kExhausted;
      next.status = SearchStatus::kFound;
      next.path = std::move(best.path);
      next.cost = best.cost;
      next.factor = ended ? best.factor : weight;
    }
    best = std::move(next);
    if (status == SearchStatus::kFound) ended = !improved(best);
  }
  return best;
}

}  // namespace taut
