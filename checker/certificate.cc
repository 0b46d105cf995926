#include "checker/certificate.h"

#include <openssl/evp.h>

#include <algorithm>
#include <initializer_list>
#include <memory>
#include <set>

#include "checker/claims.h"
#include "checker/exact.h"

namespace taut::checker {
namespace {

using Json = nlohmann::json;

constexpr int kMaxNesting = 32;  ///< a certificate needs about 7
constexpr std::int64_t kMaxHalfTurns = 1'000'000;

[[noreturn]] void fail(const std::string& where, const std::string& expected) {
  throw Malformed(where + ": expected " + expected);
}

std::string at(const std::string& where, std::size_t i) { return where + "[" + std::to_string(i) + "]"; }

/// An object with exactly these keys.
const Json& object(const Json& json, const std::string& where, std::initializer_list<const char*> keys) {
  if (!json.is_object()) fail(where, "an object");
  for (const char* key : keys) {
    if (!json.contains(key)) fail(where, "the key '" + std::string(key) + "'");
  }
  for (const auto& item : json.items()) {
    if (std::find(keys.begin(), keys.end(), item.key()) == keys.end()) fail(where, "no key '" + item.key() + "'");
  }
  return json;
}

const Json& array(const Json& json, const std::string& where) {
  if (!json.is_array()) fail(where, "an array");
  return json;
}

const Json& array(const Json& json, const std::string& where, std::size_t size) {
  if (!json.is_array() || json.size() != size) fail(where, "an array of " + std::to_string(size));
  return json;
}

const std::string& text(const Json& json, const std::string& where) {
  if (!json.is_string()) fail(where, "a string");
  return json.get_ref<const std::string&>();
}

std::int64_t integer(const Json& json, const std::string& where, std::int64_t lowest, std::int64_t highest) {
  const bool fits = json.is_number_integer() && (!json.is_number_unsigned() || json.get<std::uint64_t>() <= INT64_MAX);
  if (!fits || json.get<std::int64_t>() < lowest || json.get<std::int64_t>() > highest) {
    fail(where, "an integer from " + std::to_string(lowest) + " to " + std::to_string(highest));
  }
  return json.get<std::int64_t>();
}

mpq_class decimal(const Json& json, const std::string& where) { return parse_decimal(text(json, where), where); }
mpq_class dyadic(const Json& json, const std::string& where) { return parse_dyadic(text(json, where), where); }

template <std::size_t N>
std::array<mpq_class, N> decimals(const Json& json, const std::string& where) {
  array(json, where, N);
  std::array<mpq_class, N> result;
  for (std::size_t i = 0; i < N; ++i) result[i] = decimal(json[i], at(where, i));
  return result;
}

template <std::size_t Rows, std::size_t N>
std::array<std::array<mpq_class, N>, Rows> decimal_rows(const Json& json, const std::string& where) {
  array(json, where, Rows);
  std::array<std::array<mpq_class, N>, Rows> result;
  for (std::size_t i = 0; i < Rows; ++i) result[i] = decimals<N>(json[i], at(where, i));
  return result;
}

std::array<Limits, kCables> limits(const Json& json, const std::string& where) {
  const auto rows = decimal_rows<kCables, 2>(json, where);
  std::array<Limits, kCables> result;
  for (std::size_t i = 0; i < kCables; ++i) {
    if (rows[i][0] < 0 || rows[i][0] >= rows[i][1]) fail(at(where, i), "0 <= lower < upper");
    result[i] = {rows[i][0], rows[i][1]};
  }
  return result;
}

/// An expression that mentions no name but pi.
Expression constant(const Json& json, const std::string& where) { return Expression(text(json, where), {}, {}, where); }

mpq_class tolerance(const Json& json, const std::string& where) {
  mpq_class result = decimal(json, where);
  if (result < 0) fail(where, "a tolerance >= 0");
  return result;
}

std::array<mpq_class, kCables> tolerance_of_cables(const Json& json, const std::string& where) {
  array(json, where, kCables);
  std::array<mpq_class, kCables> result;
  for (std::size_t i = 0; i < kCables; ++i) result[i] = tolerance(json[i], at(where, i));
  return result;
}

Tolerances read_tolerances(const Json& json) {
  const std::string where = "problem.tolerances";
  object(json, where,
         {"base_anchor_m", "platform_anchor_m", "load_point_m", "wrench", "position_m", "orientation_rad",
          "cable_length_m"});
  Tolerances result;
  result.base_anchors = tolerance_of_cables(json["base_anchor_m"], where + ".base_anchor_m");
  result.platform_anchors = tolerance_of_cables(json["platform_anchor_m"], where + ".platform_anchor_m");
  result.load_point = tolerance(json["load_point_m"], where + ".load_point_m");
  result.wrench = decimals<6>(json["wrench"], where + ".wrench");
  result.position = tolerance(json["position_m"], where + ".position_m");
  const std::string angle = where + ".orientation_rad";
  result.orientation = constant(json["orientation_rad"], angle);
  try {
    const Interval value = result.orientation.evaluate({}).range;
    if (certainly_negative(value) || !certainly_positive(Interval(1) - value))
      fail(angle, "an angle from 0 to below 1");
  } catch (const Undefined& why) {
    fail(angle, std::string("an angle from 0 to below 1, not a ") + why.what());
  }
  if (!json["cable_length_m"].is_null()) {
    result.cable_length = tolerance_of_cables(json["cable_length_m"], where + ".cable_length_m");
  }
  return result;
}

void read_space(const Json& json, Problem& problem) {
  const std::string where = "problem.space";
  object(json, where, {"parameters", "constants", "flip", "pose", "constraints"});
  std::map<std::string, mpq_class> constants;
  if (!json["constants"].is_object()) fail(where + ".constants", "an object");
  for (const auto& item : json["constants"].items()) {
    if (!Expression::is_free_name(item.key())) fail(where + ".constants", "a name, not '" + item.key() + "'");
    constants[item.key()] = decimal(item.value(), where + ".constants." + item.key());
  }

  std::vector<std::string> names;
  const Json& parameters = array(json["parameters"], where + ".parameters");
  if (parameters.empty()) fail(where + ".parameters", "at least one parameter");
  for (std::size_t j = 0; j < parameters.size(); ++j) {
    const std::string here = at(where + ".parameters", j);
    const bool is_range = parameters[j].is_object() && parameters[j].contains("range");
    if (is_range) {
      object(parameters[j], here, {"name", "kind", "range"});
    } else {
      object(parameters[j], here, {"name", "kind"});
    }
    Parameter parameter;
    parameter.name = text(parameters[j]["name"], here + ".name");
    if (!Expression::is_free_name(parameter.name) || constants.count(parameter.name) > 0 ||
        std::count(names.begin(), names.end(), parameter.name) > 0) {
      fail(here + ".name", "a name that nothing else has");
    }
    const std::string& kind = text(parameters[j]["kind"], here + ".kind");
    if (kind == "range" && is_range) {
      const Json& range = array(parameters[j]["range"], here + ".range", 2);
      parameter.kind = Kind::kRange;
      parameter.lower = constant(range[0], here + ".range[0]");
      parameter.upper = constant(range[1], here + ".range[1]");
    } else if (kind == "periodic" && !is_range) {
      parameter.kind = Kind::kPeriodic;
    } else if (kind != "real" || is_range) {
      fail(here + ".kind", "real, periodic, or range with its ends");
    }
    names.push_back(parameter.name);
    problem.parameters.push_back(std::move(parameter));
  }

  constexpr std::array<const char*, 6> kPoseNames = {"px", "py", "pz", "phi", "theta", "sigma"};
  const Json& pose = object(json["pose"], where + ".pose", {"px", "py", "pz", "phi", "theta", "sigma"});
  for (std::size_t c = 0; c < 6; ++c) {
    const std::string here = where + ".pose." + kPoseNames[c];
    problem.pose[c] = Expression(text(pose[kPoseNames[c]], here), names, constants, here);
  }

  const Json& constraints = array(json["constraints"], where + ".constraints");
  for (std::size_t i = 0; i < constraints.size(); ++i) {
    const std::string here = at(where + ".constraints", i);
    problem.constraints.emplace_back(text(constraints[i], here), names, constants, here);
  }
  if (!constraints.empty() && (names.size() > kMaxConstrainedParameters || constraints.size() >= names.size())) {
    fail(where + ".constraints", "fewer constraints than parameters, and at most 6 of these");
  }

  for (std::size_t j = 0; j < names.size(); ++j) {
    if (problem.parameters[j].kind != Kind::kPeriodic) continue;
    for (std::size_t i = 0; i < constraints.size(); ++i) {
      if (problem.constraints[i].turns(static_cast<int>(j)) != 0) {
        fail(at(where + ".constraints", i),
             "the same value, and plainly so, where the periodic parameter '" + names[j] + "' grows by 2 pi");
      }
    }
    for (std::size_t c = 0; c < 6; ++c) {
      const std::optional<long> turns = problem.pose[c].turns(static_cast<int>(j));
      const bool is_angle = c >= 3;
      if (!turns || (!is_angle && *turns != 0)) {
        fail(where + ".pose." + kPoseNames[c],
             "the same pose, and plainly so, where the periodic parameter '" + names[j] + "' grows by 2 pi");
      }
    }
  }

  if (!json["flip"].is_null()) {
    const std::string here = where + ".flip";
    array(json["flip"], here, 2);
    const auto last = static_cast<std::int64_t>(names.size()) - 1;
    const auto phi = static_cast<int>(integer(json["flip"][0], here, 0, last));
    const auto theta = static_cast<int>(integer(json["flip"][1], here, 0, last));
    if (phi == theta || pose["phi"] != names[static_cast<std::size_t>(phi)] ||
        pose["theta"] != names[static_cast<std::size_t>(theta)]) {
      fail(here, "the parameters that are phi and theta themselves");
    }
    if (problem.parameters[static_cast<std::size_t>(phi)].kind != Kind::kPeriodic ||
        problem.parameters[static_cast<std::size_t>(theta)].kind != Kind::kReal) {
      fail(here, "phi of kind periodic and theta of kind real");
    }
    for (const std::size_t c : std::array<std::size_t, 4>{0, 1, 2, 5}) {
      if (problem.pose[c].mentions(phi) || problem.pose[c].mentions(theta)) {
        fail(here, std::string("a pose whose ") + kPoseNames[c] + " mentions neither phi nor theta");
      }
    }
    for (const Expression& constraint : problem.constraints) {
      if (constraint.mentions(phi) || constraint.mentions(theta)) {
        fail(here, "constraints that mention neither phi nor theta");
      }
    }
    problem.flip = {phi, theta};
  }
}

Problem read_problem(const Json& json) {
  object(json, "problem", {"name", "robot", "load", "tolerances", "space", "query"});
  text(json["name"], "problem.name");
  Problem problem;

  const Json& robot =
      object(json["robot"], "problem.robot", {"base_anchors_m", "platform_anchors_m", "tension_N", "length_m"});
  problem.base_anchors = decimal_rows<kCables, 3>(robot["base_anchors_m"], "problem.robot.base_anchors_m");
  problem.platform_anchors = decimal_rows<kCables, 3>(robot["platform_anchors_m"], "problem.robot.platform_anchors_m");
  problem.tension = limits(robot["tension_N"], "problem.robot.tension_N");
  problem.length = limits(robot["length_m"], "problem.robot.length_m");

  const Json& load = object(json["load"], "problem.load", {"point_m", "wrench", "ellipsoid"});
  problem.load_point = decimals<3>(load["point_m"], "problem.load.point_m");
  problem.wrench = decimals<6>(load["wrench"], "problem.load.wrench");
  problem.ellipsoid = decimal_rows<6, 6>(load["ellipsoid"], "problem.load.ellipsoid");
  for (std::size_t i = 0; i < 6; ++i) {
    for (std::size_t j = 0; j < i; ++j) {
      if (problem.ellipsoid[i][j] != problem.ellipsoid[j][i]) fail("problem.load.ellipsoid", "a symmetric matrix");
    }
  }

  if (!json["tolerances"].is_null()) problem.tolerances = read_tolerances(json["tolerances"]);
  read_space(json["space"], problem);

  object(json["query"], "problem.query", {"waypoints"});
  const Json& waypoints = array(json["query"]["waypoints"], "problem.query.waypoints");
  if (waypoints.size() == 1) fail("problem.query.waypoints", "none, or at least two waypoints");
  for (std::size_t k = 0; k < waypoints.size(); ++k) {
    const std::string here = at("problem.query.waypoints", k);
    array(waypoints[k], here, problem.parameters.size());
    std::vector<Expression>& waypoint = problem.query.emplace_back();
    for (std::size_t j = 0; j < waypoints[k].size(); ++j) {
      waypoint.push_back(constant(waypoints[k][j], at(here, j)));
    }
  }
  return problem;
}

std::vector<double> binary64s(const Json& json, const std::string& where, std::size_t size) {
  array(json, where, size);
  std::vector<double> result;
  for (std::size_t i = 0; i < size; ++i) result.push_back(parse_binary64(text(json[i], at(where, i)), at(where, i)));
  return result;
}

Waypoint read_waypoint(const Json& json, const std::string& where, const Problem& problem) {
  const std::size_t n = problem.parameters.size();
  const std::size_t k = problem.constraints.size();
  Waypoint waypoint;
  if (k > 0) {
    object(json, where, {"x", "half_turns", "normals"});
    waypoint.normals = binary64s(json["normals"], where + ".normals", n * k);
  } else {
    object(json, where, {"x", "half_turns"});
  }
  waypoint.x = binary64s(json["x"], where + ".x", n);
  const Json& half_turns = array(json["half_turns"], where + ".half_turns", n);
  for (std::size_t j = 0; j < n; ++j) {
    const std::int64_t most = problem.parameters[j].kind == Kind::kPeriodic ? kMaxHalfTurns : 0;
    waypoint.half_turns.push_back(static_cast<int>(integer(half_turns[j], at(where + ".half_turns", j), -most, most)));
  }
  return waypoint;
}

Waypoint read_pose(const Json& json, const std::string& where, Interpolation law) {
  Waypoint waypoint;
  const auto append = [&](const char* key, std::size_t size) {
    for (const double x : binary64s(json[key], where + "." + key, size)) waypoint.x.push_back(x);
  };
  const bool has_lengths = law == Interpolation::kCableLengths;
  if (has_lengths) {
    object(json, where, {"position", "quaternion", "lengths"});
  } else {
    object(json, where, {"position", "quaternion"});
  }
  append("position", 3);
  append("quaternion", 4);
  if (std::all_of(waypoint.x.begin() + 3, waypoint.x.end(), [](double x) { return x == 0; })) {
    fail(where + ".quaternion", "a quaternion that is not 0");
  }
  if (has_lengths) append("lengths", kCables);
  if (std::any_of(waypoint.x.begin() + 7, waypoint.x.end(), [](double x) { return x <= 0; })) {
    fail(where + ".lengths", "positive lengths");
  }
  waypoint.half_turns.assign(waypoint.x.size(), 0);
  return waypoint;
}

Interpolation read_interpolation(const Json& json) {
  static const std::map<std::string, Interpolation> kLaws = {
      {"straight-in-parameters", Interpolation::kStraight},
      {"cubic-b-spline", Interpolation::kCubicBSpline},
      {"geodesic", Interpolation::kGeodesic},
      {"straight-in-cable-lengths", Interpolation::kCableLengths}};
  const auto law = kLaws.find(text(json, "path.interpolation"));
  if (law == kLaws.end()) fail("path.interpolation", "a law of the format");
  return law->second;
}

PoseTube tube_of(const Json& json, const std::string& where) {
  return {parse_binary64(text(json["position"], where), where), parse_binary64(text(json["turn"], where), where)};
}

InnerPose read_inner_pose(const Json& json, const std::string& where, const mpq_class& last) {
  static const mpz_class kMostParts = mpz_class(1) << 52;
  object(json, where, {"s", "position", "quaternion", "tube"});
  InnerPose inner;
  inner.s = dyadic(json["s"], where + ".s");
  if (inner.s <= last || inner.s >= 1 || inner.s.get_den() > kMostParts) {
    fail(where + ".s", "places that rise inside of (0, 1), with denominators of at most 2^52");
  }
  const std::vector<double> position = binary64s(json["position"], where + ".position", 3);
  const std::vector<double> quaternion = binary64s(json["quaternion"], where + ".quaternion", 4);
  if (std::all_of(quaternion.begin(), quaternion.end(), [](double x) { return x == 0; })) {
    fail(where + ".quaternion", "a quaternion that is not 0");
  }
  std::copy(quaternion.begin(), quaternion.end(), std::copy(position.begin(), position.end(), inner.x.begin()));
  inner.tube = tube_of(object(json["tube"], where + ".tube", {"position", "turn"}), where + ".tube");
  return inner;
}

/// One entry of `pose_tubes`: the first tube, and what follows from the inner poses on.
void read_pose_tube(const Json& json, const std::string& where, Path& path) {
  if (json.is_object() && json.contains("inner")) {
    object(json, where, {"position", "turn", "inner"});
  } else {
    object(json, where, {"position", "turn"});
  }
  path.pose_tubes.push_back(tube_of(json, where));
  std::vector<InnerPose>& inner = path.inner_poses.emplace_back();
  if (!json.contains("inner")) return;
  array(json["inner"], where + ".inner");
  if (json["inner"].empty()) fail(where + ".inner", "inner poses, or no such key");
  for (std::size_t i = 0; i < json["inner"].size(); ++i) {
    const mpq_class last = i == 0 ? mpq_class(0) : inner.back().s;
    inner.push_back(read_inner_pose(json["inner"][i], at(where + ".inner", i), last));
  }
}

/// Of two successive tubes one contains the other: else the motion might change from one pose to another where they meet.
void require_nested(const PoseTube& a, const PoseTube& b, const std::string& where) {
  if ((b.position < a.position && b.turn > a.turn) || (b.position > a.position && b.turn < a.turn)) {
    fail(where, "a tube that contains the one before, or is contained in it");
  }
}

/// Decimals that rise, one a waypoint.
void read_times(const Json& json, std::size_t size) {
  if (json.is_null()) return;
  array(json, "path.times", size);
  mpq_class last;
  for (std::size_t k = 0; k < size; ++k) {
    const mpq_class time = decimal(json[k], at("path.times", k));
    if (k > 0 && time <= last) fail(at("path.times", k), "a time after the last one");
    last = time;
  }
}

Path read_path(const Json& json, const Problem& problem, Verdict verdict) {
  object(json, "path", {"interpolation", "waypoints", "tubes", "pose_tubes", "times"});
  Path path;
  path.interpolation = read_interpolation(json["interpolation"]);
  const Json& waypoints = array(json["waypoints"], "path.waypoints");
  for (std::size_t k = 0; k < waypoints.size(); ++k) {
    const std::string here = at("path.waypoints", k);
    path.waypoints.push_back(has_poses(path.interpolation) ? read_pose(waypoints[k], here, path.interpolation)
                                                           : read_waypoint(waypoints[k], here, problem));
  }
  if (path.interpolation == Interpolation::kCubicBSpline && path.segments() == 0) {
    fail("path.waypoints", "at least four of a spline");
  }
  read_times(json["times"], path.waypoints.size());

  const std::size_t segments = std::max(path.segments(), std::min<std::size_t>(path.waypoints.size(), 1));
  const auto is_wide = [&](double width) { return verdict == Verdict::kUndecided ? width >= 0 : width > 0; };
  path.tubes = binary64s(json["tubes"], "path.tubes", problem.constraints.empty() ? 0 : segments);
  for (std::size_t k = 0; k < path.tubes.size(); ++k) {
    if (!is_wide(path.tubes[k])) fail(at("path.tubes", k), "a positive width");
  }
  const bool is_implied = path.interpolation == Interpolation::kCableLengths;
  const Json& pose_tubes = array(json["pose_tubes"], "path.pose_tubes", is_implied ? segments : 0);
  std::optional<PoseTube> last;
  for (std::size_t k = 0; k < pose_tubes.size(); ++k) {
    const std::string here = at("path.pose_tubes", k);
    read_pose_tube(pose_tubes[k], here, path);
    const auto follow = [&](const PoseTube& tube, const std::string& where) {
      if (!is_wide(tube.position) || !is_wide(tube.turn)) fail(where, "positive widths");
      if (last) require_nested(*last, tube, where);
      last = tube;
    };
    follow(path.pose_tubes[k], here);
    const std::vector<InnerPose>& inner = path.inner_poses[k];
    for (std::size_t i = 0; i < inner.size(); ++i) follow(inner[i].tube, at(here + ".inner", i) + ".tube");
  }
  return path;
}

/// Where an audited path came from: informative.
void read_source(const Json& json) {
  if (json.is_null()) return;
  object(json, "source", {"file", "sha256"});
  text(json["file"], "source.file");
  const std::string& sha256 = text(json["sha256"], "source.sha256");
  if (sha256.size() != 64 || sha256.find_first_not_of("0123456789abcdef") != std::string::npos) {
    fail("source.sha256", "64 lower-case hex digits");
  }
}

Margins read_margins(const Json& json, const std::string& where) {
  object(json, where, {"tension_N", "length_m", "wrench_scale"});
  return {decimal(json["tension_N"], where + ".tension_N"), decimal(json["length_m"], where + ".length_m"),
          decimal(json["wrench_scale"], where + ".wrench_scale")};
}

/// @param is_whole  whether the boxes tile the segment: where stretches are listed they need not.
Segment read_segment(const Json& json, std::size_t k, std::size_t control_points, bool is_whole) {
  const std::string here = at("segments", k);
  object(json, here, {"from", "to", "boxes", "margins"});
  const auto from = static_cast<std::int64_t>(k);
  integer(json["from"], here + ".from", from, from);
  const std::int64_t to = from + static_cast<std::int64_t>(control_points) - 1;
  integer(json["to"], here + ".to", to, to);
  Segment segment;
  mpq_class reached = 0;
  const Json& boxes = array(json["boxes"], here + ".boxes");
  for (std::size_t b = 0; b < boxes.size(); ++b) {
    const std::string where = at(here + ".boxes", b);
    array(boxes[b], where, 2);
    const Box box = {dyadic(boxes[b][0], where), dyadic(boxes[b][1], where)};
    const bool follows = is_whole ? box.begin == reached : box.begin >= reached;
    if (!follows || box.begin >= box.end) fail(where, "a box that begins where the last one ended");
    reached = box.end;
    segment.boxes.push_back(box);
  }
  if (is_whole && reached != 1) fail(here + ".boxes", "boxes up to 1");
  if (!is_whole && boxes.empty()) {
    if (!json["margins"].is_null()) fail(here + ".margins", "null where there is no box");
  } else {
    segment.margins = read_margins(json["margins"], here + ".margins");
  }
  return segment;
}

/// The worst of the segments, each exactly as one of them writes it.
std::array<std::string, 3> read_top_margins(const Json& json, const Json& segments) {
  read_margins(json, "margins");
  std::array<std::string, 3> result;
  constexpr std::array<const char*, 3> kKeys = {"tension_N", "length_m", "wrench_scale"};
  for (std::size_t i = 0; i < 3; ++i) {
    const std::string where = std::string("margins.") + kKeys[i];
    const mpq_class least = decimal(json[kKeys[i]], where);
    bool found = false;
    for (const Json& segment : segments) {
      const Json& margin = segment["margins"][kKeys[i]];
      if (decimal(margin, where) < least) fail(where, "not more than any segment's");
      found = found || margin == json[kKeys[i]];
    }
    if (!found) fail(where, "the text of a segment's");
    result[i] = text(json[kKeys[i]], where);
  }
  return result;
}

/// AT of the format.
Place read_place(const Json& json, const std::string& where, const Path& path) {
  if (path.waypoints.empty()) fail(where, "a path");
  const auto segments = static_cast<std::int64_t>(path.segments());
  if (path.interpolation != Interpolation::kCubicBSpline && json.is_object() && json.contains("waypoint")) {
    object(json, where, {"waypoint"});
    const std::int64_t k = integer(json["waypoint"], where + ".waypoint", 0, segments);
    if (k == 0 || k < segments) return {static_cast<std::size_t>(k), 0};
    return {static_cast<std::size_t>(k - 1), 1};  // where the last segment ends
  }
  object(json, where, {"segment", "s"});
  const std::int64_t k = integer(json["segment"], where + ".segment", 0, segments - 1);
  return {static_cast<std::size_t>(k), dyadic(json["s"], where + ".s")};
}

/// PLACE of the format.
Place read_plain_place(const Json& json, const std::string& where, const Path& path) {
  object(json, where, {"segment", "s"});
  const std::int64_t k =
      integer(json["segment"], where + ".segment", 0, static_cast<std::int64_t>(path.segments()) - 1);
  return {static_cast<std::size_t>(k), dyadic(json["s"], where + ".s")};
}

WitnessDeviation read_deviation(const Json& json, const std::string& where, bool is_held) {
  WitnessDeviation result;
  if (is_held) {
    object(json, where,
           {"base_anchors_m", "platform_anchors_m", "load_point_m", "wrench", "position_m", "turn", "cable_lengths_m"});
    result.cable_lengths = decimals<kCables>(json["cable_lengths_m"], where + ".cable_lengths_m");
  } else {
    object(json, where, {"base_anchors_m", "platform_anchors_m", "load_point_m", "wrench", "position_m", "turn"});
  }
  result.base_anchors = decimal_rows<kCables, 3>(json["base_anchors_m"], where + ".base_anchors_m");
  result.platform_anchors = decimal_rows<kCables, 3>(json["platform_anchors_m"], where + ".platform_anchors_m");
  result.load_point = decimals<3>(json["load_point_m"], where + ".load_point_m");
  result.wrench = decimal(json["wrench"], where + ".wrench");
  result.position = decimals<3>(json["position_m"], where + ".position_m");
  result.turn = decimals<3>(json["turn"], where + ".turn");
  return result;
}

Witness read_witness(const Json& json, const std::string& here, const Problem& problem, const Path& path) {
  if (!json.is_object() || !json.contains("kind")) fail(here, "an object with the key 'kind'");
  static const std::map<std::string, WitnessKind> kKinds = {{"tension_min", WitnessKind::kTensionMin},
                                                            {"tension_max", WitnessKind::kTensionMax},
                                                            {"length_min", WitnessKind::kLengthMin},
                                                            {"length_max", WitnessKind::kLengthMax},
                                                            {"singular", WitnessKind::kSingular}};
  const auto kind = kKinds.find(text(json["kind"], here + ".kind"));
  if (kind == kKinds.end()) fail(here + ".kind", "a kind of the format");
  Witness witness;
  witness.kind = kind->second;
  if (witness.kind == WitnessKind::kSingular) {
    object(json, here, {"kind", "at", "to"});
    witness.at = read_place(json["at"], here + ".at", path);
    witness.to = read_place(json["to"], here + ".to", path);
    return witness;
  }
  if (json.contains("deviation")) {
    object(json, here, {"kind", "at", "cable", "value", "limit", "deviation"});
    if (!problem.tolerances) fail(here + ".deviation", "tolerances to be within");
    witness.deviation = read_deviation(json["deviation"], here + ".deviation", is_held_by_lengths(problem, path));
  } else {
    object(json, here, {"kind", "at", "cable", "value", "limit"});
  }
  witness.at = read_place(json["at"], here + ".at", path);
  witness.cable = static_cast<int>(integer(json["cable"], here + ".cable", 1, kCables)) - 1;
  const auto value = decimals<2>(json["value"], here + ".value");
  witness.value_lower = value[0];
  witness.value_upper = value[1];
  const bool of_tension = witness.kind == WitnessKind::kTensionMin || witness.kind == WitnessKind::kTensionMax;
  const bool of_minimum = witness.kind == WitnessKind::kTensionMin || witness.kind == WitnessKind::kLengthMin;
  const Limits& limit = (of_tension ? problem.tension : problem.length)[static_cast<std::size_t>(witness.cable)];
  if (decimal(json["limit"], here + ".limit") != (of_minimum ? limit.lower : limit.upper)) {
    fail(here + ".limit", "the cable's limit in the problem");
  }
  return witness;
}

/// Along the whole path, a segment being as long as 1.
mpq_class abscissa(const Place& place) { return mpq_class(place.segment) + place.s; }

Stretch read_stretch(const Json& json, const std::string& here, const Problem& problem, const Path& path) {
  object(json, here, {"outer", "inner", "reason"});
  array(json["outer"], here + ".outer", 2);
  Stretch stretch;
  stretch.begin = read_plain_place(json["outer"][0], here + ".outer[0]", path);
  stretch.end = read_plain_place(json["outer"][1], here + ".outer[1]", path);
  const mpq_class begin = abscissa(stretch.begin);
  const mpq_class end = abscissa(stretch.end);
  if (begin >= end) fail(here + ".outer", "two places in order");
  if (json["inner"].is_null()) {
    text(json["reason"], here + ".reason");
    return stretch;
  }
  if (!json["reason"].is_null()) fail(here + ".reason", "null where a violation is proved");
  array(json["inner"], here + ".inner", 2);
  for (std::size_t i = 0; i < 2; ++i) {
    const std::string where = at(here + ".inner", i);
    const Witness& witness = stretch.inner.emplace_back(read_witness(json["inner"][i], where, problem, path));
    for (const Place& place : {witness.at, witness.kind == WitnessKind::kSingular ? witness.to : witness.at}) {
      if (abscissa(place) < begin || abscissa(place) > end) fail(where, "a place between the outer ends");
    }
  }
  if (abscissa(stretch.inner[1].at) < abscissa(stretch.inner[0].at)) fail(here + ".inner", "two witnesses in order");
  return stretch;
}

std::vector<Stretch> read_stretches(const Json& json, const Problem& problem, const Path& path) {
  array(json, "stretches");
  if (!problem.query.empty()) fail("stretches", "null where nothing was audited");
  std::vector<Stretch> stretches;
  for (std::size_t i = 0; i < json.size(); ++i) {
    const std::string here = at("stretches", i);
    stretches.push_back(read_stretch(json[i], here, problem, path));
    if (i > 0 && abscissa(stretches[i].begin) < abscissa(stretches[i - 1].end)) {
      fail(here + ".outer", "a stretch after the last one");
    }
  }
  return stretches;
}

/// The proved boxes and the outer intervals of the stretches cover the path, and do not overlap.
void require_tiling(const Certificate& certificate) {
  std::vector<std::pair<mpq_class, mpq_class>> parts;
  for (std::size_t k = 0; k < certificate.segments.size(); ++k) {
    for (const Box& box : certificate.segments[k].boxes) {
      parts.emplace_back(abscissa({k, box.begin}), abscissa({k, box.end}));
    }
  }
  for (const Stretch& stretch : certificate.stretches) {
    parts.emplace_back(abscissa(stretch.begin), abscissa(stretch.end));
  }
  std::sort(parts.begin(), parts.end());
  mpq_class reached = 0;
  for (const auto& [begin, end] : parts) {
    if (begin != reached) fail("stretches", "boxes and outer ends that tile the path");
    reached = end;
  }
  if (reached != certificate.path.segments()) fail("stretches", "boxes and outer ends that tile the path");
}

std::string read_undecided(const Json& json, std::size_t segments) {
  object(json, "undecided", {"reason", "segment", "box"});
  if (json["segment"].is_null() != json["box"].is_null()) fail("undecided", "segment and box, or neither");
  if (!json["segment"].is_null()) {
    integer(json["segment"], "undecided.segment", 0, static_cast<std::int64_t>(segments) - 1);
    array(json["box"], "undecided.box", 2);
    if (dyadic(json["box"][0], "undecided.box") > dyadic(json["box"][1], "undecided.box")) {
      fail("undecided.box", "ends in order");
    }
  }
  return text(json["reason"], "undecided.reason");
}

/// What JSON would allow and a certificate must not have. Of a text that is no JSON it says nothing.
class StrictReader : public nlohmann::json_sax<Json> {
 public:
  explicit StrictReader(const std::string& text) : text_(text) {}

