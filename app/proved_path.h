// SPDX-License-Identifier: GPL-3.0-or-later
// A path that somebody else made, proved as a whole from memory.
#pragma once

#include <nlohmann/json.hpp>
#include <stop_token>
#include <string>

#include "kinematics/segment.h"
#include "problem/problem.h"

namespace taut {

/// A certificate of `path`, joined as its law says, without a query: proved, or refuted or undecided at the first piece that is. A
/// single waypoint is a segment that stays there.
/// @param path      waypoints and times; normals and tubes are made here; poses beside cable lengths that do not have these lengths are
///                  replaced by the ones next to them that have
/// @param max_bits  of the prover's last rung
/// @throws InputError where the path does not fit the problem's space.
[[nodiscard]] nlohmann::json prove_waypoints(const Problem& problem, Path path, long max_bits,
                                             const std::stop_token& stop);

}  // namespace taut
