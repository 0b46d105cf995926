// SPDX-License-Identifier: GPL-3.0-or-later
#include "reports/summary/summary.h"

#include <fmt/format.h>

#include <algorithm>
#include <nlohmann/json.hpp>

#include "base/sanitize.h"
#include "reports/summary/around_items.h"
#include "reports/summary/bodies_statement.h"
#include "reports/summary/headroom_summary.h"
#include "reports/summary/numbers.h"
#include "reports/summary/time_statement.h"
#include "reports/summary/wording.h"

namespace taut {

namespace {

/// Heads and rows of the table of cables; no rows where nothing is known.
using Row = std::array<std::string, 6>;

Row cable_heads(const DisplayUnits& units) {
  const std::string& force = units.force.name();
  return {"Cable",
          fmt::format("Tension from [{}]", force),
          fmt::format("to [{}]", force),
          "above slack",
          "of top limit",
          "length left"};
}

std::vector<Row> cable_rows(const std::vector<CableLine>& cables) {
  std::vector<Row> rows;
  for (const CableLine& c : cables) {
    rows.push_back({std::to_string(c.cable + 1), c.from, c.to, c.above_slack, c.of_top, c.length_left});
  }
  return rows;
}

const char* name(Recheck::Result result) {
  switch (result) {
    case Recheck::Result::kUnchecked: break;
    case Recheck::Result::kConfirmed: return "confirmed";
    case Recheck::Result::kNoClaim: return "no claim";
  }
  return "unchecked";
}

constexpr const char* kTitleNote = "as the case says, not checked";

const char* name(CableUse::Source source) {
  switch (source) {
    case CableUse::Source::kNone: break;
    case CableUse::Source::kSamples: return "samples";
    case CableUse::Source::kProvedParts: return "proved parts";
    case CableUse::Source::kProved: return "proved";
  }
  return "none";
}

/// What the page says of bodies: which pairs are checked, what is proved to be left, and the pairs that come nearest.
nlohmann::json bodies_json(const ReportContext& scene) {
  const Certificate& certificate = scene.certificate;
  if (!certificate.problem.bodies) return nullptr;
  const BodiesText& bodies = *certificate.problem.bodies;
  nlohmann::json result = to_json(bodies, bodies_statement(bodies));
  const bool is_proved = scene.verdict == "proved" && certificate.margins && certificate.margins->clearance_m;
  result["proved_left_m"] = is_proved ? nlohmann::json(nearest_double(*certificate.margins->clearance_m)) : nullptr;
  result["nearest"] = nlohmann::json::array();
  const std::vector<BodyPair> all = pairs(bodies);
  const DistancesAlong& along = scene.distances;
  for (std::size_t n = 0; n < along.nearest.size(); ++n) {
    const std::size_t k = along.nearest_at[n];
    result["nearest"].push_back({{"pair", names(bodies, all.at(along.nearest[n]))},
                                 {"class", name(all.at(along.nearest[n]).kind)},
                                 {"distance_m", along.distance[n][k]},
                                 {"clearance_m", along.clearance[n][k]},
                                 {"left_m", along.distance[n][k] - along.clearance[n][k]},
                                 {"at", scene.samples[k].position}});
  }
  return result;
}

nlohmann::json scope_json(const std::vector<ScopeItem>& items) {
  nlohmann::json result = nlohmann::json::array();
  for (const ScopeItem& item : items) {
    result.push_back({{"key", item.key}, {"brief", item.brief}, {"text", item.text}});
  }
  return result;
}

}  // namespace

Summary::Summary(const ReportContext& scene, const ReportOptions& options)
    : document(document_of(scene, options)),
      revision(options.revision),
      date(options.date),
      name(scene.certificate.problem.name),
      title(title_of(scene)),
      machine(scene.illustration.document_fields.machine),
      site(scene.illustration.document_fields.site),
      load_name(scene.illustration.document_fields.load_name),
      prepared_by(scene.illustration.document_fields.prepared_by),
      verdict(scene.verdict),
      word(verdict_word(scene)),
      headline(taut::headline(scene)),
      details(verdict_details(scene)),
      move(move_text(scene)),
      assumed(taut::assumed(scene.certificate)),
      not_covered(taut::not_covered(scene.certificate)),
      statements(taut::statements(scene)),
      load(stated_load(scene.certificate)),
      use(cable_use(scene)),
      units(scene.illustration.units),
      recheck(scene.recheck),
      problem_sha256(scene.certificate.problem_sha256),
      path_sha256(scene.certificate.path_sha256),
      footer_sha256(scene.certificate.footer_sha256) {
  // On a move that is not proved, what is proved of its parts says nothing of the whole.
  if (scene.verdict != "proved" && use.source == CableUse::Source::kProvedParts) {
    if (const CableUse sampled = sampled_use(scene); sampled.source != CableUse::Source::kNone) use = sampled;
  }
  key_numbers = taut::key_numbers(scene, use);
  cables = cable_lines(scene, use);
  use_caption = taut::use_caption(scene, use.source);
  assurance_case = taut::assurance_case(scene, title);
  const bool is_unchecked = scene.recheck.result == Recheck::Result::kUnchecked;
  if (const auto items = stated_items(scene.certificate)) {
    load.around_items = std::make_shared<const LoadStatement>(*items);
  }
  if (scene.illustration.headroom)
    headroom = headroom_sentences(*scene.illustration.headroom, scene.certificate.problem, scene.illustration.units);
  if (const auto found = stated_as_items(scene.certificate); found && !is_unchecked) {
    headroom.insert(headroom.begin(), sentence(*found, scene.illustration.units));
  }
  bodies = bodies_json(scene);
  lift_plan = taut::lift_plan(scene, *this);  // of all the rest
}

std::string document_of(const ReportContext& scene, const ReportOptions& options) {
  if (!options.document.empty()) return options.document;
  const std::string& stated = scene.illustration.document_fields.document;
  return stated.empty() ? document_number(scene.certificate.footer_sha256) : stated;
}

std::string title_of(const ReportContext& scene) {
  const std::string& stated = scene.illustration.document_fields.title;
  return stated.empty() ? title_from_name(scene.certificate.problem.name) : stated;
}

std::string title_from_name(const std::string& name) {
  std::string title = name;
  if (title.find(' ') == std::string::npos) {
    std::ranges::replace_if(
        title, [](char c) { return c == '-' || c == '_'; }, ' ');
  }
  if (!title.empty() && title[0] >= 'a' && title[0] <= 'z') title[0] = static_cast<char>(title[0] - 'a' + 'A');
  return title;
}

std::string document_number(const std::string& footer_sha256) {
  constexpr std::size_t kDigestDigits = 64;
  const auto is_hex = [](char c) { return (c >= '0' && c <= '9') || (c >= 'a' && c <= 'f'); };
  if (footer_sha256.size() != kDigestDigits || !std::ranges::all_of(footer_sha256, is_hex)) return "";
  std::string number = "TAUT";
  for (std::size_t i = 0; i < 12; ++i) {
    if (i % 4 == 0) number += '-';
    const char c = footer_sha256[i];
    number += c >= 'a' ? static_cast<char>(c - 'a' + 'A') : c;
  }
  return number;
}

std::string verdict_in_full(const Summary& s) {
  if (s.verdict == "refuted") return "REFUTED - " + s.word;
  return s.word == "NO DECISION" ? "UNDECIDED - " + s.word : s.word;
}

std::string markdown(const std::string& text) {
  const std::string plain = sanitize(text);
  std::string result;
  for (std::size_t i = 0; i < plain.size(); ++i) {
    const std::string_view rest = std::string_view(plain).substr(i);
    const char c = plain[i];
    if (c == '<' || c == '>' || c == '&' || rest.starts_with("://") || rest.starts_with("www.")) {
      result += fmt::format("&#{};", static_cast<int>(c));
    } else {
      if (std::string_view(R"(\`*_[]|#~$!)").find(c) != std::string_view::npos) result += '\\';
      result += c;
    }
  }
  return result;
}

std::string to_text(const Summary& s) {
  constexpr std::size_t kWidest = 12;  // of the statements' titles
  std::string text;
  const auto line = [&](const std::string& content) { text += sanitize(content) + "\n"; };
  line(fmt::format("{}: {}", verdict_in_full(s), s.headline));
  for (const KeyNumber& n : s.key_numbers) line(fmt::format("  {}: {} ({})", n.title, n.value, n.detail));
  line(fmt::format("{}{}{}: {} ({})", s.document, s.revision.empty() ? "" : ", revision " + s.revision,
                   s.date.empty() ? "" : ", " + s.date, s.title, kTitleNote));
  for (const auto& [title, value] : {std::pair("Machine", &s.machine), std::pair("Site", &s.site),
                                     std::pair("Load name", &s.load_name), std::pair("Prepared by", &s.prepared_by)}) {
    if (!value->empty()) line(fmt::format("{:<{}} {}", title, kWidest, *value));
  }
  for (const std::string& sentence : s.details) line(sentence);
  for (const std::string& sentence : s.headroom) line(sentence);
  if (const std::vector<Row> rows = cable_rows(s.cables); !rows.empty()) {
    line(s.use_caption + ":");
    const auto row = [&](const Row& c) {
      line(fmt::format("  {:>5} {:>18} {:>10} {:>12} {:>12} {:>12}", c[0], c[1], c[2], c[3], c[4], c[5]));
    };
    row(cable_heads(s.units));
    std::ranges::for_each(rows, row);
  }
  for (const Statement& statement : s.statements)
    line(fmt::format("{:<{}} {}", statement.title, kWidest, statement.text));
  line(fmt::format("{:<{}} problem {}", "SHA-256", kWidest, s.problem_sha256));
  line(fmt::format("{:<{}} path    {}", "", kWidest, s.path_sha256));
  line(fmt::format("{:<{}} footer  {}", "", kWidest, s.footer_sha256));
  return text;
}

std::string to_markdown(const Summary& s) {
  std::string text = fmt::format("## {} ({})\n\n", markdown(s.title), kTitleNote);
  std::string head = s.document;
  if (!s.revision.empty()) head += ", revision " + s.revision;
  if (!s.date.empty()) head += ", " + s.date;
  if (!head.empty()) text += markdown(head) + "\n\n";
  text += fmt::format("**{}**: {}\n\n", verdict_in_full(s), markdown(s.headline));
  for (const KeyNumber& n : s.key_numbers) {
    text += fmt::format("- {}: **{}** ({})\n", markdown(n.title), markdown(n.value), markdown(n.detail));
  }
  if (!s.key_numbers.empty()) text += "\n";
  for (const std::string& sentence : s.details) text += markdown(sentence) + "\n\n";
  for (const std::string& sentence : s.headroom) text += fmt::format("- {}\n", markdown(sentence));
  if (!s.headroom.empty()) text += "\n";
  if (const std::vector<Row> rows = cable_rows(s.cables); !rows.empty()) {
    text += markdown(s.use_caption) + ":\n\n|";
    for (const std::string& cell : cable_heads(s.units)) text += fmt::format(" {} |", markdown(cell));
    text += "\n|" + std::string("---:|---:|---:|---:|---:|---:|") + "\n";
    for (const Row& cells : rows) {
      text += "|";
      for (const std::string& cell : cells) text += fmt::format(" {} |", cell);
      text += "\n";
    }
    text += "\n";
  }
  text += "| | |\n|---|---|\n";
  for (const Statement& statement : s.statements) {
    text += fmt::format("| {} | {} |\n", statement.title, markdown(statement.text));
  }
  text += fmt::format("| SHA-256 | problem {}, path {}, footer {} |\n", markdown(s.problem_sha256),
                      markdown(s.path_sha256), markdown(s.footer_sha256));
  return text;
}

nlohmann::json to_json(const Summary& s) {
  using nlohmann::json;
  json statements = json::object();
  for (const Statement& statement : s.statements) statements[statement.key] = statement.text;
  json cables = json::array();
  if (s.use.source != CableUse::Source::kNone) {
    const auto one = [](const Use& use) {
      return json{{"least", use.range.lower},           {"greatest", use.range.upper},
                  {"lower_limit", use.lower_limit},     {"upper_limit", use.upper_limit},
                  {"share_of_upper_limit", use.used()}, {"least_at", use.least_at},
                  {"greatest_at", use.greatest_at}};
    };
    for (std::size_t i = 0; i < kCables; ++i) {
      cables.push_back({{"cable", i + 1}, {"tension_N", one(s.use.tension[i])}, {"length_m", one(s.use.length[i])}});
    }
  }
  json numbers = json::array();
  for (const KeyNumber& n : s.key_numbers) {
    numbers.push_back({{"key", n.key},
                       {"title", n.title},
                       {"value", n.value},
                       {"detail", n.detail},
                       {"nearness", name(n.nearness)},
                       {"proved", n.is_proved}});
  }
  const auto text_or_null = [](const std::string& text) { return text.empty() ? json() : json(text); };
  return {
      {"document", text_or_null(s.document)},
      {"revision", text_or_null(s.revision)},
      {"date", text_or_null(s.date)},
      {"case", s.name},
      {"title", s.title},
      {"machine", text_or_null(s.machine)},
      {"site", text_or_null(s.site)},
      {"load_name", text_or_null(s.load_name)},
      {"prepared_by", text_or_null(s.prepared_by)},
      {"verdict", s.verdict},
      {"word", s.word},
      {"headline", s.headline},
      {"details", s.details},
      {"key_numbers", numbers},
      {"headroom", s.headroom},
      {"statements", statements},
      {"assumed", scope_json(s.assumed)},
      {"not_covered", scope_json(s.not_covered)},
      {"assurance_case", to_json(s.assurance_case)},
      {"lift_plan", to_json(s.lift_plan)},
      {"load", report_json(s.load)},
      {"bodies", s.bodies},
      {"cables_source", name(s.use.source)},
      {"cables", cables},
      {"recheck", {{"result", name(s.recheck.result)}, {"checker", s.recheck.checker}, {"message", s.recheck.message}}},
      {"sha256", {{"problem", s.problem_sha256}, {"path", s.path_sha256}, {"footer", s.footer_sha256}}}};
}

}  // namespace taut
