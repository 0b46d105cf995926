// SPDX-License-Identifier: GPL-3.0-or-later
// taut: plans motions of cable-driven hexapods and proves them. Command line and exit codes; decides nothing itself.
#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <array>
#include <cmath>
#include <cstdio>
#include <exception>
#include <filesystem>
#include <iostream>
#include <nlohmann/json.hpp>
#include <optional>

#include "app/planned_case.h"
#include "app/recheck.h"
#include "app/tolerance_table.h"
#include "base/files.h"
#include "base/input_error.h"
#include "base/process.h"
#include "base/sanitize.h"
#include "certificate/signature.h"
#include "certify/arithmetic/rounding.h"
#include "certify/undecided.h"
#include "checker/arguments.h"
#include "cli/audit_command.h"
#include "cli/console.h"
#include "cli/doctor.h"
#include "cli/explain.h"
#include "cli/init.h"
#include "cli/number_option.h"
#include "cli/pdf.h"
#include "cli/regress_command.h"
#include "cli/report_command.h"
#include "cli/show.h"
#include "path_io/path_csv.h"
#include "reports/page/html_report.h"
#include "reports/summary/sentences.h"

namespace taut {
namespace {

// ---- taut plan -------------------------------------------------------------------------------------------------------

struct PlanArguments {
  std::string case_path;
  std::string out;
  std::string atlas;
  std::string save_atlas;
  std::string key;  ///< file of the private key that signs, or empty
  bool grow = false;
  double budget_seconds = 0;  ///< 0: the case's
  bool json = false;
  double max_seconds = kCheckSeconds;  ///< that the checker may take
};

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

int run_plan(const PlanArguments& arguments) {
  Case case_ = load_case(arguments.case_path, require_plannable);
  if (arguments.budget_seconds > 0) {
    case_.planner.max_seconds = arguments.budget_seconds;
    case_.planner.has_budget = true;
  }
  const std::filesystem::path out = out_folder(arguments.out, arguments.case_path);
  const std::optional<SigningKey> key = load_signing_key(arguments.key);
  const std::string date = report_date();
  const std::vector<std::string> read = {arguments.case_path, arguments.key};
  if (!arguments.save_atlas.empty()) {
    require_writable(arguments.save_atlas);
    for (const std::string& file : read) require_another(arguments.save_atlas, file);
  }
  for (const char* name : {"path.csv", "certificate.json", "report.html"}) {
    for (const std::string& file : read) require_another(out / name, file);
    for (const std::string& file : {arguments.atlas, arguments.save_atlas}) require_another(out / name, file);
  }
  Planner planner(case_, arguments.atlas);
  make_directories(out);

  const Interruption interruption;
  PlannedCase planned;
  {
    ProgressLine line(!arguments.json);
    const auto progress = [&](const PlanProgress& at) {
      line.show([&] { return fmt::format("planning: {} charts", at.charts); });
    };
    planned = plan_case(case_, planner, {arguments.grow, key ? &*key : nullptr, arguments.max_seconds}, progress,
                        interruption.token());
  }
  const Plan& result = planned.plan;
  const checker::CheckResult& checked = planned.checked;
  const bool is_proved = exit_code(checked) == kProvedExit;
  const std::vector<ToleranceLimit> limits = is_proved ? planned.tolerance_limits : std::vector<ToleranceLimit>();
  std::vector<FileContent> files = {{out / "certificate.json", planned.text},
                                    {out / "report.html", html_report(checked, {"", "", date})}};
  const bool saves_atlas = !arguments.save_atlas.empty() && planner.atlas().size() > 0;
  if (saves_atlas) files.push_back({arguments.save_atlas, planner.atlas_bytes()});
  // What is not proved is not for a machine to follow: path.csv goes first, and comes back last.
  const std::array<std::filesystem::path, 1> path_file = {out / "path.csv"};
  if (is_proved) files.push_back({path_file[0], path_csv(case_.problem, result.path, checked.sha256)});
  write_whole(files, path_file);

  const PlanStatistics& s = result.statistics;
  const MotionLengths lengths = is_proved ? planner.measure(result.path) : MotionLengths{};
  if (arguments.json) {
    const nlohmann::json summary = {
        {"verdict", verdict_name(checked)},
        {"segments", checked.counts.segments},
        {"boxes", checked.counts.boxes},
        {"charts", s.charts},
        {"charts_stored", s.charts_stored},
        {"nodes_expanded", s.nodes_expanded},
        {"edges_checked", s.edges_checked},
        {"edges_rejected", s.edges_rejected},
        {"cost", s.cost},
        {"cost_found", s.cost_found},
        {"within_factor", std::isfinite(s.factor) ? nlohmann::json(s.factor) : nullptr},
        {"budget_spent", s.budget_spent},
        {"length_m", is_proved ? nlohmann::json(lengths.length_m) : nullptr},
        {"angle_rad", is_proved ? nlohmann::json(lengths.angle_rad) : nullptr},
        {"plan_seconds", s.plan_seconds},
        {"smooth_seconds", s.smooth_seconds},
        {"prove_seconds", s.prove_seconds},
        {"tolerance_limits", to_json(limits)},
        {"margins", checked.theorem ? checked.theorem->margins() : nlohmann::json::object()},
        {"witness", checked.theorem ? checked.theorem->witness() : nlohmann::json()},
        {"undecided",
         checked.outcome == checker::Outcome::kUndecided ? checked.certificate->at("undecided") : nlohmann::json()},
        {"recheck", to_json(checked)},
        {"out", out.string()}};
    fmt::print("{}\n", summary.dump(1, ' ', true, nlohmann::json::error_handler_t::replace));
  } else {
    fmt::print("{}\n", plan_sentence(result, checked));
    if (s.charts > 0) {
      fmt::print("{} charts, {} expanded; {} edges looked at, {} refused; cost {:.4g}, shortened from {:.4g}.\n",
                 s.charts, s.nodes_expanded, s.edges_checked, s.edges_rejected, s.cost, s.cost_found);
      if (is_proved) {
        fmt::print("On its way the platform's origin moves {:.4g} m, and the platform turns {:.4g} rad.\n",
                   lengths.length_m, lengths.angle_rad);
      }
      fmt::print("Planned in {:.2f} ms, shortened in {:.2f} ms, proved in {:.2f} ms.\n", 1e3 * s.plan_seconds,
                 1e3 * s.smooth_seconds, 1e3 * s.prove_seconds);
      if (is_proved) fmt::print("{}.\n", length_sentence(s));
      fmt::print("{}", tolerance_table(limits));
    }
    fmt::print("{}\nWritten to {}: {}certificate.json, report.html\n", sentence(checked), sanitize(out.string()),
               is_proved ? "path.csv, " : "");
    if (saves_atlas) {
      fmt::print("Atlas of {} charts{} written to {}\n", planner.atlas().size(),
                 planned.whole_atlas ? ", all that can be reached," : "", sanitize(arguments.save_atlas));
    }
  }
  return exit_code(checked);
}

int run(int argc, char** argv) {
  CLI::App app("Plans motions of cable-driven hexapods and proves what it plans.", "taut");
  app.set_version_flag("--version", std::string("taut ") + TAUT_VERSION);
  app.require_subcommand(1);
  app.failure_message([argc, argv](const CLI::App* failed, const CLI::Error& error) {
    std::string message = error.what();
    std::string command;
    for (const CLI::App* known : failed->get_subcommands({})) {
      if (known->parsed()) command = " " + known->get_name();
    }
    if (command.empty() && dynamic_cast<const CLI::RequiredError*>(&error) != nullptr) {
      message = argc > 1 ? fmt::format("got '{}', expected a command:", argv[1]) : "expected a command:";
      for (const CLI::App* known : failed->get_subcommands({})) message += " " + known->get_name();
    }
    return fmt::format("{} [{}]\nRun with --help for more information: {}{} --help\n", sanitize(message),
                       code(InputKind::kUse), failed->get_name(), command);
  });
  app.footer(
      "Exit codes of plan and audit, whose verdict is the independent checker's: 0 proved, 1 refuted, 2 undecided or "
      "unchecked, 3 bad input, 4 internal failure or untrustworthy machine. Of the others: 0 done, 1 rejected (report) "
      "or not as expected (regress), 2 interrupted or unchecked, 3 and 4 likewise.");

  PlanArguments plan_arguments;
  CLI::App* plan_command = app.add_subcommand("plan", "plan, prove, write path.csv, certificate.json, report.html");
  plan_command->add_option("CASE", plan_arguments.case_path, "case file (docs/case-format.md)")->required();
  plan_command->add_option("--out", plan_arguments.out, "directory for the results (default: out/CASE's name)");
  plan_command->add_option("--atlas", plan_arguments.atlas, "begin with the charts of this file (docs/atlas-file.md)");
  CLI::Option* save_atlas =
      plan_command->add_option("--save-atlas", plan_arguments.save_atlas, "write all charts into this file");
  plan_command->add_flag("--grow", plan_arguments.grow, "make all charts that can be reached before they are saved")
      ->needs(save_atlas);
  plan_command
      ->add_option("--budget", plan_arguments.budget_seconds, "seconds for planning and proving, before the case's own")
      ->check(positive_number("a number of seconds above 0"));
  plan_command->add_option("--sign", plan_arguments.key, "sign the certificate with this Ed25519 private key (PEM)");
  plan_command->add_flag("--json", plan_arguments.json, "print the result as JSON");
  add_max_seconds_option(*plan_command, plan_arguments.max_seconds);

  AuditArguments audit_arguments;
  CLI::App* audit_command = app.add_subcommand("audit", "prove or refute a path that something else made");
  add_audit_options(*audit_command, audit_arguments);

  RegressArguments regress_arguments;
  CLI::App* regress_command = app.add_subcommand("regress", "run every case of a folder against what it declares");
  add_regress_options(*regress_command, regress_arguments);

  std::string new_path;
  CLI::App* init_command = app.add_subcommand("init", "write a commented case to begin from");
  init_command->add_option("FILE", new_path, "case file to write")->required();
  CLI::App* doctor_command = app.add_subcommand("doctor", "look whether this machine can be trusted with proofs");

  ReportArguments report_arguments;
  CLI::App* report_command =
      app.add_subcommand("report", "write the report from the certificate alone: page, PDF or summary");
  add_report_options(*report_command, report_arguments);

  ExplainArguments explain_arguments;
  CLI::App* explain_command = app.add_subcommand("explain", "say what the code behind a message means: U3, E5");
  add_explain_options(*explain_command, explain_arguments);

  ShowArguments show_arguments;
  CLI::App* show_command = app.add_subcommand("show", "print what a case was understood to say; draw the robot");
  add_show_options(*show_command, show_arguments);

  checker::refuse_empty_arguments(app);
  try {
    app.parse(argc, argv);
  } catch (const CLI::ParseError& error) {
    return app.exit(error) == 0 ? 0 : kBadInputExit;
  }
  if (*plan_command) {
    rounding_self_test();
    return reading(InputKind::kCase, [&] { return run_plan(plan_arguments); });
  }
  if (*audit_command) {
    rounding_self_test();
    return reading(InputKind::kPath, [&] { return run_audit(audit_arguments); });
  }
  if (*show_command) return reading(InputKind::kCase, [&] { return run_show(show_arguments); });
  if (*explain_command) return run_explain(explain_arguments);
  if (*init_command) return run_init(new_path);
  if (*doctor_command) return run_doctor();
  if (*regress_command) return reading(InputKind::kRegress, [&] { return run_regress(regress_arguments); });
  rounding_self_test();
  return reading(InputKind::kCertificate, [&] { return run_report(report_arguments); });
}

}  // namespace
}  // namespace taut

