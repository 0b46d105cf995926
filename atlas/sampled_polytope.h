// SPDX-License-Identifier: GPL-3.0-or-later
// The part of a chart's tangent space that belongs to the chart, known along a few rays only.
//
// In more than three dimensions the polytope of a chart (polytope.h) has too many vertices to keep: a cell of a Poisson
// Voronoi diagram has 27 on average for n = 3, but 159, about 1,100 and about 8,700 for n = 4, 5, 6. Therefore this
// class keeps no vertices. It knows how far the polytope reaches along 2 n^2 fixed directions, and which facet ends
// each of them:
//
//   d = ± e_i  and  d = (± e_i ± e_j) / √2, i < j;     reach(d) = min over cuts with d . normal > 0 of offset / d .
//   normal.  (1)
//
// Every direction is within 54.8° of one of them (n <= 6). The reach along rays is exact up to rounding. Nothing is
// known between rays: facets that no ray meets and corners between rays are missed. Therefore charts that are placed by
// it cover densely, but not provably everywhere.
#pragma once

#include <bitset>
#include <cstddef>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "atlas/manifold.h"

namespace taut {

class SampledPolytope {
 public:
  /// The ball of radius `reach`, without facets. @pre 1 <= dimension <= kMaxDimension, reach > 0.
  SampledPolytope(int dimension, double reach);

  /// Intersects with the half-space normal . u <= offset; the new facet is named `facet`.
  /// @returns whether any ray became shorter.
  /// @pre offset > 0, so that the origin stays inside; facet >= 0.
  /// Cost: one dot product for each ray.
  bool clip(const TangentVector& normal, double offset, int facet);

  [[nodiscard]] int dimension() const { return dimension_; }
  /// Reach of the longest ray.
  [[nodiscard]] double circumradius() const { return circumradius_; }

  /// Number of rays; their ends are the known corners.
  [[nodiscard]] int corners() const { return static_cast<int>(rays_.size()); }
  [[nodiscard]] TangentVector corner(int ray) const;
  [[nodiscard]] double distance(int ray) const { return rays_[ray].reach; }
  /// For the owner's use. A ray keeps its mark when it becomes shorter.
  [[nodiscard]] bool is_marked(int ray) const { return marked_[static_cast<std::size_t>(ray)]; }
  void mark(int ray) { marked_.set(static_cast<std::size_t>(ray)); }

  /// Names of the facets that end rays, ascending.
  [[nodiscard]] std::vector<int> cutting_facets() const;
  [[nodiscard]] bool has_facet(int facet) const;

  /// Appends the polytope as stored in atlas files (docs/atlas-file.md).
  void append_bytes(std::string& bytes) const;
  /// The polytope that append_bytes wrote, bit for bit. nullopt unless the bytes are such a polytope with cutting
  /// facets below `facet_end`.
  [[nodiscard]] static std::optional<SampledPolytope> from_bytes(int dimension, std::span<const std::byte> bytes,
                                                                 int facet_end);

 private:
  static constexpr int kMaxRays = 2 * kMaxDimension * kMaxDimension;
  struct Ray {
    float reach;  ///< single precision suffices to choose where to grow, and saves memory
    int facet;    ///< kNone at first
  };
  static constexpr int kNone = -1;

  int dimension_;
  double circumradius_;
  std::bitset<kMaxRays> marked_;
  std::vector<Ray> rays_;
};

}  // namespace taut
