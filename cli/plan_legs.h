// SPDX-License-Identifier: GPL-3.0-or-later
// `taut plan` of a case with legs: what it writes and what it says.
#pragma once

#include <filesystem>
#include <optional>
#include <string>

#include "app/plan.h"
#include "case/case_of_legs.h"
#include "certificate/signature.h"
#include "cli/output.h"
#include "cli/plan_command.h"

namespace taut {

/// Refuses options that are about one path. @throws InputError
void require_options_of_legs(const PlanArguments& arguments);

/// Plans all legs and writes, all at once, certificate.json of all, and of each leg what a plan of it alone would
/// write, into the folder K-NAME; of moves that are proved also tables in time of all legs.
/// @param options  of each leg
/// @returns the exit code. @throws InputError
[[nodiscard]] int run_plan_of_legs(const CaseOfLegs& the_case, const PlanArguments& arguments,
                                   const PlannedCaseOptions& options, const Stopwatch& stopwatch);

}  // namespace taut
