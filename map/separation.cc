// SPDX-License-Identifier: GPL-3.0-or-later
#include "map/separation.h"

#include <tbb/blocked_range.h>
#include <tbb/parallel_for.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <deque>
#include <memory>

namespace taut {
namespace {

constexpr auto kNever = static_cast<std::size_t>(-1);

/// @param cells  by node
std::vector<bool> flood(const CellMap& map, const std::vector<Cell>& cells, const std::vector<MapBox>& from) {
  std::vector<bool> reached(map.nodes.size(), false);
  std::vector<std::uint32_t> pending;
  const auto reach = [&](const std::vector<std::uint32_t>& leaves) {
    for (const std::uint32_t leaf : leaves) {
      if (is_outside(map.nodes[leaf].kind) || reached[leaf]) continue;
      reached[leaf] = true;
      pending.push_back(leaf);
    }
  };
  reach(leaves_at(map, from));
  while (!pending.empty()) {
    const Cell cell = cells[pending.back()];
    pending.pop_back();
    reach(neighbours(map, cell));
  }
  return reached;
}

class Separator {
 public:
  Separator(const Problem& problem, const MapSpace& space, const SeparationOptions& options)
      : options_(options), proof_(make_cell_proof(problem, space)) {
    result_.map.space = space;
    result_.map.share[0] = 1;
    const double halvings = std::floor(std::log2(1 / options.least_width));
    deepest_ = static_cast<int>(std::clamp(halvings, 0.0, double{kMaxCellDepth}));
    add_node(Cell(), 0);
  }

  Separation run(const std::vector<MapBox>& from, const std::vector<MapBox>& to) {
    judge({0});
    while (true) {
      result_.reached = flood(result_.map, cells_, from);
      if (is_apart(to)) return finish(Separation::Answer::kApart);
      if (is_joined(from, to)) return finish(Separation::Answer::kJoined);
      const std::vector<std::uint32_t> worth = largest_open_cells();
      if (worth.empty() || is_spent(worth.size())) break;
      halve(worth);
    }
    seek_gap(from, to);
    return finish(Separation::Answer::kOpen);
  }

 private:
  using Clock = std::chrono::steady_clock;

  [[nodiscard]] const MapNode& node(std::uint32_t n) const { return result_.map.nodes[n]; }
  [[nodiscard]] bool is_leaf(std::uint32_t n) const { return node(n).axis == MapNode::kLeaf; }

  void add_node(const Cell& cell, std::uint64_t proved) {
    result_.map.nodes.emplace_back();
    cells_.push_back(cell);
    verdicts_.emplace_back();
    verdicts_.back().proved = proved;
  }

  void judge(const std::vector<std::uint32_t>& nodes) {
    constexpr std::size_t kGrain = 64;
    tbb::parallel_for(tbb::blocked_range<std::size_t>(0, nodes.size(), kGrain), [&](const auto& range) {
      for (std::size_t i = range.begin(); i < range.end(); ++i) {
        CellVerdict& verdict = verdicts_[nodes[i]];
        verdict = proof_->judge(cells_[nodes[i]], verdict.proved);
      }
    });
    result_.map.judged += nodes.size();
    for (const std::uint32_t n : nodes) {
      const CellVerdict& verdict = verdicts_[n];
      MapNode& node = result_.map.nodes[n];
      node.kind = verdict.kind;
      node.reason = verdict.reason;
      node.regular = verdict.regular;
      const double volume = cells_[n].volume();
      result_.map.share[0] -= volume;
      result_.map.share[static_cast<std::size_t>(verdict.kind)] += volume;
    }
  }

  [[nodiscard]] bool is_apart(const std::vector<MapBox>& to) const {
    return std::ranges::none_of(leaves_at(result_.map, to), [&](std::uint32_t n) { return result_.reached[n]; });
  }

  /// How many undecided cells lie on a way from one place to another, at least; and the cells of such a way.
  struct Way {
    std::size_t undecided = kNever;
    std::vector<std::uint32_t> leaves;
  };
  [[nodiscard]] Way way(const std::vector<MapBox>& from, const std::vector<MapBox>& to) const {
    std::vector<std::uint32_t> before(result_.map.nodes.size());
    std::vector<std::size_t> cost(result_.map.nodes.size(), kNever);
    std::deque<std::uint32_t> queue;
    const auto step = [&](std::uint32_t leaf, std::uint32_t previous, std::size_t so_far) {
      if (!result_.reached[leaf]) return;
      const bool is_undecided = node(leaf).kind == CellKind::kUndecided;
      const std::size_t here = so_far + (is_undecided ? 1 : 0);
      if (here >= cost[leaf]) return;
      cost[leaf] = here;
      before[leaf] = previous;
      is_undecided ? queue.push_back(leaf) : queue.push_front(leaf);
    };
    for (const std::uint32_t leaf : leaves_at(result_.map, from)) step(leaf, leaf, 0);
    while (!queue.empty()) {
      const std::uint32_t leaf = queue.front();
      queue.pop_front();
      for (const std::uint32_t next : neighbours(result_.map, cells_[leaf])) step(next, leaf, cost[leaf]);
    }
    Way result;
    std::uint32_t last = 0;
    for (const std::uint32_t leaf : leaves_at(result_.map, to)) {
      if (cost[leaf] >= result.undecided) continue;
      result.undecided = cost[leaf];
      last = leaf;
    }
    if (result.undecided == kNever) return result;
    for (result.leaves = {last}; before[last] != last; result.leaves.push_back(last)) last = before[last];
    return result;
  }

