// SPDX-License-Identifier: GPL-3.0-or-later
// The part of a chart's tangent space that belongs to the chart: a cube around the centre, clipped by neighbours.
//
// It is a bounded polytope in R^n with the origin inside, kept simple: each vertex lies on exactly n facets and has n
// edges, one leaving each of its facets. A cut through (or within rounding of) a vertex does not remove that vertex, so
// that degenerate polytopes stay simple and the result depends on the order of cuts alone.
// Polytopes have up to three dimensions; in more there are too many vertices, see sampled_polytope.h.
// Source: Henderson 2002, section 4 (simple polytopes of charts); Chen, Hansen, Jaumard 1991 (on-line vertices).
#pragma once

#include <array>
#include <cmath>
#include <cstddef>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "atlas/manifold.h"

namespace taut {

class Polytope {
 public:
  static constexpr int kMaxDimension = 3;

  struct Vertex {
    std::array<double, kMaxDimension> position{};
    double squared_norm = 0;
    /// The n facets it lies on, by name.
    std::array<int, kMaxDimension> facets{};
    /// neighbours[k]: index of the vertex at the other end of the edge that leaves facets[k].
    std::array<int, kMaxDimension> neighbours{};
    /// For the owner's use; new vertices are unmarked.
    bool marked = false;
  };

  /// The cube [-half_side, half_side]^n; its facets are named -1 (u_0 = -half_side), -2 (u_0 = half_side), -3, … -2n.
  /// @pre 1 <= dimension <= Polytope::kMaxDimension, half_side > 0.
  Polytope(int dimension, double half_side);

  /// Intersects with the half-space normal . u <= offset; the new facet is named `facet`.
  /// @returns whether anything was cut off.
  /// @pre offset > 0, so that the origin stays inside; facet >= 0 and new.
  /// Cost: constant if the half-space contains the ball of radius circumradius(); else one dot product for each vertex,
  /// plus the vertices that change.
  bool clip(const TangentVector& normal, double offset, int facet);

  [[nodiscard]] int dimension() const { return dimension_; }
  /// Largest distance of a vertex from the origin.
  [[nodiscard]] double circumradius() const { return circumradius_; }
  [[nodiscard]] const std::vector<Vertex>& vertices() const { return vertices_; }

  /// The vertices under the interface that SampledPolytope has, too.
  [[nodiscard]] int corners() const { return static_cast<int>(vertices_.size()); }
  [[nodiscard]] TangentVector corner(int vertex) const;
  [[nodiscard]] double distance(int vertex) const { return std::sqrt(vertices_[vertex].squared_norm); }
  [[nodiscard]] bool is_marked(int vertex) const { return vertices_[vertex].marked; }
  void mark(int vertex) { vertices_[vertex].marked = true; }

  /// Names of the facets made by clip() that are left, ascending.
  [[nodiscard]] std::vector<int> cutting_facets() const;
  [[nodiscard]] bool has_facet(int facet) const;

  /// Appends the polytope as stored in atlas files (docs/atlas-file.md).
  void append_bytes(std::string& bytes) const;
  /// The polytope that append_bytes wrote, bit for bit. Any bytes are safe: nullopt unless they are a simple polytope
  /// inside its cube with cutting facets below `facet_end`. Whether its facets are flat, or the origin is inside, is
  /// not checked, since clip() does not rely on it.
  [[nodiscard]] static std::optional<Polytope> from_bytes(int dimension, std::span<const std::byte> bytes,
                                                          int facet_end);

 private:
  void measure();
  [[nodiscard]] bool is_simple(int facet_end) const;

  int dimension_;
  double half_side_;
  double circumradius_;
  std::vector<Vertex> vertices_;
};

}  // namespace taut
