// SPDX-License-Identifier: GPL-3.0-or-later
#include "cli/plan_command.h"

#include <fmt/format.h>

#include <array>
#include <cmath>
#include <filesystem>
#include <nlohmann/json.hpp>
#include <optional>
#include <stop_token>
#include <vector>

#include "app/plan.h"
#include "app/report.h"
#include "base/files.h"
#include "base/sanitize.h"
#include "certificate/signature.h"
#include "certify/undecided.h"
#include "cli/console.h"
#include "cli/headroom_output.h"
#include "cli/number_option.h"
#include "path_io/path_csv.h"
#include "reports/summary/sentences.h"

namespace taut {
namespace {

std::string plan_sentence(const Plan& plan, const checker::CheckResult& checked) {
  const PathProof& proof = plan.proof;
  if (checked.outcome == checker::Outcome::kUnchecked) {
    return fmt::format("UNCHECKED: {}. Nothing is claimed of the path.", checked.message);
  }
  if (checked.outcome == checker::Outcome::kUndecided && proof.verdict != Verdict::kUndecided) {
    return fmt::format("undecided: {}.", with_code(Reason(Undecided::kKernel).text()));
  }
  switch (proof.verdict) {
    case Verdict::kProved: {
      const checker::Theorem& theorem = checked.theorem.value();
      const auto margin = [&](const char* key) { return theorem.margins().at(key).get<std::string>(); };
      return fmt::format(
          "proved: the path is wrench-feasible and clear of singularities between all its waypoints, {} {}segments in "
          "{} boxes.\nProved margins: tension {} N, length {} m, wrench_scale {}.",
          theorem.counts().segments, plan.path.interpolation == Interpolation::kCubicBSpline ? "spline " : "",
          theorem.counts().boxes, margin("tension_N"), margin("length_m"), margin("wrench_scale"));
    }
    case Verdict::kRefuted: {
      const PathWitness& w = *proof.witness;
      const std::string where = plan.refuted_waypoint
                                    ? fmt::format("at waypoint {} of the query", *plan.refuted_waypoint)
                                : w.at.on_segment ? fmt::format("on segment {} of the path", w.at.index)
                                                  : fmt::format("at waypoint {} of the path", w.at.index);
      return fmt::format("refuted: {} {}.", where, violation_text(w));
    }
    case Verdict::kUndecided: break;
  }
  return fmt::format("undecided: {}.", with_code(proof.reason.text()));
}

/// What the search knows of its path.
std::string length_sentence(const PlanStatistics& s) {
  const std::string spent = s.budget_spent ? "; the budget is spent" : "";
  if (s.factor == 1) return "The path found is the shortest on the charts' graph" + spent;
  if (!std::isfinite(s.factor)) return "The path found is the first, not the shortest, on the charts' graph" + spent;
  return fmt::format("The path found is at most {:.4g} times as long as the shortest on the charts' graph{}", s.factor,
                     spent);
}

/// Checks that no file that is written is one that is read.
void require_others(const PlanArguments& arguments, const std::filesystem::path& out) {
  const std::vector<std::string> read = {arguments.case_path, arguments.key};
  if (!arguments.save_atlas.empty()) {
    require_writable(arguments.save_atlas);
    for (const std::string& file : read) require_another(arguments.save_atlas, file);
  }
  for (const char* name : {"path.csv", "certificate.json", "report.html"}) {
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

nlohmann::json summary(const Outcome& outcome) {
  const PlanStatistics& s = outcome.planned.plan.statistics;
  const checker::CheckResult& checked = outcome.planned.checked;
  const auto if_proved = [&](double x) { return outcome.is_proved() ? nlohmann::json(x) : nlohmann::json(); };
  const bool is_undecided = checked.outcome == checker::Outcome::kUndecided;
  return {{"verdict", verdict_name(checked)},
          {"segments", checked.counts.segments},
          {"boxes", checked.counts.boxes},
          {"charts", s.charts},
          {"charts_stored", s.charts_stored},
          {"nodes_expanded", s.nodes_expanded},
          {"edges_checked", s.edges_checked},
          {"edges_rejected", s.edges_rejected},
          {"cost", s.cost},
          {"cost_found", s.cost_found},
          {"within_factor", std::isfinite(s.factor) ? nlohmann::json(s.factor) : nlohmann::json()},
          {"budget_spent", s.budget_spent},
          {"length_m", if_proved(outcome.lengths.length_m)},
          {"angle_rad", if_proved(outcome.lengths.angle_rad)},
          {"plan_seconds", s.plan_seconds},
          {"smooth_seconds", s.smooth_seconds},
          {"prove_seconds", s.prove_seconds},
          {"headroom", headroom_json(outcome.planned.headroom)},
          {"margins", checked.theorem ? checked.theorem->margins() : nlohmann::json::object()},
          {"witness", checked.theorem ? checked.theorem->witness() : nlohmann::json()},
          {"undecided", is_undecided ? checked.certificate->at("undecided") : nlohmann::json()},
          {"recheck", to_json(checked)},
          {"out", outcome.out.string()}};
}

void print_search(const Outcome& outcome) {
  const PlanStatistics& s = outcome.planned.plan.statistics;
  if (s.charts == 0) return;
  fmt::print("{} charts, {} expanded; {} edges looked at, {} refused; cost {:.4g}, shortened from {:.4g}.\n", s.charts,
             s.nodes_expanded, s.edges_checked, s.edges_rejected, s.cost, s.cost_found);
  if (outcome.is_proved()) {
    fmt::print("On its way the platform's origin moves {:.4g} m, and the platform turns {:.4g} rad.\n",
               outcome.lengths.length_m, outcome.lengths.angle_rad);
  }
  fmt::print("Planned in {:.2f} ms, shortened in {:.2f} ms, proved in {:.2f} ms.\n", 1e3 * s.plan_seconds,
             1e3 * s.smooth_seconds, 1e3 * s.prove_seconds);
  if (outcome.is_proved()) fmt::print("{}.\n", length_sentence(s));
}

/// Plans, with a progress line.
PlannedCase plan(const Case& the_case, Planner& planner, const PlanArguments& arguments,
                 const std::optional<SigningKey>& key, const std::stop_token& stop) {
  ProgressLine line(!arguments.json);
  const auto progress = [&](const PlanProgress& at) {
    line.show([&] { return fmt::format("planning: {} charts", at.charts); });
  };
  PlannedCaseOptions options{arguments.grow, key ? &*key : nullptr, arguments.max_seconds, arguments.headroom_seconds};
  options.headroom_progress = [&](std::size_t done, std::size_t all) {
    line.show([&] { return headroom_progress_text(done, all); });
  };
  return plan_case(the_case, planner, options, progress, stop);
}

}  // namespace

void add_plan_options(CLI::App& command, PlanArguments& arguments) {
  command.add_option("CASE", arguments.case_path, "case file (docs/case-format.md)")->required();
  command.add_option("--out", arguments.out, "directory for the results (default: out/CASE's name)");
  command.add_option("--atlas", arguments.atlas, "begin with the charts of this file (docs/atlas-file.md)");
  CLI::Option* save_atlas = command.add_option("--save-atlas", arguments.save_atlas, "write all charts into this file");
  command.add_flag("--grow", arguments.grow, "make all charts that can be reached before they are saved")
      ->needs(save_atlas);
  command.add_option("--budget", arguments.budget_seconds, "seconds for planning and proving, before the case's own")
      ->check(positive_number("a number of seconds above 0"));
  command.add_option("--sign", arguments.key, "sign the certificate with this Ed25519 private key (PEM)");
  command.add_flag("--json", arguments.json, "print the result as JSON");
  add_headroom_option(command, arguments.headroom_seconds);
  add_max_seconds_option(command, arguments.max_seconds);
}

int run_plan(const PlanArguments& arguments) {
  Case case_ = load_case(arguments.case_path, require_plannable);
  if (arguments.budget_seconds > 0) {
    case_.planner.max_seconds = arguments.budget_seconds;
    case_.planner.has_budget = true;
  }
  const std::filesystem::path out = out_folder(arguments.out, arguments.case_path);
  const std::optional<SigningKey> key = load_signing_key(arguments.key);
  const std::string date = report_date();
  require_others(arguments, out);
  Planner planner(case_, arguments.atlas);
  make_directories(out);

  const Interruption interruption;
  const PlannedCase planned = plan(case_, planner, arguments, key, interruption.token());
  const checker::CheckResult& checked = planned.checked;
  Outcome outcome{planned, {}, out};
  std::vector<FileContent> files = {{out / "certificate.json", planned.text},
                                    {out / "report.html", make_report(checked, {"", "", date}, ReportForm::kPage)}};
  const bool saves_atlas = !arguments.save_atlas.empty() && planner.atlas().size() > 0;
  if (saves_atlas) files.push_back({arguments.save_atlas, planner.atlas_bytes()});
  // What is not proved is not for a machine to follow: path.csv goes first, and comes back last.
  const std::array<std::filesystem::path, 1> path_file = {out / "path.csv"};
  if (outcome.is_proved()) {
    outcome.lengths = planner.measure(planned.plan.path);
    files.push_back({path_file[0], path_csv(case_.problem, planned.plan.path, checked.sha256)});
  }
  write_whole(files, path_file);

  if (arguments.json) {
    fmt::print("{}\n", summary(outcome).dump(1, ' ', true, nlohmann::json::error_handler_t::replace));
    return exit_code(checked);
  }
  fmt::print("{}\n", plan_sentence(planned.plan, checked));
  print_search(outcome);
  print_headroom(planned.headroom);
  fmt::print("{}\nWritten to {}: {}certificate.json, report.html\n", sentence(checked), sanitize(out.string()),
             outcome.is_proved() ? "path.csv, " : "");
  if (saves_atlas) {
    fmt::print("Atlas of {} charts{} written to {}\n", planner.atlas().size(),
               planned.whole_atlas ? ", all that can be reached," : "", sanitize(arguments.save_atlas));
  }
  return exit_code(checked);
}

}  // namespace taut
