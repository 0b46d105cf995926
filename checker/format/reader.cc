// SPDX-License-Identifier: GPL-3.0-or-later
#include "checker/format/reader.h"

#include <algorithm>

#include "checker/format/claims.h"
#include "checker/format/parts.h"
#include "checker/format/signature.h"
#include "checker/format/strict_json.h"
#include "checker/kernel/errors.h"

namespace taut::checker {
namespace {

constexpr std::int64_t kVersion = 4;  ///< of the format
constexpr std::array<const char*, 3> kMarginKeys = {"tension_N", "length_m", "wrench_scale"};

[[noreturn]] void fail(const std::string& where, const std::string& expected) {
  throw Malformed(where + ": expected " + expected);
}
std::string at(const char* list, std::size_t i) { return std::string(list) + "[" + std::to_string(i) + "]"; }

/// From one abscissa of the path to another.
struct Interval {
  mpq_class begin;
  mpq_class end;
};

/// What is left of a path beside boxes that come in order.
class Gaps {
 public:
  void add(std::size_t k, const std::vector<Box>& boxes) {
    mpq_class reached = 0;
    for (const Box& box : boxes) {
      if (box.begin != reached) append(k, reached, box.begin);
      reached = box.end;
    }
    if (reached != 1) append(k, reached, 1);
  }
  [[nodiscard]] const std::vector<Interval>& intervals() const { return intervals_; }

  /// Whether intervals that come in order tile them.
  [[nodiscard]] bool are_tiled(const std::vector<Interval>& tiles) const {
    auto gap = intervals_.begin();
    mpq_class reached = intervals_.empty() ? mpq_class(0) : gap->begin;
    for (const Interval& tile : tiles) {
      if (gap == intervals_.end() || tile.begin != reached || tile.end > gap->end) return false;
      reached = tile.end;
      if (reached == gap->end && ++gap != intervals_.end()) reached = gap->begin;
    }
    return gap == intervals_.end();
  }

 private:
  void append(std::size_t k, const mpq_class& begin, const mpq_class& end) {
    const Interval gap = {abscissa({k, begin}), abscissa({k, end})};
    if (!intervals_.empty() && intervals_.back().end == gap.begin) {
      intervals_.back().end = gap.end;
    } else {
      intervals_.push_back(gap);
    }
  }
  std::vector<Interval> intervals_;
};

/// Takes the elements of the lists as they come, and then the outline, whose keys follow one another by code point: so
/// the path comes before the problem, both before the segments, and the verdict comes after these.
class Reader {
 public:
  explicit Reader(std::size_t size) : size_(size) {}

  void visit(const Json& outline, const Element& element) {
    const Cursor here(element.value, element.list, element.index);
    Path& path = result_.path;
    if (element.list == "path.waypoints") {
      if (element.index == 0) path.waypoints.reserve(announced(outline, "waypoints"));
      path.waypoints.push_back(read_waypoint(here, law(outline)));
    } else if (element.list == "path.tubes") {
      path.tubes.push_back(here.binary64());
      if (path.tubes.back() < 0) here.fail("a positive width");
      note_width(path.tubes.back(), here);
    } else if (element.list == "path.pose_tubes") {
      read_pose_tube(here, path);
      note_tube(path.pose_tubes.back(), here);
      for (const InnerPose& pose : path.inner_poses.back()) note_tube(pose.tube, here);
    } else if (element.list == "path.times") {
      const mpq_class time = here.decimal();
      if (element.index > 0 && time <= last_time_) here.fail("a time after the last one");
      last_time_ = time;
      times_ = element.index + 1;
    } else if (element.list == "segments") {
      visit_segment(outline, element, here);
    } else {
      visit_stretch(outline, element, here);
    }
  }

