// SPDX-License-Identifier: GPL-3.0-or-later
#include "case/bodies.h"

#include <fmt/format.h>

#include <algorithm>

#include "base/sanitize.h"
#include "case/fields.h"
#include "case/inside.h"
#include "case/prism.h"

namespace taut::case_fields {
namespace {

// --- Numbers -----------------------------------------------------------------------------------------------------

constexpr const char* kPoint = "a point: a list of three lengths";

/// A length that must not be negative or, where it has to be positive, 0.
DecimalText read_length(const Field& field, const Unit& unit, bool is_positive) {
  const DecimalText length = read_quantity(field, unit);
  const int sign = Decimal::parse(length).sign();
  if (sign < 0 || (is_positive && sign == 0)) field.fail(is_positive ? "a length above zero" : "a length >= 0");
  return length;
}

PointText read_point(const Field& field, const Unit& unit) {
  const std::vector<Field> coordinates = field.list(3, kPoint);
  PointText point;
  for (std::size_t k = 0; k < 3; ++k) point[k] = read_quantity(coordinates[k], unit);
  return point;
}

// --- A body ------------------------------------------------------------------------------------------------------

const std::vector<std::string> kShapes = {"box", "ball", "capsule", "cylinder", "points", "half_space", "mesh"};
const std::vector<std::string> kBodyKeys = {"name",   "box",    "ball",       "capsule",  "cylinder",
                                            "points", "radius", "half_space", "mesh",     "unit",
                                            "at",     "yaw",    "rotation",   "clearance"};

class BodyReader {
 public:
  BodyReader(const Units& units, const std::filesystem::path& folder, CaseBodies& result)
      : length_(units[Dimension::kLength]), angle_(units[Dimension::kAngle]), folder_(folder), result_(result) {}

  std::vector<BodyText> read_list(const Field& list) {
    std::vector<BodyText> bodies;
    for (const Field& item : list.list("a list of bodies such as {name: deck, box: [2, 1.6, 0.2], at: [0, 0, -0.1]}")) {
      bodies.push_back(read(item, list.path()));
    }
    return bodies;
  }

 private:
  /// @param list  the path of the list that has it
  BodyText read(const Field& field, const std::string& list) {
    BodyText body;
    body.name = field.open_map("a map with a name").at("name").text("a name");
    const Map map = field.renamed(fmt::format("{}[{}]", list, excerpt(body.name))).map(kBodyKeys);
    std::vector<std::string> found;
    for (const std::string& shape : kShapes) {
      if (map.find(shape)) found.push_back(shape);
    }
    if (found.size() != 1) {
      map.field().complain(fmt::format("got {} in one body, expected exactly one of {}",
                                       found.empty() ? "no shape" : join(found), join(kShapes)));
    }
    refuse_beside(map, found[0]);
    if (const auto clearance = map.find("clearance")) body.clearance_m = read_length(*clearance, length_, false);
    if (const auto at = map.find("at")) body.at_m = read_point(*at, length_);
    read_rotation(map, body);
    read_shape(map, found[0], body);
    return body;
  }

  /// Complains of keys that the shape does not have.
  static void refuse_beside(const Map& map, const std::string& shape) {
    for (const auto& [key, only] : {std::pair("radius", "points"), std::pair("unit", "mesh")}) {
      const auto field = map.find(key);
      if (field && shape != only) {
        field->complain(fmt::format("got '{}' beside '{}', expected it beside '{}' only", key, shape, only));
      }
    }
    if (shape != "half_space") return;
    for (const char* key : {"at", "yaw", "rotation"}) {
      if (const auto field = map.find(key)) {
        field->complain(fmt::format("got '{}' beside 'half_space', expected its point and its normal only", key));
      }
    }
  }

  void read_rotation(const Map& map, BodyText& body) const {
    const auto yaw = map.find("yaw"), rotation = map.find("rotation");
    if (yaw && rotation) yaw->complain("got both of 'yaw' and 'rotation', expected one of them");
    if (yaw) body.rotation_rad[2] = read_expression(*yaw, angle_, {});
    if (!rotation) return;
    constexpr std::array<const char*, 3> kAngles = {"roll", "pitch", "yaw"};
    const Map angles = rotation->map({kAngles.begin(), kAngles.end()});
    for (std::size_t k = 0; k < 3; ++k) {
      if (const auto angle = angles.find(kAngles[k])) body.rotation_rad[k] = read_expression(*angle, angle_, {});
    }
  }

