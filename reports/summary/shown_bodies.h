// SPDX-License-Identifier: GPL-3.0-or-later
// What a report's pictures show of bodies of triangles: decoration, which a certificate's illustration carries and
// nothing checks, and meshes that the checker was given.
#pragma once

#include <Eigen/Core>
#include <array>
#include <map>
#include <nlohmann/json_fwd.hpp>
#include <string>
#include <vector>

#include "case/decoration.h"
#include "problem/bodies.h"

namespace taut {

/// The object `decoration` of an illustration: for `frame` and `payload`, where they are, flat lists of `corners`
/// [10 µm] and of `triangles`, three indices of corners each.
[[nodiscard]] nlohmann::json to_json(const Decoration& decoration);
/// Reads it. A body that a case could not state is taken as not stated: anybody can alter an illustration.
[[nodiscard]] Decoration decoration_from_json(const nlohmann::json& decoration);

/// What a picture shows of a mesh, placed as its body is: of one with too many triangles a coarser one, in which points
/// that are next to each other are one.
[[nodiscard]] ShownBody shown_mesh(const TriangleMesh& mesh, const BodyText& body);
/// The meshes that were read among some bodies, by these bodies' names.
[[nodiscard]] std::map<std::string, ShownBody> shown_meshes(const BodiesText& bodies);

/// The edges that show a body's form, as pairs of points: those at which it turns by more than 30 degrees, its rims,
/// and those at which it bends out of sight.
/// @param towards  who looks, in the body's axes; of length 1
[[nodiscard]] std::vector<std::array<std::array<double, 3>, 2>> feature_edges(const ShownBody& body,
                                                                              const Eigen::Vector3d& towards);

}  // namespace taut
