// SPDX-License-Identifier: GPL-3.0-or-later
// Whether a body contains a ball, in floating point: to tell mistakes, not to prove. Internal to case/.
#pragma once

#include "problem/bodies.h"

namespace taut::case_fields {

/// Whether all points within `radius` of `centre` are within `reach` of the body, up to rounding. For hulls it is
/// false, too, where this holds of the ball but not of one 1.13 times as large. False for meshes.
/// @param centre  in the axes of the body's `at` [m]
[[nodiscard]] bool contains_ball_approx(const BodyText& body, const PointText& centre, double radius, double reach);

}  // namespace taut::case_fields
