// SPDX-License-Identifier: GPL-3.0-or-later
#include "certificate/certificate.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <bit>
#include <charconv>
#include <cmath>
#include <limits>
#include <optional>
#include <system_error>

#include "base/json_cursor.h"
#include "base/sha256.h"
#include "checker/format/claims.h"
#include "checker/format/writer.h"
#include "problem/decimal.h"

namespace taut {

using nlohmann::json;

std::string hex_float(double x) {
  std::array<char, 32> digits{};
  const auto [end, error] =
      std::to_chars(digits.data(), digits.data() + digits.size(), std::abs(x), std::chars_format::hex);
  return (std::signbit(x) ? "-0x" : "0x") + std::string(digits.data(), end);
}

json to_json(const Margins& m) {
  return {{"tension_N", m.tension_N}, {"length_m", m.length_m}, {"wrench_scale", m.wrench_scale}};
}

json to_json(const PathPoint& p) {
  if (!p.on_segment) return {{"waypoint", p.index}};
  return {{"segment", p.index}, {"s", p.s.text()}};
}

json to_json(const PathWitness& found, const KernelWitness& kernel, std::size_t segment) {
  const checker::Witness& witness = kernel.witness;
  json motion = json::array();
  for (checker::MotionBox part : witness.motion) {
    part.segment += segment;
    motion.push_back(checker::to_json(part));
  }
  json result = {{"at", to_json(found.at)}, {"motion", std::move(motion)}};
  if (found.singular) {
    result["kind"] = "singular";
    result["to"] = to_json(found.to);
    result["at_proof"] = checker::proof_to_json(witness.at_box);
    result["to_proof"] = checker::proof_to_json(witness.to_box);
    return result;
  }
  result["kind"] = name(found.margin.kind);
  result["cable"] = found.margin.cable + 1;
  result["value"] = {kernel.value_lower, kernel.value_upper};
  result["limit"] = found.limit;
  result["proof"] = checker::proof_to_json(witness.at_box);
  if (found.deviation) {
    const Deviation& d = *found.deviation;
    result["deviation"] = {{"base_anchors_m", d.base_anchors_m}, {"platform_anchors_m", d.platform_anchors_m},
                           {"load_point_m", d.load_point_m},     {"wrench", d.wrench},
                           {"position_m", d.position_m},         {"turn", d.turn}};
    if (d.cable_lengths_m) {
      result["deviation"]["cable_lengths_m"] = *d.cable_lengths_m;
      result["deviation"]["way"] = checker::way_to_json(*witness.deviation);
    }
  }
  return result;
}

json to_json(const KernelSegment& segment, std::size_t from, std::size_t to, bool has_tolerances) {
  json boxes = json::array();
  for (const KernelBox& box : segment.boxes) boxes.push_back(checker::to_json(box.box, has_tolerances));
  return {{"boxes", std::move(boxes)},
          {"from", from},
          {"to", to},
          {"margins", segment.boxes.empty() ? json() : to_json(segment.margins)}};
}

const char* interpolation_name(Interpolation law) {
  switch (law) {
    case Interpolation::kStraight: return "straight-in-parameters";
    case Interpolation::kCubicBSpline: return "cubic-b-spline";
    case Interpolation::kGeodesic: return "geodesic";
    case Interpolation::kCableLengths: break;
  }
  return "straight-in-cable-lengths";
}

const char* name(Verdict verdict) {
  switch (verdict) {
    case Verdict::kProved: return "proved";
    case Verdict::kRefuted: return "refuted";
    case Verdict::kUndecided: break;
  }
  return "undecided";
}

const char* claim_of(Verdict verdict) {
  switch (verdict) {
    case Verdict::kProved: return checker::kProvedClaim;
    case Verdict::kRefuted: return checker::kRefutedClaim;
    case Verdict::kUndecided: break;
  }
  return checker::kUndecidedClaim;
}

json generator_json() { return {{"name", "taut"}, {"version", TAUT_VERSION}}; }

namespace {

json hex_floats(std::span<const double> values) {
  json list = json::array();
  for (const double value : values) list.push_back(hex_float(value));
  return list;
}

/// "k/m" of a number in (0, 1) with m at most 2^52.
std::string dyadic_text(double s) {
  int depth = 1;
  while (std::ldexp(s, depth) != std::floor(std::ldexp(s, depth))) ++depth;
  return Dyadic{static_cast<std::uint64_t>(std::ldexp(s, depth)), depth}.text();
}

json tube_json(const PoseTube& tube) {
  return {{"position", hex_float(tube.position)}, {"turn", hex_float(tube.turn)}};
}

}  // namespace

json pose_tube_json(const PoseTube& tube, std::span<const InnerPose> inner_poses) {
  json result = tube_json(tube);
  for (const InnerPose& inner : inner_poses) {
    const std::span<const double> x = inner.x;
    result["inner"].push_back({{"s", dyadic_text(inner.s)},
                               {"position", hex_floats(x.first(3))},
                               {"quaternion", hex_floats(x.subspan(3))},
                               {"tube", tube_json(inner.tube)}});
  }
  return result;
}

namespace {

json waypoint_json(Interpolation law, const Waypoint& waypoint) {
  if (has_poses(law)) {
    const std::span<const double> x = waypoint.x;
    json result = {{"position", hex_floats(x.first(3))}, {"quaternion", hex_floats(x.subspan(3, 4))}};
    if (law == Interpolation::kCableLengths) result["lengths"] = hex_floats(x.subspan(7));
    return result;
  }
  json result = {{"x", hex_floats(waypoint.x)}, {"half_turns", waypoint.half_turns}};
  if (!waypoint.normals.empty()) result["normals"] = hex_floats(waypoint.normals);
  return result;
}

json path_json(const Path& path) {
  json waypoints = json::array();
  for (const Waypoint& waypoint : path.waypoints) waypoints.push_back(waypoint_json(path.interpolation, waypoint));
  json pose_tubes = json::array();
  for (std::size_t k = 0; k < path.pose_tubes.size(); ++k) {
    pose_tubes.push_back(pose_tube_json(path.pose_tubes[k],
                                        k < path.inner_poses.size() ? path.inner_poses[k] : std::vector<InnerPose>()));
  }
  return {{"interpolation", interpolation_name(path.interpolation)},
          {"waypoints", std::move(waypoints)},
          {"tubes", hex_floats(path.tubes)},
          {"pose_tubes", std::move(pose_tubes)},
          {"times", path.times.empty() ? json() : json(path.times)}};
}

json undecided_json(const PathProof& proof) {
  json result = {{"reason", proof.reason.text()}, {"segment", nullptr}, {"box", nullptr}};
  if (proof.open_segment >= 0) {
    const DyadicBox& box = proof.segments[static_cast<std::size_t>(proof.open_segment)].open_box;
    result["segment"] = proof.open_segment;
    result["box"] = {box.lower().text(), box.upper().text()};
  }
  return result;
}

}  // namespace

json make_certificate(const Problem& problem, const Path& path, const PathProof& proof, json illustration) {
  const KernelProof kernel = confirmed(problem, path, proof);
  const bool proved = kernel.verdict == Verdict::kProved;
  const bool refuted = kernel.verdict == Verdict::kRefuted;
  json segments = json::array();
  std::size_t boxes = 0;
  for (std::size_t k = 0; k < kernel.segments.size(); ++k) {
    const std::size_t to = k + control_points(path.interpolation) - 1;
    segments.push_back(to_json(kernel.segments[k], k, to, problem.tolerances.has_value()));
    boxes += kernel.segments[k].boxes.size();
  }
  json undecided;
  if (!proved && !refuted) {
    undecided = undecided_json(proof);
    undecided["reason"] = kernel.reason.text();
  }
  json certificate = {
      {"format", "taut-certificate"},
      {"version", kCertificateVersion},
      {"generator", generator_json()},
      {"verdict", name(kernel.verdict)},
      {"claim", claim_of(kernel.verdict)},
      {"problem", to_json(problem)},
      {"path", path_json(path)},
      {"segments", std::move(segments)},
      {"margins", proved ? to_json(kernel.margins) : json::object()},
      {"witness", refuted ? to_json(*proof.witness, *kernel.witness, segment_of(*proof.witness)) : json()},
      {"stretches", nullptr},
      {"source", nullptr},
      {"undecided", std::move(undecided)},
      {"illustration", std::move(illustration)},
  };
  certificate["problem_sha256"] = sha256(certificate["problem"]);
  certificate["path_sha256"] = sha256(certificate["path"]);
  const std::string digest = sha256(certificate);
  certificate["footer"] = {{"waypoints", path.waypoints.size()},
                           {"segments", certificate["segments"].size()},
                           {"boxes", boxes},
                           {"sha256", digest}};
  return certificate;
}

namespace {

double binary64(const JsonCursor& field) {
  const std::string& literal = field.text();
  const std::size_t digits = literal.starts_with('-') ? 3 : 2;  // behind "0x"
  double magnitude = std::numeric_limits<double>::infinity();
  if (literal.size() > digits) {
    std::from_chars(literal.data() + digits, literal.data() + literal.size(), magnitude, std::chars_format::hex);
  }
  const double value = literal.starts_with('-') ? -magnitude : magnitude;
  // As the checker reads it: one way to write each.
  if (!std::isfinite(value) || literal != hex_float(value)) {
    field.fail("a finite binary64 as %a prints it, such as \"0x1.8p+1\"");
  }
  return value;
}

std::vector<double> binary64s(const JsonCursor& list) {
  std::vector<double> values;
  for (std::size_t i = 0; i < list.size(); ++i) values.push_back(binary64(list.at(i)));
  return values;
}

std::vector<double> binary64s(const JsonCursor& list, std::size_t size) {
  if (list.size() != size) list.fail(fmt::format("a list of {}", size));
  return binary64s(list);
}

Waypoint waypoint_from_json(Interpolation law, const JsonCursor& entry) {
  Waypoint waypoint;
  if (has_poses(law)) {
    const auto append = [&](const JsonCursor& list, std::size_t size) {
      for (const double value : binary64s(list, size)) waypoint.x.push_back(value);
    };
    append(entry.at("position"), 3);
    append(entry.at("quaternion"), 4);
    if (law == Interpolation::kCableLengths) append(entry.at("lengths"), kCables);
    return waypoint;
  }
  waypoint.x = binary64s(entry.at("x"));
  for (const JsonCursor& turns : entry.at("half_turns").elements(waypoint.x.size())) {
    waypoint.half_turns.push_back(static_cast<int>(turns.integer(-kMostHalfTurns, kMostHalfTurns)));
  }
  if (entry.contains("normals")) waypoint.normals = binary64s(entry.at("normals"));
  return waypoint;
}

PoseTube tube_from_json(const JsonCursor& tube) { return {binary64(tube.at("position")), binary64(tube.at("turn"))}; }

/// Of "k/m" with m a power of two, at most 2^52.
double number_from_dyadic(const JsonCursor& field) {
  constexpr std::uint64_t kMostParts = std::uint64_t{1} << 52U;
  const std::string& text = field.text();
  std::uint64_t k = 0;
  std::uint64_t m = 0;
  const char* const end = text.data() + text.size();
  const auto [slash, no_k] = std::from_chars(text.data(), end, k);
  if (no_k == std::errc() && slash != end && *slash == '/') {
    const auto [last, no_m] = std::from_chars(slash + 1, end, m);
    if (no_m == std::errc() && last == end && k < m && m <= kMostParts && std::has_single_bit(m)) {
      return static_cast<double>(k) / static_cast<double>(m);
    }
  }
  field.fail("\"k/m\" with m a power of two up to 2^52");
}

InnerPose inner_pose_from_json(const JsonCursor& entry) {
  InnerPose inner;
  inner.s = number_from_dyadic(entry.at("s"));
  const std::vector<double> position = binary64s(entry.at("position"), 3);
  const std::vector<double> quaternion = binary64s(entry.at("quaternion"), 4);
  std::ranges::copy(quaternion, std::ranges::copy(position, inner.x.begin()).out);
  inner.tube = tube_from_json(entry.at("tube"));
  return inner;
}

std::vector<DecimalText> times_from_json(const JsonCursor& times, std::size_t waypoints) {
  std::vector<DecimalText> result;
  std::optional<Decimal> last;
  for (const JsonCursor& field : times.elements(waypoints)) {
    const Decimal time = decimal_from_json(field);
    if (last && !(time > *last)) field.fail("a time later than the one before");
    last = time;
    result.push_back(field.text());
  }
  return result;
}

Interpolation interpolation_from_json(const JsonCursor& law) {
  std::vector<std::string> names;
  for (const Interpolation known : {Interpolation::kStraight, Interpolation::kCubicBSpline, Interpolation::kGeodesic,
                                    Interpolation::kCableLengths}) {
    if (law.value() == interpolation_name(known)) return known;
    names.emplace_back(interpolation_name(known));
  }
  law.fail(fmt::format("one of {}", fmt::join(names, ", ")));
}

}  // namespace

Path path_from_json(const json& path) {
  const JsonCursor whole(path, "path");
  Path result;
  result.interpolation = interpolation_from_json(whole.at("interpolation"));
  for (const JsonCursor& entry : whole.at("waypoints").elements()) {
    result.waypoints.push_back(waypoint_from_json(result.interpolation, entry));
  }
  result.tubes = binary64s(whole.at("tubes"));
  for (const JsonCursor& tube : whole.at("pose_tubes").elements()) {
    result.pose_tubes.push_back(tube_from_json(tube));
    std::vector<InnerPose>& inner = result.inner_poses.emplace_back();
    if (!tube.contains("inner")) continue;
    for (const JsonCursor& pose : tube.at("inner").elements()) inner.push_back(inner_pose_from_json(pose));
  }
  if (const JsonCursor times = whole.at("times"); !times.is_null()) {
    result.times = times_from_json(times, result.waypoints.size());
  }
  return result;
}

}  // namespace taut
