// SPDX-License-Identifier: GPL-3.0-or-later
#include "checker/format/expression_parser.h"
#include "checker/format/parts.h"
#include "checker/kernel/errors.h"
#include "checker/kernel/mean_value_form.h"
#include "checker/kernel/moving.h"

namespace taut::checker {
namespace {

constexpr std::size_t kMaxParameters = 64;  ///< bounds the work of everything that is done for each of them
constexpr std::size_t kMaxConstrainedParameters = 6;

/// px, py, pz and the angles; for kAxis, which has one angle, two null pointers behind it.
std::array<const char*, 6> pose_names(AngleKind angles) {
  switch (angles) {
    case AngleKind::kTiltAndTorsion: break;
    case AngleKind::kRollPitchYaw: return {"px", "py", "pz", "roll", "pitch", "yaw"};
    case AngleKind::kZyz: return {"px", "py", "pz", "alpha", "beta", "gamma"};
    case AngleKind::kAxis: return {"px", "py", "pz", "turn", nullptr, nullptr};
  }
  return {"px", "py", "pz", "phi", "theta", "sigma"};
}

Expression expression(const Cursor& json, const Names& names) {
  return parse_expression(json.text(), names, json.where());
}

/// Reads a constant expression.
auto constant(Expression& x) {
  return [&x](const Cursor& json) { x = expression(json, {}); };
}

/// A constant expression whose value is certainly below 1, and not certainly below 0.
void read_angle(const Cursor& json, Expression& angle) {
  constexpr const char* kExpected = "an angle from 0 to below 1";
  constant(angle)(json);
  try {
    const WorkingPrecision precision(128);
    const Ball value = angle.evaluate<MeanValueForm>({}).range();
    json.require(!certainly_negative(value) && certainly_positive(Ball(1) - value), kExpected);
  } catch (const Undefined& why) {
    json.fail(std::string(kExpected) + ", not " + why.what());
  }
}

/// A constant expression whose value is certainly above 0.
void read_limit_in_time(const Cursor& json, std::optional<Expression>& limit) {
  constexpr const char* kExpected = "a limit above 0";
  constant(limit.emplace())(json);
  try {
    const WorkingPrecision precision(128);
    json.require(certainly_positive(limit->evaluate<MeanValueForm>({}).range()), kExpected);
  } catch (const Undefined& why) {
    json.fail(std::string(kExpected) + ", not " + why.what());
  }
}

/// Of each cable, null where it has none.
void read_limits_in_time(const Cursor& json, std::array<std::optional<Expression>, kCables>& limits) {
  json.require_size(kCables);
  json.elements([&](const Cursor& here, std::size_t i) {
    if (!here.is_null()) read_limit_in_time(here, limits[i]);
  });
  json.require(std::ranges::any_of(limits, [](const auto& limit) { return limit.has_value(); }),
               "a limit of some cable");
}

void read_time(const Cursor& json, TimeLimits& limits) {
  const auto of_load = [](std::optional<Expression>& limit) {
    return [&limit](const Cursor& here) { read_limit_in_time(here, limit); };
  };
  const auto of_winches = [](std::array<std::optional<Expression>, kCables>& of_each) {
    return [&of_each](const Cursor& here) { read_limits_in_time(here, of_each); };
  };
  const auto of_rows = [&](const Cursor& here) {
    Rows& rows = limits.rows.emplace();
    here.object("error_m", rows.error, "step_s", rows.step);
    here["step_s"].require(rows.step > 0, "a time above 0");
  };
  json.object("load_acceleration_m_s2?", of_load(limits.load_acceleration), "load_angular_acceleration_rad_s2?",
              of_load(limits.load_angular_acceleration), "load_angular_speed_rad_s?",
              of_load(limits.load_angular_speed), "load_speed_m_s?", of_load(limits.load_speed), "rows?", of_rows,
              "stopping_time_s?", of_load(limits.stopping_time), "winch_acceleration_m_s2?",
              of_winches(limits.winch_acceleration), "winch_power_W?", of_winches(limits.winch_power),
              "winch_speed_m_s?", of_winches(limits.winch_speed));
  const std::size_t others = (limits.rows ? 1 : 0) + (limits.stopping_time ? 1 : 0);
  json.require(json.json().size() > others, "at least one limit");
}

void require_tolerance(const Cursor& json, const mpq_class& x) { json.require(x >= 0, "a tolerance >= 0"); }
void require_tolerance(const Cursor& json, const std::array<mpq_class, kCables>& x) {
  for (std::size_t i = 0; i < kCables; ++i) require_tolerance(json.at(i), x[i]);
}

/// Appends the parameter and its name.
void read_parameter(const Cursor& json, Problem& problem, Names& names) {
  using Kind = ParameterKind;
  static constexpr std::array<std::pair<const char*, Kind>, 3> kKinds = {
      {{"real", Kind::kReal}, {"periodic", Kind::kPeriodic}, {"range", Kind::kRange}}};
  constexpr const char* kExpected = "real, periodic, or range with its ends";
  Parameter parameter;
  json.object(
      "name", parameter.name, "kind",
      [&](const Cursor& kind) { parameter.kind = kind.one_of<Kind>(kKinds, kExpected); }, "range?",
      [&](const Cursor& range) {
        range.require_size(2);
        constant(parameter.lower)(range.at(0));
        constant(parameter.upper)(range.at(1));
      });
  const bool is_taken = names.constants.contains(parameter.name) ||
                        std::ranges::find(names.parameters, parameter.name) != names.parameters.end();
  json["name"].require(is_free_name(parameter.name) && !is_taken, "a name that nothing else has");
  json["kind"].require(json.has("range") == (parameter.kind == Kind::kRange), kExpected);
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
    const std::array<const char*, 6> names = pose_names(problem.angles);
    for (std::size_t c = 0; c < names.size() && names[c] != nullptr; ++c) {
      const std::optional<long> k = turns(problem.pose[c], j);
      const bool is_angle = c >= 3;
      if (!k || (!is_angle && *k != 0)) pose[names[c]].fail("the same pose" + expected);
    }
  }
}

/// Where (phi, theta) and (phi + pi, -theta) are the same pose.
void read_flip(const Cursor& json, const Json& pose, Problem& problem) {
  json.require(problem.angles == AngleKind::kTiltAndTorsion, "null but for tilt-and-torsion angles");
  json.require_size(2);
  const auto last = static_cast<std::int64_t>(problem.parameters.size()) - 1;
  const auto phi = static_cast<std::size_t>(json.at(0).integer(0, last));
  const auto theta = static_cast<std::size_t>(json.at(1).integer(0, last));
  const Parameter& first = problem.parameters[phi];
  const Parameter& second = problem.parameters[theta];
  json.require(phi != theta && pose["phi"] == first.name && pose["theta"] == second.name,
               "the parameters that are phi and theta themselves");
  json.require(first.kind == ParameterKind::kPeriodic && second.kind == ParameterKind::kReal,
               "phi of kind periodic and theta of kind real");
  const auto mentions_either = [&](const Expression& x) { return mentions(x, phi) || mentions(x, theta); };
  for (const std::size_t c : {0, 1, 2, 5}) {
    if (!mentions_either(problem.pose[c])) continue;
    json.fail(std::string("a pose whose ") + pose_names(problem.angles)[c] + " mentions neither phi nor theta");
  }
  json.require(std::ranges::none_of(problem.constraints, mentions_either),
               "constraints that mention neither phi nor theta");
  problem.flip = {phi, theta};
}

/// Angles other than tilt and torsion.
void read_angles(const Cursor& json, Problem& problem) {
  static constexpr std::array<std::pair<const char*, AngleKind>, 2> kKinds = {
      {{"roll-pitch-yaw", AngleKind::kRollPitchYaw}, {"zyz", AngleKind::kZyz}}};
  if (!json.json().is_object()) {
    problem.angles = json.one_of<AngleKind>(kKinds, "roll-pitch-yaw, zyz or an axis");
    return;
  }
  problem.angles = AngleKind::kAxis;
  json.object("axis", problem.axis);
  const mpq_class least(1, 1'000'000'000), beyond(1'000'000'000);
  const mpq_class largest =
      std::max({mpq_class(abs(problem.axis[0])), mpq_class(abs(problem.axis[1])), mpq_class(abs(problem.axis[2]))});
  json["axis"].require(largest >= least && largest < beyond, "an axis of 1e-9 or more, and below 1e9");
}

void read_space(const Cursor& json, Problem& problem) {
  Names names;
  const auto read_constants = [&](const Cursor& constants) {
    constants.require(constants.json().is_object(), "an object");
    for (const auto& item : constants.json().items()) {
      if (!is_free_name(item.key())) constants.fail("a name, not '" + item.key() + "'");
      read(constants[item.key()], names.constants[item.key()]);
    }
  };
  const auto read_parameters = [&](const Cursor& parameters) {
    parameters.require(parameters.size() > 0 && parameters.size() <= kMaxParameters, "1 to 64 parameters");
    parameters.elements([&](const Cursor& here, std::size_t) { read_parameter(here, problem, names); });
  };
  const auto read_pose = [&](const Cursor& pose) {
    const auto read_coordinate = [&](std::size_t c) {
      return [&, c](const Cursor& here) { problem.pose[c] = expression(here, names); };
    };
    const std::array<const char*, 6> keys = pose_names(problem.angles);
    problem.pose.fill(parse_expression("0", {}, pose.where()));
    pose.object(keys[0], read_coordinate(0), keys[1], read_coordinate(1), keys[2], read_coordinate(2), keys[3],
                read_coordinate(3), keys[4], read_coordinate(4), keys[5], read_coordinate(5));
  };
  const auto read_constraints = [&](const Cursor& constraints) {
    const std::size_t n = problem.parameters.size();
    constraints.elements(
        [&](const Cursor& here, std::size_t) { problem.constraints.push_back(expression(here, names)); });
    constraints.require(constraints.size() == 0 || (n <= kMaxConstrainedParameters && constraints.size() < n),
                        "fewer constraints than parameters, and at most 6 of these");
    require_closed(json, problem);
  };
  json.object(
      "angles?", [&](const Cursor& angles) { read_angles(angles, problem); }, "constants", read_constants, "parameters",
      read_parameters, "pose", read_pose, "constraints", read_constraints, "flip",
      [&](const Cursor& flip) {
        if (!flip.is_null()) read_flip(flip, json["pose"].json(), problem);
      });
}

void read_query(const Cursor& json, Problem& problem) {
  json.object("waypoints", [&](const Cursor& waypoints) {
    waypoints.require(waypoints.size() != 1, "none, or at least two waypoints");
    waypoints.elements([&](const Cursor& waypoint, std::size_t) {
      waypoint.require_size(problem.parameters.size());
      std::vector<Expression>& x = problem.query.emplace_back(waypoint.size());
      waypoint.elements([&](const Cursor& here, std::size_t j) { constant(x[j])(here); });
    });
  });
}

}  // namespace

