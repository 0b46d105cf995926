// SPDX-License-Identifier: GPL-3.0-or-later
// What `taut sensitivity` finds, for programs.
#pragma once

#include <nlohmann/json.hpp>

#include "app/sensitivity.h"

namespace taut {

/// "proved", "refuted", "undecided"
[[nodiscard]] const char* verdict_name(Verdict verdict);

/// As docs/sensitivity.md has it.
/// @param problem  that `found` is about
[[nodiscard]] nlohmann::json to_json(const Problem& problem, const CaseSensitivity& found);

}  // namespace taut
