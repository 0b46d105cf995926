// SPDX-License-Identifier: GPL-3.0-or-later
// The surface of a mesh: its elements, each the hull of three points, and a tree of boxes around them.
//
// Coordinates are exact binary64 numbers, in the unit of the mesh's file. Everything here is decided by comparing such
// numbers, hence exact.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <vector>

namespace taut::checker {

/// Triangles and, behind them, needles: segments that are no edge of a triangle, or single points.
class Surface {
 public:
  using Point = std::array<double, 3>;
  using Triangle = std::array<std::uint32_t, 3>;
  using Needle = std::array<std::uint32_t, 2>;

  /// A box around the elements order[begin] to order[end - 1]. An inner node has two children, and a leaf's are 0.
  struct Node {
    Point lower;
    Point upper;
    std::uint32_t begin = 0;
    std::uint32_t end = 0;
    std::array<std::uint32_t, 2> children{};
  };

  /// @throws Undefined for numbers that are not finite, for indices that are too large, and for no triangles
  Surface(std::vector<Point> points, std::vector<Triangle> triangles, const std::vector<Needle>& needles);

  [[nodiscard]] std::size_t triangles() const { return triangles_; }
  [[nodiscard]] std::size_t elements() const { return elements_.size(); }
  /// Of a needle, the second and the third are one.
  [[nodiscard]] std::array<Point, 3> corners(std::size_t element) const;
  [[nodiscard]] const std::vector<Node>& nodes() const { return nodes_; }  ///< the first contains all
  [[nodiscard]] std::uint32_t in_order(std::uint32_t k) const { return order_[k]; }

  /// Whether each edge belongs to exactly two triangles, and each shell has two sides.
  [[nodiscard]] bool is_closed() const { return is_closed_; }
  /// Of a triangle: which shell it belongs to, of the parts that hang together by edges, and whether its corners have
  /// to be taken the other way round, so that all triangles of the shell turn the same way. @pre is_closed()
  struct Shell {
    std::uint32_t index = 0;
    bool is_reversed = false;
  };
  [[nodiscard]] Shell shell(std::size_t triangle) const { return shells_.at(triangle); }
  /// Of each part whose elements hang together by their points, one of these.
  [[nodiscard]] const std::vector<Point>& parts() const { return parts_; }

 private:
  std::uint32_t add_node(std::uint32_t begin, std::uint32_t end);
  void find_edges();
  void find_parts();

  std::vector<Point> points_;
  std::vector<Triangle> elements_;
  std::size_t triangles_;
  std::vector<std::uint32_t> order_;
  std::vector<Node> nodes_;
  bool is_closed_ = true;
  std::vector<Shell> shells_;  ///< by triangle
  std::vector<Point> parts_;
};

}  // namespace taut::checker
