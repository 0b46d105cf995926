// SPDX-License-Identifier: GPL-3.0-or-later
#include "case/mesh_file.h"

#include <CGAL/IO/OBJ.h>
#include <CGAL/IO/PLY.h>
#include <CGAL/IO/STL.h>
#include <CGAL/Simple_cartesian.h>
#include <fmt/format.h>

#include <algorithm>
#include <bit>
#include <cctype>
#include <cerrno>
#include <cmath>
#include <cstring>
#include <fstream>
#include <numeric>
#include <set>
#include <sstream>
#include <unordered_map>

#include "base/input_error.h"
#include "base/sha256.h"
#include "problem/rational.h"

namespace taut {
namespace {

[[noreturn]] void fail(const std::string& message) { throw InputError(ErrorCode::kCase, message); }

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

using CgalPoint = CGAL::Simple_cartesian<double>::Point_3;

bool read_by_cgal(const std::string& extension, const std::string& bytes, std::vector<CgalPoint>& points,
                  std::vector<std::vector<std::size_t>>& faces) {
  std::istringstream stream(bytes, std::ios::binary);
  const auto quietly = CGAL::parameters::verbose(false);
  try {
    if (extension == ".stl") return !is_cut_stl(bytes) && CGAL::IO::read_STL(stream, points, faces, quietly);
    if (extension == ".obj") return CGAL::IO::read_OBJ(stream, points, faces, quietly);
    return CGAL::IO::read_PLY(stream, points, faces, quietly);
  } catch (const std::exception&) {  // of a file that promises what it does not hold
    return false;
  }
}

using Vertex = std::array<double, 3>;
using Corners = std::array<std::uint32_t, 3>;

struct HashOfVertex {
  std::size_t operator()(const Vertex& vertex) const {
    std::uint64_t hash = 0;
    for (const double x : vertex) hash = (hash ^ std::bit_cast<std::uint64_t>(x)) * 0x9E3779B97F4A7C15U;
    return hash ^ (hash >> 32);
  }
};

/// Whether three points are on one line, exactly.
bool are_on_a_line(const Vertex& a, const Vertex& b, const Vertex& c) {
  constexpr std::array<std::array<std::size_t, 2>, 3> kMinors = {{{0, 1}, {1, 2}, {2, 0}}};
  const auto is_certainly_nonzero = [&](const std::array<std::size_t, 2>& axes) {
    const auto [i, j] = axes;
    const double left = (b[i] - a[i]) * (c[j] - a[j]), right = (b[j] - a[j]) * (c[i] - a[i]);
    const double size = std::max(std::abs(left), std::abs(right));
    // Three roundings of each product and that of the difference are less than 2^-50 of the size, where nothing
    // underflows.
    return size > 1e-200 && std::abs(left - right) > size * 0x1p-48;
  };
  const auto is_zero = [&](const std::array<std::size_t, 2>& axes) {
    const auto [i, j] = axes;
    const auto exact = [](double to, double from) { return Rational(Rational(to) - Rational(from)); };
    return exact(b[i], a[i]) * exact(c[j], a[j]) == exact(b[j], a[j]) * exact(c[i], a[i]);
  };
  return std::ranges::none_of(kMinors, is_certainly_nonzero) && std::ranges::all_of(kMinors, is_zero);
}

/// Sets that grow together, by index.
class UnionFind {
 public:
  explicit UnionFind(std::size_t count) : parent_(count) { std::iota(parent_.begin(), parent_.end(), 0U); }
  std::uint32_t root(std::uint32_t i) {
    while (parent_[i] != i) i = parent_[i] = parent_[parent_[i]];
    return i;
  }
  void unite(std::uint32_t i, std::uint32_t j) { parent_[root(i)] = root(j); }

 private:
  std::vector<std::uint32_t> parent_;
};

/// An edge of a triangle; the smaller index of a vertex comes first.
struct EdgeOfTriangle {
  std::array<std::uint32_t, 2> ends{};
  std::uint32_t triangle = 0;
};

/// All edges, those of the same ends beside each other.
std::vector<EdgeOfTriangle> sorted_edges(const std::vector<Corners>& triangles) {
  std::vector<EdgeOfTriangle> edges;
  edges.reserve(3 * triangles.size());
  for (std::uint32_t t = 0; t < triangles.size(); ++t) {
    for (std::size_t k = 0; k < 3; ++k) {
      const auto [low, high] = std::minmax(triangles[t][k], triangles[t][(k + 1) % 3]);
      edges.push_back({{low, high}, t});
    }
  }
  std::ranges::sort(edges, {}, &EdgeOfTriangle::ends);
  return edges;
}

/// Repairs a soup of polygons, step by step.
class Repair {
 public:
  explicit Repair(const PolygonSoup& soup) : soup_(soup) {}

