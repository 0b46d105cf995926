// SPDX-License-Identifier: GPL-3.0-or-later
#include "tests/atlas/topology.h"

#include <Eigen/LU>
#include <algorithm>
#include <cmath>
#include <set>
#include <stdexcept>
#include <utility>
#include <vector>

namespace taut {
namespace {

void require_surface(const Atlas& atlas) {
  if (atlas.manifold().dimension() != 2) throw std::invalid_argument("topology: the manifold is not a surface");
}

double cross(const Eigen::Vector2d& a, const Eigen::Vector2d& b) { return a.x() * b.y() - a.y() * b.x(); }

// A side of a polygon, going round counter-clockwise in the chart's own frame.
struct Side {
  int facet;
  Eigen::Vector2d begin;
  Eigen::Vector2d end;
};

std::vector<Side> polygon(const Chart& chart) {
  const auto& vertices = std::get<Polytope>(chart.polytope).vertices();
  const auto at = [&](int v) { return Eigen::Vector2d(vertices[v].position[0], vertices[v].position[1]); };
  std::vector<Side> sides;
  double twice_area = 0;
  int from = 0;
  int leaving = 0;  // slot of the facet that the next side is not on
  do {
    const int to = vertices[from].neighbours[leaving];
    const int facet = vertices[from].facets[1 - leaving];
    sides.push_back({facet, at(from), at(to)});
    twice_area += cross(at(from), at(to));
    leaving = vertices[to].facets[0] == facet ? 0 : 1;
    from = to;
  } while (from != 0);
  if (twice_area < 0) {
    std::reverse(sides.begin(), sides.end());
    for (Side& side : sides) std::swap(side.begin, side.end);
  }
  return sides;
}

double distance_to_origin(const Side& side) {
  const Eigen::Vector2d along = side.end - side.begin;
  const double length = along.squaredNorm();
  const double t = length > 0 ? std::clamp(-side.begin.dot(along) / length, 0.0, 1.0) : 0.0;
  return (side.begin + t * along).norm();
}

// A chart's edges in cyclic order.
struct Edge {
  int to;
  bool agrees;        // the two frames have the same orientation
  bool gap_after;     // between this edge and the next lies a corner outside the ball
  bool seen[2] = {};  // traced with the corner after it to the left (1), or the one before it (0)
};
using Rotation = std::vector<Edge>;

int find(const Rotation& rotation, int to) {
  const auto it = std::find_if(rotation.begin(), rotation.end(), [to](const Edge& edge) { return edge.to == to; });
  return it == rotation.end() ? -1 : static_cast<int>(it - rotation.begin());
}

bool orientations_agree(const Frame& a, const Frame& b) {
  return (a.tangent().transpose() * b.tangent()).determinant() > 0;
}

void drop(Rotation& rotation, int to) {
  const int e = find(rotation, to);
  if (rotation[e].gap_after) rotation[(e + rotation.size() - 1) % rotation.size()].gap_after = true;
  rotation.erase(rotation.begin() + e);
}

// The edges between charts that bound each other within their balls. Both charts should say so; in near-ties only one
// may, and then there is no edge.
std::vector<Rotation> mutual_rotations(const Atlas& atlas) {
  std::vector<std::vector<Side>> polygons;
  std::set<std::pair<int, int>> claims;
  for (int id = 0; id < atlas.size(); ++id) {
    const Chart& chart = atlas.chart(id);
    polygons.push_back(polygon(chart));
    for (const Side& side : polygons.back()) {
      if (side.facet >= 0 && chart.covers(distance_to_origin(side))) claims.emplace(id, side.facet);
    }
  }
  std::vector<Rotation> rotations(atlas.size());
  for (int id = 0; id < atlas.size(); ++id) {
    const Chart& chart = atlas.chart(id);
    Rotation& rotation = rotations[id];
    bool gap_before_first = false;
    for (const Side& side : polygons[id]) {
      if (claims.contains({id, side.facet}) && claims.contains({side.facet, id})) {
        rotation.push_back({side.facet, orientations_agree(chart.frame, atlas.chart(side.facet).frame), false});
      }
      (rotation.empty() ? gap_before_first : rotation.back().gap_after) |= !chart.covers(side.end.norm());
    }
    if (!rotation.empty()) rotation.back().gap_after |= gap_before_first;
  }
  return rotations;
}

// Edges b-x from b into the triangle a b c, where b comes right before c around a; they cross the edge a-c.
// `mirrored`: b's frame has the other orientation.
std::vector<int> edges_into_triangle(const Rotation& b, int a, int c, bool mirrored) {
  std::vector<int> result;
  const int count = static_cast<int>(b.size());
  const int from = find(b, mirrored ? a : c);
  const int to = find(b, mirrored ? c : a);
  for (int e = (from + 1) % count; e != to; e = (e + 1) % count) result.push_back(b[e].to);
  return result;
}

// If four charts nearly share one corner, both pairs of opposite charts may claim to touch. Of two such crossing edges
// the longer is dropped, which leaves two triangles.
bool drop_one_crossing(const Atlas& atlas, std::vector<Rotation>& rotations, int a) {
  const auto length = [&](int i, int j) {
    return (atlas.chart(i).frame.point() - atlas.chart(j).frame.point()).squaredNorm();
  };
  const Rotation& around = rotations[a];
  for (std::size_t e = 0; e < around.size(); ++e) {
    const Edge& first = around[e];
    const Edge& second = around[(e + 1) % around.size()];
    if (first.gap_after || find(rotations[first.to], second.to) < 0) continue;
    for (const bool at_second : {false, true}) {  // seen in a mirror, the second comes right before the first
      const Edge& b = at_second ? second : first;
      const int c = at_second ? first.to : second.to;
      const std::vector<int> crossing = edges_into_triangle(rotations[b.to], a, c, b.agrees == at_second);
      if (crossing.empty()) continue;
      const bool own_is_longer = length(a, c) > length(b.to, crossing.front());
      const std::pair<int, int> ends = own_is_longer ? std::pair(a, c) : std::pair(b.to, crossing.front());
      drop(rotations[ends.first], ends.second);
      drop(rotations[ends.second], ends.first);
      return true;
    }
  }
  return false;
}

std::vector<Rotation> rotation_system(const Atlas& atlas) {
  std::vector<Rotation> rotations = mutual_rotations(atlas);
  for (bool changed = true; changed;) {
    changed = false;
    for (int id = 0; id < atlas.size(); ++id) {
      while (drop_one_crossing(atlas, rotations, id)) changed = true;
    }
  }
  return rotations;
}

}  // namespace

int euler_characteristic(const Atlas& atlas) {
  require_surface(atlas);
  std::vector<Rotation> rotations = rotation_system(atlas);
  int half_edges = 0;
  int faces = 0;
  for (int first = 0; first < atlas.size(); ++first) {
    half_edges += static_cast<int>(rotations[first].size());
    for (int first_edge = 0; first_edge < static_cast<int>(rotations[first].size()); ++first_edge) {
      // Each face is met with its corners to the left of the edge, and again, mirrored, to the right.
      for (const int first_side : {0, 1}) {
        int at = first;
        int edge = first_edge;
        int side = first_side;
        bool filled = !rotations[at][edge].seen[side];
        while (!rotations[at][edge].seen[side]) {
          rotations[at][edge].seen[side] = true;
          const int to = rotations[at][edge].to;
          if (!rotations[at][edge].agrees) side = 1 - side;
          const Rotation& there = rotations[to];
          const int count = static_cast<int>(there.size());
          const int arrived = find(there, at);
          // With the face to the left (side 0) the next edge is the one before, clockwise; mirrored, the one after.
          const int next = side == 0 ? (arrived + count - 1) % count : (arrived + 1) % count;
          if (there[side == 0 ? next : arrived].gap_after) filled = false;
          at = to;
          edge = next;
        }
        if (filled) ++faces;
      }
    }
  }
  return atlas.size() - half_edges / 2 + faces / 2;
}

namespace {

// Area between the origin, the segment from a to b, and cut by the circle of the given radius; signed.
double sector_area(const Eigen::Vector2d& a, const Eigen::Vector2d& b, double radius) {
  const auto sector = [&](const Eigen::Vector2d& p, const Eigen::Vector2d& q) {
    return radius * radius * std::atan2(cross(p, q), p.dot(q)) / 2;
  };
  const Eigen::Vector2d along = b - a;
  const double aa = along.squaredNorm();
  if (aa == 0) return 0;
  const double half_b = a.dot(along) / aa;
  const double discriminant = half_b * half_b - (a.squaredNorm() - radius * radius) / aa;
  if (discriminant <= 0) return sector(a, b);
  const double enter = std::clamp(-half_b - std::sqrt(discriminant), 0.0, 1.0);
  const double leave = std::clamp(-half_b + std::sqrt(discriminant), 0.0, 1.0);
  const Eigen::Vector2d p = a + enter * along;
  const Eigen::Vector2d q = a + leave * along;
  return sector(a, p) + cross(p, q) / 2 + sector(q, b);
}

}  // namespace

double area(const Atlas& atlas) {
  require_surface(atlas);
  double total = 0;
  for (int id = 0; id < atlas.size(); ++id) {
    const Chart& chart = atlas.chart(id);
    for (const Side& side : polygon(chart)) total += sector_area(side.begin, side.end, chart.radius);
  }
  return total;
}

}  // namespace taut
