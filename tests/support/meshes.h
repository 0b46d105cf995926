// SPDX-License-Identifier: GPL-3.0-or-later
// Meshes for tests, without files.
#pragma once

#include <cmath>
#include <cstdint>
#include <map>
#include <memory>
#include <string>
#include <utility>

#include "problem/bodies.h"

namespace taut::testing {

/// A box with these half sides: 12 triangles.
inline TriangleMesh box_mesh(const std::array<double, 3>& half) {
  TriangleMesh mesh;
  for (unsigned k = 0; k < 8; ++k) {
    mesh.vertices.push_back(
        {(k & 1U) != 0 ? half[0] : -half[0], (k & 2U) != 0 ? half[1] : -half[1], (k & 4U) != 0 ? half[2] : -half[2]});
  }
  for (const auto& [fixed, u, v] : {std::array{1U, 2U, 4U}, std::array{2U, 1U, 4U}, std::array{4U, 1U, 2U}}) {
    for (const unsigned side : {0U, fixed}) {
      mesh.triangles.push_back({side, side | u, side | u | v});
      mesh.triangles.push_back({side, side | v, side | u | v});
    }
  }
  return mesh;
}

/// A sphere around 0: an octahedron whose faces are cut into 4^depth each, its points at `radius`. 8·4^depth triangles.
inline TriangleMesh sphere_mesh(double radius, int depth) {
  using Point = std::array<double, 3>;
  TriangleMesh mesh;
  mesh.vertices = {{1, 0, 0}, {-1, 0, 0}, {0, 1, 0}, {0, -1, 0}, {0, 0, 1}, {0, 0, -1}};
  for (const std::uint32_t x : {0U, 1U}) {
    for (const std::uint32_t y : {2U, 3U}) {
      for (const std::uint32_t z : {4U, 5U}) mesh.triangles.push_back({x, y, z});
    }
  }
  for (int level = 0; level < depth; ++level) {
    std::map<std::pair<std::uint32_t, std::uint32_t>, std::uint32_t> middles;
    const auto middle = [&](std::uint32_t a, std::uint32_t b) {
      const auto [at, is_new] =
          middles.try_emplace(std::minmax(a, b), static_cast<std::uint32_t>(mesh.vertices.size()));
      if (is_new) {
        Point m;
        for (std::size_t k = 0; k < 3; ++k) m[k] = mesh.vertices[a][k] + mesh.vertices[b][k];
        const double size = std::hypot(m[0], m[1], m[2]);
        for (double& x : m) x /= size;
        mesh.vertices.push_back(m);
      }
      return at->second;
    };
    std::vector<std::array<std::uint32_t, 3>> finer;
    for (const auto& [a, b, c] : mesh.triangles) {
      const std::uint32_t ab = middle(a, b), bc = middle(b, c), ca = middle(c, a);
      finer.insert(finer.end(), {{a, ab, ca}, {b, bc, ab}, {c, ca, bc}, {ab, bc, ca}});
    }
    mesh.triangles = std::move(finer);
  }
  for (Point& point : mesh.vertices) {
    for (double& x : point) x *= radius;
  }
  return mesh;
}

/// Both in one mesh, the second moved by `by`.
inline TriangleMesh joined_meshes(TriangleMesh first, const TriangleMesh& second, const std::array<double, 3>& by) {
  const auto offset = static_cast<std::uint32_t>(first.vertices.size());
  for (const auto& [x, y, z] : second.vertices) first.vertices.push_back({x + by[0], y + by[1], z + by[2]});
  for (const auto& [a, b, c] : second.triangles) first.triangles.push_back({a + offset, b + offset, c + offset});
  return first;
}

/// One closed part that winds twice about the z axis: a wheel of height 2 around 0 with rims of radius 1 to 2.
inline TriangleMesh twice_wound_mesh() {
  constexpr std::uint32_t kCount = 14;
  constexpr double kTwoTurns = 12.566370614359172;
  TriangleMesh mesh;
  for (const double z : {-1.0, 1.0}) {
    for (std::uint32_t k = 0; k < kCount; ++k) {
      const double angle = kTwoTurns * k / kCount, radius = k < kCount / 2 ? 2 : 1;
      mesh.vertices.push_back({radius * std::cos(angle), radius * std::sin(angle), z});
    }
  }
  mesh.vertices.push_back({0, 0, -1});
  mesh.vertices.push_back({0, 0, 1});
  for (std::uint32_t k = 0; k < kCount; ++k) {
    const std::uint32_t next = (k + 1) % kCount;
    mesh.triangles.push_back({2 * kCount, next, k});
    mesh.triangles.push_back({2 * kCount + 1, kCount + k, kCount + next});
    mesh.triangles.push_back({k, next, kCount + k});
    mesh.triangles.push_back({next, kCount + next, kCount + k});
  }
  return mesh;
}

/// A closed surface with one side: the projective plane, of six points.
inline TriangleMesh one_sided_mesh() {
  return {
      {{1, 0, 0}, {-1, 0.1, 0}, {0, 1, 0.2}, {0.3, -1, 0}, {0, 0.2, 1}, {0.1, 0, -1}},
      {{0, 1, 2}, {0, 1, 3}, {0, 2, 4}, {0, 3, 5}, {0, 4, 5}, {1, 2, 5}, {1, 3, 4}, {1, 4, 5}, {2, 3, 4}, {2, 3, 5}},
      {}};
}

/// As if it had been read from a file with this digest.
inline MeshText mesh_text(TriangleMesh mesh, char digest, DecimalText unit_m = "1") {
  return {"mesh.stl", std::string(64, digest), std::move(unit_m), std::make_shared<const IndexedMesh>(std::move(mesh))};
}

}  // namespace taut::testing
