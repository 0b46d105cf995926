// SPDX-License-Identifier: GPL-3.0-or-later
#include "checker/check.h"

#include <openssl/evp.h>

#include <algorithm>
#include <array>
#include <chrono>
#include <cmath>
#include <condition_variable>
#include <cstdio>
#include <functional>
#include <mutex>
#include <thread>

#include "checker/confirm.h"
#include "checker/format/parts.h"

namespace taut::checker {
namespace {

/// The certificate's problem is the case's. In an audit the path is what was asked about: so the case's query does not
/// matter, nor its space where the path goes through the free coordinates.
/// @returns what of the case was not compared
std::vector<std::string> require_problem(const std::string& text, const nlohmann::json& of_case) {
  nlohmann::json problem = nlohmann::json::parse(text);
  std::vector<std::string> not_compared;
  if (problem["query"]["waypoints"].empty()) {
    if (problem["query"] != of_case["query"]) not_compared.emplace_back("the case's query");
    problem["query"] = of_case["query"];
    if (problem["space"] == coordinate_space() && problem["space"] != of_case["space"]) {
      const bool has_constraints = !of_case["space"]["constraints"].empty();
      not_compared.emplace_back(has_constraints ? "the case's space with its constraints" : "the case's space");
      problem["space"] = of_case["space"];
    }
  }
  if (problem != of_case) throw Rejected("the certificate is about another problem");
  return not_compared;
}

bool is_same(const Path& path, const Waypoint& waypoint, const ExpectedPath::Waypoint& expected) {
  if (path.law != Law::kCableLengths) {
    return waypoint.x == expected.x && (has_poses(path.law) || waypoint.half_turns == expected.half_turns);
  }
  constexpr std::size_t kPose = 7;  // px, py, pz, qx, qy, qz, qw; then the lengths
  constexpr double kSameAssembly = 1e-6;
  if (waypoint.x.size() != expected.x.size() ||
      !std::equal(waypoint.x.begin() + kPose, waypoint.x.end(), expected.x.begin() + kPose)) {
    return false;
  }
  const auto is_near = [&](int sign) {  // q and -q are one pose
    for (std::size_t i = 0; i < kPose; ++i) {
      const double other = i < 3 ? expected.x[i] : sign * expected.x[i];
      if (!(std::abs(waypoint.x[i] - other) <= kSameAssembly)) return false;
    }
    return true;
  };
  return is_near(1) || is_near(-1);
}

const char* name(Law law) {
  switch (law) {
    case Law::kStraight: return "straight-in-parameters";
    case Law::kCubicBSpline: return "cubic-b-spline";
    case Law::kGeodesic: return "geodesic";
    case Law::kCableLengths: break;
  }
  return "straight-in-cable-lengths";
}

/// The certificate's path is the file's: its law, its waypoints and, where either names the other, its digest.
void require_path(const Certificate& certificate, const std::string& sha256, const ExpectedPath& file) {
  const Path& path = certificate.path;
  const auto fail = [&](const std::string& what) {
    throw Rejected("the path is not that of " + file.name + ": " + what);
  };
  if (!file.certificate_sha256.empty() && file.certificate_sha256 != sha256) {
    fail("the file names another certificate's SHA-256");
  }
  const std::string law = name(path.law);
  if (law != file.interpolation) {
    fail("the certificate's interpolation is " + law + ", the file's is " + file.interpolation);
  }
  const bool stays = file.waypoints.size() == 1 && path.waypoints.size() == 2;  // a segment that stays at one pose
  if (path.waypoints.size() != file.waypoints.size() && !stays) {
    fail("the certificate has " + std::to_string(path.waypoints.size()) + " waypoints, the file has " +
         std::to_string(file.waypoints.size()));
  }
  for (std::size_t k = 0; k < path.waypoints.size(); ++k) {
    const ExpectedPath::Waypoint& expected = file.waypoints[stays ? 0 : k];
    if (is_same(path, path.waypoints[k], expected)) continue;
    fail("waypoint " + std::to_string(k) + " differs from " + expected.place + " of the file");
  }
  if (file.certificate_sha256.empty() && certificate.source && certificate.source->sha256 != file.sha256) {
    fail("the file that was audited has another SHA-256");
  }
}

/// Asks to stop where the caller does, and when the time is up.
class Budget {
 public:
  Budget(const std::stop_token& caller, std::optional<double> seconds)
      : on_caller_(caller, [this] { source_.request_stop(); }) {
    if (!seconds) return;
    constexpr double kLongest = 1e9;  // [s]: a clock counts no more than some centuries
    const auto allowed = std::chrono::duration_cast<std::chrono::milliseconds>(
        std::chrono::duration<double>(std::min(*seconds, kLongest)));
    timer_ = std::jthread([this, allowed](const std::stop_token& finished) {
      std::mutex mutex;
      std::unique_lock lock(mutex);
      std::condition_variable_any never;
      never.wait_for(lock, finished, allowed, [] { return false; });
      if (!finished.stop_requested()) source_.request_stop();
    });
  }
  [[nodiscard]] std::stop_token token() const { return source_.get_token(); }

