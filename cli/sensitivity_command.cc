// SPDX-License-Identifier: GPL-3.0-or-later
#include "cli/sensitivity_command.h"

#include <fmt/format.h>

#include <algorithm>
#include <nlohmann/json.hpp>
#include <optional>
#include <vector>

#include "app/plan.h"
#include "app/sensitivity.h"
#include "app/sensitivity_json.h"
#include "base/input_error.h"
#include "certify/severity.h"
#include "cli/console.h"
#include "cli/headroom_output.h"
#include "cli/number_option.h"
#include "cli/output.h"
#include "problem/decimal.h"
#include "reports/summary/headroom_summary.h"
#include "reports/summary/load_statement.h"

namespace taut {
namespace {

using Parameter = DesignParameter;

constexpr std::array<const char*, 6> kAxes = {"x", "y", "z", "x", "y", "z"};

/// "platform anchor 3, y"
std::string words(const Parameter& p) {
  using Kind = Parameter::Kind;
  const std::size_t cable = p.index + 1;
  switch (p.kind) {
    case Kind::kBaseAnchor: return fmt::format("base anchor {}, {}", cable, kAxes.at(p.axis));
    case Kind::kPlatformAnchor: return fmt::format("platform anchor {}, {}", cable, kAxes.at(p.axis));
    case Kind::kLoadPoint: return fmt::format("load point, {}", kAxes.at(p.axis));
    case Kind::kWrench: return fmt::format("wrench, {} {}", p.axis < 3 ? "force" : "moment", kAxes.at(p.axis));
    case Kind::kWeight: return "weight of the load (w0 as a whole)";
    case Kind::kMass: return fmt::format("mass of {}", quoted_name(p.uncertainty.item));
    case Kind::kTensionLower: return fmt::format("lower tension limit of cable {}", cable);
    case Kind::kTensionUpper: return fmt::format("upper tension limit of cable {}", cable);
    case Kind::kLengthLower: return fmt::format("lower length limit of cable {}", cable);
    case Kind::kLengthUpper: return fmt::format("upper length limit of cable {}", cable);
    case Kind::kTolerance: break;
  }
  switch (p.uncertainty.kind) {
    case UncertaintyKind::kWrenchSet: return "deviations of the load";
    case UncertaintyKind::kLoadItem: return fmt::format("deviations of {}", quoted_name(p.uncertainty.item));
    default: return fmt::format("tolerance {}", taut::name(p.uncertainty.kind));
  }
}

/// "mm", "%", "0.01 N": the step that a gain is for.
std::string step_text(const Parameter& p, double step, const DisplayUnits& units) {
  const auto amount = [&](const DisplayUnit& unit) { return fmt::format("{:.3g} {}", unit.approx(step), unit.name()); };
  using Kind = Parameter::Kind;
  switch (p.kind) {
    case Kind::kWeight:
    case Kind::kMass:
    case Kind::kTolerance: return "%";
    case Kind::kBaseAnchor:
    case Kind::kPlatformAnchor:
    case Kind::kLoadPoint: return "mm";
    case Kind::kLengthLower:
    case Kind::kLengthUpper: return amount(units.length);
    case Kind::kWrench: return amount(p.axis < 3 ? units.force : units.moment);
    default: return amount(units.force);
  }
}

void print_derivatives(const Problem& problem, const Sensitivity& found, const DisplayUnits& units, std::size_t rows) {
  if (found.derivatives.empty()) return;
  const DisplayUnit& unit = units.of(is_length(found.tightest->budget.id));
  fmt::print(
      "What is left of the tightest margin changes by (first derivatives, in floating point; largest first{}):\n",
      found.derivatives.size() > rows
          ? fmt::format("; {} of {}, the rest with --rows or --json", rows, found.derivatives.size())
          : "");
  for (std::size_t i = 0; i < std::min(rows, found.derivatives.size()); ++i) {
    const Derivative& d = found.derivatives[i];
    const double step = natural_step(problem, d.parameter);
    fmt::print("  {:<36} {:>+11.4g} {} per {}\n", words(d.parameter), unit.approx(d.value * step), unit.name(),
               step_text(d.parameter, step, units));
  }
}

std::string change_words(const Change& change) {
  using Kind = Change::Kind;
  switch (change.kind) {
    case Kind::kTensionLower: return "lower tension limit, all cables";
    case Kind::kTensionUpper: return "upper tension limit, all cables";
    case Kind::kLengthLower: return "lower length limit, all cables";
    case Kind::kLengthUpper: return "upper length limit, all cables";
    case Kind::kWrench: return "weight of the load (w0 as a whole)";
    case Kind::kMass: return fmt::format("mass of {}", quoted_name(change.item));
    case Kind::kBaseAnchor: return fmt::format("base anchor {}, {}", change.index + 1, kAxes.at(change.axis));
    case Kind::kPlatformAnchor: break;
  }
  return fmt::format("platform anchor {}, {}", change.index + 1, kAxes.at(change.axis));
}

/// A value of a change as people write it.
std::string value_text(Change::Kind kind, const DecimalText& value, const DisplayUnits& units) {
  if (unit(kind) == "1") return percent_text(value);
  const DisplayUnit& of_value = units.of(unit(kind) == "m");
  return fmt::format("{} {}", of_value.exact(value), of_value.name());
}

void print_changes(const Sensitivity& found, const DisplayUnits& units) {
  if (found.changes.empty()) return;
  fmt::print("Smallest changes of one number, all else as it is:\n");
  for (const ProvedChange& change : found.changes) {
    const Change::Kind kind = change.change.kind;
    const std::string result =
        change.value
            ? fmt::format("{} to {}: proved with this change{}", value_text(kind, change.before, units),
                          value_text(kind, *change.value, units), change.is_complete ? "" : " (a smaller may do)")
        : change.is_complete ? "no change was found that proves the path"
                             : "none was found before the time was over";
    fmt::print("  {:<36} {}\n", change_words(change.change), result);
  }
}

void print(const Problem& problem, const CaseSensitivity& found, const CaseUnits& case_units, std::size_t rows) {
  const DisplayUnits units(case_units);
  fmt::print("{}: {}{}.\n",
             found.headroom.subject == Headroom::Subject::kPath
                 ? "The path"
                 : "No path was found, so this is about the straight way through the query's waypoints",
             verdict_name(found.verdict), found.verdict == Verdict::kProved ? "" : " by the prover");
  print_headroom(found.headroom, problem, case_units);
  print_derivatives(problem, found.sensitivity, units, rows);
  print_changes(found.sensitivity, units);
}

}  // namespace

void add_sensitivity_options(CLI::App& command, SensitivityArguments& arguments) {
  command.add_option("CASE", arguments.case_path, "case file (docs/case-format.md)")->required();
  command.add_option("--audit", arguments.audit, "path file to be examined instead of a plan");
  std::vector<std::string> names;
  for (const auto& [law, ignored] : audit_laws()) names.push_back(law);
  command.add_option("--interpolation", arguments.law, "what happens between its waypoints")
      ->check(CLI::IsMember(names));
  command.add_option("--budget", arguments.seconds, "seconds for shares and changes, after the plan (default: 60)")
      ->check(positive_number("a number of seconds above 0"));
  command.add_option("--rows", arguments.rows, "derivatives that are printed (default: 12)");
  command.add_flag("--json", arguments.json, "print the result as JSON");
}

int run_sensitivity(const SensitivityArguments& arguments) {
  const Stopwatch stopwatch;
  const Case the_case = at_rest(load_case(arguments.case_path));
  const bool is_audit = !arguments.audit.empty() || the_case.audit;
  if (!is_audit) {
    (void)load_case(arguments.case_path, require_plannable);
  }
  if (arguments.audit.empty() && the_case.audit && the_case.audit->timed) {
    throw InputError(
        ErrorCode::kUse,
        fmt::format("{}: audit.timed: got true, expected a path at rest: changes are sought for paths that "
                    "are passed slowly, without the inertia of a move. Name its path with --audit to have "
                    "it examined at rest",
                    arguments.case_path));
  }
  const Interruption interruption;
  CaseSensitivity found;
  Problem problem = the_case.problem;
  {
    ProgressLine line(!arguments.json);
    const SensitivityProgress progress = [&](const char* stage, std::size_t done, std::size_t all) {
      line.show([&] {
        return all == 0 ? fmt::format("{}: {} charts", stage, done) : fmt::format("{}: {} of {}", stage, done, all);
      });
    };
    if (is_audit) {
      std::optional<Interpolation> law;
      if (!arguments.law.empty()) law = audit_laws().at(arguments.law);
      const AuditRequest request = resolved({arguments.audit, law}, the_case, arguments.case_path);
      PathSource source(the_case.problem, request.path, request.law);
      problem = source.problem();
      found = audit_sensitivity(the_case, source, arguments.seconds, progress, interruption.token());
    } else {
      found = plan_sensitivity(the_case, arguments.seconds, progress, interruption.token());
    }
  }
  if (interruption.token().stop_requested()) return report_interruption("sensitivity", "interrupted", arguments.json);
  if (arguments.json) {
    nlohmann::json document = to_json(problem, found);
    document["command"] = "sensitivity";
    add_ending(document, stopwatch, kProvedExit, {});
    print_json(document);
  } else {
    print(problem, found, the_case.units, arguments.rows);
  }
  return kProvedExit;
}

}  // namespace taut
