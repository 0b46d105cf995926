// SPDX-License-Identifier: GPL-3.0-or-later
#include "case/leg_bodies.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <iterator>
#include <map>
#include <optional>
#include <set>

#include "case/leg_entries.h"
#include "problem/bodies.h"

namespace taut::case_fields {
namespace {

constexpr std::array<const char*, 2> kLists = {"platform", "obstacles"};
constexpr std::array<const char*, 2> kPairLists = {"pair_clearances", "contacts"};

/// Of each body of the file, by name, the legs in which it is there.
using LegsOfBodies = std::map<std::string, std::set<std::string>>;

LegsOfBodies legs_of_bodies(const YAML::Node& bodies, const std::vector<std::string>& legs) {
  LegsOfBodies result;
  const std::set<std::string> all(legs.begin(), legs.end());
  for (std::size_t i = 0; i < kCables; ++i) result[cable_name(i)] = all;
  for (const char* const key : kLists) {
    const YAML::Node list = bodies[key];
    if (!list || !list.IsSequence()) continue;
    for (const YAML::Node& body : list) {
      if (!body.IsMap() || !body["name"] || !body["name"].IsScalar()) continue;  // its reader complains
      for (const std::string& leg : legs) {
        if (is_in_leg(body, leg)) result[body["name"].Scalar()].insert(leg);
      }
    }
  }
  return result;
}

/// The legs in which both bodies of a pair are; nothing of an entry that names no two bodies of the file.
std::optional<std::set<std::string>> legs_of_pair(const YAML::Node& entry, const LegsOfBodies& legs) {
  if (!entry.IsMap()) return std::nullopt;
  const YAML::Node pair = entry["pair"];
  if (!pair || !is_list_of_scalars(pair) || pair.size() != 2) return std::nullopt;
  const auto a = legs.find(pair[0].Scalar()), b = legs.find(pair[1].Scalar());
  if (a == legs.end() || b == legs.end()) return std::nullopt;
  std::set<std::string> both;
  std::ranges::set_intersection(a->second, b->second, std::inserter(both, both.end()));
  return both;
}

/// The classes of pairs that have bodies in a leg.
std::set<PairClass> classes_in(const YAML::Node& bodies, const std::string& leg) {
  const auto has = [&](const char* key) {
    const YAML::Node list = bodies[key];
    return list && list.IsSequence() &&
           std::any_of(list.begin(), list.end(), [&](const YAML::Node& body) { return is_in_leg(body, leg); });
  };
  const bool platform = has("platform"), obstacles = has("obstacles"), cables = bodies["cables"].IsDefined();
  std::set<PairClass> result;
  if (platform && obstacles) result.insert(PairClass::kPlatformObstacles);
  if (cables && obstacles) result.insert(PairClass::kCablesObstacles);
  if (cables) result.insert(PairClass::kCablesCables);
  if (cables && platform) result.insert(PairClass::kCablesPlatform);
  return result;
}

std::optional<PairClass> class_of(const YAML::Node& node) {
  if (!node.IsScalar()) return std::nullopt;
  for (const PairClass kind : all_pair_classes()) {
    if (node.Scalar() == name(kind)) return kind;
  }
  return std::nullopt;
}

/// Otherwise the other body of the pair would be called unknown, in a leg that does not have it.
void require_known_names(const Field& entry, const LegsOfBodies& known) {
  if (!entry.node().IsMap()) return;
  const auto pair = entry.open_map("a pair").find("pair");
  if (!pair || !is_list_of_scalars(pair->node())) return;  // its reader complains
  const std::string expected = "the name of a body, or 'cable 1' to 'cable 6'";
  for (const Field& name : pair->list(expected)) {
    if (!known.contains(name.text(expected))) name.fail(expected);
  }
}

}  // namespace

void require_legs_of_bodies(const Map& root, const std::vector<std::string>& legs) {
  const auto field = root.find("bodies");
  if (!field || !field->node().IsMap()) return;  // its reader complains
  const Map bodies = field->open_map("bodies");
  std::set<std::string> names;
  for (const char* const key : kLists) {
    const auto list = bodies.find(key);
    if (!list || !list->node().IsSequence()) continue;
    for (const Field& body : list->list("a list of bodies")) {
      require_legs_of_entry(body, "a body", legs);
      if (!body.node().IsMap()) continue;
      const auto name = body.open_map("a body").find("name");
      if (!name || !name->node().IsScalar() || names.insert(name->node().Scalar()).second) continue;
      name->complain(
          fmt::format("got '{}' twice, expected a name of its own for each body, also where they are in "
                      "different legs",
                      name->text("a name")));
    }
  }
  const LegsOfBodies known = legs_of_bodies(field->node(), legs);
  for (const char* const key : kPairLists) {
    const auto list = bodies.find(key);
    if (!list || !list->node().IsSequence()) continue;
    for (const Field& entry : list->list("a list of pairs")) {
      require_known_names(entry, known);
      const auto both = legs_of_pair(entry.node(), known);
      if (both && both->empty()) entry.complain("got two bodies that no leg has both of, expected a pair of one leg");
    }
  }
}

void keep_bodies_of_leg(YAML::Node& root, const std::string& leg, const std::vector<std::string>& legs) {
  YAML::Node bodies = root["bodies"];
  if (!bodies || !bodies.IsMap()) return;
  const LegsOfBodies known = legs_of_bodies(bodies, legs);
  const std::set<PairClass> here = classes_in(bodies, leg);
  std::set<PairClass> somewhere;
  for (const std::string& each : legs) somewhere.merge(classes_in(bodies, each));
  const auto is_elsewhere = [&](const YAML::Node& of) {
    const auto kind = class_of(of);
    return kind && somewhere.contains(*kind) && !here.contains(*kind);
  };

  for (const char* const key : kLists) {
    if (bodies[key]) keep_entries_of_leg(bodies[key], leg);
  }
  for (const char* const key : kPairLists) {
    YAML::Node list = bodies[key];
    if (!list || !list.IsSequence() || list.size() == 0) continue;
    for (std::size_t i = list.size(); i-- > 0;) {
      const auto both = legs_of_pair(list[i], known);
      if (both && !both->contains(leg)) list.remove(i);
    }
    if (list.size() == 0) bodies.remove(key);
  }
  YAML::Node pairs = bodies["pairs"];
  const bool has_pairs = pairs && pairs.IsSequence() && pairs.size() > 0;
  for (std::size_t i = has_pairs ? pairs.size() : 0; i-- > 0;) {
    if (is_elsewhere(pairs[i])) pairs.remove(i);
  }
  YAML::Node clearance = bodies["clearance"];
  if (clearance && clearance.IsMap()) {
    for (const PairClass kind : all_pair_classes()) {
      if (is_elsewhere(YAML::Node(name(kind)))) clearance.remove(name(kind));
    }
  }
  const bool is_without = has_pairs ? pairs.size() == 0 : here.empty() && !somewhere.empty();
  if (!is_without) return;
  if (bodies["exit_cones"]) {
    bodies.remove("clearance");  // there is nothing that it is about
  } else {
    root.remove("bodies");
  }
}

}  // namespace taut::case_fields
