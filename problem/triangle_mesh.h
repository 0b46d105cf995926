// SPDX-License-Identifier: GPL-3.0-or-later
// The triangles of a mesh, and a tree of boxes around them.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <vector>

namespace taut {

/// A mesh with each point once. Triangles differ, and each has three different corners.
struct TriangleMesh {
  std::vector<std::array<double, 3>> vertices;          ///< finite, in the file's unit; all are used
  std::vector<std::array<std::uint32_t, 3>> triangles;  ///< at least one
  std::vector<std::array<std::uint32_t, 2>> needles;    ///< segments that no triangle has as an edge
};

/// All points x with lower <= x <= upper, in the file's unit.
struct MeshBox {
  std::array<double, 3> lower{};
  std::array<double, 3> upper{};
};

/// A mesh that can be searched. Its elements are its triangles and, behind them, its needles.
class IndexedMesh {
 public:
  static constexpr std::size_t kMostInLeaf = 4;

  /// The elements order()[begin] to order()[end − 1], all of them inside of the box. Its children are the next node and
  /// the node `right`.
  struct Node {
    MeshBox box;
    std::uint32_t begin = 0;
    std::uint32_t end = 0;
    std::uint32_t right = 0;  ///< 0: a leaf, of at most kMostInLeaf elements
  };

  explicit IndexedMesh(TriangleMesh mesh);

  [[nodiscard]] const TriangleMesh& mesh() const { return mesh_; }
  [[nodiscard]] std::size_t elements() const { return mesh_.triangles.size() + mesh_.needles.size(); }
  /// Three points whose hull the element is; of a needle, the last two are one.
  [[nodiscard]] std::array<std::array<double, 3>, 3> points(std::size_t element) const;
  /// The first is the root.
  [[nodiscard]] const std::vector<Node>& nodes() const { return nodes_; }
  [[nodiscard]] const std::vector<std::uint32_t>& order() const { return order_; }
  /// Whether the mesh has an inside: each edge has two triangles, and each shell two sides.
  [[nodiscard]] bool is_watertight() const { return is_watertight_; }
  /// The parts that hang together by edges.
  [[nodiscard]] std::size_t shells() const { return shells_; }
  /// The shell of a triangle, from 0.
  [[nodiscard]] std::uint32_t shell(std::size_t triangle) const { return shell_of_[triangle]; }
  /// 1 or -1: the triangles of a shell with one number turn the other way round than those with the other. @pre
  /// is_watertight()
  [[nodiscard]] int turn(std::size_t triangle) const { return turn_of_[triangle]; }
  /// Of each part that hangs together by vertices, one of these.
  [[nodiscard]] const std::vector<std::uint32_t>& components() const { return components_; }

 private:
  void build_tree();
  void find_shells();
  void find_components();

  TriangleMesh mesh_;
  std::vector<Node> nodes_;
  std::vector<std::uint32_t> order_;
  bool is_watertight_ = false;
  std::size_t shells_ = 0;
  std::vector<std::uint32_t> shell_of_;  ///< by triangle
  std::vector<std::int8_t> turn_of_;     ///< by triangle
  std::vector<std::uint32_t> components_;
};

}  // namespace taut
