// SPDX-License-Identifier: GPL-3.0-or-later
// Bodies that may touch, in numbers of one scalar: what is fixed, what the platform carries, and the cables.
//
// A convex body is all points within a radius of the convex hull of finitely many points. A cable is one that moves:
// the part of A_i B_i beyond its free ends, within half its diameter (docs/theory.md, "Bodies"). The pairs that are
// checked, and their order, are pairs()'s of problem/bodies.h.
#pragma once

#include <array>
#include <memory>
#include <optional>
#include <variant>
#include <vector>

#include "kinematics/model.h"
#include "problem/bodies.h"

namespace taut {

/// The elements of a mesh: x = at + turn (unit f) of all points f in the file's unit.
template <class S>
struct PlacedMesh {
  std::shared_ptr<const IndexedMesh> mesh;
  S unit;  ///< [m]
  Vector3<S> at;
  std::optional<Matrix3<S>> turn;  ///< none: the identity

  [[nodiscard]] Vector3<S> place(const std::array<double, 3>& f) const;
};

/// All points within `radius` of the convex hull of one or more points. Or a mesh, which this contains.
template <class S>
struct ConvexBody {
  std::vector<Vector3<S>> points;  ///< an obstacle's in W, a platform body's in P [m]
  S radius;                        ///< [m]
  /// A ball that contains all of it.
  Vector3<S> centre;
  S reach;  ///< its radius [m]
  /// Corners of a box that contains the points: hull(lowest, highest) holds every member of each.
  Vector3<S> lowest, highest;
  /// If set, the body is the mesh alone, `points` are the corners of a box around it, and `radius` is 0.
  std::shared_ptr<const PlacedMesh<S>> mesh = nullptr;
};

/// { x : normal·x <= offset }, in W.
template <class S>
struct HalfSpace {
  Vector3<S> normal;  ///< not 0, of any length
  S offset;           ///< normal·q of a point q of the plane [m times the normal's length]
};

template <class S>
using Obstacle = std::variant<ConvexBody<S>, HalfSpace<S>>;

/// Where a pair may touch: while the platform's origin is no farther than `within` from `at`, by less than `depth`.
template <class S>
struct ContactZone {
  Vector3<S> at;  ///< in W [m]
  S within;       ///< > 0 [m]
  S depth;        ///< > 0 [m]
};

/// An exit cone (problem/bodies.h).
template <class S>
struct ExitCone {
  CableEnd end;
  Vector3<S> axis;  ///< of length 1
  S sine, cosine;   ///< of the half-angle
};

/// Two bodies that have to stay farther apart than `clearance`, but in zones of contact (problem/bodies.h).
template <class S>
struct CheckedPair {
  PairClass kind;
  std::size_t first;   ///< a platform body or a cable
  std::size_t second;  ///< an obstacle, a cable, a platform body or an exit cone
  S clearance;         ///< [m]
  /// Of two cables: whether they are typed with the same anchor and the same tolerance of it, hence hang from one
  /// point.
  bool shares_base = false;
  bool shares_platform = false;
  std::vector<ContactZone<S>> zones = {};
  S radii{};              ///< the sum of both bodies' [m]; of an exit cone the cable's
  bool has_mesh = false;  ///< one of the bodies, or both
};

/// What a pair has to be farther apart than [m].
template <class S>
struct RequiredDistance {
  S at_most;   ///< it is not more than this: a pair that is farther apart than this is as the problem wants it
  S at_least;  ///< and not less than this: a pair that isn't farther apart than this is not
};
/// With the platform's origin anywhere in p [m].
template <class S>
[[nodiscard]] RequiredDistance<S> required_distance(const CheckedPair<S>& pair, const Vector3<S>& p);

template <class S>
struct BodyModel {
  std::vector<ConvexBody<S>> platform;
  std::vector<Obstacle<S>> obstacles;
  std::array<S, kCables> cable_radius;               ///< [m]
  std::array<std::array<S, 2>, kCables> cable_free;  ///< free ends at base and platform [m]
  std::array<std::array<bool, 2>, kCables> is_cut;   ///< whether they are not exactly 0
  std::vector<ExitCone<S>> exit_cones;
  std::vector<CheckedPair<S>> pairs;
  bool has_meshes = false;  ///< some pair has_mesh
};

/// Of an exit cone: |d| sin(half-angle − t), how far the other end of the cable is inside, where d is the vector to it
/// from the cable's anchor here, in the cone's axes, and t the angle between d and the cone's axis. It changes by no
/// more than d does. @tparam S  the cone's scalar, or forms in it
template <class S, class C>
[[nodiscard]] S distance_in_cone(const ExitCone<C>& cone, const std::array<S, 3>& d);

/// At working_precision(); for Interval under run_upward(). @throws InputError for a mesh that was not read
/// @pre problem.bodies
template <class S>
[[nodiscard]] BodyModel<S> make_body_model(const Problem& problem);

}  // namespace taut

#include "kinematics/bodies_impl.h"  // IWYU pragma: keep
