// SPDX-License-Identifier: GPL-3.0-or-later
// The bodies of a problem at one pose, in double and in 200 bits, and their distances by features: the least over all
// pairs of a vertex and a triangle, two segments, and so on, of the points of two hulls. None of kinematics/ or
// certify/bodies/, no search along directions.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <optional>
#include <span>
#include <string>
#include <utility>
#include <variant>
#include <vector>

#include "tests/soundness/machine.h"
#include "tests/soundness/overlap.h"

namespace taut::campaign {

/// All points within a radius of a convex hull; or a half-space.
template <class S>
struct Solid {
  std::vector<Vec<S>> points;
  S radius{};
  bool is_half_space = false;
  Vec<S> normal{};
  S offset{};
};
template <class S>
using SolidPair = std::array<Solid<S>, 2>;

/// Two bodies that are checked, found by the rules of docs/case-format.md, without pairs().
struct ScenePair {
  PairClass kind;
  std::size_t first, second;
  DecimalText clearance;
  std::vector<ContactZoneText> zones = {};
  std::optional<ExitConeText> cone = {};  ///< of an exit cone, in place of the second body

  /// Whether its distance may be below 0.
  [[nodiscard]] bool is_signed() const { return !zones.empty() || cone; }
};

/// From the cable's anchor at an exit cone's end to its other one, in the cone's axes.
template <class S>
Vec<S> out_of_end(const ScenePair& pair, const Machine<S>& machine, const RigidPose<S>& pose) {
  const Vec<S> d = pose.p + pose.r * machine.b[pair.first] - machine.a[pair.first];
  if (pair.cone->end == CableEnd::kBase) return d;
  Vec<S> turned;
  for (std::size_t k = 0; k < 3; ++k) {
    turned[k] = -(pose.r[0][k] * d[0] + pose.r[1][k] * d[1] + pose.r[2][k] * d[2]);
  }
  return turned;
}

/// Between that and the cone's axis, from half of it: of unit vectors, |u − v| is 2 sin(t/2), and |u + v| 2 cos(t/2).
template <class S>
S angle_in_cone(const ScenePair& pair, const Machine<S>& machine, const RigidPose<S>& pose) {
  const auto unit = [](const Vec<S>& x) { return (S(1.0) / root(dot(x, x))) * x; };
  const auto& axis = pair.cone->axis;
  const Vec<S> u = unit(out_of_end(pair, machine, pose));
  const Vec<S> v = unit(Vec<S>{number<S>(axis[0]), number<S>(axis[1]), number<S>(axis[2])});
  const Vec<S> less = u - v, more = u + v;
  return S(2.0) * angle(root(dot(less, less)), root(dot(more, more)));
}

template <class S>
S distance_in_cone(const ScenePair& pair, const Machine<S>& machine, const RigidPose<S>& pose) {
  const Vec<S> d = out_of_end(pair, machine, pose);
  return root(dot(d, d)) * sine(number<S>(pair.cone->half_angle_rad) - angle_in_cone(pair, machine, pose));
}

inline std::string name_of_first(const BodiesText& bodies, PairClass kind, std::size_t k) {
  return kind == PairClass::kPlatformObstacles ? bodies.platform[k].name : "cable " + std::to_string(k + 1);
}
inline std::string name_of_second(const BodiesText& bodies, PairClass kind, std::size_t k) {
  if (kind == PairClass::kCablesCables) return "cable " + std::to_string(k + 1);
  return kind == PairClass::kCablesPlatform ? bodies.platform[k].name : bodies.obstacles[k].name;
}

inline DecimalText clearance_of(const BodiesText& bodies, PairClass kind, std::size_t first, std::size_t second) {
  const std::string a = name_of_first(bodies, kind, first), b = name_of_second(bodies, kind, second);
  for (const auto& [pair, clearance] : bodies.pair_clearances_m) {
    if ((pair[0] == a && pair[1] == b) || (pair[0] == b && pair[1] == a)) return clearance;
  }
  std::optional<DecimalText> greatest;
  for (const auto* list : {&bodies.platform, &bodies.obstacles}) {
    for (const BodyText& body : *list) {
      if (!body.clearance_m || (body.name != a && body.name != b)) continue;
      if (!greatest || number<BigFloat>(*greatest) < number<BigFloat>(*body.clearance_m)) greatest = body.clearance_m;
    }
  }
  return greatest ? *greatest : *bodies.clearance_m[static_cast<std::size_t>(kind)];
}

inline std::vector<ContactZoneText> zones_of(const BodiesText& bodies, PairClass kind, std::size_t first,
                                             std::size_t second) {
  const std::string a = name_of_first(bodies, kind, first), b = name_of_second(bodies, kind, second);
  std::vector<ContactZoneText> result;
  for (const auto& [pair, zone] : bodies.contacts) {
    if ((pair[0] == a && pair[1] == b) || (pair[0] == b && pair[1] == a)) result.push_back(zone);
  }
  return result;
}

/// What a pair has to be farther apart than, with the platform's origin at p.
template <class S>
S required(const ScenePair& pair, const Vec<S>& p) {
  S result = number<S>(pair.clearance);
  for (const ContactZoneText& zone : pair.zones) {
    const Vec<S> from{p[0] - number<S>(zone.at_m[0]), p[1] - number<S>(zone.at_m[1]), p[2] - number<S>(zone.at_m[2])};
    const S within = number<S>(zone.within_m), depth = number<S>(zone.depth_m);
    if (!(dot(from, from) > within * within) && -depth < result) result = -depth;
  }
  return result;
}

/// In the order in which certificates count them.
inline std::vector<ScenePair> scene_pairs(const BodiesText& bodies) {
  std::vector<ScenePair> result;
  const auto add = [&](PairClass kind, std::size_t first, std::size_t second) {
    if (!bodies.clearance_m[static_cast<std::size_t>(kind)]) return;
    for (std::size_t i = 0; i < first; ++i) {
      for (std::size_t j = kind == PairClass::kCablesCables ? i + 1 : 0; j < second; ++j) {
        result.push_back({kind, i, j, clearance_of(bodies, kind, i, j), zones_of(bodies, kind, i, j)});
      }
    }
  };
  add(PairClass::kPlatformObstacles, bodies.platform.size(), bodies.obstacles.size());
  add(PairClass::kCablesObstacles, kCables, bodies.obstacles.size());
  add(PairClass::kCablesCables, kCables, kCables);
  add(PairClass::kCablesPlatform, kCables, bodies.platform.size());
  for (std::size_t k = 0; k < bodies.exit_cones.size(); ++k) {
    result.push_back({PairClass::kExitCones, bodies.exit_cones[k].cable, k, "0", {}, bodies.exit_cones[k]});
  }
  return result;
}

template <class S>
class Scene {
 public:
  explicit Scene(const BodiesText& bodies) {
    for (const BodyText& body : bodies.platform) platform_.push_back(solid(body));
    for (const BodyText& body : bodies.obstacles) obstacles_.push_back(solid(body));
    for (std::size_t i = 0; i < kCables; ++i) {
      radius_[i] = number<S>(bodies.cables.diameter_m[i]) / S(2.0);
      for (std::size_t end = 0; end < 2; ++end) free_[i][end] = number<S>(bodies.cables.free_ends_m[i][end]);
    }
  }