  Certificate finish(Outline outline) {
    const Cursor top(outline.json, "");
    const std::vector<std::string_view> keys = {"claim",    "footer", "format",      "generator", "illustration",
                                                "margins",  "path",   "path_sha256", "problem",   "problem_sha256",
                                                "segments", "source", "stretches",   "undecided", "verdict",
                                                "version",  "witness"};
    top.object(keys, {"signature"});
    if (top["format"].text() != "taut-certificate") top["format"].fail("'taut-certificate'");
    (void)top["version"].integer(kVersion, kVersion);
    if (!top["generator"].json().is_object()) top["generator"].fail("an object");
    const Cursor footer = top["footer"];
    footer.object({"boxes", "segments", "sha256", "waypoints"});
    require_digest(footer["sha256"], outline.body_sha256);
    require_digest(top["problem_sha256"], outline.problem_sha256);
    require_digest(top["path_sha256"], outline.path_sha256);
    if (top.has("signature")) result_.signer = verify_signature(top["signature"], outline.body_sha256);

    complete_path(outline.json);
    read_verdict(top);
    read_segments_and_stretches(top);
    read_witness_of(top);
    read_rest(top);
    const auto require_count = [&](const char* key, std::size_t n) {
      (void)footer[key].integer(static_cast<std::int64_t>(n), static_cast<std::int64_t>(n));
    };
    require_count("waypoints", result_.path.waypoints.size());
    require_count("segments", result_.segment_texts.size());
    require_count("boxes", result_.boxes);
    result_.problem_json = std::move(outline.problem);
    result_.path_sha256 = outline.path_sha256;
    return std::move(result_);
  }

 private:
  /// What the footer says of the size of a list, as far as the file is long enough for it.
  [[nodiscard]] std::size_t announced(const Json& outline, const char* key) const {
    if (!outline.contains("footer")) return 0;
    const Json& footer = outline["footer"];
    const bool is_count = footer.is_object() && footer.contains(key) && footer[key].is_number_unsigned();
    return is_count ? std::min(footer[key].get<std::size_t>(), size_ / 32) : 0;
  }

  Law law(const Json& outline) {
    if (!has_law_) {
      const Cursor path(outline["path"], "path");
      if (!path.has("interpolation")) path.fail("the key 'interpolation'");
      result_.path.law = read_law(path["interpolation"]);
      has_law_ = true;
    }
    return result_.path.law;
  }

  /// A width may be 0 in an undecided certificate only.
  void note_width(double width, const Cursor& where) {
    if (width == 0 && no_width_.empty()) no_width_ = where.where();
  }
  void note_tube(const PoseTube& tube, const Cursor& where) {
    note_width(std::min(tube.position, tube.turn), where);
    if (last_tube_ && !are_nested(*last_tube_, tube)) {
      where.fail("tubes each of which contains the one before, or is contained in it");
    }
    last_tube_ = tube;
  }

  /// Reads the problem, and checks the path against it, when both are there.
  void complete_path(const Json& outline) {
    if (is_path_complete_) return;
    is_path_complete_ = true;
    const Cursor top(outline, "");
    for (const char* key : {"margins", "path", "problem"}) {
      if (!top.has(key)) top.fail(std::string("the key '") + key + "'");
    }
    const Cursor json = top["path"];
    json.object({"interpolation", "pose_tubes", "times", "tubes", "waypoints"});
    Path& path = result_.path;
    (void)law(outline);
    result_.problem = read_problem(top["problem"]);
    const Problem& problem = result_.problem;
    for (const char* key : {"pose_tubes", "tubes", "waypoints"}) (void)json[key].size();
    if (!json["times"].is_null()) {
      (void)json["times"].size();
      require_size("path.times", times_, path.waypoints.size());
    }
    if (path.law == Law::kCubicBSpline && path.segments() == 0) fail("path.waypoints", "at least four of a spline");
    const std::size_t segments = std::max(path.segments(), std::min<std::size_t>(path.waypoints.size(), 1));
    require_size("path.tubes", path.tubes.size(), problem.constraints.empty() ? 0 : segments);
    require_size("path.pose_tubes", path.pose_tubes.size(), path.law == Law::kCableLengths ? segments : 0);
    if (has_poses(path.law)) {
      if (!problem.query.empty()) fail("problem.query.waypoints", "none where the path has a law of poses");
      if (outline["problem"]["space"] != coordinate_space()) fail("problem.space", "the one of the free coordinates");
    } else {
      for (std::size_t k = 0; k < path.waypoints.size(); ++k) require_waypoint(path.waypoints[k], k);
    }
  }

  static void require_size(const char* list, std::size_t size, std::size_t expected) {
    if (size != expected) fail(list, "an array of " + std::to_string(expected));
  }

