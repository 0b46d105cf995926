// SPDX-License-Identifier: GPL-3.0-or-later
#include "checker/format/reader.h"

#include <algorithm>

#include "base/sha256.h"
#include "checker/format/claims.h"
#include "checker/format/parts.h"
#include "checker/format/signature.h"
#include "checker/format/strict_json.h"
#include "checker/kernel/errors.h"

namespace taut::checker {
namespace {

constexpr std::int64_t kVersion = 4;            ///< of the format
constexpr std::int64_t kVersionWithBodies = 5;  ///< where the problem states bodies
constexpr std::int64_t kVersionInTime = 6;      ///< where it states limits in time, with bodies or without
constexpr std::array<const char*, 4> kMarginKeys = {"tension_N", "length_m", "wrench_scale", "clearance_m"};

std::array<const mpq_class*, 4> values_of(const Margins& margins) {
  return {&margins.tension, &margins.length, &margins.wrench_scale, &margins.clearance};
}

auto is_digest(std::string_view digest) {
  return exactly(digest, "the digest of what the file contains: it was altered");
}

/// Parts of a path that come in order, each from one abscissa to another. Parts that meet are one.
class Parts {
 public:
  void append(const mpq_class& begin, const mpq_class& end) {
    if (!parts_.empty() && parts_.back().second == begin) {
      parts_.back().second = end;
    } else {
      parts_.emplace_back(begin, end);
    }
  }
  [[nodiscard]] bool empty() const { return parts_.empty(); }
  [[nodiscard]] const mpq_class& begin() const { return parts_.front().first; }
  [[nodiscard]] const mpq_class& end() const { return parts_.back().second; }
  bool operator==(const Parts&) const = default;

 private:
  std::vector<std::pair<mpq_class, mpq_class>> parts_;
};

class Reader {
 public:
  explicit Reader(Outline outline) : outline_(std::move(outline)), top_(outline_.json, "") {}

  Certificate read() {
    require_version();
    const auto by = [this](void (Reader::*part)(const Cursor&)) {
      return [this, part](const Cursor& json) { (this->*part)(json); };
    };
    const auto later = [](const Cursor& /*json*/) {};
    const auto read_footer = [&](const Cursor& footer) {
      footer.object("sha256", is_digest(outline_.body_sha256), "boxes", later, "segments", later, "waypoints", later);
    };
    top_.object("format", exactly("taut-certificate", "'taut-certificate'"), "version", later, "footer", read_footer,
                "generator", by(&Reader::read_generator), "illustration", later, "claim", later, "verdict",
                by(&Reader::read_verdict), "path_sha256", is_digest(outline_.path_sha256), "problem",
                by(&Reader::read_problem_and_digest), "problem_sha256", later, "path", by(&Reader::read_path),
                "stretches", by(&Reader::read_stretches), "segments", by(&Reader::read_segments), "margins",
                by(&Reader::read_margins_of_path), "witness", by(&Reader::read_witness_of_path), "undecided",
                by(&Reader::read_undecided), "source", by(&Reader::read_source), "signature?",
                by(&Reader::read_signature));
    const Cursor footer = top_["footer"];
    exactly(result_.path.waypoints.size())(footer["waypoints"]);
    exactly(result_.segment_texts.size())(footer["segments"]);
    exactly(result_.boxes)(footer["boxes"]);
    result_.problem_json = std::move(outline_.json["problem"]);
    return std::move(result_);
  }

 private:
  /// A certificate of another version has other keys; that it is of another version says more than which.
  void require_version() const {
    const Json& json = outline_.json;
    if (!json.is_object() || json.value("format", Json()) != "taut-certificate") return;
    const Json version = json.value("version", Json());
    if (!version.is_number_integer() || (version >= kVersion && version <= kVersionInTime)) return;
    top_["version"].fail(std::to_string(kVersion) + ", " + std::to_string(kVersionWithBodies) + " or " +
                         std::to_string(kVersionInTime) + ", got " + version.dump() +
                         ": only the taut-check that came with the taut that made it can check it");
  }

  void read_generator(const Cursor& json) { json.require(json.json().is_object(), "an object"); }
  void read_problem_and_digest(const Cursor& json) {
    is_digest(sha256(json.json()))(top_["problem_sha256"]);
    result_.problem = read_problem(json);
    const Problem& problem = result_.problem;
    exactly(problem.time ? kVersionInTime : problem.bodies ? kVersionWithBodies : kVersion)(top_["version"]);
    require_claim();
  }
  void read_signature(const Cursor& json) { result_.signer = verify_signature(json, outline_.body_sha256); }

