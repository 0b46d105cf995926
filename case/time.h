// SPDX-License-Identifier: GPL-3.0-or-later
// What a case file says of time: limits of a move, and how it is planned. Internal to case/.
#pragma once

#include <string>
#include <vector>

#include "case/case_file.h"
#include "case/fields.h"
#include "problem/problem.h"

namespace taut::case_fields {

struct CaseTime {
  TimeText limits;
  MoveOptions move;
};

/// Reads `time`. Whether limits are above zero is for validate() to say.
/// @param load  of the same case
[[nodiscard]] CaseTime read_time(const Field& field, const Units& units, const Field& load);

/// Refuses a load that `time` does not go with. What has no inertia though it may be meant to is added to `warnings`.
/// @param around_items  whether `load` asks for one ellipsoid instead of its items
void check_load_in_time(const Field& time, const LoadText& load, bool around_items, std::vector<std::string>& warnings);

}  // namespace taut::case_fields
