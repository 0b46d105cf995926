// SPDX-License-Identifier: GPL-3.0-or-later
#include "cli/plan_command.h"

#include <fmt/format.h>

#include <charconv>
#include <cmath>
#include <filesystem>
#include <nlohmann/json.hpp>
#include <optional>
#include <stop_token>
#include <vector>

#include "app/meshes.h"
#include "app/plan.h"
#include "app/report.h"
#include "base/files.h"
#include "base/input_error.h"
#include "base/plural.h"
#include "base/sanitize.h"
#include "certificate/signature.h"
#include "certify/undecided.h"
#include "checker/arguments.h"
#include "cli/console.h"
#include "cli/headroom_output.h"
#include "cli/number_option.h"
#include "cli/output.h"
#include "cli/result_folder.h"
#include "cli/terminal.h"
#include "cli/verdict_output.h"
#include "path_io/controller_csv.h"
#include "path_io/move_tables.h"
#include "path_io/path_csv.h"
#include "reports/page/html_report.h"
#include "reports/summary/bodies_statement.h"
#include "reports/summary/display_units.h"
#include "reports/summary/hints.h"
#include "reports/summary/load_statement.h"
#include "reports/summary/sentences.h"

namespace taut {
namespace {

/// A verdict in lower case, as scripts know it, and what is said of it.
struct Said {
  std::string verdict;
  std::string text;
};

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

/// What may be wrong with the case, if its first infeasible waypoint suggests it; else empty.
std::string hint(const Case& the_case, const Plan& plan) {
  if (!plan.refuted_waypoint) return "";
  return reversed_load_hint(the_case.problem, plan.path);
}

/// What the search knows of its path.
std::string length_sentence(const PlanStatistics& s) {
  const std::string rest = fmt::format(" on the charts' graph{}.\nLength here is {}",
                                       s.budget_spent ? "; the budget is spent" : "", s.cost_measure);
  if (s.factor == 1) return "The path found is the shortest" + rest;
  if (!std::isfinite(s.factor)) return "The path found is the first, not the shortest," + rest;
  return fmt::format("The path found is at most {:.6g} times as long as the shortest{}", s.factor, rest);
}

/// Checks that no file that is written is one that is read.
void require_others(const PlanArguments& arguments, const std::filesystem::path& out) {
  const std::vector<std::string> read = {arguments.case_path, arguments.key};
  if (!arguments.save_atlas.empty()) {
    require_writable(arguments.save_atlas);
    for (const std::string& file : read) require_another(arguments.save_atlas, file);
  }
  for (const char* name : kResultFiles) {
    for (const std::string& file : read) require_another(out / name, file);
    for (const std::string& file : {arguments.atlas, arguments.save_atlas}) require_another(out / name, file);
  }
}

/// What there is to say once all is written.
struct Outcome {
  const PlannedCase& planned;
  MotionLengths lengths{};  ///< only if proved
  std::filesystem::path out;

