// SPDX-License-Identifier: GPL-3.0-or-later
// The sentences of a report about verdict, places and margins. They are plain text, so that the page, the text and the
// Markdown summaries use the same words.
#pragma once

#include <string>
#include <vector>

#include "certify/path_proof.h"
#include "reports/summary/cable_use.h"
#include "reports/summary/display_units.h"
#include "reports/summary/scene.h"

namespace taut {

/// The verdict in a word or two that nobody misreads: "PROVED", "DO NOT RUN", "NO DECISION", "NO PATH FOUND",
/// "UNCHECKED".
[[nodiscard]] const char* verdict_word(const ReportContext& scene);

/// The verdict in one sentence.
[[nodiscard]] std::string headline(const ReportContext& scene);

/// "the tension of cable 3 reaches at least 0.81 N, not below its upper limit of 0.5 N". A tension beyond
/// kSingularTension times the robot's greatest limit is called what it is: a singular pose, but for rounding. Of
/// bodies: "cable 3 and 'stack' come within 200 mm of each other, the clearance asked for".
[[nodiscard]] std::string violation_text(const PathWitness& witness, const Problem& problem, const DisplayUnits& units);

/// "0.0499 N": the value of a witness that is next to its limit, in as few digits as show it beyond the limit, rounded
/// towards the limit. @pre not singular, nor of bodies or a rate
[[nodiscard]] std::string value_text(const PathWitness& witness, const DisplayUnits& units);

/// Whether a tension is so far beyond the limits that the pose is singular but for rounding.
[[nodiscard]] bool is_all_but_singular(const PathWitness& witness, const Problem& problem);

/// What the stretches of a refuted audit say where poses are implied (theory.md, 8): which poses they are about, and
/// how far the move is proved to pass these. @param has_boxes  whether anything is proved outside of them
[[nodiscard]] std::string implied_scope(bool has_boxes);

/// The details of the verdict: for a refuted path by how much, where and at which pose; for an undecided one the
/// reason, where, and what would settle it; none for a proved one.
[[nodiscard]] std::vector<std::string> verdict_details(const ReportContext& scene);

/// "20 segments, straight in the parameters of the case. The platform's origin travels 8 m and …": the move, briefly.
[[nodiscard]] std::string move_text(const ReportContext& scene);

/// A statement of the report and its subject.
struct Statement {
  const char* key;    ///< for machines: "motion"
  const char* title;  ///< for people: "Motion"
  std::string text;
};

/// The verdict's scope: motion, loads, limits, tolerances, assumptions, what is not covered, versions, and the check.
[[nodiscard]] std::vector<Statement> statements(const ReportContext& scene);

/// "Every tension above 0.05 N and below 0.5 N; every cable length …": exactly. Limits in time are time_statement.h's.
[[nodiscard]] std::string limits_text(const RobotText& robot, const DisplayUnits& units);
/// "Up to, in any direction and all at once: base anchors 0.1 mm and …": exactly.
[[nodiscard]] std::string tolerances_text(const std::optional<TolerancesText>& tolerances, const DisplayUnits& units);
/// "Proved margins: tension 3.4 N, length 2.4 m, wrench_scale 5.3, clearance 0.2 m.": exactly, in these units.
/// @param wrench_scale  empty: not claimed, as of moves
[[nodiscard]] std::string margins_text(const DecimalText& tension_N, const DecimalText& length_m,
                                       const DecimalText& wrench_scale, const DisplayUnits& units,
                                       const std::optional<DecimalText>& clearance_m = {});

/// The bodies of a problem in sentences: pairs and their clearances, what is not checked, each body. @pre
/// problem.bodies
[[nodiscard]] std::string bodies_text(const Problem& problem);
/// "about 0.12 m apart" or "about 30 mm deep in each other": in floating point.
[[nodiscard]] std::string apart_text(const BodyDistance& distance, const DisplayUnit& unit);
/// "clearance 200 mm", or "may be 5 mm deep there".
[[nodiscard]] std::string asked_text(const BodyDistance& distance, const BodiesText& bodies, const DisplayUnit& unit);
/// "(1.2, 0, 3) m": a point, rounded.
[[nodiscard]] std::string point_in_space(const Vector3<double>& at, const DisplayUnit& unit);

/// "Cables over the whole move, proved …": what the table of cables shows.
[[nodiscard]] std::string use_caption(const ReportContext& scene, CableUse::Source source);

}  // namespace taut
