// SPDX-License-Identifier: GPL-3.0-or-later
#include "cli/sensitivity_command.h"

#include <fmt/format.h>

#include <algorithm>
#include <nlohmann/json.hpp>
#include <optional>
#include <vector>

#include "app/plan.h"
#include "app/sensitivity.h"
#include "base/sanitize.h"
#include "cli/console.h"
#include "cli/headroom_output.h"
#include "cli/number_option.h"
#include "cli/output.h"
#include "problem/decimal.h"
#include "reports/summary/headroom_summary.h"

namespace taut {
namespace {

using nlohmann::json;
using Parameter = DesignParameter;

constexpr std::array<const char*, 6> kAxes = {"x", "y", "z", "x", "y", "z"};
constexpr double kPercent = 0.01;

const char* name(Parameter::Kind kind) {
  switch (kind) {
    case Parameter::Kind::kBaseAnchor: return "base_anchor";
    case Parameter::Kind::kPlatformAnchor: return "platform_anchor";
    case Parameter::Kind::kLoadPoint: return "load_point";
    case Parameter::Kind::kWrench: return "wrench";
    case Parameter::Kind::kWeight: return "weight";
    case Parameter::Kind::kMass: return "mass";
    case Parameter::Kind::kTensionLower: return "tension_lower";
    case Parameter::Kind::kTensionUpper: return "tension_upper";
    case Parameter::Kind::kLengthLower: return "length_lower";
    case Parameter::Kind::kLengthUpper: return "length_upper";
    case Parameter::Kind::kTolerance: break;
  }
  return "tolerance";
}

const char* name(Change::Kind kind) {
  switch (kind) {
    case Change::Kind::kTensionLower: return "tension_lower";
    case Change::Kind::kTensionUpper: return "tension_upper";
    case Change::Kind::kLengthLower: return "length_lower";
    case Change::Kind::kLengthUpper: return "length_upper";
    case Change::Kind::kWrench: return "weight";
    case Change::Kind::kMass: return "mass";
    case Change::Kind::kBaseAnchor: return "base_anchor";
    case Change::Kind::kPlatformAnchor: break;
  }
  return "platform_anchor";
}

/// The unit of a parameter in SI.
const char* unit(const Parameter& p) {
  switch (p.kind) {
    case Parameter::Kind::kWrench: return p.axis < 3 ? "N" : "N m";
    case Parameter::Kind::kTensionLower:
    case Parameter::Kind::kTensionUpper: return "N";
    case Parameter::Kind::kWeight:
    case Parameter::Kind::kTolerance: return "1";
    case Parameter::Kind::kMass: return "kg";
    default: return "m";
  }
}

bool has_cable(Parameter::Kind kind) {
  return kind != Parameter::Kind::kLoadPoint && kind != Parameter::Kind::kWrench && kind != Parameter::Kind::kWeight &&
         kind != Parameter::Kind::kMass && kind != Parameter::Kind::kTolerance;
}

bool has_axis(Parameter::Kind kind) {
  return kind == Parameter::Kind::kBaseAnchor || kind == Parameter::Kind::kPlatformAnchor ||
         kind == Parameter::Kind::kLoadPoint || kind == Parameter::Kind::kWrench;
}

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
    case Kind::kMass: return fmt::format("mass of '{}'", sanitize(p.uncertainty.item));
    case Kind::kTensionLower: return fmt::format("lower tension limit of cable {}", cable);
    case Kind::kTensionUpper: return fmt::format("upper tension limit of cable {}", cable);
    case Kind::kLengthLower: return fmt::format("lower length limit of cable {}", cable);
    case Kind::kLengthUpper: return fmt::format("upper length limit of cable {}", cable);
    case Kind::kTolerance: break;
  }
  switch (p.uncertainty.kind) {
    case UncertaintyKind::kWrenchSet: return "deviations of the load";
    case UncertaintyKind::kLoadItem: return fmt::format("deviations of '{}'", sanitize(p.uncertainty.item));
    default: return fmt::format("tolerance {}", taut::name(p.uncertainty.kind));
  }
}

