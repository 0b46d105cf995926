// SPDX-License-Identifier: GPL-3.0-or-later
#include "atlas/polytope.h"

#include <algorithm>
#include <cmath>
#include <cstdint>

#include "atlas/bytes.h"

namespace taut {
namespace {

// A vertex that a cut would move by less than this fraction of the cube's half side counts as lying on the cut.
constexpr double kOnTheCut = 1e-12;

// One end of an edge to be made in the new facet. The edge lies in a 2-face that the cut crosses; `face` identifies it.
struct OpenEnd {
  std::uint64_t face;
  int vertex;
  int slot;
};

// Buffers of clip(), kept between calls.
struct Scratch {
  std::vector<double> excess;
  std::vector<int> outside;
  std::vector<Polytope::Vertex> fresh;
  std::vector<OpenEnd> ends;
};
thread_local Scratch scratch;

// Hashes a facet's name to 64 bits (the finaliser of splitmix64), so that sums of a few hashes identify sets of facets.
std::uint64_t scatter(int facet) {
  std::uint64_t z = (std::uint64_t{std::uint32_t(facet)} + 1) * 0x9e3779b97f4a7c15u;
  z = (z ^ (z >> 30)) * 0xbf58476d1ce4e5b9u;
  z = (z ^ (z >> 27)) * 0x94d049bb133111ebu;
  return z ^ (z >> 31);
}

int slot_of(const std::array<int, Polytope::kMaxDimension>& values, int value) {
  return static_cast<int>(std::find(values.begin(), values.end(), value) - values.begin());
}

double squared_norm(const Polytope::Vertex& vertex, int dimension) {
  double sum = 0;
  for (int k = 0; k < dimension; ++k) sum += vertex.position[k] * vertex.position[k];
  return sum;
}

// Index of the new vertex f: that of a removed vertex, or one behind the `count` old ones.
int place_of(int f, int count) {
  const int removed = static_cast<int>(scratch.outside.size());
  return f < removed ? scratch.outside[f] : count + f - removed;
}

// New vertices on all edges that the cut crosses, into the scratch.
void cut_edges(std::vector<Polytope::Vertex>& vertices, int dimension, double tolerance, int facet) {
  const std::vector<double>& excess = scratch.excess;
  std::vector<Polytope::Vertex>& fresh = scratch.fresh;
  const int count = static_cast<int>(vertices.size());
  fresh.clear();
  for (const int v : scratch.outside) {
    for (int k = 0; k < dimension; ++k) {
      const int w = vertices[v].neighbours[k];
      if (excess[w] > tolerance) continue;
      const double t = std::min(1.0, std::max(0.0, -excess[w] / (excess[v] - excess[w])));  // w + t (v - w)
      Polytope::Vertex vertex = vertices[v];
      vertex.marked = false;
      for (int j = 0; j < dimension; ++j) {
        const double at_w = vertices[w].position[j];
        vertex.position[j] = at_w + t * (vertex.position[j] - at_w);
      }
      vertex.squared_norm = squared_norm(vertex, dimension);
      vertex.facets[k] = facet;  // the edge to w is the one that leaves it
      const int place = place_of(static_cast<int>(fresh.size()), count);
      fresh.push_back(vertex);
      // w's edges inside the cut still name vertices of the old polytope: negative until all are found.
      Polytope::Vertex& inside = vertices[w];
      inside.neighbours[slot_of(inside.neighbours, v)] = -1 - place;
    }
  }
  for (const Polytope::Vertex& vertex : fresh) {
    const int k = slot_of(vertex.facets, facet);
    Polytope::Vertex& inside = vertices[vertex.neighbours[k]];
    for (int j = 0; j < dimension; ++j) {
      if (inside.neighbours[j] < 0) inside.neighbours[j] = -1 - inside.neighbours[j];
    }
  }
}

// Edges within the new facet: the two new vertices on the same 2-face of the old polytope.
void join_in_facet(int facet, int dimension, int count) {
  std::vector<Polytope::Vertex>& fresh = scratch.fresh;
  std::vector<OpenEnd>& ends = scratch.ends;
  ends.clear();
  for (int f = 0; f < static_cast<int>(fresh.size()); ++f) {
    const auto& facets = fresh[f].facets;
    std::uint64_t all = 0;
    for (int k = 0; k < dimension; ++k) all += scatter(facets[k]);
    for (int slot = 0; slot < dimension; ++slot) {
      if (facets[slot] != facet) ends.push_back({all - scatter(facets[slot]), f, slot});
    }
  }
  std::sort(ends.begin(), ends.end(), [](const OpenEnd& a, const OpenEnd& b) {
    return a.face != b.face ? a.face < b.face : a.vertex < b.vertex;
  });
  for (std::size_t e = 0; e + 1 < ends.size(); e += 2) {
    fresh[ends[e].vertex].neighbours[ends[e].slot] = place_of(ends[e + 1].vertex, count);
    fresh[ends[e + 1].vertex].neighbours[ends[e + 1].slot] = place_of(ends[e].vertex, count);
  }
}

// Puts the new vertices in the places of those outside, and moves the last ones to places that are left open.
void replace_vertices(std::vector<Polytope::Vertex>& vertices, int dimension) {
  const std::vector<int>& outside = scratch.outside;
  const std::vector<Polytope::Vertex>& fresh = scratch.fresh;
  const int count = static_cast<int>(vertices.size());
  for (int f = 0; f < static_cast<int>(fresh.size()); ++f) {
    const int place = place_of(f, count);
    if (place < count) {
      vertices[place] = fresh[f];
    } else {
      vertices.push_back(fresh[f]);
    }
  }
  // Fewer new vertices than removed ones: fill each hole with the last vertex.
  for (int hole = static_cast<int>(outside.size()) - 1; hole >= static_cast<int>(fresh.size()); --hole) {
    const int from = static_cast<int>(vertices.size()) - 1;
    const int to = outside[hole];
    if (to != from) {
      vertices[to] = vertices[from];
      for (int k = 0; k < dimension; ++k) {
        Polytope::Vertex& neighbour = vertices[vertices[to].neighbours[k]];
        neighbour.neighbours[slot_of(neighbour.neighbours, from)] = to;
      }
    }
    vertices.pop_back();
  }
}

}  // namespace

Polytope::Polytope(int dimension, double half_side) : dimension_(dimension), half_side_(half_side) {
  vertices_.resize(std::size_t{1} << dimension);
  for (int v = 0; v < static_cast<int>(vertices_.size()); ++v) {
    Vertex& vertex = vertices_[v];
    for (int k = 0; k < dimension; ++k) {
      const int upper = (v >> k) & 1;
      vertex.position[k] = upper ? half_side : -half_side;
      vertex.facets[k] = -1 - 2 * k - upper;
      vertex.neighbours[k] = v ^ (1 << k);
    }
    vertex.squared_norm = squared_norm(vertex, dimension);
  }
  measure();
}

void Polytope::measure() {
  double largest = 0;
  for (const Vertex& vertex : vertices_) largest = std::max(largest, vertex.squared_norm);
  circumradius_ = std::sqrt(largest);
}

bool Polytope::clip(const TangentVector& normal, double offset, int facet) {
  const int count = static_cast<int>(vertices_.size());
  const double length = normal.norm();
  if (offset >= circumradius_ * length) return false;
  const double tolerance = kOnTheCut * half_side_ * length;
  scratch.outside.clear();
  scratch.excess.resize(vertices_.size());
  for (int v = 0; v < count; ++v) {
    double value = -offset;
    for (int k = 0; k < dimension_; ++k) value += normal[k] * vertices_[v].position[k];
    scratch.excess[v] = value;
    if (value > tolerance) scratch.outside.push_back(v);
  }
  if (scratch.outside.empty()) return false;
  cut_edges(vertices_, dimension_, tolerance, facet);
  join_in_facet(facet, dimension_, count);
  replace_vertices(vertices_, dimension_);
  measure();
  return true;
}

TangentVector Polytope::corner(int vertex) const {
  return Eigen::Map<const TangentVector>(vertices_[vertex].position.data(), dimension_);
}

std::vector<int> Polytope::cutting_facets() const {
  std::vector<int> result;
  for (const Vertex& vertex : vertices_) {
    for (int k = 0; k < dimension_; ++k) {
      if (vertex.facets[k] >= 0) result.push_back(vertex.facets[k]);
    }
  }
  std::sort(result.begin(), result.end());
  result.erase(std::unique(result.begin(), result.end()), result.end());
  return result;
}

bool Polytope::has_facet(int facet) const {
  for (const Vertex& vertex : vertices_) {
    for (int k = 0; k < dimension_; ++k) {
      if (vertex.facets[k] == facet) return true;
    }
  }
  return false;
}

// ---- Bytes: half_side, then for each vertex position, facets, neighbours, marked
// ---------------------------------------

namespace {

std::size_t vertex_bytes(std::size_t n) { return n * (sizeof(double) + 2 * sizeof(int)) + sizeof(int); }

}  // namespace

void Polytope::append_bytes(std::string& bytes) const {
  const auto n = static_cast<std::size_t>(dimension_);
  append_values(bytes, &half_side_, 1);
  for (const Vertex& vertex : vertices_) {
    const int marked = vertex.marked ? 1 : 0;
    append_values(bytes, vertex.position.data(), n);
    append_values(bytes, vertex.facets.data(), n);
    append_values(bytes, vertex.neighbours.data(), n);
    append_values(bytes, &marked, 1);
  }
}

std::optional<Polytope> Polytope::from_bytes(int dimension, std::span<const std::byte> bytes, int facet_end) {
  const auto n = static_cast<std::size_t>(dimension);
  double half_side = 0;
  if (bytes.size() < sizeof half_side) return {};
  take_values(bytes, &half_side, 1);
  if (!(half_side > 0 && std::isfinite(half_side)) || bytes.empty() || bytes.size() % vertex_bytes(n) != 0) return {};
  Polytope result(dimension, half_side);
  result.vertices_.assign(bytes.size() / vertex_bytes(n), {});
  for (Vertex& vertex : result.vertices_) {
    int marked = 0;
    take_values(bytes, vertex.position.data(), n);
    take_values(bytes, vertex.facets.data(), n);
    take_values(bytes, vertex.neighbours.data(), n);
    take_values(bytes, &marked, 1);
    vertex.marked = marked != 0;
    vertex.squared_norm = squared_norm(vertex, dimension);
  }
  if (!result.is_simple(facet_end)) return {};
  result.measure();
  return result;
}

// The invariant that keeps clip() within its arrays: each edge leads to a vertex that lies on all the same facets
// except the one that the edge leaves, and leads back. Then the two ends of each edge lie on different sets of facets,
// no two edges join the same vertices, and the vertices of a 2-face form cycles, which any cut crosses an even number
// of times.
bool Polytope::is_simple(int facet_end) const {
  const int n = dimension_;
  const int count = static_cast<int>(vertices_.size());
  const auto within = [n](const std::array<int, kMaxDimension>& values, int value) {
    return slot_of(values, value) < n;
  };
  for (int v = 0; v < count; ++v) {
    const Vertex& vertex = vertices_[v];
    for (int k = 0; k < n; ++k) {
      const int facet = vertex.facets[k];
      if (facet < -2 * n || facet >= facet_end || slot_of(vertex.facets, facet) != k) return false;
      if (!(std::abs(vertex.position[k]) <= half_side_ * (1 + 1e-9))) return false;
      if (vertex.neighbours[k] < 0 || vertex.neighbours[k] >= count) return false;
      const Vertex& other = vertices_[vertex.neighbours[k]];
      const int back = slot_of(other.neighbours, v);
      if (back >= n || within(vertex.facets, other.facets[back])) return false;
      for (int j = 0; j < n; ++j) {
        if (j != k && !within(other.facets, vertex.facets[j])) return false;
      }
    }
  }
  return true;
}

}  // namespace taut
