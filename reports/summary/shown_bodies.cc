// SPDX-License-Identifier: GPL-3.0-or-later
#include "reports/summary/shown_bodies.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <map>
#include <nlohmann/json.hpp>
#include <numbers>
#include <optional>
#include <set>

#include "kinematics/geometry.h"
#include "problem/expression.h"

namespace taut {
namespace {

using Corner = std::array<double, 3>;

constexpr double kSteps = 1e5;  ///< of corners in JSON, in a metre; a certificate has no numbers but integers

nlohmann::json to_json(const ShownBody& body) {
  nlohmann::json corners = nlohmann::json::array();
  nlohmann::json triangles = nlohmann::json::array();
  for (const Corner& corner : body.corners) {
    for (const double x : corner) corners.push_back(std::llround(x * kSteps));
  }
  for (const auto& triangle : body.triangles) {
    for (const std::uint32_t i : triangle) triangles.push_back(i);
  }
  return {{"corners", corners}, {"triangles", triangles}};
}

std::optional<ShownBody> shown_body_from_json(const nlohmann::json& json) {
  if (!json.is_object() || !json.contains("corners") || !json.contains("triangles")) return std::nullopt;
  const nlohmann::json& corners = json["corners"];
  const nlohmann::json& triangles = json["triangles"];
  if (!corners.is_array() || !triangles.is_array() || corners.size() % 3 != 0 || triangles.size() % 3 != 0 ||
      triangles.size() > 3 * kMostShownTriangles || corners.size() > 9 * kMostShownTriangles) {
    return std::nullopt;
  }
  ShownBody body;
  for (std::size_t i = 0; i < corners.size(); ++i) {
    if (!corners[i].is_number_integer()) return std::nullopt;
    if (i % 3 == 0) body.corners.emplace_back();
    body.corners.back()[i % 3] = corners[i].get<double>() / kSteps;
  }
  for (std::size_t i = 0; i < triangles.size(); ++i) {
    if (!triangles[i].is_number_unsigned() || triangles[i].get<std::uint64_t>() >= body.corners.size()) {
      return std::nullopt;
    }
    if (i % 3 == 0) body.triangles.emplace_back();
    body.triangles.back()[i % 3] = triangles[i].get<std::uint32_t>();
  }
  return is_shown_body(body) ? std::optional(std::move(body)) : std::nullopt;
}

}  // namespace

nlohmann::json to_json(const Decoration& decoration) {
  nlohmann::json result = nlohmann::json::object();
  if (decoration.frame) result["frame"] = to_json(*decoration.frame);
  if (decoration.payload) result["payload"] = to_json(*decoration.payload);
  return result;
}

Decoration decoration_from_json(const nlohmann::json& decoration) {
  Decoration result;
  if (!decoration.is_object()) return result;
  if (decoration.contains("frame")) result.frame = shown_body_from_json(decoration["frame"]);
  if (decoration.contains("payload")) result.payload = shown_body_from_json(decoration["payload"]);
  return result;
}

namespace {

/// Points in one cell of a grid of `cells` a side become one, that of the first of them.
ShownBody clustered(const ShownBody& mesh, const Eigen::AlignedBox3d& box, double cells) {
  ShownBody result;
  std::map<std::array<long, 3>, std::uint32_t> known;
  std::vector<std::uint32_t> index;
  const double size = std::max(box.sizes().maxCoeff(), 1e-300);
  for (const Corner& corner : mesh.corners) {
    std::array<long, 3> cell{};
    for (std::size_t c = 0; c < 3; ++c) {
      cell[c] = std::lround((corner[c] - box.min()(static_cast<Eigen::Index>(c))) / size * cells);
    }
    const auto [found, is_new] = known.try_emplace(cell, static_cast<std::uint32_t>(result.corners.size()));
    if (is_new) result.corners.push_back(corner);
    index.push_back(found->second);
  }
  std::set<std::array<std::uint32_t, 3>> triangles;
  for (const auto& triangle : mesh.triangles) {
    std::array<std::uint32_t, 3> next = {index[triangle[0]], index[triangle[1]], index[triangle[2]]};
    if (next[0] == next[1] || next[1] == next[2] || next[2] == next[0]) continue;
    std::ranges::rotate(next, std::ranges::min_element(next));
    triangles.insert(next);
  }
  result.triangles.assign(triangles.begin(), triangles.end());
  return result;
}

}  // namespace

ShownBody shown_mesh(const TriangleMesh& mesh, const BodyText& body) {
  const double unit = ScalarTraits<double>::from_decimal(std::get<MeshText>(body.shape).unit_m);
  const auto angle = [&](std::size_t k) { return evaluate_constant<double>(body.rotation_rad[k]); };
  const Matrix3<double> turn = rotation_zyx<double>(angle(2), angle(1), angle(0));
  ShownBody result;
  Eigen::AlignedBox3d box;
  for (const Corner& vertex : mesh.vertices) {
    Eigen::Vector3d at = turn * (unit * Eigen::Vector3d(vertex[0], vertex[1], vertex[2]));
    Corner corner{};
    for (std::size_t c = 0; c < 3; ++c) {
      at(static_cast<Eigen::Index>(c)) += ScalarTraits<double>::from_decimal(body.at_m[c]);
      corner[c] = std::clamp(at(static_cast<Eigen::Index>(c)), -kFarthestShown, kFarthestShown);
    }
    box.extend(at);
    result.corners.push_back(corner);
  }
  result.triangles = mesh.triangles;
  constexpr double kFirst = 256, kLess = 0.7;
  const ShownBody whole = result;
  for (double cells = kFirst; result.triangles.size() > kMostShownTriangles && cells > 2; cells *= kLess) {
    result = clustered(whole, box, cells);
  }
  return result;
}

std::map<std::string, ShownBody> shown_meshes(const BodiesText& bodies) {
  std::map<std::string, ShownBody> result;
  for (const auto* list : {&bodies.platform, &bodies.obstacles}) {
    for (const BodyText& body : *list) {
      const auto* mesh = std::get_if<MeshText>(&body.shape);
      if (mesh != nullptr && mesh->mesh != nullptr) result.emplace(body.name, shown_mesh(mesh->mesh->mesh(), body));
    }
  }
  return result;
}

std::vector<std::array<Corner, 2>> feature_edges(const ShownBody& body, const Eigen::Vector3d& towards) {
  // Corners by their places: STL files give every triangle its own.
  struct Sides {
    Eigen::Vector3d first = Eigen::Vector3d::Zero();
    int count = 0;
    bool turns = false;
    std::array<bool, 2> is_aside{};  ///< in the picture, whether some triangle is on either side of the edge
  };
  std::map<std::array<Corner, 2>, Sides> edges;
  constexpr double kEdgeOn = 1e-6;  // of a triangle's size: it is on neither side then
  const double most_along = std::cos(std::numbers::pi / 6);
  for (const auto& triangle : body.triangles) {
    std::array<Corner, 3> at;
    for (std::size_t i = 0; i < 3; ++i) at[i] = body.corners[triangle[i]];
    const auto vector = [&](std::size_t i) { return Eigen::Map<const Eigen::Vector3d>(at[i].data()); };
    const Eigen::Vector3d normal = (vector(1) - vector(0)).cross(vector(2) - vector(0)).normalized();
    for (std::size_t i = 0; i < 3; ++i) {
      const Corner& a = at[i];
      const Corner& b = at[(i + 1) % 3];
      const std::array<Corner, 2> edge = a < b ? std::array{a, b} : std::array{b, a};
      Sides& sides = edges[edge];
      const Eigen::Map<const Eigen::Vector3d> from(edge[0].data()), to(edge[1].data());
      const Eigen::Vector3d along = to - from, across = vector((i + 2) % 3) - from;
      const double side = along.cross(towards).dot(across);
      const double flat = kEdgeOn * along.norm() * across.norm();
      if (std::abs(side) > flat) sides.is_aside[side > 0 ? 1 : 0] = true;
      if (++sides.count == 1) {
        sides.first = normal;
      } else {
        sides.turns |= std::abs(sides.first.dot(normal)) < most_along;
      }
    }
  }
  std::vector<std::array<Corner, 2>> result;
  for (const auto& [edge, sides] : edges) {
    const bool is_outline = !(sides.is_aside[0] && sides.is_aside[1]);
    if (is_outline || sides.turns) result.push_back(edge);
  }
  return result;
}

}  // namespace taut
