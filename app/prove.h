// SPDX-License-Identifier: GPL-3.0-or-later
// Proves a path that something else made, as a whole and in memory.
#pragma once

#include <stop_token>

#include "certificate/certificate.h"
#include "kinematics/segment.h"
#include "problem/problem.h"

namespace taut {

/// The certificate of `path`, without a query: proved, or refuted or undecided at the first segment that is. A single
/// waypoint is a segment that stays there.
/// @param path      waypoints and times; normals and tubes are made here. Poses that do not have the cable lengths
///                  beside them are replaced by the ones next to them that have.
/// @param max_bits  the greatest precision of the prover
/// @throws InputError where the path does not fit the problem's space.
[[nodiscard]] Certificate prove_waypoints(const Problem& problem, Path path, long max_bits,
                                          const std::stop_token& stop);

}  // namespace taut
