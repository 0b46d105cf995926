// SPDX-License-Identifier: GPL-3.0-or-later
#include "reports/page/legs_page.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <nlohmann/json.hpp>
#include <optional>
#include <utility>
#include <vector>

#include "reports/page/document.h"
#include "reports/page/first_page.h"
#include "reports/page/markup.h"
#include "reports/summary/headroom_of_legs.h"
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

bool have_bodies(const std::vector<LegOnPage>& legs) {
  return std::ranges::any_of(legs,
                             [](const LegOnPage& leg) { return leg.scene.certificate.problem.bodies.has_value(); });
}

/// The names of a leg's bodies; the leg's own report says what they are.
Html bodies_of(const std::optional<BodiesText>& bodies) {
  if (!bodies) return html("none: collisions are not covered");
  const auto names = [](const std::vector<BodyText>& list) {
    std::vector<std::string> result;
    for (const BodyText& body : list) result.push_back(body.name);
    return result;
  };
  std::vector<std::string> parts;
  if (!bodies->platform.empty()) {
    parts.push_back(fmt::format("on the platform: {}", fmt::join(names(bodies->platform), ", ")));
  }
  if (!bodies->obstacles.empty()) {
    parts.push_back(fmt::format("obstacles: {}", fmt::join(names(bodies->obstacles), ", ")));
  }
  if (parts.empty()) parts.emplace_back("cables alone");
  Html lines;
  for (const std::string& part : parts) lines += html("{}<bdi>{}</bdi>", lines.empty() ? Html() : html("<br>"), part);
  return lines;
}

Html table_of_legs(const std::vector<LegOnPage>& legs) {
  const bool has_bodies = have_bodies(legs);
  std::vector<Column> head = {{html("Leg")}, {html("Verdict")}, {html("Load")}};
  if (has_bodies) head.push_back({html("Bodies")});
  head.push_back({html("Duration"), true});
  head.push_back({html("Key numbers")});
  std::vector<std::vector<Html>> rows;
  for (std::size_t k = 0; k < legs.size(); ++k) {
    const Certificate& certificate = legs[k].scene.certificate;
    const std::vector<std::string> load = brief_lines(load_statement(certificate.problem));
    const auto& timing = certificate.path.timing;
    const Html leg = html("<bdi>{} {}</bdi>", k + 1, legs[k].name);
    std::vector<Html> row = {
        is_folder_name(legs[k].name) ? html("<a href=\"{}-{}/report.html\">{}</a>", k + 1, legs[k].name, leg) : leg,
        html("{}", verdict_in_full(legs[k].summary)), html("<bdi>{}</bdi>", load.empty() ? "" : load.front())};
    if (has_bodies) row.push_back(bodies_of(certificate.problem.bodies));
    row.push_back(timing ? html("{}", fmt::format("{:.4g} s", timing->duration_s())) : html("–"));
    row.push_back(numbers_of(legs[k].summary));
    rows.push_back(std::move(row));
  }
  return table(html("Legs"), head, rows);
}

/// What some leg does not cover, each once; where others do, with the legs that do not.
Html uncovered_of_legs(const std::vector<LegOnPage>& legs) {
  Html items = html(
      "<li>taking a load and putting it down between two legs, what the machine carries meanwhile, and how long it "
      "takes</li>");
  if (have_bodies(legs))
    items += html("<li>whether what one leg carries stands where the obstacles of others say</li>");
  std::vector<std::pair<std::string, std::vector<std::string>>> found;  // what, and the names of the legs
  for (const LegOnPage& leg : legs) {
    for (const ScopeItem& item : leg.summary.not_covered) {
      auto at = std::ranges::find(found, item.brief, [](const auto& entry) { return entry.first; });
      if (at == found.end()) at = found.insert(found.end(), {item.brief, {}});
      at->second.push_back(leg.name);
    }
  }
  for (const auto& [what, names] : found) {
    items += names.size() == legs.size()
                 ? html("<li>{}</li>", what)
                 : html("<li>{} (<bdi>{}</bdi>)</li>", what, fmt::format("{}", fmt::join(names, ", ")));
  }
  return html("<ul>{}</ul>\n<p>The reports of the legs say in full what each verdict assumes and leaves out.</p>\n",
              items);
}

std::vector<LegHeadroom> headroom_of(const std::vector<LegOnPage>& legs) {
  std::vector<LegHeadroom> result;
  for (const LegOnPage& leg : legs) {
    result.push_back({leg.name, leg.scene.illustration.headroom, leg.scene.certificate.problem});
  }
  return result;
}

Html headroom(const std::vector<LegOnPage>& legs) {
  const auto is_unchecked = [](const LegOnPage& leg) {
    return leg.scene.recheck.result == Recheck::Result::kUnchecked;
  };
  if (std::ranges::any_of(legs, is_unchecked)) return {};
  Html body;
  for (const std::string& sentence : headroom_sentences(headroom_of(legs), legs.front().scene.illustration.units)) {
    body += html("<p><bdi>{}</bdi></p>\n", sentence);
  }
  if (body.empty()) return {};
  return section(
      "headroom", "How far the proofs reach",
      body + html("<p class=\"note\">The program that wrote the certificates of the legs proved these shares. "
                  "They are no part of the claim, and nothing has checked them.</p>\n"));
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
  // Without a title of its own a leg is headed "CASE, leg NAME".
  const Summary& first = legs.front().summary;
  const std::string of_leg = ", leg " + legs.front().name;
  std::string title = first.title;
  if (title.ends_with(of_leg)) title.erase(title.size() - of_leg.size());
  const Word word = word_of(checked);
  const std::string footer = checked.certificate->at("footer").at("sha256").get<std::string>();
  const std::string document = options.document.empty() ? document_number(footer) : options.document;
  const Html body =
      html("<header class=\"first\">\n{}<h1><bdi>{}</bdi></h1>\n{}{}</header>\n",
           masthead(document, options.revision, options.date), title, title_note(), band(word, headline(word, legs))) +
      section("legs", "Legs", table_of_legs(legs)) + headroom(legs) +
      section("assumptions", "What this verdict says nothing about", uncovered_of_legs(legs)) + claim(checked) +
      check_again(checked);
  return html_document({.window_title = "Report of legs: " + word.text,
                        .title = title,
                        .word = word.text,
                        .document = document,
                        .revision = options.revision,
                        .date = options.date,
                        .policy = "default-src 'none'; style-src 'unsafe-inline'; img-src data:; font-src data:",
                        .more_style = "#legs td:nth-child(-n+2) { white-space: nowrap; }\n"},
                       fmt::format("<main>\n{}</main>\n", body.str()));
}

}  // namespace taut
