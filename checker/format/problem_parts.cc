// SPDX-License-Identifier: GPL-3.0-or-later
#include "checker/format/expression_parser.h"
#include "checker/format/parts.h"
#include "checker/kernel/errors.h"
#include "checker/kernel/mean_value_form.h"

namespace taut::checker {
namespace {

constexpr std::size_t kMaxParameters = 64;  ///< bounds the work of everything that is done for each of them
constexpr std::size_t kMaxConstrainedParameters = 6;
constexpr std::array<const char*, 6> kPoseNames = {"px", "py", "pz", "phi", "theta", "sigma"};

Expression expression(const Cursor& json, const Names& names) {
  return parse_expression(json.text(), names, json.where());
}

Expression constant(const Cursor& json) { return expression(json, {}); }

std::array<Limits, kCables> limits(const Cursor& json) {
  const auto rows = json.decimal_rows<kCables, 2>();
  std::array<Limits, kCables> result;
  for (std::size_t i = 0; i < kCables; ++i) {
    if (rows[i][0] < 0 || rows[i][0] >= rows[i][1]) json.at(i).fail("0 <= lower < upper");
    result[i] = {rows[i][0], rows[i][1]};
  }
  return result;
}

mpq_class tolerance(const Cursor& json) {
  mpq_class result = json.decimal();
  if (result < 0) json.fail("a tolerance >= 0");
  return result;
}

std::array<mpq_class, kCables> tolerances_of_cables(const Cursor& json) {
  json.array(kCables);
  std::array<mpq_class, kCables> result;
  for (std::size_t i = 0; i < kCables; ++i) result[i] = tolerance(json.at(i));
  return result;
}

/// A constant expression whose value is certainly below 1, and not certainly below 0.
Expression tolerance_of_angle(const Cursor& json) {
  constexpr const char* kExpected = "an angle from 0 to below 1";
  Expression result = constant(json);
  try {
    const WorkingPrecision precision(128);
    const Ball value = result.evaluate<MeanValueForm>({}).range();
    if (certainly_negative(value) || !certainly_positive(Ball(1) - value)) json.fail(kExpected);
  } catch (const Undefined& why) {
    json.fail(std::string(kExpected) + ", not " + why.what());
  }
  return result;
}

ToleranceBounds read_tolerances(const Cursor& json) {
  json.object({"base_anchor_m", "cable_length_m", "load_point_m", "orientation_rad", "platform_anchor_m", "position_m",
               "wrench"});
  ToleranceBounds result;
  result.base_anchors = tolerances_of_cables(json["base_anchor_m"]);
  result.platform_anchors = tolerances_of_cables(json["platform_anchor_m"]);
  result.load_point = tolerance(json["load_point_m"]);
  result.wrench = json["wrench"].decimals<6>();
  result.position = tolerance(json["position_m"]);
  result.orientation = tolerance_of_angle(json["orientation_rad"]);
  const Cursor lengths = json["cable_length_m"];
  if (!lengths.is_null()) result.cable_length = tolerances_of_cables(lengths);
  return result;
}

/// Appends the parameter and its name.
void read_parameter(const Cursor& json, Problem& problem, Names& names) {
  json.object({"kind", "name"}, {"range"});
  const bool is_range = json.has("range");
  Parameter parameter;
  parameter.name = json["name"].text();
  const bool is_taken = names.constants.contains(parameter.name) ||
                        std::ranges::find(names.parameters, parameter.name) != names.parameters.end();
  if (!is_free_name(parameter.name) || is_taken) json["name"].fail("a name that nothing else has");
  constexpr const char* kExpected = "real, periodic, or range with its ends";
  parameter.kind = json["kind"].one_of<ParameterKind>(
      {{"real", ParameterKind::kReal}, {"periodic", ParameterKind::kPeriodic}, {"range", ParameterKind::kRange}},
      kExpected);
  if (is_range != (parameter.kind == ParameterKind::kRange)) json["kind"].fail(kExpected);
  if (is_range) {
    const Cursor range = json["range"];
    range.array(2);
    parameter.lower = constant(range.at(0));
    parameter.upper = constant(range.at(1));
  }
  names.parameters.push_back(parameter.name);
  problem.parameters.push_back(std::move(parameter));
}

/// Pose and constraints are the same after a turn of any periodic parameter.
void require_closed(const Cursor& space, const Problem& problem) {
  const Cursor pose = space["pose"];
  const Cursor constraints = space["constraints"];
  for (std::size_t j = 0; j < problem.parameters.size(); ++j) {
    if (problem.parameters[j].kind != ParameterKind::kPeriodic) continue;
    const std::string expected =
        ", by its form, where the periodic parameter '" + problem.parameters[j].name + "' grows by 2 pi";
    for (std::size_t i = 0; i < problem.constraints.size(); ++i) {
      if (turns(problem.constraints[i], j) != 0) constraints.at(i).fail("the same value" + expected);
    }
    for (std::size_t c = 0; c < 6; ++c) {
      const std::optional<long> k = turns(problem.pose[c], j);
      const bool is_angle = c >= 3;
      if (!k || (!is_angle && *k != 0)) pose[kPoseNames[c]].fail("the same pose" + expected);
    }
  }
}

/// Where (phi, theta) and (phi + pi, -theta) are the same pose.
void read_flip(const Cursor& json, const Json& pose, Problem& problem) {
  json.array(2);
  const auto last = static_cast<std::int64_t>(problem.parameters.size()) - 1;
  const auto phi = static_cast<std::size_t>(json.at(0).integer(0, last));
  const auto theta = static_cast<std::size_t>(json.at(1).integer(0, last));
  const Parameter& first = problem.parameters[phi];
  const Parameter& second = problem.parameters[theta];
  if (phi == theta || pose["phi"] != first.name || pose["theta"] != second.name) {
    json.fail("the parameters that are phi and theta themselves");
  }
  if (first.kind != ParameterKind::kPeriodic || second.kind != ParameterKind::kReal) {
    json.fail("phi of kind periodic and theta of kind real");
  }
  const auto mentions_either = [&](const Expression& x) { return mentions(x, phi) || mentions(x, theta); };
  for (const std::size_t c : {0, 1, 2, 5}) {
    if (mentions_either(problem.pose[c])) {
      json.fail(std::string("a pose whose ") + kPoseNames[c] + " mentions neither phi nor theta");
    }
  }
  if (std::ranges::any_of(problem.constraints, mentions_either)) {
    json.fail("constraints that mention neither phi nor theta");
  }
  problem.flip = {phi, theta};
}

void read_space(const Cursor& json, Problem& problem) {
  json.object({"constants", "constraints", "flip", "parameters", "pose"});
  Names names;
  const Cursor constants = json["constants"];
  if (!constants.json().is_object()) constants.fail("an object");
  for (const auto& item : constants.json().items()) {
    if (!is_free_name(item.key())) constants.fail("a name, not '" + item.key() + "'");
    names.constants[item.key()] = constants[item.key().c_str()].decimal();
  }
  const Cursor parameters = json["parameters"];
  if (parameters.size() == 0 || parameters.size() > kMaxParameters) parameters.fail("1 to 64 parameters");
  for (std::size_t j = 0; j < parameters.size(); ++j) read_parameter(parameters.at(j), problem, names);
  const Cursor pose = json["pose"];
  pose.object({kPoseNames.begin(), kPoseNames.end()});
  for (std::size_t c = 0; c < 6; ++c) problem.pose[c] = expression(pose[kPoseNames[c]], names);
  const Cursor constraints = json["constraints"];
  for (std::size_t i = 0; i < constraints.size(); ++i) {
    problem.constraints.push_back(expression(constraints.at(i), names));
  }
  const std::size_t n = problem.parameters.size();
  if (constraints.size() > 0 && (n > kMaxConstrainedParameters || constraints.size() >= n)) {
    constraints.fail("fewer constraints than parameters, and at most 6 of these");
  }
  require_closed(json, problem);
  const Cursor flip = json["flip"];
  if (!flip.is_null()) read_flip(flip, pose.json(), problem);
}

void read_query(const Cursor& json, Problem& problem) {
  json.object({"waypoints"});
  const Cursor waypoints = json["waypoints"];
  if (waypoints.size() == 1) waypoints.fail("none, or at least two waypoints");
  for (std::size_t k = 0; k < waypoints.size(); ++k) {
    const Cursor waypoint = waypoints.at(k);
    waypoint.array(problem.parameters.size());
    std::vector<Expression>& x = problem.query.emplace_back();
    for (std::size_t j = 0; j < waypoint.size(); ++j) x.push_back(constant(waypoint.at(j)));
  }
}

}  // namespace

Problem read_problem(const Cursor& json) {
  json.object({"load", "name", "query", "robot", "space", "tolerances"});
  (void)json["name"].text();
  Problem problem;
  const Cursor robot = json["robot"];
  robot.object({"base_anchors_m", "length_m", "platform_anchors_m", "tension_N"});
  problem.base_anchors = robot["base_anchors_m"].decimal_rows<kCables, 3>();
  problem.platform_anchors = robot["platform_anchors_m"].decimal_rows<kCables, 3>();
  problem.tension = limits(robot["tension_N"]);
  problem.length = limits(robot["length_m"]);
  const Cursor load = json["load"];
  load.object({"ellipsoid", "point_m", "wrench"});
  problem.load_point = load["point_m"].decimals<3>();
  problem.wrench = load["wrench"].decimals<6>();
  problem.ellipsoid = load["ellipsoid"].decimal_rows<6, 6>();
  for (std::size_t i = 0; i < 6; ++i) {
    for (std::size_t j = 0; j < i; ++j) {
      if (problem.ellipsoid[i][j] != problem.ellipsoid[j][i]) load["ellipsoid"].fail("a symmetric matrix");
    }
  }
  const Cursor tolerances = json["tolerances"];
  if (!tolerances.is_null()) problem.tolerances = read_tolerances(tolerances);
  read_space(json["space"], problem);
  read_query(json["query"], problem);
  return problem;
}

const Json& coordinate_space() {
  static const Json kSpace = Json::parse(R"({
    "parameters": [{"name": "px", "kind": "real"}, {"name": "py", "kind": "real"}, {"name": "pz", "kind": "real"},
                   {"name": "phi", "kind": "periodic"}, {"name": "theta", "kind": "real"},
                   {"name": "sigma", "kind": "periodic"}],
    "constants": {}, "flip": [3, 4], "constraints": [],
    "pose": {"px": "px", "py": "py", "pz": "pz", "phi": "phi", "theta": "theta", "sigma": "sigma"}})");
  return kSpace;
}

}  // namespace taut::checker
