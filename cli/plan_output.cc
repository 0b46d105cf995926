// SPDX-License-Identifier: GPL-3.0-or-later
#include "cli/plan_output.h"

#include <fmt/format.h>

#include <cmath>
#include <utility>

#include "app/proved_path.h"
#include "base/plural.h"
#include "certify/undecided.h"
#include "cli/console.h"
#include "cli/headroom_output.h"
#include "cli/output.h"
#include "cli/terminal.h"
#include "cli/verdict_output.h"
#include "path_io/path_csv.h"
#include "reports/summary/bodies_statement.h"
#include "reports/summary/display_units.h"
#include "reports/summary/hints.h"
#include "reports/summary/load_statement.h"
#include "reports/summary/sentences.h"
#include "reports/summary/summary.h"

namespace taut {
namespace {

/// Where a proof that no path exists was tried: what became of it.
Said said_of_no_path(const Case& the_case, const NoPathAttempt& attempt, const checker::CheckResult& checked) {
  if (!checked.theorem) return {"UNCHECKED", fmt::format("{}. Nothing is claimed.", checked.message)};
  return {"no path",
          fmt::format("no motion of the coordinates within their ranges leads from waypoint {} of the query to "
                      "waypoint {} with every pose of it feasible, {} without a feasible pose part them "
                      "(proved).{}",
                      attempt.from, attempt.from + 1, plural(checked.counts.boxes, "cell"),
                      the_case.problem.tolerances
                          ? " That is about the machine exactly as typed; so no path is feasible for every "
                            "machine within the tolerances."
                          : "")};
}

/// What the search knows of its path.
std::string length_sentence(const PlanStatistics& s) {
  const std::string rest = fmt::format(" on the charts' graph{}.\nLength here is {}",
                                       s.budget_spent ? "; the budget is spent" : "", s.cost_measure);
  if (s.factor == 1) return "The path found is the shortest" + rest;
  if (!std::isfinite(s.factor)) return "The path found is the first, not the shortest," + rest;
  return fmt::format("The path found is at most {:.6g} times as long as the shortest{}", s.factor, rest);
}

/// Null unless --grow was asked for.
nlohmann::json growth_json(const std::optional<Growth>& growth) {
  if (!growth) return {};
  return {{"charts", growth->charts},
          {"complete_charts", growth->complete_charts},
          {"whole", growth->is_whole()},
          {"elapsed_seconds", growth->seconds},
          {"time_is_up", growth->time_is_up}};
}

/// Null unless the path has a time law.
nlohmann::json move_json(const PlannedCase& planned) {
  if (!planned.plan.move) return {};
  const MoveStatistics& move = *planned.plan.move;
  const auto optional = [](const std::optional<double>& x) { return x ? nlohmann::json(*x) : nlohmann::json(); };
  nlohmann::json greatest;
  if (move.greatest) {
    greatest = {{"proved_share", move.greatest->proved}, {"refuted_share", optional(move.greatest->refuted)}};
  }
  return {{"duration_s", move.duration_s},
          {"planned_s", move.planned_s},
          {"fastest_s", optional(move.fastest_s)},
          {"speed_share", move.speed_share},
          {"greatest_speed", greatest},
          {"tries", move.tries},
          {"plan_seconds", move.plan_seconds},
          {"prove_seconds", move.prove_seconds}};
}

/// "15.7 s", with as many digits as say something.
std::string duration_text(double seconds) { return fmt::format("{:.{}f} s", seconds, seconds < 100 ? 2 : 1); }

/// Null unless it was tried to prove that no path exists.
nlohmann::json no_path_json(const std::optional<NoPathAttempt>& attempt) {
  if (!attempt) return {};
  using Answer = NoPathAttempt::Answer;
  const bool is_apart = attempt->answer == Answer::kApart;
  const bool is_open = attempt->answer == Answer::kOpen;
  const char* const answer = is_apart                             ? "apart"
                             : attempt->answer == Answer::kJoined ? "joined"
                             : is_open                            ? "open"
                                                                  : "unsupported";
  return {{"answer", answer},
          {"waypoint", is_apart || is_open ? nlohmann::json(attempt->from) : nlohmann::json()},
          {"open_share", attempt->open ? nlohmann::json(attempt->open->open_share) : nlohmann::json()},
          {"cells", attempt->cells},
          {"elapsed_seconds", attempt->seconds}};
}

void print_search(const PlanOutcome& outcome, const DisplayUnits& units) {
  const PlanStatistics& s = outcome.planned.plan.statistics;
  if (s.charts == 0) return;
  const std::string unit = s.cost_unit.empty() ? "" : " " + s.cost_unit;
  const bool has_path = outcome.is_proved() || s.cost_found > 0;
  if (outcome.is_proved()) {
    print_wrapped(fmt::format("On its way the platform's origin moves {:.4g} {}, and the platform turns {}.",
                              units.length.approx(outcome.lengths.length_m), units.length.name(),
                              units.angle(outcome.lengths.angle_rad)));
  }
  print_wrapped(fmt::format(
      "{}, {} expanded; {} looked at, {} refused{}.", plural(static_cast<std::size_t>(s.charts), "chart"),
      s.nodes_expanded, plural(static_cast<std::size_t>(s.edges_checked), "edge"), s.edges_rejected,
      has_path ? fmt::format("; cost {:.4g}{}, shortened from {:.4g}{}", s.cost, unit, s.cost_found, unit) : ""));
  print_wrapped(fmt::format("Planned in {:.2f} ms, shortened in {:.2f} ms, proved in {:.2f} ms.", 1e3 * s.plan_seconds,
                            1e3 * s.smooth_seconds, 1e3 * s.prove_seconds));
  if (outcome.is_proved()) print_wrapped(length_sentence(s) + ".", 0);
}

}  // namespace

bool is_no_path(const PlannedCase& planned) {
  return planned.no_path && planned.no_path->answer == NoPathAttempt::Answer::kApart;
}

Said said(const Case& the_case, const PlannedCase& planned) {
  const Plan& plan = planned.plan;
  const checker::CheckResult& checked = planned.checked;
  if (is_no_path(planned)) return said_of_no_path(the_case, *planned.no_path, checked);
  const PathProof& proof = plan.proof;
  if (checked.outcome == checker::Outcome::kUnchecked) {
    return {"UNCHECKED", fmt::format("{}. Nothing is claimed of the path.", checked.message)};
  }
  if (checked.outcome == checker::Outcome::kUndecided && proof.verdict != Verdict::kUndecided) {
    return {"undecided", with_code(Reason(Undecided::kKernel).text()) + "."};
  }
  switch (proof.verdict) {
    case Verdict::kProved: {
      const checker::Theorem& theorem = checked.theorem.value();
      const bool is_spline = plan.path.interpolation == Interpolation::kCubicBSpline;
      if (plan.move) {
        return {"proved",
                fmt::format("the move is wrench-feasible with its inertia, within its limits in time, and clear of "
                            "singularities at every time, in {} in {}{}.",
                            plural(theorem.counts().segments, is_spline ? "spline segment" : "segment"),
                            plural(theorem.counts().boxes, "box"), clear_bodies(the_case.problem.bodies, "; "))};
      }
      return {
          "proved",
          fmt::format(
              "the path is wrench-feasible and clear of singularities, at its waypoints and everywhere between, {} in "
              "{}{}.",
              plural(theorem.counts().segments, is_spline ? "spline segment" : "segment"),
              plural(theorem.counts().boxes, "box"), clear_bodies(the_case.problem.bodies, "; "))};
    }
    case Verdict::kRefuted: {
      const PathWitness& w = *proof.witness;
      const std::string where = plan.refuted_waypoint
                                    ? fmt::format("at waypoint {} of the query", *plan.refuted_waypoint)
                                : w.at.on_segment ? fmt::format("on segment {} of the path", w.at.index)
                                                  : fmt::format("at waypoint {} of the path", w.at.index);
      return {"refuted",
              fmt::format("{} {}.{}", where, violation_text(w, the_case.problem, DisplayUnits(the_case.units)),
                          load_that_breaks(the_case.problem.load, checked))};
    }
    case Verdict::kUndecided: break;
  }
  const std::string tried = planned.no_path ? " " + describe_open(the_case, *planned.no_path) : "";
  return {"undecided", with_code(proof.reason.text()) + "." + tried};
}

std::string hint(const Case& the_case, const Plan& plan) {
  if (!plan.refuted_waypoint) return "";
  return reversed_load_hint(the_case.problem, plan.path);
}

namespace {

/// Of a move that is proved: how long it takes, and how fast it might be.
std::vector<std::string> move_sentences(const Case& the_case, const MoveStatistics& move) {
  constexpr double kSame = 1e-4;
  std::vector<std::string> result;
  std::string text = "Move: " + duration_text(move.duration_s);
  if (std::abs(move.speed_share - 1) > kSame) {
    text += fmt::format(", at {:.4g} % of the speed that was planned, {}", 100 * move.speed_share,
                        duration_text(move.planned_s));
  }
  if (move.fastest_s) {
    text += fmt::format("; without a limit of jerk the fastest law on this path takes about {} (in floating point)",
                        duration_text(*move.fastest_s));
  }
  result.push_back(text + ".");
  if (!move.greatest) return result;
  const GreatestSpeed& greatest = *move.greatest;
  text = fmt::format("Greatest speed of this law: {:.4g} % of what was planned is proved", 100 * greatest.proved);
  if (greatest.refuted) {
    const PathWitness& witness = greatest.witness.value();
    text += fmt::format(", {:.4g} % is refuted: on segment {} of the path {}", 100 * *greatest.refuted,
                        witness.at.index, violation_text(witness, the_case.problem, DisplayUnits(the_case.units)));
  }
  result.push_back(text + ".");
  return result;
}

}  // namespace

nlohmann::json plan_json(const Case& the_case, const PlanOutcome& outcome) {
  const Plan& plan = outcome.planned.plan;
  const PlanStatistics& s = plan.statistics;
  const checker::CheckResult& checked = outcome.planned.checked;
  const auto if_proved = [&](double x) { return outcome.is_proved() ? nlohmann::json(x) : nlohmann::json(); };
  nlohmann::json result = {{"command", "plan"},
                           {"segments", checked.counts.segments},
                           {"boxes", checked.counts.boxes},
                           {"charts", s.charts},
                           {"charts_stored", s.charts_stored},
                           {"nodes_expanded", s.nodes_expanded},
                           {"edges_checked", s.edges_checked},
                           {"edges_rejected", s.edges_rejected},
                           {"cost", s.cost},
                           {"cost_found", s.cost_found},
                           {"cost_unit", s.cost_unit},
                           {"cost_measure", s.cost_measure},
                           {"within_factor", std::isfinite(s.factor) ? nlohmann::json(s.factor) : nlohmann::json()},
                           {"budget_spent", s.budget_spent},
                           {"length_m", if_proved(outcome.lengths.length_m)},
                           {"angle_rad", if_proved(outcome.lengths.angle_rad)},
                           {"plan_seconds", s.plan_seconds},
                           {"smooth_seconds", s.smooth_seconds},
                           {"prove_seconds", s.prove_seconds},
                           {"headroom", headroom_json(outcome.planned.headroom)},
                           {"as_items", to_json(outcome.planned.as_items)},
                           {"growth", growth_json(outcome.planned.growth)},
                           {"move", move_json(outcome.planned)},
                           {"load", to_json(load_statement(the_case))},
                           {"bodies", stated_bodies_json(the_case.bodies)},
                           {"warnings", the_case.warnings},
                           {"out", outcome.out.string()}};
  result.update(result_json(checked));
  const bool is_proved = outcome.is_proved();
  const Said what = said(the_case, outcome.planned);
  result["no_path"] = no_path_json(outcome.planned.no_path);
  result["messages"] =
      messages_json({is_proved ? "" : fmt::format("{}: {}", what.verdict, what.text), hint(the_case, plan)});
  return result;
}

std::string plan_progress_text(const PlanProgress& at) {
  return at.move_tries > 0 ? fmt::format("proving the move: law {}", at.move_tries)
                           : "planning: " + plural(static_cast<std::size_t>(at.charts), "chart");
}

void print_remarks(const Case& the_case, const PlanOutcome& outcome) {
  const Plan& plan = outcome.planned.plan;
  if (const std::string may_be = hint(the_case, plan); !may_be.empty()) print_wrapped(may_be);
  if (!outcome.is_proved() || !plan.move) return;
  for (const std::string& sentence : move_sentences(the_case, *plan.move)) print_wrapped(sentence);
}

void print_result(const Case& the_case, const PlanOutcome& outcome, const std::optional<ReportContext>& context,
                  const ReportOptions& report_options) {
  const PlannedCase& planned = outcome.planned;
  const checker::CheckResult& checked = planned.checked;
  const DisplayUnits units(the_case.units);
  const std::string text = said(the_case, planned).text;
  if (context) {
    const Summary shown(*context, report_options);
    print_verdict(verdict_in_full(shown), text);
    print_key_numbers(shown.key_numbers);
  } else {
    print_verdict(checked.theorem ? "NO PATH EXISTS" : "UNCHECKED", text);
  }
  print_remarks(the_case, outcome);
  print_search(outcome, units);
  if (checked.outcome != checker::Outcome::kUnchecked) {
    if (planned.as_items) print_wrapped(sentence(*planned.as_items, units));
    print_headroom(planned.headroom, the_case.problem, the_case.units);
  }
  print_wrapped(sentence(checked));
}

void add_move_tables(const std::filesystem::path& out, MoveTables tables, std::vector<FileContent>& files) {
  files.push_back({out / "winches.csv", std::move(tables.winches_csv)});
  files.push_back({out / "poses.csv", std::move(tables.poses_csv)});
  files.push_back({out / "poses.tum", std::move(tables.poses_tum)});
}

std::vector<FileContent> plan_files(const Case& the_case, const PlanOutcome& outcome, const ControllerStep& step) {
  std::vector<FileContent> files;
  if (!outcome.is_proved()) return files;  // what is not proved is not for a machine to follow
  const Path& path = outcome.planned.plan.path;
  const std::string& sha256 = outcome.planned.checked.sha256;
  if (!path.timing) {
    files.push_back({outcome.out / "controller.csv", controller_csv(the_case.problem, path, step, sha256)});
  } else {  // a table without times would be about another motion than what is proved
    add_move_tables(
        outcome.out,
        move_tables(the_case.problem, path, tension_pieces(outcome.planned.checked), the_case.move.rate_Hz, sha256),
        files);
  }
  files.push_back({outcome.out / "path.csv", path_csv(the_case.problem, path, sha256)});  // last
  return files;
}

}  // namespace taut