  bool null() override { return true; }
  bool boolean(bool /*value*/) override { return true; }
  bool number_integer(number_integer_t /*value*/) override { return true; }
  bool number_unsigned(number_unsigned_t /*value*/) override { return true; }
  bool number_float(number_float_t /*value*/, const string_t& /*text*/) override {
    throw Malformed("a number that is no integer");
  }
  bool string(string_t& /*value*/) override { return true; }
  bool binary(binary_t& /*value*/) override { return true; }
  bool start_object(std::size_t /*size*/) override {
    keys_.emplace_back();
    return open();
  }
  bool key(string_t& name) override {
    if (!keys_.back().insert(name).second) throw Malformed("the key '" + name + "' appears twice in one object");
    return true;
  }
  bool end_object() override {
    keys_.pop_back();
    return close();
  }
  bool start_array(std::size_t /*size*/) override { return open(); }
  bool end_array() override { return close(); }
  bool parse_error(std::size_t position, const std::string& /*token*/,
                   const nlohmann::detail::exception& /*error*/) override {
    const auto read = text_.begin() + static_cast<std::ptrdiff_t>(std::min(position, text_.size()));
    throw Malformed("no JSON, or cut: line " + std::to_string(1 + std::count(text_.begin(), read, '\n')));
  }

 private:
  bool open() {
    if (++depth_ > kMaxNesting) throw Malformed("nested too deeply");
    return true;
  }
  bool close() {
    --depth_;
    return true;
  }

