// SPDX-License-Identifier: GPL-3.0-or-later
#include "cli/audit_command.h"

#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <list>
#include <nlohmann/json.hpp>
#include <sstream>

#include "app/audit.h"
#include "app/meshes.h"
#include "app/recheck.h"
#include "app/report.h"
#include "base/files.h"
#include "base/plural.h"
#include "base/sanitize.h"
#include "base/sha256.h"
#include "case/case_file.h"
#include "certify/undecided.h"
#include "cli/console.h"
#include "cli/headroom_output.h"
#include "cli/output.h"
#include "cli/report_command.h"
#include "cli/result_folder.h"
#include "cli/terminal.h"
#include "cli/timed_audit.h"
#include "cli/verdict_output.h"
#include "path_io/controller_csv.h"
#include "reports/page/html_report.h"
#include "reports/summary/bodies_statement.h"
#include "reports/summary/display_units.h"
#include "reports/summary/hints.h"
#include "reports/summary/load_statement.h"
#include "reports/summary/sentences.h"

namespace taut {
namespace {

constexpr std::size_t kShownStretches = 20;

// --- What is said --------------------------------------------------------------------------------------------------

std::string text(const PathPoint& point, const FilePlace& place, const char* place_name) {
  const std::string where = place.line_before == place.line_behind
                                ? fmt::format("{} {}", place_name, place.line_before)
                                : fmt::format("{}s {}-{}", place_name, place.line_before, place.line_behind);
  const std::string time = place.time_s ? fmt::format(", t = {:.6g} s", *place.time_s) : "";
  return fmt::format("segment {} at s = {:.6g} ({}{})", point.index, point.s.approx(), where, time);
}

/// The last point of a violation, which may reach from one point to another.
const PathPoint& end_of(const PathWitness& violation) { return violation.singular ? violation.to : violation.at; }

std::string text(const AuditedStretch& audited, const Case& the_case, const char* place_name) {
  const Problem& problem = the_case.problem;
  const DisplayUnits units(the_case.units);
  const Stretch& stretch = audited.stretch;
  std::string lines = fmt::format("  from {}\n    to {}\n", text(stretch.begin, audited.begin, place_name),
                                  text(stretch.end, audited.end, place_name));
  if (!stretch.violations) return lines + fmt::format("    open: {}", with_code(stretch.reason));
  const PathWitness& first = stretch.violations->first.violation;
  const PathWitness& last = stretch.violations->second.violation;
  lines += fmt::format("    violated from {}: {}\n", text(first.at, audited.first, place_name),
                       violation_text(first, problem, units));
  return lines + fmt::format("              to {}: {}", text(end_of(last), audited.last, place_name),
                             violation_text(last, problem, units));
}

/// The violation that the certificate's witness is about: the gravest, or where poses are implied the one to which the
/// move is followed.
std::string witness_text(const Audit& audit, const Case& the_case, const char* place_name) {
  const PathWitness& witness = audit.witness->violation;
  return fmt::format("{}: {}: {}.", audit.witness_is_gravest ? "Gravest" : "Proved of the move",
                     text(witness.at, audit.witness_place, place_name),
                     violation_text(witness, the_case.problem, DisplayUnits(the_case.units)));
}

/// Whether constraints or lengths of cables imply the poses.
bool is_implied(const PathSource& source) {
  return source.law() == Interpolation::kCableLengths || !source.problem().space.constraints.empty();
}

/// What follows the verdict.
std::string sentence(const Audit& audit, const PathSource& source) {
  switch (audit.verdict) {
    case Verdict::kProved:
      return fmt::format(
          "the path is wrench-feasible and clear of singularities, at its waypoints and everywhere between, {} in "
          "{}{}.",
          plural(audit.segments, "segment"), plural(audit.boxes, "box"), clear_bodies(source.problem().bodies, "; "));
    case Verdict::kRefuted:
      return fmt::format("{} of the path {} proved violations{}{}", plural(audit.stretches_violated, "stretch"),
                         audit.stretches_violated == 1 ? "has" : "have",
                         audit.stretches_open == 0
                             ? ""
                             : fmt::format(", and {} could not be decided", plural(audit.stretches_open, "other")),
                         is_implied(source) ? ". " + implied_scope(audit.boxes > 0)
                         : audit.boxes > 0  ? "; all the rest is proved."
                                            : "; no part of the path is proved.");
    case Verdict::kUndecided: break;
  }
  return fmt::format("{} of the path could not be decided; nothing is claimed of the path.",
                     plural(audit.stretches_open, "stretch"));
}

/// The verdict as the report has it. An audited path is never one that a planner did not find.
std::string verdict_in_full(const Audit& audit) {
  if (audit.verdict == Verdict::kProved) return "PROVED";
  return audit.verdict == Verdict::kRefuted ? "REFUTED - DO NOT RUN" : "UNDECIDED - NO DECISION";
}

/// What may be wrong with the case, if the path is infeasible from its beginning and suggests it; else empty.
std::string hint(const Audit& audit, const PathSource& source) {
  if (audit.verdict != Verdict::kRefuted || audit.stretches.empty()) return "";
  const PathPoint& begin = audit.stretches.front().stretch.begin;
  if (begin.index != 0 || begin.s != Dyadic{0, 0}) return "";
  return reversed_load_hint(source.problem(), source.first_segment());
}

void print_stretches(const Audit& audit, const Case& the_case, const PathSource& source,
                     const checker::CheckResult& checked) {
  if (audit.verdict == Verdict::kProved) {
    print_wrapped(source.problem().tolerances
                      ? "This holds for every deviation within the case's tolerances."
                      : "The case states no tolerances: this is about a machine that is exactly as it says.");
  }
  if (audit.witness && (audit.witness_is_gravest || is_implied(source))) {
    print_wrapped(witness_text(audit, the_case, source.place_name()));
  }
  if (const std::string load = load_that_breaks(the_case.problem.load, checked); !load.empty()) {
    print_wrapped(load.substr(1));
  }
  if (!audit.stretches.empty()) fmt::print("Not proved:\n");
  const std::size_t shown = std::min(audit.stretches.size(), kShownStretches);
  for (std::size_t i = 0; i < shown; ++i) print_wrapped(text(audit.stretches[i], the_case, source.place_name()));
  const std::size_t all = audit.stretches_violated + audit.stretches_open;
  if (all > shown) fmt::print("  … and {} more, in certificate.json\n", all - shown);
}

/// The verdict, the numbers of the report, or the certificate's margins where no report was made, and the rest.
void print(const Audit& audit, const Case& the_case, const PathSource& source, const checker::CheckResult& checked,
           const std::optional<ReportContext>& context) {
  const bool is_unchecked = checked.outcome == checker::Outcome::kUnchecked;
  if (is_unchecked) {
    print_verdict("UNCHECKED", fmt::format("{}. Nothing is claimed of the path.", checked.message));
  } else {
    print_verdict(verdict_in_full(audit), sentence(audit, source));
  }
  if (context) {
    print_key_numbers(Summary(*context, {}).key_numbers);
  } else if (audit.margins && !is_unchecked) {
    print_wrapped(margins_text(audit.margins->tension_N, audit.margins->length_m, audit.margins->wrench_scale,
                               DisplayUnits(the_case.units)));
  }
  fmt::print("{}", wrapped(source.remarks(), standard_output().columns));
  if (!is_unchecked) {
    print_stretches(audit, the_case, source, checked);
    if (const std::string may_be = hint(audit, source); !may_be.empty()) print_wrapped(may_be);
  }
  print_wrapped(fmt::format("Audited {} in {:.3g} s, {:.4g} a second.", plural(audit.segments, "segment"),
                            audit.seconds, static_cast<double>(audit.segments) / audit.seconds));
}

nlohmann::json place_json(const PathPoint& point, const FilePlace& place, const char* place_name) {
  return {{"segment", point.index},
          {"s", point.s.text()},
          {std::string(place_name) + "s", {place.line_before, place.line_behind}},
          {"t", place.time_s ? nlohmann::json(*place.time_s) : nlohmann::json()}};
}

/// A violation without its proof.
nlohmann::json violation_json(const Witness& witness) {
  nlohmann::json result = to_json(witness);
  for (const char* of_proof : {"motion", "proof", "at_proof", "to_proof"}) result.erase(of_proof);
  return result;
}

nlohmann::json stretches_json(const Audit& audit, const PathSource& source) {
  const char* const place_name = source.place_name();
  nlohmann::json stretches = nlohmann::json::array();
  for (const AuditedStretch& audited : audit.stretches) {
    const Stretch& stretch = audited.stretch;
    nlohmann::json inner;
    if (stretch.violations) {
      const auto& [first, last] = *stretch.violations;
      inner = {
          {{"at", place_json(first.violation.at, audited.first, place_name)}, {"witness", violation_json(first)}},
          {{"at", place_json(end_of(last.violation), audited.last, place_name)}, {"witness", violation_json(last)}}};
    }
    stretches.push_back(
        {{"outer",
          {place_json(stretch.begin, audited.begin, place_name), place_json(stretch.end, audited.end, place_name)}},
         {"inner", inner},
         {"reason", stretch.violations ? nlohmann::json() : nlohmann::json(stretch.reason)}});
  }
  return stretches;
}

std::vector<std::string> lines_of(const std::string& text) {
  std::vector<std::string> lines;
  std::istringstream stream(text);
  for (std::string line; std::getline(stream, line);) lines.push_back(line);
  return lines;
}

/// Verdict, margins and witness are the checker's; what is unchecked says nothing of stretches.
nlohmann::json summary(const Audit& audit, const PathSource& source, const checker::CheckResult& checked) {
  const bool is_unchecked = checked.outcome == checker::Outcome::kUnchecked;
  const auto if_checked = [&](const auto& value) { return is_unchecked ? nlohmann::json() : nlohmann::json(value); };
  nlohmann::json result = {{"command", "audit"},
                           {"interpolation", interpolation_name(source.law())},
                           {"waypoints", source.waypoints()},
                           {"segments", audit.segments},
                           {"boxes", audit.boxes},
                           {"boxes_judged", audit.boxes_judged},
                           {"stretches_violated", if_checked(audit.stretches_violated)},
                           {"stretches_open", if_checked(audit.stretches_open)},
                           {"stretches", if_checked(stretches_json(audit, source))},
                           {"move", nullptr},
                           {"table", nullptr},
                           {"prove_seconds", audit.seconds},
                           {"read", source.description()}};
  result.update(result_json(checked));
  std::vector<std::string> messages = lines_of(source.remarks());
  if (is_unchecked) messages.push_back(fmt::format("UNCHECKED: {}. Nothing is claimed of the path.", checked.message));
  if (!is_unchecked) messages.push_back(hint(audit, source));
  result["messages"] = messages_json(messages);
  return result;
}

std::string progress_text(std::size_t done, std::size_t all, double seconds) {
  const double rate = static_cast<double>(done) / seconds;
  return fmt::format("auditing: {} of {} segments ({:.0f} %), {:.4g} a second, {:.0f} s left", done, all,
                     100.0 * static_cast<double>(done) / static_cast<double>(all), rate,
                     static_cast<double>(all - done) / rate);
}

/// What the results are about.
ResultInputs inputs_of(const AuditArguments& arguments, const AuditRequest& request) {
  ResultInputs inputs("audit");
  inputs.add_file("case", arguments.case_path);
  inputs.add_file("path", request.path.name);
  if (request.law) inputs.add("interpolation", interpolation_name(*request.law));
  return inputs;
}

/// What an audit writes: under temporary names until all of it is there.
struct AuditFiles {
  explicit AuditFiles(std::filesystem::path folder)
      : out(std::move(folder)), certificate(out / "certificate.json"), csv(out / "path.csv") {}

