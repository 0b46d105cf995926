// SPDX-License-Identifier: GPL-3.0-or-later
#include "problem/bodies.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <nlohmann/json.hpp>
#include <numbers>
#include <set>
#include <utility>

#include "base/input_error.h"
#include "base/labels.h"
#include "base/sanitize.h"
#include "problem/decimal.h"
#include "problem/expression.h"

namespace taut {
namespace {

using nlohmann::json;

// --- Reading -----------------------------------------------------------------------------------------------------

template <std::size_t N>
std::array<DecimalText, N> read_texts(const JsonCursor& value) {
  std::array<DecimalText, N> texts;
  const std::vector<JsonCursor> elements = value.elements(N);
  for (std::size_t i = 0; i < N; ++i) texts[i] = elements[i].text();
  return texts;
}

HullText read_hull(const JsonCursor& value) {
  value.expect_keys({"points_m", "radius_m"});
  HullText hull{{}, value.at("radius_m").text()};
  for (const JsonCursor& point : value.at("points_m").elements()) hull.points_m.push_back(read_texts<3>(point));
  return hull;
}

BodyText read_body(const JsonCursor& value) {
  std::vector<std::string> keys = {"name", "at_m"};
  for (const char* optional : {"clearance_m", "rotation_rad"}) {
    if (value.contains(optional)) keys.emplace_back(optional);
  }
  constexpr std::array<const char*, 3> kShapes = {"hull", "half_space", "mesh"};
  const auto* const shape = std::ranges::find_if(kShapes, [&](const char* key) { return value.contains(key); });
  if (shape == kShapes.end()) {
    value.fail(fmt::format("an object with one of the keys {}", fmt::join(kShapes, ", ")));
  }
  keys.emplace_back(*shape);
  value.expect_keys(keys);
  BodyText body;
  body.name = value.at("name").text();
  body.at_m = read_texts<3>(value.at("at_m"));
  if (value.contains("clearance_m")) body.clearance_m = value.at("clearance_m").text();
  if (value.contains("rotation_rad")) body.rotation_rad = read_texts<3>(value.at("rotation_rad"));
  const JsonCursor content = value.at(*shape);
  if (shape == kShapes.begin()) {
    body.shape = read_hull(content);
  } else if (shape == kShapes.begin() + 1) {
    body.shape = HalfSpaceText{read_texts<3>(content.expect_keys({"normal"}).at("normal"))};
  } else {
    content.expect_keys({"file", "sha256", "unit_m"});
    body.shape = MeshText{content.at("file").text(), content.at("sha256").text(), content.at("unit_m").text()};
  }
  return body;
}

std::vector<ExitConeText> read_exit_cones(const JsonCursor& value) {
  std::vector<ExitConeText> cones;
  for (const JsonCursor& entry : value.elements()) {
    entry.expect_keys({"cable", "end", "axis", "half_angle_rad"});
    ExitConeText& cone = cones.emplace_back();
    cone.cable = static_cast<std::size_t>(entry.at("cable").integer(1, kCables)) - 1;
    const std::string end = entry.at("end").text();
    if (end != "base" && end != "platform") entry.at("end").fail("base or platform");
    cone.end = end == "base" ? CableEnd::kBase : CableEnd::kPlatform;
    cone.axis = read_texts<3>(entry.at("axis"));
    cone.half_angle_rad = entry.at("half_angle_rad").text();
  }
  if (cones.empty()) value.fail("at least one exit cone");
  return cones;
}

// --- Writing -----------------------------------------------------------------------------------------------------

const std::array<ExpressionText, 3> kNoRotation = {"0", "0", "0"};

json body_to_json(const BodyText& body) {
  json result = {{"name", body.name}, {"at_m", body.at_m}};
  if (body.clearance_m) result["clearance_m"] = *body.clearance_m;
  if (body.rotation_rad != kNoRotation) result["rotation_rad"] = body.rotation_rad;
  if (const auto* hull = std::get_if<HullText>(&body.shape)) {
    result["hull"] = {{"points_m", hull->points_m}, {"radius_m", hull->radius_m}};
  } else if (const auto* half_space = std::get_if<HalfSpaceText>(&body.shape)) {
    result["half_space"] = {{"normal", half_space->normal}};
  } else {
    const auto& mesh = std::get<MeshText>(body.shape);
    result["mesh"] = {{"file", mesh.file}, {"sha256", mesh.sha256}, {"unit_m", mesh.unit_m}};
  }
  return result;
}

json list_to_json(const std::vector<BodyText>& bodies) {
  json list = json::array();
  for (const BodyText& body : bodies) list.push_back(body_to_json(body));
  return list;
}

// --- Validating --------------------------------------------------------------------------------------------------

void validate_point(const std::string& where, const PointText& point) {
  for (std::size_t k = 0; k < 3; ++k) static_cast<void>(decimal_at(fmt::format("{}[{}]", where, k), point[k]));
}

void validate_not_negative(const std::string& where, const DecimalText& text, const char* what) {
  if (decimal_at(where, text).sign() < 0) throw FieldError(where, text, fmt::format("expected a {} >= 0", what));
}

void validate_rotation(const std::string& where, const std::array<ExpressionText, 3>& angles) {
  constexpr std::array<const char*, 3> kAngles = {"roll", "pitch", "yaw"};
  for (std::size_t k = 0; k < 3; ++k) {
    const std::string here = fmt::format("{}.{}", where, kAngles[k]);
    double value = 0;
    try {
      value = evaluate_constant<double>(angles[k]);
    } catch (const InputError& error) {
      throw FieldError(here, "", error.what());
    }
    // Approximate, to tell mistakes.
    if (!std::isfinite(value)) {
      throw FieldError(here, "'" + excerpt(angles[k]) + "'", "expected an expression with a finite value");
    }
  }
}

void validate_hull(const std::string& where, const HullText& hull) {
  if (hull.points_m.empty() || hull.points_m.size() > kMaxHullPoints) {
    throw FieldError(where + ".points", fmt::format("{} points", hull.points_m.size()),
                     fmt::format("expected 1 to {} points", kMaxHullPoints));
  }
  for (std::size_t i = 0; i < hull.points_m.size(); ++i) {
    validate_point(fmt::format("{}.points[{}]", where, i), hull.points_m[i]);
  }
  validate_not_negative(where + ".radius", hull.radius_m, "radius");
}

/// A direction whose length is a binary64 number and not 0, as for the axis of a space.
void validate_sized_direction(const std::string& where, const PointText& direction) {
  validate_point(where, direction);
  const auto is_below = [](const DecimalText& text, const char* limit) {
    return boost::multiprecision::abs(Decimal::parse(text).rational()) < Decimal::parse(limit).rational();
  };
  const bool is_small = std::ranges::all_of(direction, [&](const DecimalText& x) { return is_below(x, "1e-9"); });
  if (!is_small && std::ranges::all_of(direction, [&](const DecimalText& x) { return is_below(x, "1e9"); })) return;
  throw FieldError(where, fmt::format("[{}]", fmt::join(direction, ", ")),
                   "expected a direction: three numbers, the largest of which is at least 1e-9 and below 1e9");
}

void validate_half_space(const std::string& where, const BodyText& body, const HalfSpaceText& half_space) {
  validate_sized_direction(where + ".normal", half_space.normal);
  if (body.rotation_rad != kNoRotation) {
    throw FieldError(where + ".rotation", "a rotation of a half-space",
                     "expected none: its normal says where it faces");
  }
}

void validate_mesh(const std::string& where, const MeshText& mesh) {
  const bool is_line = std::ranges::none_of(mesh.file, [](unsigned char c) { return c < ' ' || c == 127; });
  constexpr std::size_t kMostBytes = 1000;
  if (mesh.file.empty() || mesh.file.size() > kMostBytes || !is_line ||
      valid_utf8_prefix(mesh.file) != mesh.file.size()) {
    throw FieldError(where + ".mesh", "'" + excerpt(mesh.file) + "'",
                     fmt::format("expected the name of a file, of 1 to {} bytes on one line", kMostBytes));
  }
  const auto is_hex = [](unsigned char c) { return (c >= '0' && c <= '9') || (c >= 'a' && c <= 'f'); };
  if (mesh.sha256.size() != 64 || !std::ranges::all_of(mesh.sha256, is_hex)) {
    throw FieldError(where + ".sha256", "'" + excerpt(mesh.sha256) + "'", "expected 64 lower-case hex digits");
  }
  if (decimal_at(where + ".unit", mesh.unit_m).sign() <= 0) {
    throw FieldError(where + ".unit", mesh.unit_m, "expected a unit > 0");
  }
}

/// @throws FieldError for a name that is no label, that a cable has, or that is there twice
void validate_names(const BodiesText& bodies) {
  std::set<std::string> seen, of_cables;
  for (std::size_t i = 0; i < kCables; ++i) of_cables.insert(cable_name(i));
  for (const auto& [where, list] :
       {std::pair("bodies.platform", &bodies.platform), std::pair("bodies.obstacles", &bodies.obstacles)}) {
    if (list->size() > kMaxBodies) {
      throw FieldError(where, fmt::format("{} bodies", list->size()), fmt::format("expected at most {}", kMaxBodies));
    }
    for (std::size_t k = 0; k < list->size(); ++k) {
      const std::string& name = (*list)[k].name;
      const std::string here = fmt::format("{}[{}].name", where, k);
      if (!is_label(name)) {
        throw FieldError(here, "'" + excerpt(name) + "'", fmt::format("expected a name: {}", kLabelExpected));
      }
      if (of_cables.contains(name)) {
        throw FieldError(here, "'" + name + "'", "expected another name: this one is a cable's");
      }
      if (!seen.insert(name).second) {
        throw FieldError(here, "'" + excerpt(name) + "' twice",
                         "expected a name of its own for each body of the platform and each obstacle");
      }
    }
  }
}

void validate_body(const std::string& where, const BodyText& body, bool is_obstacle) {
  if (body.clearance_m) validate_not_negative(where + ".clearance", *body.clearance_m, "clearance");
  validate_point(where + ".at", body.at_m);
  validate_rotation(where + ".rotation", body.rotation_rad);
  if (const auto* hull = std::get_if<HullText>(&body.shape)) {
    validate_hull(where, *hull);
  } else if (const auto* half_space = std::get_if<HalfSpaceText>(&body.shape)) {
    if (!is_obstacle) throw FieldError(where, "a half-space on the platform", "expected one among the obstacles only");
    validate_half_space(where + ".half_space", body, *half_space);
  } else {
    validate_mesh(where, std::get<MeshText>(body.shape));
  }
}

void validate_cables(const CableBodiesText& cables) {
  for (std::size_t i = 0; i < kCables; ++i) {
    validate_not_negative(fmt::format("bodies.cables.diameter[{}]", i), cables.diameter_m[i], "diameter");
    for (std::size_t end = 0; end < 2; ++end) {
      validate_not_negative(fmt::format("bodies.cables.free_ends[{}][{}]", i, end), cables.free_ends_m[i][end],
                            "length");
    }
  }
}

void validate_exit_cones(const std::vector<ExitConeText>& cones) {
  std::set<std::pair<std::size_t, CableEnd>> seen;
  for (std::size_t k = 0; k < cones.size(); ++k) {
    const ExitConeText& cone = cones[k];
    const std::string where = fmt::format("bodies.exit_cones[{}]", k);
    if (cone.cable >= kCables) {
      throw FieldError(where + ".cable", fmt::format("{}", cone.cable + 1), "expected a cable, 1 to 6");
    }
    if (!seen.emplace(cone.cable, cone.end).second) {
      throw FieldError(where, fmt::format("a second exit cone of cable {} at the {}", cone.cable + 1, name(cone.end)),
                       "expected at most one");
    }
    validate_sized_direction(where + ".axis", cone.axis);
    double value = 0;
    try {
      value = evaluate_constant<double>(cone.half_angle_rad);
    } catch (const InputError& error) {
      throw FieldError(where + ".half_angle", "", error.what());
    }
    // Approximate, to tell mistakes; a proof needs a proper angle only.
    if (!(value > 0 && value < std::numbers::pi / 2)) {
      throw FieldError(where + ".half_angle", "'" + excerpt(cone.half_angle_rad) + "'",
                       "expected an angle above 0 and below 90 deg");
    }
  }
}

// --- Pairs -------------------------------------------------------------------------------------------------------

/// What a name in a pair means.
struct NamedBody {
  enum class Kind { kCable, kPlatform, kObstacle } kind = Kind::kCable;
  std::size_t index = 0;
};

std::map<std::string, NamedBody> named_bodies(const BodiesText& bodies) {
  std::map<std::string, NamedBody> result;
  for (std::size_t i = 0; i < kCables; ++i) result[cable_name(i)] = {NamedBody::Kind::kCable, i};
  for (std::size_t i = 0; i < bodies.platform.size(); ++i) {
    result[bodies.platform[i].name] = {NamedBody::Kind::kPlatform, i};
  }
  for (std::size_t i = 0; i < bodies.obstacles.size(); ++i) {
    result[bodies.obstacles[i].name] = {NamedBody::Kind::kObstacle, i};
  }
  return result;
}

/// The class of such a pair, or nothing: two obstacles, two bodies of the platform, or a body and itself.
std::optional<BodyPair> pair_of(NamedBody a, NamedBody b) {
  using enum NamedBody::Kind;
  // The order of the kinds is the order in a pair: cables before all, the platform before obstacles.
  if (std::pair(a.kind, a.index) > std::pair(b.kind, b.index)) std::swap(a, b);
  if (a.kind == kPlatform && b.kind == kObstacle) return BodyPair{PairClass::kPlatformObstacles, a.index, b.index, ""};
  if (a.kind != kCable) return std::nullopt;
  if (b.kind == kObstacle) return BodyPair{PairClass::kCablesObstacles, a.index, b.index, ""};
  if (b.kind == kPlatform) return BodyPair{PairClass::kCablesPlatform, a.index, b.index, ""};
  if (a.index == b.index) return std::nullopt;
  return BodyPair{PairClass::kCablesCables, a.index, b.index, ""};
}

using PairKey = std::tuple<PairClass, std::size_t, std::size_t>;

PairKey key_of(const BodyPair& pair) { return {pair.kind, pair.first, pair.second}; }

/// 'a' and 'b'.
std::string seen(const std::array<std::string, 2>& names) {
  return fmt::format("'{}' and '{}'", excerpt(names[0]), excerpt(names[1]));
}

/// The pair of these names. @throws FieldError for a pair that is none, or that is not checked
BodyPair named_pair(const BodiesText& bodies, const std::map<std::string, NamedBody>& known, const std::string& where,
                    const std::array<std::string, 2>& names) {
  std::array<NamedBody, 2> ends;
  for (std::size_t end = 0; end < 2; ++end) {
    const auto found = known.find(names[end]);
    if (found == known.end()) {
      throw FieldError(fmt::format("{}.pair[{}]", where, end), "'" + excerpt(names[end]) + "'",
                       "expected the name of a body, or 'cable 1' to 'cable 6'");
    }
    ends[end] = found->second;
  }
  std::optional<BodyPair> pair = pair_of(ends[0], ends[1]);
  if (!pair) {
    throw FieldError(where + ".pair", seen(names),
                     "expected two bodies that move against each other: of the platform, an obstacle, or cables");
  }
  if (!bodies.clearance_m[static_cast<std::size_t>(pair->kind)]) {
    throw FieldError(where + ".pair", seen(names),
                     fmt::format("expected a pair that is checked; the class '{}' is not", name(pair->kind)));
  }
  return *std::move(pair);
}

/// The clearances of single pairs. @throws FieldError for a pair that is none, that is not checked, or that is there
/// twice
std::map<PairKey, DecimalText> clearances_of_pairs(const BodiesText& bodies) {
  const std::map<std::string, NamedBody> known = named_bodies(bodies);
  std::map<PairKey, DecimalText> result;
  for (std::size_t k = 0; k < bodies.pair_clearances_m.size(); ++k) {
    const auto& [names, clearance] = bodies.pair_clearances_m[k];
    const std::string where = fmt::format("bodies.pair_clearances[{}]", k);
    const BodyPair pair = named_pair(bodies, known, where, names);
    validate_not_negative(where + ".clearance", clearance, "clearance");
    if (!result.emplace(key_of(pair), clearance).second) {
      throw FieldError(where + ".pair", seen(names) + " twice", "expected one clearance for each pair");
    }
  }
  return result;
}

/// The zones in which pairs may touch. @throws FieldError for a pair that is none, that is not checked or that may not
/// touch, and for a zone that is none
std::map<PairKey, std::vector<ContactZoneText>> zones_of_pairs(const BodiesText& bodies) {
  const std::map<std::string, NamedBody> known = named_bodies(bodies);
  std::map<PairKey, std::vector<ContactZoneText>> result;
  if (bodies.contacts.size() > kMaxContacts) {
    throw FieldError("bodies.contacts", fmt::format("{} contacts", bodies.contacts.size()),
                     fmt::format("expected at most {}", kMaxContacts));
  }
  for (std::size_t k = 0; k < bodies.contacts.size(); ++k) {
    const auto& [names, zone] = bodies.contacts[k];
    const std::string where = fmt::format("bodies.contacts[{}]", k);
    const BodyPair pair = named_pair(bodies, known, where, names);
    const auto is_mesh = [](const BodyText& body) { return std::holds_alternative<MeshText>(body.shape); };
    if (pair.kind != PairClass::kPlatformObstacles || is_mesh(bodies.platform[pair.first]) ||
        is_mesh(bodies.obstacles[pair.second])) {
      throw FieldError(where + ".pair", seen(names),
                       "expected a body of the platform and an obstacle, neither of them a mesh");
    }
    validate_point(where + ".at", zone.at_m);
    for (const auto& [key, length] : {std::pair("within", &zone.within_m), std::pair("depth", &zone.depth_m)}) {
      const std::string here = fmt::format("{}.{}", where, key);
      if (decimal_at(here, *length).sign() <= 0) throw FieldError(here, *length, "expected a length > 0");
    }
    std::vector<ContactZoneText>& zones = result[key_of(pair)];
    if (std::ranges::find(zones, zone) != zones.end()) {
      throw FieldError(where, "the same contact twice", "expected each contact once");
    }
    zones.push_back(zone);
  }
  return result;
}

/// Makes the list of pairs, in its order.
class PairList {
 public:
  explicit PairList(const BodiesText& bodies)
      : bodies_(bodies), of_pairs_(clearances_of_pairs(bodies)), zones_(zones_of_pairs(bodies)) {}