  /// The distance of a pair, minus how deep its bodies are in each other if that may be so.
  [[nodiscard]] S distance(const ScenePair& pair, const Machine<S>& machine, const RigidPose<S>& pose) const;

  /// Both bodies of a pair, but an exit cone, in W. @pre cables are longer than their free ends
  [[nodiscard]] SolidPair<S> at(const ScenePair& pair, const Machine<S>& machine, const RigidPose<S>& pose) const {
    switch (pair.kind) {
      case PairClass::kPlatformObstacles: return {carried(pair.first, pose), obstacles_[pair.second]};
      case PairClass::kCablesObstacles: return {cable(pair.first, machine, pose), obstacles_[pair.second]};
      case PairClass::kCablesCables: return {cable(pair.first, machine, pose), cable(pair.second, machine, pose)};
      case PairClass::kCablesPlatform:
      case PairClass::kExitCones: break;
    }
    return {cable(pair.first, machine, pose), carried(pair.second, pose)};
  }

 private:
  static Solid<S> solid(const BodyText& body) {
    const auto vector = [](const PointText& x) { return Vec<S>{number<S>(x[0]), number<S>(x[1]), number<S>(x[2])}; };
    const Vec<S> at = vector(body.at_m);
    const S zero(0.0);
    Solid<S> result;
    result.radius = zero;
    if (const auto* half = std::get_if<HalfSpaceText>(&body.shape)) {
      result.is_half_space = true;
      result.normal = vector(half->normal);
      result.offset = dot(result.normal, at);
      return result;
    }
    const auto& hull = std::get<HullText>(body.shape);
    result.radius = number<S>(hull.radius_m);
    const auto angle = [&](std::size_t k) { return number<S>(body.rotation_rad[k]); };
    const Rows<S> r =
        turn(Vec<S>{zero, zero, angle(2)}) * turn(Vec<S>{zero, angle(1), zero}) * turn(Vec<S>{angle(0), zero, zero});
    for (const PointText& x : hull.points_m) result.points.push_back(at + r * vector(x));
    return result;
  }
  [[nodiscard]] Solid<S> carried(std::size_t k, const RigidPose<S>& pose) const {
    Solid<S> result = platform_[k];
    for (Vec<S>& x : result.points) x = pose.p + pose.r * x;
    return result;
  }
  [[nodiscard]] Solid<S> cable(std::size_t i, const Machine<S>& machine, const RigidPose<S>& pose) const {
    const Vec<S> to = pose.p + pose.r * machine.b[i];
    const Vec<S> d = to - machine.a[i];
    const Vec<S> unit = (S(1.0) / root(dot(d, d))) * d;
    Solid<S> result;
    result.points = {machine.a[i] + free_[i][0] * unit, to - free_[i][1] * unit};
    result.radius = radius_[i];
    return result;
  }