  void write_certificate(std::string_view text) {
    digest.update(text);
    size += text.size();
    certificate.write(text);
  }
  void finish() {
    certificate.finish();
    csv.write(certificate_line(digest.hex()));
    csv.finish();
  }
  /// controller.csv, where it is asked for and the path is proved.
  void add_controller(const std::optional<ControllerStep>& step, const PathSource& source,
                      const checker::CheckResult& checked) {
    if (!step || exit_code(checked) != kProvedExit) return;
    controller.emplace(out / "controller.csv");
    controller->write(controller_csv(source.problem(), source.whole_path(), *step, checked.sha256));
    controller->finish();
  }
  void add_report(const ReportContext& context, const std::string& date) {
    report.emplace(out / "report.html");
    report->write(html_report(context, {"", "", date}));
    report->finish();
  }
  void add_meshes(const Case& the_case) {
    for (const auto& [name, bytes] : mesh_files(the_case)) {
      meshes.emplace_back(out / name);
      meshes.back().write(bytes);
      meshes.back().finish();
    }
  }
  void publish(const ResultInputs& inputs) {
    std::vector<NewFile*> files = {&certificate};
    for (NewFile& mesh : meshes) files.push_back(&mesh);
    if (report) files.push_back(&*report);
    if (controller) files.push_back(&*controller);
    files.push_back(&csv);  // last, so that it is never found beside a certificate that is not its own
    std::vector<std::filesystem::path> remove_first = outdated_results(out, inputs);
    if (!report) remove_first.push_back(out / "report.html");  // of an earlier audit
    rename_into_place(files, remove_first);
  }
  /// In the order of publish().
  [[nodiscard]] std::vector<std::filesystem::path> names() const {
    std::vector<std::filesystem::path> written = {out / "certificate.json"};
    if (report) written.push_back(out / "report.html");
    if (controller) written.push_back(out / "controller.csv");
    written.push_back(out / "path.csv");
    return written;
  }

