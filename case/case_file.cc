// SPDX-License-Identifier: GPL-3.0-or-later
#include "case/case_file.h"

#include <fmt/format.h>
#include <utf8.h>
#include <yaml-cpp/eventhandler.h>
#include <yaml-cpp/yaml.h>

#include <algorithm>
#include <cerrno>
#include <cstring>
#include <fstream>
#include <optional>
#include <regex>
#include <set>
#include <sstream>
#include <string_view>
#include <utility>

#include "base/input_error.h"
#include "base/labels.h"
#include "base/sanitize.h"
#include "case/around_items.h"
#include "case/bodies.h"
#include "case/case_of_legs.h"
#include "case/decoration_fields.h"
#include "case/fields.h"
#include "case/legs.h"
#include "case/load.h"
#include "case/table_rounding.h"
#include "case/time.h"
#include "case/waypoint.h"
#include "problem/decimal.h"
#include "problem/expression.h"
#include "problem/units.h"

namespace taut {
namespace {

using namespace case_fields;

constexpr std::size_t kMaxFileBytes = 1 << 20;  // a case has about a page; a much larger file is a mistake

// --- Sections ------------------------------------------------------------------------------------------------------

std::array<std::array<DecimalText, 3>, kCables> read_anchors(const Field& field, const Units& units) {
  std::array<std::array<DecimalText, 3>, kCables> anchors;
  const std::vector<Field> points = field.list(kCables, "a list of six points");
  for (std::size_t i = 0; i < kCables; ++i) {
    const std::vector<Field> coordinates = points[i].list(3, "a point: a list of three lengths");
    for (std::size_t k = 0; k < 3; ++k) anchors[i][k] = read_quantity(coordinates[k], units[Dimension::kLength]);
  }
  return anchors;
}

std::array<Limits, kCables> read_limits(const Field& field, const Unit& unit) {
  const std::string expected = "a pair [lower, upper], or six of them";
  const auto read_pair = [&](const Field& pair) {
    const std::vector<Field> ends = pair.list(2, expected);
    return Limits{read_quantity(ends[0], unit), read_quantity(ends[1], unit)};
  };
  std::array<Limits, kCables> limits;
  if (is_list_of_scalars(field.node())) {
    limits.fill(read_pair(field));
    for (std::size_t i = 0; i < kCables; ++i) field.remember_as(fmt::format("{}[{}]", field.path(), i));
  } else {
    const std::vector<Field> pairs = field.list(kCables, expected);
    std::transform(pairs.begin(), pairs.end(), limits.begin(), read_pair);
  }
  return limits;
}

RobotText read_robot(const Field& field, const Units& units) {
  const Map map = field.map({"base_anchors", "platform_anchors", "tension", "length"});
  return {.base_anchors_m = read_anchors(map.at("base_anchors"), units),
          .platform_anchors_m = read_anchors(map.at("platform_anchors"), units),
          .tension_N = read_limits(map.at("tension"), units[Dimension::kForce]),
          .length_m = read_limits(map.at("length"), units[Dimension::kLength])};
}

/// Reads one quantity for all six cables, or six quantities.
std::array<DecimalText, kCables> read_for_each_cable(const Field& field, const Unit& unit) {
  const bool is_one = field.node().IsScalar();
  const std::vector<Field> entries =
      is_one ? std::vector<Field>(kCables, field) : field.list(kCables, "a quantity, or six of them");
  // Problems speak of base_anchors and platform_anchors, which cases may write without the s.
  const std::string path = field.path() + (field.path().ends_with("anchor") ? "s" : "");
  std::array<DecimalText, kCables> result;
  for (std::size_t i = 0; i < kCables; ++i) {
    result[i] = read_quantity(entries[i], unit);
    entries[i].remember_as(fmt::format("{}[{}]", path, i));
  }
  return result;
}

/// The entry under either of two names of one key.
std::optional<Field> find_either(const Map& map, const std::string& one, const std::string& other) {
  const auto first = map.find(one), second = map.find(other);
  if (first && second) second->complain(fmt::format("got both of '{}' and '{}', expected one of them", one, other));
  return first ? first : second;
}

TolerancesText read_tolerances(const Field& field, const Field& load, const Units& units) {
  const Map map = field.map({"base_anchor", "platform_anchor", "load_point", "mass", "wrench", "position",
                             "orientation", "cable_length", "base_anchors", "platform_anchors"});
  const Unit& length = units[Dimension::kLength];
  TolerancesText result;
  if (const auto entry = find_either(map, "base_anchor", "base_anchors")) {
    result.base_anchor_m = read_for_each_cable(*entry, length);
  }
  if (const auto entry = find_either(map, "platform_anchor", "platform_anchors")) {
    result.platform_anchor_m = read_for_each_cable(*entry, length);
  }
  if (const auto entry = map.find("load_point")) result.load_point_m = read_quantity(*entry, length);
  read_load_tolerance(map, load, units, result);
  if (const auto entry = map.find("position")) result.position_m = read_quantity(*entry, length);
  if (const auto entry = map.find("orientation")) {
    result.orientation_rad = read_expression(*entry, units[Dimension::kAngle], {});
  }
  if (const auto entry = map.find("cable_length")) result.cable_length_m = read_for_each_cable(*entry, length);
  return result;
}

/// The space, and the units of its parameters' bare values.
struct Space {
  SpaceText text;
  std::vector<Unit> units;
};

const Unit& pose_unit(const Units& units, std::size_t i) {
  return units[i < 3 ? Dimension::kLength : Dimension::kAngle];
}

/// A map whose keys are coordinates of poses with such angles.
Map coordinate_map(const Field& field, const std::vector<std::string>& keys, AngleKind angles) {
  return field.map(keys, [angles](const std::string& key) { return angles_hint(key, angles); });
}

/// Makes pose coordinate i a parameter of the space.
void set_free(Space& space, std::size_t i, const Units& units) {
  const AngleKind angles = space.text.angles.kind;
  const std::string name = pose_names(angles)[i];
  space.text.pose[i] = name;
  space.text.parameters.push_back({name, is_turn(angles, i) ? ParameterKind::kPeriodic : ParameterKind::kReal, "", ""});
  space.units.push_back(pose_unit(units, i));
}

/// Sets the space's flip if phi and theta of tilt and torsion are free and unbounded: (phi, theta) and
/// (phi + pi, -theta) are then the same pose.
void set_flip(SpaceText& space) {
  if (space.angles.kind != AngleKind::kTiltAndTorsion) return;
  const auto index = [&](const std::string& name) {
    const auto found = std::find_if(space.parameters.begin(), space.parameters.end(), [&](const Parameter& p) {
      return p.name == name && p.kind != ParameterKind::kRange;
    });
    return static_cast<std::size_t>(found - space.parameters.begin());
  };
  const std::size_t phi = index("phi"), theta = index("theta");
  if (std::max(phi, theta) < space.parameters.size()) space.flip = {static_cast<int>(phi), static_cast<int>(theta)};
}

Space empty_space(const AnglesText& angles) {
  Space space;
  space.text.angles = angles;
  space.text.pose.fill("0");
  return space;
}

std::pair<ExpressionText, ExpressionText> read_range(const Field& field, const Unit& unit,
                                                     const std::string& expected) {
  const std::vector<Field> ends = field.list(2, expected);
  return {read_expression(ends[0], unit, {}), read_expression(ends[1], unit, {})};
}

/// Makes pose coordinate i a parameter that stays in a range.
void set_bounded(Space& space, std::size_t i, const Field& range, const Units& units) {
  set_free(space, i, units);
  Parameter& parameter = space.text.parameters.back();
  parameter.kind = ParameterKind::kRange;
  std::tie(parameter.range_lower, parameter.range_upper) =
      read_range(range, pose_unit(units, i), "a range [lower, upper]");
  range.remember_as("space.parameters." + parameter.name);
}

Space read_slice(const Field& field, const AnglesText& angles, const Units& units) {
  Space space = empty_space(angles);
  const std::vector<std::string> names = pose_names(angles.kind);
  const Map map = coordinate_map(field, names, angles.kind);
  for (std::size_t i = 0; i < names.size(); ++i) {
    const auto given = map.find(names[i]);
    if (!given) {
      set_free(space, i, units);
    } else if (given->node().IsSequence()) {
      set_bounded(space, i, *given, units);
    } else {
      space.text.pose[i] = read_expression(*given, pose_unit(units, i), {});
      given->remember_as(fmt::format("space.pose.{}", names[i]));
    }
  }
  if (space.text.parameters.empty())
    field.complain("got all six coordinates fixed, expected at least one to be left free");
  set_flip(space.text);
  return space;
}

Space read_free(const Field& field, const AnglesText& angles, const Units& units) {
  Space space = empty_space(angles);
  const std::vector<std::string> names = pose_names(angles.kind);
  const Map map = field.map({"px", "py", "pz"});
  for (std::size_t i = 0; i < names.size(); ++i) {
    if (i < 3) {
      set_bounded(space, i, map.at(names[i]), units);
    } else {
      set_free(space, i, units);
    }
  }
  set_flip(space.text);
  return space;
}

Space read_surface(const Field& field, const AnglesText& angles, const Units& units) {
  Space space = empty_space(angles);
  Names names;
  const Map map = field.map({"parameters", "constants", "pose"});
  const std::string expected = "'periodic', 'real' or a range [lower, upper]";
  const Map parameters = map.at("parameters").open_map("a map of names to " + expected);
  for (const auto& [name, kind] : parameters.entries()) {
    Parameter parameter{name, ParameterKind::kRange, "", ""};
    if (kind.node().IsScalar()) {
      parameter.kind = kind.node().Scalar() == "periodic" ? ParameterKind::kPeriodic : ParameterKind::kReal;
      if (parameter.kind == ParameterKind::kReal && kind.node().Scalar() != "real") kind.fail(expected);
    } else {
      std::tie(parameter.range_lower, parameter.range_upper) = read_range(kind, si_unit(Dimension::kAngle), expected);
    }
    names.parameters.push_back(name);
    space.text.parameters.push_back(std::move(parameter));
    space.units.push_back(si_unit(Dimension::kAngle));
  }
  if (const auto field_of_constants = map.find("constants")) {
    const Map constants = field_of_constants->open_map("a map of names to numbers");
    for (const auto& [name, value] : constants.entries()) {
      names.constants[name] = read_decimal(value).text();
    }
  }
  if (names.parameters.empty()) parameters.field().complain("got no parameter, expected at least one");
  in_field(parameters.field(), [&] { return ExpressionTape({}, names.parameters, names.constants); });
  const std::vector<std::string> coordinates = pose_names(angles.kind);
  const Map pose = coordinate_map(map.at("pose"), coordinates, angles.kind);
  for (std::size_t i = 0; i < coordinates.size(); ++i) {
    space.text.pose[i] = read_expression(pose.at(coordinates[i]), pose_unit(units, i), names);
  }
  space.text.constants = names.constants;
  return space;
}

/// All pose coordinates, unbounded.
Space all_poses(const AnglesText& angles, const Units& units) {
  Space space = empty_space(angles);
  for (std::size_t i = 0; i < pose_names(angles.kind).size(); ++i) set_free(space, i, units);
  set_flip(space.text);
  return space;
}

/// The expression with its names replaced. The e of a number such as 1e3 is no name. @pre the expression parses.
ExpressionText substitute(const ExpressionText& expression, const std::map<std::string, ExpressionText>& replacements) {
  static const std::regex token("[0-9.]+([eE][+-]?[0-9]+)?|[A-Za-z_][A-Za-z_0-9]*|[^A-Za-z_0-9.]+");
  ExpressionText result;
  for (std::sregex_iterator it(expression.begin(), expression.end(), token), end; it != end; ++it) {
    const auto replacement = replacements.find(it->str());
    result += replacement == replacements.end() ? it->str() : replacement->second;
  }
  return result;
}

/// Complains of a word in a constraint that names another parametrisation's angle.
void require_angles_of(const Field& item, const ExpressionText& typed, AngleKind angles) {
  static const std::regex word("[A-Za-z_][A-Za-z_0-9]*");
  for (std::sregex_iterator it(typed.begin(), typed.end(), word), end; it != end; ++it) {
    const std::string hint = angles_hint(it->str(), angles);
    if (!hint.empty()) {
      item.complain(fmt::format("got '{}', {}expected {}", it->str(), hint, fmt::join(pose_names(angles), ", ")));
    }
  }
}

/// Reads constraints on the pose, in the case's length unit and radians, and rewrites them in the space's parameters.
void read_constraints(Space& space, const Field& field, const Units& units) {
  const AngleKind angles = space.text.angles.kind;
  const std::vector<std::string> names = pose_names(angles);
  const std::string expected = fmt::format("an expression of {} that is to be 0", fmt::join(names, ", "));
  std::map<std::string, ExpressionText> in_parameters;
  for (std::size_t i = 0; i < names.size(); ++i) {
    const ExpressionText& coordinate = space.text.pose[i];
    const ExpressionText operand = coordinate == names[i] ? coordinate : "(" + coordinate + ")";
    in_parameters[names[i]] = i < 3 ? expression_from_si(operand, units[Dimension::kLength]) : operand;
  }
  for (const Field& item : field.list("a list of expressions that are to be 0")) {
    const ExpressionText typed = item.text(expected);
    require_angles_of(item, typed, angles);
    const ExpressionTape tape = in_field(item, [&] { return ExpressionTape({typed}, names, {}); });
    const auto mentions = [&](std::size_t i) { return tape.depends_on(0, static_cast<int>(i)); };
    bool mentions_parameter = false;
    for (std::size_t i = 0; i < names.size(); ++i) {
      mentions_parameter |= mentions(i) && space.text.pose[i] == names[i];
    }
    if (!mentions_parameter) item.fail("an expression that mentions a coordinate of the pose that is not fixed");
    if (space.text.flip && (mentions(3) || mentions(4))) space.text.flip.reset();
    space.text.constraints.push_back(substitute(typed, in_parameters));
  }
  if (space.text.constraints.empty()) field.fail("at least one constraint");
}

AnglesText read_angles(const Field& field) {
  AnglesText angles;
  if (!field.node().IsMap()) {
    angles.kind = read_choice<AngleKind>(field, {{"tilt-and-torsion", AngleKind::kTiltAndTorsion},
                                                 {"roll-pitch-yaw", AngleKind::kRollPitchYaw},
                                                 {"zyz", AngleKind::kZyz},
                                                 {"{axis: [x, y, z]}", AngleKind::kAxis}});
    if (angles.kind == AngleKind::kAxis) field.fail("a map {axis: [x, y, z]}");  // typed in quotes
    return angles;
  }
  angles.kind = AngleKind::kAxis;
  const std::vector<Field> axis = field.map({"axis"}).at("axis").list(3, "a direction: a list of three numbers");
  for (std::size_t k = 0; k < 3; ++k) angles.axis[k] = read_decimal(axis[k]).text();
  return angles;
}

Space read_space(const Field& field, const Units& units) {
  const Map map = field.map({"angles", "slice", "surface", "implicit", "free"});
  AnglesText angles;
  const auto angles_field = map.find("angles");
  if (angles_field) angles = read_angles(*angles_field);
  const auto slice = map.find("slice"), surface = map.find("surface"), free = map.find("free");
  const auto implicit = map.find("implicit");
  const int bases = slice.has_value() + surface.has_value() + free.has_value();
  const bool is_all_poses = angles_field && map.entries().size() == 1;
  if ((bases + implicit.has_value() == 0 && !is_all_poses) || bases > 1 || (surface && implicit)) {
    field.complain(fmt::format(
        "got {} kinds of space, expected one of slice, surface, free and implicit, or implicit with slice or free",
        map.entries().size() - angles_field.has_value()));
  }
  Space space = slice     ? read_slice(*slice, angles, units)
                : surface ? read_surface(*surface, angles, units)
                : free    ? read_free(*free, angles, units)
                          : all_poses(angles, units);
  if (implicit) read_constraints(space, *implicit, units);
  return space;
}

/// A value for each of the space's parameters.
std::vector<ExpressionText> read_waypoint(const Field& field, const Space& space) {
  std::vector<std::string> names;
  for (const Parameter& parameter : space.text.parameters) names.push_back(parameter.name);
  const std::vector<std::string> coordinates = pose_names(space.text.angles.kind);
  const auto hint = [&](const std::string& key) -> std::string {  // where parameters are coordinates of the pose
    const bool are_coordinates = std::ranges::all_of(
        names, [&](const std::string& name) { return std::ranges::find(coordinates, name) != coordinates.end(); });
    return are_coordinates ? angles_hint(key, space.text.angles.kind) : "";
  };
  const Map waypoint = field.map(names, hint);
  std::vector<ExpressionText> values;
  for (std::size_t j = 0; j < names.size(); ++j) {
    values.push_back(read_expression(waypoint.at(names[j]), space.units[j], {}));
  }
  return values;
}

std::vector<std::vector<ExpressionText>> read_query(const Field& field, const Space& space) {
  const Map map = field.map({"waypoints"});
  const std::vector<Field> items = map.at("waypoints").list("a list of at least two waypoints");
  if (items.empty()) map.at("waypoints").fail("a list of at least two waypoints");
  std::vector<std::vector<ExpressionText>> waypoints;
  for (const Field& item : items) waypoints.push_back(read_waypoint(item, space));
  return waypoints;
}

double read_positive(const Field& field) {
  const Decimal value = read_decimal(field);
  if (value.sign() <= 0) field.fail("a number above zero");
  return ScalarTraits<double>::from_decimal(value.text());
}

double read_fraction(const Field& field) {
  const double value = ScalarTraits<double>::from_decimal(read_decimal(field).text());
  if (!(value >= 0 && value < 1)) field.fail("a number from 0 to below 1");
  return value;
}

int read_count(const Field& field, int largest) {
  const std::string expected = fmt::format("a whole number from 1 to {}", largest);
  const std::string text = field.text(expected);
  if (text.find_first_not_of("0123456789") != std::string::npos || text.size() > 9) field.fail(expected);
  const int value = std::stoi(text);
  if (value < 1 || value > largest) field.fail(expected);
  return value;
}

/// Reads `{travel: {point, per_radian}}`.
TravelCost read_travel(const Field& field, const Units& units) {
  const Unit& length = units[Dimension::kLength];
  const Map map = field.map({"point", "per_radian"});
  TravelCost travel;
  if (const auto point = map.find("point")) {
    const std::vector<Field> coordinates = point->list(3, "a point of the platform: a list of three lengths");
    for (std::size_t k = 0; k < 3; ++k) {
      travel.point_m[k] = ScalarTraits<double>::from_decimal(read_quantity(coordinates[k], length));
    }
  }
  if (const auto per_radian = map.find("per_radian")) {
    travel.per_radian_m = ScalarTraits<double>::from_decimal(read_quantity(*per_radian, length));
    if (*travel.per_radian_m < 0) per_radian->fail("a length >= 0");
  }
  return travel;
}

void read_cost(const Field& field, const Units& units, PlannerOptions& planner) {
  if (field.node().IsMap()) {
    planner.cost = Cost::kTravel;
    planner.travel = read_travel(field.map({"travel"}).at("travel"), units);
    return;
  }
  planner.cost = read_choice<Cost>(field, {{"rotation", Cost::kRotation},
                                           {"great_circle", Cost::kGreatCircle},
                                           {"parameters", Cost::kParameters},
                                           {"travel", Cost::kTravel}});
}

PlannerOptions read_planner(const Field& field, const Units& units) {
  const Map map =
      field.map({"strategy", "cost", "radius", "epsilon", "max_charts", "max_seconds", "clearance", "smooth"});
  PlannerOptions planner;
  if (const auto strategy = map.find("strategy")) {
    planner.strategy =
        read_choice<Strategy>(*strategy, {{"astar", Strategy::kAStar}, {"greedy", Strategy::kGreedyBestFirst}});
  }
  if (const auto cost = map.find("cost")) read_cost(*cost, units, planner);
  if (const auto radius = map.find("radius")) planner.radius = read_positive(*radius);
  if (const auto epsilon = map.find("epsilon")) planner.epsilon = read_positive(*epsilon);
  if (const auto max_charts = map.find("max_charts")) planner.max_charts = read_count(*max_charts, 100'000'000);
  if (const auto max_seconds = map.find("max_seconds")) planner.max_seconds = read_positive(*max_seconds);
  planner.has_budget = map.find("max_charts") || map.find("max_seconds");
  if (const auto clearance = map.find("clearance")) {
    planner.clearance = read_fraction(*clearance);
  }
  if (const auto smooth = map.find("smooth")) {
    planner.smoothing = read_choice<Smoothing>(
        *smooth, {{"none", Smoothing::kNone}, {"shorten", Smoothing::kShorten}, {"spline", Smoothing::kSpline}});
  }
  return planner;
}

double read_bound(const Field& field, std::optional<Unit> unit) {
  if (!unit) return ScalarTraits<double>::from_decimal(read_decimal(field).text());
  return evaluate_constant<double>(read_quantity(field, *unit));
}

std::vector<Bound> read_bounds(const Map& map, const Units& units) {
  const std::map<std::string, Dimension> dimensions = {{"tension_margin", Dimension::kForce},
                                                       {"length_margin", Dimension::kLength},
                                                       {"clearance_margin", Dimension::kLength},
                                                       {"length", Dimension::kLength},
                                                       {"angle", Dimension::kAngle},
                                                       {"duration", Dimension::kTime}};
  std::vector<Bound> bounds;
  for (const char* quantity : kBoundQuantities) {
    const auto field = map.find(quantity);
    if (!field) continue;
    const auto dimension = dimensions.find(quantity);
    const std::optional<Unit> unit =
        dimension == dimensions.end() ? std::nullopt : std::optional(units[dimension->second]);
    const std::vector<Field> ends = field->list(2, "a pair [lower, upper], either of which may be null");
    Bound bound{quantity};
    if (!ends[0].node().IsNull()) bound.lower = read_bound(ends[0], unit);
    if (!ends[1].node().IsNull()) bound.upper = read_bound(ends[1], unit);
    if (!(bound.lower <= bound.upper)) field->fail("lower <= upper");
    bounds.push_back(bound);
  }
  return bounds;
}

/// Reads a verdict, or a map with a verdict and bounds.
void read_expectation(const Field& field, const Units& units, Case& result) {
  Field verdict = field;
  if (field.node().IsMap()) {
    std::vector<std::string> keys = {"verdict"};
    keys.insert(keys.end(), kBoundQuantities.begin(), kBoundQuantities.end());
    const Map map = field.map(keys);
    verdict = map.at("verdict");
    result.bounds = read_bounds(map, units);
  }
  result.expect = read_choice<Expectation>(verdict, {{"proved", Expectation::kProved},
                                                     {"refuted", Expectation::kRefuted},
                                                     {"undecided", Expectation::kUndecided},
                                                     {"no path", Expectation::kNoPath}});
}

TableRounding read_rounding(const Field& field, const Units& units) {
  const Map map = field.map({"position", "angle", "length"});
  const auto read = [&](const char* key, Dimension dimension) {
    const Field entry = map.at(key);
    const std::string expected = rounding_expected(dimension);
    const auto size = read_rounding_size(entry.text(expected), dimension, units[dimension]);
    if (!size) entry.fail(expected);
    return *size;
  };
  if (const auto length = map.find("length")) {
    for (const char* key : {"position", "angle"}) {
      if (const auto other = map.find(key)) {
        other->complain("got it beside 'length', which is of a table of cable lengths, expected one or the other");
      }
    }
    const RoundingSize size = read("length", Dimension::kLength);
    return {.length_m = size.si, .length = size.text};
  }
  const RoundingSize position = read("position", Dimension::kLength), angle = read("angle", Dimension::kAngle);
  return {.position_m = position.si, .angle_rad = angle.si, .position = position.text, .angle = angle.text};
}

AuditedPath read_audited_path(const Field& field, const Units& units, bool has_time) {
  const Map map = field.map({"path", "interpolation", "timed", "rounding"});
  AuditedPath result;
  result.file = map.at("path").text("the name of a path file, seen from the case file");
  if (const auto law = map.find("interpolation")) {
    const std::vector<std::string> laws = {"straight", "geodesic", "cable-lengths"};
    result.interpolation = law->text("one of " + join(laws));
    if (std::ranges::find(laws, result.interpolation) == laws.end()) law->fail("one of " + join(laws));
  }
  if (const auto timed = map.find("timed")) {
    result.timed = read_choice<bool>(*timed, {{"true", true}, {"false", false}});
    if (result.timed && !has_time) timed->complain("got true in a case without the key 'time', expected both");
    if (result.timed && !result.interpolation.empty()) {
      map.at("interpolation")
          .complain("got a law between rows, expected none of a table that is audited with its times");
    }
  }
  if (const auto rounding = map.find("rounding")) {
    if (!result.timed) rounding->complain("got a rounding without 'timed: true', expected both");
    result.rounding = read_rounding(*rounding, units);
  }
  return result;
}

constexpr std::size_t kMaxName = 200;  // bytes, of a case

std::string read_name(const Field& field) {
  const std::string expected = fmt::format(
      "a name of 1 to {} bytes on one line, without characters that hide text or change its direction", kMaxName);
  const std::string name = field.text(expected);
  if (sanitize(name) != name || name.size() > kMaxName) field.fail(expected);
  return name;
}

DocumentFields read_document_fields(const Map& map) {
  DocumentFields result;
  for (const auto& [name, member] : kDocumentFields) {
    const bool is_of_load = member == &DocumentFields::load_name;
    const auto field = is_of_load ? map.at("load").open_map("the load, a map").find("name") : map.find(name);
    if (!field) continue;
    const bool is_document = member == &DocumentFields::document;
    const char* const expected = is_document ? kDocumentExpected : kLabelExpected;
    const std::string text = field->text(expected);
    if (!is_label(text) || (is_document && !is_document_label(text))) field->fail(expected);
    result.*member = text;
  }
  return result;
}

/// @param folder  of the file: names of files in it are relative to this
/// @param typed   a further waypoint, which is read where the space is known
Case read_case(const Field& root, const std::filesystem::path& folder, const std::function<void(const Space&)>& typed) {
  const Map map =
      root.map({"taut", "name", "title", "machine", "site", "document", "prepared_by", "units", "robot", "load",
                "tolerances", "bodies", "space", "query", "planner", "time", "audit", "decoration", "expect"});
  if (const Field version = map.at("taut"); version.text("1, the case format") != "1") {
    version.fail("1, the case format that this version reads");
  }
  Units units;
  if (const auto field = map.find("units"))
    units = Units(field->map({"length", "force", "moment", "mass", "angle", "time"}));
  Case result;
  result.problem.name = read_name(map.at("name"));
  result.problem.robot = read_robot(map.at("robot"), units);
  const auto time = map.find("time");
  result.problem.load = read_load(map.at("load"), units, time.has_value(), result.warnings);
  if (is_around_items(map.at("load"))) result.items_in_ellipsoid = result.problem.load;
  result.document_fields = read_document_fields(map);
  if (const auto field = map.find("decoration")) result.decoration = read_decoration(*field, units, folder);
  if (const auto field = map.find("tolerances")) {
    result.problem.tolerances = read_tolerances(*field, map.at("load"), units);
  }
  if (const auto field = map.find("bodies")) {
    result.bodies = read_bodies(*field, units, folder, result.problem.robot);
    result.problem.bodies = result.bodies->text;
  }
  result.problem.space = coordinate_space();
  result.units = units.all();
  const auto query = map.find("query");
  if (query || map.find("space")) {
    const Space space = read_space(map.at("space"), units);
    result.problem.space = space.text;
    if (query) result.problem.query = read_query(*query, space);
    if (typed) typed(space);
  } else if (typed) {
    (void)map.at("space");  // says that there is none
  }
  if (const auto planner = map.find("planner")) result.planner = read_planner(*planner, units);
  if (time) {
    check_load_in_time(*time, result.problem.load, is_around_items(map.at("load")), result.warnings);
    const CaseTime in_time = read_time(*time, units, map.at("load"));
    result.problem.time = in_time.limits;
    if (in_time.limits.rows && !result.problem.tolerances) result.problem.tolerances.emplace();
    result.move = in_time.move;
  }
  if (const auto audit = map.find("audit")) result.audit = read_audited_path(*audit, units, time.has_value());
  if (const auto expect = map.find("expect")) read_expectation(*expect, units, result);
  return result;
}

/// @throws InputError naming the place of the first byte that is not UTF-8, if there is one.
void require_utf8(const std::string& text, const Places& places) {
  const std::size_t wrong = valid_utf8_prefix(text);
  if (wrong == text.size()) return;
  const std::string_view before = std::string_view(text).substr(0, wrong);
  const std::size_t line = before.rfind('\n') + 1;  // begin of the byte's line; npos + 1 is 0
  YAML::Mark mark;
  mark.line = static_cast<int>(std::ranges::count(before, '\n'));
  mark.column = static_cast<int>(utf8::distance(before.begin() + static_cast<std::ptrdiff_t>(line), before.end()));
  places.fail(mark, "",
              fmt::format("got the byte 0x{:02X}, expected UTF-8 text", static_cast<unsigned char>(text[wrong])));
}

/// Of text that is not YAML: names the first tab among the blanks that begin a line, which is what most often is wrong.
void refuse_tabs(const std::string& text, const Places& places) {
  YAML::Mark mark;
  mark.line = 0;
  std::istringstream lines(text);
  for (std::string line; std::getline(lines, line); ++mark.line) {
    const std::size_t content = line.find_first_not_of(" \t\r");
    const std::size_t tab = line.find('\t');
    if (content == std::string::npos || line[content] == '#' || tab >= content) continue;
    mark.column = static_cast<int>(tab);
    places.fail(mark, "", "got a tab at the beginning of the line, expected blanks: YAML forbids tabs in indentation");
  }
}

/// Ignores all events.
class NullEventHandler : public YAML::EventHandler {
 public:
  void OnDocumentStart(const YAML::Mark& /*mark*/) override {}
  void OnDocumentEnd() override {}
  void OnNull(const YAML::Mark& /*mark*/, YAML::anchor_t /*anchor*/) override {}
  void OnAlias(const YAML::Mark& /*mark*/, YAML::anchor_t /*anchor*/) override {}
  void OnScalar(const YAML::Mark& /*mark*/, const std::string& /*tag*/, YAML::anchor_t /*anchor*/,
                const std::string& /*value*/) override {}
  void OnSequenceStart(const YAML::Mark& /*mark*/, const std::string& /*tag*/, YAML::anchor_t /*anchor*/,
                       YAML::EmitterStyle::value /*style*/) override {}
  void OnSequenceEnd() override {}
  void OnMapStart(const YAML::Mark& /*mark*/, const std::string& /*tag*/, YAML::anchor_t /*anchor*/,
                  YAML::EmitterStyle::value /*style*/) override {}
  void OnMapEnd() override {}
};

/// The only document of the file. YAML::LoadAll is not used: where a stray `}` or `]` begins a document, it never ends.
YAML::Node only_document(const std::string& text, const std::string& name) {
  std::istringstream stream(text);
  YAML::Parser parser(stream);
  NullEventHandler ignore;
  if (!parser.HandleNextDocument(ignore)) throw InputError(name + ": got no YAML document, expected one", {name});
  if (parser.HandleNextDocument(ignore)) throw InputError(name + ": got several YAML documents, expected one", {name});
  return YAML::Load(text);
}

/// The comment lines at the beginning of the file, without the `#`.
std::string leading_comment(const std::string& text) {
  std::istringstream lines(text);
  std::string comment;
  for (std::string line; std::getline(lines, line) && line.starts_with('#');) {
    line.erase(0, line.starts_with("# ") ? 2 : 1);
    comment += (comment.empty() ? "" : "\n") + line;
  }
  return comment;
}

/// The mean distance of the platform's anchors from its origin [m].
double arm_of(const RobotText& robot) {
  double sum = 0;
  for (const auto& anchor : robot.platform_anchors_m) {
    std::array<double, 3> b{};
    std::ranges::transform(anchor, b.begin(),
                           [](const DecimalText& x) { return ScalarTraits<double>::from_decimal(x); });
    sum += std::hypot(b[0], b[1], b[2]);
  }
  return sum > 0 ? sum / kCables : 1;
}

/// Reads the document of a case without legs, or of one leg.
Case read_document(Places& places, const YAML::Node& document, const std::string& name, const CaseCheck& check,
                   const std::function<void(const Space&)>& typed = {}) {
  try {
    Case result = read_case(Field(places, document, ""), std::filesystem::path(name).parent_path(), typed);
    validate(result.problem);
    if (result.items_in_ellipsoid) {
      result.problem.load = ellipsoid_around_items(*result.items_in_ellipsoid, arm_of(result.problem.robot));
      validate(result.problem);
    }
    if (check) check(result);
    return result;
  } catch (const FieldError& error) {
    places.fail(error);
  }
}

CaseOfLegs read_legs_of(const Field& root, const std::string& text, const std::string& name, const CaseCheck& check) {
  CaseOfLegs result;
  const std::vector<std::string> names = read_legs(root);
  for (const std::string& leg_name : names) {
    Places places(name);
    YAML::Node document = only_document(text, name);
    keep_leg(document, names, result.legs.size());
    Case leg = read_document(places, document, name, check);
    if (result.legs.empty()) result.whole = leg;
    leg.problem.name = fmt::format("{}, leg {}", leg.problem.name, leg_name);
    if (leg.problem.name.size() > kMaxName) {
      root.open_map("a case").at("name").complain(
          fmt::format("got a name too long for '{}', expected at most {} bytes "
                      "of that",
                      leg.problem.name, kMaxName));
    }
    leg.expect = Expectation::kNone;
    leg.bounds.clear();
    const auto bodies = root.open_map("a case").find("bodies");
    if (bodies && !leg.problem.bodies) {
      leg.warnings.push_back(bodies->remark(fmt::format(
          "no two bodies of the leg '{}' could touch, so that nothing is checked of its bodies", leg_name)));
    }
    for (const std::string& warning : leg.warnings) {
      std::vector<std::string>& all = result.whole.warnings;
      if (std::ranges::find(all, warning) == all.end()) all.push_back(warning);
    }
    result.legs.push_back({leg_name, std::move(leg)});
  }
  require_joined(root, result.legs);
  result.whole.problem.query.clear();
  return result;
}

/// @param allows_legs  else a case that has them is refused
CaseOfLegs parse(const std::string& text, const std::string& name, const CaseCheck& check, bool allows_legs,
                 const std::function<void(const Space&)>& typed = {}) {
  Places places(name);
  if (text.size() > kMaxFileBytes) {
    throw InputError(fmt::format("{}: got more than {} bytes, expected a case file", name, kMaxFileBytes), {name});
  }
  require_utf8(text, places);
  try {
    const YAML::Node document = only_document(text, name);
    const bool is_of_legs = has_legs(document);
    if (is_of_legs && !allows_legs) {
      places.fail(
          document["query"]["legs"].Mark(), "query.legs",
          "got legs, expected 'waypoints': only taut plan, taut show, taut regress and taut-check take a case of legs");
    }
    CaseOfLegs result;
    if (is_of_legs) {
      result = read_legs_of(Field(places, document, ""), text, name, check);
    } else {
      result.whole = read_document(places, document, name, check, typed);
    }
    result.whole.description = leading_comment(text);
    for (CaseLeg& leg : result.legs) leg.content.description = result.whole.description;
    return result;
  } catch (const YAML::Exception& error) {
    refuse_tabs(text, places);
    places.fail(error.mark, "", fmt::format("got text that is not YAML ({}), expected a case file", error.msg));
  }
}

/// A waypoint as `{phi: 1, theta: 2}`, or without the braces.
std::vector<ExpressionText> read_typed_waypoint(const std::string& text, const std::string& name, const Space& space) {
  Places places(name);
  require_utf8(text, places);
  try {
    const bool has_braces =
        text.find_first_not_of(' ') != std::string::npos && text[text.find_first_not_of(' ')] == '{';
    return read_waypoint(Field(places, only_document(has_braces ? text : "{" + text + "}", name), ""), space);
  } catch (const YAML::Exception& error) {
    throw InputError(
        fmt::format("{}: got '{}', expected a waypoint such as 'phi: 10 deg, theta: 0.3'", name, excerpt(text)),
        {name});
  }
}

CaseOfLegs load(const std::string& path, const CaseCheck& check, bool allows_legs,
                const std::function<void(const Space&)>& typed = {}) {
  errno = 0;
  std::ifstream file(path, std::ios::binary);
  std::string text(kMaxFileBytes + 1, '\0');
  if (!file.read(text.data(), static_cast<std::streamsize>(text.size())) && !file.eof()) {
    const char* reason = errno != 0 ? std::strerror(errno) : "no reason is known";
    throw InputError(ErrorCode::kFile, fmt::format("{}: could not read: {}", path, reason), {path});
  }
  text.resize(static_cast<std::size_t>(file.gcount()));
  return parse(text, path, check, allows_legs, typed);
}

}  // namespace

Case parse_case(const std::string& text, const std::string& name, const CaseCheck& check) {
  return with_error_code(ErrorCode::kCase, [&] { return parse(text, name, check, false).whole; });
}

Case load_case(const std::string& path, const CaseCheck& check) {
  return with_error_code(ErrorCode::kCase, [&] { return load(path, check, false).whole; });
}

CaseOfLegs parse_case_of_legs(const std::string& text, const std::string& name, const CaseCheck& check) {
  return with_error_code(ErrorCode::kCase, [&] { return parse(text, name, check, true); });
}

CaseOfLegs load_case_of_legs(const std::string& path, const CaseCheck& check) {
  return with_error_code(ErrorCode::kCase, [&] { return load(path, check, true); });
}

Case load_case_and_waypoint(const std::string& path, const std::string& text, const std::string& name,
                            TypedWaypoint& waypoint, const CaseCheck& check) {
  const auto read = [&](const Space& space) { waypoint = read_typed_waypoint(text, name, space); };
  const auto check_both = [&](const Case& the_case) {
    Problem from_there = the_case.problem;
    from_there.query = {waypoint, waypoint};
    try {
      validate(from_there);
    } catch (const FieldError& error) {
      const std::string coordinate = error.field().substr(error.field().rfind('.') + 1);
      throw InputError(fmt::format("{}: {}: got {}, {}", name, coordinate, error.seen(), error.expected()), {name});
    }
    if (check) check(the_case);
  };
  return with_error_code(ErrorCode::kCase, [&] { return load(path, check_both, false, read).whole; });
}

}  // namespace taut
