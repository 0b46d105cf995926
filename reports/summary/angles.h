// SPDX-License-Identifier: GPL-3.0-or-later
// A pose's angles: which of them a report shows, and in the range that people use.
#pragma once

#include <array>

#include "certificate/certificate.h"
#include "kinematics/model.h"
#include "problem/problem.h"

namespace taut {

/// Angles [rad] of the same orientation: a tilt θ and Euler's β within [0, π], a pitch within [−π/2, π/2], and all
/// others within (−π, π], but for rounding. Angles that are not finite stay as they are.
[[nodiscard]] std::array<double, 3> customary_angles(AngleKind kind, const std::array<double, 3>& angles);

/// The angles in which poses of a certificate are shown: those of its space. Of a law between poses, whose space knows
/// tilt and torsion only, those that the illustration says that the case chose, if three angles tell any rotation.
[[nodiscard]] AnglesText shown_angles(const Certificate& certificate);

/// Angles [rad] of the rotation `r`, customary ones. Where two of them turn about one axis, the first is 0 or, of roll,
/// pitch and yaw, the roll is. @pre kind is not kAxis
[[nodiscard]] std::array<double, 3> angles_of(AngleKind kind, const Matrix3<double>& r);

/// The same of angles `x` of a model, which may be of another kind.
[[nodiscard]] std::array<double, 3> angles_of(AngleKind kind, const Angles<double>& model,
                                              const std::array<double, 3>& x);

/// Of the forms of the same orientation, whole turns included, the one nearest to `previous`: so that curves have no
/// jumps. @pre kind is not kAxis
[[nodiscard]] std::array<double, 3> nearest_angles(AngleKind kind, const std::array<double, 3>& angles,
                                                   const std::array<double, 3>& previous);

}  // namespace taut