 private:
  std::stop_source source_;
  std::stop_callback<std::function<void()>> on_caller_;
  std::jthread timer_;  // last: joins before the rest goes
};

std::string seconds_text(double seconds) {
  char text[32];
  std::snprintf(text, sizeof text, "%g s", seconds);
  return text;
}

std::string plural(std::size_t n, const std::string& what) {
  return std::to_string(n) + " " + what + (n == 1 ? "" : what == "box" || what == "stretch" ? "es" : "s");
}

/// What a file says may be printed on a terminal and searched by scripts: here it is one line of printable ASCII, with
/// \xNN for any other byte.
std::string printable(const std::string& text) {
  std::string result;
  for (const char c : text) {
    if (c >= ' ' && c <= '~') {
      result += c;
      continue;
    }
    const auto byte = static_cast<unsigned char>(c);
    result += {'\\', 'x', "0123456789abcdef"[byte >> 4U], "0123456789abcdef"[byte & 15U]};
  }
  return result;
}

std::string describe_accepted(const Certificate& certificate, const CheckResult& result) {
  const std::string bits = "; " + std::to_string(result.counts.bits) + " bits";
  const std::string audit = certificate.problem.query.empty() ? "an audit, " : "";
  const std::string boxes = plural(result.counts.boxes, "box");
  if (certificate.verdict == Verdict::kRefuted) {
    const std::string refuted = audit + "refuted again: the witness is confirmed";
    const std::size_t stretches = certificate.stretch_texts.size();
    if (stretches == 0) return refuted + bits;
    std::size_t open = 0;
    for (std::size_t i = 0; i < stretches; ++i) open += certificate.stretch(i).inner.empty() ? 1 : 0;
    return refuted + ", " + plural(stretches, "stretch") + " (" + std::to_string(open) +
           " open), and nothing outside of them: " + boxes + bits;
  }
  return audit + "proved again: " + plural(result.counts.segments, "segment") + ", " + boxes +
         ", tension margin >= " + certificate.margins[0] + " N, length margin >= " + certificate.margins[1] +
         " m, wrench scale >= " + certificate.margins[2] + bits;
}

/// Signer, case, path file and verdict are those that were asked for.
void require_asked_for(const Certificate& certificate, const CheckOptions& options, CheckResult& result) {
  result.is_trusted = std::ranges::find(options.trusted, result.signer) != options.trusted.end();
  if (!options.trusted.empty() && !result.is_trusted) {
    throw Rejected(result.signer.empty() ? "nobody signed it" : "nobody trusted signed it");
  }
  if (options.problem != nullptr) {
    result.not_compared = require_problem(certificate.problem_json, *options.problem);
  } else {
    result.not_compared.emplace_back("case");
  }
  if (options.path != nullptr) {
    require_path(certificate, result.sha256, *options.path);
  } else {
    result.not_compared.emplace_back("path file");
  }
  if (!options.expect || certificate.verdict == Verdict::kUndecided) return;
  const bool expects_proved = *options.expect == Theorem::Verdict::kProved;
  if (expects_proved != (certificate.verdict == Verdict::kProved)) {
    throw Rejected(std::string("the certificate says ") +
                   (expects_proved ? "refuted, expected proved" : "proved, expected refuted"));
  }
}

}  // namespace

const char* name(Outcome outcome) {
  switch (outcome) {
    case Outcome::kAccepted: return "accepted";
    case Outcome::kRejected: return "rejected";
    case Outcome::kUndecided: return "undecided";
    case Outcome::kUnchecked: return "unchecked";
    case Outcome::kMalformed: break;
  }
  return "malformed";
}

std::string sha256(const std::string& bytes) {
  std::array<unsigned char, EVP_MAX_MD_SIZE> digest{};
  unsigned int size = 0;
  if (EVP_Digest(bytes.data(), bytes.size(), digest.data(), &size, EVP_sha256(), nullptr) != 1) {
    throw std::runtime_error("SHA-256 is not available");
  }
  std::string hex;
  for (unsigned int i = 0; i < size; ++i) {
    hex += "0123456789abcdef"[digest[i] >> 4U];
    hex += "0123456789abcdef"[digest[i] & 15U];
  }
  return hex;
}

CheckResult check(const std::string& bytes, const CheckOptions& options) {
  const Budget budget(options.stop, options.max_seconds);
  CheckResult result;
  result.sha256 = sha256(bytes);
  try {
    const Certificate certificate = read_certificate(bytes);
    if (options.keeps_certificate) {
      result.certificate = std::make_shared<const nlohmann::json>(nlohmann::json::parse(bytes));
    }
    result.signer = certificate.signer;
    result.is_audit = certificate.problem.query.empty();
    result.counts = {certificate.segment_texts.size(), certificate.boxes, 0};
    require_asked_for(certificate, options, result);
    if (certificate.verdict == Verdict::kUndecided) {
      result.outcome = Outcome::kUndecided;
      result.message = "the certificate claims nothing: " + printable(certificate.undecided_reason);
      return result;
    }
    if (options.max_seconds && *options.max_seconds <= 0) throw Interrupted("no time");
    ConfirmOptions confirm_options;
    confirm_options.threads = options.threads > 0 ? options.threads : std::max(1U, std::thread::hardware_concurrency());
    confirm_options.before_box = [stop = budget.token()] {
      if (stop.stop_requested()) throw Interrupted("interrupted");
    };
    result.counts = confirm(certificate, confirm_options);
    result.message = describe_accepted(certificate, result);
    const bool is_proved = certificate.verdict == Verdict::kProved;
    result.theorem = Theorem(is_proved ? Theorem::Verdict::kProved : Theorem::Verdict::kRefuted, result.certificate,
                             result.sha256, result.counts);
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
    result.message = seconds > 0 ? "the budget of " + seconds_text(seconds) + " ran out before all was proved"
                                 : "nothing was proved, as no time was allowed for it";
  }
  return result;
}

}  // namespace taut::checker
