// SPDX-License-Identifier: GPL-3.0-or-later
// taut-check CERTIFICATE [CASE] [--path FILE] [--expect VERDICT] [--trust PUBKEY.pem]…: proves the claim of a
// certificate again, and says what it was compared with.
//
// Results go to stdout; bad input is complained about on stderr, as wrong use is, and with --json on stdout too.
// Exit codes: 0 accepted; 1 rejected, or not as expected; 2 the certificate itself is undecided, or the budget ran out;
// 3 malformed input or wrong use; 4 this program failed.
#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <array>
#include <chrono>
#include <filesystem>
#include <iostream>
#include <memory>
#include <optional>
#include <sstream>
#include <string>
#include <vector>

#include "base/files.h"
#include "base/input_error.h"
#include "base/process.h"
#include "base/sanitize.h"
#include "case/case_of_legs.h"
#include "case/mesh_search.h"
#include "checker/arguments.h"
#include "checker/check.h"
#include "checker/format/legs.h"
#include "checker/format/signature.h"
#include "checker/kernel/errors.h"
#include "checker/kernel/statement.h"
#include "checker/stated_bodies.h"
#include "checker/stated_load.h"
#include "path_io/path_file.h"
#include "path_io/waypoint_maker.h"

namespace taut::checker {
namespace {

constexpr std::size_t kMaxFileSize = std::size_t{2} << 30U;  ///< bytes; a certificate of 10^6 boxes has 10^8

/// A law as --interpolation, as path files, and as the kernel name it.
struct LawNames {
  const char* option;
  taut::Interpolation of_file;
  Law of_kernel;
};
constexpr std::array<LawNames, 4> kLawNames = {
    {{"straight", taut::Interpolation::kStraight, Law::kStraight},
     {"geodesic", taut::Interpolation::kGeodesic, Law::kGeodesic},
     {"cable-lengths", taut::Interpolation::kCableLengths, Law::kCableLengths},
     {"cubic-b-spline", taut::Interpolation::kCubicBSpline, Law::kCubicBSpline}}};

/// The path of a path file, read as `taut audit` does.
/// @param interpolation  "straight", "geodesic" or "cable-lengths"; empty: the law that such a file usually has
/// @throws InputError naming file, line and column.
ExpectedPath read_expected_path(const std::string& text, const std::string& name, const taut::Problem& problem,
                                const std::string& interpolation) {
  if (is_certificate_name(name)) {
    throw InputError(name + ": got the name of a certificate, expected a path file, such as path.csv", {name});
  }
  PathFile file(std::make_unique<std::istringstream>(text), name, problem.space);
  const auto* const named = std::ranges::find(kLawNames, interpolation, &LawNames::option);
  WaypointMaker maker(problem, file.header(), named == kLawNames.end() ? usual_law(file.header()) : named->of_file,
                      name);
  ExpectedPath path;
  path.name = name;
  path.law = std::ranges::find(kLawNames, maker.law(), &LawNames::of_file)->of_kernel;
  path.space = to_json(maker.problem())["space"];
  path.sha256 = sha256(text);
  path.certificate_sha256 = named_certificate(text);
  for (PathRow row; file.next(row);) {
    const taut::Waypoint& waypoint = maker.next(row, file.start());
    const auto* const point = std::get_if<taut::ParameterPoint>(&waypoint.point());
    path.waypoints.push_back(
        {numbers(waypoint), half_turns(waypoint), point != nullptr ? point->normals : std::vector<double>(), row.line});
  }
  return path;
}

constexpr std::array kVerdicts = {Theorem::Verdict::kProved, Theorem::Verdict::kRefuted, Theorem::Verdict::kNoPath};

int exit_code(Outcome outcome) {
  constexpr std::array<int, 5> kCodes = {0, 1, 2, 2, 3};  // in the order of the outcomes
  return kCodes.at(static_cast<std::size_t>(outcome));
}

struct Arguments {
  std::string certificate_path;
  std::string case_path;
  std::string path_path;  ///< of the path file
  std::string interpolation;
  std::string expect;
  std::vector<std::string> key_paths;
  unsigned threads = 0;
  std::optional<double> max_seconds;
  std::string meshes;  ///< a folder
  bool as_json = false;
  bool quiet = false;
};

/// Looks for meshes in the folder that is named, else in those of the case, if one is given, and beside the
/// certificate.
MeshSupplier meshes_of(const Arguments& arguments, const CaseOfLegs* of) {
  std::vector<std::filesystem::path> folders;
  if (!arguments.meshes.empty()) {
    folders.emplace_back(arguments.meshes);
  } else {
    const auto add = [&](const Case& the_case) {
      if (!the_case.bodies) return;
      for (const MeshOfBody& mesh : the_case.bodies->meshes) folders.push_back(mesh.path.parent_path());
    };
    if (of != nullptr) {
      add(of->whole);
      for (const CaseLeg& leg : of->legs) add(leg.content);
    }
    folders.push_back(std::filesystem::path(arguments.certificate_path).parent_path());
  }
  return [folders](const std::string& file, const std::string& sha256) {
    const LoadedMesh loaded = find_mesh(folders, file, sha256);
    return SuppliedMesh{loaded.sha256, loaded.mesh.vertices, loaded.mesh.triangles, loaded.mesh.needles};
  };
}

struct CheckedFile {
  CheckResult result;
  std::vector<std::string> stated;  ///< what an accepted certificate is about, where no case says what it has to be
  bool is_bad_input = false;  ///< of kMalformed: a file could not be read, or one that is not the certificate is wrong
};

/// The load, the limits in time and the bodies of a certificate, a line each; of legs, those of each.
std::vector<std::string> stated_lines(const std::string& bytes, const CheckResult& result) {
  std::vector<std::string> lines;
  const auto add = [&](const std::string& leg, const std::string& line) {
    if (!line.empty()) lines.push_back(leg + line);
  };
  if (result.legs.empty()) {
    add("", stated_load(bytes));
    add("", stated_time(bytes));
    add("", stated_bodies(bytes));
    return lines;
  }
  const Outline outline = read_json(bytes);
  const std::vector<std::string_view> texts = leg_texts(outline);
  add("", stated_time(std::string(texts.at(0))));
  for (std::size_t k = 0; k < texts.size(); ++k) {
    const std::string leg = fmt::format("leg {}: ", k + 1);
    add(leg, stated_load(std::string(texts[k])));
    add(leg, stated_bodies(std::string(texts[k])));
  }
  return lines;
}

/// The case's problem, or the list of those of its legs.
nlohmann::json problem_json(const CaseOfLegs& the_case) {
  if (the_case.legs.empty()) return to_json(the_case.whole.problem);
  nlohmann::json problems = nlohmann::json::array();
  for (const CaseLeg& leg : the_case.legs) problems.push_back(to_json(leg.content.problem));
  return problems;
}

CheckedFile check_file(const Arguments& arguments) {
  CheckResult malformed;
  try {
    CheckOptions options;
    options.keeps_certificate = false;
    options.threads = arguments.threads;
    options.max_seconds = arguments.max_seconds;
    for (const std::string& path : arguments.key_paths) {
      options.trusted.push_back(read_public_key(read_whole(path, kMaxKeyFile), path));
    }
    if (!arguments.expect.empty()) {
      options.expect = *std::ranges::find(kVerdicts, arguments.expect, [](Theorem::Verdict v) { return name(v); });
    }
    const std::string bytes = read_whole(arguments.certificate_path, kMaxFileSize);
    if (arguments.case_path.empty()) {
      options.meshes = meshes_of(arguments, nullptr);
      CheckedFile checked{check(bytes, options), {}};
      if (checked.result.outcome == Outcome::kAccepted) checked.stated = stated_lines(bytes, checked.result);
      return checked;
    }
    const CaseOfLegs the_case = load_case_of_legs(arguments.case_path);
    const taut::Problem& problem = the_case.whole.problem;
    options.meshes = meshes_of(arguments, &the_case);
    const nlohmann::json of_case = problem_json(the_case);
    options.problem = &of_case;
    std::optional<ExpectedPath> path;
    if (!arguments.path_path.empty()) {
      path = read_expected_path(read_whole(arguments.path_path, kMaxFileSize), arguments.path_path, problem,
                                arguments.interpolation);
      options.path = &*path;
    }
    return {check(bytes, options), {}};
  } catch (const Malformed& error) {
    malformed.message = error.what();
  } catch (const InputError& error) {
    malformed.message = error.what();
  }
  return {malformed, {}, true};  // check() itself says what is wrong with a certificate
}

/// "; path file not compared; not compared: the case's query", or nothing.
std::string describe_not_compared(const CheckResult& result) {
  std::string files;
  std::string parts;
  for (const std::string& what : result.not_compared) {
    if (what == "case" || what == "path file") {
      files += "; " + what + " not compared";
    } else {
      parts += (parts.empty() ? "; not compared: " : ", ") + what;
    }
  }
  return files + parts;
}

/// Who vouches for the file.
std::string describe_signer(const CheckResult& result) {
  if (result.signer.empty()) return "not signed";
  return "signed by key " + fingerprint(result.signer) + (result.is_trusted ? "; trusted" : "; not trusted by anyone");
}

/// Null unless it is known.
nlohmann::json verdict_json(const CheckResult& result) {
  if (result.theorem) return name(result.theorem->verdict());
  return result.outcome == Outcome::kUndecided ? nlohmann::json("undecided") : nlohmann::json();
}

nlohmann::json to_json(const CheckResult& result, double seconds) {
  nlohmann::json signature;
  if (!result.signer.empty()) {
    signature = {{"key", fingerprint(result.signer)}, {"public_key", result.signer}, {"trusted", result.is_trusted}};
  }
  nlohmann::json document = {{"command", "check"},
                             {"outcome", name(result.outcome)},
                             {"message", result.message},
                             {"verdict", verdict_json(result)},
                             {"audit", result.is_audit},
                             {"segments", result.counts.segments},
                             {"boxes", result.counts.boxes},
                             {"bits", result.counts.bits},
                             {"not_compared", result.not_compared},
                             {"sha256", result.sha256},
                             {"signature", signature},
                             {"exit_code", exit_code(result.outcome)},
                             {"elapsed_seconds", seconds}};
  for (const CheckResult& leg : result.legs) {
    document["legs"].push_back({{"outcome", name(leg.outcome)},
                                {"verdict", verdict_json(leg)},
                                {"message", leg.message},
                                {"sha256", leg.sha256}});
  }
  return document;
}

void add_options(CLI::App& app, Arguments& arguments) {
  app.add_option("CERTIFICATE", arguments.certificate_path, "certificate.json")->required();
  CLI::Option* the_case =
      app.add_option("CASE", arguments.case_path, "case that the certificate must be about (of an audit: its machine)");
  CLI::Option* path =
      app.add_option("--path", arguments.path_path,
                     "path file whose waypoints the certificate must be about: the audited file, or the "
                     "path.csv beside the certificate");
  path->needs(the_case);
  app.add_option("--interpolation", arguments.interpolation,
                 "law of the path file, where it is not the usual one: straight, geodesic or cable-lengths")
      ->check(CLI::IsMember({"straight", "geodesic", "cable-lengths"}))
      ->needs(path);
  app.add_option("--expect", arguments.expect, "reject a certificate of another verdict: proved, refuted or 'no path'")
      ->check(CLI::IsMember({"proved", "refuted", "no path"}));
  app.add_option("--trust", arguments.key_paths,
                 "reject what is not signed by this Ed25519 public key (PEM); repeatable")
      ->allow_extra_args(false);
  app.add_option("--meshes", arguments.meshes,
                 "folder of the meshes that the problem names (default: those of the case and the certificate)");
  constexpr unsigned kMostThreads = 1024;
  app.add_option("--threads", arguments.threads, "threads to prove with (default: one for each core)")
      ->check(CLI::Range(1U, kMostThreads));
  app.add_option("--max-seconds", arguments.max_seconds,
                 "give up after so long, and say 'unchecked' (default: never); 0: compare, but prove nothing")
      ->check(complain_of_seconds);
  app.add_flag("--json", arguments.as_json, "print one JSON object");
  app.add_flag("--quiet", arguments.quiet, "print nothing: the exit code says it");
  app.set_version_flag("--version", std::string("taut-check ") + TAUT_VERSION);
  app.footer(
      "Exit codes: 0 accepted; 1 rejected, or not as expected; 2 undecided, or unchecked as time ran out; 3 malformed; "
      "4 internal failure.");
  refuse_empty_arguments(app);
}

int run(int argc, char** argv) {
  CLI::App app("Proves the claim of a certificate again, independently of the program that wrote it.", "taut-check");
  Arguments arguments;
  add_options(app, arguments);
  app.failure_message([](const CLI::App* /*failed*/, const CLI::Error& error) {
    return sanitize(error.what()) + "\nRun with --help for more information.\n";
  });
  try {
    app.parse(argc, argv);
  } catch (const CLI::ParseError& error) {
    const int code = app.exit(error);
    if (!std::cout.flush()) throw std::runtime_error("could not write to standard output");
    return code == 0 ? 0 : 3;
  }

  const auto start = std::chrono::steady_clock::now();
  const CheckedFile checked = check_file(arguments);
  const CheckResult& result = checked.result;
  const double seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
  const bool is_malformed = result.outcome == Outcome::kMalformed;
  if (arguments.as_json && !arguments.quiet) {
    std::cout << to_json(result, seconds).dump(2, ' ', true, nlohmann::json::error_handler_t::replace) << std::endl;
  } else if (!arguments.quiet && !is_malformed) {
    std::cout << name(result.outcome) << ": " << sanitize(result.message) << describe_not_compared(result)
              << fmt::format("; {:.2f} s; ", seconds) << describe_signer(result) << std::endl;
    for (const std::string& line : checked.stated) std::cout << sanitize(line) << std::endl;
  }
  if (!arguments.quiet && is_malformed)
    std::cerr << (checked.is_bad_input ? "bad input" : name(result.outcome)) << ": " << sanitize(result.message)
              << std::endl;
  if (!std::cout) throw std::runtime_error("could not write to standard output");
  return exit_code(result.outcome);
}

}  // namespace
}  // namespace taut::checker

/// Runs before any initialisation, that of shared libraries included, which may fail for want of memory, too.
static void prepare() { taut::prepare_process("taut-check", ""); }
[[gnu::section(".preinit_array"), gnu::used]] static void (*const prepare_first)() = prepare;

int main(int argc, char** argv) {
  try {
    return taut::checker::run(argc, argv);
  } catch (const std::bad_alloc&) {
    std::cerr << "taut-check: internal failure: out of memory" << std::endl;
    return 4;
  } catch (const std::exception& error) {
    std::cerr << "taut-check: internal failure: " << taut::sanitize(error.what()) << std::endl;
    return 4;
  }
}
