// SPDX-License-Identifier: GPL-3.0-or-later
// What to change in a case so that its path is proved.
#pragma once

#include <functional>
#include <stop_token>
#include <string>

#include "app/audit.h"
#include "certify/sensitivity.h"
#include "planner/planner.h"

namespace taut {

struct CaseSensitivity {
  Verdict verdict = Verdict::kUndecided;  ///< of the path, by the prover alone
  std::size_t segments = 0;
  Headroom headroom;  ///< its subject is the path or the straight way
  Sensitivity sensitivity;
};

/// What is called now and then: what is being done, and how much of it is done.
using SensitivityProgress = std::function<void(const char* stage, std::size_t done, std::size_t all)>;

/// Plans the case, and examines the path; where none is found, the straight way through the query.
/// @param seconds  the budget of what follows the plan
/// @throws InputError where there is nothing to plan
[[nodiscard]] CaseSensitivity plan_sensitivity(const Case& the_case, double seconds,
                                               const SensitivityProgress& progress, const std::stop_token& stop);

/// Examines a path that something else made.
/// @throws InputError as PathSource, and for more than kMostReported segments
[[nodiscard]] CaseSensitivity audit_sensitivity(const Case& the_case, PathSource& source, double seconds,
                                                const SensitivityProgress& progress, const std::stop_token& stop);

}  // namespace taut
