// SPDX-License-Identifier: GPL-3.0-or-later
#include "case/mesh_wrap.h"

#include <CGAL/AABB_face_graph_triangle_primitive.h>
#include <CGAL/AABB_traits.h>
#include <CGAL/AABB_tree.h>
#include <CGAL/AABB_triangle_primitive.h>
#include <CGAL/Exact_predicates_inexact_constructions_kernel.h>
#include <CGAL/Polygon_mesh_processing/measure.h>
#include <CGAL/Polygon_mesh_processing/polygon_soup_to_polygon_mesh.h>
#include <CGAL/Polygon_mesh_processing/self_intersections.h>
#include <CGAL/Side_of_triangle_mesh.h>
#include <CGAL/Surface_mesh.h>
#include <CGAL/alpha_wrap_3.h>
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <utility>

#include "base/input_error.h"
#include "case/mesh_file.h"

namespace taut {
namespace {

using Kernel = CGAL::Exact_predicates_inexact_constructions_kernel;
using Point = Kernel::Point_3;
using Triangle = Kernel::Triangle_3;
using Segment = Kernel::Segment_3;
using Surface = CGAL::Surface_mesh<Point>;
using FaceTree = CGAL::AABB_tree<CGAL::AABB_traits<Kernel, CGAL::AABB_face_graph_triangle_primitive<Surface>>>;

Point point(const std::array<double, 3>& x) { return {x[0], x[1], x[2]}; }

[[noreturn]] void fail(const std::string& what) {
  throw InputError(ErrorCode::kCase, "the wrap was not written: " + what);
}

// --- Writing -----------------------------------------------------------------------------------------------------

/// As text, of which each number reads back as the same binary64 number.
std::string text_of(const Surface& surface, const std::string& extension) {
  std::string text;
  const auto add_point = [&](const char* word, const Point& p) {
    text += fmt::format("{}{} {} {}\n", word, p.x(), p.y(), p.z());
  };
  const auto corners = [&](auto face) { return surface.vertices_around_face(surface.halfedge(face)); };
  if (extension == ".stl") {
    text = "solid wrap\n";
    for (const auto face : surface.faces()) {
      text += "facet normal 0 0 0\nouter loop\n";
      for (const auto v : corners(face)) add_point("vertex ", surface.point(v));
      text += "endloop\nendfacet\n";
    }
    return text + "endsolid wrap\n";
  }
  const bool is_ply = extension == ".ply";
  if (is_ply) {
    text = fmt::format(
        "ply\nformat ascii 1.0\nelement vertex {}\nproperty double x\nproperty double y\nproperty double z\n"
        "element face {}\nproperty list uchar int vertex_indices\nend_header\n",
        surface.number_of_vertices(), surface.number_of_faces());
  }
  for (const auto v : surface.vertices()) add_point(is_ply ? "" : "v ", surface.point(v));
  for (const auto face : surface.faces()) {
    text += is_ply ? "3" : "f";
    for (const auto v : corners(face)) text += fmt::format(" {}", static_cast<std::size_t>(v) + (is_ply ? 0 : 1));
    text += '\n';
  }
  return text;
}

// --- Proof -------------------------------------------------------------------------------------------------------

Surface surface_of(const TriangleMesh& mesh) {
  std::vector<Point> points;
  for (const auto& x : mesh.vertices) points.push_back(point(x));
  std::vector<std::array<std::uint32_t, 3>> faces = mesh.triangles;
  namespace processing = CGAL::Polygon_mesh_processing;
  if (!processing::orient_polygon_soup(points, faces) || !processing::is_polygon_soup_a_polygon_mesh(faces)) {
    fail("its triangles do not make a surface");
  }
  Surface surface;
  processing::polygon_soup_to_polygon_mesh(points, faces, surface);
  return surface;
}

/// Of three points on a line, the two that are farthest apart; of two points, these.
Segment longest(const std::array<Point, 3>& p) {
  std::array<Segment, 3> sides{Segment(p[0], p[1]), Segment(p[1], p[2]), Segment(p[2], p[0])};
  for (const Segment& side : sides) {
    if (std::ranges::all_of(p, [&](const Point& x) { return side.has_on(x); })) return side;
  }
  fail("a triangle of the mesh has no corners that can be told apart");
}

/// Exact: `read` is what the file that is written says.
void require_inside(const IndexedMesh& mesh, const IndexedMesh& read) {
  if (!read.is_watertight()) fail("it is not closed");
  const Surface wrap = surface_of(read.mesh());
  for (const auto face : wrap.faces()) {
    if (CGAL::Polygon_mesh_processing::is_degenerate_triangle_face(face, wrap)) fail("a triangle has no area");
  }
  if (CGAL::Polygon_mesh_processing::does_self_intersect(wrap)) fail("it crosses itself");
  const FaceTree tree(faces(wrap).first, faces(wrap).second, wrap);
  const CGAL::Side_of_triangle_mesh<Surface, Kernel> side(tree);
  const auto corners = [&](std::size_t element) {
    const auto x = mesh.points(element);
    return std::array<Point, 3>{point(x[0]), point(x[1]), point(x[2])};
  };
  for (std::size_t element = 0; element < mesh.elements(); ++element) {
    const std::array<Point, 3> p = corners(element);
    const bool meets = CGAL::collinear(p[0], p[1], p[2]) ? tree.do_intersect(longest(p))
                                                         : tree.do_intersect(Triangle(p[0], p[1], p[2]));
    if (meets) fail("it meets the mesh. A larger --offset may do");
  }
  for (const std::uint32_t vertex : mesh.components()) {
    if (side(point(mesh.mesh().vertices.at(vertex))) != CGAL::ON_BOUNDED_SIDE) {
      fail("a part of the mesh is outside of it");
    }
  }
}

/// The greatest distance of a corner of the wrap from the mesh.
double farthest(const IndexedMesh& mesh, const TriangleMesh& wrap) {
  std::vector<Triangle> triangles;
  for (std::size_t element = 0; element < mesh.elements(); ++element) {
    const auto x = mesh.points(element);
    const Triangle triangle(point(x[0]), point(x[1]), point(x[2]));
    if (!triangle.is_degenerate()) triangles.push_back(triangle);
  }
  if (triangles.empty()) return 0;
  using Primitive = CGAL::AABB_triangle_primitive<Kernel, std::vector<Triangle>::const_iterator>;
  const CGAL::AABB_tree<CGAL::AABB_traits<Kernel, Primitive>> tree(triangles.cbegin(), triangles.cend());
  double most = 0;
  for (const auto& x : wrap.vertices) most = std::max(most, CGAL::to_double(tree.squared_distance(point(x))));
  return std::sqrt(most);
}

}  // namespace

double diagonal(const TriangleMesh& mesh) {
  double square = 0;
  for (std::size_t k = 0; k < 3; ++k) {
    const auto [least, greatest] =
        std::ranges::minmax(mesh.vertices, {}, [k](const std::array<double, 3>& x) { return x[k]; });
    square += (greatest[k] - least[k]) * (greatest[k] - least[k]);
  }
  return std::sqrt(square);
}

MeshWrap wrap(const TriangleMesh& mesh, const WrapOptions& options, const std::string& extension) {
  std::vector<Point> points;
  for (const auto& x : mesh.vertices) points.push_back(point(x));
  std::vector<std::array<std::size_t, 3>> faces;
  for (const auto& [a, b, c] : mesh.triangles) faces.push_back({a, b, c});
  for (const auto& [a, b] : mesh.needles) faces.push_back({a, b, b});
  Surface surface;
  CGAL::alpha_wrap_3(points, faces, options.alpha, options.offset, surface);
  if (surface.number_of_faces() > kMostMeshTriangles) {
    fail(fmt::format("it has {} triangles, expected at most {}. A larger --alpha makes fewer",
                     surface.number_of_faces(), kMostMeshTriangles));
  }
  if (surface.is_empty()) fail("there is nothing in it. A smaller --alpha may do");
  std::string file = text_of(surface, extension);
  if (file.size() > kMostMeshBytes) {
    fail(
        fmt::format("it has {} bytes, expected at most {}. A larger --alpha makes fewer", file.size(), kMostMeshBytes));
  }
  IndexedMesh read(repaired(read_polygons(extension, file)).mesh);
  const IndexedMesh around(mesh);
  require_inside(around, read);
  const double far = farthest(around, read.mesh());
  const double volume = std::abs(CGAL::to_double(CGAL::Polygon_mesh_processing::volume(surface)));
  return {std::move(file), std::move(read), far, volume};
}

}  // namespace taut
