// SPDX-License-Identifier: GPL-3.0-or-later
#include "checker/kernel/clearance.h"

#include <algorithm>
#include <map>

#include "checker/kernel/mesh_clearance.h"
#include "checker/kernel/mesh_inside.h"

namespace taut::checker {
namespace {

/// By how much the ends of a cable may be from where they are stated to be.
struct EndShift {
  Ball base;
  Ball platform;
};

/// |d_i|, which has to be more than the free ends however a deviation changes it.
const MeanValueForm& require_longer(const Machine& machine, const Geometry& geometry, std::size_t i, const Ball& loss) {
  const auto& [at_base, at_platform] = machine.bodies->free_ends[i];
  const Ball rest = geometry.length[i].range() - loss - at_base - at_platform;
  if (!certainly_positive(rest)) throw Undefined("a cable may not be longer than its free ends");
  return geometry.length[i];
}

/// (2).
Ball distance_in_cone(const Geometry& geometry, std::size_t i, const PlacedExitCone& cone) {
  Vector3<MeanValueForm> d = geometry.d[i];
  if (cone.end == Axes::kPlatform) {
    d = multiply(transposed(geometry.pose.R), d);
    for (MeanValueForm& x : d) x = -x;
  }
  const Vector3<MeanValueForm> n = {MeanValueForm(cone.axis[0]), MeanValueForm(cone.axis[1]),
                                    MeanValueForm(cone.axis[2])};
  return (cone.sine * dot(cone.axis, d) - cone.cosine * norm(cross(d, n))).range();
}

/// u, of which products are to be divided by |u|.
struct Along {
  Axes axes;
  Vector3<Ball> u;
  Ball size;                                       ///< |u|
  std::optional<Vector3<MeanValueForm>> turned{};  ///< R' u for u of W, R u for u of P; once it was asked for
};

class Clearances {
 public:
  Clearances(const Machine& machine, const Geometry& geometry, const MarginLoss& loss,
             std::span<const Direction> directions, const Apart& apart, const std::optional<Ball>& enough)
      : machine_(machine),
        bodies_(*machine.bodies),
        geometry_(geometry),
        loss_(loss),
        directions_(directions),
        apart_(apart),
        enough_(enough) {
    if (apart.size() != bodies_.pairs.size()) throw Undefined("no directions are stated for pairs of bodies");
    shift_ = {highest(loss.shift.position), highest(loss.shift.turn)};
  }

  [[nodiscard]] std::vector<Ball> margins() {
    std::vector<Ball> result;
    for (std::size_t k = 0; k < apart_.size(); ++k) {
      const CheckedPair& pair = bodies_.pairs[k];
      const bool has_mesh = bodies_.mesh(pair, true) != nullptr || bodies_.mesh(pair, false) != nullptr;
      result.push_back(has_mesh ? margin_of_mesh(k)
                                : lowest(distance(k) - bodies_.required_at_most(k, range(geometry_.pose.p))));
    }
    return result;
  }

 private:
  /// (1), of pair k.
  [[nodiscard]] Ball distance(std::size_t k) {
    const auto& [kind, first, second, clearance, name, zones] = bodies_.pairs[k];
    if (kind == PairKind::kExitCone) return in_cone(first, bodies_.exit_cones[second]);
    if (kind == PairKind::kCableCable) return between_cables(first, second, along(k, std::nullopt));
    if (kind == PairKind::kCablePlatform) {
      Along& u = along(k, Axes::kPlatform);
      return least_of_cable(first, u) - most(bodies_.platform[second], Axes::kPlatform, u);
    }
    const bool is_cable = kind == PairKind::kCableObstacle;
    const auto from_obstacle = [&](Along& u, const Ball& most) {
      return (is_cable ? least_of_cable(first, u) : least(bodies_.platform[first], Axes::kPlatform, u)) - most;
    };
    if (const auto* hull = std::get_if<PlacedHull>(&bodies_.obstacles[second])) {
      Along& u = along(k, is_cable ? std::optional(Axes::kWorld) : std::nullopt);
      return from_obstacle(u, most(*hull, Axes::kWorld, u));
    }
    const auto& half_space = std::get<PlacedHalfSpace>(bodies_.obstacles[second]);
    Along n = along(Axes::kWorld, half_space.normal);
    return from_obstacle(n, half_space.offset / n.size);
  }

