// SPDX-License-Identifier: GPL-3.0-or-later
// The bodies that a report's pictures show beside the machine, as a certificate's illustration carries them. Nothing
// checks them.
#pragma once

#include <array>
#include <map>
#include <nlohmann/json_fwd.hpp>
#include <string>
#include <vector>

#include "case/bodies.h"
#include "case/decoration.h"

namespace taut {

/// The object `decoration` of an illustration: for `frame` and `payload`, where they are, flat lists of `corners`
/// [10 µm] and of `triangles`, three indices of corners each.
[[nodiscard]] nlohmann::json to_json(const Decoration& decoration);
/// Reads it. A body that a case could not state is taken as not stated: anybody can alter an illustration.
[[nodiscard]] Decoration decoration_from_json(const nlohmann::json& decoration);

/// What a picture shows of a mesh, placed as its body is: of one with too many triangles a coarser one, in which points
/// that are next to each other are one.
[[nodiscard]] ShownBody shown_mesh(const TriangleMesh& mesh, const BodyText& body);
/// The meshes among the bodies of a case, by their names.
[[nodiscard]] std::map<std::string, ShownBody> shown_meshes(const CaseBodies& bodies);

/// The object `meshes` of an illustration: bodies of the platform in its axes, obstacles in the world's.
[[nodiscard]] nlohmann::json to_json(const std::map<std::string, ShownBody>& meshes);
/// Reads it, as decoration_from_json() does.
[[nodiscard]] std::map<std::string, ShownBody> meshes_from_json(const nlohmann::json& meshes);

/// The edges that show a body's form, as pairs of points: those at which it turns by more than 30 degrees, and its
/// rims.
[[nodiscard]] std::vector<std::array<std::array<double, 3>, 2>> feature_edges(const ShownBody& body);

}  // namespace taut
