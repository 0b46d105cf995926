// SPDX-License-Identifier: GPL-3.0-or-later
#include "cli/plan_legs.h"

#include <fmt/format.h>

#include <algorithm>
#include <cstdlib>
#include <nlohmann/json.hpp>
#include <vector>

#include "app/legs.h"
#include "app/meshes.h"
#include "app/proved_path.h"
#include "app/report.h"
#include "base/files.h"
#include "base/input_error.h"
#include "base/plural.h"
#include "base/sanitize.h"
#include "cli/console.h"
#include "cli/headroom_output.h"
#include "cli/plan_output.h"
#include "cli/result_folder.h"
#include "cli/terminal.h"
#include "cli/verdict_output.h"
#include "problem/scalar.h"
#include "reports/page/html_report.h"
#include "reports/summary/display_units.h"
#include "reports/summary/headroom_of_legs.h"
#include "reports/summary/load_statement.h"
#include "reports/summary/summary.h"

namespace taut {
namespace {

namespace fs = std::filesystem;
using nlohmann::json;

/// A leg, and all that is said of it.
struct LegOutcome {
  std::string name;
  const Case& the_case;
  const PlannedLeg& planned;
  PlanOutcome outcome;
  ReportContext context;
  std::vector<fs::path> files = {};
};

std::string folder_name(const CaseLeg& leg, std::size_t k) { return fmt::format("{}-{}", k + 1, leg.name); }

PlannedLegs plan_with_progress(const CaseOfLegs& the_case, const PlanArguments& arguments, PlannedCaseOptions options,
                               const std::stop_token& stop) {
  ProgressLine line(!arguments.json);
  std::string at;
  options.headroom_progress = [&](std::size_t done, std::size_t all) {
    line.show([&] { return at + headroom_progress_text(done, all); });
  };
  const auto at_leg = [&](std::size_t k) {
    at = fmt::format("leg {} of {}, {}: ", k + 1, the_case.legs.size(), the_case.legs[k].name);
  };
  const auto progress = [&](const PlanProgress& now) { line.show([&] { return at + plan_progress_text(now); }); };
  return plan_legs(the_case.legs, options, at_leg, progress, stop);
}

/// The first leg with this verdict. @pre there is one
std::size_t first_with(const PlannedLegs& planned, const std::string& verdict) {
  const auto found = std::ranges::find_if(
      planned.legs, [&](const PlannedLeg& leg) { return verdict_name(leg.planned.checked) == verdict; });
  return static_cast<std::size_t>(found - planned.legs.begin());
}

/// The leg that the verdict over all is that of.
std::size_t decisive_leg(const PlannedLegs& planned) {
  return std::min(first_with(planned, verdict_name(planned.checked)), planned.legs.size() - 1);
}

/// How long all moves take together, if they are moves that are proved [s].
std::optional<double> duration_s(const PlannedLegs& planned) {
  if (exit_code(planned.checked) != kProvedExit) return std::nullopt;
  double sum = 0;
  for (const PlannedLeg& leg : planned.legs) {
    if (!leg.planned.plan.move) return std::nullopt;
    sum += leg.planned.plan.move->duration_s;
  }
  return sum;
}

std::string sentence_of_all(const CaseOfLegs& the_case, const PlannedLegs& planned) {
  const std::size_t count = planned.legs.size();
  const std::string verdict = verdict_name(planned.checked);
  if (verdict == "proved") {
    const auto duration = duration_s(planned);
    return fmt::format(
        "all {} legs are proved, each with its own load, and each begins at the very pose at which the one before it "
        "ends{}. Nothing is claimed of how a load is taken or put down between them.",
        count, duration ? fmt::format(", at rest; together they take {:.4g} s", *duration) : "");
  }
  const std::size_t k = decisive_leg(planned);
  const Said what = said(the_case.legs[k].content, planned.legs[k].planned);
  return fmt::format("leg {} of {}, {}: {}", k + 1, count, the_case.legs[k].name, what.text);
}

/// The least of the legs' margins, as the certificates write them; none unless all are proved.
json least_margins(const PlannedLegs& planned) {
  json result = json::object();
  if (exit_code(planned.checked) != kProvedExit) return result;
  const auto number = [](const json& text) { return ScalarTraits<double>::from_decimal(text.get<std::string>()); };
  for (const PlannedLeg& leg : planned.legs) {
    for (const auto& [key, value] : leg.planned.checked.theorem->margins().items()) {
      if (!result.contains(key) || number(value) < number(result[key])) result[key] = value;
    }
  }
  return result;
}

std::vector<LegHeadroom> headroom_of(const std::vector<LegOutcome>& legs) {
  std::vector<LegHeadroom> result;
  for (const LegOutcome& leg : legs) {
    result.push_back({leg.name, leg.planned.planned.headroom, leg.the_case.problem});
  }
  return result;
}

json json_of(const CaseOfLegs& the_case, const PlannedLegs& planned, const std::vector<LegOutcome>& legs,
             const fs::path& out) {
  const bool is_proved = exit_code(planned.checked) == kProvedExit;
  json result = {{"command", "plan"},
                 {"verdict", verdict_name(planned.checked)},
                 {"margins", least_margins(planned)},
                 {"segments", planned.checked.counts.segments},
                 {"boxes", planned.checked.counts.boxes},
                 {"recheck", to_json(planned.checked)},
                 {"warnings", the_case.whole.warnings},
                 {"messages", messages_json({is_proved ? "" : sentence_of_all(the_case, planned)})},
                 {"out", out.string()},
                 {"headroom", headroom_json(headroom_of(legs))},
                 {"legs", json::array()}};
  double length = 0, angle = 0, cost = 0;
  int charts = 0;
  for (const LegOutcome& leg : legs) {
    const PlanStatistics& s = leg.planned.planned.plan.statistics;
    length += leg.outcome.lengths.length_m;
    angle += leg.outcome.lengths.angle_rad;
    cost += s.cost;
    charts += s.charts;
    json plan = plan_json(leg.the_case, leg.outcome);
    plan["elapsed_seconds"] = leg.planned.seconds;
    plan["exit_code"] = static_cast<int>(exit_code(leg.planned.planned.checked));
    plan["files"] = json::array();
    for (const fs::path& file : leg.files) plan["files"].push_back(file.string());
    result["legs"].push_back({{"name", leg.name}, {"plan", std::move(plan)}});
  }
  const auto duration = duration_s(planned);
  result["length_m"] = is_proved ? json(length) : json();
  result["angle_rad"] = is_proved ? json(angle) : json();
  result["cost"] = cost;
  result["charts"] = charts;
  result["duration_s"] = duration ? json(*duration) : json();
  return result;
}

void print(const CaseOfLegs& the_case, const PlannedLegs& planned, const std::vector<LegOutcome>& legs,
           const ReportOptions& options) {
  const Summary decisive(legs[decisive_leg(planned)].context, options);
  print_verdict(verdict_in_full(decisive), sentence_of_all(the_case, planned));
  for (std::size_t k = 0; k < legs.size(); ++k) {
    const LegOutcome& leg = legs[k];
    const Summary shown(leg.context, options);
    fmt::print("\nLeg {} of {}, {}\n", k + 1, legs.size(), leg.name);
    print_problem(leg.the_case);
    print_verdict(verdict_in_full(shown), said(leg.the_case, leg.planned.planned).text);
    print_key_numbers(shown.key_numbers);
    print_remarks(leg.the_case, leg.outcome);
  }
  fmt::print("\n");
  if (planned.checked.outcome != checker::Outcome::kUnchecked) {
    for (const std::string& line : headroom_sentences(headroom_of(legs), DisplayUnits(the_case.whole.units))) {
      print_wrapped(sanitize(line));
    }
  }
  print_wrapped(sentence(planned.checked));
}

/// The tables of all legs, if they are moves that are proved.
void add_tables_of_all(const CaseOfLegs& the_case, const PlannedLegs& planned, const fs::path& out,
                       std::vector<FileContent>& files) {
  if (!duration_s(planned)) return;
  std::vector<MoveLeg> moves;
  for (std::size_t k = 0; k < planned.legs.size(); ++k) {
    const PlannedCase& leg = planned.legs[k].planned;
    moves.push_back(
        {the_case.legs[k].content.problem, leg.plan.path, the_case.legs[k].name, tension_pieces(leg.checked)});
  }
  add_move_tables(
      out, move_tables(moves, the_case.whole.problem.name, the_case.whole.move.rate_Hz, planned.checked.sha256), files);
}

}  // namespace

void require_options_of_legs(const PlanArguments& arguments) {
  const char* const option = !arguments.atlas.empty()        ? "--atlas"
                             : !arguments.save_atlas.empty() ? "--save-atlas"
                                                             : nullptr;
  if (option == nullptr) return;
  throw InputError(ErrorCode::kUse,
                   fmt::format("{}: got a case with legs, each of which has an atlas of its own, expected one with "
                               "'query.waypoints'",
                               option));
}

int run_plan_of_legs(const CaseOfLegs& the_case, const PlanArguments& arguments, const PlannedCaseOptions& options,
                     const Stopwatch& stopwatch) {
  const ControllerStep step = read_controller_step(arguments.step, "--step");
  const ReportOptions report_options{"", "", report_date()};
  ResultInputs inputs("plan");
  inputs.add_file("case", arguments.case_path);
  const fs::path out = make_result_folder(arguments.out, fs::path(arguments.case_path).stem().string(), inputs);
  const std::vector<std::string> read = {arguments.case_path, arguments.key};
  require_results_apart(out, read);
  for (std::size_t k = 0; k < the_case.legs.size(); ++k) {
    require_results_apart(out / folder_name(the_case.legs[k], k), read);
  }
  for (const std::string& warning : the_case.whole.warnings) complain("warning: " + warning);

  const Interruption interruption;
  const PlannedLegs planned = plan_with_progress(the_case, arguments, options, interruption.token());
  std::vector<LegOutcome> legs;
  std::vector<FileContent> files;
  std::vector<fs::path> remove_first = outdated_results(out, inputs);
  if (arguments.no_report) remove_first.push_back(out / "report.html");
  for (std::size_t k = 0; k < planned.legs.size(); ++k) {
    const PlannedLeg& leg = planned.legs[k];
    const fs::path folder = out / folder_name(the_case.legs[k], k);
    make_directories(folder);
    legs.push_back({the_case.legs[k].name,
                    the_case.legs[k].content,
                    leg,
                    {leg.planned, leg.lengths, folder},
                    ReportContext(leg.planned.checked)});
    for (const fs::path& file : outdated_results(folder, inputs)) remove_first.push_back(file);
    if (arguments.no_report) remove_first.push_back(folder / "report.html");
    std::vector<FileContent> of_leg = {{folder / "certificate.json", leg.planned.text}};
    for (auto& [name, bytes] : mesh_files(the_case.legs[k].content)) {
      of_leg.push_back({folder / name, std::move(bytes)});
    }
    if (!arguments.no_report) {
      of_leg.push_back({folder / "report.html", html_report(legs.back().context, report_options)});
    }
    for (FileContent& file : plan_files(the_case.legs[k].content, legs.back().outcome, step))
      of_leg.push_back(std::move(file));
    for (FileContent& file : of_leg) {
      legs.back().files.push_back(file.path);
      files.push_back(std::move(file));
    }
  }
  files.push_back({out / "certificate.json", planned.text});
  for (auto& [name, bytes] : mesh_files(the_case.legs)) files.push_back({out / name, std::move(bytes)});
  if (!arguments.no_report) files.push_back({out / "report.html", html_report(planned.checked, report_options)});
  add_tables_of_all(the_case, planned, out, files);
  write_whole(files, remove_first);

  const int code = exit_code(planned.checked);
  if (arguments.json) {
    json document = json_of(the_case, planned, legs, out);
    std::vector<fs::path> written;
    for (const FileContent& file : files) written.push_back(file.path);
    add_ending(document, stopwatch, code, written);
    print_json(document);
    return code;
  }
  print(the_case, planned, legs, report_options);
  print_wrapped(fmt::format(
      "Written to {}: certificate.json{} of all legs{}; of each leg its own, in {} to {}", sanitize(out.string()),
      arguments.no_report ? "" : " and report.html", duration_s(planned) ? ", winches.csv, poses.csv, poses.tum" : "",
      folder_name(the_case.legs.front(), 0), folder_name(the_case.legs.back(), the_case.legs.size() - 1)));
  return code;
}

}  // namespace taut
