// SPDX-License-Identifier: GPL-3.0-or-later
#include "checker/legs.h"

#include <fmt/format.h>

#include <algorithm>
#include <initializer_list>
#include <map>
#include <set>
#include <span>
#include <string>
#include <utility>

#include "checker/format/claims.h"
#include "checker/format/cursor.h"
#include "checker/kernel/errors.h"

namespace taut::checker {
namespace {

/// The values of a problem's parameters at a place of its path: x + pi half_turns, exactly.
struct ExactPoint {
  std::vector<mpq_class> x, half_turns;
};

/// Where the path begins, or where it ends. A spline is there at (P0 + 4 P1 + P2) / 6 of its three control points.
ExactPoint end_of(const Path& path, bool is_last) {
  const bool is_spline = path.law == Law::kCubicBSpline;
  const std::size_t count = is_spline ? 3 : 1;
  const std::span<const Waypoint> all = path.waypoints;
  if (has_poses(path.law) || all.size() < count) throw Rejected("a path without an end in parameters");
  const std::span<const Waypoint> controls = is_last ? all.last(count) : all.first(count);
  constexpr std::array<int, 3> kWeights = {1, 4, 1};
  ExactPoint point;
  for (std::size_t j = 0; j < controls[0].x.size(); ++j) {
    mpq_class x, half_turns;
    for (std::size_t k = 0; k < count; ++k) {
      const mpq_class weight = is_spline ? mpq_class(kWeights.at(k), 6) : mpq_class(1);
      x += weight * mpq_class(controls[k].x[j]);
      half_turns += weight * controls[k].half_turns[j];
    }
    point.x.push_back(x);
    point.half_turns.push_back(half_turns);
  }
  return point;
}

bool is_whole(const mpq_class& x) { return x.get_den() == 1; }

/// Whether b is the pose of a, by its parameters: whole turns of a periodic one are the same pose, and where the space
/// says so, phi + pi with -theta.
bool is_same_pose(const Problem& problem, const ExactPoint& a, const ExactPoint& b) {
  const auto agree = [&](bool is_flipped) {
    for (std::size_t j = 0; j < a.x.size(); ++j) {
      const bool is_phi = is_flipped && j == (*problem.flip)[0], is_theta = is_flipped && j == (*problem.flip)[1];
      const int sign = is_theta ? -1 : 1;
      const mpq_class turns = (b.half_turns[j] - sign * a.half_turns[j] - (is_phi ? 1 : 0)) / 2;
      if (b.x[j] != sign * a.x[j]) return false;
      const bool is_periodic = problem.parameters[j].kind == ParameterKind::kPeriodic;
      if (turns != 0 && !(is_periodic && is_whole(turns))) return false;
    }
    return true;
  };
  return agree(false) || (problem.flip && agree(true));
}

/// What has to be the same of each leg's problem, by its key.
Json same_of(const Json& problem, const std::string& key) {
  const Json value = problem.value(key, Json());
  const auto with = [&](std::initializer_list<const char*> keys) {
    Json result = Json::object();
    for (const char* const part : keys) result[part] = value.is_object() ? value.value(part, Json()) : Json();
    return result;
  };
  if (key == "load") return with({"gravity_m_s2", "point_m"});
  if (key == "bodies") return with({"exit_cones"});
  return value;
}

// ---- Bodies ---------------------------------------------------------------------------------------------------------

using Names = std::array<std::string, 2>;

/// What a leg's problem states of bodies.
struct Scene {
  explicit Scene(const Json& stated) : json(stated) {
    for (std::size_t i = 0; i < kCables; ++i) bodies["cable " + std::to_string(i + 1)] = {};
    for (const char* const list : {"platform", "obstacles"}) {
      for (const Json& body : json.at(list)) bodies[body.at("name").get<std::string>()] = {{list, body}};
    }
    for (const char* const list : {"pair_clearances_m", "contacts"}) {
      if (!json.contains(list)) continue;
      for (const Json& entry : json.at(list)) {
        auto pair = entry.at("pair").get<Names>();
        std::ranges::sort(pair);
        entries[pair].insert(list + entry.dump());
      }
    }
  }

