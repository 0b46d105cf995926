// SPDX-License-Identifier: GPL-3.0-or-later
// Where two bodies come nearest of which one is a mesh, or both, in floating point; and directions along which they are
// apart, piece by piece. Nothing here is proved.
#pragma once

#include <optional>
#include <span>
#include <vector>

#include "certify/bodies/body_gaps.h"
#include "certify/bodies/nearest.h"
#include "kinematics/bodies.h"

namespace taut {

/// A body at one pose, in one frame: points whose hull it is, or a mesh, whose point f in the file's unit is at
/// origin + axes f.
struct BodyInFrame {
  Points points;
  const IndexedMesh* mesh = nullptr;
  Vector3<double> origin{0, 0, 0};
  Matrix3<double> axes = Matrix3<double>::Identity();  ///< a rotation times a scale
};

/// Its points, or those of an element of its mesh.
[[nodiscard]] Points points_of(const BodyInFrame& body, const std::optional<std::uint32_t>& element);

struct NearestElements {
  NearestPoints nearest;                                 ///< of the points of the bodies, or of their elements
  std::array<std::optional<std::uint32_t>, 2> elements;  ///< of meshes
};
/// @pre one of them is a mesh
[[nodiscard]] NearestElements nearest_elements(const BodyInFrame& first, const BodyInFrame& second);

/// A lower bound of the distance of their surfaces: that distance, or at least `enough`, which is much cheaper.
/// @pre one of them is a mesh
[[nodiscard]] double distance_bound(const BodyInFrame& first, const BodyInFrame& second, double enough);

/// A point of one body that is inside of the other, a watertight mesh.
struct PointInside {
  std::size_t solid = 0;                 ///< the mesh: 0 the first, 1 the second
  Shares shares;                         ///< of the other body's points, or of those of an element of it
  std::optional<std::uint32_t> element;  ///< of the other body, if that is a mesh
};
/// Looks at one point of each part of a body that hangs together: enough where surfaces do not touch.
[[nodiscard]] std::optional<PointInside> point_inside(const BodyInFrame& first, const BodyInFrame& second);

/// The element of a mesh with the point that has the least u·x. @pre body.mesh
[[nodiscard]] std::uint32_t lowest_element(const BodyInFrame& body, const Vector3<double>& u);

/// Unit vectors of which one for each pair of elements shows them apart by at least `needed` + share·(distance −
/// needed); as many of them as were found, where these are too many. Empty where the bodies are not apart by more than
/// `needed`.
[[nodiscard]] std::vector<Vector3<double>> covering_directions(const BodyInFrame& first, const BodyInFrame& second,
                                                               double needed, double share);

}  // namespace taut
