// SPDX-License-Identifier: GPL-3.0-or-later
#include "certificate/certificate_reader.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <bit>
#include <charconv>
#include <cmath>
#include <cstdint>
#include <limits>
#include <nlohmann/json.hpp>
#include <optional>
#include <span>
#include <system_error>

#include "base/input_error.h"
#include "base/json_cursor.h"
#include "checker/format/legs.h"
#include "checker/format/strict_json.h"
#include "checker/kernel/errors.h"
#include "kinematics/time_law.h"
#include "problem/decimal.h"
#include "problem/rational.h"

namespace taut {

using nlohmann::json;

namespace {

// ---- Numbers --------------------------------------------------------------------------------------------------------

/// The text of a decimal.
std::string decimal(const JsonCursor& field) {
  (void)decimal_from_json(field);
  return field.text();
}

/// "k/m", "0" or "1".
Dyadic read_dyadic(const JsonCursor& field) {
  const std::string& text = field.text();
  const std::size_t slash = std::min(text.find('/'), text.size());
  const std::string numerator = text.substr(0, slash);
  const std::string denominator = slash < text.size() ? text.substr(slash + 1) : "1";
  constexpr std::size_t kMostDigits = 310;  // 2^1000 has 302
  const auto is_natural = [](const std::string& digits) {
    return !digits.empty() && digits.size() <= kMostDigits &&
           std::ranges::all_of(digits, [](char c) { return c >= '0' && c <= '9'; }) &&
           (digits == "0" || digits.front() != '0');
  };
  if (is_natural(numerator) && is_natural(denominator) && denominator != "0") {
    const boost::multiprecision::cpp_int k(numerator);
    const boost::multiprecision::cpp_int m(denominator);
    const unsigned depth = msb(m);
    if (m == boost::multiprecision::cpp_int(1) << depth && k <= m && depth <= DyadicBox::kMaxDepth + 1) {
      return {k, static_cast<int>(depth)};
    }
  }
  field.fail("a dyadic from 0 to 1");
}

double binary64(const JsonCursor& field) {
  const std::string& literal = field.text();
  const std::size_t digits = literal.starts_with('-') ? 3 : 2;  // behind "0x"
  double magnitude = std::numeric_limits<double>::infinity();
  if (literal.size() > digits) {
    std::from_chars(literal.data() + digits, literal.data() + literal.size(), magnitude, std::chars_format::hex);
  }
  const double value = literal.starts_with('-') ? -magnitude : magnitude;
  // There is one way to write each number, as for the checker.
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

// ---- The path -------------------------------------------------------------------------------------------------------

PoseNumbers pose_from_json(const JsonCursor& entry) {
  PoseNumbers pose{};
  const std::vector<double> position = binary64s(entry.at("position"), 3);
  const std::vector<double> quaternion = binary64s(entry.at("quaternion"), 4);
  std::ranges::copy(quaternion, std::ranges::copy(position, pose.begin()).out);
  return pose;
}

Waypoint waypoint_from_json(Interpolation law, const JsonCursor& entry) {
  if (has_poses(law)) {
    const PoseNumbers pose = pose_from_json(entry);
    if (law == Interpolation::kGeodesic) {
      if (entry.contains("lengths")) entry.at("lengths").fail("no such key under this law");
      return PosePoint{pose};
    }
    LengthsPoint point{pose};
    std::ranges::copy(binary64s(entry.at("lengths"), kCables), point.length_m.begin());
    return point;
  }
  ParameterPoint point{binary64s(entry.at("x")), {}};
  for (const JsonCursor& turns : entry.at("half_turns").elements(point.x.size())) {
    point.half_turns.push_back(static_cast<int>(turns.integer(-kMostHalfTurns, kMostHalfTurns)));
  }
  if (entry.contains("normals")) point.normals = binary64s(entry.at("normals"));
  return point;
}

PoseTube tube_from_json(const JsonCursor& tube) { return {binary64(tube.at("position")), binary64(tube.at("turn"))}; }

/// Reads "k/m" with m a power of two, at most 2^52.
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
  inner.x = pose_from_json(entry);
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

/// The path, with the sizes that the space prescribes.
Path read_path_in(const json& path, const SpaceText& space) {
  const std::size_t parameters = space.parameters.size();
  const std::size_t normals = parameters * space.constraints.size();
  Path result = taut::read_path(path);
  if (has_poses(result.interpolation)) return result;
  for (std::size_t k = 0; k < result.waypoints.size(); ++k) {
    const ParameterPoint& point = result.waypoints[k].parameters();
    if (point.x.size() != parameters || point.normals.size() != normals) {
      throw FieldError(
          fmt::format("path.waypoints[{}]", k),
          fmt::format("{} values of x and {} of normals", point.x.size(), point.normals.size()),
          fmt::format("expected {} values of x and of half_turns, and {} of normals", parameters, normals));
    }
  }
  return result;
}

/// Reads an index in [0, count).
int read_index(const JsonCursor& index, std::size_t count) {
  if (count == 0) index.fail("none, as the path has no segment");
  return static_cast<int>(index.integer(0, static_cast<std::int64_t>(count) - 1));
}

PathPoint read_point(const JsonCursor& point, const Path& path) {
  if (point.contains("waypoint")) return {false, read_index(point.at("waypoint"), path.waypoints.size()), {}};
  return {true, read_index(point.at("segment"), path.segments()), read_dyadic(point.at("s"))};
}

// ---- Bodies ---------------------------------------------------------------------------------------------------------

Direction direction_from_json(const JsonCursor& entry) {
  const std::vector<JsonCursor> parts = entry.elements(4);
  const std::string& axes = parts[0].text();
  if (axes != "W" && axes != "P") parts[0].fail("\"W\" or \"P\"");
  Direction result;
  result.in_platform = axes == "P";
  for (std::size_t k = 0; k < 3; ++k) {
    result.u[k] = static_cast<int>(parts[k + 1].integer(-Direction::kLargest, Direction::kLargest));
  }
  if (result.u == std::array<int, 3>{}) entry.fail("a vector that is not 0");
  return result;
}

/// The directions of one pair: an index of the table, null against a half-space, or a list of a pair with a mesh.
std::vector<Direction> read_apart(const JsonCursor& entry, std::span<const Direction> table) {
  if (entry.is_null()) return {{}};
  if (table.empty()) entry.fail("none, as the path states no direction");
  const auto last = static_cast<std::int64_t>(table.size()) - 1;
  const auto at = [&](const JsonCursor& index) { return table[static_cast<std::size_t>(index.integer(0, last))]; };
  if (!entry.value().is_array()) return {at(entry)};
  std::vector<Direction> result;
  for (const JsonCursor& index : entry.elements()) result.push_back(at(index));
  if (result.empty()) entry.fail("a direction");
  return result;
}

void set_apart(PairDirections& directions, std::size_t pair, std::vector<Direction> apart) {
  directions.lists.erase(pair);
  if (apart.size() > 1) directions.lists[pair] = apart;
  directions.single.at(pair) = apart.front();
}

/// `apart` of a segment and of its boxes.
std::vector<PairDirections> read_directions(const JsonCursor& segment, std::span<const Direction> table) {
  std::vector<PairDirections> result;
  const std::vector<JsonCursor> boxes = segment.at("boxes").elements();
  if (boxes.empty()) return result;
  PairDirections of_all;
  const std::vector<JsonCursor> entries = segment.at("apart").elements();
  of_all.single.resize(entries.size());
  for (std::size_t n = 0; n < entries.size(); ++n) set_apart(of_all, n, read_apart(entries[n], table));
  for (const JsonCursor& box : boxes) {
    PairDirections& of_box = result.emplace_back(of_all);
    if (!box.contains("apart")) continue;
    for (const JsonCursor& change : box.at("apart").elements()) {
      const std::vector<JsonCursor> parts = change.elements(2);
      if (entries.empty()) parts[0].fail("none, as no pair is checked");
      const auto pair = parts[0].integer(0, static_cast<std::int64_t>(entries.size()) - 1);
      set_apart(of_box, static_cast<std::size_t>(pair), read_apart(parts[1], table));
    }
  }
  return result;
}

// ---- How it is proved -----------------------------------------------------------------------------------------------

checker::NearZero read_near(const JsonCursor& near) {
  constexpr int kMostNarrowings = 8;
  return {binary64s(near.at("at")), binary64s(near.at("slope")), binary64(near.at("radius")),
          static_cast<int>(near.at("narrowings").integer(0, kMostNarrowings))};
}

/// How a box is proved, without its ends.
checker::Box read_proof(const JsonCursor& proof) {
  constexpr int kFewestBits = 32;
  constexpr int kMostBits = 4096;
  constexpr int kMostParts = 64;
  constexpr int kMostGuesses = 16;
  checker::Box result;
  result.bits = static_cast<int>(proof.at("bits").integer(kFewestBits, kMostBits));
  if (proof.contains("near")) result.near = read_near(proof.at("near"));
  if (proof.contains("parts")) result.parts = static_cast<int>(proof.at("parts").integer(1, kMostParts));
  if (proof.contains("guesses")) result.guesses = static_cast<int>(proof.at("guesses").integer(1, kMostGuesses));
  return result;
}

checker::Box read_box(const JsonCursor& box) {
  const std::vector<JsonCursor> ends = box.at("s").elements(2);
  checker::Box result = read_proof(box);
  result.begin = to_rational(read_dyadic(ends[0]));
  result.end = to_rational(read_dyadic(ends[1]));
  return result;
}

std::vector<checker::Box> read_boxes(const JsonCursor& boxes) {
  std::vector<checker::Box> result;
  for (const JsonCursor& box : boxes.elements()) result.push_back(read_box(box));
  return result;
}

/// How the pose at a point of the path is proved.
checker::Box read_proof_at(const JsonCursor& proof, const PathPoint& point) {
  checker::Box result = read_proof(proof);
  result.begin = result.end = to_rational(point.s);
  return result;
}

/// How a deviation is followed; null where it leads nowhere.
void read_way(const JsonCursor& way, Witness& witness) {
  if (way.is_null()) return;
  for (const JsonCursor& entry : way.at("poses").elements()) {
    checker::InnerPose& pose = witness.way_poses.emplace_back();
    pose.s = to_rational(read_dyadic(entry.at("tau")));
    const std::vector<double> position = binary64s(entry.at("position"), 3);
    const std::vector<double> quaternion = binary64s(entry.at("quaternion"), 4);
    std::ranges::copy(quaternion, std::ranges::copy(position, pose.x.begin()).out);
    const PoseTube tube = tube_from_json(entry.at("tube"));
    pose.tube = {tube.position, tube.turn};
  }
  witness.way_boxes = read_boxes(way.at("boxes"));
}

// ---- What is claimed ------------------------------------------------------------------------------------------------

Margins read_margins(const JsonCursor& margins) {
  Margins result{decimal(margins.at("tension_N")), decimal(margins.at("length_m")),
                 decimal(margins.at("wrench_scale"))};
  if (margins.contains("clearance_m")) result.clearance_m = decimal(margins.at("clearance_m"));
  return result;
}

template <std::size_t N>
void read_decimals(const JsonCursor& list, std::array<DecimalText, N>& result) {
  const std::vector<JsonCursor> elements = list.elements(N);
  for (std::size_t i = 0; i < N; ++i) result[i] = decimal(elements[i]);
}

void read_vectors(const JsonCursor& list, std::array<std::array<DecimalText, 3>, kCables>& result) {
  const std::vector<JsonCursor> elements = list.elements(kCables);
  for (std::size_t i = 0; i < kCables; ++i) read_decimals(elements[i], result[i]);
}

Deviation read_deviation(const JsonCursor& deviation) {
  Deviation result;
  read_vectors(deviation.at("base_anchors_m"), result.base_anchors_m);
  read_vectors(deviation.at("platform_anchors_m"), result.platform_anchors_m);
  read_decimals(deviation.at("load_point_m"), result.load_point_m);
  result.wrench = decimal(deviation.at("wrench"));
  read_decimals(deviation.at("position_m"), result.position_m);
  read_decimals(deviation.at("turn"), result.turn);
  if (deviation.contains("cable_lengths_m")) {
    read_decimals(deviation.at("cable_lengths_m"), result.cable_lengths_m.emplace());
  }
  return result;
}

std::optional<RateKind> read_rate(const JsonCursor& kind) {
  for (const RateKind rate : kRateKinds) {
    if (kind.text() == name(rate)) return rate;
  }
  return std::nullopt;
}

/// Which limit is violated; nothing for "singular".
std::optional<MarginKind> read_kind(const JsonCursor& kind) {
  constexpr std::array kLimits = {MarginKind::kTensionMin, MarginKind::kTensionMax, MarginKind::kLengthMin,
                                  MarginKind::kLengthMax};
  if (kind.text() == "singular") return std::nullopt;
  for (const MarginKind limit : kLimits) {
    if (kind.text() == name(limit)) return limit;
  }
  kind.fail("one of singular, tension_min, tension_max, length_min, length_max");
}

mpq_class rational(const JsonCursor& value) {
  try {
    return mpq_class(parse_rational(value.text()).str());
  } catch (const FieldError&) {
    throw;
  } catch (const InputError&) {  // names no place
    value.fail("a decimal number, or a fraction a/b, in a string");
  }
}

checker::ExactVector rational_vector(const JsonCursor& list) {
  const std::vector<JsonCursor> elements = list.elements(3);
  return {rational(elements[0]), rational(elements[1]), rational(elements[2])};
}

checker::LoadChoice read_load(const JsonCursor& load) {
  if (load.contains("mass_kg")) {
    return checker::WeightChoice{rational(load.at("mass_kg")), rational_vector(load.at("offset_m"))};
  }
  if (load.contains("vector")) return checker::VectorChoice{rational_vector(load.at("vector"))};
  if (load.contains("amount")) return checker::AmountChoice{rational(load.at("amount"))};
  constexpr std::int64_t kMostIndex = std::numeric_limits<int>::max();
  return checker::CaseChoice{static_cast<std::size_t>(load.at("case").integer(0, kMostIndex))};
}

std::vector<std::int64_t> read_shares(const JsonCursor& weights) {
  std::vector<std::int64_t> result;
  for (const JsonCursor& weight : weights.elements()) {
    const mpq_class share = rational(weight) * static_cast<long>(PointPair::kWhole);
    if (share.get_den() != 1 || share < 0 || share > static_cast<long>(PointPair::kWhole)) {
      weight.fail("a multiple of 1/2^30 from 0 to 1");
    }
    result.push_back(share.get_num().get_si());
  }
  return result;
}

/// What `witness` says of two bodies that are too near.
void read_contact(const JsonCursor& witness, Witness& result) {
  const auto read_weights = [](const JsonCursor& weights) {
    const std::vector<JsonCursor> of = weights.elements(2);
    return PointPair{read_shares(of[0]), read_shares(of[1])};
  };
  constexpr std::int64_t kMostPairs = std::numeric_limits<int>::max();
  PairContact& contact = result.violation.contact.emplace();
  contact.pair = static_cast<std::size_t>(witness.at("pair").integer(0, kMostPairs));
  if (witness.contains("around")) {
    const std::vector<JsonCursor> four = witness.at("around").elements(4);
    std::ranges::transform(four, contact.around.emplace().begin(), read_weights);
  } else {
    contact.points = read_weights(witness.at("weights"));
  }
  if (witness.contains("inside")) contact.points.inside = witness.at("inside").text() == "first" ? 0 : 1;
  if (witness.contains("elements")) {
    const std::vector<JsonCursor> elements = witness.at("elements").elements(2);
    for (std::size_t side = 0; side < 2; ++side) {
      constexpr std::int64_t kMostElements = std::numeric_limits<std::uint32_t>::max();
      if (elements[side].is_null()) continue;
      contact.points.elements[side] = static_cast<std::uint32_t>(elements[side].integer(0, kMostElements));
    }
  }
  result.violation.depth_m = decimal(witness.at("depth_m"));
  result.at_box = read_proof_at(witness.at("proof"), result.violation.at);
}

std::optional<Slowing> read_slowing(const JsonCursor& witness) {
  if (!witness.contains("slowing")) return std::nullopt;
  const JsonCursor slowing = witness.at("slowing");
  return Slowing{decimal(slowing.at("speed")), static_cast<int>(slowing.at("change").integer(-1, 1))};
}

/// Of the machine that deviates, if the witness is of one.
void read_deviating(const JsonCursor& witness, Witness& result) {
  if (!witness.contains("deviation")) return;
  const JsonCursor deviation = witness.at("deviation");
  result.violation.deviation = std::make_shared<const Deviation>(read_deviation(deviation));
  if (result.violation.deviation->cable_lengths_m) read_way(deviation.at("way"), result);
}

Witness read_witness(const JsonCursor& witness, const Path& path) {
  Witness result;
  PathWitness& violation = result.violation;
  const bool is_contact = witness.at("kind").text() == "contact";
  const std::optional<RateKind> rate = read_rate(witness.at("kind"));
  const std::optional<MarginKind> limit = is_contact || rate ? std::nullopt : read_kind(witness.at("kind"));
  violation.at = read_point(witness.at("at"), path);
  for (const JsonCursor& box : witness.at("motion").elements()) {
    result.motion.push_back({static_cast<std::size_t>(read_index(box.at("segment"), path.segments())), read_box(box)});
  }
  if (is_contact) {
    read_contact(witness, result);
    return result;
  }
  violation.slowing = read_slowing(witness);
  if (rate) {
    violation.rate = RateId{*rate};
    if (is_of_winch(*rate)) violation.rate->cable = static_cast<int>(witness.at("cable").integer(1, kCables)) - 1;
    const std::vector<JsonCursor> value = witness.at("value").elements(2);
    violation.value_lower = decimal(value[0]);
    violation.value_upper = decimal(value[1]);
    violation.limit = witness.at("limit").text();
    result.at_box = read_proof_at(witness.at("proof"), violation.at);
    read_deviating(witness, result);
    return result;
  }
  if (!limit) {
    violation.singular = true;
    violation.to = read_point(witness.at("to"), path);
    result.at_box = read_proof_at(witness.at("at_proof"), violation.at);
    result.to_box = read_proof_at(witness.at("to_proof"), violation.to);
    return result;
  }
  violation.margin = {*limit, static_cast<int>(witness.at("cable").integer(1, kCables)) - 1};
  const std::vector<JsonCursor> value = witness.at("value").elements(2);
  violation.value_lower = decimal(value[0]);
  violation.value_upper = decimal(value[1]);
  violation.limit = decimal(witness.at("limit"));
  result.at_box = read_proof_at(witness.at("proof"), violation.at);
  if (witness.contains("loads")) {
    std::vector<checker::LoadChoice>& loads = result.loads.emplace();
    for (const JsonCursor& load : witness.at("loads").elements()) loads.push_back(read_load(load));
  }
  read_deviating(witness, result);
  return result;
}

/// @param directions  of the path's table; null where the problem has no bodies
CertificateSegment read_segment(const JsonCursor& segment, std::size_t k, Interpolation law,
                                const std::vector<Direction>* directions) {
  CertificateSegment result;
  if (directions != nullptr) result.directions = read_directions(segment, *directions);
  result.boxes = read_boxes(segment.at("boxes"));
  const auto require = [&](const char* key, std::size_t waypoint) {
    constexpr std::int64_t kMostIndex = std::numeric_limits<int>::max();
    const JsonCursor field = segment.at(key);
    if (field.integer(0, kMostIndex) != static_cast<std::int64_t>(waypoint)) field.fail(fmt::format("{}", waypoint));
  };
  require("from", k);
  require("to", k + control_points(law) - 1);
  if (const JsonCursor margins = segment.at("margins"); !margins.is_null()) result.margins = read_margins(margins);
  return result;
}

Stretch read_stretch(const JsonCursor& stretch, const Path& path) {
  Stretch result;
  const std::vector<JsonCursor> outer = stretch.at("outer").elements(2);
  result.begin = read_point(outer[0], path);
  result.end = read_point(outer[1], path);
  if (const JsonCursor inner = stretch.at("inner"); !inner.is_null()) {
    const std::vector<JsonCursor> witnesses = inner.elements(2);
    result.violations = {read_witness(witnesses[0], path), read_witness(witnesses[1], path)};
  } else {
    result.reason = stretch.at("reason").text();
  }
  return result;
}

OpenPart read_undecided(const JsonCursor& undecided, const Path& path) {
  OpenPart result;
  result.reason = undecided.at("reason").text();
  if (const JsonCursor segment = undecided.at("segment"); !segment.is_null()) {
    result.segment = read_index(segment, path.segments());
  }
  if (const JsonCursor box = undecided.at("box"); !box.is_null()) {
    const std::vector<JsonCursor> ends = box.elements(2);
    result.box = {read_dyadic(ends[0]), read_dyadic(ends[1])};
    if (!(result.box->first < result.box->second)) box.fail("a lower end and a higher one");
  }
  return result;
}

Verdict read_verdict(const JsonCursor& verdict) {
  for (const Verdict known : {Verdict::kProved, Verdict::kRefuted, Verdict::kUndecided}) {
    if (verdict.text() == name(known)) return known;
  }
  verdict.fail("proved, refuted or undecided");
}

Problem read_problem(const JsonCursor& problem) {
  try {
    return problem_from_json(problem.value());
  } catch (const FieldError& error) {
    const bool is_whole = error.field() == "problem";
    throw FieldError(is_whole ? error.field() : "problem." + error.field(), error.seen(), error.expected());
  }
}

Generator read_generator(const JsonCursor& generator) {
  Generator result;
  if (generator.contains("name")) result.name = generator.at("name").text();
  if (generator.contains("version")) result.version = generator.at("version").text();
  return result;
}

void require_unaltered(const json& certificate, const std::string& sha256) {
  const json::json_pointer place("/footer/sha256");
  static const json kNone;
  const json& stated = certificate.is_object() && certificate.contains(place) ? certificate.at(place) : kNone;
  if (stated == sha256) return;
  JsonCursor(stated, "footer.sha256").fail("the digest of this file: it is no certificate, or was cut or altered");
}

}  // namespace

json parse_certificate(const std::string& text, const std::string& name) {
  return with_error_code(ErrorCode::kCertificate, name, [&] {
    try {
      const std::string digest = checker::read_json(text).body_sha256;
      json certificate = json::parse(text);
      require_unaltered(certificate, digest);
      return certificate;
    } catch (const checker::Malformed& error) {
      throw InputError(fmt::format("got {}, expected a certificate", error.what()));
    }
  });
}

Path read_path(const json& path) {
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
  if (whole.contains("timing")) {
    const JsonCursor timing = whole.at("timing");
    result.timing = TimeLaw{binary64(timing.at("step_s")), binary64s(timing.at("controls"))};
    if (const std::string text = complaint(result); !text.empty()) timing.fail("the law of a move along it: " + text);
  }
  return result;
}

Certificate read_certificate(const json& certificate) {
  const JsonCursor whole(certificate, "certificate");
  const auto member = [&](const char* key) -> JsonCursor { return {whole.at(key).value(), key}; };
  if (member("format").value() != "taut-certificate") member("format").fail("\"taut-certificate\"");
  const JsonCursor version = member("version");
  if (version.value() == checker::kVersionOfLegs) {
    version.fail(
        fmt::format("{}, {} or {}, about one path: this is a certificate of several legs, each of which has "
                    "one of its own beside it, in 1-NAME/certificate.json and so on",
                    kCertificateVersion, kCertificateVersionWithBodies, kCertificateVersionInTime));
  }
  if (version.value() != kCertificateVersion && version.value() != kCertificateVersionWithBodies &&
      version.value() != kCertificateVersionInTime) {
    version.fail(fmt::format("{}, {} or {}: only the taut that made it can make its report, or one of that time",
                             kCertificateVersion, kCertificateVersionWithBodies, kCertificateVersionInTime));
  }
  Certificate result;
  result.generator = read_generator(member("generator"));
  result.verdict = read_verdict(member("verdict"));
  result.claim = member("claim").text();
  result.problem = read_problem(member("problem"));
  result.path = read_path_in(member("path").value(), result.problem.space);
  result.problem_sha256 = member("problem_sha256").text();
  result.path_sha256 = member("path_sha256").text();
  result.footer_sha256 = member("footer").at("sha256").text();
  std::vector<Direction> directions;
  const bool has_bodies = result.problem.bodies.has_value();
  if (has_bodies) {
    for (const JsonCursor& entry : member("path").at("directions").elements()) {
      directions.push_back(direction_from_json(entry));
    }
  }
  for (const JsonCursor& segment : member("segments").elements()) {
    result.segments.push_back(
        read_segment(segment, result.segments.size(), result.path.interpolation, has_bodies ? &directions : nullptr));
  }
  const bool is_proved = result.verdict == Verdict::kProved;
  if (is_proved && result.path.segments() == 0) {
    member("path").at("waypoints").fail("at least two of a proved path");
  }
  if (is_proved && result.segments.empty()) member("segments").fail("some of a proved path");
  if (is_proved) result.margins = read_margins(member("margins"));
  if (result.verdict == Verdict::kRefuted) result.witness = read_witness(member("witness"), result.path);
  if (result.verdict == Verdict::kUndecided) result.undecided = read_undecided(member("undecided"), result.path);
  if (const JsonCursor stretches = member("stretches"); !stretches.is_null()) {
    for (const JsonCursor& stretch : stretches.elements()) {
      result.stretches.push_back(read_stretch(stretch, result.path));
    }
  }
  if (const JsonCursor source = member("source"); !source.is_null()) {
    result.source = {source.at("file").text(), source.at("sha256").text()};
  }
  if (whole.contains("illustration")) result.illustration = member("illustration").value();
  return result;
}

}  // namespace taut
