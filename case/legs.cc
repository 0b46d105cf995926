// SPDX-License-Identifier: GPL-3.0-or-later
#include "case/legs.h"

#include <algorithm>

#include "base/sanitize.h"
#include "case/leg_bodies.h"
#include "case/leg_entries.h"
#include "problem/decimal.h"

namespace taut::case_fields {
namespace {

constexpr std::size_t kLeastLegs = 2;
constexpr std::size_t kMostLegs = 64;
constexpr std::size_t kMaxName = 40;
constexpr const char* kNameExpected = "a name of 1 to 40 letters, digits, '-' and '_', the first a letter or a digit";
constexpr const char* kLegsExpected = "a list of 2 to 64 legs such as {name: fetch, waypoints: [{px: 0}, {px: 1}]}";

std::string read_name(const Field& field) {
  const std::string name = field.text(kNameExpected);
  const auto is_letter = [](char c) {
    return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || (c >= '0' && c <= '9');
  };
  const bool is_fit = std::ranges::all_of(name, [&](char c) { return is_letter(c) || c == '-' || c == '_'; });
  if (!is_fit || !is_letter(name[0]) || name.size() > kMaxName) field.fail(kNameExpected);
  return name;
}

void refuse_what_has_no_legs(const Map& root) {
  const auto refuse = [](const std::optional<Field>& field, const std::string& what) {
    if (field)
      field->complain(fmt::format("got {} beside 'query.legs', expected none: legs do not have them yet", what));
  };
  refuse(root.find("audit"), "a path to be audited");
  if (const auto space = root.find("space"); space && space->node().IsMap()) {
    refuse(space->open_map("a space").find("implicit"), "constraints");
  }
  if (const auto load = root.find("load"); load && load->node().IsMap()) {
    const auto ellipsoid = load->open_map("a load").find("ellipsoid");
    if (ellipsoid && ellipsoid->node().IsScalar()) refuse(ellipsoid, "an ellipsoid around items");
  }
}

bool are_equal(const ExpressionText& a, const ExpressionText& b) {
  if (a == b) return true;
  return is_decimal(a) && is_decimal(b) && Decimal::parse(a) == Decimal::parse(b);
}

}  // namespace

bool has_legs(const YAML::Node& root) {
  if (!root.IsMap()) return false;
  const YAML::Node query = root["query"];
  return query && query.IsMap() && query["legs"];
}

std::vector<std::string> read_legs(const Field& root) {
  const Map map = root.open_map("a case");
  const Field list = map.at("query").map({"legs"}).at("legs");
  const std::vector<Field> legs = list.list(kLegsExpected);
  if (legs.size() < kLeastLegs || legs.size() > kMostLegs) list.fail(kLegsExpected);
  std::vector<std::string> names;
  for (const Field& leg : legs) {
    const Map entries = leg.map({"name", "waypoints"});
    const Field field = entries.at("name");
    const std::string name = read_name(field);
    if (std::ranges::find(names, name) != names.end()) {
      field.complain(fmt::format("got '{}' twice, expected a name of its own for each leg", name));
    }
    names.push_back(name);
    const Field waypoints = entries.at("waypoints");
    if (waypoints.list("a list of at least two waypoints").size() < 2)
      waypoints.fail("a list of at least two waypoints");
  }
  refuse_what_has_no_legs(map);
  require_legs_of_bodies(map, names);
  const auto load = map.find("load");
  if (!load || !load->node().IsMap()) return names;  // its reader complains
  const auto items = load->open_map("a load").find("items");
  if (!items || !items->node().IsSequence()) return names;
  const std::vector<Field> all = items->list("a list of items");
  for (const Field& item : all) require_legs_of_entry(item, "an item", names);
  for (std::size_t k = 0; k < names.size(); ++k) {
    if (std::ranges::any_of(all, [&](const Field& item) { return is_in_leg(item.node(), names[k]); })) continue;
    legs[k].complain(fmt::format("got no item of the load in the leg '{}', expected at least one", names[k]));
  }
  return names;
}

void keep_leg(YAML::Node& root, const std::vector<std::string>& names, std::size_t k) {
  YAML::Node query = root["query"];
  const YAML::Node waypoints = query["legs"][k]["waypoints"];
  query.remove("legs");
  query["waypoints"] = waypoints;
  keep_bodies_of_leg(root, names[k], names);
  const YAML::Node load = root["load"];
  if (load.IsMap() && load["items"]) keep_entries_of_leg(load["items"], names[k]);
}

void require_joined(const Field& root, const std::vector<CaseLeg>& legs) {
  const std::vector<Field> fields = root.open_map("a case").at("query").map({"legs"}).at("legs").list(kLegsExpected);
  for (std::size_t k = 1; k < legs.size(); ++k) {
    const Problem& problem = legs[k].content.problem;
    const std::vector<ExpressionText>& last = legs[k - 1].content.problem.query.back();
    const std::vector<ExpressionText>& first = problem.query.front();
    for (std::size_t j = 0; j < first.size(); ++j) {
      if (are_equal(last[j], first[j])) continue;
      const std::string& name = problem.space.parameters[j].name;
      fields[k]
          .map({"name", "waypoints"})
          .at("waypoints")
          .list("waypoints")
          .front()
          .open_map("a waypoint")
          .at(name)
          .fail(fmt::format("{} as the leg before it ends, in the same words", name));
    }
  }
}

}  // namespace taut::case_fields
