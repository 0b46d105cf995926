// SPDX-License-Identifier: GPL-3.0-or-later
// What stands in the way of a plan's proof, within a budget of time.
#pragma once

#include <stop_token>

#include "certify/headroom.h"
#include "planner/planner.h"

namespace taut {

/// How long it may take to find out what stands in the way of a proof if nobody says [s].
inline constexpr double kHeadroomSeconds = 30;

/// What a plan's headroom is about: its path; the waypoint of the query that was not proved; or, where no path was
/// found, the straight way through the query.
/// @param wrench_scale  that of the certificate's margins, so that both say one number; empty where it has none
/// @param seconds  the budget, of which nothing is left if it is not positive
[[nodiscard]] Headroom plan_headroom(const Case& the_case, const Plan& plan, const DecimalText& wrench_scale,
                                     double seconds, const HeadroomProgress& progress, const std::stop_token& stop);

}  // namespace taut
