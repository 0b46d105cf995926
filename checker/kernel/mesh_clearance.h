// SPDX-License-Identifier: GPL-3.0-or-later
// The distance of two bodies of which one is a mesh, or both.
//
// A mesh is the union of its elements, each the hull of three points. Its distance from another body is the least of
// its elements' distances; if both are meshes, the least over all pairs of elements. For each element, or pair, (1) of
// clearance.h holds for every vector u, so that for a list of such vectors the largest of what they prove is proved:
//     distance >= min over elements of max over u of [ min_k (u . a_k / |u|) - max_l (u . b_l / |u|) ].       (2)
// Along one u, a mesh's point with the coordinates f in its file's unit is at c + w . f, the c and w being constants of
// a mesh that stands still, and functions of s of one that the platform carries. The range of c + w . f over a box that
// contains some elements bounds what each of them is; so what (2) gives for a box is not more than it is for any
// element in it. The least is found by opening boxes where what they give may be less than what is known.
#pragma once

#include <optional>
#include <span>
#include <vector>

#include "checker/kernel/bodies.h"

namespace taut::checker {

/// A body along one vector u, divided by |u|.
struct SideAlong {
  std::optional<Ball> extreme;  ///< of a body that is no mesh: its least value, or its largest; one number
  MeanValueForm constant;       ///< of a mesh: c
  Vector3<MeanValueForm> by;    ///< likewise: w
};
/// The first body's and the second's.
using BothAlong = std::array<SideAlong, 2>;

/// A mesh along u, divided by |u|: u may depend on s, and `origin` is what all points have in common.
[[nodiscard]] SideAlong along(const PlacedSurface& mesh, const MeanValueForm& origin, const Vector3<MeanValueForm>& u);

/// By how much deviations may move the points of a mesh.
struct MeshShift {
  Ball position;  ///< of the platform that carries the first body [m]
  Ball turn;      ///< [rad]
};

/// A number that (2) minus `needed` is not less than. It is nearly that, unless that is larger than `enough`, or not
/// positive.
/// @param first, second  the meshes; null where the body is none
/// @param shift  of the first mesh
/// @throws Undefined where boxes would have to be opened too often
[[nodiscard]] Ball mesh_margin(const PlacedSurface* first, const PlacedSurface* second,
                               std::span<const BothAlong> along, const MeshShift& shift, const Ball& needed,
                               const std::optional<Ball>& enough);

}  // namespace taut::checker
