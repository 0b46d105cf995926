// SPDX-License-Identifier: GPL-3.0-or-later
// What a certificate says, in sentences that an engineer would sign. Plain text: the page, the text and the Markdown summaries
// say the same words.
#pragma once

#include <string>
#include <vector>

#include "certify/path_proof.h"
#include "reports/summary/cable_use.h"
#include "reports/summary/scene.h"

namespace taut {

/// The verdict in one sentence.
[[nodiscard]] std::string headline(const ReportContext& scene);

/// "the tension of cable 3 reaches at least 0.81 N, not below its upper limit of 0.5 N"
[[nodiscard]] std::string violation_text(const PathWitness& witness);

/// What follows from it: of a refuted one by how much, where and at which pose; of an undecided one the reason and where; of a
/// proved one its reserves.
[[nodiscard]] std::vector<std::string> verdict_details(const ReportContext& scene);

/// How close the move comes to limits of tension and of length: "Cable 3 comes closest to a limit of tension …". Nothing unless all of the move is
/// proved.
[[nodiscard]] std::vector<std::string> closest_text(const ReportContext& scene, const CableUse& use);

/// What a statement is about, and the statement.
struct Statement {
  const char* key;    ///< for machines: "motion"
  const char* title;  ///< for people: "Motion"
  std::string text;
};

/// What the verdict is about: motion, loads, limits, tolerances, assumptions, what is not covered, versions, and who checked it again.
[[nodiscard]] std::vector<Statement> statements(const ReportContext& scene);

/// The centre load and by how much each component may differ from it: the semi-axes of K. Floating point.
[[nodiscard]] std::string load_text(const LoadText& load);
/// "Up to, in any direction and all at once: base anchors 0.1 mm and …": exactly.
[[nodiscard]] std::string tolerances_text(const std::optional<TolerancesText>& tolerances);

/// "Utilisation of the cables, proved …": what the table of cables shows.
[[nodiscard]] std::string use_caption(CableUse::Source source);

}  // namespace taut
