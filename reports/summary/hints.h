// SPDX-License-Identifier: GPL-3.0-or-later
// Guesses, in floating point, at what is wrong with a pose that is not feasible. Nothing here is proved.
#pragma once

#include <string>

#include "kinematics/segment.h"
#include "kinematics/statics.h"

namespace taut {

/// Tensions beyond this many times the greatest limit mean a pose that is singular but for rounding.
inline constexpr double kSingularTension = 1e6;

/// Whether the pose is singular, or so near a singular one that a tension is beyond kSingularTension.
[[nodiscard]] bool is_nearly_singular(const Model<double>& model, const Statics<double>& statics);

/// A question to the user where every cable is slack under the nominal load and would be within its limits under the
/// opposite one: is gravity reversed? Else empty.
[[nodiscard]] std::string reversed_load_hint(const Model<double>& model, const Statics<double>& statics);
/// The same at the beginning of a path, which has at least one waypoint.
[[nodiscard]] std::string reversed_load_hint(const Problem& problem, const Path& path);

}  // namespace taut
