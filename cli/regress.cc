// SPDX-License-Identifier: GPL-3.0-or-later
#include "cli/regress.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>
#include <pugixml.hpp>
#include <set>
#include <sstream>
#include <system_error>

#include "base/files.h"
#include "base/input_error.h"
#include "base/json_cursor.h"
#include "base/sanitize.h"
#include "case/case_of_legs.h"
#include "cli/console.h"
#include "cli/subprocess.h"
#include "problem/scalar.h"

namespace taut {
namespace {

namespace fs = std::filesystem;
using nlohmann::json;

constexpr const char* kBaselineFormat = "taut-baseline";
constexpr int kBaselineVersion = 1;

const char* name(Expectation expectation) {
  switch (expectation) {
    case Expectation::kProved: return "proved";
    case Expectation::kRefuted: return "refuted";
    case Expectation::kUndecided: return "undecided";
    case Expectation::kNoPath: return "no path";
    case Expectation::kNone: break;
  }
  return "";
}

// --- One case --------------------------------------------------------------------------------------------------------

/// Margins are decimals as text, counts and lengths are numbers.
std::optional<double> number(const json& value) {
  if (value.is_number()) return value.get<double>();
  if (!value.is_string()) return std::nullopt;
  return ScalarTraits<double>::from_decimal(value.get<std::string>());
}

/// Reads what `taut plan --json` and `taut audit --json` print.
Measurement measurement(const json& summary) {
  Measurement result{summary.at("verdict"), {}};
  const auto take = [&](const char* quantity, const json& object, const char* key) {
    if (!object.is_object() || !object.contains(key)) return;
    if (const auto value = number(object.at(key))) result.quantities[quantity] = *value;
  };
  const json margins = summary.value("margins", json());
  take("tension_margin", margins, "tension_N");
  take("length_margin", margins, "length_m");
  take("wrench_scale", margins, "wrench_scale");
  take("clearance_margin", margins, "clearance_m");
  take("segments", summary, "segments");
  take("boxes", summary, "boxes");
  if (const json& found = summary.value("stretches_violated", json()); found.is_number()) {
    result.quantities["stretches"] =
        summary.at("stretches_violated").get<double>() + summary.at("stretches_open").get<double>();
  } else if (result.verdict == "proved") {
    take("length", summary, "length_m");
    take("angle", summary, "angle_rad");
    take("cost", summary, "cost");
    take("charts", summary, "charts");
    take("duration", summary.value("move", json()), "duration_s");
    take("duration", summary, "duration_s");  // of legs
  }
  return result;
}

std::string shown_number(double x) { return fmt::format("{:.6g}", x); }

std::string shown_bound(const Bound& bound) {
  if (std::isinf(bound.upper)) return "at least " + shown_number(bound.lower);
  if (std::isinf(bound.lower)) return "at most " + shown_number(bound.upper);
  return fmt::format("{} to {}", shown_number(bound.lower), shown_number(bound.upper));
}

std::vector<std::string> differences(const Case& declared, const Measurement& measured) {
  std::vector<std::string> result;
  if (measured.verdict != name(declared.expect)) {
    result.push_back(fmt::format("{}, expected {}", measured.verdict, name(declared.expect)));
  }
  for (const Bound& bound : declared.bounds) {
    const auto found = measured.quantities.find(bound.quantity);
    if (found == measured.quantities.end()) {
      result.push_back(fmt::format("{} was not measured", bound.quantity));
      continue;
    }
    if (bound.lower <= found->second && found->second <= bound.upper) continue;
    result.push_back(
        fmt::format("{} is {}, expected {}", bound.quantity, shown_number(found->second), shown_bound(bound)));
  }
  return result;
}

/// The last line that a failed program wrote.
std::string last_lines(const std::string& text) {
  constexpr std::size_t kMost = 2000;
  std::string tail = text.size() > kMost ? text.substr(text.size() - kMost) : text;
  while (!tail.empty() && tail.back() == '\n') tail.pop_back();
  return tail;
}

std::vector<std::string> command_for(const Case& declared, const fs::path& file, const RegressOptions& options,
                                     const fs::path& out) {
  std::vector<std::string> command = {own_program(), declared.audit ? "audit" : "plan", file.string(), "--max-seconds",
                                      fmt::format("{}", options.most_seconds)};
  if (!declared.audit && options.budget) {
    command.insert(command.end(), {"--budget", fmt::format("{}", *options.budget)});
  }
  if (options.out.empty()) command.emplace_back("--no-report");  // nobody would see it
  command.insert(command.end(), {"--json", "--out", out.string()});
  return command;
}

void recheck(const fs::path& file, const fs::path& out, const RegressOptions& options, const std::stop_token& stop,
             RegressedCase& result) {
  std::vector<std::string> command = {checker_program(), (out / "certificate.json").string(), file.string()};
  if (const fs::path path = out / "path.csv"; fs::exists(path)) {
    command.insert(command.end(), {"--path", path.string()});
  }
  const FinishedProgram checked = run_program(command, stop, options.most_seconds);
  const int expected = result.measurement->verdict == "undecided" ? kUndecidedExit : kProvedExit;
  if (checked.exit_code == expected) return;
  if (checked.timed_out || checked.exit_code > kUndecidedExit) {
    result.error = checked.timed_out ? fmt::format("taut-check took longer than {} s", options.most_seconds)
                                     : fmt::format("taut-check ended with {}: {}", checked.exit_code,
                                                   last_lines(checked.out + checked.err));
    return;
  }
  result.differences.push_back(fmt::format("taut-check ended with {}, expected {}: {}", checked.exit_code, expected,
                                           last_lines(checked.out + checked.err)));
}

void run(const fs::path& file, const fs::path& out, const RegressOptions& options, const std::stop_token& stop,
         RegressedCase& result) {
  Case declared;
  try {
    declared = load_case_of_legs(file.string()).whole;
    if (declared.expect == Expectation::kNone) {
      throw InputError(file.string() + ": got no 'expect', expected the verdict that the case should get");
    }
  } catch (const InputError& error) {
    result.error = error.what();
    result.is_bad_input = true;
    return;
  }
  result.expected = name(declared.expect);
  result.has_budget = !declared.audit && (options.budget.has_value() || declared.planner.has_budget);
  const FinishedProgram ran = run_program(command_for(declared, file, options, out), stop, options.most_seconds);
  result.seconds = ran.seconds;
  if (ran.timed_out) {
    result.error = fmt::format("took longer than {} s", options.most_seconds);
    return;
  }
  if (ran.exit_code > kUndecidedExit) {
    result.error = fmt::format("ended with {}: {}", ran.exit_code, last_lines(ran.err));
    result.is_bad_input = ran.exit_code == kBadInputExit;
    return;
  }
  result.measurement = measurement(json::parse(ran.out));
  result.differences = differences(declared, *result.measurement);
  if (options.check) recheck(file, out, options, stop, result);
}

// --- JUnit -----------------------------------------------------------------------------------------------------------

void add_property(pugi::xml_node& properties, const std::string& name, const std::string& value) {
  pugi::xml_node property = properties.append_child("property");
  property.append_attribute("name") = name.c_str();
  property.append_attribute("value") = value.c_str();
}

void add_trouble(pugi::xml_node& testcase, const char* kind, const std::string& type, const std::string& message) {
  pugi::xml_node trouble = testcase.append_child(kind);
  trouble.append_attribute("type") = type.c_str();
  trouble.append_attribute("message") = sanitize_lines(message).c_str();
}

bool is_margin(const std::string& quantity) { return quantity.ends_with("_margin") || quantity == "wrench_scale"; }

}  // namespace

namespace {

/// Appends the cases of a folder and of those below it, links to folders too. No folder is looked through twice.
void collect_cases(const fs::path& folder, std::set<fs::path>& seen, std::vector<fs::path>& cases) {
  if (!seen.insert(fs::canonical(folder)).second) return;
  std::vector<fs::directory_entry> entries(fs::directory_iterator(folder), {});
  std::ranges::sort(entries);
  for (const fs::directory_entry& entry : entries) {
    if (entry.path().filename().string().starts_with(".")) continue;
    if (entry.is_directory()) {
      collect_cases(entry.path(), seen, cases);
    } else if (const fs::path extension = entry.path().extension();
               (extension == ".yaml" || extension == ".yml") && (entry.is_regular_file() || !entry.exists())) {
      cases.push_back(entry.path());  // a link to nothing is bad input, not nothing
    }
  }
}

}  // namespace

std::vector<fs::path> find_cases(const fs::path& folder) {
  std::error_code error;
  const fs::file_status status = fs::status(folder, error);
  if (!fs::status_known(status)) throw InputError(folder.string() + ": could not read: " + error.message());
  if (!fs::exists(status)) throw InputError(folder.string() + ": got nothing, expected a folder of cases");
  if (!fs::is_directory(status)) return {folder};
  std::vector<fs::path> result;
  std::set<fs::path> seen;
  try {
    collect_cases(folder, seen, result);
  } catch (const fs::filesystem_error& failure) {
    throw InputError(fmt::format("{}: {}", failure.path1().string(), failure.code().message()));
  }
  if (result.empty()) throw InputError(folder.string() + ": got no *.yaml, expected a folder of cases");
  std::ranges::sort(result);
  return result;
}

CaseResults::CaseResults(const fs::path& wanted) : is_kept_(!wanted.empty()) {
  if (is_kept_) {
    make_directories(wanted);
    path_ = wanted;
    return;
  }
  path_ = make_temporary_folder("taut-regress");
}

CaseResults::~CaseResults() {
  std::error_code ignored;
  if (!is_kept_) fs::remove_all(path_, ignored);
}

std::string case_name(const fs::path& folder, const fs::path& file) {
  const fs::path seen = file.lexically_relative(folder);
  return (seen.empty() || seen == "." ? file.filename() : seen).string();
}

RegressedCase regress_case(const std::string& name, const fs::path& file, const RegressOptions& options,
                           const fs::path& results, const std::stop_token& stop) {
  RegressedCase result;
  result.name = name;
  try {
    run(file, results / fs::path(name).replace_extension(), options, stop, result);
  } catch (const std::exception& error) {
    result.error = error.what();
  }
  return result;
}

std::vector<std::string> compare(const Baseline& baseline, std::vector<RegressedCase>& cases) {
  std::set<std::string> gone;
  for (const auto& [name, ignored] : baseline.cases) gone.insert(name);
  for (RegressedCase& regressed : cases) {
    const std::string name = sanitize(regressed.name);
    gone.erase(name);
    const auto before = baseline.cases.find(name);
    if (before == baseline.cases.end() || !regressed.measurement) continue;
    if (before->second.verdict != regressed.measurement->verdict) {
      regressed.differences.push_back(
          fmt::format("{}, in the baseline {}", regressed.measurement->verdict, before->second.verdict));
      continue;
    }
    if (regressed.has_budget) continue;
    for (const auto& [quantity, then] : before->second.quantities) {
      const auto now = regressed.measurement->quantities.find(quantity);
      const double slack = baseline.tolerance * std::abs(then);
      if (now == regressed.measurement->quantities.end()) {
        regressed.differences.push_back(
            fmt::format("{} was not measured, in the baseline {}", quantity, shown_number(then)));
      } else if (is_margin(quantity) ? now->second < then - slack : now->second > then + slack) {
        regressed.differences.push_back(
            fmt::format("{} is {}, in the baseline {}", quantity, shown_number(now->second), shown_number(then)));
      }
    }
  }
  return {gone.begin(), gone.end()};
}

bool is_baseline(const std::string& text) {
  const json file = json::parse(text, nullptr, false);
  return file.is_object() && file.value("format", json()) == kBaselineFormat;
}

Baseline read_baseline(const fs::path& path) {
  const auto fail = [&](const std::string& what) {
    return InputError(fmt::format("{}: {}, expected a baseline that taut regress --update wrote", path.string(), what),
                      {path.string()});
  };
  const json file = json::parse(read_whole(path), nullptr, false);
  if (!file.is_object() || file.value("format", json()) != kBaselineFormat) throw fail("got another file");
  if (file.value("version", json()) != kBaselineVersion) throw fail("got another version");
  return with_error_code(ErrorCode::kRegress, path.string(), [&] {
    Baseline result;
    const JsonCursor cases = JsonCursor(file, "baseline").at("cases");
    if (!cases.value().is_object()) cases.fail("an object");
    for (const auto& [name, member] : cases.value().items()) {
      const JsonCursor entry(member, "cases." + name);
      Measurement measured{entry.at("verdict").text(), {}};
      for (const char* quantity : kBoundQuantities) {
        if (!entry.contains(quantity)) continue;
        const JsonCursor number = entry.at(quantity);
        if (!number.value().is_number()) number.fail("a number");
        measured.quantities[quantity] = number.value().get<double>();
      }
      result.cases.emplace(name, std::move(measured));
    }
    return result;
  });
}

std::string baseline_text(const std::vector<RegressedCase>& cases) {
  json entries = json::object();
  for (const RegressedCase& regressed : cases) {
    if (!regressed.measurement) continue;
    json& entry = entries[sanitize(regressed.name)];
    entry["verdict"] = regressed.measurement->verdict;
    for (const auto& [quantity, value] : regressed.measurement->quantities) entry[quantity] = value;
  }
  return json{{"format", kBaselineFormat}, {"version", kBaselineVersion}, {"cases", entries}}.dump(1, ' ', true) + "\n";
}

std::string junit_text(const std::string& suite_name, const std::vector<RegressedCase>& cases,
                       const std::vector<std::string>& gone) {
  pugi::xml_document document;
  pugi::xml_node suite = document.append_child("testsuites").append_child("testsuite");
  double seconds = 0;
  std::size_t failures = gone.size();
  std::size_t errors = 0;
  for (const RegressedCase& regressed : cases) {
    seconds += regressed.seconds;
    errors += regressed.error.empty() ? 0 : 1;
    failures += regressed.error.empty() && !regressed.differences.empty() ? 1 : 0;
  }
  suite.append_attribute("name") = sanitize_lines(suite_name).c_str();
  suite.append_attribute("tests") = cases.size() + gone.size();
  suite.append_attribute("failures") = failures;
  suite.append_attribute("errors") = errors;
  suite.append_attribute("skipped") = 0;
  suite.append_attribute("time") = fmt::format("{:.3f}", seconds).c_str();
  const auto add = [&](const std::string& case_name, double time) {
    pugi::xml_node testcase = suite.append_child("testcase");
    testcase.append_attribute("classname") = "taut.regress";
    testcase.append_attribute("name") = sanitize_lines(case_name).c_str();
    testcase.append_attribute("time") = fmt::format("{:.3f}", time).c_str();
    return testcase;
  };
  for (const RegressedCase& regressed : cases) {
    pugi::xml_node testcase = add(regressed.name, regressed.seconds);
    if (regressed.measurement) {
      pugi::xml_node properties = testcase.append_child("properties");
      add_property(properties, "verdict", regressed.measurement->verdict);
      for (const auto& [quantity, value] : regressed.measurement->quantities) {
        add_property(properties, quantity, fmt::format("{}", value));
      }
    }
    if (!regressed.error.empty())
      add_trouble(testcase, "error", regressed.is_bad_input ? "bad input" : "no result", regressed.error);
    for (const std::string& difference : regressed.differences) add_trouble(testcase, "failure", "differs", difference);
  }
  for (const std::string& name : gone) {
    pugi::xml_node testcase = add(name, 0);
    add_trouble(testcase, "failure", "gone", "is in the baseline, and is no more");
  }
  std::ostringstream text;
  document.save(text, " ", pugi::format_default, pugi::encoding_utf8);
  return text.str();
}

namespace {

/// The unit of a quantity of kBoundQuantities, as keys of JSON end in it.
std::string unit_suffix(const std::string& quantity) {
  if (quantity == "tension_margin") return "_N";
  if (quantity == "length_margin" || quantity == "clearance_margin" || quantity == "length") return "_m";
  if (quantity == "duration") return "_s";
  return quantity == "angle" ? "_rad" : "";
}

}  // namespace

json to_json(const RegressedCase& regressed) {
  json result = {{"case", regressed.name},
                 {"as_declared", regressed.is_as_declared()},
                 {"expected", regressed.expected},
                 {"differences", regressed.differences},
                 {"error", regressed.error.empty() ? json() : json(regressed.error)},
                 {"elapsed_seconds", regressed.seconds},
                 {"measured", json::object()},
                 {"verdict", nullptr}};
  if (!regressed.measurement) return result;
  result["verdict"] = regressed.measurement->verdict;
  for (const auto& [quantity, value] : regressed.measurement->quantities) {
    result["measured"][quantity + unit_suffix(quantity)] = value;
  }
  return result;
}

}  // namespace taut
