// SPDX-License-Identifier: GPL-3.0-or-later
// Bodies that may touch, in numbers of one scalar: what is fixed, what the platform carries, and the cables.
//
// A convex body is all points within a radius of the convex hull of finitely many points. A cable is one that moves:
// the part of A_i B_i beyond its free ends, within half its diameter (docs/theory.md, "Bodies"). The pairs that are
// checked, and their order, are pairs()'s of problem/bodies.h.
#pragma once

#include <array>
#include <variant>
#include <vector>

#include "kinematics/model.h"
#include "problem/bodies.h"

namespace taut {

/// All points within `radius` of the convex hull of one or more points.
template <class S>
struct ConvexBody {
  std::vector<Vector3<S>> points;  ///< an obstacle's in W, a platform body's in P [m]
  S radius;                        ///< [m]
  /// A ball that contains all of it.
  Vector3<S> centre;
  S reach;  ///< its radius [m]
};

/// { x : normal·x <= offset }, in W.
template <class S>
struct HalfSpace {
  Vector3<S> normal;  ///< not 0, of any length
  S offset;           ///< normal·q of a point q of the plane [m times the normal's length]
};

template <class S>
using Obstacle = std::variant<ConvexBody<S>, HalfSpace<S>>;

/// Two bodies that have to stay farther apart than `clearance`.
template <class S>
struct CheckedPair {
  PairClass kind;
  std::size_t first;   ///< a platform body or a cable
  std::size_t second;  ///< an obstacle, a cable or a platform body
  S clearance;         ///< [m]
  /// Of two cables: whether they are typed with the same anchor and the same tolerance of it, hence hang from one
  /// point.
  bool shares_base = false;
  bool shares_platform = false;
};

template <class S>
struct BodyModel {
  std::vector<ConvexBody<S>> platform;
  std::vector<Obstacle<S>> obstacles;
  std::array<S, kCables> cable_radius;               ///< [m]
  std::array<std::array<S, 2>, kCables> cable_free;  ///< free ends at base and platform [m]
  std::array<std::array<bool, 2>, kCables> is_cut;   ///< whether they are not exactly 0
  std::vector<CheckedPair<S>> pairs;
};

/// At working_precision(); for Interval under run_upward(). @pre problem.bodies, of hulls and half-spaces only
template <class S>
[[nodiscard]] BodyModel<S> make_body_model(const Problem& problem);

}  // namespace taut

#include "kinematics/bodies_impl.h"  // IWYU pragma: keep