/// Before all other initialisation, which may fail for want of memory, too.
[[gnu::constructor(101)]] static void prepare() { taut::prepare_process("taut", taut::kInternalCode); }

int main(int argc, char** argv) {
  const auto failed = [](const std::exception& error, const auto& code, int exit_code) {
    taut::complain(fmt::format("{} [{}]", error.what(), code));
    return exit_code;
  };
  try {
    const int code = taut::run(argc, argv);
    if (std::fflush(stdout) != 0 || !std::cout.flush()) throw std::runtime_error("could not write to standard output");
    return code;
  } catch (const taut::InputErrorOfKind& error) {
    return failed(error, taut::code(error.kind()), taut::kBadInputExit);
  } catch (const taut::InputError& error) {
    return failed(error, taut::code(taut::InputKind::kUse), taut::kBadInputExit);
  } catch (const std::filesystem::filesystem_error& error) {
    return failed(error, taut::code(taut::InputKind::kFile), taut::kBadInputExit);
  } catch (const taut::BrowserFailed& error) {
    return failed(error, taut::kBrowserFailedCode, taut::kInternalExit);
  } catch (const taut::UntrustworthyMachine& error) {
    return failed(error, taut::kUntrustworthyCode, taut::kInternalExit);
  } catch (const std::bad_alloc&) {
    taut::complain(fmt::format("internal failure: out of memory [{}]", taut::kInternalCode));
  } catch (const std::exception& error) {
    taut::complain(fmt::format("internal failure: {} [{}]", error.what(), taut::kInternalCode));
  }
  return taut::kInternalExit;
}
