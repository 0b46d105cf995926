// SPDX-License-Identifier: GPL-3.0-or-later
#include "cli/regress_command.h"

#include <fmt/format.h>

#include <algorithm>
#include <filesystem>
#include <nlohmann/json.hpp>

#include "base/files.h"
#include "base/input_error.h"
#include "base/sanitize.h"
#include "cli/console.h"
#include "cli/number_option.h"
#include "cli/output.h"
#include "cli/regress_parts.h"

namespace taut {
namespace {

std::string cell(const RegressedCase& regressed, const char* quantity, const char* format) {
  if (!regressed.measurement) return "";
  const auto found = regressed.measurement->quantities.find(quantity);
  return found == regressed.measurement->quantities.end() ? "" : fmt::format(fmt::runtime(format), found->second);
}

void print_table(const std::vector<RegressedCase>& cases) {
  std::size_t width = 4;
  for (const RegressedCase& regressed : cases) width = std::max(width, regressed.name.size());
  fmt::print("{:<{}}  {:<9}  {:>8} {:>8} {:>11} {:>11} {:>9} {:>8}\n", "case", width, "verdict", "segments", "boxes",
             "tension [N]", "length [m]", "scale", "time [s]");
  for (const RegressedCase& regressed : cases) {
    fmt::print("{:<{}}  {:<9}  {:>8} {:>8} {:>11} {:>11} {:>9} {:>8.2f}{}\n", sanitize(regressed.name), width,
               regressed.measurement ? regressed.measurement->verdict : "-", cell(regressed, "segments", "{:.0f}"),
               cell(regressed, "boxes", "{:.0f}"), cell(regressed, "tension_margin", "{:.4g}"),
               cell(regressed, "length_margin", "{:.4g}"), cell(regressed, "wrench_scale", "{:.4g}"), regressed.seconds,
               regressed.is_as_declared() ? "" : "  <- differs");
    if (!regressed.error.empty()) fmt::print("    {}\n", sanitize(regressed.error));
    for (const std::string& difference : regressed.differences) fmt::print("    {}\n", sanitize(difference));
  }
}

int exit_code(const std::vector<RegressedCase>& cases, const std::vector<std::string>& gone) {
  const auto any = [&](auto what) { return std::ranges::any_of(cases, what); };
  if (any([](const RegressedCase& c) { return !c.error.empty() && !c.is_bad_input; })) return kInternalExit;
  if (any([](const RegressedCase& c) { return c.is_bad_input; })) return kBadInputExit;
  const bool differs = !gone.empty() || any([](const RegressedCase& c) { return !c.is_as_declared(); });
  return differs ? kRefutedExit : kProvedExit;
}

bool is_junit(const std::string& text) {
  return text.starts_with("<?xml") && text.find("<testsuites>") != std::string::npos;
}

/// Checks that `file` is absent, empty or an earlier output of this kind: a case is never overwritten.
void require_replaceable(const char* option, const std::string& file, bool (*is_of_its_kind)(const std::string&)) {
  require_writable(file);
  const std::filesystem::path extension = std::filesystem::path(file).extension();
  std::error_code ignored;
  const bool is_there = std::filesystem::is_regular_file(file, ignored);
  const std::string text = is_there ? read_whole(file) : "";
  if (extension != ".yaml" && extension != ".yml" && (text.empty() || is_of_its_kind(text))) return;
  throw InputError(ErrorCode::kUse,
                   fmt::format("{}: got '{}', which is another file or named as a case, expected a new file or "
                               "an earlier one of taut regress {}",
                               option, excerpt(file), option));
}

/// That the files which are to be written may be.
void require_outputs(const RegressArguments& arguments) {
  if (!arguments.junit.empty()) require_replaceable("--junit", arguments.junit, is_junit);
  if (arguments.update) require_replaceable("--baseline", arguments.baseline, is_baseline);
  if (!arguments.junit.empty() && !arguments.baseline.empty()) require_another(arguments.junit, arguments.baseline);
}

/// What a run says at its end.
struct RegressResult {
  std::vector<RegressedCase> cases;
  std::vector<std::string> gone;  ///< cases of the baseline that are no more
  bool has_baseline = false;
  std::vector<FileContent> written;

