// SPDX-License-Identifier: GPL-3.0-or-later
#include "cli/report_command.h"

#include <fmt/format.h>

#include <filesystem>
#include <nlohmann/json.hpp>

#include "app/meshes.h"
#include "app/recheck.h"
#include "app/report.h"
#include "base/files.h"
#include "base/input_error.h"
#include "base/sanitize.h"
#include "certificate/certificate_reader.h"
#include "certify/arithmetic/rounding.h"
#include "cli/browser.h"
#include "cli/console.h"
#include "cli/output.h"
#include "cli/verdict_output.h"

namespace taut {
namespace {

/// A report, and the name of the file for it unless another one is asked for.
struct Rendered {
  std::string content;
  const char* file_name;  ///< null: standard output
};

/// Nothing, where somebody asked to stop.
std::optional<Rendered> render(const ReportArguments& arguments, const checker::CheckResult& checked,
                               const ReportOptions& options, const std::stop_token& stop) {
  const ReportForm form = arguments.text       ? ReportForm::kText
                          : arguments.markdown ? ReportForm::kMarkdown
                          : arguments.json     ? ReportForm::kJson
                                               : ReportForm::kPage;
  std::string page = make_report(checked, options, form);
  if (form == ReportForm::kJson) {
    nlohmann::json document = nlohmann::json::parse(page);
    document["command"] = "report";
    page = json_text(document);
  }
  if (form != ReportForm::kPage) return Rendered{std::move(page), nullptr};
  if (!arguments.pdf) return Rendered{std::move(page), "report.html"};
  std::optional<std::string> pdf = print_to_pdf(page, stop);
  if (!pdf) return std::nullopt;
  return Rendered{std::move(*pdf), "report.pdf"};
}

}  // namespace

void add_report_options(CLI::App& command, ReportArguments& arguments) {
  command.add_option("CERTIFICATE", arguments.certificate_path, "certificate.json")->required();
  command.add_option(
      "--out", arguments.out,
      "file to write (default: report.html or report.pdf beside the certificate; summaries: standard output)");
  CLI::Option_group* form = command.add_option_group("form", "One of these; none: an HTML page");
  form->add_flag("--pdf", arguments.pdf, "the page as PDF, printed by an installed Chromium");
  form->add_flag("--text", arguments.text, "its first page as plain text");
  form->add_flag("--markdown", arguments.markdown, "its first page as Markdown");
  form->add_flag("--json", arguments.json, "its first page as JSON");
  form->require_option(0, 1);
  add_max_seconds_option(command, arguments.max_seconds);
  command.add_option("--document", arguments.document,
                     "number of the document (default: from the certificate's digest)");
  command.add_option("--revision", arguments.revision, "its revision (default: a line to write on)");
  command.add_option("--date", arguments.date, "its date (default: today in UTC, or of SOURCE_DATE_EPOCH)");
}

int run_report(const ReportArguments& arguments) {
  const std::string date = arguments.date.empty() ? report_date() : arguments.date;
  const Interruption interruption;
  // Read once: what is shown is what was checked.
  const std::string bytes = read_whole(arguments.certificate_path);
  const checker::CheckResult checked =
      recheck(bytes, arguments.max_seconds, interruption.token(),
              meshes_in({std::filesystem::path(arguments.certificate_path).parent_path()}));
  if (checked.outcome == checker::Outcome::kMalformed) {
    // A report's reader says what it saw and where; what only the checker minds is said in its words.
    with_error_code(ErrorCode::kCertificate, arguments.certificate_path,
                    [&] { (void)read_certificate(parse_certificate(bytes, arguments.certificate_path)); });
    throw InputError(ErrorCode::kCertificate,
                     fmt::format("{}: got {}, expected a certificate", arguments.certificate_path, checked.message),
                     {arguments.certificate_path});
  }
  if (checked.outcome == checker::Outcome::kRejected) {
    const std::string message =
        fmt::format("{}: {}. No report is made of it.", arguments.certificate_path, sentence(checked));
    complain(message);
    if (arguments.json && arguments.out.empty()) {
      print_json(error_json("report", sanitize(message), text(ErrorCode::kCertificate), kRefutedExit,
                            {arguments.certificate_path}));
    }
    return kRefutedExit;
  }
  const ReportOptions options{arguments.document, arguments.revision, date};
  const std::optional<Rendered> made = with_error_code(ErrorCode::kCertificate, arguments.certificate_path, [&] {
    return render(arguments, checked, options, interruption.token());
  });
  if (!made || interruption.token().stop_requested()) {
    return report_interruption("report", "interrupted: nothing was written", arguments.json && arguments.out.empty());
  }
  const Rendered& rendered = *made;
  if (arguments.out.empty() && rendered.file_name == nullptr) {
    if (arguments.text) {
      print_text_report(rendered.content);
    } else {
      fmt::print("{}", rendered.content);
    }
  } else {
    const std::filesystem::path target =
        arguments.out.empty() ? std::filesystem::path(arguments.certificate_path).parent_path() / rendered.file_name
                              : std::filesystem::path(arguments.out);
    std::error_code not_there;
    if (std::filesystem::equivalent(target, arguments.certificate_path, not_there)) {
      throw InputError(ErrorCode::kUse, fmt::format("--out: got '{}', which is the certificate, expected another file",
                                                    excerpt(target.string())));
    }
    write_whole({{target, rendered.content}});
    fmt::print("{}\nWritten: {}\n", sentence(checked), sanitize(target.string()));
  }
  if (checked.outcome != checker::Outcome::kUnchecked) return kProvedExit;
  complain(fmt::format("{}: {}", arguments.certificate_path, sentence(checked)));
  return kUndecidedExit;
}

}  // namespace taut