  LoadedMesh run() && {
    split();
    merge();
    drop();
    keep_what_is_used();
    find_components();
    find_box();
    return std::move(result_);
  }

 private:
  /// Faces to triangles of the soup's points.
  void split() {
    std::size_t count = 0;
    for (const std::vector<std::size_t>& face : soup_.faces) count += face.size() < 3 ? 1 : face.size() - 2;
    if (count == 0) fail("in which no face is, expected a mesh");
    if (count > kMostMeshTriangles) {
      fail(fmt::format("a mesh of {} triangles, expected at most {}", count, kMostMeshTriangles));
    }
    corners_.reserve(count);
    for (const std::vector<std::size_t>& face : soup_.faces) {
      for (const std::size_t i : face) {
        if (i >= soup_.points.size()) {
          fail(fmt::format("in which corner {} is missing, expected a mesh", i + 1));
        }
      }
      if (face.size() < 3) fail(fmt::format("in which a face has {} corners, expected a mesh", face.size()));
      const auto corner = [&](std::size_t k) { return static_cast<std::uint32_t>(face[k]); };
      for (std::size_t k = 2; k < face.size(); ++k) corners_.push_back({corner(0), corner(k - 1), corner(k)});
      result_.report.split_faces += face.size() > 3;
    }
  }

  /// Corners to points of which no two are equal.
  void merge() {
    std::unordered_map<Vertex, std::uint32_t, HashOfVertex> known;
    known.reserve(soup_.points.size());
    std::vector<std::uint32_t> merged(soup_.points.size());
    for (std::size_t i = 0; i < soup_.points.size(); ++i) {
      Vertex point = soup_.points[i];
      for (double& x : point) {
        if (!std::isfinite(x)) fail(fmt::format("in which point {} is no number, expected a mesh", i + 1));
        if (std::abs(x) > kFarthestMesh) {
          fail(fmt::format("in which point {} is farther away than {:g} of its units, expected a mesh", i + 1,
                           kFarthestMesh));
        }
        if (x == 0) x = 0;  // -0, too
      }
      const auto [found, is_new] = known.try_emplace(point, static_cast<std::uint32_t>(vertices_.size()));
      if (is_new) vertices_.push_back(point);
      merged[i] = found->second;
    }
    result_.report.merged_points = soup_.points.size() - vertices_.size();
    for (Corners& triangle : corners_) {
      for (std::uint32_t& corner : triangle) corner = merged[corner];
    }
  }

  /// Drops what is there twice, or is no triangle.
  void drop() {
    std::vector<Corners> flat;
    std::vector<std::pair<Corners, std::uint32_t>> known;
    known.reserve(corners_.size());
    for (const Corners& triangle : corners_) {
      if (triangle[0] == triangle[1] || triangle[1] == triangle[2] || triangle[2] == triangle[0]) {
        flat.push_back(triangle);
        continue;
      }
      Corners sorted = triangle;
      std::ranges::sort(sorted);
      known.emplace_back(sorted, static_cast<std::uint32_t>(known.size()));
      kept_.push_back(triangle);
    }
    std::ranges::sort(known);
    std::vector<bool> is_again(kept_.size());
    for (std::size_t k = 1; k < known.size(); ++k) is_again[known[k].second] = known[k].first == known[k - 1].first;
    std::size_t kept = 0;
    for (std::size_t k = 0; k < kept_.size(); ++k) {
      if (!is_again[k]) kept_[kept++] = kept_[k];
    }
    kept_.resize(kept);
    result_.report.dropped_triangles = corners_.size() - kept;
    if (kept == 0) fail("in which no triangle has three different corners, expected a mesh");
    for (const Corners& t : kept_) {
      result_.report.flat_triangles += are_on_a_line(vertices_[t[0]], vertices_[t[1]], vertices_[t[2]]);
    }
    edges_ = sorted_edges(kept_);
    keep_needles(flat);
  }

  /// Keeps the segments of triangles with two corners, or the point of those with one, that no other triangle has.
  void keep_needles(const std::vector<Corners>& flat) {
    if (flat.empty()) return;
    std::vector<bool> is_used(vertices_.size());
    for (const Corners& triangle : kept_) {
      for (const std::uint32_t corner : triangle) is_used[corner] = true;
    }
    std::set<std::array<std::uint32_t, 2>> needles;
    for (const Corners& triangle : flat) {
      const auto [low, high] = std::ranges::minmax(triangle);
      const std::array<std::uint32_t, 2> ends = {low, high};
      const bool is_covered =
          low == high ? is_used[low] : std::ranges::binary_search(edges_, ends, {}, &EdgeOfTriangle::ends);
      if (!is_covered) needles.insert(ends);
    }
    result_.mesh.needles.assign(needles.begin(), needles.end());
  }

