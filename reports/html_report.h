// The report: a certificate for the eye, one HTML page that an engineer can read, print and sign.
//
// Made from the certificate alone. It decides nothing and proves nothing: it prints what the certificate says, and
// pictures that are floating-point samples and say so. The page is self-contained (no script, no network) and shows
// nothing of the certificate unescaped.
#pragma once

#include <nlohmann/json_fwd.hpp>
#include <string>

namespace taut {

/// A complete HTML document, UTF-8.
/// @throws InputError where the certificate is not of the form of docs/certificate-format.md. Digests and statements
/// are not checked; that is taut-check's.
[[nodiscard]] std::string html_report(const nlohmann::json& certificate);

/// The verdict in a few lines of plain text, as at the head of the page. @throws as html_report.
[[nodiscard]] std::string text_summary(const nlohmann::json& certificate);

}  // namespace taut