  [[nodiscard]] bool is_proved() const { return exit_code(planned.checked) == kProvedExit; }
};

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

nlohmann::json summary(const Case& the_case, const Outcome& outcome) {
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

void print_search(const Outcome& outcome, const DisplayUnits& units) {
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

/// Everything but the files.
/// @param context  null where no path exists
void print_result(const Case& the_case, const Outcome& outcome, const std::optional<ReportContext>& context,
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
  if (const std::string may_be = hint(the_case, planned.plan); !may_be.empty()) print_wrapped(may_be);
  if (outcome.is_proved() && planned.plan.move) {
    for (const std::string& sentence : move_sentences(the_case, *planned.plan.move)) print_wrapped(sentence);
  }
  print_search(outcome, units);
  if (checked.outcome != checker::Outcome::kUnchecked) {
    if (planned.as_items) print_wrapped(sentence(*planned.as_items, units));
    print_headroom(planned.headroom, the_case.problem, the_case.units);
  }
  print_wrapped(sentence(checked));
}

/// What growing the atlas will cost, at most.
std::string growth_announcement(const GrowthEstimate& estimate, double most_seconds) {
  constexpr double kMegabyte = 1e6;
  return fmt::format(
      "Growing the atlas to all charts that can be reached, {} at most (planner.max_charts): as it begins, these would "
      "take about {:.2g} s and a file of {:.2g} MB. It ends after {:.6g} s (--grow-seconds) with what there is.",
      estimate.most_charts, estimate.seconds, estimate.file_bytes / kMegabyte, most_seconds);
}

/// What a saved atlas holds.
std::string atlas_sentence(const PlannedCase& planned, int charts, const std::string& file) {
  const std::string written = fmt::format("Atlas of {}", plural(static_cast<std::size_t>(charts), "chart"));
  if (!planned.growth) return fmt::format("{} written to {}", written, sanitize(file));
  const Growth& growth = *planned.growth;
  if (growth.is_whole()) return fmt::format("{}, all that can be reached, written to {}", written, sanitize(file));
  return fmt::format(
      "{}, NOT all that can be reached, written to {}: growing ended after {:.3g} s {}, with {} complete", written,
      sanitize(file), growth.seconds,
      growth.time_is_up ? "(--grow-seconds)" : "(planner.max_charts, or an interruption)",
      plural(static_cast<std::size_t>(growth.complete_charts), "chart"));
}

/// Reads "40%", "40 %" or "0.4".
double read_speed(const std::string& typed) {
  constexpr double kPercent = 100;
  std::string text = typed;
  const bool is_percent = text.ends_with('%');
  if (is_percent) text.pop_back();
  while (text.ends_with(' ')) text.pop_back();
  double value = 0;
  const char* const end = text.data() + text.size();
  const auto [read, error] = std::from_chars(text.data(), end, value);
  if (is_percent) value /= kPercent;
  if (error != std::errc() || read != end || !(value >= kLeastSpeed && value <= 1)) {
    throw InputError(ErrorCode::kUse,
                     fmt::format("--speed: got '{}', expected a share of the planned speed from {} % to 100 %, such "
                                 "as 40%",
                                 excerpt(typed), kPercent * kLeastSpeed));
  }
  return value;
}

/// Checks that the case has what the options of a move are about, and that they can be read.
void require_move(const Case& the_case, const PlanArguments& arguments) {
  if (arguments.speed) static_cast<void>(read_speed(*arguments.speed));
  const char* const option = arguments.max_speed ? "--max-speed"
                             : arguments.speed   ? "--speed"
                             : arguments.timed   ? "--timed"
                                                 : nullptr;
  if (option == nullptr || the_case.problem.time) return;
  throw InputError(ErrorCode::kUse,
                   fmt::format("{}: got a case without the key 'time', expected one that says what winches and load "
                               "may do (docs/case-format.md)",
                               option));
}

/// Plans, with a progress line.
PlannedCase plan(const Case& the_case, Planner& planner, const PlanArguments& arguments,
                 const std::optional<SigningKey>& key, const std::stop_token& stop) {
  ProgressLine line(!arguments.json);
  std::optional<Stopwatch> growing;
  const auto progress = [&](const PlanProgress& at) {
    line.show([&] {
      const std::string charts = plural(static_cast<std::size_t>(at.charts), "chart");
      return growing ? fmt::format("growing the atlas: {}, {:.0f} of at most {:.6g} s", charts, growing->seconds(),
                                   arguments.grow_seconds)
             : at.move_tries > 0 ? fmt::format("proving the move: law {}", at.move_tries)
                                 : "planning: " + charts;
    });
  };
  PlannedCaseOptions options;
  options.grow = arguments.grow;
  options.key = key ? &*key : nullptr;
  options.max_seconds = arguments.max_seconds;
  options.grow_seconds = arguments.grow_seconds;
  options.announce_growth = [&](const GrowthEstimate& estimate) {
    growing.emplace();
    if (arguments.json) return;
    line.clear();
    fmt::print("{}\n", growth_announcement(estimate, arguments.grow_seconds));
    std::fflush(stdout);
  };
  options.headroom_seconds = arguments.headroom_seconds;
  options.no_path_seconds = arguments.no_path_seconds;
  if (arguments.speed) options.move.speed_share = read_speed(*arguments.speed);
  options.move.seeks_greatest_speed = arguments.max_speed;
  options.headroom_progress = [&](std::size_t done, std::size_t all) {
    line.show([&] { return headroom_progress_text(done, all); });
  };
  return plan_case(the_case, planner, options, progress, stop);
}

}  // namespace

void add_plan_options(CLI::App& command, PlanArguments& arguments) {
  command.add_option("CASE", arguments.case_path, "case file (docs/case-format.md)")->required();
  command.add_option("--out", arguments.out,
                     "directory for the results (default: a new one, out/CASE's name, or this case's own)");
  command.add_option("--step", arguments.step,
                     "how far the platform travels between two rows of controller.csv at most (default: 10 mm)");
  command.add_option("--atlas", arguments.atlas, "begin with the charts of this file (docs/atlas-file.md)");
  CLI::Option* save_atlas = command.add_option("--save-atlas", arguments.save_atlas, "write all charts into this file");
  CLI::Option* grow =
      command.add_flag("--grow", arguments.grow, "make all charts that can be reached before they are saved");
  grow->needs(save_atlas);
  command
      .add_option(
          "--grow-seconds", arguments.grow_seconds,
          fmt::format("what --grow may take before it saves what it has (default: {:.0f})", arguments.grow_seconds))
      ->check(positive_number("a number of seconds above 0"))
      ->needs(grow);
  command
      .add_option("--budget", arguments.budget_seconds, "seconds for planning and proving, instead of the case's own")
      ->check(positive_number("a number of seconds above 0"));
  command.add_option("--sign", arguments.key, "sign the certificate with this Ed25519 private key (PEM)");
  command.add_flag("--json", arguments.json, "print the result as JSON");
  command.add_flag("--no-report", arguments.no_report, "write no report.html");
  command.add_flag("--timed", arguments.timed, "plan a move in time; the case has to have the key 'time'");
  CLI::Option* speed = command.add_option("--speed", arguments.speed,
                                          "share of the planned speed at which the move is run, such as 40%");
  command
      .add_flag("--max-speed", arguments.max_speed,
                "run the move as fast as its law is proved, and say what stands in the way of more")
      ->excludes(speed);
  add_headroom_option(command, arguments.headroom_seconds);
  command
      .add_option("--no-path", arguments.no_path_seconds,
                  fmt::format("seconds for proving that no path exists, where the search found none (default: {:.0f}); "
                              "0: don't try",
                              kNoPathSeconds))
      ->check(checker::complain_of_seconds);
  add_max_seconds_option(command, arguments.max_seconds);
}

int run_plan(const PlanArguments& arguments) {
  const Stopwatch stopwatch;
  Case case_ = load_case(arguments.case_path, require_plannable);
  if (arguments.budget_seconds > 0) {
    case_.planner.max_seconds = arguments.budget_seconds;
    case_.planner.has_budget = true;
  }
  require_move(case_, arguments);
  const ControllerStep step = read_controller_step(arguments.step, "--step");
  const std::optional<SigningKey> key = load_signing_key(arguments.key);
  const std::string date = report_date();
  Planner planner(case_, arguments.atlas);
  ResultInputs inputs("plan");
  inputs.add_file("case", arguments.case_path);
  const std::filesystem::path out =
      make_result_folder(arguments.out, std::filesystem::path(arguments.case_path).stem().string(), inputs);
  require_others(arguments, out);
  announce(case_, arguments.json);

  const Interruption interruption;
  const PlannedCase planned = plan(case_, planner, arguments, key, interruption.token());
  const checker::CheckResult& checked = planned.checked;
  Outcome outcome{planned, {}, out};
  const ReportOptions report_options{"", "", date};
  std::optional<ReportContext> context;
  if (!is_no_path(planned)) context.emplace(checked);
  std::vector<FileContent> files = {{out / "certificate.json", planned.text}};
  for (auto& [name, bytes] : mesh_files(case_)) files.push_back({out / name, std::move(bytes)});
  std::vector<std::filesystem::path> remove_first = outdated_results(out, inputs);
  if (arguments.no_report) {
    remove_first.push_back(out / "report.html");
  } else {
    files.push_back(
        {out / "report.html", context ? html_report(*context, report_options) : html_report(checked, report_options)});
  }
  const bool saves_atlas = !arguments.save_atlas.empty() && planner.atlas().size() > 0;
  if (saves_atlas) files.push_back({arguments.save_atlas, planner.atlas_bytes()});
  if (outcome.is_proved()) {  // what is not proved is not for a machine to follow
    outcome.lengths = planner.measure(planned.plan.path);
    const Path& path = planned.plan.path;
    if (!path.timing) {
      files.push_back({out / "controller.csv", controller_csv(case_.problem, path, step, checked.sha256)});
    } else {  // a table without times would be about another motion than what is proved
      MoveTables tables = move_tables(case_.problem, path, case_.move.rate_Hz, checked.sha256);
      files.push_back({out / "winches.csv", std::move(tables.winches_csv)});
      files.push_back({out / "poses.csv", std::move(tables.poses_csv)});
      files.push_back({out / "poses.tum", std::move(tables.poses_tum)});
    }
    files.push_back({out / "path.csv", path_csv(case_.problem, path, checked.sha256)});  // last
  }
  write_whole(files, remove_first);

  if (arguments.json) {
    nlohmann::json result = summary(case_, outcome);
    std::vector<std::filesystem::path> written;
    for (const FileContent& file : files) written.push_back(file.path);
    add_ending(result, stopwatch, exit_code(checked), written);
    print_json(result);
    return exit_code(checked);
  }
  print_result(case_, outcome, context, report_options);
  print_wrapped(fmt::format("Written to {}: {}certificate.json{}", sanitize(out.string()),
                            !outcome.is_proved()       ? ""
                            : planned.plan.path.timing ? "path.csv, winches.csv, poses.csv, poses.tum, "
                                                       : "path.csv, controller.csv, ",
                            arguments.no_report ? "" : ", report.html"));
  if (saves_atlas) print_wrapped(atlas_sentence(planned, planner.atlas().size(), arguments.save_atlas));
  return exit_code(checked);
}

}  // namespace taut
