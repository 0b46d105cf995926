// SPDX-License-Identifier: GPL-3.0-or-later
#include "cli/timed_audit.h"

#include <fmt/format.h>

#include <filesystem>
#include <nlohmann/json.hpp>
#include <vector>

#include "app/meshes.h"
#include "app/proved_path.h"
#include "app/report.h"
#include "app/timed_audit.h"
#include "base/files.h"
#include "base/plural.h"
#include "base/sanitize.h"
#include "certify/undecided.h"
#include "cli/console.h"
#include "cli/plan_output.h"
#include "cli/terminal.h"
#include "cli/verdict_output.h"
#include "path_io/path_csv.h"
#include "reports/page/html_report.h"
#include "reports/summary/bodies_statement.h"
#include "reports/summary/display_units.h"
#include "reports/summary/hints.h"
#include "reports/summary/load_statement.h"
#include "reports/summary/sentences.h"

namespace taut {
namespace {

/// Where a move is refuted: "at t = 7.31 s (lines 738-739)".
std::string witness_place(const TimedAudit& audit, const MoveSource& source) {
  const PathPoint& at = audit.certificate.witness->violation.at;
  const double time_s = audit.witness_s.value();
  std::string lines;
  if (source.table) {
    const auto [before, behind] = source.table->lines_at(time_s);
    lines = before == behind ? fmt::format("line {}", before) : fmt::format("lines {}-{}", before, behind);
  } else {
    lines = at.on_segment ? fmt::format("segment {}", at.index) : fmt::format("waypoint {}", at.index);
  }
  return fmt::format("at t = {:.6g} s ({})", time_s, lines);
}

/// What follows the verdict.
std::string timed_sentence(const TimedAudit& audit, const MoveSource& source, const Case& the_case) {
  const checker::CheckResult& checked = audit.checked;
  if (checked.outcome == checker::Outcome::kUnchecked) {
    return fmt::format("{}. Nothing is claimed of the move.", checked.message);
  }
  const Certificate& certificate = audit.certificate;
  switch (certificate.verdict) {
    case Verdict::kProved: {
      const checker::Theorem& theorem = checked.theorem.value();
      return fmt::format(
          "the move is wrench-feasible with its inertia, within its limits in time, and clear of singularities at "
          "every time, in {} in {}{}.",
          plural(theorem.counts().segments, "segment"), plural(theorem.counts().boxes, "box"),
          clear_bodies(source.problem.bodies, "; "));
    }
    case Verdict::kRefuted:
      return fmt::format("{} {}.{}{}", witness_place(audit, source),
                         violation_text(certificate.witness->violation, source.problem, DisplayUnits(the_case.units)),
                         load_that_breaks(source.problem.load, checked),
                         source.table ? " That is about the fitted move, not about others within the rounding." : "");
    case Verdict::kUndecided: break;
  }
  return with_code(certificate.undecided ? certificate.undecided->reason : "") + ".";
}

nlohmann::json timed_summary(const TimedAudit& audit, const MoveSource& source, const Case& the_case) {
  const checker::CheckResult& checked = audit.checked;
  nlohmann::json result = {{"command", "audit"},
                           {"interpolation", interpolation_name(source.path.interpolation)},
                           {"waypoints", source.path.waypoints.size()},
                           {"segments", checked.counts.segments},
                           {"boxes", checked.counts.boxes},
                           {"boxes_judged", nullptr},
                           {"stretches_violated", nullptr},
                           {"stretches_open", nullptr},
                           {"stretches", nullptr},
                           {"headroom", nullptr},
                           {"as_items", nullptr},
                           {"move",
                            {{"duration_s", source.path.timing->duration_s()},
                             {"witness_s", audit.witness_s ? nlohmann::json(*audit.witness_s) : nlohmann::json()}}},
                           {"table", source.table ? to_json(*source.table) : nlohmann::json()},
                           {"prove_seconds", audit.prove_seconds},
                           {"read", source.description},
                           {"load", to_json(load_statement(the_case))},
                           {"bodies", stated_bodies_json(the_case.bodies)},
                           {"warnings", the_case.warnings}};
  result.update(result_json(checked));
  const bool is_proved = exit_code(checked) == kProvedExit;
  result["messages"] = messages_json({source.remarks, is_proved ? "" : timed_sentence(audit, source, the_case)});
  return result;
}

/// "path.csv, winches.csv, …": the names of files.
std::string names_of(const std::vector<FileContent>& files) {
  std::vector<std::string> names;
  for (const FileContent& file : files) names.push_back(file.path.filename().string());
  return fmt::format("{}", fmt::join(names, ", "));
}

}  // namespace

int run_timed_audit(const AuditArguments& arguments, const Case& the_case, const AuditRequest& request,
                    const Stopwatch& stopwatch) {
  require_timed(request, the_case, "--timed");
  if (!arguments.step.empty()) {
    throw InputError(ErrorCode::kUse,
                     "--step: got it with --timed, expected one of the two: the tables of a move have a row "
                     "every so often (time.rate in the case)");
  }
  const std::optional<SigningKey> key = load_signing_key(arguments.key);
  const std::string date = report_date();
  const MoveSource source = read_move(the_case.problem, request.path, request.rounding);
  if (!arguments.json) fmt::print("{}", wrapped(source.description, standard_output().columns));
  Case with_rows = the_case;
  with_rows.problem.time = source.problem.time;  // those of the table
  announce(with_rows, arguments.json);
  std::fflush(stdout);

  ResultInputs inputs("audit");
  inputs.add_file("case", arguments.case_path);
  inputs.add_file("path", request.path.name);
  inputs.add("timed", request.rounding ? request.rounding->text() : "exactly");
  const std::filesystem::path out = audit_folder(arguments, request.path.name, inputs);
  const Interruption interruption;
  const TimedAudit audit = audit_move(source, the_case, {arguments.bits, key ? &*key : nullptr, arguments.max_seconds},
                                      interruption.token());
  if (audit.interrupted) return report_interruption("audit", "interrupted: nothing was written", arguments.json);

  const checker::CheckResult& checked = audit.checked;
  const ReportOptions report_options{"", "", date};
  const ReportContext context(checked);
  std::vector<FileContent> files = {{out / "certificate.json", audit.text}};
  for (auto& [name, bytes] : mesh_files(the_case)) files.push_back({out / name, std::move(bytes)});
  std::vector<std::filesystem::path> remove_first = outdated_results(out, inputs);
  if (arguments.no_report) {
    remove_first.push_back(out / "report.html");
  } else {
    files.push_back({out / "report.html", html_report(context, report_options)});
  }
  if (exit_code(checked) == kProvedExit) {  // what is not proved is not for a machine to follow
    try {
      add_move_tables(
          out, move_tables(source.problem, source.path, tension_pieces(checked), the_case.move.rate_Hz, checked.sha256),
          files);
    } catch (const InputError& error) {  // too many rows: the audit is none the worse
      complain(fmt::format("warning: no tables of the move are written: {}", error.what()));
    }
  }
  files.push_back({out / "path.csv", path_csv(source.problem, source.path, checked.sha256)});  // last
  write_whole(files, remove_first);

  if (arguments.json) {
    nlohmann::json result = timed_summary(audit, source, the_case);
    result["out"] = out.string();
    std::vector<std::filesystem::path> written;
    for (const FileContent& file : files) written.push_back(file.path);
    add_ending(result, stopwatch, exit_code(checked), written);
    print_json(result);
    return exit_code(checked);
  }
  const Summary shown(context, report_options);
  print_verdict(verdict_in_full(shown), timed_sentence(audit, source, the_case));
  print_key_numbers(shown.key_numbers);
  fmt::print("{}", wrapped(source.remarks, standard_output().columns));
  print_wrapped(sentence(checked));
  print_wrapped(fmt::format("Written to {}: {}", sanitize(out.string()), names_of(files)));
  return exit_code(checked);
}

}  // namespace taut