  [[nodiscard]] auto as_declared() const {
    return std::ranges::count_if(cases, [](const RegressedCase& c) { return c.is_as_declared(); });
  }
  [[nodiscard]] int code() const { return exit_code(cases, gone); }
};

void print_as_json(const RegressResult& result, const Stopwatch& stopwatch) {
  nlohmann::json list = nlohmann::json::array();
  for (const RegressedCase& regressed : result.cases) list.push_back(to_json(regressed));
  nlohmann::json document = {
      {"command", "regress"}, {"cases", list}, {"gone", result.gone}, {"as_declared", result.as_declared()}};
  std::vector<std::filesystem::path> paths;
  for (const FileContent& file : result.written) paths.push_back(file.path);
  add_ending(document, stopwatch, result.code(), paths);
  print_json(document);
}

void print(const RegressResult& result, const Stopwatch& stopwatch) {
  print_table(result.cases);
  const auto on_budget = std::ranges::count_if(result.cases, &RegressedCase::has_budget);
  if (result.has_baseline && on_budget > 0) {
    fmt::print("{} on a budget: only the verdict is compared with the baseline.\n",
               on_budget == 1 ? "1 of them plans" : fmt::format("{} of them plan", on_budget));
  }
  for (const std::string& name : result.gone) {
    fmt::print("{}: is in the baseline, and is no more\n", sanitize(name));
  }
  fmt::print("{} of {} cases as declared, in {:.1f} s.\n", result.as_declared(), result.cases.size(),
             stopwatch.seconds());
  for (const FileContent& file : result.written) fmt::print("Written: {}\n", sanitize(file.path.string()));
}

RegressOptions options_of(const RegressArguments& arguments) {
  RegressOptions options = arguments.options;
  options.out = arguments.out;
  if (arguments.budget > 0) options.budget = arguments.budget;
  return options;
}

/// A shard is held to nothing but what its cases declare.
void require_whole(const RegressArguments& arguments) {
  if (arguments.parts.shard.empty() || (arguments.junit.empty() && arguments.baseline.empty())) return;
  throw InputError(ErrorCode::kUse, fmt::format("{}: got a file for a shard, expected it with --merge, which knows all "
                                                "cases",
                                                arguments.junit.empty() ? "--baseline" : "--junit"));
}

std::vector<RegressedCase> cases_of(const RegressArguments& arguments, RegressParts& parts, const Shard& shard,
                                    std::size_t most, Ranks* ranks, const std::stop_token& stop) {
  if (arguments.parts.merge) return parts.merge();
  ProgressLine line(!arguments.json);
  return parts.make(
      shard, ranks, [&](std::size_t count) { line.show([&] { return fmt::format("{} of {} cases", count, most); }); },
      stop);
}

/// What `taut regress` does, and rank 0 under mpirun.
int run_first(const RegressArguments& arguments, std::unique_ptr<Ranks>& ranks) {
  const Stopwatch stopwatch;
  const std::vector<std::filesystem::path> files = find_cases(arguments.folder);
  require_whole(arguments);
  require_outputs(arguments);
  std::optional<Baseline> baseline;
  if (!arguments.baseline.empty() && !arguments.update) {
    baseline = read_baseline(arguments.baseline);
    baseline->tolerance = arguments.tolerance;
  }
  const RegressOptions options = options_of(arguments);
  const Shard shard = shard_of(arguments.parts).value_or(Shard());
  std::size_t most = 0;
  for (std::size_t n = 0; n < files.size(); ++n) most += shard.has(n) ? 1 : 0;

  const Interruption interruption;
  RegressResult result;
  result.has_baseline = baseline.has_value();
  RegressParts parts(arguments.folder, files, options, arguments.parts.folder);
  result.cases = cases_of(arguments, parts, shard, most, ranks.get(), interruption.token());
  ranks.reset();  // the others go while this one finishes
  if (result.cases.size() < most) {
    return report_interruption(
        "regress", fmt::format("interrupted after {} of {} cases: nothing was written", result.cases.size(), most),
        arguments.json);
  }
  if (baseline) result.gone = compare(*baseline, result.cases);

  if (!arguments.junit.empty()) {
    result.written.push_back(
        {arguments.junit, junit_text("taut regress " + arguments.folder, result.cases, result.gone)});
  }
  if (arguments.update) result.written.push_back({arguments.baseline, baseline_text(result.cases)});
  write_whole(result.written);

  if (arguments.json) {
    print_as_json(result, stopwatch);
  } else {
    print(result, stopwatch);
  }
  return result.code();
}

/// What other ranks do: they run cases, and print nothing.
void serve(const RegressArguments& arguments, Ranks& ranks, const std::stop_token& stop) {
  const RegressOptions options = options_of(arguments);
  const RegressParts parts(arguments.folder, find_cases(arguments.folder), options, "");
  const CaseResults results(options.out);
  ranks.serve(
      parts.digest(), [&](const Task& task) { return parts.run(task.part, results.path(), stop); }, stop);
}

}  // namespace

void add_regress_options(CLI::App& command, RegressArguments& arguments) {
  command.add_option("DIR", arguments.folder, "folder of cases, each with 'expect' (docs/regress.md)")->required();
  command.add_option("--junit", arguments.junit, "write a JUnit XML file, too");
  CLI::Option* baseline =
      command.add_option("--baseline", arguments.baseline, "file of an earlier run's measurements to compare with");
  command.add_flag("--update", arguments.update, "write the baseline instead of comparing with it")->needs(baseline);
  command
      .add_option("--tolerance", arguments.tolerance, "relative change for the worse that is let pass (default: 0.05)")
      ->check(number("a number from 0 to 1", [](double x) { return x >= 0 && x <= 1; }));
  command.add_option("--jobs", arguments.options.jobs, "cases at a time (default: one a core)")
      ->check(CLI::Range(1, 1024));
  command.add_option("--timeout", arguments.options.most_seconds, "seconds for one case (default: 600)")
      ->check(positive_number());
  command.add_option("--budget", arguments.budget, "seconds of planning a case, before its own")
      ->check(positive_number());
  command.add_flag("--check", arguments.options.check, "have each certificate proved again by taut-check");
  command.add_option("--out", arguments.out, "keep the results here, a folder a case (default: thrown away)");
  add_parts_options(command, arguments.parts);
  command.add_flag("--json", arguments.json, "print the results as JSON");
}

int run_regress(const RegressArguments& arguments) {
  return run_in_ranks(
      arguments.parts, [&](std::unique_ptr<Ranks>& ranks) { return run_first(arguments, ranks); },
      [&](Ranks& ranks, const std::stop_token& stop) { serve(arguments, ranks, stop); });
}

}  // namespace taut