  [[nodiscard]] bool is_joined(const std::vector<MapBox>& from, const std::vector<MapBox>& to) const {
    const auto is_inside = [&](std::uint32_t n) { return node(n).kind == CellKind::kInside; };
    return std::ranges::all_of(leaves_at(result_.map, from), is_inside) &&
           std::ranges::all_of(leaves_at(result_.map, to), is_inside) && way(from, to).undecided == 0;
  }

  [[nodiscard]] std::optional<std::size_t> axis_to_halve(std::uint32_t n) const {
    const Cell& cell = cells_[n];
    if (cell.halvings() >= kMaxCellHalvings) return std::nullopt;
    if (cell.depth[verdicts_[n].axis] < deepest_) return verdicts_[n].axis;
    std::optional<std::size_t> widest;
    for (std::size_t k = 0; k < result_.map.space.size(); ++k) {
      if (cell.depth[k] < deepest_ && (!widest || cell.depth[k] < cell.depth[*widest])) widest = k;
    }
    return widest;
  }

  /// Those of all undecided ones that matter that were halved least, and those that were halved once more.
  [[nodiscard]] std::vector<std::uint32_t> largest_open_cells() const {
    int least = kMaxCellHalvings + 1;
    const auto matters = [&](std::uint32_t n) {
      return result_.reached[n] && is_leaf(n) && node(n).kind == CellKind::kUndecided && axis_to_halve(n);
    };
    for (std::uint32_t n = 0; n < cells_.size(); ++n) {
      if (cells_[n].halvings() < least && matters(n)) least = cells_[n].halvings();
    }
    std::vector<std::uint32_t> found;
    for (std::uint32_t n = 0; n < cells_.size(); ++n) {
      if (cells_[n].halvings() <= least + 1 && matters(n)) found.push_back(n);
    }
    return found;
  }

  void halve(const std::vector<std::uint32_t>& nodes) {
    std::vector<std::uint32_t> halves;
    for (const std::uint32_t n : nodes) {
      const std::size_t axis = axis_to_halve(n).value();
      const auto child = static_cast<std::uint32_t>(cells_.size());
      result_.map.nodes[n].child = child;
      result_.map.nodes[n].axis = static_cast<std::uint8_t>(axis);
      for (unsigned side = 0; side < 2; ++side) {
        add_node(cells_[n].half(axis, side), verdicts_[n].proved);
        halves.push_back(child + side);
      }
    }
    judge(halves);
  }

  [[nodiscard]] bool is_spent(std::size_t more) const {
    return result_.map.leaves() + more > options_.most_cells || options_.stop.stop_requested() ||
           std::chrono::duration<double>(Clock::now() - begin_).count() > options_.seconds;
  }

  void seek_gap(const std::vector<MapBox>& from, const std::vector<MapBox>& to) {
    Way best = way(from, to);
    std::erase_if(best.leaves, [&](std::uint32_t n) { return node(n).kind != CellKind::kUndecided; });
    if (best.leaves.empty()) return;
    // The middle of the first stretch would do as well; this one is surely on it.
    const Cell& middle = cells_[best.leaves[best.leaves.size() / 2]];
    OpenPlace& gap = result_.gap.emplace();
    gap.cells = best.leaves.size();
    for (std::size_t k = 0; k < result_.map.space.size(); ++k) {
      gap.at.push_back(middle.mid(k));
      gap.half_width.push_back(middle.radius(k));
    }
  }

  Separation finish(Separation::Answer answer) {
    result_.answer = answer;
    for (std::uint32_t n = 0; n < cells_.size(); ++n) {
      const bool is_open = result_.reached[n] && is_leaf(n) && node(n).kind == CellKind::kUndecided;
      if (is_open) result_.open_share += cells_[n].volume();
    }
    return std::move(result_);
  }

  const SeparationOptions& options_;
  Clock::time_point begin_ = Clock::now();
  std::unique_ptr<CellProof> proof_;
  Separation result_;
  int deepest_ = 0;
  std::vector<Cell> cells_;            ///< by node
  std::vector<CellVerdict> verdicts_;  ///< likewise
};

}  // namespace

std::vector<bool> reached_leaves(const CellMap& map, const std::vector<MapBox>& from) {
  std::vector<Cell> cells(map.nodes.size());
  map.for_each_leaf([&](const Cell& cell, std::uint32_t node) { cells[node] = cell; });
  return flood(map, cells, from);
}

Separation separate(const Problem& problem, const MapSpace& space, const std::vector<ExpressionText>& from,
                    const std::vector<ExpressionText>& to, const SeparationOptions& options) {
  Problem as_typed = problem;
  as_typed.tolerances.reset();
  return Separator(as_typed, space, options).run(place_of(space, from), place_of(space, to));
}

}  // namespace taut
