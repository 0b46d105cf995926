// SPDX-License-Identifier: GPL-3.0-or-later
#include "certificate/certificate_view.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <cstdint>
#include <limits>
#include <nlohmann/json.hpp>
#include <string_view>

#include "base/input_error.h"
#include "base/json_cursor.h"
#include "certificate/certificate.h"
#include "problem/decimal.h"

namespace taut {

using nlohmann::json;

namespace {

/// Nearest double of a decimal.
double approximation(const JsonCursor& field) {
  double value = 0;
  const std::string& text = field.text();
  const char* const end = text.data() + text.size();
  const auto [read, error] = std::from_chars(text.data(), end, value);
  if (error != std::errc() || read != end || !std::isfinite(value)) field.fail("a number in a string");
  return value;
}

/// Its text.
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

std::vector<DyadicBox> read_boxes(const JsonCursor& boxes) {
  std::vector<DyadicBox> result;
  for (const JsonCursor& ends : boxes.elements()) {
    const std::vector<JsonCursor> both = ends.at("s").elements(2);
    const Dyadic lower = read_dyadic(both[0]);
    const Dyadic upper = read_dyadic(both[1]);
    const int depth = std::max(lower.depth, upper.depth);
    const DyadicBox box = {lower.k << (depth - lower.depth), depth};
    if (depth <= DyadicBox::kMaxDepth && box.upper() == upper) result.push_back(box);
  }
  return result;
}

Path read_path(const json& path, const SpaceText& space) {
  const std::size_t parameters = space.parameters.size();
  const std::size_t normals = parameters * space.constraints.size();
  Path result = path_from_json(path);
  if (has_poses(result.interpolation)) return result;
  for (std::size_t k = 0; k < result.waypoints.size(); ++k) {
    const Waypoint& waypoint = result.waypoints[k];
    if (waypoint.x.size() != parameters || waypoint.normals.size() != normals) {
      throw FieldError(
          fmt::format("path.waypoints[{}]", k),
          fmt::format("{} values of x and {} of normals", waypoint.x.size(), waypoint.normals.size()),
          fmt::format("expected {} values of x and of half_turns, and {} of normals", parameters, normals));
    }
  }
  return result;
}

MarginsView read_margins(const JsonCursor& margins) {
  return {decimal(margins.at("tension_N")), decimal(margins.at("length_m")), decimal(margins.at("wrench_scale"))};
}

/// Of one of so many things.
int read_index(const JsonCursor& index, std::size_t count) {
  if (count == 0) index.fail("none, as the path has no segment");
  return static_cast<int>(index.integer(0, static_cast<std::int64_t>(count) - 1));
}

PathPointView read_point(const JsonCursor& point, const Path& path) {
  PathPointView result;
  if (point.contains("waypoint")) {
    result.index = read_index(point.at("waypoint"), path.waypoints.size());
    result.position = result.index;
  } else {
    result.index = read_index(point.at("segment"), path.segments());
    result.s = point.at("s").text();
    result.position = result.index + read_dyadic(point.at("s")).approx();
  }
  return result;
}

WitnessView read_witness(const JsonCursor& witness, const Path& path) {
  WitnessView result;
  result.kind = witness.at("kind").text();
  constexpr std::array<std::string_view, 5> kKinds = {"singular", "tension_min", "tension_max", "length_min",
                                                      "length_max"};
  if (std::ranges::find(kKinds, result.kind) == kKinds.end()) {
    witness.at("kind").fail(fmt::format("one of {}", fmt::join(kKinds, ", ")));
  }
  result.at = read_point(witness.at("at"), path);
  if (result.kind == "singular") {
    result.to = read_point(witness.at("to"), path);
    return result;
  }
  result.cable = static_cast<int>(witness.at("cable").integer(1, kCables));
  const std::vector<JsonCursor> value = witness.at("value").elements(2);
  result.value_lower = decimal(value[0]);
  result.value_upper = decimal(value[1]);
  result.limit = decimal(witness.at("limit"));
  result.deviates = witness.contains("deviation");
  result.uses_continuation = result.deviates && witness.at("deviation").contains("cable_lengths_m");
  return result;
}

StretchView read_stretch(const JsonCursor& stretch, const Path& path) {
  StretchView result;
  const std::vector<JsonCursor> outer = stretch.at("outer").elements(2);
  result.begin = read_point(outer[0], path);
  result.end = read_point(outer[1], path);
  if (const JsonCursor inner = stretch.at("inner"); !inner.is_null()) {
    const std::vector<JsonCursor> witnesses = inner.elements(2);
    result.first = read_witness(witnesses[0], path);
    result.last = read_witness(witnesses[1], path);
  } else {
    result.reason = stretch.at("reason").text();
  }
  return result;
}

UndecidedView read_undecided(const JsonCursor& undecided, const Path& path) {
  UndecidedView result;
  result.reason = undecided.at("reason").text();
  if (const JsonCursor segment = undecided.at("segment"); !segment.is_null()) {
    result.segment = read_index(segment, path.segments());
  }
  if (const JsonCursor box = undecided.at("box"); !box.is_null()) {
    const std::vector<JsonCursor> ends = box.elements(2);
    result.box_lower = ends[0].text();
    result.box_upper = ends[1].text();
    const Dyadic lower = read_dyadic(ends[0]);
    const Dyadic upper = read_dyadic(ends[1]);
    if (!(lower < upper)) box.fail("a lower end and a higher one");
    result.lower = lower.approx();
    result.upper = upper.approx();
  }
  return result;
}

/// Charts of the atlas, where they are polygons in a plane of two parameters; others are passed over.
void read_illustration(const JsonCursor& illustration, CertificateView& view) {
  if (!illustration.value().is_object()) return;
  if (illustration.contains("stats") && illustration.at("stats").value().is_object()) {
    for (const auto& [key, value] : illustration.value()["stats"].items()) {
      view.stats[key] = value.is_string() ? value.get<std::string>() : value.dump();
    }
  }
  if (illustration.contains("tolerance_limits")) {
    for (const JsonCursor& limit : illustration.at("tolerance_limits").elements()) {
      view.tolerance_limits.push_back(
          {limit.at("tolerance").text(), decimal(limit.at("proved")), limit.at("unit").text()});
    }
  }
  if (!illustration.contains("charts") || view.problem.space.parameters.size() != 2) return;
  for (const JsonCursor& entry : illustration.at("charts").elements()) {
    if (!entry.contains("c") || entry.at("c").size() != 2) continue;
    ChartView chart;
    for (const JsonCursor& c : entry.at("c").elements()) chart.centre.push_back(approximation(c));
    if (entry.contains("p")) {
      for (const JsonCursor& corner : entry.at("p").elements()) {
        const std::vector<JsonCursor> at = corner.elements(2);
        chart.corners.push_back({approximation(at[0]), approximation(at[1])});
      }
    }
    view.charts.push_back(std::move(chart));
  }
}

}  // namespace

CertificateView read_certificate(const json& certificate) {
  const JsonCursor whole(certificate, "certificate");
  const auto member = [&](const char* key) -> JsonCursor { return {whole.at(key).value(), key}; };
  const auto text = [&](const char* key) { return member(key).text(); };
  CertificateView view;
  if (member("format").value() != "taut-certificate") member("format").fail("\"taut-certificate\"");
  if (const JsonCursor version = member("version"); version.value() != kCertificateVersion) {
    version.fail(
        fmt::format("{}: only the taut that made it can make its report, or one of that time", kCertificateVersion));
  }
  for (const char* key : {"name", "version"}) {
    const JsonCursor generator = member("generator");
    if (!generator.contains(key)) continue;
    view.generator += (view.generator.empty() ? "" : " ") + generator.at(key).text();
  }
  view.verdict = text("verdict");
  if (view.verdict != "proved" && view.verdict != "refuted" && view.verdict != "undecided") {
    member("verdict").fail("proved, refuted or undecided");
  }
  view.claim = text("claim");
  const JsonCursor problem = member("problem");
  try {
    view.problem = problem_from_json(problem.value());
  } catch (const FieldError& error) {
    const bool is_whole = error.field() == "problem";
    throw FieldError(is_whole ? error.field() : "problem." + error.field(), error.seen(), error.expected());
  }
  const JsonCursor path = member("path");
  view.interpolation = path.at("interpolation").text();
  view.path = read_path(path.value(), view.problem.space);
  view.problem_sha256 = text("problem_sha256");
  view.path_sha256 = text("path_sha256");
  view.footer_sha256 = member("footer").at("sha256").text();
  constexpr std::int64_t kMostIndex = std::numeric_limits<int>::max();
  for (const JsonCursor& segment : member("segments").elements()) {
    const JsonCursor boxes = segment.at("boxes");
    const JsonCursor margins = segment.at("margins");
    view.segments.push_back({static_cast<int>(segment.at("from").integer(0, kMostIndex)),
                             static_cast<int>(segment.at("to").integer(0, kMostIndex)), boxes.size(),
                             margins.is_null() ? MarginsView() : read_margins(margins)});
    view.boxes += view.segments.back().boxes;
    view.segment_boxes.push_back(read_boxes(boxes));
  }
  if (view.verdict == "proved" && view.path.segments() == 0) path.at("waypoints").fail("at least two of a proved path");
  if (view.verdict == "proved" && view.segments.empty()) member("segments").fail("some of a proved path");
  if (view.verdict == "proved") view.margins = read_margins(member("margins"));
  if (view.verdict == "refuted") view.witness = read_witness(member("witness"), view.path);
  if (view.verdict == "undecided") view.undecided = read_undecided(member("undecided"), view.path);
  if (const JsonCursor stretches = member("stretches"); !stretches.is_null()) {
    for (const JsonCursor& stretch : stretches.elements()) view.stretches.push_back(read_stretch(stretch, view.path));
  }
  if (whole.contains("illustration")) read_illustration(member("illustration"), view);
  return view;
}

}  // namespace taut