  void require_waypoint(const Waypoint& waypoint, std::size_t k) const {
    const std::vector<Parameter>& parameters = result_.problem.parameters;
    const std::size_t n = parameters.size();
    const std::size_t normals = n * result_.problem.constraints.size();
    const std::string where = at("path.waypoints", k);
    if (waypoint.x.size() != n) fail(where + ".x", "an array of " + std::to_string(n));
    if (waypoint.normals.size() != normals) {
      fail(where + ".normals", normals == 0 ? "no such key" : "an array of " + std::to_string(normals));
    }
    for (std::size_t j = 0; j < n; ++j) {
      if (waypoint.half_turns[j] == 0 || parameters[j].kind == ParameterKind::kPeriodic) continue;
      fail(where + ".half_turns[" + std::to_string(j) + "]", "0 of a parameter that is not periodic");
    }
  }

  void visit_segment(const Json& outline, const Element& element, const Cursor& here) {
    complete_path(outline);
    const std::size_t k = element.index;
    if (k == 0) result_.segment_texts.reserve(announced(outline, "segments"));
    if (k >= result_.path.segments()) here.fail("no more segments than the path has");
    const Segment segment = read_segment(here, k, result_.problem, result_.path);
    gaps_.add(k, segment.boxes);
    result_.boxes += segment.boxes.size();
    result_.segment_texts.push_back(element.text);
    if (segment.boxes.empty()) return;
    const std::array<const mpq_class*, 3> margins = {&segment.margins.tension, &segment.margins.length,
                                                     &segment.margins.wrench_scale};
    for (std::size_t i = 0; i < 3; ++i) {
      if (!least_[i] || *margins[i] < *least_[i]) least_[i] = *margins[i];
      const Json& written = outline["margins"];
      is_of_segment_[i] |=
          written.is_object() && written.value(kMarginKeys[i], Json()) == element.value["margins"][kMarginKeys[i]];
    }
  }

  void visit_stretch(const Json& outline, const Element& element, const Cursor& here) {
    complete_path(outline);
    if (!result_.problem.query.empty()) fail("stretches", "null where nothing was audited");
    const Stretch stretch = read_stretch(here, result_.problem, result_.path);
    const Interval outer = {abscissa(stretch.begin), abscissa(stretch.end)};
    if (!outer_.empty() && outer.begin < outer_.back().end) here.fail("a stretch after the last one");
    outer_.push_back(outer);
    is_violated_ |= !stretch.inner.empty();
    result_.stretch_texts.push_back(element.text);
  }

  static void require_digest(const Cursor& claimed, const std::string& digest) {
    if (claimed.text() != digest) claimed.fail("the digest of what the file contains: it was altered");
  }

  void read_verdict(const Cursor& top) {
    constexpr std::array<const char*, 3> kClaims = {kProvedClaim, kRefutedClaim, kUndecidedClaim};
    result_.verdict = top["verdict"].one_of<Verdict>(
        {{"proved", Verdict::kProved}, {"refuted", Verdict::kRefuted}, {"undecided", Verdict::kUndecided}},
        "proved, refuted or undecided");
    result_.claim = kClaims[static_cast<std::size_t>(result_.verdict)];
    if (top["claim"].text() != result_.claim) top["claim"].fail("the text that belongs to the verdict");
    if (result_.verdict != Verdict::kUndecided && !no_width_.empty()) fail(no_width_, "a positive width");
    if (result_.verdict == Verdict::kProved && result_.path.segments() == 0) {
      fail("path.waypoints", "at least two of a proved path");
    }
  }

  void read_segments_and_stretches(const Cursor& top) {
    const bool is_proved = result_.verdict == Verdict::kProved;
    const bool is_refuted = result_.verdict == Verdict::kRefuted;
    const bool has_stretches = !top["stretches"].is_null();
    (void)top["segments"].size();
    if (has_stretches) (void)top["stretches"].size();
    require_size("segments", result_.segment_texts.size(),
                 is_proved || (is_refuted && has_stretches) ? result_.path.segments() : 0);
    const Cursor margins = top["margins"];
    if (is_proved) {
      if (has_stretches) top["stretches"].fail("null");
      if (!gaps_.intervals().empty()) {
        const mpz_class k = gaps_.intervals()[0].begin.get_num() / gaps_.intervals()[0].begin.get_den();
        fail(at("segments", k.get_ui()) + ".boxes", "boxes that tile [0, 1]");
      }
      (void)read_margins(margins);
      for (std::size_t i = 0; i < 3; ++i) {
        const Cursor margin = margins[kMarginKeys[i]];
        if (*least_[i] < margin.decimal()) margin.fail("not more than any segment's");
        if (!is_of_segment_[i]) margin.fail("the text of a segment's");
        result_.margins[i] = margin.text();
      }
      return;
    }
    margins.object({});
    if (!has_stretches) return;
    if (!result_.problem.query.empty()) fail("stretches", "null where nothing was audited");
    if (!is_refuted && is_violated_) fail("stretches", "open ones only, where nothing is refuted");
    if (is_refuted && !gaps_.are_tiled(outer_)) fail("stretches", "boxes and outer ends that tile the path");
  }

