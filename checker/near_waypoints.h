// SPDX-License-Identifier: GPL-3.0-or-later
// Whether a path on constraints goes where it says: "The query" in docs/certificate-format.md. Its waypoints are stated
// next to the constraints; the poses are those on the constraints. Normals and tube, which lead from the one to the
// other, are the certificate's own choice, and could lead anywhere.
#pragma once

#include "checker/kernel/motion.h"

namespace taut::checker {

/// The parameters of a control point as it is stated, x + pi half_turns.
[[nodiscard]] std::vector<MeanValueForm> stated_parameters(const Waypoint& waypoint);

/// Where the space has constraints and the box begins or ends at a joint of the path: that the pose there, which is on
/// the constraints, is next to what the path states. Each coordinate is between those of the control points that matter
/// there, or hardly beyond. @throws Undefined otherwise.
void require_near_waypoints(const Machine& machine, const Problem& problem, const Path& path, std::size_t k,
                            const Box& box);

}  // namespace taut::checker
