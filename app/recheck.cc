// SPDX-License-Identifier: GPL-3.0-or-later
#include "app/recheck.h"

#include <fmt/format.h>

#include <stdexcept>

namespace taut {
namespace {

constexpr const char* kChecker = "taut-check " TAUT_VERSION;

}  // namespace

checker::CheckResult recheck(const std::string& bytes, double max_seconds, const std::stop_token& stop,
                             const checker::MeshSupplier& meshes) {
  checker::CheckOptions options;
  options.meshes = meshes;
  options.max_seconds = max_seconds;
  options.stop = stop;
  try {
    return checker::check(bytes, options);
  } catch (const checker::Interrupted&) {
    options.max_seconds = 0;  // reads only
    options.stop = {};
    checker::CheckResult result = checker::check(bytes, options);
    result.message = "it was interrupted";
    return result;
  }
}

checker::CheckResult too_long_to_check() {
  checker::CheckResult result;
  result.outcome = checker::Outcome::kUnchecked;
  result.message = fmt::format("the certificate has more than {} MiB: run taut-check", kMostCheckedBytes >> 20U);
  return result;
}

const char* verdict_name(const checker::CheckResult& checked) {
  if (checked.theorem) {
    return checker::name(checked.theorem->verdict());
  }
  return checked.outcome == checker::Outcome::kUndecided ? "undecided" : "unchecked";
}

std::string sentence(const checker::CheckResult& checked) {
  switch (checked.outcome) {
    case checker::Outcome::kAccepted: return fmt::format("Checked by {}: accepted.", kChecker);
    case checker::Outcome::kUndecided: return fmt::format("Checked by {}: well formed, claims nothing.", kChecker);
    case checker::Outcome::kUnchecked: return fmt::format("UNCHECKED by {}: {}.", kChecker, checked.message);
    case checker::Outcome::kRejected: return fmt::format("REJECTED by {}: {}", kChecker, checked.message);
    case checker::Outcome::kMalformed: break;
  }
  return fmt::format("MALFORMED, says {}: {}", kChecker, checked.message);
}

nlohmann::json to_json(const checker::CheckResult& checked) {
  const auto result = [&] {
    switch (checked.outcome) {
      case checker::Outcome::kAccepted: return "confirmed";
      case checker::Outcome::kUndecided: return "no claim";
      case checker::Outcome::kUnchecked: return "unchecked";
      case checker::Outcome::kRejected:
      case checker::Outcome::kMalformed: break;
    }
    return "rejected";
  };
  return {{"result", result()}, {"checker", kChecker}, {"message", checked.message}};
}

void require_confirmed(const checker::CheckResult& checked) {
  if (checked.outcome == checker::Outcome::kRejected || checked.outcome == checker::Outcome::kMalformed) {
    throw std::logic_error(
        fmt::format("a certificate was made that {} rejects, and nothing was written: {}", kChecker, checked.message));
  }
}

}  // namespace taut
