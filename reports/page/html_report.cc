// SPDX-License-Identifier: GPL-3.0-or-later
#include "reports/page/html_report.h"

#include <nlohmann/json.hpp>

#include "base/input_error.h"
#include "base/labels.h"
#include "base/sanitize.h"
#include "reports/page/appendix.h"
#include "reports/page/assurance_drawing.h"
#include "reports/page/document.h"
#include "reports/page/first_page.h"
#include "reports/page/legs_page.h"
#include "reports/page/margins.h"
#include "reports/page/no_path_page.h"
#include "reports/page/plane.h"
#include "reports/page/plot_sections.h"
#include "reports/page/sections.h"
#include "reports/page/sticky_bar.h"
#include "reports/summary/time_statement.h"
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
  link(!scene.samples.empty(), "move", move_title(scene));
  link(has_path, "pose", "Pose");
  link(has_path, "tensions", "Tensions");
  link(has_path, "lengths", "Lengths");
  link(has_path && is_move(scene.certificate), "winches", "Winches");
  link(is_plane(scene.certificate.problem.space), "plane", "Plane");
  link(!scene.certificate.stretches.empty(), "stretches", "Stretches");
  link(true, "robot", "Machine and load");
  link(is_claimed && scene.certificate.problem.tolerances.has_value(), "tolerances", "Tolerances");
  link(true, "assumptions", "Assumptions");
  link(true, "path", "Path");
  link(is_claimed, "theorem", "Claim");
  link(is_claimed && count_boxes(scene.certificate) > 0, "margins", "Margins");
  link(true, "appendix", "Appendix");
  link(true, "recheck", "Check again");
  link(true, "assurance", "Assurance case");
  link(true, "lift-plan", "Lift plan");
  return sticky_bar(scene, links);
}

/// Checks document numbers, revisions and dates, which are put into a style sheet and printed.
void require_plain(const ReportOptions& options) {
  const auto require = [&](const std::string& text, const char* what) {
    if (!is_document_label(text)) {
      throw InputError(ErrorCode::kUse,
                       fmt::format("{}: got '{}', expected {}", what, excerpt(text), kDocumentExpected));
    }
  };
  require(options.document, "document");
  require(options.revision, "revision");
  require(options.date, "date");
}

}  // namespace

std::string html_report(const ReportContext& scene, const ReportOptions& options) {
  require_plain(options);
  const Summary summary(scene, options);
  const bool is_claimed = scene.recheck.result == Recheck::Result::kConfirmed;
  // What a reader needs first comes first; then what the verdict is about; then how it was proved; then all digits.
  const Html results =
      move_section(scene) + cables_section(scene, summary) + plot_sections(scene) + headroom(scene) + stretches(scene);
  const Html inputs_in_words =
      machine(scene) + (is_claimed ? tolerances(scene) : Html()) + assumptions(scene.certificate) + path_section(scene);
  const Html proof = verdict_section(summary) + (is_claimed ? theorem(scene.certificate) + margins(scene) : Html());
  const Html exact = exact_load(scene) + space(scene.certificate) + exact_path(scene) + exact_stretches(scene) +
                     (is_claimed ? exact_margins(scene) : Html()) + inputs(scene.certificate) + recheck(scene);
  const Html body = first_page(scene, summary) + results + inputs_in_words + proof +
                    html("<div class=\"appendix\" id=\"appendix\">\n{}</div>\n", exact) +
                    assurance_section(scene, summary) + lift_plan_section(scene, summary);
  return html_document({.window_title = "Motion report: " + summary.verdict,
                        .title = summary.title,
                        .word = summary.word,
                        .document = summary.document,
                        .revision = summary.revision,
                        .date = summary.date,
                        .policy = content_security_policy(),
                        .more_style = std::string(kStickyBarStyle) + kAssuranceStyle},
                       fmt::format("{}<main>\n{}</main>\n{}", contents(scene).str(), body.str(), page_scripts(scene)));
}

std::string html_report(const checker::CheckResult& checked, const ReportOptions& options) {
  require_plain(options);
  if (is_about_no_path(checked)) return no_path_page(checked, options);
  if (!checked.legs.empty()) return legs_page(checked, options);
  return html_report(ReportContext(checked), options);
}
std::string text_summary(const checker::CheckResult& checked, const ReportOptions& options) {
  require_plain(options);
  if (is_about_no_path(checked)) return no_path_text(checked, options, false);
  return to_text(Summary(ReportContext(checked), options));
}
std::string markdown_summary(const checker::CheckResult& checked, const ReportOptions& options) {
  require_plain(options);
  if (is_about_no_path(checked)) return no_path_text(checked, options, true);
  return to_markdown(Summary(ReportContext(checked), options));
}
nlohmann::json json_summary(const checker::CheckResult& checked, const ReportOptions& options) {
  require_plain(options);
  if (is_about_no_path(checked)) return no_path_json(checked, options);
  return to_json(Summary(ReportContext(checked), options));
}

}  // namespace taut