  /// Calls `read(element, text)` for each element of a list that may be long. @returns how many there are
  template <class Read>
  std::size_t for_each(const char* key, const char* name, const Read& read) const {
    std::size_t count = 0;
    const auto list = outline_.lists.find(key);
    if (list == outline_.lists.end()) return 0;
    for_each_element(list->second,
                     [&](const Json& element, std::string_view text) { read(Cursor(element, name, count++), text); });
    return count;
  }

  /// How many objects there are in a list whose elements are objects of plain values; more are not made room for.
  [[nodiscard]] std::size_t objects_in(const char* key) const {
    constexpr std::size_t kLeastBytes = 24;  // {"half_turns":[],"x":[]}
    const auto list = outline_.lists.find(key);
    if (list == outline_.lists.end()) return 0;
    return std::min<std::size_t>(std::ranges::count(list->second, '{'), list->second.size() / kLeastBytes);
  }

  static void require_size(const Cursor& json, std::size_t size, std::size_t expected) {
    if (size != expected) json.fail("an array of " + std::to_string(expected));
  }

  // ---- The path -----------------------------------------------------------------------------------------------------

  void read_path(const Cursor& json) {
    Path& path = result_.path;
    const Problem& problem = result_.problem;
    const auto is_list = [](const Cursor& list) { (void)list.size(); };
    const auto is_list_or_null = [&](const Cursor& list) { list.is_null() ? void() : is_list(list); };
    json.object(
        problem.bodies ? "directions" : nullptr, is_list, "interpolation",
        [&](const Cursor& law) { path.law = law.one_of<Law>(kLaws, "a law of the format"); }, "pose_tubes", is_list,
        "times", is_list_or_null, "timing?", [](const Cursor& /*timing*/) {}, "tubes", is_list, "waypoints", is_list);
    path.waypoints.reserve(objects_in("waypoints"));
    for_each("waypoints", "path.waypoints", [&](const Cursor& here, std::string_view /*text*/) {
      path.waypoints.push_back(read_waypoint(here, path.law));
      if (!has_poses(path.law)) require_waypoint(here, path.waypoints.back());
    });
    const std::size_t waypoints = path.waypoints.size();
    if (!json["times"].is_null()) require_size(json["times"], read_times(), waypoints);
    json["waypoints"].require(path.law != Law::kCubicBSpline || path.segments() > 0, "at least four of a spline");
    read_tubes();
    for_each("directions", "path.directions",
             [&](const Cursor& here, std::string_view /*text*/) { append_direction(here, path); });
    const std::size_t segments = std::max(path.segments(), std::min<std::size_t>(waypoints, 1));
    require_size(json["tubes"], path.tubes.size(), problem.constraints.empty() ? 0 : segments);
    require_size(json["pose_tubes"], path.pose_tubes.size(), path.law == Law::kCableLengths ? segments : 0);
    if (json.has("timing")) {
      read_timing(json["timing"], problem, path);
      json["times"].require(json["times"].is_null(), "null in a move, whose law says when it is where");
    }
    const bool may_be_at_rest = !problem.time || result_.verdict != Verdict::kProved;
    json.require(path.timing || may_be_at_rest, "the key 'timing' of a proved move");
    if (!has_poses(path.law)) return;
    const Cursor of_case = top_["problem"];
    if (!problem.query.empty()) {
      throw Malformed("problem.query.waypoints: expected none where the path has a law of poses");
    }
    of_case["space"].require(of_case["space"].json() == coordinate_space(), "the one of the free coordinates");
  }

  [[nodiscard]] std::size_t read_times() const {
    mpq_class last = -1;
    bool is_first = true;
    return for_each("times", "path.times", [&](const Cursor& here, std::string_view /*text*/) {
      mpq_class time;
      taut::checker::read(here, time);
      here.require(is_first || time > last, "a time after the last one");
      last = time;
      is_first = false;
    });
  }

  void read_tubes() {
    Path& path = result_.path;
    for_each("tubes", "path.tubes", [&](const Cursor& here, std::string_view /*text*/) {
      taut::checker::read(here, path.tubes.emplace_back());
      here.require(path.tubes.back() >= 0, "a positive width");
      require_width(here, path.tubes.back());
    });
    std::optional<PoseTube> last;
    const auto require_tube = [&](const Cursor& here, const PoseTube& tube) {
      require_width(here, std::min(tube.position, tube.turn));
      here.require(!last || are_nested(*last, tube),
                   "tubes each of which contains the one before, or is contained in it");
      last = tube;
    };
    for_each("pose_tubes", "path.pose_tubes", [&](const Cursor& here, std::string_view /*text*/) {
      read_pose_tube(here, path);
      require_tube(here, path.pose_tubes.back());
      for (const InnerPose& pose : path.inner_poses.back()) require_tube(here, pose.tube);
    });
  }

