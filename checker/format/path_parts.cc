// SPDX-License-Identifier: GPL-3.0-or-later
#include <algorithm>

#include "checker/format/parts.h"
#include "checker/kernel/errors.h"

namespace taut::checker {
namespace {

constexpr std::int64_t kMaxHalfTurns = 1'000'000;
constexpr std::size_t kPoseSize = 7;  ///< px, py, pz, qx, qy, qz, qw

/// The numbers of `position` and `quaternion`.
std::vector<double> read_pose(const Cursor& json) {
  std::vector<double> x = json["position"].binary64s(3);
  const std::vector<double> q = json["quaternion"].binary64s(4);
  if (std::ranges::all_of(q, [](double c) { return c == 0; })) json["quaternion"].fail("a quaternion that is not 0");
  x.insert(x.end(), q.begin(), q.end());
  return x;
}

/// Widths >= 0; that they are positive is asked where something is claimed.
PoseTube read_tube(const Cursor& json) {
  const PoseTube tube = {json["position"].binary64(), json["turn"].binary64()};
  if (tube.position < 0 || tube.turn < 0) json.fail("positive widths");
  return tube;
}

/// @param key  under which the pose's place is found
InnerPose read_reference_pose(const Cursor& json, const char* key) {
  static const mpz_class kMaxDenominator = mpz_class(1) << 52;
  json.object({"position", "quaternion", key, "tube"});
  InnerPose pose;
  pose.s = json[key].dyadic();
  if (pose.s.get_den() > kMaxDenominator) json[key].fail("a denominator of at most 2^52");
  std::ranges::copy(read_pose(json), pose.x.begin());
  const Cursor tube = json["tube"];
  tube.object({"position", "turn"});
  pose.tube = read_tube(tube);
  return pose;
}

/// What a box's object has besides "bits".
struct BoxKeys {
  bool s = true;
  std::size_t unknowns = 0;  ///< "near" is there unless this is 0
  bool end_point = false;    ///< whether "s" may be ["1", "1"]
  bool tolerances = false;   ///< "parts" and "guesses"
  bool segment = false;
};

/// The unknowns of the equations that imply poses; 0 where poses are stated.
std::size_t unknowns(const Problem& problem, const Path& path) {
  return path.law == Law::kCableLengths ? kCables : problem.constraints.size();
}

NearZero read_near(const Cursor& json, std::size_t unknowns) {
  json.object({"at", "narrowings", "radius", "slope"});
  NearZero near{json["at"].binary64s(unknowns), json["slope"].binary64s(unknowns), json["radius"].binary64(),
                static_cast<int>(json["narrowings"].integer(0, 8))};
  if (near.radius <= 0) json["radius"].fail("a positive radius");
  return near;
}

Box read_box(const Cursor& json, const BoxKeys& keys) {
  std::vector<std::string_view> names = {"bits"};
  if (keys.s) names.emplace_back("s");
  if (keys.unknowns > 0) names.emplace_back("near");
  if (keys.tolerances) names.insert(names.end(), {"guesses", "parts"});
  if (keys.segment) names.emplace_back("segment");
  json.object(names);
  Box box;
  box.bits = static_cast<int>(json["bits"].integer(32, 4096));
  if (keys.s) {
    const Cursor s = json["s"];
    s.array(2);
    box.begin = s.at(0).dyadic();
    box.end = s.at(1).dyadic();
    if (box.begin > box.end || (box.begin == box.end && !(keys.end_point && box.begin == 1))) s.fail("begin < end");
  }
  if (keys.unknowns > 0) box.near = read_near(json["near"], keys.unknowns);
  if (keys.tolerances) {
    box.parts = static_cast<int>(json["parts"].integer(1, 64));
    box.guesses = static_cast<int>(json["guesses"].integer(1, 16));
  }
  return box;
}

/// Boxes never reach across a pose at which the reference changes direction.
void require_one_piece(const Cursor& json, const Box& box, const std::vector<InnerPose>& poses) {
  const auto next = std::ranges::upper_bound(poses, box.begin, {}, &InnerPose::s);
  if (next != poses.end() && next->s < box.end) json["s"].fail("a box that reaches across no pose of the reference");
}

void require_one_piece(const Cursor& json, const Box& box, std::size_t segment, const Path& path) {
  if (segment < path.inner_poses.size()) require_one_piece(json, box, path.inner_poses[segment]);
}

PathPoint read_point(const Cursor& json, const Path& path) {
  json.object({"s", "segment"});
  const auto segments = static_cast<std::int64_t>(path.segments());
  if (segments == 0) json.fail("a path with segments");
  return {static_cast<std::size_t>(json["segment"].integer(0, segments - 1)), json["s"].dyadic()};
}

/// Or {"waypoint": k}, except on a spline: s = 0 of segment k, or the end of the last segment.
PathPoint read_witness_point(const Cursor& json, const Path& path) {
  if (path.waypoints.empty()) json.fail("a path");
  if (path.law == Law::kCubicBSpline || !json.has("waypoint")) return read_point(json, path);
  json.object({"waypoint"});
  const std::size_t segments = path.segments();
  const auto k = static_cast<std::size_t>(json["waypoint"].integer(0, static_cast<std::int64_t>(segments)));
  return k == 0 || k < segments ? PathPoint{k, 0} : PathPoint{k - 1, 1};
}

/// The box of a single point.
Box read_proof(const Cursor& json, const PathPoint& point, std::size_t unknowns) {
  Box box = read_box(json, {.s = false, .unknowns = unknowns});
  box.begin = box.end = point.s;
  return box;
}

bool is_zero(const mpq_class& x) { return x == 0; }
template <class Range>
bool is_zero(const Range& range) {
  return std::ranges::all_of(range, [](const auto& x) { return is_zero(x); });
}

/// How the pose is followed while the deviation grows.
void read_way(const Cursor& json, WitnessDeviation& deviation) {
  json.object({"boxes", "poses"});
  const Cursor poses = json["poses"];
  if (poses.size() < 2) poses.fail("at least two poses");
  for (std::size_t i = 0; i < poses.size(); ++i) {
    const Cursor here = poses.at(i);
    InnerPose pose = read_reference_pose(here, "tau");
    if (pose.tube.position == 0 || pose.tube.turn == 0) here["tube"].fail("positive widths");
    const bool follows = i == 0 ? pose.s == 0 : pose.s > deviation.poses.back().s;
    if (!follows) here["tau"].fail("0 at first, then rising");
    if (i > 0 && !are_nested(deviation.poses.back().tube, pose.tube)) {
      here["tube"].fail("a tube that contains the one before, or is contained in it");
    }
    deviation.poses.push_back(std::move(pose));
  }
  if (deviation.poses.back().s != 1) poses.fail("tau = 1 at last");
  const Cursor boxes = json["boxes"];
  mpq_class reached = 0;
  for (std::size_t i = 0; i < boxes.size(); ++i) {
    const Cursor here = boxes.at(i);
    Box box = read_box(here, {.unknowns = kCables, .end_point = i + 1 == boxes.size()});
    if (box.begin != reached) here["s"].fail("a box that begins where the last one ended");
    require_one_piece(here, box, deviation.poses);
    reached = box.end;
    deviation.boxes.push_back(std::move(box));
  }
  if (reached != 1) boxes.fail("boxes up to 1");
}

WitnessDeviation read_deviation(const Cursor& json, bool is_controlled) {
  std::vector<std::string_view> keys = {"base_anchors_m", "load_point_m", "platform_anchors_m",
                                        "position_m",     "turn",         "wrench"};
  if (is_controlled) keys.insert(keys.end(), {"cable_lengths_m", "way"});
  json.object(keys);
  WitnessDeviation result;
  result.base_anchors = json["base_anchors_m"].decimal_rows<kCables, 3>();
  result.platform_anchors = json["platform_anchors_m"].decimal_rows<kCables, 3>();
  result.load_point = json["load_point_m"].decimals<3>();
  result.wrench = json["wrench"].decimal();
  result.position = json["position_m"].decimals<3>();
  result.turn = json["turn"].decimals<3>();
  if (!is_controlled) return result;
  result.cable_lengths = json["cable_lengths_m"].decimals<kCables>();
  const bool stays = is_zero(result.base_anchors) && is_zero(result.platform_anchors) && is_zero(*result.cable_lengths);
  const Cursor way = json["way"];
  if (stays != way.is_null()) way.fail(stays ? "null where neither anchors nor lengths deviate" : "an object");
  if (!stays) read_way(way, result);
  return result;
}

std::vector<MotionBox> read_motion(const Cursor& json, const Problem& problem, const Path& path) {
  std::vector<MotionBox> motion;
  for (std::size_t i = 0; i < json.size(); ++i) {
    const Cursor here = json.at(i);
    MotionBox& last = motion.emplace_back();
    last.box = read_box(here, {.unknowns = unknowns(problem, path), .segment = true});
    const auto segments = static_cast<std::int64_t>(path.segments());
    last.segment = static_cast<std::size_t>(here["segment"].integer(0, segments - 1));
    require_one_piece(here, last.box, last.segment, path);
  }
  return motion;
}

/// The violated limit, and the value that lies beyond it.
void read_violation(const Cursor& json, const Problem& problem, Witness& witness) {
  witness.cable = static_cast<std::size_t>(json["cable"].integer(1, kCables)) - 1;
  const auto value = json["value"].decimals<2>();
  witness.value_lower = value[0];
  witness.value_upper = value[1];
  const bool is_tension = witness.kind == WitnessKind::kTensionMin || witness.kind == WitnessKind::kTensionMax;
  const bool is_minimum = witness.kind == WitnessKind::kTensionMin || witness.kind == WitnessKind::kLengthMin;
  const Limits& limits = (is_tension ? problem.tension : problem.length)[witness.cable];
  const mpq_class& limit = is_minimum ? limits.lower : limits.upper;
  if (json["limit"].decimal() != limit) json["limit"].fail("the cable's limit in the problem");
  if (value[0] > value[1]) json["value"].fail("ends in order");
  if (is_minimum ? value[1] > limit : value[0] < limit) json["value"].fail("an enclosure that lies beyond the limit");
}

}  // namespace

Law read_law(const Cursor& json) {
  return json.one_of<Law>({{"straight-in-parameters", Law::kStraight},
                           {"cubic-b-spline", Law::kCubicBSpline},
                           {"geodesic", Law::kGeodesic},
                           {"straight-in-cable-lengths", Law::kCableLengths}},
                          "a law of the format");
}

Waypoint read_waypoint(const Cursor& json, Law law) {
  Waypoint waypoint;
  if (law == Law::kCableLengths) {
    json.object({"lengths", "position", "quaternion"});
    waypoint.x = read_pose(json);
    const std::vector<double> lengths = json["lengths"].binary64s(kCables);
    if (std::ranges::any_of(lengths, [](double x) { return x <= 0; })) json["lengths"].fail("positive lengths");
    waypoint.x.insert(waypoint.x.end(), lengths.begin(), lengths.end());
  } else if (law == Law::kGeodesic) {
    json.object({"position", "quaternion"});
    waypoint.x = read_pose(json);
  } else {
    json.object({"half_turns", "x"}, {"normals"});
    if (json.has("normals")) {
      waypoint.normals = json["normals"].binary64s(json["normals"].size());
      if (waypoint.normals.empty()) json["normals"].fail("numbers, or no such key");
    }
    waypoint.x = json["x"].binary64s(json["x"].size());
    const Cursor half_turns = json["half_turns"];
    half_turns.array(waypoint.x.size());
    for (std::size_t j = 0; j < half_turns.size(); ++j) {
      waypoint.half_turns.push_back(static_cast<int>(half_turns.at(j).integer(-kMaxHalfTurns, kMaxHalfTurns)));
    }
  }
  return waypoint;
}

void read_pose_tube(const Cursor& json, Path& path) {
  json.object({"position", "turn"}, {"inner"});
  path.pose_tubes.push_back(read_tube(json));
  std::vector<InnerPose>& poses = path.inner_poses.emplace_back();
  if (!json.has("inner")) return;
  const Cursor inner = json["inner"];
  if (inner.size() == 0) inner.fail("inner poses, or no such key");
  poses.reserve(inner.size());
  for (std::size_t i = 0; i < inner.size(); ++i) {
    const Cursor here = inner.at(i);
    InnerPose pose = read_reference_pose(here, "s");
    if (pose.s <= (i == 0 ? mpq_class(0) : poses.back().s) || pose.s >= 1) here["s"].fail("rising s in (0, 1)");
    poses.push_back(std::move(pose));
  }
}

bool are_nested(const PoseTube& a, const PoseTube& b) {
  return (a.position <= b.position && a.turn <= b.turn) || (a.position >= b.position && a.turn >= b.turn);
}

Margins read_margins(const Cursor& json) {
  json.object({"length_m", "tension_N", "wrench_scale"});
  return {json["tension_N"].decimal(), json["length_m"].decimal(), json["wrench_scale"].decimal()};
}

Segment read_segment(const Cursor& json, std::size_t k, const Problem& problem, const Path& path) {
  json.object({"boxes", "from", "margins", "to"});
  const auto from = static_cast<std::int64_t>(k);
  const auto to = from + static_cast<std::int64_t>(path.control_points()) - 1;
  (void)json["from"].integer(from, from);
  (void)json["to"].integer(to, to);
  Segment segment;
  const Cursor boxes = json["boxes"];
  const BoxKeys keys = {.unknowns = unknowns(problem, path), .tolerances = problem.tolerances.has_value()};
  for (std::size_t i = 0; i < boxes.size(); ++i) {
    const Cursor here = boxes.at(i);
    Box box = read_box(here, keys);
    if (!segment.boxes.empty() && box.begin < segment.boxes.back().end) here["s"].fail("a box after the last one");
    require_one_piece(here, box, k, path);
    segment.boxes.push_back(std::move(box));
  }
  const Cursor margins = json["margins"];
  if (segment.boxes.empty() != margins.is_null()) margins.fail("null where there is no box, and only there");
  if (!margins.is_null()) segment.margins = read_margins(margins);
  return segment;
}

Witness read_witness(const Cursor& json, const Problem& problem, const Path& path) {
  if (!json.has("kind")) json.fail("an object with the key 'kind'");
  Witness witness;
  witness.kind = json["kind"].one_of<WitnessKind>({{"tension_min", WitnessKind::kTensionMin},
                                                   {"tension_max", WitnessKind::kTensionMax},
                                                   {"length_min", WitnessKind::kLengthMin},
                                                   {"length_max", WitnessKind::kLengthMax},
                                                   {"singular", WitnessKind::kSingular}},
                                                  "a kind of the format");
  const std::size_t k = unknowns(problem, path);
  const bool is_singular = witness.kind == WitnessKind::kSingular;
  if (is_singular) {
    json.object({"at", "at_proof", "kind", "motion", "to", "to_proof"});
    witness.to = read_witness_point(json["to"], path);
    witness.to_box = read_proof(json["to_proof"], witness.to, k);
  } else {
    json.object({"at", "cable", "kind", "limit", "motion", "proof", "value"}, {"deviation"});
    read_violation(json, problem, witness);
    if (json.has("deviation")) {
      const Cursor deviation = json["deviation"];
      if (!problem.tolerances) deviation.fail("tolerances to be within");
      witness.deviation = read_deviation(deviation, is_length_controlled(problem, path));
    }
  }
  witness.at = read_witness_point(json["at"], path);
  witness.at_box = read_proof(json[is_singular ? "at_proof" : "proof"], witness.at, k);
  witness.motion = read_motion(json["motion"], problem, path);
  return witness;
}

Stretch read_stretch(const Cursor& json, const Problem& problem, const Path& path) {
  json.object({"inner", "outer", "reason"});
  const Cursor outer = json["outer"];
  outer.array(2);
  Stretch stretch{read_point(outer.at(0), path), read_point(outer.at(1), path), {}};
  const mpq_class begin = abscissa(stretch.begin);
  const mpq_class end = abscissa(stretch.end);
  if (begin >= end) outer.fail("two places in order");
  const Cursor inner = json["inner"];
  if (inner.is_null()) {
    (void)json["reason"].text();
    return stretch;
  }
  if (!json["reason"].is_null()) json["reason"].fail("null where a violation is proved");
  inner.array(2);
  for (std::size_t i = 0; i < 2; ++i) {
    const Witness& witness = stretch.inner.emplace_back(read_witness(inner.at(i), problem, path));
    for (const PathPoint& point : {witness.at, witness.kind == WitnessKind::kSingular ? witness.to : witness.at}) {
      if (abscissa(point) < begin || abscissa(point) > end) inner.at(i).fail("a place between the outer ends");
    }
  }
  if (abscissa(stretch.inner[1].at) < abscissa(stretch.inner[0].at)) inner.fail("two witnesses in order");
  return stretch;
}

}  // namespace taut::checker
