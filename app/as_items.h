// SPDX-License-Identifier: GPL-3.0-or-later
// What a case states that the problem of its certificate does not have: the items that an ellipsoid was put around, and
// the angles of poses under a law that has none.
#pragma once

#include <nlohmann/json_fwd.hpp>
#include <optional>
#include <stop_token>

#include "case/case_file.h"
#include "planner/planner.h"
#include "reports/summary/around_items.h"

namespace taut {

/// Adds the keys `around_items` and `angles` to the illustration of a certificate, for its report.
void add_stated(nlohmann::json& illustration, const Case& the_case);

/// Proves or refutes a path with the items of the case in place of the ellipsoid around them; nothing for other cases.
/// @param problem       what the path was proved of
/// Margins are those that a certificate would state.
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