  std::vector<BodyPair> all() && {
    for (std::size_t i = 0; i < bodies_.platform.size(); ++i) {
      for (std::size_t j = 0; j < bodies_.obstacles.size(); ++j) {
        add(PairClass::kPlatformObstacles, i, j, &bodies_.platform[i], &bodies_.obstacles[j]);
      }
    }
    for (std::size_t i = 0; i < kCables; ++i) {
      for (std::size_t j = 0; j < bodies_.obstacles.size(); ++j) {
        add(PairClass::kCablesObstacles, i, j, nullptr, &bodies_.obstacles[j]);
      }
    }
    for (std::size_t i = 0; i < kCables; ++i) {
      for (std::size_t j = i + 1; j < kCables; ++j) add(PairClass::kCablesCables, i, j, nullptr, nullptr);
    }
    for (std::size_t i = 0; i < kCables; ++i) {
      for (std::size_t j = 0; j < bodies_.platform.size(); ++j) {
        add(PairClass::kCablesPlatform, i, j, nullptr, &bodies_.platform[j]);
      }
    }
    for (std::size_t k = 0; k < bodies_.exit_cones.size(); ++k) {
      pairs_.push_back({PairClass::kExitCones, bodies_.exit_cones[k].cable, k, "0"});
    }
    return std::move(pairs_);
  }

