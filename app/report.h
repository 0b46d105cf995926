// SPDX-License-Identifier: GPL-3.0-or-later
// Reports of what the checker said of a certificate, in each of their forms.
#pragma once

#include <string>

#include "checker/check.h"
#include "reports/summary/report_options.h"

namespace taut {

enum class ReportForm {
  kPage,  ///< HTML
  // The page's first page alone:
  kText,
  kMarkdown,
  kJson,
};

/// @throws InputError where a report can't show what is in the certificate.
/// @pre the checker has neither rejected the certificate nor found it malformed.
[[nodiscard]] std::string make_report(const checker::CheckResult& checked, const ReportOptions& options,
                                      ReportForm form);

/// "2024-02-29": today in UTC, or the day of SOURCE_DATE_EPOCH where that is set.
/// @throws InputError where SOURCE_DATE_EPOCH is not a number of seconds.
[[nodiscard]] std::string report_date();

}  // namespace taut