  /// (2), with what deviations take.
  [[nodiscard]] Ball in_cone(std::size_t i, const PlacedExitCone& cone) {
    (void)require_longer(machine_, geometry_, i, highest(loss_.length[i]));
    const EndShift& shift = end_shift(i, cone.end);
    return lowest(distance_in_cone(geometry_, i, cone)) - shift.base - shift.platform;
  }

  /// That of pair k, of which one body is a mesh or both.
  [[nodiscard]] Ball margin_of_mesh(std::size_t k) {
    const CheckedPair& pair = bodies_.pairs[k];
    const PlacedSurface* const first = bodies_.mesh(pair, true);
    const PlacedSurface* const second = bodies_.mesh(pair, false);
    std::vector<BothAlong> along_all;
    if (const auto* half_space = half_space_of(pair)) {
      Along n = along(Axes::kWorld, half_space->normal);
      along_all.push_back(both_along(pair, n));
      along_all.back()[1].extreme = highest(half_space->offset / n.size);
    } else {
      const Axes axes = pair.kind == PairKind::kCablePlatform ? Axes::kPlatform : Axes::kWorld;
      for (const std::size_t index : apart_[k]) along_all.push_back(both_along(pair, along_direction(index, axes)));
    }
    if (half_space_of(pair) == nullptr) {
      require_outside(pair, false);
      require_outside(pair, true);
    }
    return mesh_margin(first, second, along_all, {shift_.position, shift_.turn}, bodies_.clearance[k], enough_);
  }

  /// In the middle of the box, no part of the other body is inside of the first one, or of the second, if that is a
  /// closed mesh. A part that hangs together stays on its side of a surface that it does not touch: so one point of
  /// each is enough, at one pose.
  void require_outside(const CheckedPair& pair, bool of_first) {
    const PlacedSurface* const mesh = bodies_.mesh(pair, of_first);
    if (mesh == nullptr || !mesh->surface->is_closed()) return;
    const bool is_carried = of_first || pair.kind == PairKind::kCablePlatform;
    const Matrix3<Ball> R = middle(geometry_.pose.R);
    const Vector3<Ball> p = middle(geometry_.pose.p);
    const auto require = [&](const Vector3<Ball>& x) {  // of W
      const Vector3<Ball> here = is_carried ? multiply(transposed(R), x - p) : x;
      if (side_of(*mesh->surface, in_unit_of(*mesh, here)) == Side::kOutside) return;
      throw Undefined("a body may be inside of a mesh: " + pair.name);
    };
    if (pair.kind != PairKind::kPlatformObstacle) {  // then the other one is the cable
      const Ball t = cuts(pair.first)[0].at;
      return require(machine_.base[pair.first] + t * middle(geometry_.d[pair.first]));
    }
    const PlacedHull& other = *bodies_.hull(pair, !of_first);
    const auto in_world = [&](const Vector3<Ball>& x) { return of_first ? x : p + multiply(R, x); };
    if (!other.mesh) return require(in_world(other.points.front()));
    for (const Surface::Point& part : other.mesh->surface->parts()) require(in_world(other.mesh->place(part)));
  }

  /// What is known of forms at u = 0.
  [[nodiscard]] static Vector3<Ball> middle(const Vector3<MeanValueForm>& x) { return {x[0].at, x[1].at, x[2].at}; }
  [[nodiscard]] static Matrix3<Ball> middle(const Matrix3<MeanValueForm>& x) {
    return {middle(x[0]), middle(x[1]), middle(x[2])};
  }

  [[nodiscard]] const PlacedHalfSpace* half_space_of(const CheckedPair& pair) const {
    if (pair.kind == PairKind::kCableCable || pair.kind == PairKind::kCablePlatform) return nullptr;
    return std::get_if<PlacedHalfSpace>(&bodies_.obstacles[pair.second]);
  }

