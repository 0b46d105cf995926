// SPDX-License-Identifier: GPL-3.0-or-later
// How deep hulls are in each other, in double and in 200 bits, by all faces of their difference.
#pragma once

#include <array>
#include <optional>
#include <utility>
#include <vector>

#include "tests/soundness/vectors.h"

namespace taut::campaign {

/// How deep two hulls are in each other, along the normals of the faces of their difference: those of either's faces,
/// and those of two edges.
template <class S>
struct Depth {
  S size{};
  Vec<S> out{};  ///< moves the first out of the second, of any length
};
template <class S>
Depth<S> depth_of(const std::vector<Vec<S>>& a, const std::vector<Vec<S>>& b) {
  std::optional<Depth<S>> least;
  const auto consider = [&](const Vec<S>& u) {
    const S square = dot(u, u);
    if (!(square > S(0.0))) return;
    std::array<S, 2> of_a{dot(u, a[0]), dot(u, a[0])}, of_b{dot(u, b[0]), dot(u, b[0])};
    const auto widen = [&](std::array<S, 2>& range, const std::vector<Vec<S>>& points) {
      for (const Vec<S>& x : points) {
        const S here = dot(u, x);
        if (here < range[0]) range[0] = here;
        if (here > range[1]) range[1] = here;
      }
    };
    widen(of_a, a);
    widen(of_b, b);
    const S size = root(square);
    const S out = (of_b[1] - of_a[0]) / size, back = (of_a[1] - of_b[0]) / size;
    if (!least || out < least->size) least = Depth<S>{out, u};
    if (back < least->size) least = Depth<S>{back, S(-1.0) * u};
  };
  std::array<std::vector<Vec<S>>, 2> edges;
  for (const auto& [points, list] : {std::pair(&a, &edges[0]), std::pair(&b, &edges[1])}) {
    for (std::size_t i = 0; i < points->size(); ++i) {
      for (std::size_t j = i + 1; j < points->size(); ++j) {
        list->push_back((*points)[j] - (*points)[i]);
        for (std::size_t k = j + 1; k < points->size(); ++k) {
          consider(cross((*points)[j] - (*points)[i], (*points)[k] - (*points)[i]));
        }
      }
    }
  }
  for (const Vec<S>& e : edges[0]) {
    for (const Vec<S>& f : edges[1]) consider(cross(e, f));
  }
  return least ? *least : Depth<S>{S(0.0), {S(0.0), S(0.0), S(1.0)}};
}

}  // namespace taut::campaign
