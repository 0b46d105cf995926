// SPDX-License-Identifier: GPL-3.0-or-later
// The report: a certificate for the eye, one HTML page that an engineer can read, print and sign.
//
// Made from what the checker found, of the very bytes that it checked: a verdict is shown only where it made a theorem.
// A certificate that was not checked within the budget is headed UNCHECKED, and nothing that it claims is shown.
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
/// @throws InputError where the report can't show what is in the certificate, or an option is too long or strange.
/// @pre the checker rejected nothing: accepted, undecided or unchecked.
[[nodiscard]] std::string html_report(const checker::CheckResult& checked, const ReportOptions& options = {});
/// The same of a scene.
[[nodiscard]] std::string html_report(const ReportContext& scene, const ReportOptions& options = {});

/// Its first page in other forms (summary.h). @throws and @pre as html_report.
[[nodiscard]] std::string text_summary(const checker::CheckResult& checked, const ReportOptions& options = {});
[[nodiscard]] std::string markdown_summary(const checker::CheckResult& checked, const ReportOptions& options = {});
[[nodiscard]] nlohmann::json json_summary(const checker::CheckResult& checked, const ReportOptions& options = {});

}  // namespace taut