  /// Of a half-space, nothing.
  [[nodiscard]] BothAlong both_along(const CheckedPair& pair, Along& u) {
    const Ball unit = Ball(1) / u.size;
    BothAlong result;
    if (const PlacedSurface* const mesh = bodies_.mesh(pair, true)) {  // on the platform, along a vector of W
      const Vector3<MeanValueForm>& v = turned(u);
      result[0] =
          taut::checker::along(*mesh, unit * dot(u.u, geometry_.pose.p), {unit * v[0], unit * v[1], unit * v[2]});
    } else {
      result[0].extreme = pair.kind == PairKind::kPlatformObstacle
                              ? least(bodies_.platform[pair.first], Axes::kPlatform, u)
                              : least_of_cable(pair.first, u);
    }
    if (const PlacedSurface* const mesh = bodies_.mesh(pair, false)) {
      const auto constant = [&](std::size_t c) { return MeanValueForm(unit * u.u[c]); };
      result[1] = taut::checker::along(*mesh, MeanValueForm(), {constant(0), constant(1), constant(2)});
    } else if (const PlacedHull* const hull = bodies_.hull(pair, false)) {
      result[1].extreme = highest(most(*hull, Axes::kWorld, u));
    }
    return result;
  }

  // ---- Directions ---------------------------------------------------------------------------------------------------

  [[nodiscard]] static Along along(Axes axes, const Vector3<Ball>& u) { return {axes, u, sqrt(squared_norm(u))}; }

  [[nodiscard]] const Vector3<MeanValueForm>& turned(Along& along) const {
    const Matrix3<MeanValueForm>& R = geometry_.pose.R;
    if (!along.turned) along.turned = multiply(along.axes == Axes::kWorld ? transposed(R) : R, along.u);
    return *along.turned;
  }

  /// Of pair k, in the only axes that make sense of it.
  [[nodiscard]] Along& along(std::size_t k, std::optional<Axes> axes) {
    if (apart_[k].size() != 1) throw Undefined("not one direction is stated for a pair of bodies");
    return along_direction(apart_[k][0], axes);
  }
  [[nodiscard]] Along& along_direction(std::size_t index, std::optional<Axes> axes) {
    if (index >= directions_.size()) throw Undefined("no direction is stated for a pair of bodies");
    const Direction& direction = directions_[index];
    if (axes && direction.axes != *axes) throw Undefined("a pair of bodies is told apart in the wrong axes");
    const auto known = along_.find(index);
    if (known != along_.end()) return known->second;
    const auto& [x, y, z] = direction.u;
    return along_.emplace(index, along(direction.axes, {Ball(x), Ball(y), Ball(z)})).first->second;
  }

  // ---- Bodies -------------------------------------------------------------------------------------------------------

  /// The first term of (1) for a body that stands still in `axes`.
  [[nodiscard]] Ball least(const PlacedHull& hull, Axes axes, Along& along) const {
    std::optional<Ball> result;
    for (const Vector3<Ball>& x : hull.points) {
      const auto [at, shift] = project(x, axes, along);
      const Ball here = lowest(at - shift);
      result = result ? smaller(*result, here) : here;
    }
    return *result - hull.radius;
  }
  /// The second term, likewise.
  [[nodiscard]] Ball most(const PlacedHull& hull, Axes axes, Along& along) const {
    std::optional<Ball> result;
    for (const Vector3<Ball>& x : hull.points) {
      const auto [at, shift] = project(x, axes, along);
      const Ball here = highest(at + shift);
      result = result ? larger(*result, here) : here;
    }
    return *result + hull.radius;
  }

  struct Projected {
    Ball at;     ///< u . x / |u|
    Ball shift;  ///< by how much deviations may change it
  };
  /// Of a point that stands still in `axes`.
  [[nodiscard]] Projected project(const Vector3<Ball>& x, Axes axes, Along& along) const {
    if (axes == along.axes) return {dot(along.u, x) / along.size, Ball()};
    if (axes == Axes::kPlatform) {
      return {(dot(along.u, geometry_.pose.p) + dot(turned(along), x)).range() / along.size,
              shift_.position + shift_.turn * length_bound(x).ball()};
    }
    const Vector3<MeanValueForm> from_p = from_origin(x);
    return {dot(turned(along), from_p).range() / along.size,
            shift_.position + shift_.turn * length_bound(range(from_p)).ball()};
  }
  /// x - p, of a point that stands still in W.
  [[nodiscard]] Vector3<MeanValueForm> from_origin(const Vector3<Ball>& x) const {
    Vector3<MeanValueForm> result;
    for (std::size_t c = 0; c < 3; ++c) result[c] = MeanValueForm(x[c]) - geometry_.pose.p[c];
    return result;
  }

