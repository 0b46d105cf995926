// SPDX-License-Identifier: GPL-3.0-or-later
#include "reports/page/no_path_page.h"

#include <algorithm>
#include <nlohmann/json.hpp>
#include <string_view>
#include <vector>

#include "base/sanitize.h"
#include "reports/page/appendix.h"
#include "reports/page/document.h"
#include "reports/page/first_page.h"
#include "reports/page/machine_picture.h"
#include "reports/page/no_path_content.h"
#include "reports/page/no_path_picture.h"
#include "reports/page/sections.h"
#include "reports/summary/around_items.h"
#include "reports/summary/summary.h"
#include "reports/summary/wording.h"

namespace taut {
namespace {

using nlohmann::json;

bool is_about_verdict(const Statement& statement) { return statement.key == std::string_view("recheck"); }

// ---- Page -----------------------------------------------------------------------------------------------------------

/// What the verdict is about, before the verdict.
Html scope(const NoPathContent& content) {
  Html rows;
  const auto row = [&](const char* title, const Html& text) {
    rows += html("<div><dt>{}</dt><dd>{}</dd></div>\n", title, text);
  };
  if (!content.fields.machine.empty()) row("Machine", html("<bdi>{}</bdi>", content.fields.machine));
  if (!content.fields.site.empty()) row("Site", html("<bdi>{}</bdi>", content.fields.site));
  for (const Statement& statement : content.statements) {
    if (is_about_verdict(statement)) continue;
    row(statement.title, html("<bdi>{}</bdi>", with_minus_signs(statement.text)));
    if (statement.key == std::string_view("space")) row("Load", load_words(content.fields.load_name, content.load));
  }
  return html("<dl class=\"scope\">\n{}</dl>\n", rows);
}

Html band(const NoPathContent& content) {
  const Html checks = content.is_proved()
                          ? html(
                                "<ul class=\"checks\"><li>Re-checked by a second program <b>✓</b></li><li>Machine "
                                "exactly as typed</li></ul>")
                          : html("<ul class=\"checks\"><li><b>Not re-checked</b></li></ul>");
  const char* const kind = content.is_proved() ? "refuted" : "unchecked";
  return html("<div class=\"band {}\"><p class=\"word\">{}{}</p><p class=\"headline\">{}</p>{}</div>\n", kind,
              verdict_icon(kind), content.word, content.headline, checks);
}

Html not_covered(const NoPathContent& content) {
  Html items;
  for (const ScopeItem& item : content.not_covered) items += html("<li>{}</li>", item.brief);
  return html(
      "<div class=\"uncovered\"><p><b>This verdict says nothing about:</b> <a class=\"more\" href=\"#assumptions\">in "
      "full</a></p><ul>{}</ul></div>\n",
      items);
}

/// The machine at start and goal.
Html ends(const NoPathContent& content) {
  const ReportContext& scene = content.scene;
  const MachineView view(scene);
  constexpr PictureSize kSize = {420, 420};
  Html pictures;
  for (std::size_t n = 0; n < 2; ++n) {
    const PathSample sample = scene.sampler.at(scene.certificate.path, static_cast<double>(n));
    pictures += machine_picture(scene, view, static_cast<double>(n), nearness_at(scene.sampler.model(), sample.statics),
                                fmt::format("{}: waypoint {}, {}", n == 0 ? "Start" : "Goal", content.from + n,
                                            with_minus_signs(pose_text(scene, sample.pose))),
                                kSize);
  }
  return section("move", "Start and goal",
                 html("<p class=\"note\">Cables are coloured by floating-point values at these poses: grey is calm, "
                      "amber from 75 % of a limit, dashed from 95 %, red out of the limits. Dashed outlines are the "
                      "platform at the other place.</p>\n<div class=\"ends\">{}</div>\n",
                      pictures));
}

Html assumptions(const NoPathContent& content) {
  const auto list = [](const std::vector<ScopeItem>& items) {
    Html rows;
    for (const ScopeItem& item : items) rows += html("<li>{}</li>\n", item.text);
    return html("<ul>\n{}</ul>\n", rows);
  };
  return section("assumptions", "What is assumed, and what is not covered",
                 html("<div class=\"scopes\"><div><h3>Assumed</h3>\n{}</div>\n<div><h3>Not "
                      "covered</h3>\n{}</div></div>\n",
                      list(content.assumed), list(content.not_covered)));
}

Html claim(const NoPathContent& content) {
  if (!content.is_proved()) return {};
  return section(
      "theorem", "What is claimed",
      html("<blockquote>{}</blockquote>\n<p>The certificate divides the space into cells and states of {} why no pose "
           "of them is feasible. The checker proves each of these reasons again; it finds all other cells that hang "
           "together with the start, and the goal is in none of them.</p>\n",
           content.certificate().at("claim").get<std::string>(), content.checked.theorem->counts().boxes));
}

Html inputs(const NoPathContent& content) {
  const Certificate& certificate = content.scene.certificate;
  const auto row = [](const char* what, const std::string& digest) {
    return std::vector<Html>{html("{}", what), html("<span class=\"digest\">{}</span>", digest)};
  };
  return section("inputs", "Inputs and digests",
                 table(html("Inputs and digests"), {{html("What")}, {html("Value")}},
                       {{html("name of the case (not checked)"), html("<bdi>{}</bdi>", certificate.problem.name)},
                        {html("made by (not checked)"),
                         html("<bdi>{} {}</bdi>", certificate.generator.name, certificate.generator.version)},
                        row("certificate file, SHA-256", content.checked.sha256),
                        row("problem_sha256", certificate.problem_sha256),
                        row("footer.sha256", certificate.footer_sha256)}));
}

Html check_again(const NoPathContent& content) {
  return section("recheck", "How to check this again",
                 html("<p>Another program, with other arithmetic, proves the certificate again from nothing but the "
                      "certificate and the case file. It should exit with 0, accepted, if the claim is "
                      "true.</p>\n<pre>taut-check certificate.json CASE.yaml --expect 'no path'</pre>\n<p>Its answer "
                      "for this report: {}</p>\n",
                      content.statements.back().text));
}

}  // namespace

bool is_about_no_path(const checker::CheckResult& checked) {
  return checked.certificate && checked.certificate->is_object() &&
         checked.certificate->value("format", json()) == "taut-no-path-certificate";
}

std::string no_path_page(const checker::CheckResult& checked, const ReportOptions& options) {
  const NoPathContent content(checked, options);
  const Html first =
      html("<header class=\"first no-path\">\n{}<h1><bdi>{}</bdi></h1>\n{}{}{}{}{}</header>\n",
           masthead(content.document, content.revision, content.date), content.title, title_note(), scope(content),
           band(content), content.is_proved() ? no_path_picture(content) : Html(), not_covered(content));
  const Html exact =
      exact_load(content.scene) + space(content.scene.certificate) + inputs(content) + check_again(content);
  const Html body = first + ends(content) + claim(content) + assumptions(content) + machine(content.scene) +
                    html("<div class=\"appendix\" id=\"appendix\">\n{}</div>\n", exact);
  return html_document({.window_title = "Motion report: " + content.word,
                        .title = content.title,
                        .word = content.word,
                        .document = content.document,
                        .revision = content.revision,
                        .date = content.date,
                        .policy = "default-src 'none'; style-src 'unsafe-inline'; img-src data:; font-src data:",
                        .more_style = kNoPathStyle},
                       fmt::format("<main>\n{}</main>\n", body.str()));
}

// ---- Other forms ----------------------------------------------------------------------------------------------------

namespace {

/// What there is to say, each under its title.
std::vector<std::pair<std::string, std::string>> rows(const NoPathContent& content) {
  std::vector<std::pair<std::string, std::string>> result;
  const auto add = [&](const char* title, const std::string& text) {
    if (!text.empty()) result.emplace_back(title, text);
  };
  add("Document", content.document);
  add("Revision", content.revision);
  add("Date", content.date);
  add("Title", content.title);
  add("Machine", content.fields.machine);
  add("Site", content.fields.site);
  add("Load name", content.fields.load_name);
  add("Prepared by", content.fields.prepared_by);
  add("Case", content.scene.certificate.problem.name);
  for (const Statement& statement : content.statements) {
    if (is_about_verdict(statement)) add("Not covered", in_full(content.not_covered));
    add(statement.title, statement.text);
    if (statement.key != std::string_view("space")) continue;
    std::string load;
    for (const std::string& line : lines(content.load)) load += (load.empty() ? "" : " ") + line;
    add("Load", load);
  }
  if (content.is_proved()) add("Claim", content.certificate().at("claim").get<std::string>());
  add("SHA-256", content.checked.sha256);
  return result;
}

json text_or_null(const std::string& text) { return text.empty() ? json() : json(text); }

}  // namespace

std::string no_path_text(const checker::CheckResult& checked, const ReportOptions& options, bool is_markdown) {
  const NoPathContent content(checked, options);
  const auto plain = [&](const std::string& text) { return is_markdown ? markdown(text) : sanitize(text); };
  std::string result = fmt::format("{}{}: {}\n{}", is_markdown ? "## " : "", content.word, plain(content.headline),
                                   is_markdown ? "\n" : "");
  for (const auto& [title, text] : rows(content)) {
    result += fmt::format("{}{}: {}\n", is_markdown ? "- " : "", title, plain(text));
  }
  return result;
}

json no_path_json(const checker::CheckResult& checked, const ReportOptions& options) {
  const NoPathContent content(checked, options);
  json statements = json::object();
  for (const Statement& statement : content.statements) statements[statement.key] = statement.text;
  json not_covered = json::array();
  for (const ScopeItem& item : content.not_covered) {
    not_covered.push_back({{"key", item.key}, {"brief", item.brief}, {"text", item.text}});
  }
  return {{"verdict", content.is_proved() ? "no path" : "unchecked"},
          {"word", content.word},
          {"headline", content.headline},
          {"document", text_or_null(content.document)},
          {"revision", text_or_null(content.revision)},
          {"date", text_or_null(content.date)},
          {"case", content.scene.certificate.problem.name},
          {"title", content.title},
          {"machine", text_or_null(content.fields.machine)},
          {"site", text_or_null(content.fields.site)},
          {"load_name", text_or_null(content.fields.load_name)},
          {"prepared_by", text_or_null(content.fields.prepared_by)},
          {"waypoints", {content.from, content.from + 1}},
          {"statements", statements},
          {"not_covered", not_covered},
          {"load", report_json(content.load)},
          {"claim", content.is_proved() ? content.certificate().at("claim") : json()},
          {"cells", content.is_proved() ? json(checked.theorem->counts().boxes) : json()},
          {"certificate_sha256", checked.sha256},
          {"message", checked.message}};
}

}  // namespace taut
