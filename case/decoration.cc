// SPDX-License-Identifier: GPL-3.0-or-later
#include "case/decoration.h"

#include <CGAL/IO/OBJ.h>
#include <CGAL/IO/PLY.h>
#include <CGAL/IO/STL.h>
#include <CGAL/Simple_cartesian.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <cctype>
#include <cerrno>
#include <cmath>
#include <cstring>
#include <fstream>
#include <sstream>

#include "base/input_error.h"
#include "base/sanitize.h"
#include "case/decoration_fields.h"
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

using Point = CGAL::Simple_cartesian<double>::Point_3;
using Polygons = std::vector<std::vector<std::size_t>>;

constexpr std::size_t kMostBytes = 64 << 20;

[[noreturn]] void fail(const MeshFile& file, const std::string& message) {
  throw InputError(ErrorCode::kCase, fmt::format("{}got '{}', {}", file.where, excerpt(file.name), message));
}

std::string content_of(const MeshFile& mesh) {
  errno = 0;
  std::ifstream file(mesh.path, std::ios::binary);
  std::string content(kMostBytes + 1, '\0');
  if (!file.read(content.data(), static_cast<std::streamsize>(content.size())) && !file.eof()) {
    fail(mesh, fmt::format("which could not be read: {}", errno != 0 ? std::strerror(errno) : "no reason is known"));
  }
  const auto size = static_cast<std::size_t>(file.gcount());
  if (size > kMostBytes) fail(mesh, fmt::format("expected a mesh of at most {} MB", kMostBytes >> 20));
  content.resize(size);
  return content;
}

/// A binary STL file says how many triangles follow, of 50 bytes each; CGAL would make room for as many as it says.
bool is_cut_stl(const std::string& content) {
  constexpr std::size_t kHead = 84;
  if (content.starts_with("solid") && content.find("facet") != std::string::npos) return false;
  if (content.size() < kHead) return true;
  std::uint32_t count = 0;
  for (std::size_t i = 0; i < 4; ++i) {
    count |= static_cast<std::uint32_t>(static_cast<unsigned char>(content[kHead - 4 + i])) << (8 * i);
  }
  return content.size() < kHead + 50 * static_cast<std::size_t>(count);
}

bool read_polygons(const std::string& extension, const std::string& content, std::vector<Point>& points,
                   Polygons& polygons) {
  std::istringstream stream(content, std::ios::binary);
  const auto quietly = CGAL::parameters::verbose(false);
  try {
    if (extension == ".stl") return !is_cut_stl(content) && CGAL::IO::read_STL(stream, points, polygons, quietly);
    if (extension == ".obj") return CGAL::IO::read_OBJ(stream, points, polygons, quietly);
    return CGAL::IO::read_PLY(stream, points, polygons, quietly);
  } catch (const std::exception&) {  // of a file that promises what it does not hold
    return false;
  }
}

/// A polygon of n corners as n − 2 triangles around its first corner.
ShownBody triangulated(const MeshFile& mesh, const std::vector<Point>& points, const Polygons& polygons) {
  ShownBody body;
  for (const Point& p : points) {
    std::array<double, 3>& corner = body.corners.emplace_back(mesh.at);
    for (std::size_t i = 0; i < 3; ++i) {
      for (std::size_t j = 0; j < 3; ++j) corner[i] += mesh.turn[i][j] * p[static_cast<int>(j)];
    }
  }
  std::size_t triangles = 0;
  for (const std::vector<std::size_t>& polygon : polygons) {
    for (std::size_t k = 2; k < polygon.size(); ++k) {
      if (++triangles > kMostShownTriangles) continue;
      const auto index = [&](std::size_t i) {
        return static_cast<std::uint32_t>(std::min<std::size_t>(polygon[i], points.size()));
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

std::string extension_of(const std::string& name) {
  std::string extension = std::filesystem::path(name).extension().string();
  std::ranges::transform(extension, extension.begin(), [](unsigned char c) { return std::tolower(c); });
  return extension;
}

ShownBody read_mesh(const MeshFile& mesh) {
  std::vector<Point> points;
  Polygons polygons;
  const std::string extension = extension_of(mesh.name);
  if (!read_polygons(extension, content_of(mesh), points, polygons)) {
    fail(mesh, fmt::format("which is no whole {} file, expected a mesh", extension.substr(1)));
  }
  ShownBody body = triangulated(mesh, points, polygons);
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
  const std::string name = mesh.text("the name of an STL, OBJ or PLY file");
  const std::string extension = extension_of(name);
  if (extension != ".stl" && extension != ".obj" && extension != ".ply") {
    mesh.fail("the name of an STL, OBJ or PLY file");
  }
  const Field unit_field = map.at("unit");
  const std::string expected = "the unit of the mesh's coordinates, one of " + unit_names(Dimension::kLength);
  const auto unit = find_unit(unit_field.text(expected));
  if (!unit || unit->dimension != Dimension::kLength) unit_field.fail(expected);
  MeshFile result{name, mesh.remark(""), folder / name, {}, {}};
  Eigen::Matrix3d turn = Eigen::Matrix3d::Identity();
  if (const auto rotation = map.find("rotation")) turn = read_rotation(*rotation, units[Dimension::kAngle]);
  for (std::size_t i = 0; i < 3; ++i) {
    for (std::size_t j = 0; j < 3; ++j) {
      result.turn[i][j] = metres(*unit) * turn(static_cast<Eigen::Index>(i), static_cast<Eigen::Index>(j));
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