  [[nodiscard]] bool has(const Names& pair) const { return bodies.contains(pair[0]) && bodies.contains(pair[1]); }

  const Json& json;
  std::map<std::string, Json> bodies;                     ///< by name, with the list that they are in
  std::map<Names, std::multiset<std::string>> entries{};  ///< about single pairs, whose names are in order
};

/// A class of pairs, and the lists whose bodies it is about.
struct ClassOfPairs {
  const char* name;
  std::vector<const char*> lists;
};

/// Compares what two legs both state. @returns the key of what differs, or nothing
std::string difference(const Scene& a, const Scene& b) {
  if (a.json.at("cables") != b.json.at("cables")) return "cables";
  for (const auto& [name, body] : a.bodies) {
    const auto other = b.bodies.find(name);
    if (other != b.bodies.end() && other->second != body) return "the body '" + name + "'";
  }
  const std::array<ClassOfPairs, 4> classes = {{{kPairClassNames[0], {"platform", "obstacles"}},
                                                {kPairClassNames[1], {"obstacles"}},
                                                {kPairClassNames[2], {}},
                                                {kPairClassNames[3], {"platform"}}}};
  for (const auto& [name, lists] : classes) {
    const bool have_both = std::ranges::all_of(
        lists, [&](const char* list) { return !a.json.at(list).empty() && !b.json.at(list).empty(); });
    const auto clearance = [&, key = name](const Scene& of) { return of.json.at("clearance_m").value(key, Json()); };
    if (have_both && clearance(a) != clearance(b)) return std::string("the clearance of ") + name;
  }
  for (const auto& [one, other] : {std::pair(&a, &b), std::pair(&b, &a)}) {
    for (const auto& [pair, entries] : one->entries) {
      if (!other->has(pair)) continue;
      const auto found = other->entries.find(pair);
      if (found == other->entries.end() || found->second != entries) {
        return "what is stated of '" + pair[0] + "' and '" + pair[1] + "'";
      }
    }
  }
  return "";
}

void require_one_scene(const LegsCertificate& certificate) {
  std::vector<std::pair<std::size_t, Scene>> scenes;
  for (std::size_t k = 0; k < certificate.legs.size(); ++k) {
    const Json& problem = certificate.legs[k].certificate.problem_json;
    if (!problem.contains("bodies")) continue;
    const Scene scene(problem["bodies"]);
    for (const auto& [j, other] : scenes) {
      const std::string what = difference(other, scene);
      if (what.empty()) continue;
      throw Rejected(fmt::format("leg {} states other bodies than leg {}: {} differs", k + 1, j + 1, what));
    }
    scenes.emplace_back(k, scene);
  }
}

}  // namespace

void require_one_machine(const LegsCertificate& certificate) {
  const Json& first = certificate.legs.front().certificate.problem_json;
  for (std::size_t k = 1; k < certificate.legs.size(); ++k) {
    const Json& other = certificate.legs[k].certificate.problem_json;
    for (const auto* problem : {&first, &other}) {
      for (const auto& [key, value] : problem->items()) {
        if (key == "name" || key == "query" || same_of(first, key) == same_of(other, key)) continue;
        throw Rejected(fmt::format("leg {} is about another machine than leg 1: problem.{} differs", k + 1, key));
      }
    }
  }
  require_one_scene(certificate);
}

void require_joined(const LegsCertificate& certificate) {
  for (std::size_t k = 1; k < certificate.legs.size(); ++k) {
    const Certificate& before = certificate.legs[k - 1].certificate;
    const Certificate& after = certificate.legs[k].certificate;
    if (is_same_pose(before.problem, end_of(before.path, true), end_of(after.path, false))) continue;
    throw Rejected(fmt::format("leg {} does not begin at the pose at which leg {} ends", k + 1, k));
  }
}

}  // namespace taut::checker
