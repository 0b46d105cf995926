// SPDX-License-Identifier: GPL-3.0-or-later
#include "reports/page/html_report.h"

#include <algorithm>
#include <nlohmann/json.hpp>

#include "base/input_error.h"
#include "base/sanitize.h"
#include "reports/page/first_page.h"
#include "reports/page/plane.h"
#include "reports/page/plot_sections.h"
#include "reports/page/sections.h"
#include "reports/page/sticky_bar.h"
#include "reports/page/style.h"
#include "reports/summary/wording.h"

namespace taut {

namespace {

Html contents(const ReportContext& scene) {
  std::vector<ContentsLink> links;
  const auto link = [&](bool present, const char* id, const char* title) {
    if (present) links.push_back({id, title});
  };
  const bool has_path = shows_path(scene);
  const bool is_claimed = scene.recheck.result == Recheck::Result::kConfirmed;
  link(has_path, "move", "The move");
  link(!scene.certificate.stretches.empty(), "stretches", "Stretches");
  link(has_path, "tensions", "Tensions");
  link(has_path, "lengths", "Lengths");
  link(has_path, "pose", "Pose");
  link(is_plane(scene.certificate.problem.space), "plane", "Plane");
  link(is_claimed && count_boxes(scene.certificate) > 0, "margins", "Margins");
  link(is_claimed, "theorem", "Claim");
  link(is_claimed && scene.certificate.problem.tolerances.has_value(), "tolerances", "Tolerances");
  link(true, "assumptions", "Assumptions");
  link(true, "robot", "Robot");
  link(true, "path", "Path");
  link(true, "inputs", "Digests");
  link(true, "recheck", "Check again");
  return sticky_bar(scene, links);
}

/// Checks document numbers, revisions and dates, which are put into a style sheet and printed.
void require_plain(const ReportOptions& options) {
  constexpr std::size_t kLongest = 40;
  const auto is_plain = [](char c) {
    return (c >= '0' && c <= '9') || (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') ||
           std::string_view(" .,:;/_+-#()").find(c) != std::string_view::npos;
  };
  const auto require = [&](const std::string& text, const char* what) {
    if (text.size() > kLongest || !std::ranges::all_of(text, is_plain)) {
      throw InputError(
          ErrorCode::kUse,
          fmt::format("{}: got '{}', expected at most {} letters, digits, blanks and . , : ; / _ + - # ( )", what,
                      excerpt(text), kLongest));
    }
  };
  require(options.document, "document");
  require(options.revision, "revision");
  require(options.date, "date");
}

/// The style sheet's part for the page's footer, with the document's number and the page number. @pre the document's
/// number has no quote or backslash.
std::string footer_style(const std::string& document) {
  return fmt::format(
      "@media print {{ @page {{ @bottom-left {{ content: \"{}\"; }} @bottom-right {{ content: \"Page \" counter(page) "
      "\" of "
      "\" counter(pages); }} }} }}\n",
      document);
}

}  // namespace

std::string html_report(const ReportContext& scene, const ReportOptions& options) {
  require_plain(options);
  const Summary summary(scene, options);
  const bool is_claimed = scene.recheck.result == Recheck::Result::kConfirmed;
  const Html claim = is_claimed ? margins(scene) + theorem(scene.certificate) + tolerances(scene) : Html();
  const Html body = first_page(scene, summary) + move_section(scene) + stretches(scene) + headroom(scene) +
                    plot_sections(scene) + claim + assumptions(scene.certificate.problem) + robot(scene) +
                    path_section(scene) + inputs(scene.certificate) + recheck(scene);
  const Html title = html("Motion report: {}", summary.verdict);
  // An empty icon keeps browsers from asking a server for one.
  return fmt::format(
      "<!DOCTYPE html>\n<html lang=\"en\">\n<head>\n<meta charset=\"utf-8\">\n"
      "<meta name=\"viewport\" content=\"width=device-width, initial-scale=1\">\n"
      "<meta http-equiv=\"Content-Security-Policy\" content=\"{}\">\n<link rel=\"icon\" "
      "href=\"data:,\">\n<title>{}</title>\n<style>{}{}{}</style>\n</head>\n<body>\n{}<main>\n{}</main>\n{}</body>\n"
      "</html>\n",
      content_security_policy(), title.str(), kStyle, kStickyBarStyle, footer_style(summary.document),
      contents(scene).str(), body.str(), page_scripts(scene));
}

std::string html_report(const checker::CheckResult& checked, const ReportOptions& options) {
  return html_report(ReportContext(checked), options);
}
std::string text_summary(const checker::CheckResult& checked, const ReportOptions& options) {
  require_plain(options);
  return to_text(Summary(ReportContext(checked), options));
}
std::string markdown_summary(const checker::CheckResult& checked, const ReportOptions& options) {
  require_plain(options);
  return to_markdown(Summary(ReportContext(checked), options));
}
nlohmann::json json_summary(const checker::CheckResult& checked, const ReportOptions& options) {
  require_plain(options);
  return to_json(Summary(ReportContext(checked), options));
}

}  // namespace taut
