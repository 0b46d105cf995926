// SPDX-License-Identifier: GPL-3.0-or-later
// On which side of a closed mesh a point is.
//
// Inside of a watertight mesh are the points from which a ray in general position crosses the triangles of some shell
// more often from one side than from the other (docs/theory.md, "Meshes"). Signs of determinants of intervals decide of
// each triangle whether the ray crosses it. Where one of them is not known, another ray is taken.
#pragma once

#include <algorithm>
#include <array>
#include <cstddef>
#include <optional>
#include <vector>

#include "certify/arithmetic/slope_form.h"
#include "problem/triangle_mesh.h"

namespace taut {

enum class MeshSide { kOutside, kInside, kUnknown };

namespace mesh_side_detail {

/// Whether all numbers of an interval are negative.
template <class I>
bool certainly_negative(const I& x) {
  return certainly_positive(I(-x));
}

template <class I>
class RayCount {
 public:
  using Point = std::array<I, 3>;
  RayCount(const IndexedMesh& mesh, const Point& origin, const std::array<int, 3>& ray)
      : mesh_(mesh), origin_(origin), ray_(ray) {
    for (std::size_t k = 0; k < 3; ++k) along_[k] = I(static_cast<double>(ray[k]));
  }

  [[nodiscard]] MeshSide side() const {
    std::vector<int> winding(mesh_.shells());
    std::vector<std::uint32_t> open = {0};
    while (!open.empty()) {
      const std::uint32_t index = open.back();
      open.pop_back();
      const IndexedMesh::Node& node = mesh_.nodes()[index];
      if (misses(node.box)) continue;
      if (node.right != 0) {
        open.push_back(node.right);
        open.push_back(index + 1);
        continue;
      }
      for (std::uint32_t i = node.begin; i < node.end; ++i) {
        const std::uint32_t element = mesh_.order()[i];
        if (element >= mesh_.mesh().triangles.size()) continue;  // a needle has no inside
        const std::optional<int> crosses = this->crosses(element);
        if (!crosses) return MeshSide::kUnknown;
        winding[mesh_.shell(element)] += *crosses * mesh_.turn(element);
      }
    }
    const bool is_outside = std::ranges::all_of(winding, [](int number) { return number == 0; });
    return is_outside ? MeshSide::kOutside : MeshSide::kInside;
  }

 private:
  /// Whether the ray certainly has no point in a box.
  [[nodiscard]] bool misses(const MeshBox& box) const {
    Point from;  // the origin to the box
    for (std::size_t k = 0; k < 3; ++k) {
      from[k] = I(box.lower[k], box.upper[k]) - origin_[k];
      if (ray_[k] >= 0 && certainly_negative(from[k])) return true;
      if (ray_[k] <= 0 && certainly_positive(from[k])) return true;
    }
    for (std::size_t k = 0; k < 3; ++k) {
      const std::size_t l = (k + 1) % 3;
      const I beside = along_[k] * from[l] - along_[l] * from[k];
      if (certainly_positive(beside) || certainly_negative(beside)) return true;
    }
    return false;
  }

  static I determinant(const Point& a, const Point& b, const Point& c) {
    return a[0] * (b[1] * c[2] - b[2] * c[1]) + a[1] * (b[2] * c[0] - b[0] * c[2]) + a[2] * (b[0] * c[1] - b[1] * c[0]);
  }

  /// With the corners seen from the origin, det(r, a, b), det(r, b, c) and det(r, c, a) have one sign where the line of
  /// the ray crosses the triangle inside; then their sum times the distance along r is det(a, b, c). Returns that sign,
  /// which tells from which side the ray comes, or 0 where there is no crossing.
  [[nodiscard]] std::optional<int> crosses(std::uint32_t triangle) const {
    std::array<Point, 3> corner;
    const auto points = mesh_.points(triangle);
    for (std::size_t n = 0; n < 3; ++n) {
      for (std::size_t k = 0; k < 3; ++k) corner[n][k] = I(points[n][k]) - origin_[k];
    }
    int positive = 0, negative = 0;
    for (std::size_t n = 0; n < 3; ++n) {
      const I side = determinant(along_, corner[n], corner[(n + 1) % 3]);
      positive += certainly_positive(side) ? 1 : 0;
      negative += certainly_negative(side) ? 1 : 0;
    }
    if (positive > 0 && negative > 0) return 0;
    const I ahead = determinant(corner[0], corner[1], corner[2]);
    const bool is_positive = certainly_positive(ahead), is_negative = certainly_negative(ahead);
    if (positive == 3 && (is_positive || is_negative)) return is_positive ? 1 : 0;
    if (negative == 3 && (is_positive || is_negative)) return is_negative ? -1 : 0;
    return std::nullopt;
  }

  const IndexedMesh& mesh_;
  const Point& origin_;
  const std::array<int, 3>& ray_;
  Point along_;
};

}  // namespace mesh_side_detail

/// Of every point in `point`, in the mesh's unit. Void if a fault was raised. @pre mesh.is_watertight()
template <class I>
[[nodiscard]] MeshSide mesh_side(const IndexedMesh& mesh, const std::array<I, 3>& point) {
  const MeshBox& all = mesh.nodes().front().box;
  for (std::size_t k = 0; k < 3; ++k) {
    if (certainly_positive(I(point[k] - I(all.upper[k]))) || certainly_positive(I(I(all.lower[k]) - point[k]))) {
      return MeshSide::kOutside;
    }
  }
  constexpr std::array<std::array<int, 3>, 4> kRays = {
      {{61, 97, 1009}, {1013, -89, 71}, {-83, 1019, -67}, {73, 59, -997}}};
  for (const auto& ray : kRays) {
    const MeshSide side = mesh_side_detail::RayCount<I>(mesh, point, ray).side();
    if (side != MeshSide::kUnknown) return side;
  }
  return MeshSide::kUnknown;
}

}  // namespace taut
