// SPDX-License-Identifier: GPL-3.0-or-later
// The least gap between two bodies of which one is a mesh or both, when each pair of their elements may be told apart
// along another one of some directions.
//
// Two bodies are apart by g if for each pair of an element of the one and an element of the other there is a direction
// along which these are apart by g. A box around elements stands for all of them; where no direction tells two boxes
// apart by enough, one of them is opened. The number that is returned is not larger than the least over all pairs of
// elements of the largest of `gap` over the directions, whatever `gap` is, if it is monotone: not larger for a part
// than for what is inside of it.
#pragma once

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <span>
#include <utility>
#include <vector>

#include "problem/triangle_mesh.h"

namespace taut {

/// A part of a body: a convex body whole (no mesh), a node of a mesh's tree, or an element of a mesh.
struct MeshPart {
  const IndexedMesh* mesh = nullptr;
  std::uint32_t index = 0;
  bool is_element = false;

  [[nodiscard]] bool may_open() const { return mesh != nullptr && !is_element; }
};

/// Boxes that together contain the corners of a part: one of a node, three of an element; none of a convex body.
class PartBoxes {
 public:
  explicit PartBoxes(const MeshPart& part) {
    if (part.mesh == nullptr) return;
    if (!part.is_element) {
      boxes_[count_++] = part.mesh->nodes()[part.index].box;
      return;
    }
    for (const auto& point : part.mesh->points(part.index)) boxes_[count_++] = {point, point};
  }
  [[nodiscard]] std::span<const MeshBox> all() const { return {boxes_.data(), count_}; }

 private:
  std::array<MeshBox, 3> boxes_;
  std::size_t count_ = 0;
};

/// The children of a node, or the elements of a leaf. @pre part.may_open()
inline std::vector<MeshPart> parts_of(const MeshPart& part) {
  const IndexedMesh::Node& node = part.mesh->nodes()[part.index];
  if (node.right != 0) return {{part.mesh, part.index + 1, false}, {part.mesh, node.right, false}};
  std::vector<MeshPart> elements;
  for (std::uint32_t i = node.begin; i < node.end; ++i) elements.push_back({part.mesh, part.mesh->order()[i], true});
  return elements;
}

/// The sum of the sides of a node's box.
inline double size_of(const MeshPart& part) {
  const MeshBox& box = part.mesh->nodes()[part.index].box;
  double sum = 0;
  for (std::size_t k = 0; k < 3; ++k) sum += box.upper[k] - box.lower[k];
  return sum;
}

/// Which of two parts is opened next: the larger one that may be. @param scale  of the second's size to the first's
inline bool opens_first(const MeshPart& first, const MeshPart& second, double scale) {
  if (!first.may_open() || !second.may_open()) return first.may_open();
  return size_of(first) >= scale * size_of(second);
}

struct CoverOptions {
  /// Parts that are apart by as much are not looked into.
  double enough = std::numeric_limits<double>::infinity();
  double share = 1;                                         ///< so much of the least gap is found at least, if positive
  double floor = -std::numeric_limits<double>::infinity();  ///< the search ends with the first gap that is not larger
  double scale = 1;                                         ///< of opens_first()
  std::size_t most = 4'000'000;                             ///< gaps that are evaluated
};

struct LeastGap {
  double gap = std::numeric_limits<double>::infinity();  ///< minus infinity: the search was too long
  MeshPart first, second;  ///< elements, or convex bodies, that have it; not set where `enough` was found
};

/// @param gap  of direction k between two parts: gap(k, first, second)
template <class Gap>
[[nodiscard]] LeastGap least_gap(const MeshPart& first, const MeshPart& second, std::size_t directions, const Gap& gap,
                                 const CoverOptions& options = {}) {
  constexpr double kInfinity = std::numeric_limits<double>::infinity();
  struct Task {
    MeshPart first, second;
    double gap;
  };
  LeastGap least;             // of what was looked into
  double result = kInfinity;  // of all
  std::size_t evaluated = 0, likely = 0;
  const auto evaluate = [&](const MeshPart& a, const MeshPart& b) {
    const double needed = std::min(least.gap, options.enough);
    double best = -kInfinity;
    for (std::size_t n = 0; n < directions && best < needed; ++n) {
      const std::size_t k = n == 0 ? likely : n <= likely ? n - 1 : n;  // `likely` first
      const double here = gap(k, PartBoxes(a).all(), PartBoxes(b).all());
      ++evaluated;
      if (!(here > best)) continue;
      best = here;
      if (best >= needed) likely = k;
    }
    return best;
  };
  std::vector<Task> open_tasks = {{first, second, evaluate(first, second)}};
  while (!open_tasks.empty()) {
    const Task task = open_tasks.back();
    open_tasks.pop_back();
    const double known = std::min(least.gap, options.enough);
    if (task.gap >= known || (least.gap > 0 && task.gap >= options.share * least.gap)) {
      result = std::min(result, task.gap);
      continue;
    }
    if (evaluated > options.most) return {-kInfinity, {}, {}};
    const bool opens = opens_first(task.first, task.second, options.scale);
    if (!opens && !task.second.may_open()) {
      least = {task.gap, task.first, task.second};
      result = std::min(result, task.gap);
      if (task.gap <= options.floor) break;
      continue;
    }
    const std::size_t begin = open_tasks.size();
    for (const MeshPart& part : parts_of(opens ? task.first : task.second)) {
      const MeshPart& a = opens ? part : task.first;
      const MeshPart& b = opens ? task.second : part;
      open_tasks.push_back({a, b, evaluate(a, b)});
    }
    // That with the least gap is looked into next.
    for (std::size_t k = begin; k + 1 < open_tasks.size(); ++k) {
      if (open_tasks[k].gap < open_tasks.back().gap) std::swap(open_tasks[k], open_tasks.back());
    }
  }
  least.gap = result;
  return least;
}

}  // namespace taut