  std::filesystem::path out;
  NewFile certificate, csv;
  std::optional<NewFile> report, controller;
  std::list<NewFile> meshes;
  Sha256 digest;  ///< of the certificate
  std::uintmax_t size = 0;
};

/// Audits with a line of progress, into files that are not finished.
Audit audit(const AuditArguments& arguments, const Case& the_case, const SigningKey* key, PathSource& source,
            AuditFiles& files, const std::stop_token& stop) {
  ProgressLine line(!arguments.json);
  const auto begin = std::chrono::steady_clock::now();
  const auto progress = [&](std::size_t done) {
    line.show([&] {
      const std::chrono::duration<double> spent = std::chrono::steady_clock::now() - begin;
      return progress_text(done, source.segments(), spent.count());
    });
  };
  const auto headroom_progress = [&](std::size_t done, std::size_t all) {
    line.show([&] { return headroom_progress_text(done, all); });
  };
  return audit_path(
      source,
      {the_case, read_meshes(the_case.decoration), arguments.bits, files.out, key, arguments.headroom_seconds,
       headroom_progress},
      [&](std::string_view text) { files.write_certificate(text); },
      [&](std::string_view text) { files.csv.write(text); }, progress, stop);
}

void print_result_json(const Audit& result, const Case& the_case, const PathSource& source,
                       const checker::CheckResult& checked, const AuditFiles& files, const Stopwatch& stopwatch) {
  const bool is_unchecked = checked.outcome == checker::Outcome::kUnchecked;
  nlohmann::json object = summary(result, source, checked);
  object["load"] = to_json(load_statement(the_case));
  object["bodies"] = stated_bodies_json(the_case.bodies);
  object["warnings"] = the_case.warnings;
  object["out"] = files.out.string();
  object["headroom"] = is_unchecked ? nlohmann::json() : headroom_json(result.headroom);
  object["as_items"] = is_unchecked ? nlohmann::json() : to_json(result.as_items);
  add_ending(object, stopwatch, exit_code(checked), files.names());
  print_json(object);
}

void print_result(const Audit& result, const Case& the_case, const PathSource& source,
                  const checker::CheckResult& checked, const std::optional<ReportContext>& context,
                  const AuditFiles& files) {
  print(result, the_case, source, checked, context);
  if (checked.outcome != checker::Outcome::kUnchecked) {
    if (result.as_items) print_wrapped(sentence(*result.as_items, DisplayUnits(the_case.units)));
    print_headroom(result.headroom, source.problem(), the_case.units);
  }
  print_wrapped(taut::sentence(checked));
  print_wrapped(fmt::format("Written to {}: path.csv, {}certificate.json{}", sanitize(files.out.string()),
                            files.controller ? "controller.csv, " : "", files.report ? ", report.html" : ""));
  if (result.segments > kMostReported) {
    fmt::print("No report is made of more than {} segments unless you ask for it:\n  taut report {}\n", kMostReported,
               sanitize((files.out / "certificate.json").string()));
  }
}

}  // namespace

std::filesystem::path audit_folder(const AuditArguments& arguments, const std::string& path,
                                   const ResultInputs& inputs) {
  const auto stem = [](const std::string& file) { return std::filesystem::path(file).stem().string(); };
  std::filesystem::path out =
      make_result_folder(arguments.out, stem(arguments.case_path) + "-audit-" + stem(path), inputs);
  require_results_apart(out, {path, arguments.case_path, arguments.key});
  return out;
}

void add_audit_options(CLI::App& command, AuditArguments& arguments) {
  command.add_option("CASE", arguments.case_path, "case file (docs/case-format.md); needs no query")->required();
  command.add_option("PATH", arguments.path,
                     "path file, or a certificate.json (docs/audits.md; default: what the case's 'audit' names)");
  std::vector<std::string> names;
  for (const auto& [law, ignored] : audit_laws()) names.push_back(law);
  command
      .add_option("--interpolation", arguments.law, "what happens between waypoints (default: as the file suggests)")
      ->check(CLI::IsMember(names));
  command.add_flag("--timed", arguments.timed,
                   "audit a move in time: a certificate's path with its law, or a table with times");
  command.add_option(
      "--rounding", arguments.rounding,
      "how far a table's rows may be from the move that is fitted to them, for example 0.1mm,0.01deg; of "
      "cable lengths 0.1mm");
  command.add_option("--out", arguments.out,
                     "directory for the results (default: a new one, out/CASE-audit-PATH, or that of these files)");
  command.add_option("--step", arguments.step,
                     "write controller.csv, too, if the path is proved: the platform travels at most so far from row "
                     "to row, for example 10mm");
  constexpr int kLeastBits = 128;
  constexpr int kMostBits = 1 << 20;
  command.add_option("--bits", arguments.bits, "precision beyond which the prover gives up (default: 4096)")
      ->check(CLI::Range(kLeastBits, kMostBits));
  command.add_option("--sign", arguments.key, "sign the certificate with this Ed25519 private key (PEM)");
  command.add_flag("--json", arguments.json, "print the result as JSON");
  command.add_flag("--no-report", arguments.no_report, "write no report.html");
  add_headroom_option(command, arguments.headroom_seconds);
  add_max_seconds_option(command, arguments.max_seconds);
}

int run_audit(const AuditArguments& arguments) {
  const Stopwatch stopwatch;
  Case stated = load_case(arguments.case_path);
  const std::optional<Interpolation> law =
      arguments.law.empty() ? std::nullopt : std::optional(audit_laws().at(arguments.law));
  std::optional<TableRounding> rounding;
  if (!arguments.rounding.empty()) rounding = read_table_rounding(arguments.rounding, "--rounding");
  const AuditRequest request = resolved({arguments.path, law, arguments.timed, rounding}, stated, arguments.case_path);
  if (request.timed) return run_timed_audit(arguments, stated, request, stopwatch);
  if (rounding) {
    throw InputError(ErrorCode::kUse,
                     "--rounding: got it without --timed, expected both: rows without times are audited "
                     "as they are");
  }
  const Case case_ = at_rest(std::move(stated));
  const std::optional<ControllerStep> step =
      arguments.step.empty() ? std::nullopt : std::optional(read_controller_step(arguments.step, "--step"));
  const std::optional<SigningKey> key = load_signing_key(arguments.key);
  const std::string date = report_date();
  PathSource source(case_.problem, request.path, request.law);
  if (!arguments.json) fmt::print("{}", wrapped(source.description(), standard_output().columns));
  announce(case_, arguments.json);
  std::fflush(stdout);

  const ResultInputs inputs = inputs_of(arguments, request);
  const std::filesystem::path out = audit_folder(arguments, request.path.name, inputs);
  const Interruption interruption;  // before there is a file that a signal could leave behind
  AuditFiles files(out);
  const Audit result = audit(arguments, case_, key ? &*key : nullptr, source, files, interruption.token());
  if (result.interrupted) {
    return report_interruption("audit", "interrupted: nothing was written", arguments.json);
  }
  files.finish();
  const checker::CheckResult checked = files.size > kMostCheckedBytes
                                           ? too_long_to_check()
                                           : recheck(read_whole(files.certificate.temporary()), arguments.max_seconds,
                                                     interruption.token(), meshes_of(case_.problem));
  require_confirmed(checked);
  std::optional<ReportContext> context;
  if (result.segments <= kMostReported && checked.certificate != nullptr) {
    context.emplace(checked);
    if (!arguments.no_report) files.add_report(*context, date);
  }
  files.add_controller(step, source, checked);
  files.add_meshes(case_);
  files.publish(inputs);

  if (arguments.json) {
    print_result_json(result, case_, source, checked, files, stopwatch);
  } else {
    print_result(result, case_, source, checked, context, files);
  }
  return exit_code(checked);
}

}  // namespace taut