  void read_shape(const Map& map, const std::string& shape, BodyText& body) {
    const Field field = map.at(shape);
    if (shape == "box") return read_box(field, body);
    if (shape == "ball") return read_ball(field, body);
    if (shape == "capsule" || shape == "cylinder") return read_round(field, shape == "cylinder", body);
    if (shape == "points") return read_points(map, field, body);
    if (shape == "half_space") return read_half_space(field, body);
    read_mesh(map, field, body);
  }

  void read_box(const Field& field, BodyText& body) const {
    const std::vector<Field> sides = field.list(3, "the three sides of a box");
    std::array<Rational, 3> half;
    for (std::size_t k = 0; k < 3; ++k) half[k] = parse_rational(read_length(sides[k], length_, true)) / 2;
    HullText hull;
    for (unsigned corner = 0; corner < 8; ++corner) {
      PointText& point = hull.points_m.emplace_back();
      for (unsigned k = 0; k < 3; ++k) point[k] = text_of(sides[k], (corner >> k & 1U) != 0 ? half[k] : -half[k]);
    }
    body.shape = std::move(hull);
  }

  void read_ball(const Field& field, BodyText& body) const {
    const Map map = field.map({"at", "radius"});
    HullText hull{{{"0", "0", "0"}}, read_length(map.at("radius"), length_, true)};
    if (const auto at = map.find("at")) hull.points_m[0] = read_point(*at, length_);
    body.shape = std::move(hull);
  }

  void read_round(const Field& field, bool is_cylinder, BodyText& body) const {
    const Map map = field.map({"from", "to", "radius"});
    const PointText from = read_point(map.at("from"), length_), to = read_point(map.at("to"), length_);
    if (from == to) map.at("to").fail("another point than 'from'");  // quantities have one text each
    const DecimalText radius = read_length(map.at("radius"), length_, true);
    if (!is_cylinder) {
      body.shape = HullText{{from, to}, radius};
      return;
    }
    Prism prism = in_field(field, [&] { return prism_around_cylinder(from, to, radius); });
    result_.cylinders.push_back({body.name, prism.excess_m});
    body.shape = HullText{std::move(prism.points_m), "0"};
  }

  void read_points(const Map& map, const Field& field, BodyText& body) const {
    const std::string expected = fmt::format("a list of 1 to {} points", kMaxHullPoints);
    const std::vector<Field> points = field.list(expected);
    if (points.empty() || points.size() > kMaxHullPoints) field.fail(expected);
    HullText hull;
    for (const Field& point : points) hull.points_m.push_back(read_point(point, length_));
    if (const auto radius = map.find("radius")) hull.radius_m = read_length(*radius, length_, false);
    body.shape = std::move(hull);
  }

  void read_half_space(const Field& field, BodyText& body) const {
    const Map map = field.map({"point", "normal"});
    body.at_m = read_point(map.at("point"), length_);
    const std::vector<Field> entries = map.at("normal").list(3, "a direction: a list of three numbers");
    HalfSpaceText half_space;
    for (std::size_t k = 0; k < 3; ++k) half_space.normal[k] = read_decimal(entries[k]).text();
    body.shape = std::move(half_space);
  }

  void read_mesh(const Map& map, const Field& field, BodyText& body) const {
    const std::string name = field.text(kMeshNameExpected);
    if (!is_mesh_name(name)) field.fail(kMeshNameExpected);
    const Unit unit = read_unit(map.at("unit"), Dimension::kLength, kMeshUnitExpected);
    std::shared_ptr<const LoadedMesh> mesh;
    try {
      mesh = std::make_shared<const LoadedMesh>(load_mesh(folder_ / name));
    } catch (const InputError& error) {
      field.complain(fmt::format("got '{}', {}", excerpt(name), error.what()));
    }
    body.shape =
        MeshText{name, mesh->sha256, decimal_to_si("1", unit), std::make_shared<const IndexedMesh>(mesh->mesh)};
    result_.meshes.push_back({body.name, std::move(mesh), folder_ / name});
  }

