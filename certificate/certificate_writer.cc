// SPDX-License-Identifier: GPL-3.0-or-later
#include "certificate/certificate_writer.h"

#include <fcntl.h>
#include <fmt/format.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <cmath>
#include <cstring>
#include <vector>

#include "base/input_error.h"
#include "base/sha256.h"
#include "certificate/worst_loads.h"
#include "checker/format/claims.h"
#include "checker/format/writer.h"

namespace taut {

using nlohmann::json;

namespace {

std::string canonical(const json& value) { return value.dump(-1, ' ', true); }

void append_hex_floats(std::string& text, std::span<const double> values) {
  text += '[';
  for (std::size_t i = 0; i < values.size(); ++i) {
    text += (i == 0 ? "\"" : ",\"") + hex_float(values[i]) + "\"";
  }
  text += ']';
}

/// Whether a body of a problem is a mesh.
bool has_meshes(const json& problem) {
  if (!problem.contains("bodies")) return false;
  const auto is_mesh = [](const json& body) { return body.contains("mesh"); };
  const json& bodies = problem["bodies"];
  return std::ranges::any_of(bodies["platform"], is_mesh) || std::ranges::any_of(bodies["obstacles"], is_mesh);
}

std::string claim_of(Verdict verdict, const json& problem, bool is_move,
                     const std::optional<std::array<bool, kPairClasses>>& checked) {
  if (verdict == Verdict::kUndecided) return checker::kUndecidedClaim;
  checker::ClaimSubject subject;
  subject.has_items = problem["load"].contains("items");
  subject.has_time = problem.contains("time");
  subject.is_move = is_move;
  subject.may_stop = subject.has_time && problem["time"].contains("stopping_time_s");
  subject.has_rows = subject.has_time && problem["time"].contains("rows");
  subject.checks = checked;
  subject.has_meshes = has_meshes(problem);
  subject.has_zones = checked && problem["bodies"].contains("contacts");
  subject.has_exit_cones = checked && problem["bodies"].contains("exit_cones");
  return checker::claim_text(verdict == Verdict::kProved, subject);
}

json rationals(const std::vector<std::int64_t>& shares) {
  json list = json::array();
  for (const std::int64_t share : shares) list.push_back(dyadic_share(share).text());
  return list;
}

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

/// An entry of `path.pose_tubes`.
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

json to_json(const Margins& m) {
  json result = {{"tension_N", m.tension_N}, {"length_m", m.length_m}, {"wrench_scale", m.wrench_scale}};
  if (m.clearance_m) result["clearance_m"] = *m.clearance_m;
  return result;
}

json to_json(const PathPoint& p) {
  if (!p.on_segment) return {{"waypoint", p.index}};
  return {{"segment", p.index}, {"s", p.s.text()}};
}

/// @param way  how the deviation is followed; its numbers are not read.
json to_json(const Deviation& d, const checker::WitnessDeviation& way) {
  json result = {{"base_anchors_m", d.base_anchors_m}, {"platform_anchors_m", d.platform_anchors_m},
                 {"load_point_m", d.load_point_m},     {"wrench", d.wrench},
                 {"position_m", d.position_m},         {"turn", d.turn}};
  if (d.cable_lengths_m) {
    result["cable_lengths_m"] = *d.cable_lengths_m;
    result["way"] = checker::way_to_json(way);
  }
  return result;
}

json to_json(const Stretch& stretch) {
  json inner;
  if (stretch.violations) inner = {taut::to_json(stretch.violations->first), taut::to_json(stretch.violations->second)};
  return {{"outer", {to_json(stretch.begin), to_json(stretch.end)}},
          {"inner", inner},
          {"reason", stretch.violations ? json() : json(stretch.reason)}};
}

json to_json(const OpenPart& open) {
  json result = {{"reason", open.reason}, {"segment", nullptr}, {"box", nullptr}};
  if (open.segment) result["segment"] = *open.segment;
  if (open.box) result["box"] = {open.box->first.text(), open.box->second.text()};
  return result;
}

/// Digests canonical text: leaves out the line feeds that the file has for the eye.
CertificateWriter::Write digest_of(Sha256& sha256) {
  return [&sha256](std::string_view text) {
    while (!text.empty()) {
      const std::size_t size = std::min(text.find('\n'), text.size());
      sha256.update(text.substr(0, size));
      text.remove_prefix(std::min(size + 1, text.size()));
    }
  };
}

}  // namespace

std::string waypoint_text(Interpolation law, const Waypoint& waypoint) {
  std::string text;
  if (has_poses(law)) {
    text = "{";
    if (law == Interpolation::kCableLengths) {
      text += "\"lengths\":";
      append_hex_floats(text, waypoint.lengths_m());
      text += ',';
    }
    const std::span<const double> pose = waypoint.pose();
    text += "\"position\":";
    append_hex_floats(text, pose.first(3));
    text += ",\"quaternion\":";
    append_hex_floats(text, pose.subspan(3));
    return text + "}";
  }
  const auto& [x, half_turns, normals] = waypoint.parameters();
  text = "{\"half_turns\":[";
  for (std::size_t j = 0; j < half_turns.size(); ++j) text += (j == 0 ? "" : ",") + std::to_string(half_turns[j]);
  text += "],";
  if (!normals.empty()) {
    text += "\"normals\":";
    append_hex_floats(text, normals);
    text += ',';
  }
  text += "\"x\":";
  append_hex_floats(text, x);
  return text + "}";
}

namespace {

/// Of segment k, without directions.
json segment_json(const CertificateSegment& segment, std::size_t k, bool has_tolerances, Interpolation law) {
  json boxes = json::array();
  for (const checker::Box& box : segment.boxes) boxes.push_back(checker::to_json(box, has_tolerances));
  return {{"boxes", std::move(boxes)},
          {"from", k},
          {"to", k + control_points(law) - 1},
          {"margins", segment.margins ? to_json(*segment.margins) : json()}};
}

}  // namespace

std::string segment_text(const CertificateSegment& segment, std::size_t k, const Problem& problem, Interpolation law) {
  return canonical(segment_json(segment, k, problem.tolerances.has_value(), law));
}

json to_json(const Witness& witness) {
  const PathWitness& violation = witness.violation;
  json motion = json::array();
  for (const checker::MotionBox& part : witness.motion) motion.push_back(checker::to_json(part));
  json result = {{"at", to_json(violation.at)}, {"motion", std::move(motion)}};
  if (violation.singular) {
    result["kind"] = "singular";
    result["to"] = to_json(violation.to);
    result["at_proof"] = checker::proof_to_json(witness.at_box);
    result["to_proof"] = checker::proof_to_json(witness.to_box);
    return result;
  }
  if (violation.contact) {
    const auto& [pair, points, around] = *violation.contact;
    const auto weights = [](const PointPair& of) { return json::array({rationals(of.first), rationals(of.second)}); };
    result["kind"] = "contact";
    result["depth_m"] = violation.depth_m;
    result["pair"] = pair;
    if (points.inside) result["inside"] = *points.inside == 0 ? "first" : "second";
    if (around) {
      for (const PointPair& of : *around) result["around"].push_back(weights(of));
    } else {
      result["weights"] = weights(points);
    }
    const auto& [first, second] = points.elements;
    if (first || second || points.inside) {
      result["elements"] = {first ? json(*first) : json(), second ? json(*second) : json()};
    }
    result["proof"] = checker::proof_to_json(witness.at_box);
    return result;
  }
  if (violation.rate) {
    result["kind"] = name(violation.rate->kind);
    result["cable"] = is_of_winch(violation.rate->kind) ? json(violation.rate->cable + 1) : json();
  } else {
    result["kind"] = name(violation.margin.kind);
    result["cable"] = violation.margin.cable + 1;
  }
  result["value"] = {violation.value_lower, violation.value_upper};
  result["limit"] = violation.limit;
  result["proof"] = checker::proof_to_json(witness.at_box);
  if (witness.loads) result["loads"] = to_json(*witness.loads);
  if (const auto& slowing = violation.slowing) {
    result["slowing"] = {{"change", slowing->change}, {"speed", slowing->speed}};
  }
  if (violation.deviation) {
    checker::WitnessDeviation way;
    way.poses = witness.way_poses;
    way.boxes = witness.way_boxes;
    result["deviation"] = to_json(*violation.deviation, way);
  }
  return result;
}

/// The items of a JSON array, in memory or in a file without a name.
class CertificateWriter::Spool {
 public:
  /// @param folder  of the file; empty: the items are kept in memory.
  explicit Spool(const std::filesystem::path& folder) : folder_(folder) {
    if (folder.empty()) return;
    // Without a name, so that a kill at any moment leaves nothing; not every file system can.
    int descriptor = ::open(folder.c_str(), O_TMPFILE | O_RDWR | O_CLOEXEC, 0600);
    if (descriptor < 0) {
      std::string name = (folder / ".taut.XXXXXX").string();
      descriptor = ::mkostemp(name.data(), O_CLOEXEC);
      if (descriptor < 0) fail();
      ::unlink(name.c_str());
    }
    file_ = ::fdopen(descriptor, "w+b");
    if (file_ == nullptr) fail();
  }
  ~Spool() {
    if (file_ != nullptr) std::fclose(file_);
  }
  Spool(const Spool&) = delete;
  Spool& operator=(const Spool&) = delete;

