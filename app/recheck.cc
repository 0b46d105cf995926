#include "app/recheck.h"

#include <fmt/chrono.h>
#include <fmt/format.h>

#include <charconv>
#include <chrono>
#include <cstdlib>
#include <ctime>
#include <stdexcept>

#include "base/input_kind.h"
#include "checker/check.h"

namespace taut {

namespace {

/// About.
double recheck_seconds(std::size_t boxes, bool has_tolerances) {
  constexpr double kPerBox = 0.002;            // [s]: a piece takes a millisecond, and a box is two pieces or so
  constexpr double kPerBoxTolerances = 0.050;  // deviations are taken in up to 16 parts
  return static_cast<double>(boxes) * (has_tolerances ? kPerBoxTolerances : kPerBox);
}

}  // namespace

Recheck recheck(const std::string& text, std::size_t boxes, bool has_tolerances, std::optional<bool> wanted,
                const std::stop_token& stop) {
  constexpr double kFewSeconds = 4;
  Recheck result;
  result.checker = fmt::format("taut-check {}", TAUT_VERSION);
  const double seconds = recheck_seconds(boxes, has_tolerances);
  if (!wanted.value_or(seconds <= kFewSeconds)) {
    result.message = wanted ? "as was asked" : fmt::format("it would take about {:.0f} s", seconds);
    return result;
  }
  try {
    const checker::CheckResult checked = checker::check_certificate(text, nullptr, {}, stop);
    result.message = checked.message;
    switch (checked.outcome) {
      case checker::Outcome::kAccepted: result.result = Recheck::Result::kConfirmed; break;
      case checker::Outcome::kUndecided: result.result = Recheck::Result::kNoClaim; break;
      case checker::Outcome::kRejected:
      case checker::Outcome::kMalformed: result.result = Recheck::Result::kRejected; break;
    }
  } catch (const checker::Interrupted&) {
    result.message = "it was interrupted";
  }
  return result;
}

Recheck recheck(const std::string& text, const nlohmann::json& certificate, std::optional<bool> wanted,
                const std::stop_token& stop) {
  const auto at = [&](const char* pointer) {
    const nlohmann::json::json_pointer place(pointer);
    return certificate.contains(place) ? certificate.at(place) : nlohmann::json();
  };
  // Counted: what the footer says of them is the one thing that no digest covers.
  // Where a machine that is held by lengths is led takes as long as a few boxes.
  constexpr std::size_t kOfLed = 6;
  const auto statement = [](const nlohmann::json& witness) {
    return witness.contains(nlohmann::json::json_pointer("/deviation/cable_lengths_m")) ? kOfLed : std::size_t{1};
  };
  std::size_t statements = at("/witness").is_object() ? statement(at("/witness")) : 0;
  for (const nlohmann::json& stretch : at("/stretches")) {
    if (!stretch.is_object() || !stretch.contains("inner") || !stretch["inner"].is_array()) continue;
    for (const nlohmann::json& witness : stretch["inner"]) statements += statement(witness);
  }
  for (const nlohmann::json& segment : at("/segments")) {
    if (segment.is_object() && segment.contains("boxes")) statements += segment["boxes"].size();
  }
  return recheck(text, statements, !at("/problem/tolerances").is_null(), wanted, stop);
}

std::string sentence(const Recheck& recheck) {
  switch (recheck.result) {
    case Recheck::Result::kNotRun: break;
    case Recheck::Result::kConfirmed: return fmt::format("Re-checked by {}: accepted.", recheck.checker);
    case Recheck::Result::kNoClaim:
      return fmt::format("Re-checked by {}: well formed, claims nothing.", recheck.checker);
    case Recheck::Result::kRejected: return fmt::format("REJECTED by {}: {}", recheck.checker, recheck.message);
  }
  return fmt::format("Not re-checked ({}): run taut-check.", recheck.message);
}

nlohmann::json to_json(const Recheck& recheck) {
  const auto name = [&] {
    switch (recheck.result) {
      case Recheck::Result::kNotRun: break;
      case Recheck::Result::kConfirmed: return "confirmed";
      case Recheck::Result::kNoClaim: return "no claim";
      case Recheck::Result::kRejected: return "rejected";
    }
    return "not run";
  };
  return {{"result", name()}, {"checker", recheck.checker}, {"message", recheck.message}};
}

void require_confirmed(const Recheck& recheck) {
  if (recheck.result == Recheck::Result::kRejected) {
    throw std::logic_error(fmt::format("a certificate was made that {} rejects, and nothing was written: {}",
                                       recheck.checker, recheck.message));
  }
}

std::string report_date() {
  std::time_t now = std::chrono::system_clock::to_time_t(std::chrono::system_clock::now());
  if (const char* epoch = std::getenv("SOURCE_DATE_EPOCH"); epoch != nullptr && *epoch != '\0') {
    const std::string_view text = epoch;
    constexpr std::time_t kLatest = 253402300799;  // the end of the year 9999
    const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), now);
    if (error != std::errc() || end != text.data() + text.size() || now < 0 || now > kLatest) {
      throw InputErrorOfKind(InputKind::kUse,
                             fmt::format("SOURCE_DATE_EPOCH: got '{}', expected seconds since 1970", text));
    }
  }
  return fmt::format("{:%Y-%m-%d}", fmt::gmtime(now));
}

}  // namespace taut