  // ---- Cables -------------------------------------------------------------------------------------------------------

  using OfCuts = std::array<MeanValueForm, 2>;  ///< at base and platform

  /// t_0 and t_1.
  [[nodiscard]] const OfCuts& cuts(std::size_t i) {
    if (cuts_[i]) return *cuts_[i];
    const Ball loss = highest(loss_.length[i]);
    const MeanValueForm longest = require_longer(machine_, geometry_, i, loss) + MeanValueForm(loss);
    const MeanValueForm inverse = apply(Function::kInverse, longest);
    return cuts_[i].emplace(OfCuts{bodies_.free_ends[i][0] * inverse, bodies_.free_ends[i][1] * inverse});
  }

  /// u . x / |u| at both cuts.
  [[nodiscard]] OfCuts ends(std::size_t i, Along& along) {
    const auto& [t_0, t_1] = cuts(i);
    const Ball unit = Ball(1) / along.size;
    if (along.axes == Axes::kWorld) {
      const MeanValueForm at_A(dot(along.u, machine_.base[i]) * unit);
      const MeanValueForm d = unit * dot(along.u, geometry_.d[i]);
      return {at_A + t_0 * d, at_A + d - t_1 * d};
    }
    const MeanValueForm at_B(dot(along.u, machine_.platform[i]) * unit);
    const MeanValueForm d = unit * dot(turned(along), geometry_.d[i]);
    return {at_B - d + t_0 * d, at_B - t_1 * d};
  }

  /// The table of the header.
  [[nodiscard]] const EndShift& end_shift(std::size_t i, Axes axes) {
    std::optional<EndShift>& known = end_shifts_[i][axes == Axes::kWorld ? 0 : 1];
    if (!known) known = compute_end_shift(i, axes);
    return *known;
  }
  [[nodiscard]] EndShift compute_end_shift(std::size_t i, Axes axes) const {
    if (!machine_.tolerances) return {};
    const Ball& beta = machine_.tolerances->base_anchors[i];
    const Ball& mu = machine_.tolerances->platform_anchors[i];
    if (axes == Axes::kWorld) {
      return {beta, shift_.position + shift_.turn * length_bound(machine_.platform[i]).ball() + mu};
    }
    const Vector3<MeanValueForm> from_p = from_origin(machine_.base[i]);
    return {beta + shift_.position + shift_.turn * length_bound(range(from_p)).ball(), mu};
  }

  /// Radii of the balls around both cuts.
  [[nodiscard]] OfCuts radii(std::size_t i, const EndShift& shift) {
    const auto& [t_0, t_1] = cuts(i);
    const Ball& half_diameter = bodies_.cable_radius[i];
    const Ball growth = shift.platform - shift.base;
    return {MeanValueForm(shift.base + half_diameter) + growth * t_0,
            MeanValueForm(shift.platform + half_diameter) - growth * t_1};
  }

  [[nodiscard]] Ball least_of_cable(std::size_t i, Along& along) {
    const OfCuts at = ends(i, along);
    const OfCuts radius = radii(i, end_shift(i, along.axes));
    return smaller(lowest((at[0] - radius[0]).range()), lowest((at[1] - radius[1]).range()));
  }

  [[nodiscard]] Ball between_cables(std::size_t i, std::size_t j, Along& along) {
    const EndShift of_i = end_shift(i, along.axes);
    const EndShift of_j = end_shift(j, along.axes);
    const std::array at = {ends(i, along), ends(j, along)};
    Ball result = between_cables(at, {radii(i, of_i), radii(j, of_j)});
    if (!machine_.tolerances) return result;
    const auto& [one_base, one_platform] = bodies_.shares[i][j];
    const auto take = [&](const EndShift& x, const EndShift& y) {
      result = larger(result, between_cables(at, {radii(i, x), radii(j, y)}));
    };
    if (one_base) take({Ball(), of_i.base + of_i.platform}, {Ball(), of_j.base + of_j.platform});
    if (one_platform) take({of_i.base + of_i.platform, Ball()}, {of_j.base + of_j.platform, Ball()});
    return result;
  }