 private:
  /// @param a, b  the pair's bodies, but cables, which have no clearance of their own
  void add(PairClass kind, std::size_t first, std::size_t second, const BodyText* a, const BodyText* b) {
    const std::optional<DecimalText>& of_class = bodies_.clearance_m[static_cast<std::size_t>(kind)];
    if (!of_class) return;
    BodyPair pair{kind, first, second, *of_class};
    std::optional<Decimal> greatest;
    for (const BodyText* body : {a, b}) {
      if (!body || !body->clearance_m) continue;
      const Decimal own = Decimal::parse(*body->clearance_m);
      if (greatest && *greatest >= own) continue;
      greatest = own;
      pair.clearance_m = *body->clearance_m;
    }
    if (const auto found = of_pairs_.find(key_of(pair)); found != of_pairs_.end()) pair.clearance_m = found->second;
    if (const auto found = zones_.find(key_of(pair)); found != zones_.end()) pair.zones = found->second;
    pairs_.push_back(std::move(pair));
  }

  const BodiesText& bodies_;
  std::map<PairKey, DecimalText> of_pairs_;
  std::map<PairKey, std::vector<ContactZoneText>> zones_;
  std::vector<BodyPair> pairs_;
};

}  // namespace

const char* name(PairClass kind) {
  switch (kind) {
    case PairClass::kPlatformObstacles: return "platform-obstacles";
    case PairClass::kCablesObstacles: return "cables-obstacles";
    case PairClass::kCablesCables: return "cables-cables";
    case PairClass::kCablesPlatform: return "cables-platform";
    case PairClass::kExitCones: break;
  }
  return "exit-cones";
}

const char* name(CableEnd end) { return end == CableEnd::kBase ? "base" : "platform"; }

std::string cable_name(std::size_t i) { return fmt::format("cable {}", i + 1); }

std::array<std::string, 2> names(const BodiesText& bodies, const BodyPair& pair) {
  switch (pair.kind) {
    case PairClass::kPlatformObstacles:
      return {bodies.platform.at(pair.first).name, bodies.obstacles.at(pair.second).name};
    case PairClass::kCablesObstacles: return {cable_name(pair.first), bodies.obstacles.at(pair.second).name};
    case PairClass::kCablesCables: return {cable_name(pair.first), cable_name(pair.second)};
    case PairClass::kCablesPlatform: return {cable_name(pair.first), bodies.platform.at(pair.second).name};
    case PairClass::kExitCones: break;
  }
  return {cable_name(pair.first), fmt::format("exit cone at the {}", name(bodies.exit_cones.at(pair.second).end))};
}

std::string name(const BodiesText& bodies, const BodyPair& pair) {
  const auto [first, second] = names(bodies, pair);
  return fmt::format("{} / {}", first, second);
}

std::vector<BodyPair> pairs(const BodiesText& bodies) { return PairList(bodies).all(); }

void validate(const BodiesText& bodies) {
  validate_names(bodies);
  for (const BodyText& body : bodies.platform) {
    validate_body(fmt::format("bodies.platform[{}]", body.name), body, false);
  }
  for (const BodyText& body : bodies.obstacles) {
    validate_body(fmt::format("bodies.obstacles[{}]", body.name), body, true);
  }
  validate_cables(bodies.cables);
  for (const PairClass kind : all_pair_classes()) {
    const std::optional<DecimalText>& clearance = bodies.clearance_m[static_cast<std::size_t>(kind)];
    if (clearance) validate_not_negative(fmt::format("bodies.clearance.{}", name(kind)), *clearance, "clearance");
  }
  static_cast<void>(clearances_of_pairs(bodies));
  static_cast<void>(zones_of_pairs(bodies));
  validate_exit_cones(bodies.exit_cones);
}

bool are_meshes_read(const BodiesText& bodies) {
  const auto is_read = [](const BodyText& body) {
    const auto* mesh = std::get_if<MeshText>(&body.shape);
    return mesh == nullptr || mesh->mesh != nullptr;
  };
  return std::ranges::all_of(bodies.platform, is_read) && std::ranges::all_of(bodies.obstacles, is_read);
}

json to_json(const BodiesText& bodies) {
  json clearance = json::object();
  for (const PairClass kind : all_pair_classes()) {
    if (const auto& text = bodies.clearance_m[static_cast<std::size_t>(kind)]) clearance[name(kind)] = *text;
  }
  json result = {{"platform", list_to_json(bodies.platform)},
                 {"obstacles", list_to_json(bodies.obstacles)},
                 {"cables", {{"diameter_m", bodies.cables.diameter_m}, {"free_ends_m", bodies.cables.free_ends_m}}},
                 {"clearance_m", std::move(clearance)}};
  for (const PairClearanceText& entry : bodies.pair_clearances_m) {
    result["pair_clearances_m"].push_back({{"pair", entry.pair}, {"clearance_m", entry.clearance_m}});
  }
  for (const auto& [pair, zone] : bodies.contacts) {
    result["contacts"].push_back(
        {{"pair", pair}, {"at_m", zone.at_m}, {"within_m", zone.within_m}, {"depth_m", zone.depth_m}});
  }
  for (const ExitConeText& cone : bodies.exit_cones) {
    result["exit_cones"].push_back({{"cable", cone.cable + 1},
                                    {"end", name(cone.end)},
                                    {"axis", cone.axis},
                                    {"half_angle_rad", cone.half_angle_rad}});
  }
  return result;
}

BodiesText bodies_from_json(const JsonCursor& value) {
  std::vector<std::string> keys = {"platform", "obstacles", "cables", "clearance_m"};
  for (const char* optional : {"pair_clearances_m", "contacts", "exit_cones"}) {
    if (value.contains(optional)) keys.emplace_back(optional);
  }
  value.expect_keys(keys);
  BodiesText bodies;
  for (const JsonCursor& body : value.at("platform").elements()) bodies.platform.push_back(read_body(body));
  for (const JsonCursor& body : value.at("obstacles").elements()) bodies.obstacles.push_back(read_body(body));
  const JsonCursor cables = value.at("cables");
  cables.expect_keys({"diameter_m", "free_ends_m"});
  bodies.cables.diameter_m = read_texts<kCables>(cables.at("diameter_m"));
  const std::vector<JsonCursor> free_ends = cables.at("free_ends_m").elements(kCables);
  for (std::size_t i = 0; i < kCables; ++i) bodies.cables.free_ends_m[i] = read_texts<2>(free_ends[i]);
  const JsonCursor clearance = value.at("clearance_m");
  std::vector<std::string> checked;
  for (const PairClass kind : all_pair_classes()) {
    if (!clearance.contains(name(kind))) continue;
    checked.emplace_back(name(kind));
    bodies.clearance_m[static_cast<std::size_t>(kind)] = clearance.at(name(kind)).text();
  }
  clearance.expect_keys(checked);
  const auto read_entries = [&](const char* key, const std::vector<std::string>& entry_keys, const auto& add) {
    if (!value.contains(key)) return;
    const std::vector<JsonCursor> entries = value.at(key).elements();
    if (entries.empty()) value.at(key).fail("at least one pair");
    for (const JsonCursor& entry : entries) {
      entry.expect_keys(entry_keys);
      add(entry, read_texts<2>(entry.at("pair")));
    }
  };
  read_entries("pair_clearances_m", {"pair", "clearance_m"}, [&](const JsonCursor& entry, auto pair) {
    bodies.pair_clearances_m.push_back({std::move(pair), entry.at("clearance_m").text()});
  });
  read_entries("contacts", {"pair", "at_m", "within_m", "depth_m"}, [&](const JsonCursor& entry, auto pair) {
    bodies.contacts.push_back(
        {std::move(pair), {read_texts<3>(entry.at("at_m")), entry.at("within_m").text(), entry.at("depth_m").text()}});
  });
  if (value.contains("exit_cones")) bodies.exit_cones = read_exit_cones(value.at("exit_cones"));
  return bodies;
}

}  // namespace taut
