// SPDX-License-Identifier: GPL-3.0-or-later
#include "checker/check.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <array>
#include <chrono>
#include <cmath>
#include <map>
#include <set>
#include <thread>

#include "base/sha256.h"
#include "checker/confirm.h"
#include "checker/format/parts.h"
#include "checker/legs.h"
#include "checker/no_path.h"

namespace taut::checker {
namespace {

/// What a case states of a path that has no law in time.
nlohmann::json without_time(nlohmann::json of_case) {
  of_case.erase("time");
  if (!of_case["load"].contains("items")) return of_case;
  for (nlohmann::json& item : of_case["load"]["items"]) {
    if (item.contains("weight")) item["weight"].erase("inertia_box_m");
  }
  return of_case;
}

/// Whether both state rows of a table, and those of the certificate are off by no less than the case's: then what it
/// claims holds for these.
bool holds_for_rows(const nlohmann::json& problem, const nlohmann::json& of_case) {
  const auto errors = [](const nlohmann::json& of) -> std::optional<std::array<mpq_class, kCables>> {
    if (!of.contains("time") || !of["time"].contains("rows")) return std::nullopt;
    std::array<mpq_class, kCables> result;
    const Cursor rows(of["time"]["rows"], "rows");
    read(rows["error_m"], result);
    return result;
  };
  const auto stated = errors(problem), of_the_case = errors(of_case);
  return stated && of_the_case && std::ranges::equal(*stated, *of_the_case, std::ranges::greater_equal());
}

/// The certificate's problem is the case's. In an audit the path is what was asked about: so the case's query does not
/// matter, nor its space where the path goes through the free coordinates, and what is claimed may hold for more than
/// the case's rows. What a case allows in time does not matter to an audited path without a law, nor to that no path
/// exists.
/// @returns what of the case was not compared
std::vector<std::string> require_problem(nlohmann::json problem, nlohmann::json of_case, bool is_no_path) {
  std::vector<std::string> not_compared;
  const bool is_audit = problem["query"]["waypoints"].empty();
  if ((is_audit || is_no_path) && of_case.contains("time") && !problem.contains("time")) {
    not_compared.emplace_back("time");
    of_case = without_time(std::move(of_case));
  }
  if (is_audit) {
    if (problem["query"] != of_case["query"]) not_compared.emplace_back("the case's query");
    problem["query"] = of_case["query"];
    if (is_coordinate_space(problem["space"], of_case["space"]) && problem["space"] != of_case["space"]) {
      const bool has_constraints = !of_case["space"]["constraints"].empty();
      not_compared.emplace_back(has_constraints ? "the case's space with its constraints" : "the case's space");
      problem["space"] = of_case["space"];
    }
    if (holds_for_rows(problem, of_case)) problem["time"]["rows"] = of_case["time"]["rows"];
  }
  if (problem != of_case) throw Rejected("the certificate is about another problem");
  return not_compared;
}

/// Waypoints are the same bit for bit; but poses beside lengths of cables only say in which assembly the robot is.
bool is_same(Law law, const Waypoint& waypoint, const ExpectedPath::Row& expected) {
  if (law != Law::kCableLengths) {
    return waypoint.x == expected.x && (has_poses(law) || waypoint.half_turns == expected.half_turns);
  }
  constexpr std::size_t kPose = 7;  // px, py, pz, qx, qy, qz, qw; then the lengths
  constexpr double kSameAssembly = 1e-6;
  const auto is_near = [&](int sign) {  // q and -q are one pose
    for (std::size_t i = 0; i < kPose; ++i) {
      const double other = i < 3 ? expected.x[i] : sign * expected.x[i];
      if (!(std::abs(waypoint.x[i] - other) <= kSameAssembly)) return false;
    }
    return true;
  };
  return waypoint.x.size() == expected.x.size() &&
         std::equal(waypoint.x.begin() + kPose, waypoint.x.end(), expected.x.begin() + kPose) &&
         (is_near(1) || is_near(-1));
}

/// Both were computed in floating point, on machines that may round differently.
bool has_normals(const Waypoint& waypoint, const ExpectedPath::Row& expected) {
  constexpr double kRounding = 1e-9;  // of columns of length 1
  return std::ranges::equal(waypoint.normals, expected.normals,
                            [](double a, double b) { return std::abs(a - b) <= kRounding; });
}

const char* name(Law law) { return std::ranges::find(kLaws, law, &std::pair<const char*, Law>::second)->first; }

/// The certificate's path is the file's: its law, its waypoints and, where either names the other, its digest.
void require_path(const Certificate& certificate, const std::string& sha256, const ExpectedPath& file) {
  const Path& path = certificate.path;
  const auto require = [&](bool holds, const std::string& what) {
    if (!holds) throw Rejected("the path is not that of " + file.name + ": " + what);
  };
  const bool is_source = certificate.source && certificate.source->sha256 == file.sha256;
  require(file.certificate_sha256.empty() || file.certificate_sha256 == sha256 || is_source,
          "the file names another certificate's SHA-256");
  const bool is_fitted = path.timing && path.law == Law::kCubicBSpline && file.law != path.law && is_source;
  require(!is_fitted,
          "the certificate is about a move that was fitted to this file's rows, which are no points of it: compare the "
          "path.csv beside the certificate");
  require(path.law == file.law,
          std::string("the certificate's interpolation is ") + name(path.law) + ", the file's is " + name(file.law));
  require(certificate.problem_json["space"] == file.space,
          "the certificate's parameters are not those of the file's rows");
  const bool stays = file.waypoints.size() == 1 && path.waypoints.size() == 2;  // a segment that stays at one pose
  require(path.waypoints.size() == file.waypoints.size() || stays,
          "the certificate has " + std::to_string(path.waypoints.size()) + " waypoints, the file has " +
              std::to_string(file.waypoints.size()));
  for (std::size_t k = 0; k < path.waypoints.size(); ++k) {
    const ExpectedPath::Row& row = file.waypoints[stays ? 0 : k];
    const std::string line = "line " + std::to_string(row.line) + " of the file";
    require(is_same(path.law, path.waypoints[k], row), "waypoint " + std::to_string(k) + " differs from " + line);
    require(has_normals(path.waypoints[k], row),
            "the normals of waypoint " + std::to_string(k) + " are not those of the constraints at " + line);
  }
  require(!file.certificate_sha256.empty() || !certificate.source || is_source,
          "the file that was audited has another SHA-256");
}

std::string plural(std::size_t n, const std::string& what) {
  return std::to_string(n) + " " + what + (n == 1 ? "" : what == "box" || what == "stretch" ? "es" : "s");
}

/// What a file says may be printed on a terminal and searched by scripts: here it is one line of printable ASCII, with
/// \xNN for any other byte.
std::string printable(const std::string& text) {
  std::string result;
  for (const char c : text) {
    result += c >= ' ' && c <= '~' ? std::string(1, c) : fmt::format("\\x{:02x}", static_cast<unsigned char>(c));
  }
  return result;
}

/// "300 s", "less than 1 ms": no exponents, which only programmers read.
std::string duration(double seconds) {
  constexpr double kLeast = 1e-3;
  constexpr double kMost = 1e9;
  if (seconds < kLeast) return "less than 1 ms";
  if (seconds > kMost) return "more than 30 years";
  return seconds < 1 ? fmt::format("{:.3g} s", seconds) : fmt::format("{:.10g} s", seconds);
}

/// What was read, for whoever shows it.
void keep(const std::string& bytes, const CheckOptions& options, CheckResult& result) {
  if (!options.keeps_certificate) return;
  result.certificate = std::make_shared<const nlohmann::json>(nlohmann::json::parse(bytes));
}

/// "; only the surface of rock.stl was checked, a mesh without an inside", or nothing.
std::string describe_open_meshes(const Problem& problem) {
  if (!problem.bodies) return "";
  std::set<std::string> files;
  for (const auto* list : {&problem.bodies->platform, &problem.bodies->obstacles}) {
    for (const RigidBody& body : *list) {
      const auto* mesh = std::get_if<MeshShape>(&body.shape);
      if (mesh == nullptr || mesh->surface == nullptr || mesh->surface->is_closed()) continue;
      files.insert(printable(mesh->file));
    }
  }
  if (files.empty()) return "";
  return fmt::format("; only the surface of {} was checked, {} without an inside", fmt::join(files, ", "),
                     files.size() == 1 ? "a mesh" : "meshes");
}

std::string describe_accepted(const Certificate& certificate, const CheckResult& result) {
  const std::string audit = certificate.problem.query.empty() ? "an audit, " : "";
  const std::string kind = audit + (certificate.path.timing ? "a move, " : "");
  const std::string boxes = plural(result.counts.boxes, "box");
  const int bits = result.counts.bits;
  if (certificate.verdict == Verdict::kProved) {
    const auto& [tension, length, scale, clearance] = certificate.margins;
    const std::size_t pairs = certificate.problem.bodies ? certificate.problem.bodies->pairs.size() : 0;
    const std::string apart =
        pairs == 0 ? "" : fmt::format(", clearance margin >= {} m of {}", clearance, plural(pairs, "pair"));
    const std::string growth =
        certificate.path.timing ? ", limits in time kept" : fmt::format(", wrench scale >= {}", scale);
    return fmt::format("{}proved again: {}, {}, tension margin >= {} N, length margin >= {} m{}{}; {} bits", kind,
                       plural(result.counts.segments, "segment"), boxes, tension, length, growth, apart, bits);
  }
  const std::string refuted = kind + "refuted again: the witness is confirmed";
  const std::size_t stretches = certificate.stretch_texts.size();
  if (stretches == 0) return fmt::format("{}; {} bits", refuted, bits);
  std::size_t open = 0;
  for (std::size_t i = 0; i < stretches; ++i) open += certificate.stretch(i).inner.empty() ? 1 : 0;
  const std::string listed = fmt::format("{}, {} ({} open)", refuted, plural(stretches, "stretch"), open);
  if (!is_implied(certificate.problem, certificate.path)) {
    return fmt::format("{}, and nothing outside of them: {}; {} bits", listed, boxes, bits);
  }
  return fmt::format(
      "{}, and no violation outside of them at the poses in the stated tubes, which the motion is shown to pass up to "
      "the witness: {}; {} bits",
      listed, boxes, bits);
}

void require_trusted(const CheckOptions& options, CheckResult& result) {
  result.is_trusted = std::ranges::find(options.trusted, result.signer) != options.trusted.end();
  if (!options.trusted.empty() && !result.is_trusted) {
    throw Rejected(result.signer.empty() ? "nobody signed it" : "nobody trusted signed it");
  }
}

/// The problem is that of one of the case's legs.
std::vector<std::string> require_leg(const nlohmann::json& problem, const nlohmann::json& of_case, bool is_no_path) {
  for (const nlohmann::json& leg : of_case) {
    if (problem["name"] != leg["name"]) continue;
    std::vector<std::string> not_compared = require_problem(problem, leg, is_no_path);
    not_compared.emplace_back("the case's other legs");
    return not_compared;
  }
  throw Rejected("the certificate is about none of the case's legs");
}

void require_case(const nlohmann::json& problem, bool is_no_path, const CheckOptions& options, CheckResult& result) {
  if (options.problem == nullptr) {
    result.not_compared.emplace_back("case");
  } else if (options.problem->is_array()) {
    result.not_compared = require_leg(problem, *options.problem, is_no_path);
  } else {
    result.not_compared = require_problem(problem, *options.problem, is_no_path);
  }
}

void require_verdict(Theorem::Verdict verdict, const CheckOptions& options) {
  if (!options.expect || *options.expect == verdict) return;
  throw Rejected(std::string("the certificate says ") + name(verdict) + ", expected " + name(*options.expect));
}

Theorem::Verdict theorem_verdict(Verdict verdict) {
  return verdict == Verdict::kProved ? Theorem::Verdict::kProved : Theorem::Verdict::kRefuted;
}

/// Signer, case, path file and verdict are those that were asked for.
void require_asked_for(const Certificate& certificate, const CheckOptions& options, CheckResult& result) {
  require_trusted(options, result);
  require_case(certificate.problem_json, false, options, result);
  if (options.path != nullptr) {
    require_path(certificate, result.sha256, *options.path);
    if (certificate.path.timing) result.not_compared.emplace_back("the path's law in time");
  } else {
    result.not_compared.emplace_back("path file");
  }
  if (certificate.verdict != Verdict::kUndecided) require_verdict(theorem_verdict(certificate.verdict), options);
}

/// How to confirm, with a budget that began at `start`.
ConfirmOptions confirm_options(const CheckOptions& options, std::chrono::steady_clock::time_point start) {
  if (options.max_seconds && *options.max_seconds <= 0) throw Interrupted("no time");
  ConfirmOptions result;
  result.threads = options.threads > 0 ? options.threads : std::max(1U, std::thread::hardware_concurrency());
  result.before_box = [&options, start] {
    const std::chrono::duration<double> used = std::chrono::steady_clock::now() - start;
    const bool is_over = options.max_seconds && used.count() >= *options.max_seconds;
    if (is_over || options.stop.stop_requested()) throw Interrupted("interrupted");
  };
  return result;
}

/// Takes the meshes that the problem names. @throws Rejected where one is not supplied
void supply_meshes(Problem& problem, const CheckOptions& options, CheckResult& result) {
  if (!problem.bodies) return;
  // By name and digest: how bytes are read depends on the name, too.
  std::map<std::pair<std::string, std::string>, std::shared_ptr<const Surface>> known;
  for (auto* bodies : {&problem.bodies->platform, &problem.bodies->obstacles}) {
    for (RigidBody& body : *bodies) {
      auto* const mesh = std::get_if<MeshShape>(&body.shape);
      if (mesh == nullptr) continue;
      std::shared_ptr<const Surface>& surface = known[{mesh->file, mesh->sha256}];
      if (surface == nullptr) {
        const std::string name = "the mesh " + mesh->file;
        if (!options.meshes) throw Rejected(name + " was not supplied");
        SuppliedMesh supplied = options.meshes(mesh->file, mesh->sha256);
        if (supplied.sha256 != mesh->sha256) throw Rejected(name + " is another one: its SHA-256 differs");
        if (options.keeps_certificate) result.meshes.push_back(supplied);
        try {
          surface = std::make_shared<const Surface>(std::move(supplied.points), std::move(supplied.triangles),
                                                    supplied.needles);
        } catch (const Undefined& error) {
          throw Rejected(name + ": " + error.what());
        }
      }
      mesh->surface = surface;
    }
  }
}

using TimePoint = std::chrono::steady_clock::time_point;

/// @returns what is proved; nothing where the certificate claims nothing
std::optional<Theorem::Verdict> check_path(const std::string& bytes, Outline outline, const CheckOptions& options,
                                           TimePoint start, CheckResult& result) {
  Certificate certificate = read_certificate(std::move(outline));
  keep(bytes, options, result);
  result.signer = certificate.signer;
  result.is_audit = certificate.problem.query.empty();
  result.counts = {certificate.segment_texts.size(), certificate.boxes, 0};
  require_asked_for(certificate, options, result);
  if (options.meshes) supply_meshes(certificate.problem, options, result);
  if (certificate.verdict == Verdict::kUndecided) {
    result.outcome = Outcome::kUndecided;
    result.message = "the certificate claims nothing: " + printable(certificate.undecided_reason);
    return std::nullopt;
  }
  const ConfirmOptions how = confirm_options(options, start);
  if (!options.meshes) supply_meshes(certificate.problem, options, result);
  result.counts = confirm(certificate, how);
  result.message = describe_accepted(certificate, result) + describe_open_meshes(certificate.problem);
  return theorem_verdict(certificate.verdict);
}

Theorem::Verdict check_no_path(const std::string& bytes, Outline outline, const CheckOptions& options, TimePoint start,
                               CheckResult& result) {
  const NoPathCertificate certificate = read_no_path(std::move(outline));
  keep(bytes, options, result);
  result.signer = certificate.signer;
  require_trusted(options, result);
  require_case(certificate.problem_json, true, options, result);
  if (options.path != nullptr) throw Rejected("it is about no path, but about all that might lead to a waypoint");
  require_verdict(Theorem::Verdict::kNoPath, options);
  result.counts = confirm(certificate, confirm_options(options, start));
  result.message = fmt::format(
      "proved again: no path exists from waypoint {} of the query to waypoint {}; {} without "
      "a feasible pose part them; {} bits",
      certificate.from, certificate.from + 1, plural(result.counts.boxes, "cell"), result.counts.bits);
  return Theorem::Verdict::kNoPath;
}

/// The legs' problems are those of the case's legs, in their order.
void require_case_of_legs(const LegsCertificate& certificate, const CheckOptions& options, CheckResult& result) {
  if (options.path != nullptr) throw Rejected("it is about several legs: compare a path file with a leg's certificate");
  if (options.problem == nullptr) {
    result.not_compared.emplace_back("case");
    return;
  }
  const nlohmann::json& of_case = *options.problem;
  if (!of_case.is_array()) throw Rejected("the certificate is about legs, and the case has none");
  if (of_case.size() != certificate.legs.size()) {
    throw Rejected(
        fmt::format("the certificate has {}, the case has {}", plural(certificate.legs.size(), "leg"), of_case.size()));
  }
  for (std::size_t k = 0; k < of_case.size(); ++k) {
    if (certificate.legs[k].certificate.problem_json == of_case[k]) continue;
    throw Rejected(fmt::format("leg {} is about another problem than the case's", k + 1));
  }
}

/// How each leg is checked by itself, with what is left of the budget. The whole is what was asked for and signed.
CheckOptions leg_options(const CheckOptions& options, TimePoint start) {
  CheckOptions result = options;
  result.problem = nullptr;
  result.expect.reset();
  result.trusted.clear();
  if (options.max_seconds) {
    const std::chrono::duration<double> used = std::chrono::steady_clock::now() - start;
    result.max_seconds = std::max(0.0, *options.max_seconds - used.count());
  }
  return result;
}

/// Checks the legs, one after the other, and adds their results up.
/// @returns what is proved; nothing where the outcome is another than accepted
std::optional<Theorem::Verdict> check_legs(const std::string& bytes, const Outline& outline,
                                           const CheckOptions& options, TimePoint start, CheckResult& result) {
  const LegsCertificate certificate = read_legs(outline);
  keep(bytes, options, result);
  result.signer = certificate.signer;
  require_trusted(options, result);
  require_case_of_legs(certificate, options, result);
  if (certificate.verdict != Verdict::kUndecided) require_verdict(theorem_verdict(certificate.verdict), options);
  require_one_machine(certificate);
  if (certificate.verdict == Verdict::kProved) require_joined(certificate);
  std::optional<std::size_t> unchecked, undecided;
  for (const Leg& leg : certificate.legs) {
    const std::size_t k = result.legs.size();
    const CheckResult& checked = result.legs.emplace_back(check(std::string(leg.text), leg_options(options, start)));
    result.counts.segments += checked.counts.segments;
    result.counts.boxes += checked.counts.boxes;
    result.counts.bits = std::max(result.counts.bits, checked.counts.bits);
    switch (checked.outcome) {
      case Outcome::kAccepted: break;
      case Outcome::kUndecided:
        if (!undecided) undecided = k;
        break;
      case Outcome::kUnchecked:
        if (!unchecked) unchecked = k;
        break;
      case Outcome::kRejected:
      case Outcome::kMalformed: throw Rejected(fmt::format("leg {}: {}", k + 1, checked.message));
    }
  }
  if (unchecked) {
    result.outcome = Outcome::kUnchecked;
    result.message = fmt::format("leg {}: {}", *unchecked + 1, result.legs[*unchecked].message);
    return std::nullopt;
  }
  if (certificate.verdict == Verdict::kUndecided) {
    result.outcome = Outcome::kUndecided;
    result.message = fmt::format("leg {}: {}", undecided.value() + 1, result.legs[*undecided].message);
    return std::nullopt;
  }
  const std::string bits = fmt::format("{} bits", result.counts.bits);
  if (certificate.verdict == Verdict::kRefuted) {
    const std::size_t k = certificate.first_refuted;
    if (result.legs.at(k).outcome != Outcome::kAccepted) throw Rejected(fmt::format("leg {}: not refuted", k + 1));
    result.message = fmt::format("leg {} of {}: {}", k + 1, certificate.legs.size(), result.legs[k].message);
    return Theorem::Verdict::kRefuted;
  }
  if (undecided) throw Rejected(fmt::format("leg {}: not proved", *undecided + 1));
  result.message =
      fmt::format("proved again: {}{}, each from the pose where the last one ends, {}, {}; {}",
                  plural(certificate.legs.size(), "leg"), certificate.legs[0].certificate.path.timing ? ", moves" : "",
                  plural(result.counts.segments, "segment"), plural(result.counts.boxes, "box"), bits);
  return Theorem::Verdict::kProved;
}

}  // namespace

const char* name(Theorem::Verdict verdict) {
  constexpr std::array<const char*, 3> kNames = {"proved", "refuted", "no path"};
  return kNames.at(static_cast<std::size_t>(verdict));
}

const char* name(Outcome outcome) {
  constexpr std::array<const char*, 5> kNames = {"accepted", "rejected", "undecided", "unchecked", "malformed"};
  return kNames.at(static_cast<std::size_t>(outcome));
}

std::string sha256(const std::string& bytes) {
  Sha256 digest;
  digest.update(bytes);
  return digest.hex();
}

CheckResult check(const std::string& bytes, const CheckOptions& options) {
  const auto start = std::chrono::steady_clock::now();
  CheckResult result;
  result.sha256 = sha256(bytes);
  try {
    Outline outline = read_json(bytes);
    const bool is_no_path = outline.json.is_object() && outline.json.value("format", nlohmann::json()) == kNoPathFormat;
    const std::optional<Theorem::Verdict> verdict =
        is_no_path            ? check_no_path(bytes, std::move(outline), options, start, result)
        : is_of_legs(outline) ? check_legs(bytes, outline, options, start, result)
                              : check_path(bytes, std::move(outline), options, start, result);
    if (!verdict) return result;
    result.theorem = Theorem(*verdict, result.certificate, result.sha256, result.counts);
    result.outcome = Outcome::kAccepted;
  } catch (const Malformed& error) {
    result.outcome = Outcome::kMalformed;
    result.message = printable(error.what());
  } catch (const Rejected& error) {
    result.outcome = Outcome::kRejected;
    result.message = printable(error.what());
  } catch (const Interrupted&) {
    if (options.stop.stop_requested()) throw;
    result.outcome = Outcome::kUnchecked;
    const double seconds = options.max_seconds.value_or(0);
    result.message = seconds > 0 ? fmt::format("the budget of {} ran out before all was proved", duration(seconds))
                                 : "nothing was proved, as no time was allowed for it";
  }
  return result;
}

}  // namespace taut::checker