  void read_witness_of(const Cursor& top) {
    const Cursor json = top["witness"];
    if (result_.verdict != Verdict::kRefuted) {
      if (!json.is_null()) json.fail("null");
      return;
    }
    result_.witness = read_witness(json, result_.problem, result_.path);
    if (top["stretches"].is_null()) return;
    const auto is_witness = [&](Json of_stretch) {
      of_stretch["motion"] = json.json()["motion"];
      return of_stretch == json.json();
    };
    const bool is_found = std::ranges::any_of(result_.stretch_texts, [&](std::string_view text) {
      const Json inner = Json::parse(text)["inner"];
      return !inner.is_null() && (is_witness(inner[0]) || is_witness(inner[1]));
    });
    if (!is_found) json.fail("one of the stretches', but for its motion");
  }

  void read_rest(const Cursor& top) {
    const Cursor undecided = top["undecided"];
    if (result_.verdict == Verdict::kUndecided) {
      read_undecided(undecided);
    } else if (!undecided.is_null()) {
      undecided.fail("null");
    }
    const Cursor source = top["source"];
    if (source.is_null()) return;
    if (!result_.problem.query.empty()) source.fail("null where nothing was audited");
    source.object({"file", "sha256"});
    result_.source = Source{source["file"].text(), source["sha256"].hex(32)};
  }

  void read_undecided(const Cursor& json) {
    json.object({"box", "reason", "segment"});
    const Cursor box = json["box"];
    if (json["segment"].is_null() != box.is_null()) json.fail("segment and box, or neither");
    if (!box.is_null()) {
      (void)json["segment"].integer(0, static_cast<std::int64_t>(result_.path.segments()) - 1);
      box.array(2);
      if (box.at(0).dyadic() > box.at(1).dyadic()) box.fail("ends in order");
    }
    result_.undecided_reason = json["reason"].text();
  }

  std::size_t size_;  ///< of the text
  Certificate result_;
  bool has_law_ = false;
  bool is_path_complete_ = false;
  std::string no_width_;  ///< where a tube first has no width
  std::optional<PoseTube> last_tube_;
  mpq_class last_time_;
  std::size_t times_ = 0;
  Gaps gaps_;
  std::vector<Interval> outer_;                    ///< of the stretches
  bool is_violated_ = false;                       ///< in some stretch
  std::array<std::optional<mpq_class>, 3> least_;  ///< margins of segments
  std::array<bool, 3> is_of_segment_{};  ///< whether a segment writes the top-level margin as the top level does
};

/// A certificate of another version has other keys; that it is of another version says more than which.
void require_version(std::string_view text) {
  const auto is_of_top = [](int depth, Json::parse_event_t /*event*/, Json& /*value*/) { return depth <= 1; };
  const Json json = Json::parse(text, is_of_top, false);
  if (!json.is_object() || json.value("format", Json()) != "taut-certificate") return;
  const Json version = json.value("version", Json());
  if (!version.is_number_integer() || version == kVersion) return;
  fail("version", std::to_string(kVersion) + ", got " + version.dump() +
                      ": only the taut-check that came with the taut that made it can check it");
}

}  // namespace

Segment Certificate::segment(std::size_t k) const {
  const Json json = Json::parse(segment_texts[k]);
  return read_segment(Cursor(json, "segments", k), k, problem, path);
}

Stretch Certificate::stretch(std::size_t i) const {
  const Json json = Json::parse(stretch_texts[i]);
  return read_stretch(Cursor(json, "stretches", i), problem, path);
}

Certificate read_certificate(std::string_view text) {
  try {
    Reader reader(text.size());
    return reader.finish(read_json(text, [&](const Json& outline, const Element& x) { reader.visit(outline, x); }));
  } catch (const Malformed&) {
    require_version(text);
    throw;
  }
}

}  // namespace taut::checker
