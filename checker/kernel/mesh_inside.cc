// SPDX-License-Identifier: GPL-3.0-or-later
#include "checker/kernel/mesh_inside.h"

#include <algorithm>
#include <map>
#include <optional>

namespace taut::checker {
namespace {

Ball determinant(const Vector3<Ball>& a, const Vector3<Ball>& b, const Vector3<Ball>& c) { return dot(a, cross(b, c)); }

Vector3<Ball> from(const Vector3<Ball>& point, const Surface::Point& to) {
  return {Ball(to[0]) - point[0], Ball(to[1]) - point[1], Ball(to[2]) - point[2]};
}

/// Whether no point of the ray from 0 along r is between `lower` and `upper`.
bool misses(const Vector3<Ball>& lower, const Vector3<Ball>& upper, const std::array<int, 3>& r) {
  for (std::size_t c = 0; c < 3; ++c) {
    if (r[c] >= 0 && certainly_negative(upper[c])) return true;
    if (r[c] <= 0 && certainly_positive(lower[c])) return true;
  }
  // On the line along r, r_c x_d - r_d x_c is 0.
  for (std::size_t c = 0; c < 3; ++c) {
    const std::size_t d = (c + 1) % 3;
    const Ball beside = Ball(r[c]) * hull(lower[d], upper[d]) - Ball(r[d]) * hull(lower[c], upper[c]);
    if (certainly_positive(beside) || certainly_negative(beside)) return true;
  }
  return false;
}

/// 1 or -1 where the ray crosses the triangle, by the side from which it does; 0 where it certainly does not.
std::optional<int> crossing(const Vector3<Ball>& a, const Vector3<Ball>& b, const Vector3<Ball>& c,
                            const Vector3<Ball>& r) {
  const std::array<Ball, 3> sides = {determinant(r, a, b), determinant(r, b, c), determinant(r, c, a)};
  bool is_positive = true, is_negative = true, has_positive = false, has_negative = false;
  for (const Ball& side : sides) {
    has_positive = has_positive || certainly_positive(side);
    has_negative = has_negative || certainly_negative(side);
    is_positive = is_positive && certainly_positive(side);
    is_negative = is_negative && certainly_negative(side);
  }
  if (has_positive && has_negative) return 0;
  if (!is_positive && !is_negative) return std::nullopt;
  const Ball ahead = is_positive ? determinant(a, b, c) : -determinant(a, b, c);
  if (certainly_positive(ahead)) return is_positive ? 1 : -1;
  return certainly_negative(ahead) ? std::optional(0) : std::nullopt;
}

Side side_along(const Surface& surface, const Vector3<Ball>& point, const std::array<int, 3>& r) {
  const Vector3<Ball> ray = {Ball(r[0]), Ball(r[1]), Ball(r[2])};
  std::map<std::uint32_t, int> winding;  // by shell
  std::vector<std::uint32_t> open = {0};
  while (!open.empty()) {
    const Surface::Node& node = surface.nodes()[open.back()];
    open.pop_back();
    if (misses(from(point, node.lower), from(point, node.upper), r)) continue;
    if (node.children[0] != 0) {
      open.insert(open.end(), node.children.begin(), node.children.end());
      continue;
    }
    for (std::uint32_t k = node.begin; k < node.end; ++k) {
      const std::uint32_t element = surface.in_order(k);
      if (element >= surface.triangles()) continue;  // a needle
      const auto corners = surface.corners(element);
      const std::optional<int> found =
          crossing(from(point, corners[0]), from(point, corners[1]), from(point, corners[2]), ray);
      if (!found) return Side::kUnknown;
      const Surface::Shell shell = surface.shell(element);
      if (*found != 0) winding[shell.index] += shell.is_reversed ? -*found : *found;
    }
  }
  const bool is_outside = std::ranges::all_of(winding, [](const auto& shell) { return shell.second == 0; });
  return is_outside ? Side::kOutside : Side::kInside;
}

}  // namespace

Side side_of(const Surface& surface, const Vector3<Ball>& point) {
  const Surface::Node& all = surface.nodes().front();
  for (std::size_t c = 0; c < 3; ++c) {
    if (certainly_negative(Ball(all.upper[c]) - point[c]) || certainly_positive(Ball(all.lower[c]) - point[c])) {
      return Side::kOutside;
    }
  }
  constexpr std::array<std::array<int, 3>, 4> kRays = {
      {{61, 97, 1009}, {1013, -89, 71}, {-83, 1019, -67}, {73, 59, -997}}};
  for (const auto& ray : kRays) {
    if (const Side side = side_along(surface, point, ray); side != Side::kUnknown) return side;
  }
  return Side::kUnknown;
}

Vector3<Ball> in_unit_of(const PlacedSurface& mesh, const Vector3<Ball>& point) {
  return (Ball(1) / mesh.unit) * multiply(transposed(mesh.R), point - mesh.at);
}

}  // namespace taut::checker
