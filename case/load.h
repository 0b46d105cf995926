// SPDX-License-Identifier: GPL-3.0-or-later
// The load of a case file, and the tolerances of it. Internal to case/.
#pragma once

#include <string>
#include <vector>

#include "case/fields.h"
#include "problem/problem.h"

namespace taut::case_fields {

/// Reads `load`. What may not be meant as it was typed is added to `warnings`. @param in_time  whether the case has
/// `time`: only then a weight's `inertia` is a part of the load
[[nodiscard]] LoadText read_load(const Field& field, const Units& units, bool in_time,
                                 std::vector<std::string>& warnings);

/// Whether `load`, which read_load() has read, asks for one ellipsoid instead of its items.
[[nodiscard]] bool is_around_items(const Field& load);

/// Reads the tolerance of the wrench w0 from `tolerances`, where it is that of the mass in `load` or of the wrench
/// itself.
void read_load_tolerance(const Map& tolerances, const Field& load, const Units& units, TolerancesText& result);

}  // namespace taut::case_fields
