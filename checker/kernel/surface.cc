// SPDX-License-Identifier: GPL-3.0-or-later
#include "checker/kernel/surface.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
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

void Surface::find_edges() {
  std::vector<std::pair<std::uint32_t, std::uint32_t>> edges;
  for (std::size_t t = 0; t < triangles_; ++t) {
    for (std::size_t c = 0; c < 3; ++c) edges.push_back(std::minmax({elements_[t][c], elements_[t][(c + 1) % 3]}));
  }
  std::ranges::sort(edges);
  for (std::size_t k = 0; k < edges.size(); ++k) {
    const bool has_twin = (k > 0 && edges[k] == edges[k - 1]) || (k + 1 < edges.size() && edges[k] == edges[k + 1]);
    const bool is_third = k > 1 && edges[k] == edges[k - 2];
    if (!has_twin || is_third) is_closed_ = false;
  }
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
