#include "reports/certificate_view.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>

#include "certify/certificate.h"
#include "kinematics/input_error.h"

namespace taut {

using nlohmann::json;

namespace {

/// Nearest double of a decimal or a C99 hexadecimal literal.
double approximation(const std::string& text) {
  std::size_t used = 0;
  double value = 0;
  try {
    value = std::stod(text, &used);
  } catch (const std::logic_error&) {
    used = 0;
  }
  if (used == 0 || used != text.size() || !std::isfinite(value)) {
    throw InputError(fmt::format("certificate: got '{}', expected a number", text));
  }
  return value;
}

/// Nearest double of "k/m" or "k".
double dyadic_approximation(const std::string& text) {
  const std::size_t slash = text.find('/');
  const double numerator = approximation(text.substr(0, slash));
  const double value = slash == std::string::npos ? numerator : numerator / approximation(text.substr(slash + 1));
  if (!(value >= 0 && value <= 1)) {
    throw InputError(fmt::format("certificate: got '{}', expected a dyadic from 0 to 1", text));
  }
  return value;
}

/// "k/m", "0" or "1".
Dyadic read_dyadic(const std::string& text) {
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
  throw InputError(fmt::format("certificate: got '{}', expected a dyadic from 0 to 1", text));
}

std::vector<DyadicBox> read_boxes(const json& boxes) {
  std::vector<DyadicBox> result;
  for (const json& ends : boxes) {
    const Dyadic lower = read_dyadic(ends.at(0).get<std::string>());
    const Dyadic upper = read_dyadic(ends.at(1).get<std::string>());
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
      throw InputError(
          fmt::format("certificate: path.waypoints[{}]: expected {} values of x and of half_turns, and {} of normals",
                      k, parameters, normals));
    }
  }
  return result;
}

MarginsView read_margins(const json& margins) {
  return {margins.at("tension_N").get<std::string>(), margins.at("length_m").get<std::string>(),
          margins.at("wrench_scale").get<std::string>()};
}

int read_index(const json& index, std::size_t count, const char* what) {
  const int value = index.get<int>();
  if (value < 0 || static_cast<std::size_t>(value) >= count) {
    throw InputError(fmt::format("certificate: got {} {}, expected 0 to {}", what, value, count - 1));
  }
  return value;
}

PathPointView read_point(const json& point, const Path& path) {
  PathPointView result;
  if (point.contains("waypoint")) {
    result.index = read_index(point.at("waypoint"), path.waypoints.size(), "waypoint");
    result.position = result.index;
  } else {
    result.index = read_index(point.at("segment"), path.segments(), "segment");
    result.s = point.at("s").get<std::string>();
    result.position = result.index + dyadic_approximation(*result.s);
  }
  return result;
}

WitnessView read_witness(const json& witness, const Path& path) {
  WitnessView result;
  result.kind = witness.at("kind").get<std::string>();
  result.at = read_point(witness.at("at"), path);
  if (result.kind == "singular") {
    result.to = read_point(witness.at("to"), path);
    return result;
  }
  result.cable = 1 + read_index(witness.at("cable").get<int>() - 1, kCables, "cable minus one");
  result.value_lower = witness.at("value").at(0).get<std::string>();
  result.value_upper = witness.at("value").at(1).get<std::string>();
  result.limit = witness.at("limit").get<std::string>();
  result.deviates = witness.contains("deviation");
  result.is_led = result.deviates && witness["deviation"].contains("cable_lengths_m");
  return result;
}

StretchView read_stretch(const json& stretch, const Path& path) {
  StretchView result;
  result.begin = read_point(stretch.at("outer").at(0), path);
  result.end = read_point(stretch.at("outer").at(1), path);
  if (const json& inner = stretch.at("inner"); !inner.is_null()) {
    result.first = read_witness(inner.at(0), path);
    result.last = read_witness(inner.at(1), path);
  } else {
    result.reason = stretch.at("reason").get<std::string>();
  }
  return result;
}

UndecidedView read_undecided(const json& undecided, const Path& path) {
  UndecidedView result;
  result.reason = undecided.at("reason").get<std::string>();
  if (const json& segment = undecided.at("segment"); !segment.is_null()) {
    result.segment = read_index(segment, path.segments(), "segment");
  }
  if (const json& box = undecided.at("box"); !box.is_null()) {
    result.box_lower = box.at(0).get<std::string>();
    result.box_upper = box.at(1).get<std::string>();
    result.lower = dyadic_approximation(result.box_lower);
    result.upper = dyadic_approximation(result.box_upper);
  }
  return result;
}

/// Charts of the atlas, where they are polygons in a plane of two parameters; others are passed over.
void read_illustration(const json& illustration, CertificateView& view) {
  if (!illustration.is_object()) return;
  if (const auto stats = illustration.find("stats"); stats != illustration.end() && stats->is_object()) {
    for (const auto& [key, value] : stats->items()) {
      view.stats[key] = value.is_string() ? value.get<std::string>() : value.dump();
    }
  }
  if (const auto limits = illustration.find("tolerance_limits"); limits != illustration.end()) {
    for (const json& limit : *limits) {
      view.tolerance_limits.push_back({limit.at("tolerance").get<std::string>(), limit.at("proved").get<std::string>(),
                                       limit.at("unit").get<std::string>()});
    }
  }
  const auto charts = illustration.find("charts");
  if (charts == illustration.end() || view.problem.space.parameters.size() != 2) return;
  for (const json& entry : *charts) {
    ChartView chart;
    for (const json& c : entry.value("c", json::array())) chart.centre.push_back(approximation(c.get<std::string>()));
    for (const json& corner : entry.value("p", json::array())) {
      chart.corners.push_back(
          {approximation(corner.at(0).get<std::string>()), approximation(corner.at(1).get<std::string>())});
    }
    if (chart.centre.size() == 2) view.charts.push_back(std::move(chart));
  }
}

CertificateView read(const json& certificate) {
  CertificateView view;
  if (certificate.at("format") != "taut-certificate") {
    throw InputError("certificate: format: expected \"taut-certificate\"");
  }
  if (certificate.at("version") != kCertificateVersion) {
    throw InputError(
        fmt::format("certificate: version: got {}, expected {}: only the taut that made it can make its report, or one "
                    "of that time",
                    certificate.at("version").dump(), kCertificateVersion));
  }
  const json& generator = certificate.at("generator");
  view.generator = generator.value("name", "") + " " + generator.value("version", "");
  view.verdict = certificate.at("verdict").get<std::string>();
  if (view.verdict != "proved" && view.verdict != "refuted" && view.verdict != "undecided") {
    throw InputError(fmt::format("certificate: got verdict '{}', expected proved, refuted or undecided", view.verdict));
  }
  view.claim = certificate.at("claim").get<std::string>();
  view.problem = problem_from_json(certificate.at("problem"));
  const json& path = certificate.at("path");
  view.interpolation = path.at("interpolation").get<std::string>();
  view.path = read_path(path, view.problem.space);
  view.problem_sha256 = certificate.at("problem_sha256").get<std::string>();
  view.path_sha256 = certificate.at("path_sha256").get<std::string>();
  view.footer_sha256 = certificate.at("footer").at("sha256").get<std::string>();
  for (const json& segment : certificate.at("segments")) {
    view.segments.push_back({segment.at("from").get<int>(), segment.at("to").get<int>(), segment.at("boxes").size(),
                             segment.at("margins").is_null() ? MarginsView() : read_margins(segment.at("margins"))});
    view.boxes += view.segments.back().boxes;
    view.segment_boxes.push_back(read_boxes(segment.at("boxes")));
  }
  if (view.verdict == "proved") view.margins = read_margins(certificate.at("margins"));
  if (view.verdict == "refuted") view.witness = read_witness(certificate.at("witness"), view.path);
  if (view.verdict == "undecided") view.undecided = read_undecided(certificate.at("undecided"), view.path);
  if (const json& stretches = certificate.at("stretches"); !stretches.is_null()) {
    for (const json& stretch : stretches) view.stretches.push_back(read_stretch(stretch, view.path));
  }
  if (const auto illustration = certificate.find("illustration"); illustration != certificate.end()) {
    read_illustration(*illustration, view);
  }
  return view;
}

}  // namespace

CertificateView read_certificate(const json& certificate) {
  try {
    return read(certificate);
  } catch (const json::exception& error) {
    throw InputError(std::string("certificate: ") + error.what());
  }
}

}  // namespace taut
