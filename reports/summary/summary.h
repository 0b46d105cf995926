// SPDX-License-Identifier: GPL-3.0-or-later
// The first page as data, and as plain text, Markdown and JSON. All have the same content.
#pragma once

#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "reports/summary/assurance_case.h"
#include "reports/summary/key_numbers.h"
#include "reports/summary/lift_plan.h"
#include "reports/summary/load_statement.h"
#include "reports/summary/scope.h"
#include "reports/summary/sentences.h"

namespace taut {

struct Summary {
  Summary(const ReportContext& scene, const ReportOptions& options);

  std::string document;  ///< its number
  std::string revision;  ///< may be empty, like the date
  std::string date;
  std::string name;   ///< of the case; nothing checks it
  std::string title;  ///< as the case states it, else made from its name; nothing checks it
  std::string machine, site, load_name, prepared_by;  ///< as the case states them; empty: it does not. Unchecked, too
  std::string verdict;  ///< "proved" or "refuted", if the checker made a theorem; else "undecided" or "unchecked"
  std::string word;     ///< the verdict as nobody misreads it: "DO NOT RUN"
  std::string headline;
  std::vector<std::string> details;
  std::vector<KeyNumber> key_numbers;
  std::vector<CableLine> cables;      ///< those nearest to their limits first
  std::vector<std::string> headroom;  ///< what stands in the way, or how far the proof reaches; nothing checks it
  std::string move;                   ///< travel, turn and law, briefly
  std::vector<ScopeItem> assumed, not_covered;
  std::vector<AssuranceNode> assurance_case;  ///< none unless the move is proved
  std::vector<LiftPlanItem> lift_plan;
  std::vector<Statement> statements;
  LoadStatement load;
  nlohmann::json bodies;  ///< what is checked of them, and the pairs that come nearest; null where there are none
  CableUse use;
  std::string use_caption;  ///< what the table of cables shows
  DisplayUnits units;       ///< of text for people; JSON is in SI
  Recheck recheck;
  std::string problem_sha256, path_sha256, footer_sha256;
};

/// "TAUT-1A2B-3C4D-5E6F", made from the certificate's own digest; nothing if that is no digest.
[[nodiscard]] std::string document_number(const std::string& footer_sha256);

/// The document's number: the one asked for, else the case's, else one made from the certificate's digest.
[[nodiscard]] std::string document_of(const ReportContext& scene, const ReportOptions& options);

/// The title of a case that states none: "Robot1 slice qs qg" of "robot1-slice-qs-qg".
[[nodiscard]] std::string title_from_name(const std::string& name);
/// The title that the case states, else one made from its name.
[[nodiscard]] std::string title_of(const ReportContext& scene);

/// The verdict as logs and terminals show it: "PROVED", "REFUTED - DO NOT RUN", "UNDECIDED - NO DECISION",
/// "NO PATH FOUND" or "UNCHECKED".
[[nodiscard]] std::string verdict_in_full(const Summary& summary);

/// Markdown that shows a text, on one line, and is no markup of its own: what could be is escaped.
[[nodiscard]] std::string markdown(const std::string& text);

/// Lines of plain text, the verdict first, without control characters, for logs.
[[nodiscard]] std::string to_text(const Summary& summary);
/// GitHub's Markdown. Text from the certificate is escaped, so that it can't contain markup.
[[nodiscard]] std::string to_markdown(const Summary& summary);
/// JSON with the keys of docs/report.md.
[[nodiscard]] nlohmann::json to_json(const Summary& summary);

}  // namespace taut
