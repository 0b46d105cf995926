// The report: a certificate for the eye, one HTML page that an engineer can read, print and sign.
//
// Made from the certificate alone. It decides nothing and proves nothing: it prints what the certificate says, and
// pictures that are floating-point samples and say so. The page is self-contained (no script, no network) and shows
// nothing of the certificate unescaped.
#pragma once

#include <nlohmann/json_fwd.hpp>
#include <string>

#include "reports/summary/report_options.h"

namespace taut {

/// A complete HTML document, UTF-8.
/// @throws InputError where the certificate is not of the form of docs/certificate-format.md, or an option is too long or strange.
/// Digests and statements are not checked; that is taut-check's.
[[nodiscard]] std::string html_report(const nlohmann::json& certificate, const ReportOptions& options = {});

/// Its first page in other forms (summary.h). @throws as html_report.
[[nodiscard]] std::string text_summary(const nlohmann::json& certificate, const ReportOptions& options = {});
[[nodiscard]] std::string markdown_summary(const nlohmann::json& certificate, const ReportOptions& options = {});
[[nodiscard]] nlohmann::json json_summary(const nlohmann::json& certificate, const ReportOptions& options = {});

}  // namespace taut
