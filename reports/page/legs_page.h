// SPDX-License-Identifier: GPL-3.0-or-later
// The overview of a certificate of legs: the verdict over all, the legs in a table with links to their own reports, and
// what nothing is claimed of.
#pragma once

#include <string>

#include "checker/check.h"
#include "reports/summary/report_options.h"

namespace taut {

/// A complete HTML document, UTF-8, without a script. Its links lead to K-NAME/report.html, where `taut plan` writes
/// the report of leg K.
/// @throws InputError where a report can't show what is in a leg.
/// @pre a certificate of legs, of which the checker rejected nothing
[[nodiscard]] std::string legs_page(const checker::CheckResult& checked, const ReportOptions& options);

}  // namespace taut
