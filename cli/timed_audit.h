// SPDX-License-Identifier: GPL-3.0-or-later
// `taut audit --timed`: what it writes and what it says (docs/audits.md).
#pragma once

#include "app/audit.h"
#include "cli/audit_command.h"
#include "cli/output.h"

namespace taut {

/// @param the_case  as stated, with its limits in time
/// @param request   whose `timed` is true
/// @returns the exit code. @throws InputError
[[nodiscard]] int run_timed_audit(const AuditArguments& arguments, const Case& the_case, const AuditRequest& request,
                                  const Stopwatch& stopwatch);

}  // namespace taut
