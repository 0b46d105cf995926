// SPDX-License-Identifier: GPL-3.0-or-later
#include "case/decoration.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>

#include "base/input_error.h"
#include "base/sanitize.h"
#include "case/decoration_fields.h"
#include "case/mesh_file.h"
#include "problem/expression.h"
#include "problem/scalar.h"

namespace taut {

bool is_shown_body(const ShownBody& body) {
  const auto is_near = [](const std::array<double, 3>& corner) {
    return std::ranges::all_of(corner, [](double x) { return std::isfinite(x) && std::abs(x) <= kFarthestShown; });
  };
  const auto has_corners = [&](const std::array<std::uint32_t, 3>& triangle) {
    return std::ranges::all_of(triangle, [&](std::uint32_t i) { return i < body.corners.size(); });
  };
  return !body.triangles.empty() && body.triangles.size() <= kMostShownTriangles &&
         body.corners.size() <= 3 * kMostShownTriangles && std::ranges::all_of(body.corners, is_near) &&
         std::ranges::all_of(body.triangles, has_corners);
}

namespace {

[[noreturn]] void fail(const MeshFile& file, const std::string& message) {
  throw InputError(ErrorCode::kCase, fmt::format("{}got '{}', {}", file.where, excerpt(file.name), message));
}

/// A polygon of n corners as n − 2 triangles around its first corner.
ShownBody triangulated(const MeshFile& mesh, const PolygonSoup& soup) {
  ShownBody body;
  for (const std::array<double, 3>& p : soup.points) {
    std::array<double, 3>& corner = body.corners.emplace_back(mesh.at);
    for (std::size_t i = 0; i < 3; ++i) {
      for (std::size_t j = 0; j < 3; ++j) corner[i] += mesh.turn[i][j] * p[j];
    }
  }
  std::size_t triangles = 0;
  for (const std::vector<std::size_t>& polygon : soup.faces) {
    for (std::size_t k = 2; k < polygon.size(); ++k) {
      if (++triangles > kMostShownTriangles) continue;
      const auto index = [&](std::size_t i) {
        return static_cast<std::uint32_t>(std::min<std::size_t>(polygon[i], soup.points.size()));
      };
      body.triangles.push_back({index(0), index(k - 1), index(k)});
    }
  }
  if (triangles > kMostShownTriangles) {
    fail(mesh,
         fmt::format("a mesh of {} triangles, expected at most {} for a picture", triangles, kMostShownTriangles));
  }
  return body;
}

PolygonSoup polygons_of(const MeshFile& mesh) {
  try {
    return read_polygons(extension_of(mesh.name), mesh_bytes(mesh.path));
  } catch (const InputError& error) {
    fail(mesh, error.what());
  }
}

ShownBody read_mesh(const MeshFile& mesh) {
  ShownBody body = triangulated(mesh, polygons_of(mesh));
  if (!is_shown_body(body)) {
    fail(mesh, fmt::format("in which a corner is missing, no number or beyond {:g} m, or no face is, expected a mesh",
                           kFarthestShown));
  }
  return body;
}

}  // namespace

Decoration read_meshes(const DecorationFiles& files) {
  Decoration result;
  if (files.frame) result.frame = read_mesh(*files.frame);
  if (files.payload) result.payload = read_mesh(*files.payload);
  return result;
}

namespace case_fields {
namespace {

Eigen::Matrix3d read_rotation(const Field& field, const Unit& angle) {
  const Map map = field.map({"roll", "pitch", "yaw"});
  Eigen::Matrix3d result = Eigen::Matrix3d::Identity();
  const std::pair<const char*, Eigen::Vector3d> axes[] = {
      {"yaw", Eigen::Vector3d::UnitZ()}, {"pitch", Eigen::Vector3d::UnitY()}, {"roll", Eigen::Vector3d::UnitX()}};
  for (const auto& [name, axis] : axes) {
    const auto entry = map.find(name);
    if (!entry) continue;
    const double turn = evaluate_constant<double>(read_expression(*entry, angle, {}));
    result = result * Eigen::AngleAxisd(turn, axis);
  }
  return result;
}

double metres(const Unit& unit) { return ScalarTraits<double>::from_decimal(decimal_to_si("1", unit)); }

MeshFile read_mesh_file(const Field& field, const Units& units, const std::filesystem::path& folder) {
  const Map map = field.map({"mesh", "unit", "at", "rotation"});
  const Field mesh = map.at("mesh");
  const std::string name = mesh.text(kMeshNameExpected);
  if (!is_mesh_name(name)) mesh.fail(kMeshNameExpected);
  const Unit unit = read_unit(map.at("unit"), Dimension::kLength, kMeshUnitExpected);
  MeshFile result{name, mesh.remark(""), folder / name, {}, {}};
  Eigen::Matrix3d turn = Eigen::Matrix3d::Identity();
  if (const auto rotation = map.find("rotation")) turn = read_rotation(*rotation, units[Dimension::kAngle]);
  for (std::size_t i = 0; i < 3; ++i) {
    for (std::size_t j = 0; j < 3; ++j) {
      result.turn[i][j] = metres(unit) * turn(static_cast<Eigen::Index>(i), static_cast<Eigen::Index>(j));
    }
  }
  if (const auto at = map.find("at")) {
    const std::vector<Field> coordinates = at->list(3, "a point: a list of three lengths");
    for (std::size_t k = 0; k < 3; ++k) {
      result.at[k] = ScalarTraits<double>::from_decimal(read_quantity(coordinates[k], units[Dimension::kLength]));
    }
  }
  return result;
}

}  // namespace

DecorationFiles read_decoration(const Field& field, const Units& units, const std::filesystem::path& folder) {
  const Map map = field.map({"frame", "payload"});
  DecorationFiles result;
  if (const auto frame = map.find("frame")) result.frame = read_mesh_file(*frame, units, folder);
  if (const auto payload = map.find("payload")) result.payload = read_mesh_file(*payload, units, folder);
  return result;
}

}  // namespace case_fields
}  // namespace taut
