// SPDX-License-Identifier: GPL-3.0-or-later
#include "certificate/legs.h"

#include <algorithm>
#include <nlohmann/json.hpp>
#include <vector>

#include "base/sha256.h"
#include "checker/format/claims.h"
#include "checker/format/legs.h"

namespace taut {
namespace {

using nlohmann::json;

struct Stated {
  std::string verdict, claim;
};

Stated stated_of(const json& legs) {
  const auto is = [](const char* verdict) { return [=](const json& leg) { return leg["verdict"] == verdict; }; };
  if (const auto refuted = std::ranges::find_if(legs, is("refuted")); refuted != legs.end()) {
    const auto number = static_cast<std::size_t>(refuted - legs.begin()) + 1;
    return {"refuted", checker::legs_refuted_claim(legs.size(), number)};
  }
  if (!std::ranges::all_of(legs, is("proved"))) return {"undecided", checker::kLegsUndecidedClaim};
  return {"proved", checker::legs_proved_claim(legs.size(), legs.front()["path"].contains("timing"))};
}

}  // namespace

std::string legs_certificate_text(std::span<const std::string> legs, const SigningKey* key) {
  json of_legs = json::array();
  for (const std::string& leg : legs) of_legs.push_back(json::parse(leg));
  const Stated stated = stated_of(of_legs);
  json whole = {{"claim", stated.claim},
                {"format", "taut-certificate"},
                {"generator", {{"name", "taut"}, {"version", TAUT_VERSION}}},
                {"illustration", nullptr},
                {"legs", std::move(of_legs)},
                {"verdict", stated.verdict},
                {"version", checker::kVersionOfLegs}};
  const std::string digest = sha256(whole);
  whole["footer"] = {{"legs", legs.size()}, {"sha256", digest}};
  if (key != nullptr) whole["signature"] = key->signature(digest);
  whole["legs"] = nullptr;  // takes its bytes instead
  std::string text = "{";
  for (const auto& [name, value] : whole.items()) {  // in the order of their code points
    text += (text.size() > 1 ? ",\n " : "\n ") + json(name).dump() + ": ";
    if (name != "legs") {
      text += value.dump(-1, ' ', true);
      continue;
    }
    text += "[";
    for (std::size_t k = 0; k < legs.size(); ++k) text += (k > 0 ? ",\n" : "\n") + legs[k];
    text += "\n ]";
  }
  return text + "\n}\n";
}

}  // namespace taut
