// SPDX-License-Identifier: GPL-3.0-or-later
// The report: a certificate as one HTML page that an engineer can read, print and sign.
//
// It is made from the checker's result and from the same bytes that were checked: it shows a verdict only if the
// checker made a theorem. A certificate that was not checked within the budget is headed UNCHECKED, and none of its
// claims is shown.
// Pictures are floating-point samples and say so. The page needs no network; its one script draws the plots, and
// nothing of the certificate is shown unescaped.
#pragma once

#include <nlohmann/json_fwd.hpp>
#include <string>

#include "checker/check.h"
#include "reports/summary/report_options.h"
#include "reports/summary/scene.h"

namespace taut {

/// A complete HTML document, UTF-8.
/// @throws InputError if the report can't show the certificate's content, or an option is too long or has characters
/// that are not allowed.
/// @pre the checker rejected nothing: accepted, undecided or unchecked.
[[nodiscard]] std::string html_report(const checker::CheckResult& checked, const ReportOptions& options = {});
/// The same for a context that was made before.
[[nodiscard]] std::string html_report(const ReportContext& scene, const ReportOptions& options = {});

/// The report's first page in other forms (summary.h). @throws and @pre as html_report.
[[nodiscard]] std::string text_summary(const checker::CheckResult& checked, const ReportOptions& options = {});
[[nodiscard]] std::string markdown_summary(const checker::CheckResult& checked, const ReportOptions& options = {});
[[nodiscard]] nlohmann::json json_summary(const checker::CheckResult& checked, const ReportOptions& options = {});

}  // namespace taut
