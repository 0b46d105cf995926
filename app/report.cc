// SPDX-License-Identifier: GPL-3.0-or-later
#include "app/report.h"

#include <fmt/chrono.h>
#include <fmt/format.h>

#include <charconv>
#include <chrono>
#include <cstdlib>
#include <ctime>
#include <nlohmann/json.hpp>

#include "base/input_error.h"
#include "reports/page/html_report.h"

namespace taut {

std::string make_report(const checker::CheckResult& checked, const ReportOptions& options, ReportForm form) {
  switch (form) {
    case ReportForm::kPage: break;
    case ReportForm::kText: return text_summary(checked, options);
    case ReportForm::kMarkdown: return markdown_summary(checked, options);
    case ReportForm::kJson:
      return json_summary(checked, options).dump(1, ' ', true, nlohmann::json::error_handler_t::replace) + "\n";
  }
  return html_report(checked, options);
}

std::string report_date() {
  std::time_t now = std::chrono::system_clock::to_time_t(std::chrono::system_clock::now());
  if (const char* epoch = std::getenv("SOURCE_DATE_EPOCH"); epoch != nullptr && *epoch != '\0') {
    const std::string_view text = epoch;
    constexpr std::time_t kLatest = 253402300799;  // the end of the year 9999
    const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), now);
    if (error != std::errc() || end != text.data() + text.size() || now < 0 || now > kLatest) {
      throw InputError(ErrorCode::kUse, fmt::format("SOURCE_DATE_EPOCH: got '{}', expected seconds since 1970", text));
    }
  }
  return fmt::format("{:%Y-%m-%d}", fmt::gmtime(now));
}

}  // namespace taut
