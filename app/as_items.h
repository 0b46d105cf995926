// SPDX-License-Identifier: GPL-3.0-or-later
// What a case states and a certificate's problem does not have: how results are shown, and the items that an ellipsoid
// was put around.
#pragma once

#include <nlohmann/json_fwd.hpp>
#include <optional>
#include <stop_token>

#include "case/case_file.h"
#include "planner/planner.h"
#include "reports/summary/around_items.h"

namespace taut {

/// Adds to the illustration of a certificate, for its report: units, the fields of the document, the items that an
/// ellipsoid was put around, and the angles of poses under a law that has none.
void add_stated(nlohmann::json& illustration, const Case& the_case);
/// The same, and the bodies of its pictures.
/// @param decoration  what read_meshes() makes of the case's
void add_stated(nlohmann::json& illustration, const Case& the_case, const Decoration& decoration);

/// Proves or refutes a path with the items of the case in place of the ellipsoid around them; nothing for other cases.
/// Margins are those that a certificate would state.
/// @param problem       what the path was proved of
/// @param of_ellipsoid  the margins of the certificate with the ellipsoid
/// @param seconds       the budget
[[nodiscard]] std::optional<AsItems> prove_as_items(const Case& the_case, const Problem& problem, const Path& path,
                                                    const std::optional<Margins>& of_ellipsoid, double seconds,
                                                    const std::stop_token& stop);
/// The same of what a plan's headroom is about: its path, a waypoint or the straight way.
[[nodiscard]] std::optional<AsItems> prove_as_items(const Case& the_case, const Plan& plan,
                                                    const std::optional<Margins>& of_ellipsoid, double seconds,
                                                    const std::stop_token& stop);

}  // namespace taut