bool is_length(MarginId id) { return id.kind == MarginKind::kLengthMin || id.kind == MarginKind::kLengthMax; }

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
  fmt::print("What is left of that margin changes by (first derivatives, in floating point; largest first{}):\n",
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
    case Kind::kMass: return fmt::format("mass of '{}'", sanitize(change.item));
    case Kind::kBaseAnchor: return fmt::format("base anchor {}, {}", change.index + 1, kAxes.at(change.axis));
    case Kind::kPlatformAnchor: break;
  }
  return fmt::format("platform anchor {}, {}", change.index + 1, kAxes.at(change.axis));
}

bool is_factor(Change::Kind kind) { return kind == Change::Kind::kWrench || kind == Change::Kind::kMass; }

bool is_of_length(Change::Kind kind) {
  return kind != Change::Kind::kTensionLower && kind != Change::Kind::kTensionUpper && !is_factor(kind);
}

const char* unit(Change::Kind kind) { return is_factor(kind) ? "1" : is_of_length(kind) ? "m" : "N"; }

/// A value of a change as people write it.
std::string value_text(Change::Kind kind, const DecimalText& value, const DisplayUnits& units) {
  if (is_factor(kind)) return percent_text(value);
  const DisplayUnit& unit = units.of(is_of_length(kind));
  return fmt::format("{} {}", unit.exact(value), unit.name());
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

json derivative_json(const Problem& problem, const Derivative& d, bool length) {
  const Parameter& p = d.parameter;
  const double step = natural_step(problem, p);
  return {{"parameter", p.kind == Parameter::Kind::kTolerance ? taut::name(p.uncertainty.kind) : name(p.kind)},
          {"item", p.uncertainty.kind == UncertaintyKind::kLoadItem ? json(p.uncertainty.item) : json()},
          {"cable", has_cable(p.kind) ? json(p.index + 1) : json()},
          {"axis", has_axis(p.kind) ? json(kAxes.at(p.axis)) : json()},
          {"of_moment", p.kind == Parameter::Kind::kWrench && p.axis >= 3},
          {"derivative", d.value},
          {"unit", fmt::format("{}/{}", length ? "m" : "N", unit(p))},
          {"step", step},
          {"gain", d.value * step}};
}

json change_json(const ProvedChange& change) {
  const Change::Kind kind = change.change.kind;
  const bool is_anchor = kind == Change::Kind::kBaseAnchor || kind == Change::Kind::kPlatformAnchor;
  return {{"change", name(kind)},
          {"item", kind == Change::Kind::kMass ? json(change.change.item) : json()},
          {"cable", is_anchor ? json(change.change.index + 1) : json()},
          {"axis", is_anchor ? json(kAxes.at(change.change.axis)) : json()},
          {"before", change.before},
          {"value", change.value ? json(*change.value) : json()},
          {"unit", unit(kind)},
          {"complete", change.is_complete}};
}

const char* verdict_text(Verdict verdict) {
  return verdict == Verdict::kProved ? "proved" : verdict == Verdict::kRefuted ? "refuted" : "undecided";
}

json to_json(const Problem& problem, const CaseSensitivity& found) {
  json derivatives = json::array();
  json changes = json::array();
  const Sensitivity& s = found.sensitivity;
  const bool length = s.tightest && !s.tightest->singular && is_length(s.tightest->budget.id);
  for (const Derivative& d : s.derivatives) derivatives.push_back(derivative_json(problem, d, length));
  for (const ProvedChange& change : s.changes) changes.push_back(change_json(change));
  return {{"command", "sensitivity"},   {"verdict", verdict_text(found.verdict)},
          {"segments", found.segments}, {"headroom", taut::to_json(found.headroom)},
          {"derivatives", derivatives}, {"changes", changes}};
}

void print(const Problem& problem, const CaseSensitivity& found, const CaseUnits& case_units, std::size_t rows) {
  const DisplayUnits units(case_units);
  fmt::print("{}: {}{}.\n",
             found.headroom.subject == Headroom::Subject::kPath
                 ? "The path"
                 : "No path was found, so this is about the straight way through the query's waypoints",
             verdict_text(found.verdict), found.verdict == Verdict::kProved ? "" : " by the prover");
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
  const Case the_case = load_case(arguments.case_path);
  const bool is_audit = !arguments.audit.empty() || the_case.audit;
  if (!is_audit) {
    (void)load_case(arguments.case_path, require_plannable);
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
    json document = to_json(problem, found);
    add_ending(document, stopwatch, kProvedExit, {});
    print_json(document);
  } else {
    print(problem, found, the_case.units, arguments.rows);
  }
  return kProvedExit;
}

}  // namespace taut
