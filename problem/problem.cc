// SPDX-License-Identifier: GPL-3.0-or-later
#include "problem/problem.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>
#include <tuple>

#include "base/input_error.h"
#include "base/json_cursor.h"
#include "problem/decimal.h"
#include "problem/expression.h"
#include "problem/load.h"
#include "problem/rational.h"

namespace taut {
namespace {

using nlohmann::json;

// --- Reading -----------------------------------------------------------------------------------------------------

[[noreturn]] void fail_at(const std::string& where, const std::string& expected) {
  throw FieldError(where, "", expected);
}

void read(const JsonCursor& value, std::string& out) { out = value.text(); }

template <class T, std::size_t N>
void read(const JsonCursor& value, std::array<T, N>& out);
void read(const JsonCursor& value, Limits& out) {
  std::array<DecimalText, 2> pair;
  read(value, pair);
  out = {pair[0], pair[1]};
}

template <class T, std::size_t N>
void read(const JsonCursor& value, std::array<T, N>& out) {
  const std::vector<JsonCursor> elements = value.elements(N);
  for (std::size_t i = 0; i < N; ++i) read(elements[i], out[i]);
}

Parameter read_parameter(const JsonCursor& value) {
  const bool has_range = value.contains("range");
  if (has_range) {
    value.expect_keys({"name", "kind", "range"});
  } else {
    value.expect_keys({"name", "kind"});
  }
  Parameter parameter;
  read(value.at("name"), parameter.name);
  const JsonCursor kind = value.at("kind");
  if (kind.value() == "real") {
    parameter.kind = ParameterKind::kReal;
  } else if (kind.value() == "periodic") {
    parameter.kind = ParameterKind::kPeriodic;
  } else if (kind.value() == "range") {
    parameter.kind = ParameterKind::kRange;
  } else {
    kind.fail("\"real\", \"periodic\" or \"range\"");
  }
  if (has_range != (parameter.kind == ParameterKind::kRange)) {
    fail_at(value.where(), "expected 'range' exactly where the kind is \"range\"");
  }
  if (has_range) {
    std::array<ExpressionText, 2> range;
    read(value.at("range"), range);
    std::tie(parameter.range_lower, parameter.range_upper) = std::tie(range[0], range[1]);
  }
  return parameter;
}

TolerancesText read_tolerances(const JsonCursor& value) {
  value.expect_keys({"base_anchor_m", "platform_anchor_m", "load_point_m", "wrench", "position_m", "orientation_rad",
                     "cable_length_m"});
  TolerancesText result;
  read(value.at("base_anchor_m"), result.base_anchor_m);
  read(value.at("platform_anchor_m"), result.platform_anchor_m);
  read(value.at("load_point_m"), result.load_point_m);
  read(value.at("wrench"), result.wrench);
  read(value.at("position_m"), result.position_m);
  read(value.at("orientation_rad"), result.orientation_rad);
  if (const JsonCursor length = value.at("cable_length_m"); !length.is_null()) {
    read(length, result.cable_length_m.emplace());
  }
  return result;
}

/// Reads `space.angles`, which is absent for tilt-and-torsion angles.
AnglesText read_angles(const JsonCursor& value) {
  if (value.value() == name(AngleKind::kRollPitchYaw)) return {AngleKind::kRollPitchYaw};
  if (value.value() == name(AngleKind::kZyz)) return {AngleKind::kZyz};
  if (!value.value().is_object()) value.fail("\"roll-pitch-yaw\", \"zyz\" or an object with an axis");
  AnglesText angles{AngleKind::kAxis};
  value.expect_keys({"axis"});
  read(value.at("axis"), angles.axis);
  return angles;
}

SpaceText read_space(const JsonCursor& value) {
  SpaceText space;
  if (value.contains("angles")) {
    value.expect_keys({"angles", "parameters", "constants", "flip", "pose", "constraints"});
    space.angles = read_angles(value.at("angles"));
  } else {
    value.expect_keys({"parameters", "constants", "flip", "pose", "constraints"});
  }
  for (const JsonCursor& parameter : value.at("parameters").elements()) {
    space.parameters.push_back(read_parameter(parameter));
  }
  const JsonCursor constants = value.at("constants");
  if (!constants.value().is_object()) constants.fail("an object");
  for (const auto& [name, decimal] : constants.value().items()) {
    read({decimal, constants.where() + "." + name}, space.constants[name]);
  }
  if (const JsonCursor flip = value.at("flip"); !flip.is_null()) {
    const auto is_index = [&](const json& i) {
      return i.is_number_integer() && i >= 0 && i < static_cast<int>(space.parameters.size());
    };
    const json& pair = flip.value();
    if (!pair.is_array() || pair.size() != 2 || !is_index(pair[0]) || !is_index(pair[1])) {
      flip.fail("null or the indices of two parameters");
    }
    space.flip = {pair[0].get<int>(), pair[1].get<int>()};
  }
  const JsonCursor pose = value.at("pose");
  const std::vector<std::string> names = pose_names(space.angles.kind);
  pose.expect_keys(names);
  space.pose.fill("0");
  for (std::size_t i = 0; i < names.size(); ++i) read(pose.at(names[i].c_str()), space.pose[i]);
  for (const JsonCursor& constraint : value.at("constraints").elements()) {
    read(constraint, space.constraints.emplace_back());
  }
  return space;
}

// --- Writing -----------------------------------------------------------------------------------------------------

json limits_to_json(const std::array<Limits, kCables>& limits) {
  json list = json::array();
  for (const Limits& pair : limits) list.push_back({pair.lower, pair.upper});
  return list;
}

json parameter_to_json(const Parameter& parameter) {
  switch (parameter.kind) {
    case ParameterKind::kReal: return {{"name", parameter.name}, {"kind", "real"}};
    case ParameterKind::kPeriodic: return {{"name", parameter.name}, {"kind", "periodic"}};
    case ParameterKind::kRange: break;
  }
  return {{"name", parameter.name},
          {"kind", "range"},
          {"range", json::array({parameter.range_lower, parameter.range_upper})}};
}

json tolerances_to_json(const TolerancesText& tolerances) {
  json cable_length = nullptr;
  if (tolerances.cable_length_m) cable_length = *tolerances.cable_length_m;
  return {{"base_anchor_m", tolerances.base_anchor_m}, {"platform_anchor_m", tolerances.platform_anchor_m},
          {"load_point_m", tolerances.load_point_m},   {"wrench", tolerances.wrench},
          {"position_m", tolerances.position_m},       {"orientation_rad", tolerances.orientation_rad},
          {"cable_length_m", std::move(cable_length)}};
}

// --- Validating --------------------------------------------------------------------------------------------------

/// Calls `check`; an InputError that it throws becomes a FieldError at `where`.
template <class Check>
auto at(const std::string& where, Check check) {
  try {
    return check();
  } catch (const InputError& error) {
    fail_at(where, error.what());
  }
}

using Point = std::array<Decimal, 3>;

Point point_at(const std::string& where, const std::array<DecimalText, 3>& coordinates) {
  Point point;
  for (std::size_t k = 0; k < 3; ++k) point[k] = decimal_at(fmt::format("{}[{}]", where, k), coordinates[k]);
  return point;
}

std::array<Point, kCables> validate_anchors(const std::string& where,
                                            const std::array<std::array<DecimalText, 3>, kCables>& anchors) {
  std::array<Point, kCables> points;
  for (std::size_t i = 0; i < kCables; ++i) points[i] = point_at(fmt::format("{}[{}]", where, i), anchors[i]);
  if (std::all_of(points.begin(), points.end(), [&](const Point& point) { return point == points[0]; })) {
    throw FieldError(where, "the same point six times", "expected at least two different anchors");
  }
  return points;
}

void validate_limits(const std::string& where, const std::array<Limits, kCables>& limits) {
  for (std::size_t i = 0; i < limits.size(); ++i) {
    const std::string here = fmt::format("{}[{}]", where, i);
    const Decimal lower = decimal_at(here + "[0]", limits[i].lower);
    const Decimal upper = decimal_at(here + "[1]", limits[i].upper);
    if (lower.sign() < 0 || lower >= upper) {
      throw FieldError(here, fmt::format("[{}, {}]", limits[i].lower, limits[i].upper), "expected 0 <= lower < upper");
    }
  }
}

void validate_robot(const RobotText& robot) {
  const auto a = validate_anchors("robot.base_anchors", robot.base_anchors_m);
  const auto b = validate_anchors("robot.platform_anchors", robot.platform_anchors_m);
  for (std::size_t i = 0; i < kCables; ++i) {
    for (std::size_t j = 0; j < i; ++j) {
      if (a[i] == a[j] && b[i] == b[j]) {
        throw FieldError("robot", fmt::format("the same two anchors for cables {} and {}", j + 1, i + 1),
                         "expected six different cables");
      }
    }
  }
  validate_limits("robot.tension", robot.tension_N);
  validate_limits("robot.length", robot.length_m);
}

/// Approximate value, to tell mistakes; closer calls are left to the proof.
double constant_value_approx(const std::string& where, const ExpressionText& expression) {
  const double value = at(where, [&] { return evaluate_constant<double>(expression); });
  if (!std::isfinite(value))
    throw FieldError(where, "'" + expression + "'", "expected an expression with a finite value");
  return value;
}

std::array<double, 2> range_approx(const Parameter& parameter) {
  const std::string here = "space.parameters." + parameter.name;
  return {constant_value_approx(here + "[0]", parameter.range_lower),
          constant_value_approx(here + "[1]", parameter.range_upper)};
}

void validate_tolerance(const std::string& name, const DecimalText& text) {
  const std::string where = "tolerances." + name;
  if (decimal_at(where, text).sign() < 0) throw FieldError(where, text, "expected a tolerance >= 0");
}

void validate_tolerances(const TolerancesText& tolerances) {
  for (std::size_t i = 0; i < kCables; ++i) {
    validate_tolerance(fmt::format("base_anchors[{}]", i), tolerances.base_anchor_m[i]);
    validate_tolerance(fmt::format("platform_anchors[{}]", i), tolerances.platform_anchor_m[i]);
    if (tolerances.cable_length_m) {
      validate_tolerance(fmt::format("cable_length[{}]", i), (*tolerances.cable_length_m)[i]);
    }
  }
  validate_tolerance("load_point", tolerances.load_point_m);
  for (std::size_t i = 0; i < tolerances.wrench.size(); ++i) {
    static_cast<void>(decimal_at(fmt::format("tolerances.wrench[{}]", i), tolerances.wrench[i]));
  }
  validate_tolerance("position", tolerances.position_m);
  const double angle = constant_value_approx("tolerances.orientation", tolerances.orientation_rad);
  if (!(angle >= 0 && angle < 1)) {
    throw FieldError("tolerances.orientation", "'" + tolerances.orientation_rad + "'",
                     "expected an angle from 0 to below 1 rad");
  }
}

/// The place of a coordinate of the pose, in messages. @pre the pose has it
std::string place(const SpaceText& space, std::size_t i) { return "space.pose." + pose_names(space.angles.kind).at(i); }

void validate_angles(const SpaceText& space) {
  const AnglesText& angles = space.angles;
  if (angles.kind != AngleKind::kAxis) return;
  const Point axis = point_at("space.angles.axis", angles.axis);
  // So that the squares of its numbers are within binary64.
  const auto is_below = [](const Decimal& x, const char* limit) {
    return boost::multiprecision::abs(x.rational()) < Decimal::parse(limit).rational();
  };
  const bool is_small = std::ranges::all_of(axis, [&](const Decimal& x) { return is_below(x, "1e-9"); });
  if (is_small || !std::ranges::all_of(axis, [&](const Decimal& x) { return is_below(x, "1e9"); })) {
    throw FieldError("space.angles.axis", fmt::format("[{}]", fmt::join(angles.axis, ", ")),
                     "expected a direction: three numbers, the largest of which is at least 1e-9 and below 1e9");
  }
  if (space.pose[4] != "0" || space.pose[5] != "0")
    fail_at("space.pose", "expected one angle: the turn about the axis");
}

/// Items of a load have tolerances of their own.
void validate_no_tolerance_of_the_load(const TolerancesText& tolerances) {
  const auto require_zero = [](const std::string& where, const DecimalText& text) {
    if (Decimal::parse(text).sign() == 0) return;
    throw FieldError(where, text,
                     "expected none, as the load has items: say 'mass_tolerance' and 'at_tolerance' there");
  };
  require_zero("tolerances.load_point", tolerances.load_point_m);
  for (std::size_t i = 0; i < tolerances.wrench.size(); ++i) {
    require_zero(fmt::format("tolerances.wrench[{}]", i), tolerances.wrench[i]);
  }
}

void validate_flip(const SpaceText& space, const ExpressionTape& pose) {
  if (space.angles.kind != AngleKind::kTiltAndTorsion) fail_at("space.flip", "expected null but for tilt-and-torsion");
  const auto [phi, theta] = *space.flip;
  const bool is_phi_theta =
      phi != theta && space.pose[3] == space.parameters[phi].name && space.pose[4] == space.parameters[theta].name &&
      space.parameters[phi].kind == ParameterKind::kPeriodic && space.parameters[theta].kind == ParameterKind::kReal;
  bool is_elsewhere = false;
  for (const int i : {0, 1, 2, 5}) is_elsewhere |= pose.depends_on(i, phi) || pose.depends_on(i, theta);
  if (!is_phi_theta || is_elsewhere) {
    fail_at("space.flip",
            "expected a periodic and a real parameter that are pose.phi and pose.theta themselves and occur "
            "in no other expression of the pose");
  }
}

void validate_periods(const SpaceText& space, const ExpressionTape& pose) {
  for (std::size_t j = 0; j < space.parameters.size(); ++j) {
    if (space.parameters[j].kind != ParameterKind::kPeriodic) continue;
    for (std::size_t i = 0; i < space.pose.size(); ++i) {
      const bool is_angle = i >= 3;
      const std::optional<int> turns = pose.turns(static_cast<int>(i), static_cast<int>(j));
      if (turns && (is_angle || *turns == 0)) continue;
      throw FieldError(place(space, i), "'" + space.pose[i] + "'",
                       fmt::format("expected the same {} when the periodic parameter {} grows by 2*pi, and plainly so",
                                   is_angle ? "angle" : "value", space.parameters[j].name));
    }
  }
}

void validate_constraints(const SpaceText& space, const std::vector<std::string>& names) {
  if (space.constraints.empty()) return;
  if (space.parameters.size() > kMaxConstrainedParameters) {
    throw FieldError("space.parameters", fmt::format("{} parameters", space.parameters.size()),
                     fmt::format("expected at most {} in a space with constraints", kMaxConstrainedParameters));
  }
  if (space.constraints.size() >= space.parameters.size()) {
    throw FieldError("space.constraints", fmt::format("{} constraints", space.constraints.size()),
                     fmt::format("expected fewer than the {} parameters", space.parameters.size()));
  }
  for (std::size_t i = 0; i < space.constraints.size(); ++i) {
    const std::string here = fmt::format("space.constraints[{}]", i);
    const ExpressionTape tape =
        at(here, [&] { return ExpressionTape({space.constraints[i]}, names, space.constants); });
    for (std::size_t j = 0; j < space.parameters.size(); ++j) {
      if (space.parameters[j].kind == ParameterKind::kPeriodic && tape.turns(0, static_cast<int>(j)) != 0) {
        throw FieldError(
            here, "'" + space.constraints[i] + "'",
            fmt::format("expected the same value when the periodic parameter {} grows by 2*pi, and plainly so",
                        space.parameters[j].name));
      }
      if (space.flip && tape.depends_on(0, static_cast<int>(j)) &&
          (static_cast<int>(j) == (*space.flip)[0] || static_cast<int>(j) == (*space.flip)[1])) {
        throw FieldError(here, "'" + space.constraints[i] + "'",
                         "expected no mention of phi and theta where they flip");
      }
    }
  }
  at("space.constraints", [&] { return ExpressionTape(space.constraints, names, space.constants); });
}

void validate_space(const SpaceText& space) {
  if (space.parameters.empty()) fail_at("space.parameters", "expected at least one parameter");
  std::vector<std::string> names;
  for (const Parameter& parameter : space.parameters) {
    names.push_back(parameter.name);
    if (parameter.kind != ParameterKind::kRange) continue;
    if (const auto [lower, upper] = range_approx(parameter); !(lower < upper)) {
      throw FieldError("space.parameters." + parameter.name,
                       fmt::format("[{}, {}]", parameter.range_lower, parameter.range_upper), "expected lower < upper");
    }
  }
  at("space.parameters", [&] { return ExpressionTape({}, names, space.constants); });
  for (const auto& [name, text] : space.constants) static_cast<void>(decimal_at("space.constants." + name, text));
  for (std::size_t i = 0; i < space.pose.size(); ++i) {
    const bool is_named = i < pose_names(space.angles.kind).size();
    at(is_named ? place(space, i) : "space.pose",
       [&] { return ExpressionTape({space.pose[i]}, names, space.constants); });
  }
  const ExpressionTape pose = at("space.pose", [&] {
    return ExpressionTape({space.pose.begin(), space.pose.end()}, names, space.constants);
  });
  validate_angles(space);
  validate_periods(space, pose);
  if (space.flip) validate_flip(space, pose);
  validate_constraints(space, names);
}

/// Checks that the pose is defined at a waypoint. Whether it is defined in between is for the proof to decide.
void validate_pose_at(const SpaceText& space, std::size_t waypoint, const std::vector<double>& parameters) {
  std::vector<std::string> names;
  for (const Parameter& parameter : space.parameters) names.push_back(parameter.name);
  std::array<double, 6> pose = {};
  Evaluator<double>(ExpressionTape({space.pose.begin(), space.pose.end()}, names, space.constants))
      .evaluate(parameters, pose);
  for (std::size_t i = 0; i < pose.size(); ++i) {
    if (!std::isfinite(pose[i])) {
      throw FieldError(place(space, i), "'" + space.pose[i] + "'",
                       fmt::format("expected an expression with a finite value at query.waypoints[{}]", waypoint));
    }
  }
}

void validate_query(const Problem& problem) {
  const std::vector<Parameter>& parameters = problem.space.parameters;
  if (problem.query.size() == 1) {
    throw FieldError("query.waypoints", fmt::format("{} waypoints", problem.query.size()), "expected at least two");
  }
  for (std::size_t k = 0; k < problem.query.size(); ++k) {
    const std::vector<ExpressionText>& waypoint = problem.query[k];
    const std::string here = fmt::format("query.waypoints[{}]", k);
    if (waypoint.size() != parameters.size()) {
      throw FieldError(here, fmt::format("{} values", waypoint.size()),
                       fmt::format("expected {}, one a parameter", parameters.size()));
    }
    std::vector<double> values;
    for (std::size_t j = 0; j < parameters.size(); ++j) {
      const std::string place = fmt::format("{}.{}", here, parameters[j].name);
      const double value = values.emplace_back(constant_value_approx(place, waypoint[j]));
      if (parameters[j].kind != ParameterKind::kRange) continue;
      const auto [lower, upper] = range_approx(parameters[j]);
      constexpr double kSlack = 1e-12;  // well above the rounding of a short expression
      const double slack = kSlack * std::max(std::abs(lower), std::abs(upper));
      if (value < lower - slack || value > upper + slack) {
        throw FieldError(place, fmt::format("'{}', which is {:.6g}", waypoint[j], value),
                         fmt::format("expected a value in the parameter's range [{}, {}] (SI: m, rad)",
                                     parameters[j].range_lower, parameters[j].range_upper));
      }
    }
    validate_pose_at(problem.space, k, values);
  }
}

/// Checks the limits in time, and what only a problem with them may state, or may not.
void validate_time(const Problem& problem) {
  bool has_mass = false;
  for (const LoadItem& item : problem.load.items) {
    const auto* weight = std::get_if<Weight>(&item.what);
    if (!weight) continue;
    has_mass |= parse_rational(weight->mass_upper) > 0;
    if (!problem.time && weight->inertia_box) {
      throw FieldError(fmt::format("load.items[{}].inertia", item.name), "a box",
                       "expected none in a problem without 'time'");
    }
  }
  if (!problem.time) return;
  validate(*problem.time);
  if (problem.time->rows && !problem.tolerances) {
    throw FieldError("tolerances", "none", "expected some, if all zero, beside 'time.rows'");
  }
  if (!has_mass) {
    throw FieldError("load.items", "no mass", "expected a load with at least one item of kind 'mass' beside 'time'");
  }
}

}  // namespace

const char* name(AngleKind kind) {
  switch (kind) {
    case AngleKind::kTiltAndTorsion: return "tilt-and-torsion";
    case AngleKind::kRollPitchYaw: return "roll-pitch-yaw";
    case AngleKind::kZyz: return "zyz";
    case AngleKind::kAxis: break;
  }
  return "axis";
}

const char* angles_text(AngleKind kind) {
  switch (kind) {
    case AngleKind::kTiltAndTorsion: return "tilt-and-torsion angles";
    case AngleKind::kRollPitchYaw: return "roll-pitch-yaw angles";
    case AngleKind::kZyz: return "ZYZ Euler angles";
    case AngleKind::kAxis: break;
  }
  return "a turn about an axis";
}

std::vector<std::string> pose_names(AngleKind kind) {
  switch (kind) {
    case AngleKind::kTiltAndTorsion: return {"px", "py", "pz", "phi", "theta", "sigma"};
    case AngleKind::kRollPitchYaw: return {"px", "py", "pz", "roll", "pitch", "yaw"};
    case AngleKind::kZyz: return {"px", "py", "pz", "alpha", "beta", "gamma"};
    case AngleKind::kAxis: break;
  }
  return {"px", "py", "pz", "turn"};
}

std::string angles_hint(const std::string& word, AngleKind chosen) {
  if (chosen == AngleKind::kTiltAndTorsion && (word == "tilt" || word == "torsion")) {
    return fmt::format("which is called {}, ", word == "tilt" ? "theta (towards phi)" : "sigma");
  }
  const bool is_common = word == "rx" || word == "ry" || word == "rz" || word == "heading";
  for (const AngleKind kind :
       {AngleKind::kTiltAndTorsion, AngleKind::kRollPitchYaw, AngleKind::kZyz, AngleKind::kAxis}) {
    const std::vector<std::string> names = pose_names(kind);
    const bool is_angle = std::find(names.begin() + 3, names.end(), word) != names.end();
    if (kind == chosen || !(is_angle || (is_common && kind == AngleKind::kRollPitchYaw))) continue;
    const std::string value = kind == AngleKind::kAxis ? "{axis: [x, y, z]}" : name(kind);
    return fmt::format("which is understood with 'angles: {}' under 'space' of the case (it has {}), ", value,
                       angles_text(chosen));
  }
  return "";
}

bool is_turn(AngleKind kind, std::size_t i) {
  // A tilt theta is real: its other half turn is the flip's.
  return i >= 3 && !(kind == AngleKind::kTiltAndTorsion && i == 4);
}

SpaceText coordinate_space(const AnglesText& angles) {
  SpaceText space;
  space.angles = angles;
  space.pose.fill("0");
  const std::vector<std::string> names = pose_names(angles.kind);
  for (std::size_t i = 0; i < names.size(); ++i) {
    const ParameterKind kind = is_turn(angles.kind, i) ? ParameterKind::kPeriodic : ParameterKind::kReal;
    space.parameters.push_back({names[i], kind, "", ""});
    space.pose[i] = names[i];
  }
  if (angles.kind == AngleKind::kTiltAndTorsion) space.flip = {3, 4};
  return space;
}

json to_json(const Problem& problem) {
  json parameters = json::array();
  for (const Parameter& parameter : problem.space.parameters) parameters.push_back(parameter_to_json(parameter));
  json pose = json::object();
  const std::vector<std::string> names = pose_names(problem.space.angles.kind);
  for (std::size_t i = 0; i < names.size(); ++i) pose[names[i]] = problem.space.pose[i];
  json flip = nullptr;
  if (problem.space.flip) flip = *problem.space.flip;
  json space = {{"parameters", std::move(parameters)},
                {"constants", problem.space.constants},
                {"flip", std::move(flip)},
                {"pose", std::move(pose)},
                {"constraints", problem.space.constraints}};
  if (const AnglesText& angles = problem.space.angles; angles.kind == AngleKind::kAxis) {
    space["angles"] = {{"axis", angles.axis}};
  } else if (angles.kind != AngleKind::kTiltAndTorsion) {
    space["angles"] = name(angles.kind);
  }
  json result = {{"name", problem.name},
                 {"robot",
                  {{"base_anchors_m", problem.robot.base_anchors_m},
                   {"platform_anchors_m", problem.robot.platform_anchors_m},
                   {"tension_N", limits_to_json(problem.robot.tension_N)},
                   {"length_m", limits_to_json(problem.robot.length_m)}}},
                 {"load", to_json(problem.load)},
                 {"tolerances", problem.tolerances ? tolerances_to_json(*problem.tolerances) : json()},
                 {"space", std::move(space)},
                 {"query", {{"waypoints", problem.query}}}};
  if (problem.bodies) result["bodies"] = to_json(*problem.bodies);
  if (problem.time) result["time"] = to_json(*problem.time);
  return result;
}

Problem problem_from_json(const json& value) {
  const auto member = [&](const char* key) -> JsonCursor { return {value[key], key}; };
  const JsonCursor whole(value, "problem");
  const bool has_bodies = whole.contains("bodies");
  const bool has_time = whole.contains("time");
  std::vector<std::string> keys = {"name", "robot", "load", "tolerances", "space", "query"};
  if (has_bodies) keys.emplace_back("bodies");
  if (has_time) keys.emplace_back("time");
  whole.expect_keys(keys);
  Problem problem;
  read(member("name"), problem.name);
  const JsonCursor robot = member("robot");
  robot.expect_keys({"base_anchors_m", "platform_anchors_m", "tension_N", "length_m"});
  read(robot.at("base_anchors_m"), problem.robot.base_anchors_m);
  read(robot.at("platform_anchors_m"), problem.robot.platform_anchors_m);
  read(robot.at("tension_N"), problem.robot.tension_N);
  read(robot.at("length_m"), problem.robot.length_m);
  problem.load = load_from_json(member("load"));
  if (const JsonCursor tolerances = member("tolerances"); !tolerances.is_null()) {
    problem.tolerances = read_tolerances(tolerances);
  }
  problem.space = read_space(member("space"));
  for (const JsonCursor& waypoint : member("query").expect_keys({"waypoints"}).at("waypoints").elements()) {
    std::vector<ExpressionText>& values = problem.query.emplace_back();
    for (const JsonCursor& entry : waypoint.elements()) read(entry, values.emplace_back());
  }
  if (has_bodies) problem.bodies = bodies_from_json(member("bodies"));
  if (has_time) problem.time = time_from_json(member("time"));
  validate(problem);
  return problem;
}

void validate(const Problem& problem) {
  validate_robot(problem.robot);
  validate(problem.load);
  if (problem.tolerances) {
    validate_tolerances(*problem.tolerances);
    if (!problem.load.items.empty()) validate_no_tolerance_of_the_load(*problem.tolerances);
  }
  validate_space(problem.space);
  if (problem.bodies) validate(*problem.bodies);
  validate_query(problem);
  validate_time(problem);
}

Problem without_time(Problem problem) {
  problem.time.reset();
  for (LoadItem& item : problem.load.items) {
    if (auto* weight = std::get_if<Weight>(&item.what)) weight->inertia_box.reset();
  }
  return problem;
}

}  // namespace taut