void read(const Cursor& json, Limits& limits) {
  std::array<mpq_class, 2> ends;
  read(json, ends);
  json.require(ends[0] >= 0 && ends[0] < ends[1], "0 <= lower < upper");
  limits = {ends[0], ends[1]};
}

void read(const Cursor& json, ToleranceBounds& x) {
  const auto read_orientation = [&](const Cursor& here) { read_angle(here, x.orientation); };
  json.object("base_anchor_m", x.base_anchors, "cable_length_m", x.cable_length, "load_point_m", x.load_point,
              "orientation_rad", read_orientation, "platform_anchor_m", x.platform_anchors, "position_m", x.position,
              "wrench", x.wrench);
  require_tolerance(json["base_anchor_m"], x.base_anchors);
  require_tolerance(json["platform_anchor_m"], x.platform_anchors);
  require_tolerance(json["load_point_m"], x.load_point);
  require_tolerance(json["position_m"], x.position);
  if (x.cable_length) require_tolerance(json["cable_length_m"], *x.cable_length);
}

Problem read_problem(const Cursor& json) {
  Problem problem;
  std::string name;
  const auto read_robot = [&](const Cursor& robot) {
    robot.object("base_anchors_m", problem.base_anchors, "length_m", problem.length, "platform_anchors_m",
                 problem.platform_anchors, "tension_N", problem.tension);
  };
  json.object(
      "bodies?", [&](const Cursor& bodies) { read(bodies, problem.bodies.emplace()); }, "name", name, "robot",
      read_robot, "load", [&](const Cursor& load) { read_load(load, problem); }, "tolerances", problem.tolerances,
      "space", [&](const Cursor& space) { read_space(space, problem); }, "query",
      [&](const Cursor& query) { read_query(query, problem); }, "time?",
      [&](const Cursor& time) { read_time(time, problem.time.emplace()); });
  if (!problem.time) require_no_inertia_box(json["load"]);
  try {
    const WorkingPrecision precision(128);
    require_rows(problem);
  } catch (const Rejected& why) {
    const Cursor time = json["time"];
    time["rows"].fail(std::string("rows whose errors follow from limits, not ") + why.what());
  }
  if (problem.tolerances && !problem.items.empty()) {
    require_no_tolerance_of_load(json["tolerances"], *problem.tolerances);
  }
  return problem;
}

bool is_coordinate_space(const Json& space, const Json& of_case) {
  const auto is_of = [&](const Json& angles) {
    Problem with_angles;
    read_angles(Cursor(angles, "angles"), with_angles);
    Json expected = {{"angles", angles},
                     {"constants", Json::object()},
                     {"flip", nullptr},
                     {"constraints", Json::array()},
                     {"parameters", Json::array()},
                     {"pose", Json::object()}};
    for (const char* name : pose_names(with_angles.angles)) {
      if (name == nullptr) continue;
      const bool is_angle = expected["parameters"].size() >= 3;
      expected["parameters"].push_back({{"name", name}, {"kind", is_angle ? "periodic" : "real"}});
      expected["pose"][name] = name;
    }
    return space == expected;
  };
  if (space == coordinate_space() || is_of("roll-pitch-yaw")) return true;
  return of_case.contains("angles") && is_of(of_case["angles"]);
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
