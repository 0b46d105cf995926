// SPDX-License-Identifier: GPL-3.0-or-later
#include "case/mesh_file.h"

#include <CGAL/IO/OBJ.h>
#include <CGAL/IO/STL.h>
#include <CGAL/Simple_cartesian.h>
#include <fmt/format.h>

#include <algorithm>
#include <bit>
#include <cctype>
#include <cerrno>
#include <charconv>
#include <cmath>
#include <cstring>
#include <fstream>
#include <numeric>
#include <set>
#include <sstream>
#include <string_view>
#include <unordered_map>

#include "base/input_error.h"
#include "base/sanitize.h"
#include "base/sha256.h"
#include "case/ply_file.h"
#include "problem/rational.h"

namespace taut {
namespace {

[[noreturn]] void fail(const std::string& message) { throw InputError(ErrorCode::kCase, message); }

// --- Files -------------------------------------------------------------------------------------------------------
//
// CGAL reads STL and OBJ files, but leaves out without a word what it does not know. What would be lost is refused.

constexpr std::size_t kStlHead = 84;   ///< of a binary STL file, with the count of triangles in its last 4 bytes
constexpr std::size_t kStlPiece = 50;  ///< a triangle: normal, corners, two bytes

bool is_space(char c) { return std::isspace(static_cast<unsigned char>(c)) != 0; }

/// A binary file has a zero in its count: no file is large enough for 2^24 triangles.
bool is_text_stl(const std::string& bytes) {
  constexpr std::string_view kSolid = "solid";
  return bytes.starts_with(kSolid) && bytes.size() > kSolid.size() && is_space(bytes[kSolid.size()]) &&
         bytes.find("facet") != std::string::npos && bytes.find('\0') == std::string::npos;
}

std::uint32_t little_endian(const std::string& bytes, std::size_t at) {
  std::uint32_t number = 0;
  for (std::size_t i = 0; i < 4; ++i) {
    number |= static_cast<std::uint32_t>(static_cast<unsigned char>(bytes[at + i])) << (8 * i);
  }
  return number;
}

/// A binary STL file says how many triangles follow; CGAL would make room for as many as it says.
bool is_not_whole_stl(const std::string& bytes) {
  if (is_text_stl(bytes)) return false;
  if (bytes.size() < kStlHead) return true;
  return bytes.size() != kStlHead + kStlPiece * static_cast<std::size_t>(little_endian(bytes, kStlHead - 4));
}

/// CGAL takes a point that is no number for one that it has read before. @pre !is_not_whole_stl
void require_numbers(const std::string& bytes) {
  const std::size_t count = little_endian(bytes, kStlHead - 4);
  for (std::size_t t = 0; t < count; ++t) {
    for (std::size_t k = 3; k < 12; ++k) {
      if (std::isfinite(std::bit_cast<float>(little_endian(bytes, kStlHead + kStlPiece * t + 4 * k)))) continue;
      fail(fmt::format("in which a coordinate of triangle {} is no number, expected a mesh", t + 1));
    }
  }
}

std::string lower_case(std::string text) {
  std::ranges::transform(text, text.begin(), [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
  return text;
}

std::size_t count_words(const std::string& bytes, const std::string& word) {
  std::istringstream stream(bytes);
  std::size_t count = 0;
  for (std::string each; stream >> each;) count += lower_case(each) == word;
  return count;
}

/// Whether a word of a face in an OBJ file is a corner: "3", "-1", "3/1/2", "3//2". CGAL takes 0 for the point that
/// follows, leaves out the rest of a face behind a number that is too large for it, and reads on within a long word.
bool is_corner(std::string_view word) {
  constexpr std::size_t kMostDigits = 9;
  constexpr std::size_t kMostLetters = 100;
  const std::string_view index = word.substr(word.starts_with('-') ? 1 : 0, word.find('/') - word.starts_with('-'));
  return !index.empty() && index.size() <= kMostDigits && word.size() <= kMostLetters &&
         index.find_first_not_of("0123456789") == std::string_view::npos &&
         index.find_first_not_of('0') != std::string_view::npos &&
         word.find_first_not_of("-0123456789/") == std::string_view::npos;
}

/// CGAL takes the 1 of "1,5" or "1mm" for a number. What is too large for one is left to it.
bool is_number(std::string_view word) {
  if (word.starts_with('+')) word.remove_prefix(1);
  double value = 0;
  const auto [end, error] = std::from_chars(word.data(), word.data() + word.size(), value);
  return error != std::errc::invalid_argument && end == word.data() + word.size() && std::isfinite(value);
}

/// Three coordinates, maybe with a colour, or with a weight of 1: CGAL does not divide by it.
bool is_point(const std::vector<std::string>& words) {
  if (!std::ranges::all_of(words, is_number)) return false;
  if (words.size() == 4) {
    const std::string& weight = words.back();
    return weight == "1" || (weight.starts_with("1.") && weight.find_first_not_of('0', 2) == std::string::npos);
  }
  return words.size() == 3 || words.size() == 6;
}

/// Refuses text in which a coordinate of a corner is followed by anything but a blank.
void require_plain_corners(const std::string& text) {
  std::istringstream words(text);
  std::string word;
  while (words >> word) {
    if (word != "vertex") continue;
    for (std::size_t k = 0; k < 3 && words >> word; ++k) {
      if (!is_number(word)) fail(fmt::format("in which '{}' is no number, expected a mesh", excerpt(word)));
    }
  }
}

std::string missing_corner(std::size_t line, long corner, long points) {
  return fmt::format("in which line {} has the corner {} of {} points, expected a mesh", line, corner, points);
}

/// Refuses points and faces with words that are no numbers and no corners, behind which CGAL leaves out the rest, and
/// surfaces of other kinds, and corners that no point of the file is.
void require_plain_lines(const std::string& bytes) {
  std::istringstream lines(bytes);
  std::size_t number = 0;
  long points = 0;
  struct {
    long corner = 0;
    std::size_t line = 0;
  } farthest;
  for (std::string line; std::getline(lines, line);) {
    ++number;
    std::istringstream words(line);
    std::string word;
    if (!(words >> word)) continue;
    for (const char* curved : {"surf", "bsp", "bzp", "cdc", "cdp"}) {
      if (word == curved) fail(fmt::format("which has a curved surface in line {}, expected a mesh", number));
    }
    if (word != "f" && word != "v") continue;
    const bool is_face = word == "f";
    std::vector<std::string> parts;
    while (words >> word && !word.starts_with('#')) parts.push_back(word);
    if (!(is_face ? std::ranges::all_of(parts, is_corner) : is_point(parts))) {
      fail(fmt::format("in which line {} is no {}, expected a mesh", number, is_face ? "face" : "point"));
    }
    if (!is_face) {
      ++points;
      continue;
    }
    for (const std::string& part : parts) {
      const long corner = std::stol(part);  // up to the slash
      if (corner > farthest.corner) farthest = {corner, number};
      if (corner < -points) fail(missing_corner(number, corner, points));
    }
  }
  if (farthest.corner > points) fail(missing_corner(farthest.line, farthest.corner, points));
}

using CgalPoint = CGAL::Simple_cartesian<double>::Point_3;

/// Refuses a file of which CGAL would lose a part, or would crash. @pre it is not cut, if it is a binary STL file
void require_plain(const std::string& extension, const std::string& bytes) {
  if (extension == ".obj") {
    require_plain_lines(bytes);
  } else if (is_text_stl(bytes)) {
    require_plain_corners(bytes);
  } else {
    require_numbers(bytes);
  }
}

/// The same file as CGAL needs it. Of blanks it knows but some in some places, and of ends of lines one; of an STL file
/// it guesses the kind from the first word.
std::string as_cgal_needs_it(const std::string& extension, std::string bytes) {
  if (extension == ".stl" && !is_text_stl(bytes)) {
    std::fill_n(bytes.begin(), std::min(bytes.size(), kStlHead - 4), '\0');
    return bytes;
  }
  for (std::size_t i = 0; i < bytes.size(); ++i) {
    const bool ends_line = bytes[i] == '\n' || (bytes[i] == '\r' && bytes.compare(i, 2, "\r\n") != 0);
    if (is_space(bytes[i])) bytes[i] = ends_line ? '\n' : ' ';
  }
  return bytes;
}

bool read_by_cgal(const std::string& extension, const std::string& bytes, std::vector<CgalPoint>& points,
                  std::vector<std::vector<std::size_t>>& faces) {
  std::istringstream stream(bytes, std::ios::binary);
  const auto quietly = CGAL::parameters::verbose(false);
  try {
    if (extension == ".obj") return CGAL::IO::read_OBJ(stream, points, faces, quietly);
    if (!CGAL::IO::read_STL(stream, points, faces, quietly)) return false;
    return is_text_stl(bytes) ? count_words(bytes, "vertex") == 3 * faces.size()
                              : little_endian(bytes, kStlHead - 4) == faces.size();
  } catch (const std::exception&) {  // of a file that promises what it does not hold
    return false;
  }
}

/// Reads a whole file. False if it is none.
bool read_file(const std::string& extension, const std::string& bytes, std::vector<CgalPoint>& points,
               std::vector<std::vector<std::size_t>>& faces) {
  if (extension == ".stl" && is_not_whole_stl(bytes)) return false;
  require_plain(extension, bytes);
  return read_by_cgal(extension, bytes, points, faces);
}

// --- Repair ------------------------------------------------------------------------------------------------------

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
        if (i >= soup_.points.size()) fail("in which a face has a corner that is missing, expected a mesh");
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
  return lower_case(std::filesystem::path(name).extension().string());
}

bool is_mesh_name(const std::string& name) {
  const std::string extension = extension_of(name);
  return extension == ".stl" || extension == ".obj" || extension == ".ply";
}

std::string mesh_bytes(const std::filesystem::path& path) {
  std::error_code ignored;
  // A pipe gives its bytes once, and they are read again to be kept beside the certificate.
  if (std::filesystem::exists(path, ignored) && !std::filesystem::is_regular_file(path, ignored)) {
    fail("which is no regular file, expected one");
  }
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
  if (extension == ".ply") return read_ply(bytes);
  std::vector<CgalPoint> points;
  PolygonSoup soup;
  if (!read_file(extension, as_cgal_needs_it(extension, bytes), points, soup.faces)) {
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