  const Unit& length_;
  const Unit& angle_;
  const std::filesystem::path& folder_;
  CaseBodies& result_;
};

// --- Cables ------------------------------------------------------------------------------------------------------

std::array<DecimalText, 2> read_free_ends(const Field& field, const Unit& length) {
  if (field.node().IsScalar()) {
    const DecimalText both = read_length(field, length, false);
    return {both, both};
  }
  const std::vector<Field> ends = field.list(2, "two lengths: near the base's anchor and near the platform's");
  return {read_length(ends[0], length, false), read_length(ends[1], length, false)};
}

CableBodiesText read_cables(const Field& field, const Unit& length, const RobotText& robot) {
  const Map map = field.map({"diameter", "free_ends"});
  CableBodiesText cables;
  const Field diameter = map.at("diameter"), free_ends = map.at("free_ends");
  if (diameter.node().IsSequence()) {
    const std::vector<Field> entries = diameter.list(kCables, "a diameter, or six of them");
    for (std::size_t i = 0; i < kCables; ++i) cables.diameter_m[i] = read_length(entries[i], length, false);
  } else {
    cables.diameter_m.fill(read_length(diameter, length, false));
  }
  if (free_ends.node().IsSequence() && free_ends.node().size() != 2) {
    const std::vector<Field> entries =
        free_ends.list(kCables, "two lengths, near the base's anchor and near the platform's, or six such pairs");
    for (std::size_t i = 0; i < kCables; ++i) cables.free_ends_m[i] = read_free_ends(entries[i], length);
  } else {
    cables.free_ends_m.fill(read_free_ends(free_ends, length));
  }
  for (std::size_t i = 0; i < kCables; ++i) {
    const auto number = [](const DecimalText& text) { return Decimal::parse(text).rational(); };
    const auto& [at_base, at_platform] = cables.free_ends_m[i];
    if (number(at_base) + number(at_platform) < number(robot.length_m[i].upper)) continue;
    free_ends.fail(
        fmt::format("two that together are shorter than cable {} may get, {} m", i + 1, robot.length_m[i].upper));
  }
  return cables;
}

// --- Which pairs are checked, and their clearances -----------------------------------------------------------------

std::vector<std::string> class_names() {
  std::vector<std::string> names;
  for (const PairClass kind : all_pair_classes()) names.emplace_back(name(kind));
  return names;
}

/// The key of what a class of pairs needs and the case does not have; null if it has all.
const char* missing_for(PairClass kind, const BodiesText& bodies, bool has_cables) {
  if (kind != PairClass::kPlatformObstacles && !has_cables) return "cables";
  const bool takes_platform = kind == PairClass::kPlatformObstacles || kind == PairClass::kCablesPlatform;
  if (takes_platform && bodies.platform.empty()) return "platform";
  const bool takes_obstacles = kind == PairClass::kPlatformObstacles || kind == PairClass::kCablesObstacles;
  return takes_obstacles && bodies.obstacles.empty() ? "obstacles" : nullptr;
}

std::vector<PairClass> checked_classes(const Map& map, const BodiesText& bodies, bool has_cables) {
  std::vector<PairClass> checked;
  const auto pairs = map.find("pairs");
  if (!pairs) {
    for (const PairClass kind : all_pair_classes()) {
      if (!missing_for(kind, bodies, has_cables)) checked.push_back(kind);
    }
    if (checked.empty() && !map.find("exit_cones")) {
      map.field().complain("got nothing that could touch, expected 'platform' and 'obstacles', or 'cables'");
    }
    return checked;
  }
  std::vector<std::pair<std::string, PairClass>> choices;
  for (const PairClass kind : all_pair_classes()) choices.emplace_back(name(kind), kind);
  for (const Field& item : pairs->list("a list of " + join(class_names()))) {
    const auto kind = read_choice<PairClass>(item, choices);
    if (std::ranges::find(checked, kind) != checked.end()) {
      item.complain(fmt::format("got '{}' twice, expected each class of pairs once", name(kind)));
    }
    if (const char* missing = missing_for(kind, bodies, has_cables)) {
      item.complain(fmt::format("got '{}' without '{}', expected bodies of both kinds", name(kind), missing));
    }
    checked.push_back(kind);
  }
  if (checked.empty() && !map.find("exit_cones")) {
    pairs->complain("got an empty list, expected one class of pairs or more, or no 'pairs'");
  }
  return checked;
}

void read_clearances(const Map& map, const Unit& length, const std::vector<PairClass>& checked, BodiesText& bodies) {
  const Field field = map.at("clearance");
  const auto set = [&](PairClass kind, const DecimalText& text) {
    bodies.clearance_m[static_cast<std::size_t>(kind)] = text;
  };
  if (!field.node().IsMap()) {
    if (!field.node().IsScalar()) field.fail("a length, or a map with the keys default, " + join(class_names()));
    for (const PairClass kind : checked) set(kind, read_length(field, length, false));
    return;
  }
  std::vector<std::string> keys = class_names();
  keys.insert(keys.begin(), "default");
  const Map clearances = field.map(keys);
  std::optional<DecimalText> otherwise;
  if (const auto entry = clearances.find("default")) otherwise = read_length(*entry, length, false);
  for (const PairClass kind : all_pair_classes()) {
    const auto entry = clearances.find(name(kind));
    const std::optional<DecimalText> own = entry ? std::optional(read_length(*entry, length, false)) : otherwise;
    if (std::ranges::find(checked, kind) != checked.end()) {
      if (!own) field.complain(fmt::format("got no clearance of '{0}', expected 'default' or '{0}'", name(kind)));
      set(kind, *own);
    } else if (entry && !map.find("pairs")) {
      entry->complain(fmt::format("got a clearance of '{}', expected bodies of both kinds", name(kind)));
    }
  }
}

std::vector<PairClearanceText> read_pair_clearances(const Field& field, const Unit& length) {
  std::vector<PairClearanceText> result;
  for (const Field& item : field.list("a list of pairs such as {pair: [deck, stack], clearance: 0.5}")) {
    const Map map = item.map({"pair", "clearance"});
    const std::vector<Field> ends = map.at("pair").list(2, "the names of two bodies");
    result.push_back({{ends[0].text("the name of a body"), ends[1].text("the name of a body")},
                      read_length(map.at("clearance"), length, false)});
  }
  if (result.empty()) field.complain("got an empty list, expected one pair or more, or no 'pair_clearances'");
  return result;
}

std::vector<ContactText> read_contacts(const Field& field, const Unit& length) {
  std::vector<ContactText> result;
  for (const Field& item : field.list("a list of contacts such as "
                                      "{pair: [container, ground], at: [0, 0, 2.6], within: 0.3, depth: 0.01}")) {
    const Map map = item.map({"pair", "at", "within", "depth"});
    const std::vector<Field> ends = map.at("pair").list(2, "the names of two bodies");
    result.push_back({{ends[0].text("the name of a body"), ends[1].text("the name of a body")},
                      {read_point(map.at("at"), length), read_length(map.at("within"), length, true),
                       read_length(map.at("depth"), length, true)}});
  }
  if (result.empty()) field.complain("got an empty list, expected one contact or more, or no 'contacts'");
  return result;
}

void read_exit_cone(const Field& field, const Unit& angle, std::vector<ExitConeText>& cones) {
  constexpr const char* kCable = "a cable, 1 to 6, a list of cables, or all";
  const Map map = field.map({"cable", "end", "axis", "half_angle"});
  ExitConeText cone;
  cone.end = read_choice<CableEnd>(map.at("end"), {{"base", CableEnd::kBase}, {"platform", CableEnd::kPlatform}});
  const std::vector<Field> axis = map.at("axis").list(3, "a direction: a list of three numbers");
  for (std::size_t k = 0; k < 3; ++k) cone.axis[k] = read_decimal(axis[k]).text();
  cone.half_angle_rad = read_expression(map.at("half_angle"), angle, {});
  const Field cable = map.at("cable");
  const auto add = [&](const Field& of) {
    const std::string number = of.text(kCable);
    if (number.size() != 1 || number[0] < '1' || number[0] > '6') of.fail(kCable);
    cone.cable = static_cast<std::size_t>(number[0] - '1');
    cones.push_back(cone);
  };
  if (cable.node().IsSequence()) {
    for (const Field& item : cable.list(kCable)) add(item);
  } else if (cable.node().IsScalar() && cable.text(kCable) == "all") {
    for (cone.cable = 0; cone.cable < kCables; ++cone.cable) cones.push_back(cone);
  } else {
    add(cable);
  }
}

std::vector<ExitConeText> read_exit_cones(const Field& field, const Unit& angle) {
  std::vector<ExitConeText> cones;
  for (const Field& item : field.list("a list of exit cones such as "
                                      "{cable: all, end: base, axis: [0, 0, -1], half_angle: 60 deg}")) {
    read_exit_cone(item, angle, cones);
  }
  if (cones.empty()) field.complain("got no exit cone, expected one or more, or no 'exit_cones'");
  return cones;
}

// --- Anchors inside of bodies --------------------------------------------------------------------------------------

/// Refuses a cable that would always touch a body, since all points as far from its anchor as its free end is long are
/// within the clearance of the body. It is decided in floating point, to tell mistakes; closer calls are left to the
/// proof. Meshes are not examined.
void refuse_anchors_inside(const BodiesText& bodies, const RobotText& robot) {
  const auto number = [](const DecimalText& text) { return ScalarTraits<double>::from_decimal(text); };
  for (const BodyPair& pair : pairs(bodies)) {
    const bool is_obstacle = pair.kind == PairClass::kCablesObstacles;
    if (!is_obstacle && pair.kind != PairClass::kCablesPlatform) continue;
    const BodyText& body = (is_obstacle ? bodies.obstacles : bodies.platform)[pair.second];
    const std::size_t i = pair.first;
    const DecimalText& free_end = bodies.cables.free_ends_m[i][is_obstacle ? 0 : 1];
    const PointText& anchor = (is_obstacle ? robot.base_anchors_m : robot.platform_anchors_m)[i];
    const double reach = number(bodies.cables.diameter_m[i]) / 2 + number(pair.clearance_m);
    if (!contains_ball_approx(body, anchor, number(free_end), reach)) continue;
    throw FieldError(
        fmt::format("bodies.{}[{}]", is_obstacle ? "obstacles" : "platform", body.name),
        fmt::format(
            "a body with the {} anchor of cable {} inside, or nearer than its clearance of {} m, deeper than the "
            "cable's free end of {} m there",
            is_obstacle ? "base" : "platform", i + 1, pair.clearance_m, free_end),
        "expected a longer free end, or the body elsewhere: the cable always touches it");
  }
}

}  // namespace

CaseBodies read_bodies(const Field& field, const Units& units, const std::filesystem::path& folder,
                       const RobotText& robot) {
  const Map map =
      field.map({"clearance", "cables", "platform", "obstacles", "pairs", "pair_clearances", "contacts", "exit_cones"});
  const Unit& length = units[Dimension::kLength];
  CaseBodies result;
  BodiesText& bodies = result.text;
  BodyReader reader(units, folder, result);
  if (const auto list = map.find("platform")) bodies.platform = reader.read_list(*list);
  if (const auto list = map.find("obstacles")) bodies.obstacles = reader.read_list(*list);
  const auto cables = map.find("cables");
  if (cables) bodies.cables = read_cables(*cables, length, robot);
  const std::vector<PairClass> checked = checked_classes(map, bodies, cables.has_value());
  if (!checked.empty()) {
    read_clearances(map, length, checked, bodies);
  } else if (const auto clearance = map.find("clearance")) {
    clearance->complain("got a clearance of nothing that could touch, expected bodies, or exit cones alone");
  }
  if (const auto list = map.find("pair_clearances")) bodies.pair_clearances_m = read_pair_clearances(*list, length);
  if (const auto list = map.find("contacts")) bodies.contacts = read_contacts(*list, length);
  if (const auto list = map.find("exit_cones")) {
    bodies.exit_cones = read_exit_cones(*list, units[Dimension::kAngle]);
  }
  validate(bodies);
  refuse_anchors_inside(bodies, robot);
  return result;
}

}  // namespace taut::case_fields
