// SPDX-License-Identifier: GPL-3.0-or-later
#include "cli/audit_command.h"

#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <nlohmann/json.hpp>

#include "app/audit.h"
#include "app/recheck.h"
#include "app/report.h"
#include "base/files.h"
#include "base/sanitize.h"
#include "base/sha256.h"
#include "case/case_file.h"
#include "certify/undecided.h"
#include "cli/console.h"
#include "cli/headroom_output.h"
#include "cli/report_command.h"
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

std::string text(const AuditedStretch& audited, const char* place_name) {
  const Stretch& stretch = audited.stretch;
  std::string lines = fmt::format("  from {}\n    to {}\n", text(stretch.begin, audited.begin, place_name),
                                  text(stretch.end, audited.end, place_name));
  if (!stretch.violations) return lines + fmt::format("    open: {}\n", with_code(stretch.reason));
  const PathWitness& first = stretch.violations->first.violation;
  const PathWitness& last = stretch.violations->second.violation;
  lines += fmt::format("    violated from {}: {}\n", text(first.at, audited.first, place_name), violation_text(first));
  return lines +
         fmt::format("              to {}: {}\n", text(end_of(last), audited.last, place_name), violation_text(last));
}

std::string counted(std::size_t n, std::string_view what) {
  const bool hisses = what.ends_with('x') || what.ends_with("ch");
  return fmt::format("{} {}{}", n, what, n == 1 ? "" : hisses ? "es" : "s");
}

std::string sentence(const Audit& audit) {
  switch (audit.verdict) {
    case Verdict::kProved:
      return fmt::format(
          "proved: the path is wrench-feasible and clear of singularities, at its waypoints and everywhere between, {} "
          "in {}.\n"
          "Proved margins: tension {} N, length {} m, wrench_scale {}.",
          counted(audit.segments, "segment"), counted(audit.boxes, "box"), audit.margins->tension_N,
          audit.margins->length_m, audit.margins->wrench_scale);
    case Verdict::kRefuted:
      return fmt::format("refuted: {} of the path {} proved violations{}; all the rest is proved.",
                         counted(audit.stretches_violated, "stretch"), audit.stretches_violated == 1 ? "has" : "have",
                         audit.stretches_open == 0
                             ? ""
                             : fmt::format(", and {} could not be decided", counted(audit.stretches_open, "other")));
    case Verdict::kUndecided: break;
  }
  return fmt::format("undecided: {} of the path could not be decided; nothing is claimed of the path.",
                     counted(audit.stretches_open, "stretch"));
}

void print_stretches(const Audit& audit, const PathSource& source) {
  if (audit.verdict == Verdict::kProved) {
    fmt::print("{}\n", source.problem().tolerances
                           ? "This holds for every deviation within the case's tolerances."
                           : "The case states no tolerances: this is about a machine that is exactly as it says.");
  }
  if (!audit.stretches.empty()) fmt::print("Not proved:\n");
  const std::size_t shown = std::min(audit.stretches.size(), kShownStretches);
  for (std::size_t i = 0; i < shown; ++i) fmt::print("{}", text(audit.stretches[i], source.place_name()));
  const std::size_t all = audit.stretches_violated + audit.stretches_open;
  if (all > shown) fmt::print("  … and {} more, in certificate.json\n", all - shown);
}

void print(const Audit& audit, const PathSource& source, const checker::CheckResult& checked) {
  fmt::print("{}", source.remarks());
  const bool is_unchecked = checked.outcome == checker::Outcome::kUnchecked;
  if (is_unchecked) {
    fmt::print("UNCHECKED: {}. Nothing is claimed of the path.\n", checked.message);
  } else {
    fmt::print("{}\n", sentence(audit));
    print_stretches(audit, source);
  }
  fmt::print("Audited {} in {:.3g} s, {:.4g} a second.\n", counted(audit.segments, "segment"), audit.seconds,
             static_cast<double>(audit.segments) / audit.seconds);
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

/// Verdict, margins and witness are the checker's; what is unchecked says nothing of stretches.
nlohmann::json summary(const Audit& audit, const PathSource& source, const checker::CheckResult& checked) {
  const bool is_unchecked = checked.outcome == checker::Outcome::kUnchecked;
  const auto if_checked = [&](const auto& value) { return is_unchecked ? nlohmann::json() : nlohmann::json(value); };
  return {{"verdict", verdict_name(checked)},
          {"interpolation", interpolation_name(source.law())},
          {"waypoints", source.waypoints()},
          {"segments", audit.segments},
          {"boxes", audit.boxes},
          {"boxes_judged", audit.boxes_judged},
          {"margins", checked.theorem ? checked.theorem->margins() : nlohmann::json::object()},
          {"witness", checked.theorem ? checked.theorem->witness() : nlohmann::json()},
          {"stretches_violated", if_checked(audit.stretches_violated)},
          {"stretches_open", if_checked(audit.stretches_open)},
          {"stretches", if_checked(stretches_json(audit, source))},
          {"seconds", audit.seconds},
          {"read", source.description()},
          {"remarks", source.remarks()}};
}

std::string progress_text(std::size_t done, std::size_t all, double seconds) {
  const double rate = static_cast<double>(done) / seconds;
  return fmt::format("auditing: {} of {} segments ({:.0f} %), {:.4g} a second, {:.0f} s left", done, all,
                     100.0 * static_cast<double>(done) / static_cast<double>(all), rate,
                     static_cast<double>(all - done) / rate);
}

}  // namespace

