// SPDX-License-Identifier: GPL-3.0-or-later
#include "reports/page/legs_page.h"

#include <fmt/format.h>

#include <algorithm>
#include <nlohmann/json.hpp>
#include <vector>

#include "reports/page/document.h"
#include "reports/page/first_page.h"
#include "reports/page/markup.h"
#include "reports/summary/load_statement.h"
#include "reports/summary/scene.h"
#include "reports/summary/summary.h"

namespace taut {
namespace {

/// A leg, and what its own report says of it.
struct LegOnPage {
  LegOnPage(const checker::CheckResult& checked, const ReportOptions& options)
      : scene(checked), summary(scene, options), name(name_of(scene.certificate.problem.name)) {}

  ReportContext scene;
  Summary summary;
  std::string name;

 private:
  /// Of a leg's problem, "CASE, leg NAME".
  static std::string name_of(const std::string& problem) {
    constexpr std::string_view kBefore = ", leg ";
    const std::size_t at = problem.rfind(kBefore);
    return at == std::string::npos ? problem : problem.substr(at + kBefore.size());
  }
};

/// The verdict over all as style sheets name it, and as nobody misreads it.
struct Word {
  const char* kind;
  std::string text;
};

Word word_of(const checker::CheckResult& checked) {
  if (checked.theorem) {
    const bool is_proved = checked.theorem->verdict() == checker::Theorem::Verdict::kProved;
    return is_proved ? Word{"proved", "PROVED"} : Word{"refuted", "DO NOT RUN"};
  }
  return checked.outcome == checker::Outcome::kUndecided ? Word{"undecided", "NO DECISION"}
                                                         : Word{"unchecked", "UNCHECKED"};
}

Html band(const Word& word, const std::string& headline) {
  const bool is_known = word.text != "UNCHECKED";
  const Html checks = is_known ? html("<ul class=\"checks\"><li>Re-checked by a second program <b>✓</b></li></ul>")
                               : html("<ul class=\"checks\"><li><b>Not re-checked</b></li></ul>");
  return html("<div class=\"band {}\"><p class=\"word\">{}{}</p><p class=\"headline\">{}</p>{}</div>\n", word.kind,
              verdict_icon(word.kind), word.text, headline, checks);
}

std::string headline(const Word& word, const std::vector<LegOnPage>& legs) {
  if (word.kind == std::string_view("proved")) {
    return fmt::format(
        "All {} legs are proved, each with its own load, and each begins at the very pose at which the one before it "
        "ends.",
        legs.size());
  }
  const auto decisive =
      std::ranges::find_if(legs, [&](const LegOnPage& leg) { return leg.summary.verdict == word.kind; });
  if (decisive == legs.end()) return "Not all legs were checked. Nothing is claimed.";
  return fmt::format("Leg {} of {}, {}: {}", decisive - legs.begin() + 1, legs.size(), decisive->name,
                     decisive->summary.headline);
}

/// Those of tensions, lengths and bodies; the leg's own report has all.
Html numbers_of(const Summary& summary) {
  Html lines;
  for (const KeyNumber& number : summary.key_numbers) {
    if (number.is_of_rate || number.key == std::string_view("duration")) continue;
    lines += html("{}{}: {}", lines.empty() ? Html() : html("<br>"), number.title, number.value);
  }
  return lines;
}

/// Names of legs are, in certificates of taut's own; in others a name may be anything.
bool is_folder_name(const std::string& name) {
  return std::ranges::all_of(name, [](char c) {
    return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || (c >= '0' && c <= '9') || c == '-' || c == '_';
  });
}

Html table_of_legs(const std::vector<LegOnPage>& legs) {
  std::vector<std::vector<Html>> rows;
  for (std::size_t k = 0; k < legs.size(); ++k) {
    const Certificate& certificate = legs[k].scene.certificate;
    const std::vector<std::string> load = brief_lines(load_statement(certificate.problem));
    const auto& timing = certificate.path.timing;
    const Html leg = html("<bdi>{} {}</bdi>", k + 1, legs[k].name);
    rows.push_back(
        {is_folder_name(legs[k].name) ? html("<a href=\"{}-{}/report.html\">{}</a>", k + 1, legs[k].name, leg) : leg,
         html("{}", verdict_in_full(legs[k].summary)), html("<bdi>{}</bdi>", load.empty() ? "" : load.front()),
         timing ? html("{}", fmt::format("{:.4g} s", timing->duration_s())) : html("–"), numbers_of(legs[k].summary)});
  }
  return table(html("Legs"),
               {{html("Leg")}, {html("Verdict")}, {html("Load")}, {html("Duration"), true}, {html("Key numbers")}},
               rows);
}

Html uncovered_of_legs(const Summary& first) {
  Html items = html(
      "<li>taking a load and putting it down between two legs, what the machine carries meanwhile, and how long it "
      "takes</li>");
  for (const ScopeItem& item : first.not_covered) items += html("<li>{}</li>", item.brief);
  return html("<ul>{}</ul>\n<p>The reports of the legs say in full what each verdict assumes and leaves out.</p>\n",
              items);
}

Html claim(const checker::CheckResult& checked) {
  if (!checked.theorem) return {};
  return section("theorem", "What is claimed", html("<blockquote>{}</blockquote>\n", checked.theorem->claim()));
}

Html check_again(const checker::CheckResult& checked) {
  return section("recheck", "How to check this again",
                 html("<p>Another program, with other arithmetic, proves the certificate of all legs again, each as it "
                      "would alone.</p>\n<pre>taut-check certificate.json CASE.yaml</pre>\n<p>Its answer for this "
                      "report: {}.</p>\n<p>SHA-256 of the certificate: <span class=\"digest\">{}</span></p>\n",
                      checked.message, checked.sha256));
}

}  // namespace

std::string legs_page(const checker::CheckResult& checked, const ReportOptions& options) {
  std::vector<LegOnPage> legs;
  legs.reserve(checked.legs.size());
  for (const checker::CheckResult& leg : checked.legs) legs.emplace_back(leg, options);
  const Summary& first = legs.front().summary;
  const Word word = word_of(checked);
  const std::string footer = checked.certificate->at("footer").at("sha256").get<std::string>();
  const std::string document = options.document.empty() ? document_number(footer) : options.document;
  const Html body = html("<header class=\"first\">\n{}<h1><bdi>{}</bdi></h1>\n{}{}</header>\n",
                         masthead(document, options.revision, options.date), first.title, title_note(),
                         band(word, headline(word, legs))) +
                    section("legs", "Legs", table_of_legs(legs)) +
                    section("assumptions", "What this verdict says nothing about", uncovered_of_legs(first)) +
                    claim(checked) + check_again(checked);
  return html_document({.window_title = "Report of legs: " + word.text,
                        .title = first.title,
                        .word = word.text,
                        .document = document,
                        .revision = options.revision,
                        .date = options.date,
                        .policy = "default-src 'none'; style-src 'unsafe-inline'; img-src data:; font-src data:",
                        .more_style = "#legs td:nth-child(-n+2) { white-space: nowrap; }\n"},
                       fmt::format("<main>\n{}</main>\n", body.str()));
}

}  // namespace taut