  /// A width may be 0 in an undecided certificate only.
  void require_width(const Cursor& json, double width) const {
    json.require(width > 0 || result_.verdict == Verdict::kUndecided, "a positive width");
  }

  void require_waypoint(const Cursor& json, const Waypoint& waypoint) const {
    const std::vector<Parameter>& parameters = result_.problem.parameters;
    const std::size_t n = parameters.size();
    const std::size_t normals = n * result_.problem.constraints.size();
    json["x"].require_size(n);
    if (waypoint.normals.size() != normals) {
      throw Malformed(json.where() + ".normals: expected " +
                      (normals == 0 ? "no such key" : "an array of " + std::to_string(normals)));
    }
    const Cursor half_turns = json["half_turns"];
    for (std::size_t j = 0; j < n; ++j) {
      half_turns.at(j).require(waypoint.half_turns[j] == 0 || parameters[j].kind == ParameterKind::kPeriodic,
                               "0 of a parameter that is not periodic");
    }
  }

  // ---- What is stated of it -----------------------------------------------------------------------------------------

  void read_verdict(const Cursor& json) {
    static constexpr std::array<std::pair<const char*, Verdict>, 3> kVerdicts = {
        {{"proved", Verdict::kProved}, {"refuted", Verdict::kRefuted}, {"undecided", Verdict::kUndecided}}};
    result_.verdict = json.one_of<Verdict>(kVerdicts, "proved, refuted or undecided");
  }

  void require_claim() const {
    const Problem& problem = result_.problem;
    ClaimSubject subject{.has_items = !problem.items.empty(),
                         .has_time = problem.time.has_value(),
                         .is_move = top_["path"].has("timing"),
                         .may_stop = problem.time && problem.time->stopping_time,
                         .has_rows = problem.time && problem.time->rows};
    if (problem.bodies) {
      subject.checks = problem.bodies->checks;
      subject.has_meshes = problem.bodies->has_meshes();
      subject.has_zones = problem.bodies->has_zones();
      subject.has_exit_cones = !problem.bodies->exit_cones.empty();
    }
    const bool is_undecided = result_.verdict == Verdict::kUndecided;
    const std::string claim = is_undecided ? kUndecidedClaim : claim_text(result_.verdict == Verdict::kProved, subject);
    exactly(claim, "the text that belongs to the verdict")(top_["claim"]);
  }

  void read_stretches(const Cursor& json) {
    if (json.is_null()) return;
    (void)json.size();
    json.require(!result_.problem.time, "null where the problem has limits in time");
    const bool is_audit = result_.problem.query.empty();
    json.require(is_audit && result_.verdict != Verdict::kProved, is_audit ? "null" : "null where nothing was audited");
    for_each("stretches", "stretches", [&](const Cursor& here, std::string_view text) {
      Stretch stretch = read_stretch(here, result_.problem, result_.path);
      const mpq_class begin = abscissa(stretch.begin);
      here.require(outer_.empty() || begin >= outer_.end(), "a stretch after the last one");
      outer_.append(begin, abscissa(stretch.end));
      if (!stretch.inner.empty()) violated_.push_back({stretch.begin, stretch.end, {}});
      result_.stretch_texts.push_back(text);
    });
    json.require(result_.verdict == Verdict::kRefuted || violated_.empty(), "open ones only, where nothing is refuted");
  }