void add_audit_options(CLI::App& command, AuditArguments& arguments) {
  command.add_option("CASE", arguments.case_path, "case file (docs/case-format.md); needs no query")->required();
  command.add_option("PATH", arguments.path,
                     "path file, or a certificate.json (docs/audits.md; default: what the case's 'audit' names)");
  std::vector<std::string> names;
  for (const auto& [law, ignored] : audit_laws()) names.push_back(law);
  command
      .add_option("--interpolation", arguments.law, "what happens between waypoints (default: as the file suggests)")
      ->check(CLI::IsMember(names));
  command.add_option("--out", arguments.out, "directory for the results (default: out/PATH's name)");
  constexpr int kLeastBits = 128;
  constexpr int kMostBits = 1 << 20;
  command.add_option("--bits", arguments.bits, "precision beyond which the prover gives up (default: 4096)")
      ->check(CLI::Range(kLeastBits, kMostBits));
  command.add_flag("--allow-repeats", arguments.allow_repeats, "drop rows that repeat the pose of the row before");
  command.add_option("--sign", arguments.key, "sign the certificate with this Ed25519 private key (PEM)");
  command.add_flag("--json", arguments.json, "print the result as JSON");
  add_headroom_option(command, arguments.headroom_seconds);
  add_max_seconds_option(command, arguments.max_seconds);
}

int run_audit(const AuditArguments& arguments) {
  const Case case_ = load_case(arguments.case_path);
  const std::optional<Interpolation> law =
      arguments.law.empty() ? std::nullopt : std::optional(audit_laws().at(arguments.law));
  const AuditRequest request = resolved({arguments.path, law, arguments.allow_repeats}, case_, arguments.case_path);
  const std::optional<SigningKey> key = load_signing_key(arguments.key);
  const std::string date = report_date();
  PathSource source(case_.problem, request.path, request.law, {request.allow_repeats});
  if (!arguments.json) fmt::print("{}", source.description());
  std::fflush(stdout);

  const std::filesystem::path out = out_folder(arguments.out, request.path.name);
  make_directories(out);
  for (const char* name : {"path.csv", "certificate.json", "report.html"}) {
    for (const std::string& read : {request.path.name, arguments.case_path, arguments.key}) {
      require_another(out / name, read);
    }
  }
  const Interruption interruption;  // before there is a file that a signal could leave behind
  Audit result;
  NewFile certificate(out / "certificate.json");
  NewFile csv(out / "path.csv");
  Sha256 digest;  // of the certificate
  std::uintmax_t size = 0;
  {
    ProgressLine line(!arguments.json);
    const auto begin = std::chrono::steady_clock::now();
    const auto progress = [&](std::size_t done) {
      line.show([&] {
        const std::chrono::duration<double> spent = std::chrono::steady_clock::now() - begin;
        return progress_text(done, source.segments(), spent.count());
      });
    };
    result = audit_path(
        source,
        {arguments.bits, out, key ? &*key : nullptr, arguments.headroom_seconds,
         [&](std::size_t done, std::size_t all) { line.show([&] { return headroom_progress_text(done, all); }); }},
        [&](std::string_view text) {
          digest.update(text);
          size += text.size();
          certificate.write(text);
        },
        [&](std::string_view text) { csv.write(text); }, progress, interruption.token());
  }
  if (result.interrupted) {
    complain("interrupted: nothing was written");
    return kUndecidedExit;
  }
  certificate.finish();
  csv.write(certificate_line(digest.hex()));
  csv.finish();
  const checker::CheckResult checked = size > kMostCheckedBytes ? too_long_to_check()
                                                                : recheck(read_whole(certificate.temporary()),
                                                                          arguments.max_seconds, interruption.token());
  require_confirmed(checked);
  std::vector<NewFile*> files = {&certificate};
  const std::filesystem::path report_path = out / "report.html";
  std::optional<NewFile> report;
  if (result.segments <= kMostReported && checked.certificate != nullptr) {
    report.emplace(report_path);
    report->write(make_report(checked, {"", "", date}, ReportForm::kPage));
    report->finish();
    files.push_back(&*report);
  }
  files.push_back(&csv);  // last, so that it is never found beside a certificate that is not its own
  std::vector<std::filesystem::path> remove_first = {out / "path.csv"};
  if (!report) remove_first.push_back(report_path);  // of an earlier audit
  rename_into_place(files, remove_first);

  if (arguments.json) {
    nlohmann::json object = summary(result, source, checked);
    object["out"] = out.string();
    object["headroom"] = headroom_json(result.headroom);
    object["recheck"] = to_json(checked);
    fmt::print("{}\n", object.dump(1, ' ', true, nlohmann::json::error_handler_t::replace));
  } else {
    print(result, source, checked);
    print_headroom(result.headroom);
    fmt::print("{}\n", sentence(checked));
    fmt::print("Written to {}: path.csv, certificate.json{}\n", sanitize(out.string()), report ? ", report.html" : "");
    if (!report) {
      fmt::print("No report is made of more than {} segments unless you ask for it:\n  taut report {}\n", kMostReported,
                 sanitize((out / "certificate.json").string()));
    }
  }
  return exit_code(checked);
}

}  // namespace taut