  void add(std::string_view item) {
    if (count_++ > 0) append(",\n");
    append(item);
  }
  [[nodiscard]] std::size_t count() const { return count_; }

  /// Writes the array. The line feeds between items are for the eye: no digest takes them.
  void replay(const Write& write) const {
    write("[");
    write(text_);
    if (file_ != nullptr) replay_file(write);
    write("]");
  }

 private:
  void replay_file(const Write& write) const {
    if (std::fflush(file_) != 0 || std::fseek(file_, 0, SEEK_SET) != 0) fail();
    std::vector<char> buffer(std::size_t{1} << 18U);
    while (const std::size_t size = std::fread(buffer.data(), 1, buffer.size(), file_)) {
      write(std::string_view(buffer.data(), size));
    }
    if (std::ferror(file_) != 0 || std::fseek(file_, 0, SEEK_END) != 0) fail();
  }
  void append(std::string_view text) {
    if (file_ == nullptr) {
      text_ += text;
    } else if (std::fwrite(text.data(), 1, text.size(), file_) != text.size()) {
      fail();
    }
  }
  [[noreturn]] void fail() const {
    throw InputError(fmt::format("{}: could not write a temporary file: {}", folder_.string(), std::strerror(errno)));
  }

  std::filesystem::path folder_;
  std::string text_;
  std::FILE* file_ = nullptr;
  std::size_t count_ = 0;
};

CertificateWriter::CertificateWriter(const Problem& problem, Interpolation law, const std::filesystem::path& folder)
    : problem_(taut::to_json(problem)), law_(law) {
  for (auto* spool : {&waypoints_, &times_, &tubes_, &pose_tubes_, &segments_, &stretches_, &directions_}) {
    *spool = std::make_unique<Spool>(folder);
  }
  if (!problem.bodies) return;
  checked_.emplace();
  for (std::size_t k = 0; k < kPairClasses; ++k) (*checked_)[k] = problem.bodies->clearance_m[k].has_value();
}

CertificateWriter::~CertificateWriter() = default;

void CertificateWriter::add_waypoint(std::string_view text) { waypoints_->add(text); }
void CertificateWriter::add_time(std::string_view decimal) { times_->add(fmt::format("\"{}\"", decimal)); }
void CertificateWriter::set_timing(const TimeLaw& law) { timing_ = law; }
void CertificateWriter::add_tube(double tube) { tubes_->add("\"" + hex_float(tube) + "\""); }
void CertificateWriter::add_pose_tube(const PoseTube& tube, std::span<const InnerPose> inner_poses) {
  pose_tubes_->add(canonical(pose_tube_json(tube, inner_poses)));
}
void CertificateWriter::add_segment(std::string_view text, std::size_t boxes) {
  segments_->add(text);
  boxes_ += boxes;
}
std::size_t CertificateWriter::index_of(const Direction& direction) {
  const auto [at, is_new] = index_.try_emplace(direction, index_.size());
  if (is_new) {
    const auto& [x, y, z] = direction.u;
    directions_->add(canonical(json::array({direction.in_platform ? "P" : "W", x, y, z})));
  }
  return at->second;
}

/// An entry of `apart` for each pair.
json CertificateWriter::apart(const PairDirections& directions) {
  json result = json::array();
  for (std::size_t pair = 0; pair < directions.single.size(); ++pair) {
    std::vector<std::size_t> indices;
    for (const Direction& direction : directions.of(pair)) {
      if (!is_of_half_space(direction)) indices.push_back(index_of(direction));
    }
    result.push_back(checker::apart_to_json(indices));
  }
  return result;
}

void CertificateWriter::add_segment(const CertificateSegment& segment, std::size_t k) {
  json result = segment_json(segment, k, !problem_["tolerances"].is_null(), law_);
  if (checked_) {
    const json of_all = segment.boxes.empty() ? json() : apart(segment.directions.front());
    for (std::size_t n = 1; n < segment.boxes.size(); ++n) {
      const json of_box = apart(segment.directions[n]);
      json changes = json::array();
      for (std::size_t pair = 0; pair < of_box.size(); ++pair) {
        if (of_box[pair] != of_all[pair]) changes.push_back({pair, of_box[pair]});
      }
      if (!changes.empty()) result["boxes"][n]["apart"] = std::move(changes);
    }
    result["apart"] = of_all;
  }
  add_segment(canonical(result), segment.boxes.size());
}

void CertificateWriter::add_stretch(const Stretch& stretch) { stretches_->add(canonical(to_json(stretch))); }

void CertificateWriter::emit_path(const Write& write) const {
  write("{");
  if (checked_) {
    write("\"directions\":");
    directions_->replay(write);
    write(",");
  }
  write(fmt::format(R"("interpolation":"{}","pose_tubes":)", interpolation_name(law_)));
  pose_tubes_->replay(write);
  write(",\"times\":");
  if (times_->count() == 0) {
    write("null");
  } else {
    times_->replay(write);
  }
  if (timing_) {
    write(",\"timing\":" +
          canonical({{"controls", hex_floats(timing_->controls)}, {"step_s", hex_float(timing_->step_s)}}));
  }
  write(",\"tubes\":");
  tubes_->replay(write);
  write(",\"waypoints\":");
  waypoints_->replay(write);
  write("}");
}

/// Writes all but the footer, the signature and the brace at the end.
void CertificateWriter::emit(const Certificate& rest, const Write& write, const std::string& path_digest) const {
  const bool is_undecided = rest.verdict == Verdict::kUndecided;
  write("{\"claim\":" + canonical(claim_of(rest.verdict, problem_, timing_.has_value(), checked_)));
  write(",\"format\":\"taut-certificate\",\"generator\":" + canonical({{"name", "taut"}, {"version", TAUT_VERSION}}));
  write(",\"illustration\":" + canonical(rest.illustration));
  write(",\"margins\":" + canonical(rest.margins ? to_json(*rest.margins) : json::object()));
  write(",\"path\":");
  emit_path(write);
  write(fmt::format(R"(,"path_sha256":"{}","problem":{},"problem_sha256":"{}","segments":)", path_digest,
                    canonical(problem_), sha256(problem_)));
  if (is_undecided) {
    write("[]");
  } else {
    segments_->replay(write);
  }
  const json source = rest.source ? json{{"file", rest.source->file}, {"sha256", rest.source->sha256}} : json();
  write(",\"source\":" + canonical(source) + ",\"stretches\":");
  if (stretches_->count() == 0) {
    write("null");
  } else {
    stretches_->replay(write);
  }
  write(",\"undecided\":" + canonical(rest.undecided ? to_json(*rest.undecided) : json()));
  write(fmt::format(R"(,"verdict":"{}","version":{},"witness":{})", name(rest.verdict),
                    problem_.contains("time") ? kCertificateVersionInTime
                    : checked_                ? kCertificateVersionWithBodies
                                              : kCertificateVersion,
                    canonical(rest.witness ? to_json(*rest.witness) : json())));
}

void CertificateWriter::finish(const Certificate& rest, const Write& write, const Sign& sign) {
  Sha256 path;
  emit_path(digest_of(path));
  const std::string path_digest = path.hex();

  Sha256 whole;
  const Write digest = digest_of(whole);
  const auto write_and_digest = [&](std::string_view text) {
    digest(text);
    write(text);
  };
  emit(rest, write_and_digest, path_digest);
  digest("}");
  const std::string body_digest = whole.hex();
  const bool has_segments = rest.verdict != Verdict::kUndecided;
  const std::string footer = canonical({{"waypoints", waypoints_->count()},
                                        {"segments", has_segments ? segments_->count() : 0},
                                        {"boxes", has_segments ? boxes_ : 0},
                                        {"sha256", body_digest}});
  write(",\"footer\":" + footer);
  if (sign) write(",\"signature\":" + canonical(sign(body_digest)));
  write("}\n");
}

std::string certificate_text(const Certificate& certificate, const SigningKey* key) {
  const Path& path = certificate.path;
  CertificateWriter writer(certificate.problem, path.interpolation);
  for (const Waypoint& waypoint : path.waypoints) writer.add_waypoint(waypoint_text(path.interpolation, waypoint));
  for (const DecimalText& time : path.times) writer.add_time(time);
  if (path.timing) writer.set_timing(*path.timing);
  for (const double tube : path.tubes) writer.add_tube(tube);
  for (std::size_t k = 0; k < path.pose_tubes.size(); ++k) {
    const bool has_inner_poses = k < path.inner_poses.size();
    writer.add_pose_tube(path.pose_tubes[k], has_inner_poses ? std::span<const InnerPose>(path.inner_poses[k])
                                                             : std::span<const InnerPose>());
  }
  for (std::size_t k = 0; k < certificate.segments.size(); ++k) {
    writer.add_segment(certificate.segments[k], k);
  }
  for (const Stretch& stretch : certificate.stretches) writer.add_stretch(stretch);
  CertificateWriter::Sign sign;
  if (key != nullptr) sign = [&](const std::string& digest) { return key->signature(digest); };
  std::string text;
  writer.finish(
      certificate, [&](std::string_view piece) { text += piece; }, sign);
  return json::parse(text).dump(1, ' ', true) + "\n";
}

}  // namespace taut
