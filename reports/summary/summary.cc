// SPDX-License-Identifier: GPL-3.0-or-later
#include "reports/summary/summary.h"

#include <fmt/format.h>

#include <algorithm>
#include <nlohmann/json.hpp>

#include "base/sanitize.h"
#include "reports/summary/headroom_summary.h"
#include "reports/summary/wording.h"

namespace taut {

namespace {

struct CableRow {
  std::array<std::string, 7> cells;  ///< cable; least, greatest and share of tension; of length
};

CableRow cable_heads(const DisplayUnits& units) {
  const std::string& force = units.force.name();
  const std::string& length = units.length.name();
  return {{"Cable", fmt::format("Tension from [{}]", force), fmt::format("to [{}]", force), "of limit",
           fmt::format("Length from [{}]", length), fmt::format("to [{}]", length), "of limit"}};
}

std::vector<CableRow> cable_rows(const CableUse& use, const DisplayUnits& units) {
  std::vector<CableRow> rows;
  if (use.source == CableUse::Source::kNone) return rows;
  const auto percent = [](const Use& x) { return rounded_up(x.used_percent(), 3) + " %"; };
  for (std::size_t i = 0; i < kCables; ++i) {
    const Use& t = use.tension[i];
    const Use& d = use.length[i];
    rows.push_back({{std::to_string(i + 1), units.force.down(t.range.lower), units.force.up(t.range.upper), percent(t),
                     units.length.down(d.range.lower), units.length.up(d.range.upper), percent(d)}});
  }
  return rows;
}

/// Markdown that shows `text` and is no markup of its own: what could be is escaped. On one line.
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

const char* name(Recheck::Result result) {
  switch (result) {
    case Recheck::Result::kUnchecked: break;
    case Recheck::Result::kConfirmed: return "confirmed";
    case Recheck::Result::kNoClaim: return "no claim";
  }
  return "unchecked";
}

constexpr const char* kNameNote = "name given in the case, not checked";

const char* name(CableUse::Source source) {
  switch (source) {
    case CableUse::Source::kNone: break;
    case CableUse::Source::kSamples: return "samples";
    case CableUse::Source::kProvedParts: return "proved parts";
    case CableUse::Source::kProved: return "proved";
  }
  return "none";
}

/// The document's number: the one asked for, else the case's, else one made from the certificate's digest.
std::string document_of(const ReportContext& scene, const ReportOptions& options) {
  if (!options.document.empty()) return options.document;
  const std::string& stated = scene.illustration.document_fields.document;
  return stated.empty() ? document_number(scene.certificate.footer_sha256) : stated;
}

}  // namespace

Summary::Summary(const ReportContext& scene, const ReportOptions& options)
    : document(document_of(scene, options)),
      revision(options.revision),
      date(options.date),
      name(scene.certificate.problem.name),
      title(scene.illustration.document_fields.title),
      machine(scene.illustration.document_fields.machine),
      site(scene.illustration.document_fields.site),
      load_name(scene.illustration.document_fields.load_name),
      prepared_by(scene.illustration.document_fields.prepared_by),
      verdict(scene.verdict),
      headline(taut::headline(scene)),
      details(verdict_details(scene)),
      statements(taut::statements(scene)),
      load(load_statement(scene.certificate.problem.load)),
      use(cable_use(scene)),
      units(scene.illustration.units),
      recheck(scene.recheck),
      problem_sha256(scene.certificate.problem_sha256),
      path_sha256(scene.certificate.path_sha256),
      footer_sha256(scene.certificate.footer_sha256) {
  if (title.empty()) title = title_from_name(name);
  closest = closest_text(scene, use);
  if (scene.illustration.headroom)
    headroom = headroom_sentences(*scene.illustration.headroom, scene.certificate.problem, scene.illustration.units);
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

std::string to_text(const Summary& s) {
  constexpr std::size_t kWidest = 12;  // of the statements' titles
  std::string text;
  const auto line = [&](const std::string& content) { text += sanitize(content) + "\n"; };
  line(fmt::format("{}{}{}: {} ({})", s.document, s.revision.empty() ? "" : ", revision " + s.revision,
                   s.date.empty() ? "" : ", " + s.date, s.name, kNameNote));
  line(s.headline);
  for (const std::string& sentence : s.details) line(sentence);
  for (const std::string& sentence : s.closest) line(sentence);
  for (const std::string& sentence : s.headroom) line(sentence);
  if (const std::vector<CableRow> rows = cable_rows(s.use, s.units); !rows.empty()) {
    line(use_caption(s.use.source) + ":");
    const CableRow heads = cable_heads(s.units);
    constexpr std::size_t kFirstWidth = 16;
    const std::size_t width = std::max(kFirstWidth, heads.cells[1].size());
    const auto row = [&](const CableRow& cable) {
      const auto& c = cable.cells;
      line(fmt::format("  {:>5} {:>{}} {:>10} {:>8} {:>17} {:>10} {:>8}", c[0], c[1], width, c[2], c[3], c[4], c[5],
                       c[6]));
    };
    row(heads);
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
  std::string text = fmt::format("## {} ({})\n\n", markdown(s.name), kNameNote);
  std::string head = s.document;
  if (!s.revision.empty()) head += ", revision " + s.revision;
  if (!s.date.empty()) head += ", " + s.date;
  if (!head.empty()) text += markdown(head) + "\n\n";
  text += fmt::format("**{}**\n\n", markdown(s.headline));
  for (const std::string& sentence : s.details) text += markdown(sentence) + "\n\n";
  for (const std::string& sentence : s.closest) text += fmt::format("- {}\n", markdown(sentence));
  for (const std::string& sentence : s.headroom) text += fmt::format("- {}\n", markdown(sentence));
  if (!s.closest.empty() || !s.headroom.empty()) text += "\n";
  if (const std::vector<CableRow> rows = cable_rows(s.use, s.units); !rows.empty()) {
    text += markdown(use_caption(s.use.source)) + ":\n\n|";
    for (const std::string& cell : cable_heads(s.units).cells) text += fmt::format(" {} |", markdown(cell));
    text += "\n|" + std::string("---:|---:|---:|---:|---:|---:|---:|") + "\n";
    for (const auto& [cells] : rows) {
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
      {"headline", s.headline},
      {"details", s.details},
      {"closest", s.closest},
      {"headroom", s.headroom},
      {"statements", statements},
      {"load", to_json(s.load)},
      {"cables_source", name(s.use.source)},
      {"cables", cables},
      {"recheck", {{"result", name(s.recheck.result)}, {"checker", s.recheck.checker}, {"message", s.recheck.message}}},
      {"sha256", {{"problem", s.problem_sha256}, {"path", s.path_sha256}, {"footer", s.footer_sha256}}}};
}

}  // namespace taut