  void keep_what_is_used() {
    constexpr std::uint32_t kUnused = UINT32_MAX;
    std::vector<std::uint32_t> index(vertices_.size(), kUnused);
    const auto use = [&](std::uint32_t& corner) {
      if (index[corner] == kUnused) {
        index[corner] = static_cast<std::uint32_t>(result_.mesh.vertices.size());
        result_.mesh.vertices.push_back(vertices_[corner]);
      }
      corner = index[corner];
    };
    for (Corners& triangle : kept_) std::ranges::for_each(triangle, use);
    for (auto& needle : result_.mesh.needles) std::ranges::for_each(needle, use);
    result_.report.unused_points = vertices_.size() - result_.mesh.vertices.size();
    result_.mesh.triangles = std::move(kept_);
  }

  void find_components() {
    MeshReport& report = result_.report;
    const std::vector<Corners>& triangles = result_.mesh.triangles;
    UnionFind components(triangles.size());
    std::vector<bool> is_open(triangles.size());
    for (std::size_t begin = 0, end = 0; begin < edges_.size(); begin = end) {
      while (end < edges_.size() && edges_[end].ends == edges_[begin].ends) ++end;
      report.edges_of_one += end - begin == 1;
      report.edges_of_many += end - begin > 2;
      for (std::size_t k = begin; k < end; ++k) {
        components.unite(edges_[begin].triangle, edges_[k].triangle);
        if (end - begin != 2) is_open[edges_[k].triangle] = true;
      }
    }
    std::vector<bool> has_open(triangles.size());
    for (std::uint32_t t = 0; t < triangles.size(); ++t) {
      if (is_open[t]) has_open[components.root(t)] = true;
    }
    for (std::uint32_t t = 0; t < triangles.size(); ++t) {
      if (components.root(t) == t) ++(has_open[t] ? report.open_components : report.closed_components);
    }
  }

  void find_box() {
    MeshReport& report = result_.report;
    report.lower = report.upper = result_.mesh.vertices.front();
    for (const Vertex& vertex : result_.mesh.vertices) {
      for (std::size_t k = 0; k < 3; ++k) {
        report.lower[k] = std::min(report.lower[k], vertex[k]);
        report.upper[k] = std::max(report.upper[k], vertex[k]);
      }
    }
  }

  const PolygonSoup& soup_;
  std::vector<Corners> corners_;  ///< of all triangles; first of the soup's points, then of vertices_
  std::vector<Vertex> vertices_;
  std::vector<Corners> kept_;
  std::vector<EdgeOfTriangle> edges_;  ///< of kept_
  LoadedMesh result_;
};

}  // namespace

std::string extension_of(const std::string& name) {
  std::string extension = std::filesystem::path(name).extension().string();
  std::ranges::transform(extension, extension.begin(),
                         [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
  return extension;
}

bool is_mesh_name(const std::string& name) {
  const std::string extension = extension_of(name);
  return extension == ".stl" || extension == ".obj" || extension == ".ply";
}

std::string mesh_bytes(const std::filesystem::path& path) {
  errno = 0;
  std::ifstream file(path, std::ios::binary);
  std::string content;
  constexpr std::size_t kPiece = 1 << 20;
  for (std::size_t size = 0; file; content.resize(size)) {
    content.resize(size + kPiece);
    file.read(content.data() + size, kPiece);
    size += static_cast<std::size_t>(file.gcount());
    if (size > kMostMeshBytes) fail(fmt::format("expected a mesh of at most {} MB", kMostMeshBytes >> 20));
  }
  if (!file.eof()) {
    fail(fmt::format("which could not be read: {}", errno != 0 ? std::strerror(errno) : "no reason is known"));
  }
  return content;
}

PolygonSoup read_polygons(const std::string& extension, const std::string& bytes) {
  std::vector<CgalPoint> points;
  PolygonSoup soup;
  if (!read_by_cgal(extension, bytes, points, soup.faces)) {
    fail(fmt::format("which is no whole {} file, expected a mesh", extension.substr(1)));
  }
  soup.points.reserve(points.size());
  for (const CgalPoint& p : points) soup.points.push_back({p.x(), p.y(), p.z()});
  return soup;
}

LoadedMesh repaired(const PolygonSoup& soup) { return Repair(soup).run(); }

LoadedMesh load_mesh(const std::filesystem::path& path) {
  const std::string bytes = mesh_bytes(path);
  Sha256 digest;
  digest.update(bytes);
  LoadedMesh result = repaired(read_polygons(extension_of(path.string()), bytes));
  result.sha256 = digest.hex();
  return result;
}

}  // namespace taut
