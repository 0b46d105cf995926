// SPDX-License-Identifier: GPL-3.0-or-later
#include "case/leg_entries.h"

#include <fmt/format.h>

#include <algorithm>

namespace taut::case_fields {

bool is_in_leg(const YAML::Node& entry, const std::string& leg) {
  if (!entry.IsMap()) return true;
  const YAML::Node legs = entry["legs"];
  return !legs || std::any_of(legs.begin(), legs.end(), [&](const YAML::Node& name) { return name.Scalar() == leg; });
}

void require_legs_of_entry(const Field& entry, const std::string& noun, const std::vector<std::string>& legs) {
  if (!entry.node().IsMap()) return;  // its reader complains
  const auto stated = entry.open_map(noun).find("legs");
  if (!stated) return;
  const std::string expected = "a list of one or more of " + join(legs);
  std::vector<std::string> seen;
  for (const Field& leg : stated->list(expected)) {
    const std::string name = leg.text(expected);
    if (std::ranges::find(legs, name) == legs.end()) leg.fail("one of the legs " + join(legs));
    if (std::ranges::find(seen, name) != seen.end()) {
      leg.complain(fmt::format("got '{}' twice, expected each leg once", name));
    }
    seen.push_back(name);
  }
  if (seen.empty()) stated->complain(fmt::format("got {} of no leg, expected {}", noun, expected));
}

void keep_entries_of_leg(YAML::Node list, const std::string& leg) {
  if (!list.IsSequence()) return;
  for (std::size_t i = list.size(); i-- > 0;) {
    if (!is_in_leg(list[i], leg)) {
      list.remove(i);
    } else if (list[i].IsMap()) {
      list[i].remove("legs");
    }
  }
}

}  // namespace taut::case_fields