  void read_segments(const Cursor& json) {
    const bool is_proved = result_.verdict == Verdict::kProved;
    const bool has_stretches = !top_["stretches"].is_null();
    const std::size_t expected =
        is_proved || (result_.verdict == Verdict::kRefuted && has_stretches) ? result_.path.segments() : 0;
    (void)json.size();
    Parts gaps;
    result_.segment_texts.reserve(expected);
    for_each("segments", "segments", [&](const Cursor& here, std::string_view text) {
      const std::size_t k = result_.segment_texts.size();
      here.require(k < result_.path.segments(), "no more segments than the path has");
      const Segment segment = read_segment(here, k, result_.problem, result_.path);
      mpq_class reached = 0;
      for (const Box& box : segment.boxes) {
        if (box.begin != reached) gaps.append(abscissa({k, reached}), abscissa({k, box.begin}));
        reached = box.end;
      }
      if (reached != 1) gaps.append(abscissa({k, reached}), abscissa({k, 1}));
      if (is_proved) here["boxes"].require(gaps.empty(), "boxes that tile [0, 1]");
      result_.boxes += segment.boxes.size();
      result_.segment_texts.push_back(text);
      if (!segment.boxes.empty()) note_margins(segment.margins, here["margins"].json());
    });
    require_size(json, result_.segment_texts.size(), expected);
    if (is_proved && expected == 0) throw Malformed("path.waypoints: expected at least two of a proved path");
    if (expected > 0 && !is_proved) {
      top_["stretches"].require(gaps == outer_, "boxes and outer ends that tile the path");
    }
  }

  [[nodiscard]] std::size_t margin_count() const { return result_.problem.bodies ? 4 : 3; }

  void note_margins(const Margins& margins, const Json& written) {
    const auto values = values_of(margins);
    for (std::size_t i = 0; i < margin_count(); ++i) {
      if (!least_[i] || *values[i] < *least_[i]) least_[i] = *values[i];
      const Json& of_path = outline_.json["margins"];
      is_of_segment_[i] |= of_path.is_object() && of_path.value(kMarginKeys[i], Json()) == written[kMarginKeys[i]];
    }
  }

  void read_margins_of_path(const Cursor& json) {
    if (result_.verdict != Verdict::kProved) return json.object();
    Margins margins;
    read_margins(json, result_.problem, margins);
    const auto values = values_of(margins);
    for (std::size_t i = 0; i < margin_count(); ++i) {
      const Cursor margin = json[kMarginKeys[i]];
      margin.require(*least_[i] >= *values[i], "not more than any segment's");
      margin.require(is_of_segment_[i], "the text of a segment's");
      result_.margins[i] = margin.text();
    }
  }

  void read_witness_of_path(const Cursor& json) {
    if (result_.verdict != Verdict::kRefuted) return json.require(json.is_null(), "null");
    result_.witness = read_witness(json, result_.problem, result_.path);
    if (top_["stretches"].is_null()) return;
    // It may be graver than those of the stretches, which are where violations begin and end.
    const auto contains_it = [&](const Stretch& stretch) { return is_inside(*result_.witness, stretch); };
    json.require(std::ranges::any_of(violated_, contains_it), "a place between the outer ends of a violated stretch");
  }

  void read_undecided(const Cursor& json) {
    if (result_.verdict != Verdict::kUndecided) return json.require(json.is_null(), "null");
    const auto read_segment_number = [&](const Cursor& segment) {
      if (!segment.is_null()) (void)segment.integer(0, static_cast<std::int64_t>(result_.path.segments()) - 1);
    };
    const auto read_box = [&](const Cursor& box) {
      json.require(box.is_null() == json["segment"].is_null(), "segment and box, or neither");
      if (box.is_null()) return;
      mpq_class begin, end;
      box.require_size(2);
      dyadic(begin)(box.at(0));
      dyadic(end)(box.at(1));
      box.require(begin <= end, "ends in order");
    };
    json.object("box", read_box, "reason", result_.undecided_reason, "segment", read_segment_number);
  }

  void read_source(const Cursor& json) {
    if (json.is_null()) return;
    json.require(result_.problem.query.empty(), "null where nothing was audited");
    Source& source = result_.source.emplace();
    json.object("file", source.file, "sha256", hex(source.sha256, 32));
  }

  Outline outline_;
  Cursor top_;
  Certificate result_;
  Parts outer_;                                    ///< of the stretches
  std::vector<Stretch> violated_;                  ///< outer ends of those that have witnesses
  std::array<std::optional<mpq_class>, 4> least_;  ///< margins of segments
  std::array<bool, 4> is_of_segment_{};  ///< whether a segment writes the top-level margin as the top level does
};

}  // namespace

Segment Certificate::segment(std::size_t k) const {
  const Json json = Json::parse(segment_texts[k]);
  return read_segment(Cursor(json, "segments", k), k, problem, path);
}

Stretch Certificate::stretch(std::size_t i) const {
  const Json json = Json::parse(stretch_texts[i]);
  return read_stretch(Cursor(json, "stretches", i), problem, path);
}

Certificate read_certificate(Outline outline) { return Reader(std::move(outline)).read(); }
Certificate read_certificate(std::string_view text) { return read_certificate(read_json(text)); }

}  // namespace taut::checker
