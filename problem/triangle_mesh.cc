// SPDX-License-Identifier: GPL-3.0-or-later
#include "problem/triangle_mesh.h"

#include <algorithm>
#include <limits>
#include <numeric>
#include <stdexcept>
#include <utility>

namespace taut {

IndexedMesh::IndexedMesh(TriangleMesh mesh) : mesh_(std::move(mesh)) {
  if (mesh_.triangles.empty()) throw std::logic_error("a mesh without triangles");
  build_tree();
  find_shells();
  find_components();
}

std::array<std::array<double, 3>, 3> IndexedMesh::points(std::size_t element) const {
  const auto at = [&](std::uint32_t vertex) { return mesh_.vertices.at(vertex); };
  if (element < mesh_.triangles.size()) {
    const auto& [a, b, c] = mesh_.triangles[element];
    return {at(a), at(b), at(c)};
  }
  const auto& [a, b] = mesh_.needles.at(element - mesh_.triangles.size());
  return {at(a), at(b), at(b)};
}

/// Halves at the middle element along the longest side of the elements' middles.
void IndexedMesh::build_tree() {
  const std::size_t count = elements();
  std::vector<MeshBox> boxes(count);
  for (std::size_t e = 0; e < count; ++e) {
    const auto corners = points(e);
    for (std::size_t k = 0; k < 3; ++k) {
      const auto [low, high] = std::minmax({corners[0][k], corners[1][k], corners[2][k]});
      boxes[e].lower[k] = low;
      boxes[e].upper[k] = high;
    }
  }
  order_.resize(count);
  std::iota(order_.begin(), order_.end(), 0U);
  nodes_.reserve(count);
  constexpr double kInfinity = std::numeric_limits<double>::infinity();
  struct Open {
    std::uint32_t begin, end, parent;
  };
  constexpr std::uint32_t kNone = UINT32_MAX;  // of a left child and the root
  std::vector<Open> open = {{0, static_cast<std::uint32_t>(count), kNone}};
  while (!open.empty()) {
    const auto [begin, end, parent] = open.back();
    open.pop_back();
    if (parent != kNone) nodes_[parent].right = static_cast<std::uint32_t>(nodes_.size());
    const auto here = static_cast<std::uint32_t>(nodes_.size());
    Node& node = nodes_.emplace_back();
    node.begin = begin;
    node.end = end;
    node.box.lower.fill(kInfinity);
    node.box.upper.fill(-kInfinity);
    std::array<double, 3> least = node.box.lower, most = node.box.upper;  // of twice the middles
    for (std::uint32_t i = begin; i < end; ++i) {
      const MeshBox& box = boxes[order_[i]];
      for (std::size_t k = 0; k < 3; ++k) {
        node.box.lower[k] = std::min(node.box.lower[k], box.lower[k]);
        node.box.upper[k] = std::max(node.box.upper[k], box.upper[k]);
        least[k] = std::min(least[k], box.lower[k] + box.upper[k]);
        most[k] = std::max(most[k], box.lower[k] + box.upper[k]);
      }
    }
    if (end - begin <= kMostInLeaf) continue;
    std::size_t axis = 0;
    for (std::size_t k = 1; k < 3; ++k) {
      if (most[k] - least[k] > most[axis] - least[axis]) axis = k;
    }
    const std::uint32_t middle = begin + (end - begin) / 2;
    const auto is_before = [&, axis](std::uint32_t a, std::uint32_t b) {
      const auto place = [&](std::uint32_t e) { return boxes[e].lower[axis] + boxes[e].upper[axis]; };
      return std::pair(place(a), a) < std::pair(place(b), b);
    };
    std::nth_element(order_.begin() + begin, order_.begin() + middle, order_.begin() + end, is_before);
    open.push_back({middle, end, here});
    open.push_back({begin, middle, kNone});  // next
  }
}

/// Walks from triangle to triangle over edges that two have. Neighbours that pass their edge in one direction turn in
/// different ways.
void IndexedMesh::find_shells() {
  struct Side {
    std::array<std::uint32_t, 2> ends;  // rising
    std::uint32_t triangle;
    bool is_rising;
  };
  const std::size_t count = mesh_.triangles.size();
  std::vector<Side> sides;
  sides.reserve(3 * count);
  for (std::uint32_t t = 0; t < count; ++t) {
    for (std::size_t k = 0; k < 3; ++k) {
      const std::uint32_t from = mesh_.triangles[t][k], to = mesh_.triangles[t][(k + 1) % 3];
      sides.push_back({{std::min(from, to), std::max(from, to)}, t, from < to});
    }
  }
  std::ranges::sort(sides, {}, [](const Side& side) { return std::pair(side.ends, side.triangle); });
  struct Neighbour {
    std::uint32_t triangle;
    bool turns_alike;
  };
  std::vector<std::vector<Neighbour>> neighbours(count);
  is_watertight_ = true;
  for (std::size_t begin = 0, end = 0; begin < sides.size(); begin = end) {
    while (end < sides.size() && sides[end].ends == sides[begin].ends) ++end;
    is_watertight_ = is_watertight_ && end - begin == 2;
    for (std::size_t k = begin + 1; k < end; ++k) {
      const Side &a = sides[k - 1], &b = sides[k];
      const bool turns_alike = a.is_rising != b.is_rising;
      neighbours[a.triangle].push_back({b.triangle, turns_alike});
      neighbours[b.triangle].push_back({a.triangle, turns_alike});
    }
  }
  shell_of_.assign(count, 0);
  turn_of_.assign(count, 0);
  std::vector<std::uint32_t> open;
  for (std::uint32_t first = 0; first < count; ++first) {
    if (turn_of_[first] != 0) continue;
    turn_of_[first] = 1;
    open.push_back(first);
    while (!open.empty()) {
      const std::uint32_t t = open.back();
      open.pop_back();
      shell_of_[t] = static_cast<std::uint32_t>(shells_);
      for (const auto& [next, turns_alike] : neighbours[t]) {
        const auto turn = static_cast<std::int8_t>(turns_alike ? turn_of_[t] : -turn_of_[t]);
        if (turn_of_[next] == 0) {
          turn_of_[next] = turn;
          open.push_back(next);
        } else if (turn_of_[next] != turn) {
          is_watertight_ = false;
        }
      }
    }
    ++shells_;
  }
}

void IndexedMesh::find_components() {
  std::vector<std::uint32_t> parent(mesh_.vertices.size());
  std::iota(parent.begin(), parent.end(), 0U);
  const auto root = [&](std::uint32_t i) {
    while (parent[i] != i) i = parent[i] = parent[parent[i]];
    return i;
  };
  for (const auto& [a, b, c] : mesh_.triangles) {
    parent[root(b)] = root(a);
    parent[root(c)] = root(a);
  }
  for (const auto& [a, b] : mesh_.needles) parent[root(b)] = root(a);
  for (std::uint32_t i = 0; i < parent.size(); ++i) {
    if (root(i) == i) components_.push_back(i);
  }
}

}  // namespace taut
