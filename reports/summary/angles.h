// SPDX-License-Identifier: GPL-3.0-or-later
// A pose's angles in the range that people use.
#pragma once

#include <array>

#include "problem/problem.h"

namespace taut {

/// Angles [rad] of the same orientation: a tilt θ and Euler's β within [0, π], a pitch within [−π/2, π/2], and all
/// others within (−π, π], but for rounding. Angles that are not finite stay as they are.
[[nodiscard]] std::array<double, 3> customary_angles(AngleKind kind, const std::array<double, 3>& angles);

}  // namespace taut
