// SPDX-License-Identifier: GPL-3.0-or-later
// Finds the charts near a point without looking at all of them.
//
// Points have kDimension coordinates, a fixed choice of the ambient coordinates. Leaving some out only shortens
// distances, so that nothing near is missed. Each point has a reach of its own.
// Source: Bentley, Saxe 1980, "Decomposable searching problems": static kd-trees of sizes 1, 2, 4, … buckets, merged
// like the digits of a binary counter; an insertion costs O(log^2 N), amortised.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <span>
#include <utility>
#include <vector>

#include "atlas/manifold.h"

namespace taut {

class NeighbourIndex {
 public:
  static constexpr int kDimension = 8;
  using Point = std::array<double, kDimension>;

  /// The first kDimension coordinates of an ambient point, filled up with zeros if it has fewer.
  [[nodiscard]] static Point locate(const AmbientPoint& ambient_point);

  /// A point. The entry in the middle of a range of a tree is also the node of that range.
  struct Entry {
    Point point;
    double reach;
    double largest_reach = 0;  ///< of the node's range
    int id;
    int split = 0;  ///< coordinate that divides the node's range
  };
  using Entries = std::vector<Entry>;

  NeighbourIndex() = default;
  /// Begins with the result of an earlier tree(), which is not copied: the memory must outlive the index.
  explicit NeighbourIndex(std::span<const Entry> tree) : stored_(tree) {}

  /// All points in one tree.
  [[nodiscard]] Entries tree() const;

  void insert(int id, const Point& point, double reach);

  /// Calls visit(id, |p_i - point|^2) for each point p_i with |p_i - point| <= max(reach, reach_i), in an order that is
  /// the same on every machine.
  template <class Visit>
  void visit(const Point& point, double reach, Visit&& visit) const {
    scan(recent_, 0, recent_.size(), point, reach, visit);
    Cell everywhere;
    descend(stored_, 0, stored_.size(), point, reach, everywhere, visit);
    for (const auto& tree : trees_) descend(tree, 0, tree.size(), point, reach, everywhere, visit);
  }

  /// Number of distances computed so far, a measure of cost that does not depend on the machine.
  [[nodiscard]] long distance_evaluations() const { return distance_evaluations_; }

 private:
  static constexpr std::size_t kBucket = 16;  ///< entries below which a scan beats a tree

  static void build(Entries& entries, std::size_t begin, std::size_t end);

  template <class Visit>
  void scan(std::span<const Entry> entries, std::size_t begin, std::size_t end, const Point& point, double reach,
            Visit&& visit) const {
    distance_evaluations_ += static_cast<long>(end - begin);
    for (std::size_t e = begin; e < end; ++e) {
      const Entry& entry = entries[e];
      double squared = 0;
      for (int k = 0; k < kDimension; ++k) squared += (point[k] - entry.point[k]) * (point[k] - entry.point[k]);
      const double limit = std::max(reach, entry.reach);
      if (squared <= limit * limit) visit(entry.id, squared);
    }
  }

  /// The part of space that a descent has reached: the squared distance of the point from it, and the distance along
  /// each coordinate (Arya, Mount 1993: incremental distances).
  struct Cell {
    double squared_distance = 0;
    Point gaps{};
  };

  template <class Visit>
  void descend(std::span<const Entry> entries, std::size_t begin, std::size_t end, const Point& point, double reach,
               Cell& cell, Visit&& visit) const {
    if (end - begin <= kBucket) return scan(entries, begin, end, point, reach, visit);
    const std::size_t middle = begin + (end - begin) / 2;
    const Entry& node = entries[middle];
    const double limit = std::max(reach, node.largest_reach);
    const double gap = point[node.split] - node.point[node.split];
    double& known_gap = cell.gaps[static_cast<std::size_t>(node.split)];
    const double here = cell.squared_distance;
    const double beyond = here - known_gap * known_gap + gap * gap;  // squared distance of the other half
    const auto half = [&](std::size_t from, std::size_t to, bool holds_point) {
      if (holds_point) return descend(entries, from, to, point, reach, cell, visit);
      if (beyond > limit * limit) return;
      const double before = std::exchange(known_gap, gap);
      cell.squared_distance = beyond;
      descend(entries, from, to, point, reach, cell, visit);
      cell.squared_distance = here;
      known_gap = before;
    };
    half(begin, middle, gap <= 0);
    if (std::abs(gap) <= limit) scan(entries, middle, middle + 1, point, reach, visit);
    half(middle + 1, end, gap >= 0);
  }

  std::span<const Entry> stored_;  ///< one tree, or none
  Entries recent_;
  std::vector<Entries> trees_;  ///< trees_[k] holds kBucket * 2^k entries or none
  mutable long distance_evaluations_ = 0;
};

}  // namespace taut
