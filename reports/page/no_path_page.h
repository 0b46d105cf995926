// SPDX-License-Identifier: GPL-3.0-or-later
// The report of a certificate that no path exists: a page of its own, without a script, and its content in other forms.
#pragma once

#include <nlohmann/json_fwd.hpp>
#include <string>

#include "checker/check.h"
#include "reports/summary/report_options.h"

namespace taut {

/// Whether what was checked is a certificate that no path exists.
[[nodiscard]] bool is_about_no_path(const checker::CheckResult& checked);

/// A complete HTML document, UTF-8: verdict, claim, waypoints, space, and a picture of the cells where there are two
/// coordinates. @pre is_about_no_path(), and the checker rejected nothing
[[nodiscard]] std::string no_path_page(const checker::CheckResult& checked, const ReportOptions& options);
/// The same in lines of plain text; in Markdown these are a list.
[[nodiscard]] std::string no_path_text(const checker::CheckResult& checked, const ReportOptions& options,
                                       bool is_markdown);
[[nodiscard]] nlohmann::json no_path_json(const checker::CheckResult& checked, const ReportOptions& options);

}  // namespace taut