  std::vector<Solid<S>> platform_, obstacles_;
  Six<S> radius_;
  std::array<std::array<S, 2>, kCables> free_;
};

// ---- Distances ------------------------------------------------------------------------------------------------------

/// One to three points of either hull.
struct Features {
  std::vector<std::size_t> first, second;
};

/// The shortest vector between the affine hulls of two features, if it ends inside of both: from a point of the second
/// hull to one of the first in any case.
template <class S>
std::optional<Vec<S>> between(const std::vector<Vec<S>>& a, const std::vector<Vec<S>>& b, const Features& f) {
  std::array<Vec<S>, 2> edge;
  std::size_t n = 0;
  for (std::size_t i = 1; i < f.first.size(); ++i) edge[n++] = a[f.first[i]] - a[f.first[0]];
  for (std::size_t j = 1; j < f.second.size(); ++j) edge[n++] = b[f.second[0]] - b[f.second[j]];
  const Vec<S> v = a[f.first[0]] - b[f.second[0]];
  if (n == 0) return v;
  const S zero(0.0), one(1.0);
  const auto is_share = [&](const S& t) { return !(t < zero) && !(t > one); };
  const S ee = dot(edge[0], edge[0]), ev = dot(edge[0], v);
  if (n == 1) {
    if (!(ee > zero)) return std::nullopt;
    const S t = -ev / ee;
    if (!is_share(t)) return std::nullopt;
    return v + t * edge[0];
  }
  const S ff = dot(edge[1], edge[1]), fv = dot(edge[1], v), ef = dot(edge[0], edge[1]);
  const S determinant = ee * ff - ef * ef;
  if (!(determinant > zero)) return std::nullopt;
  const S s = (ef * fv - ff * ev) / determinant, t = (ef * ev - ee * fv) / determinant;
  if (!is_share(s) || !is_share(t)) return std::nullopt;
  const bool is_of_triangle = f.first.size() != f.second.size();
  if (is_of_triangle && s + t > one) return std::nullopt;
  return v + s * edge[0] + t * edge[1];
}

template <class S>
struct NearestFeatures {
  Features features;
  Vec<S> apart{};        ///< from the second to the first
  bool overlap = false;  ///< the plane across `apart` does not part the hulls: they meet
};

/// Visits all features of up to three of so many points.
template <class Visit>
void for_each_feature(std::size_t points, const Visit& visit) {
  for (std::size_t i = 0; i < points; ++i) {
    visit(std::vector<std::size_t>{i});
    for (std::size_t j = i + 1; j < points; ++j) {
      visit(std::vector<std::size_t>{i, j});
      for (std::size_t k = j + 1; k < points; ++k) visit(std::vector<std::size_t>{i, j, k});
    }
  }
}

/// Whether a plane across v, a vector from the one hull's nearest point to the other's, parts them.
template <class S>
bool parts(const Vec<S>& v, const std::vector<Vec<S>>& a, const std::vector<Vec<S>>& b) {
  S low = dot(v, a[0]), high = dot(v, b[0]);
  for (const Vec<S>& x : a) {
    const S here = dot(v, x);
    if (here < low) low = here;
  }
  for (const Vec<S>& x : b) {
    const S here = dot(v, x);
    if (here > high) high = here;
  }
  return !(low - high < S(0.5) * dot(v, v));
}

/// Of hulls that do not meet, a vertex and a face, or two edges, or parts of these, have the nearest points.
template <class S>
NearestFeatures<S> nearest_features(const std::vector<Vec<S>>& a, const std::vector<Vec<S>>& b) {
  NearestFeatures<S> best;
  std::optional<S> least;
  std::vector<std::vector<std::size_t>> of_a, of_b;
  for_each_feature(a.size(), [&](std::vector<std::size_t> f) { of_a.push_back(std::move(f)); });
  for_each_feature(b.size(), [&](std::vector<std::size_t> f) { of_b.push_back(std::move(f)); });
  Features here;
  for (const auto& f : of_a) {
    here.first = f;
    for (const auto& g : of_b) {
      if (f.size() + g.size() > 4) continue;
      here.second = g;
      const auto v = between(a, b, here);
      if (!v) continue;
      const S square = dot(*v, *v);
      if (least && !(square < *least)) continue;
      least = square;
      best.features = here;
      best.apart = *v;
    }
  }
  best.overlap = !parts(best.apart, a, b);
  return best;
}

template <class S>
S height_over(const Solid<S>& solid, const Solid<S>& half_space) {
  const S size = root(dot(half_space.normal, half_space.normal));
  std::optional<S> least;
  for (const Vec<S>& x : solid.points) {
    const S here = (dot(half_space.normal, x) - half_space.offset) / size;
    if (!least || here < *least) least = here;
  }
  return *least - solid.radius;
}

/// The distance of two solids; negative, and no less than minus both radii, where the balls around their points
/// overlap.
template <class S>
S distance_of(const SolidPair<S>& pair) {
  if (pair[1].is_half_space) return height_over(pair[0], pair[1]);
  const NearestFeatures<S> nearest = nearest_features(pair[0].points, pair[1].points);
  const S radii = pair[0].radius + pair[1].radius;
  return nearest.overlap ? -radii : root(dot(nearest.apart, nearest.apart)) - radii;
}

/// The same in 200 bits, from the features that double finds; from all of them where these are not clear. It is the
/// distance of two points of the solids, so not less than theirs.
inline BigFloat distance_of(const SolidPair<BigFloat>& pair, const SolidPair<double>& approx) {
  if (!pair[1].is_half_space) {
    const NearestFeatures<double> nearest = nearest_features(approx[0].points, approx[1].points);
    const auto v = nearest.overlap ? std::nullopt : between(pair[0].points, pair[1].points, nearest.features);
    if (v && parts(*v, pair[0].points, pair[1].points)) return root(dot(*v, *v)) - pair[0].radius - pair[1].radius;
  }
  return distance_of<BigFloat>(pair);
}

/// The same, but minus how deep they are in each other where they overlap.
template <class S>
S signed_distance_of(const SolidPair<S>& pair) {
  if (pair[1].is_half_space) return height_over(pair[0], pair[1]);
  const NearestFeatures<S> nearest = nearest_features(pair[0].points, pair[1].points);
  const S radii = pair[0].radius + pair[1].radius;
  if (nearest.overlap) return -depth_of(pair[0].points, pair[1].points).size - radii;
  return root(dot(nearest.apart, nearest.apart)) - radii;
}

template <class S>
S Scene<S>::distance(const ScenePair& pair, const Machine<S>& machine, const RigidPose<S>& pose) const {
  if (pair.cone) return distance_in_cone(pair, machine, pose);
  const SolidPair<S> solids = at(pair, machine, pose);
  return pair.is_signed() ? signed_distance_of(solids) : distance_of(solids);
}

/// No more than their distance, by balls around them.
inline double rough_distance(const SolidPair<double>& pair) {
  if (pair[1].is_half_space) return height_over(pair[0], pair[1]);
  const auto reach = [](const Solid<double>& solid) {
    double square = 0;
    for (const auto& x : solid.points) square = std::max(square, dot(x - solid.points[0], x - solid.points[0]));
    return std::sqrt(square) + solid.radius;
  };
  const Vec<double> d = pair[0].points[0] - pair[1].points[0];
  return std::sqrt(dot(d, d)) - reach(pair[0]) - reach(pair[1]);
}

}  // namespace taut::campaign