  const std::string& text_;
  std::vector<std::set<std::string>> keys_;  ///< of the objects that are open
  int depth_ = 0;
};

void require_digest(const Json& value, const Json& claimed, const std::string& where) {
  if (text(claimed, where) != digest(value)) fail(where, "the digest of what the file contains: it was altered");
}

}  // namespace

nlohmann::json parse_json(const std::string& text) {
  // The library would skip the one, and take the other for the end.
  if (text.starts_with("\xEF\xBB\xBF")) throw Malformed("no JSON: it begins with a byte order mark");
  if (text.find('\0') != std::string::npos) throw Malformed("no JSON: it contains a NUL byte");
  try {
    // The library could ask us while it builds the value, but then looks at all of an array at the end of each of its objects.
    StrictReader strict(text);
    Json::sax_parse(text, &strict);
    return Json::parse(text);
  } catch (const Json::exception& error) {
    throw Malformed(std::string("no JSON, or cut: ") + error.what());
  }
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

constexpr std::int64_t kVersion = 3;  // of the format

std::string digest(const nlohmann::json& value) {
  const std::string canonical = value.dump(-1, ' ', true);
  std::array<unsigned char, EVP_MAX_MD_SIZE> bytes{};
  unsigned int size = 0;
  if (EVP_Digest(canonical.data(), canonical.size(), bytes.data(), &size, EVP_sha256(), nullptr) != 1) {
    throw std::runtime_error("SHA-256 is not available");
  }
  std::string hex;
  for (unsigned int i = 0; i < size; ++i) {
    hex += "0123456789abcdef"[bytes[i] >> 4U];
    hex += "0123456789abcdef"[bytes[i] & 15U];
  }
  return hex;
}

Certificate read_certificate(const nlohmann::json& json) {
  // First: a certificate of another version has other keys, and that is why.
  if (json.is_object() && json.contains("format") && json.contains("version") && json["format"] == "taut-certificate" &&
      json["version"].is_number_integer() && json["version"] != kVersion) {
    fail("version", std::to_string(kVersion) + ", got " + json["version"].dump() +
                        ": only the taut-check that came with the taut that made it can check it");
  }
  object(json, "certificate",
         {"format", "version", "generator", "verdict", "claim", "problem", "problem_sha256", "path", "path_sha256",
          "segments", "margins", "witness", "stretches", "source", "undecided", "illustration", "footer"});
  if (json["format"] != "taut-certificate") fail("format", "'taut-certificate'");
  integer(json["version"], "version", kVersion, kVersion);
  if (!json["generator"].is_object()) fail("generator", "an object");

  // Is this the whole file, as it was written?
  const Json& footer = object(json["footer"], "footer", {"waypoints", "segments", "boxes", "sha256"});
  Json body = json;
  body.erase("footer");
  require_digest(body, footer["sha256"], "footer.sha256");
  require_digest(json["problem"], json["problem_sha256"], "problem_sha256");
  require_digest(json["path"], json["path_sha256"], "path_sha256");

  Certificate certificate;
  static const std::map<std::string, std::pair<Verdict, const char*>> kVerdicts = {
      {"proved", {Verdict::kProved, kProvedClaim}},
      {"refuted", {Verdict::kRefuted, kRefutedClaim}},
      {"undecided", {Verdict::kUndecided, kUndecidedClaim}}};
  const auto verdict = kVerdicts.find(text(json["verdict"], "verdict"));
  if (verdict == kVerdicts.end()) fail("verdict", "proved, refuted or undecided");
  certificate.verdict = verdict->second.first;
  if (json["claim"] != verdict->second.second) fail("claim", "the text that belongs to the verdict");

  certificate.problem = read_problem(json["problem"]);
  certificate.path = read_path(json["path"], certificate.problem, certificate.verdict);
  const Path& path = certificate.path;

  const Json& segments = array(json["segments"], "segments");
  const Json& stretches = json["stretches"];
  const bool is_proved = certificate.verdict == Verdict::kProved;
  const bool is_refuted = certificate.verdict == Verdict::kRefuted;
  if (is_proved && path.segments() == 0) fail("path.waypoints", "at least two of a proved path");
  array(segments, "segments", is_proved || (is_refuted && !stretches.is_null()) ? path.segments() : 0);
  for (std::size_t k = 0; k < segments.size(); ++k) {
    certificate.segments.push_back(read_segment(segments[k], k, path.control_points(), is_proved));
    certificate.boxes += certificate.segments.back().boxes.size();
  }
  if (is_proved) {
    certificate.margins = read_top_margins(json["margins"], segments);
  } else {
    object(json["margins"], "margins", {});
  }

  if (is_refuted) {
    certificate.witness = read_witness(json["witness"], "witness", certificate.problem, path);
  } else if (!json["witness"].is_null()) {
    fail("witness", "null");
  }
  if (is_proved) {
    if (!stretches.is_null()) fail("stretches", "null");
  } else if (!stretches.is_null()) {
    certificate.stretches = read_stretches(stretches, certificate.problem, path);
    const auto is_violated = [](const Stretch& stretch) { return !stretch.inner.empty(); };
    if (!is_refuted && std::any_of(certificate.stretches.begin(), certificate.stretches.end(), is_violated)) {
      fail("stretches", "open ones only, where nothing is refuted");
    }
    if (is_refuted) {
      require_tiling(certificate);
      const auto has_witness = [&](const Json& stretch) {
        return !stretch["inner"].is_null() &&
               std::count(stretch["inner"].begin(), stretch["inner"].end(), json["witness"]) > 0;
      };
      if (std::none_of(stretches.begin(), stretches.end(), has_witness)) fail("witness", "one of the stretches'");
    }
  }
  if (certificate.verdict == Verdict::kUndecided) {
    certificate.undecided_reason = read_undecided(json["undecided"], path.segments());
  } else if (!json["undecided"].is_null()) {
    fail("undecided", "null");
  }

  read_source(json["source"]);
  if (!json["source"].is_null() && !certificate.problem.query.empty()) fail("source", "null where nothing was audited");
  if (has_poses(path.interpolation)) {
    if (!certificate.problem.query.empty()) fail("problem.query.waypoints", "none where the path has a law of poses");
    if (json["problem"]["space"] != coordinate_space()) fail("problem.space", "the one of the free coordinates");
  }

  const auto count = [&](const char* key, std::size_t n) {
    integer(footer[key], std::string("footer.") + key, static_cast<std::int64_t>(n), static_cast<std::int64_t>(n));
  };
  count("waypoints", path.waypoints.size());
  count("segments", segments.size());
  count("boxes", certificate.boxes);
  return certificate;
}

}  // namespace taut::checker
