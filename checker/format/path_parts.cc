// SPDX-License-Identifier: GPL-3.0-or-later
#include <algorithm>

#include "checker/format/expression_parser.h"
#include "checker/format/parts.h"
#include "checker/kernel/errors.h"
#include "checker/kernel/moving.h"

namespace taut::checker {
namespace {

constexpr std::size_t kPoseSize = 7;              ///< px, py, pz, qx, qy, qz, qw
constexpr std::size_t kMaxTimeControls = 20'000;  ///< bounds the work of a box

auto quaternion(std::span<double> q) {
  return [q](const Cursor& json) {
    read(json, q);
    json.require(std::ranges::any_of(q, [](double c) { return c != 0; }), "a quaternion that is not 0");
  };
}

/// @param key  under which the pose's place is found
InnerPose read_reference_pose(const Cursor& json, const char* key) {
  static const mpz_class kMaxDenominator = mpz_class(1) << 52;
  InnerPose pose;
  const std::span<double> x = pose.x;
  json.object("position", x.first(3), "quaternion", quaternion(x.last(4)), key, dyadic(pose.s), "tube", pose.tube);
  json[key].require(pose.s.get_den() <= kMaxDenominator, "a denominator of at most 2^52");
  return pose;
}

/// The unknowns of the equations that imply poses; 0 where poses are stated.
std::size_t unknowns(const Problem& problem, const Path& path) {
  return path.law == Law::kCableLengths ? kCables : problem.constraints.size();
}

/// What a box's object has besides "bits".
struct BoxKeys {
  bool s = true;
  std::size_t unknowns = 0;     ///< "near" is there unless this is 0
  bool end_point = false;       ///< whether "s" may be ["1", "1"]
  bool tolerances = false;      ///< "parts" and "guesses"
  bool apart = false;           ///< "apart" may be there, and is read by others
  MotionBox* motion = nullptr;  ///< where not null: "segment", which is read into it
  std::size_t segments = 0;     ///< of the path
};

Box read_box(const Cursor& json, const BoxKeys& keys) {
  Box box;
  std::size_t segment = 0;
  const auto read_near = [&](const Cursor& here) {
    NearZero& near = box.near.emplace(NearZero{std::vector<double>(keys.unknowns), std::vector<double>(keys.unknowns)});
    here.object("at", std::span(near.at), "narrowings", integer(near.narrowings, 0, 8), "radius", near.radius, "slope",
                std::span(near.slope));
    here["radius"].require(near.radius > 0, "a positive radius");
  };
  const auto read_ends = [&](const Cursor& s) {
    s.require_size(2);
    dyadic(box.begin)(s.at(0));
    dyadic(box.end)(s.at(1));
    s.require(box.begin < box.end || (box.begin == box.end && keys.end_point && box.begin == 1), "begin < end");
  };
  const auto if_tolerances = [&](const char* key) { return keys.tolerances ? key : nullptr; };
  const auto later = [](const Cursor& /*json*/) {};
  json.object(keys.apart ? "apart?" : nullptr, later, "bits", integer(box.bits, 32, 4096), keys.s ? "s" : nullptr,
              read_ends, keys.unknowns > 0 ? "near" : nullptr, read_near, if_tolerances("guesses"),
              integer(box.guesses, 1, 16), if_tolerances("parts"), integer(box.parts, 1, 64),
              keys.motion != nullptr ? "segment" : nullptr,
              integer(segment, 0, static_cast<std::int64_t>(keys.segments) - 1));
  if (keys.motion != nullptr) *keys.motion = {segment, box};
  return box;
}

/// `apart` of a box: what differs from its segment's.
ApartChanges read_changes(const Cursor& json, const Problem& problem, const Path& path) {
  ApartChanges changes;
  const auto pairs = static_cast<std::int64_t>(problem.bodies->pairs.size());
  json.require(json.size() > 0, "changes, or no such key");
  json.elements([&](const Cursor& here, std::size_t) {
    here.require_size(2);
    const auto pair = static_cast<std::size_t>(here.at(0).integer(0, pairs - 1));
    here.require(changes.empty() || pair > changes.back().first, "rising pairs");
    std::vector<std::size_t> directions = read_apart(here.at(1), pair, problem, path);
    here.require(!directions.empty(), "a pair neither of which is a half-space");
    changes.emplace_back(pair, std::move(directions));
  });
  return changes;
}

/// Boxes never reach across a pose at which the reference changes direction.
void require_one_piece(const Cursor& json, const Box& box, const std::vector<InnerPose>& poses) {
  const auto next = std::ranges::upper_bound(poses, box.begin, {}, &InnerPose::s);
  json["s"].require(next == poses.end() || next->s >= box.end, "a box that reaches across no pose of the reference");
}

void require_one_piece(const Cursor& json, const Box& box, std::size_t segment, const Path& path) {
  if (segment < path.inner_poses.size()) require_one_piece(json, box, path.inner_poses[segment]);
}

PathPoint read_point(const Cursor& json, const Path& path) {
  PathPoint point;
  const std::size_t segments = path.segments();
  json.require(segments > 0, "a path with segments");
  json.object("s", dyadic(point.s), "segment", integer(point.segment, 0, static_cast<std::int64_t>(segments) - 1));
  return point;
}

/// Or {"waypoint": k}, except on a spline: s = 0 of segment k, or the end of the last segment.
auto witness_point(PathPoint& point, const Path& path) {
  return [&](const Cursor& json) {
    json.require(!path.waypoints.empty(), "a path");
    if (path.law == Law::kCubicBSpline || !json.has("waypoint")) {
      point = read_point(json, path);
      return;
    }
    std::size_t k = 0;
    const std::size_t segments = path.segments();
    json.object("waypoint", integer(k, 0, static_cast<std::int64_t>(segments)));
    point = k == 0 || k < segments ? PathPoint{k, 0} : PathPoint{k - 1, 1};
  };
}

/// The box of a single point, which has been read.
auto proof(Box& box, const PathPoint& point, std::size_t unknowns) {
  return [&, unknowns](const Cursor& json) {
    box = read_box(json, {.s = false, .unknowns = unknowns});
    box.begin = box.end = point.s;
  };
}

bool is_zero(const mpq_class& x) { return x == 0; }
template <class Range>
bool is_zero(const Range& range) {
  return std::ranges::all_of(range, [](const auto& x) { return is_zero(x); });
}

/// How the pose is followed while the deviation grows.
void read_way(const Cursor& json, WitnessDeviation& deviation) {
  std::vector<InnerPose>& way = deviation.poses;
  const auto read_pose = [&](const Cursor& here, std::size_t i) {
    InnerPose pose = read_reference_pose(here, "tau");
    here["tube"].require(pose.tube.position != 0 && pose.tube.turn != 0, "positive widths");
    here["tau"].require(i == 0 ? pose.s == 0 : pose.s > way.back().s, "0 at first, then rising");
    here["tube"].require(i == 0 || are_nested(way.back().tube, pose.tube),
                         "a tube that contains the one before, or is contained in it");
    way.push_back(std::move(pose));
  };
  const auto read_poses = [&](const Cursor& poses) {
    poses.require(poses.size() >= 2, "at least two poses");
    poses.elements(read_pose);
    poses.require(way.back().s == 1, "tau = 1 at last");
  };
  const auto read_boxes = [&](const Cursor& boxes) {
    mpq_class reached = 0;
    boxes.elements([&](const Cursor& here, std::size_t i) {
      Box box = read_box(here, {.unknowns = kCables, .end_point = i + 1 == boxes.size()});
      here["s"].require(box.begin == reached, "a box that begins where the last one ended");
      require_one_piece(here, box, way);
      reached = box.end;
      deviation.boxes.push_back(std::move(box));
    });
    boxes.require(reached == 1, "boxes up to 1");
  };
  json.object("poses", read_poses, "boxes", read_boxes);
}

WitnessDeviation read_deviation(const Cursor& json, bool is_controlled) {
  WitnessDeviation x;
  std::array<mpq_class, kCables> lengths;
  const auto read_way_or_null = [&](const Cursor& way) {
    const bool stays = is_zero(x.base_anchors) && is_zero(x.platform_anchors) && is_zero(lengths);
    if (stays != way.is_null()) way.fail(stays ? "null where neither anchors nor lengths deviate" : "an object");
    if (!stays) read_way(way, x);
  };
  json.object("base_anchors_m", x.base_anchors, "load_point_m", x.load_point, "platform_anchors_m", x.platform_anchors,
              "position_m", x.position, "turn", x.turn, "wrench", x.wrench, is_controlled ? "cable_lengths_m" : nullptr,
              lengths, is_controlled ? "way" : nullptr, read_way_or_null);
  if (is_controlled) x.cable_lengths = lengths;
  return x;
}

/// The violated limit, and the value that lies beyond it.
void require_violation(const Cursor& json, const mpq_class& stated_limit, const Problem& problem,
                       const Witness& witness) {
  const bool is_tension = witness.kind == WitnessKind::kTensionMin || witness.kind == WitnessKind::kTensionMax;
  const bool is_minimum = witness.kind == WitnessKind::kTensionMin || witness.kind == WitnessKind::kLengthMin;
  const Limits& limits = (is_tension ? problem.tension : problem.length)[witness.cable];
  const mpq_class& limit = is_minimum ? limits.lower : limits.upper;
  json["limit"].require(stated_limit == limit, "the cable's limit in the problem");
  json["value"].require(is_minimum ? witness.value_upper <= limit : witness.value_lower >= limit,
                        "an enclosure that lies beyond the limit");
}

}  // namespace

Waypoint read_waypoint(const Cursor& json, Law law) {
  constexpr std::int64_t kMaxHalfTurns = 1'000'000;
  Waypoint waypoint;
  if (has_poses(law)) {
    const bool has_lengths = law == Law::kCableLengths;
    waypoint.x.resize(kPoseSize + (has_lengths ? kCables : 0));
    const std::span<double> x = waypoint.x;
    const std::span<double> lengths = x.subspan(kPoseSize);
    json.object(has_lengths ? "lengths" : nullptr, lengths, "position", x.first(3), "quaternion",
                quaternion(x.subspan(3, 4)));
    const bool are_positive = std::ranges::all_of(lengths, [](double length) { return length > 0; });
    if (!are_positive) json["lengths"].fail("positive lengths");
    return waypoint;
  }
  const auto read_half_turns = [&](const Cursor& half_turns) {
    half_turns.elements([&](const Cursor& here, std::size_t) {
      waypoint.half_turns.push_back(static_cast<int>(here.integer(-kMaxHalfTurns, kMaxHalfTurns)));
    });
  };
  json.object("half_turns", read_half_turns, "normals?", waypoint.normals, "x", waypoint.x);
  json["half_turns"].require_size(waypoint.x.size());
  if (json.has("normals")) json["normals"].require(!waypoint.normals.empty(), "numbers, or no such key");
  return waypoint;
}

void read(const Cursor& json, PoseTube& tube) {
  json.object("position", tube.position, "turn", tube.turn);
  json.require(tube.position >= 0 && tube.turn >= 0, "positive widths");
}

void read_pose_tube(const Cursor& json, Path& path) {
  PoseTube& tube = path.pose_tubes.emplace_back();
  std::vector<InnerPose>& poses = path.inner_poses.emplace_back();
  const auto read_inner = [&](const Cursor& inner) {
    inner.require(inner.size() > 0, "inner poses, or no such key");
    poses.reserve(inner.size());
    inner.elements([&](const Cursor& here, std::size_t i) {
      InnerPose pose = read_reference_pose(here, "s");
      here["s"].require(pose.s > (i == 0 ? mpq_class(0) : poses.back().s) && pose.s < 1, "rising s in (0, 1)");
      poses.push_back(std::move(pose));
    });
  };
  json.object("position", tube.position, "turn", tube.turn, "inner?", read_inner);
  json.require(tube.position >= 0 && tube.turn >= 0, "positive widths");
}

bool are_nested(const PoseTube& a, const PoseTube& b) {
  return (a.position <= b.position && a.turn <= b.turn) || (a.position >= b.position && a.turn >= b.turn);
}

void read_timing(const Cursor& json, const Problem& problem, Path& path) {
  TimeLaw law;
  const auto read_controls = [&](const Cursor& controls) {
    controls.require(controls.size() >= 4 && controls.size() <= kMaxTimeControls, "4 to 20000 control values");
    read(controls, law.controls);
  };
  json.object("controls", read_controls, "step_s", law.step_s);
  json.require(problem.time.has_value(), "no law in time where the problem has no limits in time");
  path.timing = std::move(law);
  try {
    require_time_law(path);
  } catch (const Rejected& why) {
    json.fail(std::string("a law of a move along the path, not ") + why.what());
  }
}

void read_margins(const Cursor& json, const Problem& problem, Margins& margins) {
  json.object(problem.bodies ? "clearance_m" : nullptr, margins.clearance, "length_m", margins.length, "tension_N",
              margins.tension, "wrench_scale", margins.wrench_scale);
}

Segment read_segment(const Cursor& json, std::size_t k, const Problem& problem, const Path& path) {
  Segment segment;
  const BoxKeys keys = {.unknowns = unknowns(problem, path),
                        .tolerances = problem.tolerances.has_value(),
                        .apart = problem.bodies.has_value()};
  const auto read_boxes = [&](const Cursor& boxes) {
    boxes.elements([&](const Cursor& here, std::size_t i) {
      Box box = read_box(here, keys);
      here["s"].require(i == 0 || box.begin >= segment.boxes.back().end, "a box after the last one");
      require_one_piece(here, box, k, path);
      segment.boxes.push_back(std::move(box));
      segment.changes.push_back(here.has("apart") ? read_changes(here["apart"], problem, path) : ApartChanges());
    });
  };
  const auto read_apart_of_all = [&](const Cursor& apart) {
    apart.require(segment.boxes.empty() == apart.is_null(), "null where there is no box, and only there");
    if (apart.is_null()) return;
    apart.require_size(problem.bodies->pairs.size());
    apart.elements(
        [&](const Cursor& here, std::size_t pair) { segment.apart.push_back(read_apart(here, pair, problem, path)); });
  };
  const auto read_margins = [&](const Cursor& margins) {
    margins.require(segment.boxes.empty() == margins.is_null(), "null where there is no box, and only there");
    if (!margins.is_null()) taut::checker::read_margins(margins, problem, segment.margins);
  };
  json.object("from", exactly(k), "to", exactly(k + path.control_points() - 1), "boxes", read_boxes,
              problem.bodies ? "apart" : nullptr, read_apart_of_all, "margins", read_margins);
  return segment;
}

Apart Segment::apart_of(std::size_t box) const {
  Apart result = apart;
  for (const auto& [pair, directions] : changes[box]) result[pair] = directions;
  return result;
}

namespace {

/// The rest of a witness that two bodies are too close.
template <class ReadMotion>
void read_contact(const Cursor& json, const Problem& problem, const Path& path, const ReadMotion& read_motion,
                  Witness& witness) {
  const auto ignore = [](const Cursor&) {};
  const std::size_t n = unknowns(problem, path);
  json["kind"].require(problem.bodies && !problem.bodies->pairs.empty(), "no contact where no pair is checked");
  const auto last = static_cast<std::int64_t>(problem.bodies->pairs.size()) - 1;
  const auto read_weights = [&](const Cursor& weights) {
    witness.weights = read_contact_weights(weights, witness.pair, witness.inside, problem);
  };
  const auto read_around = [&](const Cursor& around) {
    const Bodies& bodies = *problem.bodies;
    const CheckedPair& pair = bodies.pairs[witness.pair];
    const bool may_be =
        pair.kind != PairKind::kExitCone && !bodies.is_against_half_space(pair) && !bodies.has_mesh(pair);
    around.require(may_be, "no such key, as the pair has a half-space, an exit cone or a mesh");
    around.require_size(4);
    around.elements([&](const Cursor& weights, std::size_t) {
      witness.around.push_back(read_contact_weights(weights, witness.pair, {}, problem));
    });
  };
  const auto read_elements = [&](const Cursor& elements) {
    witness.elements = read_contact_elements(elements, witness.pair, witness.inside, problem);
  };
  const auto read_inside = [&](const Cursor& inside) {
    witness.inside = read_contact_inside(inside, witness.pair, problem);
  };
  const bool is_around = json.has("around");
  const auto read_points = [&](const Cursor& here) { is_around ? read_around(here) : read_weights(here); };
  json.object("kind", ignore, "pair", integer(witness.pair, 0, last), "inside?", read_inside,
              is_around ? "around" : "weights", read_points, "elements?", read_elements, "depth_m", witness.depth, "at",
              witness_point(witness.at, path), "proof", proof(witness.at_box, witness.at, n), "motion", read_motion);
  json["depth_m"].require(witness.depth >= 0, "a depth >= 0");
  const bool has_mesh = problem.bodies->has_mesh(problem.bodies->pairs[witness.pair]);
  json.require(json.has("elements") == has_mesh, "the key 'elements' where a body of the pair is a mesh");
}

auto read_value_of(Witness& witness) {
  return [&witness](const Cursor& value) {
    std::array<mpq_class, 2> ends;
    read(value, ends);
    value.require(ends[0] <= ends[1], "ends in order");
    witness.value_lower = ends[0];
    witness.value_upper = ends[1];
  };
}

/// Whether a witness may say how a move is slowed down: of what is greatest at full speed, or does not depend on it, it
/// may not.
bool may_be_slowed(WitnessKind kind, const Problem& problem, const Path& path) {
  switch (kind) {
    case WitnessKind::kTensionMin:
    case WitnessKind::kTensionMax:
    case WitnessKind::kWinchAcceleration:
    case WitnessKind::kWinchPower:
    case WitnessKind::kLoadAcceleration:
    case WitnessKind::kLoadAngularAcceleration: return path.timing && problem.time && problem.time->stopping_time;
    default: return false;
  }
}

auto read_slowing(Witness& witness) {
  return [&witness](const Cursor& json) {
    Slowing& slowing = witness.slowing.emplace();
    const auto read_change = [&](const Cursor& here) { slowing.change = static_cast<int>(here.integer(-1, 1)); };
    json.object("change", read_change, "speed", slowing.speed);
    json["change"].require(slowing.change != 0, "-1 or 1");
    json["speed"].require(slowing.speed > 0 && slowing.speed < 1, "a number between 0 and 1");
  };
}

/// Of the machine that deviates, whose tensions, length or power the witness is of.
auto read_deviating(const Problem& problem, const Path& path, Witness& witness) {
  return [&](const Cursor& deviation) {
    deviation.require(problem.tolerances.has_value(), "tolerances to be within");
    witness.deviation = read_deviation(deviation, is_length_controlled(problem, path));
  };
}

/// The rest of a witness that a limit in time is not kept. That the value lies beyond it is proved by others.
template <class ReadMotion>
void read_rate(const Cursor& json, RateKind rate, const Problem& problem, const Path& path,
               const ReadMotion& read_motion, Witness& witness) {
  json["kind"].require(path.timing.has_value(), "no limit in time where the path has no law in time");
  const auto ignore = [](const Cursor&) {};
  const auto read_cable = [&](const Cursor& cable) {
    if (!is_of_winch(rate)) return cable.require(cable.is_null(), "null of what is not of a winch");
    witness.cable = static_cast<std::size_t>(cable.integer(1, kCables)) - 1;
  };
  json.object("kind", ignore, "cable", read_cable, "limit", ignore, "value", read_value_of(witness), "at",
              witness_point(witness.at, path), "proof", proof(witness.at_box, witness.at, unknowns(problem, path)),
              "motion", read_motion, rate == RateKind::kWinchPower ? "deviation?" : nullptr,
              read_deviating(problem, path, witness), may_be_slowed(witness.kind, problem, path) ? "slowing?" : nullptr,
              read_slowing(witness));
  const std::optional<Expression>& limit = problem.time->of(rate, witness.cable);
  json["kind"].require(limit.has_value(), "a limit that the problem states");
  const Cursor stated = json["limit"];
  stated.require(parse_expression(stated.text(), {}, stated.where()) == *limit, "the limit in the problem");
}

}  // namespace

Witness read_witness(const Cursor& json, const Problem& problem, const Path& path) {
  static constexpr std::array<std::pair<const char*, WitnessKind>, 13> kKinds = {
      {{"tension_min", WitnessKind::kTensionMin},
       {"tension_max", WitnessKind::kTensionMax},
       {"length_min", WitnessKind::kLengthMin},
       {"length_max", WitnessKind::kLengthMax},
       {"singular", WitnessKind::kSingular},
       {"contact", WitnessKind::kContact},
       {"winch_speed", WitnessKind::kWinchSpeed},
       {"winch_acceleration", WitnessKind::kWinchAcceleration},
       {"winch_power", WitnessKind::kWinchPower},
       {"load_speed", WitnessKind::kLoadSpeed},
       {"load_acceleration", WitnessKind::kLoadAcceleration},
       {"load_angular_speed", WitnessKind::kLoadAngularSpeed},
       {"load_angular_acceleration", WitnessKind::kLoadAngularAcceleration}}};
  json.require(json.has("kind"), "an object with the key 'kind'");
  Witness witness;
  witness.kind = json["kind"].one_of<WitnessKind>(kKinds, "a kind of the format");
  const std::size_t n = unknowns(problem, path);
  const auto read_motion = [&](const Cursor& motion) {
    motion.elements([&](const Cursor& here, std::size_t) {
      MotionBox& last = witness.motion.emplace_back();
      (void)read_box(here, {.unknowns = n, .motion = &last, .segments = path.segments()});
      require_one_piece(here, last.box, last.segment, path);
    });
  };
  const auto ignore = [](const Cursor&) {};
  if (witness.kind == WitnessKind::kSingular) {
    json.object("kind", ignore, "at", witness_point(witness.at, path), "at_proof", proof(witness.at_box, witness.at, n),
                "to", witness_point(witness.to, path), "to_proof", proof(witness.to_box, witness.to, n), "motion",
                read_motion);
    return witness;
  }
  if (witness.kind == WitnessKind::kContact) {
    read_contact(json, problem, path, read_motion, witness);
    return witness;
  }
  if (const std::optional<RateKind> rate = rate_of(witness.kind)) {
    read_rate(json, *rate, problem, path, read_motion, witness);
    return witness;
  }
  mpq_class limit;
  const bool is_tension = witness.kind == WitnessKind::kTensionMin || witness.kind == WitnessKind::kTensionMax;
  const bool is_at_rest = !path.timing;
  const char* const loads_key = is_tension && !problem.items.empty() && is_at_rest ? "loads?" : nullptr;
  const auto read_witness_loads = [&](const Cursor& loads) { witness.loads = read_loads(loads, problem.items); };
  json.object("kind", ignore, "cable", integer(witness.cable, 1, kCables), "limit", limit, "value",
              read_value_of(witness), "at", witness_point(witness.at, path), "proof",
              proof(witness.at_box, witness.at, n), "motion", read_motion, "deviation?",
              read_deviating(problem, path, witness), loads_key, read_witness_loads,
              may_be_slowed(witness.kind, problem, path) ? "slowing?" : nullptr, read_slowing(witness));
  --witness.cable;
  require_violation(json, limit, problem, witness);
  return witness;
}

std::pair<mpq_class, mpq_class> places(const Witness& witness) {
  const mpq_class at = abscissa(witness.at);
  const mpq_class to = witness.kind == WitnessKind::kSingular ? abscissa(witness.to) : at;
  return std::minmax(at, to);
}

bool is_inside(const Witness& witness, const Stretch& stretch) {
  const auto [first, last] = places(witness);
  return first >= abscissa(stretch.begin) && last <= abscissa(stretch.end);
}

Stretch read_stretch(const Cursor& json, const Problem& problem, const Path& path) {
  Stretch stretch;
  const auto read_outer = [&](const Cursor& outer) {
    outer.require_size(2);
    stretch.begin = read_point(outer.at(0), path);
    stretch.end = read_point(outer.at(1), path);
    outer.require(abscissa(stretch.begin) < abscissa(stretch.end), "two places in order");
  };
  const auto read_inner = [&](const Cursor& inner) {
    if (inner.is_null()) return;
    inner.require_size(2);
    inner.elements([&](const Cursor& here, std::size_t) {
      stretch.inner.push_back(read_witness(here, problem, path));
      here.require(is_inside(stretch.inner.back(), stretch), "a place between the outer ends");
    });
    inner.require(abscissa(stretch.inner[0].at) <= abscissa(stretch.inner[1].at), "two witnesses in order");
  };
  const auto read_reason = [&](const Cursor& reason) {
    if (stretch.inner.empty()) (void)reason.text();
    reason.require(stretch.inner.empty() || reason.is_null(), "null where a violation is proved");
  };
  json.object("outer", read_outer, "inner", read_inner, "reason", read_reason);
  return stretch;
}

}  // namespace taut::checker
