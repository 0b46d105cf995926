// SPDX-License-Identifier: GPL-3.0-or-later
// Meshes in files: STL (binary and text) and OBJ, read by CGAL, and PLY (ply_file.h).
//
// A mesh is the union of its triangles. A coordinate is the binary64 number nearest to what the file says, or the
// binary32 number where the file says that its numbers are such, in a unit that the file does not know. A face with
// more than three corners is split into triangles around its first corner; their union contains the face, if it is
// flat. Repair takes nothing away from that union.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

#include "problem/triangle_mesh.h"

namespace taut {

/// The faces of a mesh as a file has them.
struct PolygonSoup {
  std::vector<std::array<double, 3>> points;
  std::vector<std::vector<std::size_t>> faces;  ///< indices of points, which may be too large
};

inline constexpr std::size_t kMostMeshBytes = 64 << 20;
inline constexpr std::size_t kMostMeshTriangles = 1'000'000;
inline constexpr double kFarthestMesh = 1e9;  ///< of a coordinate, in the file's unit

/// ".stl" in "Tool.STL".
[[nodiscard]] std::string extension_of(const std::string& name);
/// Whether the name is that of an STL, OBJ or PLY file.
[[nodiscard]] bool is_mesh_name(const std::string& name);
/// For messages about the name, and about the unit, whose names follow.
inline constexpr const char* kMeshNameExpected = "the name of an STL, OBJ or PLY file";
inline constexpr const char* kMeshUnitExpected = "the unit of the mesh's coordinates, one of ";

/// The file's bytes. @throws InputError that begins "which could not be read", for what is no regular file,
/// or for more than kMostMeshBytes
[[nodiscard]] std::string mesh_bytes(const std::filesystem::path& path);
/// What the bytes of a file with such an extension say. @pre is_mesh_name()
/// @throws InputError "which is no whole stl file, expected a mesh"
[[nodiscard]] PolygonSoup read_polygons(const std::string& extension, const std::string& bytes);

/// What a file holds, and what was done to it.
struct MeshReport {
  // Repair
  std::size_t split_faces = 0;        ///< those with more than three corners
  std::size_t merged_points = 0;      ///< points that are where another one is
  std::size_t unused_points = 0;      ///< points of no face
  std::size_t dropped_triangles = 0;  ///< twice there, or with a corner twice; what these cover is covered still
  std::size_t flat_triangles = 0;     ///< three different corners on one line: they stay
  // Of what is left
  std::size_t edges_of_one = 0;       ///< edges of one triangle
  std::size_t edges_of_many = 0;      ///< edges of more than two
  std::size_t closed_components = 0;  ///< parts that hang together by edges and have no edge of one or of many
  std::size_t open_components = 0;
  std::array<double, 3> lower{};  ///< bounding box, in the file's unit
  std::array<double, 3> upper{};

  /// Whether each edge has two triangles. A mesh has an inside if, besides, each of its parts has two sides.
  [[nodiscard]] bool is_watertight() const { return edges_of_one == 0 && edges_of_many == 0; }
};

struct LoadedMesh {
  TriangleMesh mesh;
  MeshReport report;
  std::string sha256;  ///< of the file's bytes
};

/// Merges equal points and drops triangles that are there twice, in any order of their corners, or that have a corner
/// twice. A triangle whose corners are two points is the segment between them: unless that is an edge of a triangle
/// that stays, it is kept among the needles, so that nothing of the file's surface is lost.
/// @throws InputError for a mesh without triangles or with too many, and for a corner that is missing, no number or too
/// far away
[[nodiscard]] LoadedMesh repaired(const PolygonSoup& soup);

/// Reads, checks and repairs a mesh. 10^5 triangles take 0.1 s, or 0.4 s in an STL file of text.
/// @throws InputError that says what is wrong with the file, "which …" or "in which …"
[[nodiscard]] LoadedMesh load_mesh(const std::filesystem::path& path);

}  // namespace taut