  using OfTwoCables = std::array<OfCuts, 2>;
  /// The least of all ends of one against all of the other.
  [[nodiscard]] static Ball between_cables(const OfTwoCables& at, const OfTwoCables& radius) {
    const OfCuts first = {at[0][0] - radius[0][0], at[0][1] - radius[0][1]};
    const OfCuts second = {at[1][0] + radius[1][0], at[1][1] + radius[1][1]};
    std::optional<Ball> result;
    for (std::size_t k = 0; k < 2; ++k) {
      for (std::size_t l = 0; l < 2; ++l) {
        const Ball here = lowest((first[k] - second[l]).range());
        result = result ? smaller(*result, here) : here;
      }
    }
    return *result;
  }

  const Machine& machine_;
  const PlacedBodies& bodies_;
  const Geometry& geometry_;
  const MarginLoss& loss_;
  PoseShift shift_;
  std::span<const Direction> directions_;
  const Apart& apart_;
  const std::optional<Ball>& enough_;
  std::map<std::size_t, Along> along_;  ///< by the index of the direction
  std::array<std::optional<OfCuts>, kCables> cuts_;
  std::array<std::array<std::optional<EndShift>, 2>, kCables> end_shifts_;  ///< in W and in P
};

// ---- Contact --------------------------------------------------------------------------------------------------------

/// The point of a hull, or of a cable between its cuts, in W, and the radius around it.
struct ContactPoint {
  Vector3<Ball> at;
  Ball radius;
};

Vector3<Ball> mean(const std::vector<Vector3<Ball>>& points, const std::vector<mpq_class>& weights) {
  Vector3<Ball> result;
  for (std::size_t k = 0; k < points.size(); ++k) result = result + Ball(weights.at(k)) * points[k];
  return result;
}

/// In the body's own axes.
ContactPoint of_body(const PlacedHull& body, const std::vector<mpq_class>& weights,
                     const std::optional<std::size_t>& element) {
  if (!body.mesh) return {mean(body.points, weights), body.radius};
  if (!element || *element >= body.mesh->surface->elements()) throw Undefined("no element of a mesh has this index");
  std::vector<Vector3<Ball>> corners;
  for (const Surface::Point& f : body.mesh->surface->corners(*element)) corners.push_back(body.mesh->place(f));
  return {mean(corners, weights), Ball()};
}

ContactPoint of_platform(const PlacedHull& body, const Geometry& geometry, const std::vector<mpq_class>& weights,
                         const std::optional<std::size_t>& element) {
  const ContactPoint point = of_body(body, weights, element);
  return {range(geometry.pose.p) + multiply(range(geometry.pose.R), point.at), point.radius};
}

ContactPoint of_cable(const Machine& machine, const Geometry& geometry, std::size_t i,
                      const std::vector<mpq_class>& weights) {
  const Ball length = require_longer(machine, geometry, i, Ball()).range();
  const auto& [at_base, at_platform] = machine.bodies->free_ends[i];
  const Ball t = Ball(weights.at(0)) * at_base / length + Ball(weights.at(1)) * (Ball(1) - at_platform / length);
  return {machine.base[i] + t * range(geometry.d[i]), machine.bodies->cable_radius[i]};
}

ContactPoint first_point(const Machine& machine, const Geometry& geometry, std::size_t n, const ContactWeights& weights,
                         const ContactElements& elements) {
  const CheckedPair& pair = machine.bodies->pairs.at(n);
  if (pair.kind != PairKind::kPlatformObstacle) return of_cable(machine, geometry, pair.first, weights[0]);
  return of_platform(machine.bodies->platform[pair.first], geometry, weights[0], elements[0]);
}

/// Nothing of a half-space.
std::optional<ContactPoint> second_point(const Machine& machine, const Geometry& geometry, std::size_t n,
                                         const ContactWeights& weights, const ContactElements& elements) {
  const PlacedBodies& bodies = *machine.bodies;
  const CheckedPair& pair = bodies.pairs.at(n);
  if (pair.kind == PairKind::kCableCable) return of_cable(machine, geometry, pair.second, weights[1]);
  if (pair.kind == PairKind::kCablePlatform) {
    return of_platform(bodies.platform[pair.second], geometry, weights[1], elements[1]);
  }
  const auto* hull = std::get_if<PlacedHull>(&bodies.obstacles[pair.second]);
  if (hull == nullptr) return std::nullopt;
  return of_body(*hull, weights[1], elements[1]);
}

}  // namespace

std::vector<Ball> clearance_margins(const Machine& machine, const Geometry& geometry, const MarginLoss& loss,
                                    std::span<const Direction> directions, const Apart& apart,
                                    const std::optional<Ball>& enough) {
  return Clearances(machine, geometry, loss, directions, apart, enough).margins();
}

Ball contact_depth(const Machine& machine, const Geometry& geometry, std::size_t pair, const ContactWeights& weights,
                   const ContactElements& elements) {
  const PlacedBodies& bodies = machine.bodies.value();
  const auto& [kind, first, second, clearance, name, zones] = bodies.pairs.at(pair);
  if (kind == PairKind::kExitCone) {
    (void)require_longer(machine, geometry, first, Ball());
    return -distance_in_cone(geometry, first, bodies.exit_cones[second]);
  }
  const ContactPoint a = first_point(machine, geometry, pair, weights, elements);
  const Ball allowed = a.radius + bodies.required_at_least(pair, range(geometry.pose.p));
  if (const auto b = second_point(machine, geometry, pair, weights, elements)) {
    return allowed + b->radius - length_range(a.at - b->at);
  }
  const auto& half_space = std::get<PlacedHalfSpace>(bodies.obstacles[second]);
  return allowed - (dot(half_space.normal, a.at) - half_space.offset) / sqrt(squared_norm(half_space.normal));
}

Ball depth_around(const Machine& machine, const Geometry& geometry, std::size_t pair,
                  const std::vector<ContactWeights>& around) {
  Ball radii;
  std::array<Vector3<Ball>, 4> v;
  for (std::size_t k = 0; k < 4; ++k) {
    const ContactPoint a = first_point(machine, geometry, pair, around.at(k), {});
    const ContactPoint b = second_point(machine, geometry, pair, around.at(k), {}).value();
    v[k] = a.at - b.at;
    radii = a.radius + b.radius;
  }
  std::array<Ball, 4> determinants;
  std::ranges::transform(kTetrahedronFaces, determinants.begin(),
                         [&v](const auto& face) { return determinant(v[face[0]], v[face[1]], v[face[2]]); });
  if (!std::ranges::all_of(determinants, certainly_positive) &&
      !std::ranges::all_of(determinants, certainly_negative)) {
    throw Undefined("the points may not be around a common point of the bodies");
  }
  std::optional<Ball> low, high;  // ends of the least height of 0 over a face
  for (std::size_t k = 0; k < 4; ++k) {
    const auto& [a, b, c] = kTetrahedronFaces[k];
    const Ball height = determinants[k] / length_range(cross(v[b] - v[a], v[c] - v[a]));
    const Ball least = least_magnitude(height), most = magnitude(height);
    low = low ? smaller(*low, least) : least;
    high = high ? smaller(*high, most) : most;
  }
  return hull(*low, *high) + radii + machine.bodies->required_at_least(pair, range(geometry.pose.p));
}

Ball depth_inside(const Machine& machine, const Geometry& geometry, std::size_t n, std::size_t solid,
                  const ContactWeights& weights, const ContactElements& elements) {
  const PlacedBodies& bodies = machine.bodies.value();
  const CheckedPair& pair = bodies.pairs.at(n);
  const PlacedSurface* const mesh = bodies.mesh(pair, solid == 0);
  if (mesh == nullptr || !mesh->surface->is_closed()) throw Undefined("the body has no inside: " + pair.name);
  const std::size_t other = 1 - solid;
  const bool is_of_platform = pair.kind == PairKind::kPlatformObstacle && solid == 1;
  const ContactPoint point =
      pair.kind != PairKind::kPlatformObstacle ? of_cable(machine, geometry, pair.first, weights[other])
      : is_of_platform ? of_platform(*bodies.hull(pair, true), geometry, weights[other], elements[other])
                       : of_body(*bodies.hull(pair, false), weights[other], elements[other]);
  const bool is_carried = solid == 0 || pair.kind == PairKind::kCablePlatform;
  const Vector3<Ball> here =
      is_carried ? multiply(transposed(range(geometry.pose.R)), point.at - range(geometry.pose.p)) : point.at;
  if (side_of(*mesh->surface, in_unit_of(*mesh, here)) != Side::kInside) {
    throw Undefined("the point may be outside of the mesh: " + pair.name);
  }
  return bodies.clearance[n];
}

}  // namespace taut::checker
