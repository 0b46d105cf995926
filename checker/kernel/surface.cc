// SPDX-License-Identifier: GPL-3.0-or-later
#include "checker/kernel/surface.h"

#include <algorithm>
#include <cmath>
#include <compare>
#include <limits>
#include <utility>

#include "checker/kernel/errors.h"

namespace taut::checker {

Surface::Surface(std::vector<Point> points, std::vector<Triangle> triangles, const std::vector<Needle>& needles)
    : points_(std::move(points)), elements_(std::move(triangles)), triangles_(elements_.size()) {
  for (const auto& [a, b] : needles) elements_.push_back({a, b, b});
  if (triangles_ == 0) throw Undefined("a mesh has no triangle");
  for (const Point& point : points_) {
    if (!std::ranges::all_of(point, [](double x) { return std::isfinite(x); })) {
      throw Undefined("a mesh has a point that is no number");
    }
  }
  for (const Triangle& element : elements_) {
    if (std::ranges::any_of(element, [&](std::uint32_t k) { return k >= points_.size(); })) {
      throw Undefined("a mesh has a corner without a point");
    }
  }
  for (std::uint32_t k = 0; k < elements_.size(); ++k) order_.push_back(k);
  (void)add_node(0, static_cast<std::uint32_t>(elements_.size()));
  find_edges();
  find_parts();
}

std::array<Surface::Point, 3> Surface::corners(std::size_t element) const {
  const Triangle& t = elements_.at(element);
  return {points_[t[0]], points_[t[1]], points_[t[2]]};
}

/// Each half of the elements, by their first corners along the longest side, gets a child.
std::uint32_t Surface::add_node(std::uint32_t begin, std::uint32_t end) {
  constexpr std::uint32_t kLeaf = 4;
  const auto here = static_cast<std::uint32_t>(nodes_.size());
  Node node;
  node.begin = begin;
  node.end = end;
  node.lower.fill(std::numeric_limits<double>::infinity());
  node.upper.fill(-std::numeric_limits<double>::infinity());
  for (std::uint32_t k = begin; k < end; ++k) {
    for (const Point& corner : corners(order_[k])) {
      for (std::size_t c = 0; c < 3; ++c) {
        node.lower[c] = std::min(node.lower[c], corner[c]);
        node.upper[c] = std::max(node.upper[c], corner[c]);
      }
    }
  }
  nodes_.push_back(node);
  if (end - begin <= kLeaf) return here;
  std::size_t longest = 0;
  for (std::size_t c = 1; c < 3; ++c) {
    if (node.upper[c] - node.lower[c] > node.upper[longest] - node.lower[longest]) longest = c;
  }
  const auto place = [&](std::uint32_t element) { return std::pair(points_[elements_[element][0]][longest], element); };
  const std::uint32_t middle = begin + (end - begin) / 2;
  std::ranges::nth_element(order_.begin() + begin, order_.begin() + middle, order_.begin() + end, {}, place);
  const std::uint32_t first = add_node(begin, middle);
  const std::uint32_t second = add_node(middle, end);
  nodes_[here].children = {first, second};
  return here;
}

/// Joins triangles over their edges. Two triangles turn the same way if they pass their edge in opposite directions.
void Surface::find_edges() {
  struct Edge {
    std::uint32_t low, high, triangle;
    bool is_rising;
    auto operator<=>(const Edge&) const = default;
  };
  std::vector<Edge> edges;
  for (std::uint32_t t = 0; t < triangles_; ++t) {
    shells_.push_back({t, false});
    for (std::size_t c = 0; c < 3; ++c) {
      const std::uint32_t from = elements_[t][c], to = elements_[t][(c + 1) % 3];
      edges.push_back({std::min(from, to), std::max(from, to), t, from < to});
    }
  }
  // Until all are joined, a shell's index is another triangle of it, or the triangle itself; reversed against that.
  const auto leader = [&](std::uint32_t t) {
    bool is_reversed = false;
    for (; shells_[t].index != t; t = shells_[t].index) {
      Shell& way = shells_[t];
      const Shell next = shells_[way.index];
      way = {next.index, way.is_reversed != next.is_reversed};
      is_reversed = is_reversed != way.is_reversed;
    }
    return Shell{t, is_reversed};
  };
  std::ranges::sort(edges);
  for (std::size_t begin = 0, end = 0; begin < edges.size(); begin = end) {
    const Edge& one = edges[begin];
    while (end < edges.size() && edges[end].low == one.low && edges[end].high == one.high) ++end;
    if (end - begin != 2) {
      is_closed_ = false;
      continue;
    }
    const Edge& other = edges[begin + 1];
    const Shell a = leader(one.triangle), b = leader(other.triangle);
    const bool is_reversed = (a.is_reversed != b.is_reversed) != (one.is_rising == other.is_rising);
    if (a.index != b.index) {
      shells_[b.index] = {a.index, is_reversed};
    } else if (is_reversed) {
      is_closed_ = false;  // a surface with one side
    }
  }
  for (std::uint32_t t = 0; t < triangles_; ++t) shells_[t] = leader(t);
}

void Surface::find_parts() {
  std::vector<std::uint32_t> leader(points_.size());
  for (std::uint32_t k = 0; k < leader.size(); ++k) leader[k] = k;
  const auto find = [&](std::uint32_t k) {
    while (leader[k] != k) k = leader[k] = leader[leader[k]];
    return k;
  };
  for (const Triangle& t : elements_) {
    leader[find(t[1])] = find(t[0]);
    leader[find(t[2])] = find(t[0]);
  }
  std::vector<bool> is_known(points_.size());
  for (const Triangle& t : elements_) {
    const std::uint32_t k = find(t[0]);
    if (!is_known[k]) parts_.push_back(points_[k]);
    is_known[k] = true;
  }
}

}  // namespace taut::checker
