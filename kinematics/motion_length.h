// SPDX-License-Identifier: GPL-3.0-or-later
// How long a motion is, by any distance between near poses. Floating point, for comparison and reports.
#pragma once

#include <functional>
#include <vector>

#include "kinematics/segment.h"

namespace taut {

/// λ at the point s of a segment.
using ParametersAt = std::function<std::vector<double>(const Segment& segment, double s)>;
/// The length of a short way; symmetric, as good as Riemannian for near arguments.
using ShortDistance = std::function<double(const std::vector<double>& a, const std::vector<double>& b)>;

/// ℓ(s), which is the motion itself in a space without constraints.
[[nodiscard]] std::vector<double> curve_parameters(const Segment& segment, double s);

/// Sum of distances over `pieces` pieces a segment, extrapolated from half as many; error of order pieces^-4.
[[nodiscard]] double motion_length(const Path& path, const ParametersAt& parameters, const ShortDistance& distance,
                                   int pieces = 16);

}  // namespace taut
