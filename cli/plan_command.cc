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
#include "checker/arguments.h"
#include "cli/console.h"
#include "cli/headroom_output.h"
#include "cli/number_option.h"
#include "cli/output.h"
#include "cli/plan_legs.h"
#include "cli/plan_output.h"
#include "cli/result_folder.h"
#include "cli/terminal.h"
#include "path_io/controller_csv.h"
#include "reports/page/html_report.h"

namespace taut {
namespace {

/// Checks that no file that is written is one that is read.
void require_others(const PlanArguments& arguments, const std::filesystem::path& out) {
  const std::vector<std::string> read = {arguments.case_path, arguments.key};
  if (!arguments.save_atlas.empty()) {
    require_writable(arguments.save_atlas);
    for (const std::string& file : read) require_another(arguments.save_atlas, file);
  }
  require_results_apart(out, read);
  require_results_apart(out, {arguments.atlas, arguments.save_atlas});
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
  if (option != nullptr) require_limits_in_time(the_case, option);
}

/// All but what is called while it plans.
PlannedCaseOptions options_of(const PlanArguments& arguments, const std::optional<SigningKey>& key) {
  PlannedCaseOptions options;
  options.grow = arguments.grow;
  options.key = key ? &*key : nullptr;
  options.max_seconds = arguments.max_seconds;
  options.grow_seconds = arguments.grow_seconds;
  options.headroom_seconds = arguments.headroom_seconds;
  options.no_path_seconds = arguments.no_path_seconds;
  if (arguments.speed) options.move.speed_share = read_speed(*arguments.speed);
  options.move.seeks_greatest_speed = arguments.max_speed;
  return options;
}

/// Plans, with a progress line.
PlannedCase plan(const Case& the_case, Planner& planner, const PlanArguments& arguments,
                 const std::optional<SigningKey>& key, const std::stop_token& stop) {
  ProgressLine line(!arguments.json);
  std::optional<Stopwatch> growing;
  const auto progress = [&](const PlanProgress& at) {
    line.show([&] {
      if (!growing) return plan_progress_text(at);
      return fmt::format("growing the atlas: {}, {:.0f} of at most {:.6g} s",
                         plural(static_cast<std::size_t>(at.charts), "chart"), growing->seconds(),
                         arguments.grow_seconds);
    });
  };
  PlannedCaseOptions options = options_of(arguments, key);
  options.announce_growth = [&](const GrowthEstimate& estimate) {
    growing.emplace();
    if (arguments.json) return;
    line.clear();
    fmt::print("{}\n", growth_announcement(estimate, arguments.grow_seconds));
    std::fflush(stdout);
  };
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
  CaseOfLegs loaded = load_case_of_legs(arguments.case_path, require_plannable);
  Case& case_ = loaded.whole;
  const auto give_budget = [&](Case& of) {
    if (!(arguments.budget_seconds > 0)) return;
    of.planner.max_seconds = arguments.budget_seconds;
    of.planner.has_budget = true;
  };
  give_budget(case_);
  for (CaseLeg& leg : loaded.legs) give_budget(leg.content);
  require_move(case_, arguments);
  const ControllerStep step = read_controller_step(arguments.step, "--step");
  const std::optional<SigningKey> key = load_signing_key(arguments.key);
  if (!loaded.legs.empty()) {
    require_options_of_legs(arguments);
    return run_plan_of_legs(loaded, arguments, options_of(arguments, key), stopwatch);
  }
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
  PlanOutcome outcome{planned, {}, out};
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
  if (outcome.is_proved()) outcome.lengths = planner.measure(planned.plan.path);
  for (FileContent& file : plan_files(case_, outcome, step)) files.push_back(std::move(file));
  write_whole(files, remove_first);

  if (arguments.json) {
    nlohmann::json result = plan_json(case_, outcome);
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
