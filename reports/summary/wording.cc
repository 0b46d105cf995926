// SPDX-License-Identifier: GPL-3.0-or-later
#include "reports/summary/wording.h"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <cmath>
#include <limits>

#include "certify/arithmetic/big_float.h"
#include "certify/arithmetic/mp_interval.h"
#include "problem/decimal.h"
#include "problem/expression.h"
#include "reports/summary/angles.h"
#include "reports/summary/numbers.h"
#include "reports/summary/time_statement.h"

namespace taut {

namespace {

std::string rounded(double x, int digits, mpfr_rnd_t direction) {
  if (x == 0) return "0";
  if (is_absurd(x)) return fmt::format("{:.{}g}", x, digits);
  const PrecisionScope precision(64);
  return plain(BigFloat(x).to_decimal(digits, direction));
}

bool is_number(std::string_view text) { return text.find_first_not_of("+-.0123456789eE") == std::string_view::npos; }

/// " (25.7143°)", or nothing.
std::string in_degrees(const ExpressionText& radians) {
  constexpr int kDigits = 6;
  constexpr mpfr_prec_t kMostBits = 4096;
  for (mpfr_prec_t bits = 64; bits <= kMostBits; bits *= 2) {
    const PrecisionScope precision(bits);
    Faults<MpInterval>::clear();
    const auto value = evaluate_constant<MpInterval>("(" + radians + ")*180/pi");
    if (Faults<MpInterval>::raised()) continue;  // with more bits it may be defined
    const auto text = [](const BigFloat& x) { return plain(x.to_decimal(kDigits, MPFR_RNDN)); };
    if (text(value.lower()) == text(value.upper())) return fmt::format(" ({}°)", text(value.lower()));
  }
  return "";
}

}  // namespace

std::string plain(const DecimalText& decimal) { return Decimal::parse(decimal).text(); }

std::string millimetres(const DecimalText& metres) { return (Decimal::parse(metres) * Decimal::parse("1000")).text(); }

std::string rounded_down(double x, int digits) { return rounded(x, digits, MPFR_RNDD); }
std::string rounded_up(double x, int digits) { return rounded(x, digits, MPFR_RNDU); }
std::string rounded_to_nearest(double x, int digits) { return rounded(x, digits, MPFR_RNDN); }

double number_in(const std::string& text) {
  double value = std::numeric_limits<double>::quiet_NaN();
  std::from_chars(text.data(), text.data() + text.size(), value);
  return value;
}

namespace {

/// @param text  of the value with so many digits, in the unit
template <class Text>
std::string told_apart(double value, double limit, const DisplayUnit& unit, const Text& text) {
  constexpr int kTyped = 15;  // decimals of so many digits are told from each other by binary64
  const double shown_limit = number_in(unit.nearest(limit, kTyped));
  std::string result;
  for (const int digits : {3, 4, 6, 9, 12, 15, 17}) {
    result = text(value, digits);
    const double shown = number_in(result);
    if ((shown < shown_limit) == (value < limit) && (shown > shown_limit) == (value > limit)) break;
  }
  return result;
}

}  // namespace

std::string up_text(double si, double limit_si, const DisplayUnit& unit) {
  return told_apart(si, limit_si, unit, [&](double x, int digits) { return unit.up(x, digits); });
}

std::string down_text(double si, double limit_si, const DisplayUnit& unit) {
  return told_apart(si, limit_si, unit, [&](double x, int digits) { return unit.down(x, digits); });
}

std::string sampled_text(double si, double limit_si, const DisplayUnit& unit) {
  std::string text = si > limit_si ? down_text(si, limit_si, unit) : up_text(si, limit_si, unit);
  return text.starts_with('-') ? text.replace(0, 1, "−") : text;
}

std::string with_minus_signs(std::string_view text) {
  const auto is_digit = [](char c) { return c >= '0' && c <= '9'; };
  std::string result;
  for (std::size_t k = 0; k < text.size(); ++k) {
    const bool begins = k == 0 || text[k - 1] == ' ' || text[k - 1] == '(' || text[k - 1] == '[';
    const bool is_sign = text[k] == '-' && begins && k + 1 < text.size() && is_digit(text[k + 1]);
    result += is_sign ? "−" : std::string(1, text[k]);
  }
  return result;
}

std::string truncated(const DecimalText& decimal, int digits) {
  const std::string text = plain(decimal);
  const std::size_t exponent = std::min(text.find('e'), text.size());
  std::string result;
  int seen = 0;
  bool is_fraction = false;
  for (std::size_t k = 0; k < exponent; ++k) {
    const char c = text[k];
    const bool is_digit = c >= '0' && c <= '9';
    if (is_digit && (seen > 0 || c != '0')) ++seen;
    is_fraction = is_fraction || c == '.';
    if (!is_digit || seen <= digits) {
      result += c;
    } else if (!is_fraction) {
      result += '0';
    }
  }
  if (result.ends_with('.')) result.pop_back();
  return result + text.substr(exponent);
}

std::string growth_text(const DecimalText& factor) {
  constexpr int kFewest = 3;
  const auto most = static_cast<int>(factor.size());
  int digits = kFewest;
  while (digits < most && Decimal::parse(truncated(factor, digits)) == Decimal::parse("1")) ++digits;
  return truncated(factor, digits);
}

std::string triple(const std::array<DecimalText, 3>& metres, const DisplayUnit& unit) {
  return fmt::format("({}, {}, {})", unit.exact(metres[0]), unit.exact(metres[1]), unit.exact(metres[2]));
}

std::string angle_text(const ExpressionText& radians) {
  constexpr std::string_view kOpen = "(";
  constexpr std::string_view kDegrees = ")*pi/180";  // as decimal_to_si() writes them
  if (radians.starts_with(kOpen) && radians.ends_with(kDegrees)) {
    const std::string inner = radians.substr(kOpen.size(), radians.size() - kOpen.size() - kDegrees.size());
    if (is_number(inner)) return plain(inner) + "°";
  }
  if (is_number(radians) && plain(radians) == "0") return "0°";
  return radians + " rad" + in_degrees(radians);
}

std::vector<std::string> coordinate_texts(const Waypoint& waypoint) {
  std::vector<std::string> texts;
  for (const double x : numbers(waypoint)) texts.push_back(fmt::format("{}", x));
  const std::vector<int> turns = half_turns(waypoint);
  for (std::size_t j = 0; j < turns.size(); ++j) {
    if (turns[j] == 0) continue;
    const int count = std::abs(turns[j]);
    texts[j] += fmt::format(" {} {}π", turns[j] > 0 ? "+" : "−", count == 1 ? "" : std::to_string(count));
  }
  return texts;
}

std::vector<std::pair<std::string, std::string>> coordinates(const Certificate& certificate) {
  std::vector<std::pair<std::string, std::string>> result;
  if (!has_poses(certificate.path.interpolation)) {
    const SpaceText& space = certificate.problem.space;
    for (std::size_t j = 0; j < space.parameters.size(); ++j)
      result.emplace_back(space.parameters[j].name, unit(space, j));
    return result;
  }
  for (const char* name : {"px", "py", "pz"}) result.emplace_back(name, "m");
  for (const char* name : {"qx", "qy", "qz", "qw"}) result.emplace_back(name, "");
  if (certificate.path.interpolation == Interpolation::kCableLengths) {
    for (const char* name : {"L1", "L2", "L3", "L4", "L5", "L6"}) result.emplace_back(name, "m");
  }
  return result;
}

std::string waypoint_text(const Certificate& certificate, const Waypoint& waypoint) {
  std::string names;
  std::string values;
  const auto named = coordinates(certificate);
  const std::vector<std::string> texts = coordinate_texts(waypoint);
  for (std::size_t j = 0; j < texts.size(); ++j) {
    const char* comma = j == 0 ? "" : ", ";
    names += comma + named[j].first;
    values += comma + texts[j];
  }
  return fmt::format("({}) = ({})", names, values);
}

std::string segment_text(const Certificate& certificate, int k) {
  if (certificate.path.interpolation == Interpolation::kCubicBSpline) return fmt::format("segment {}", k);
  return fmt::format("segment {}, between waypoints {} and {}", k, k, k + 1);
}

std::string point_text(const Certificate& certificate, const PathPoint& point) {
  if (point.on_segment) return fmt::format("s = {} of {}", point.s.text(), segment_text(certificate, point.index));
  const Waypoint& waypoint = certificate.path.waypoints[static_cast<std::size_t>(point.index)];
  return fmt::format("waypoint {}, {}", point.index, waypoint_text(certificate, waypoint));
}

std::vector<std::string> angle_symbols(AngleKind kind) {
  switch (kind) {
    case AngleKind::kTiltAndTorsion: return {"φ", "θ", "σ"};
    case AngleKind::kRollPitchYaw: return {"roll", "pitch", "yaw"};
    case AngleKind::kZyz: return {"α", "β", "γ"};
    case AngleKind::kAxis: break;
  }
  return {"turn"};
}

std::string rotation_formula(const AnglesText& angles) {
  switch (angles.kind) {
    case AngleKind::kTiltAndTorsion: return "tilt φ, θ and torsion σ, with R = Rz(φ) Ry(θ) Rz(σ − φ)";
    case AngleKind::kRollPitchYaw: return "roll, pitch and yaw, with R = Rz(yaw) Ry(pitch) Rx(roll)";
    case AngleKind::kZyz: return "Euler’s angles α, β, γ, with R = Rz(α) Ry(β) Rz(γ)";
    case AngleKind::kAxis: break;
  }
  return fmt::format("a turn about the fixed axis ({})", fmt::join(angles.axis, ", "));
}

std::string pose_text(const ReportContext& scene, const Pose<double>& pose) {
  const DisplayUnit& length = scene.illustration.units.length;
  const auto text = [](double x, double to) {
    constexpr double kLargest = 1e9;
    if (!(std::abs(x) < kLargest)) return fmt::format("{:.4g}", x);
    return fmt::format("{:.12g}", std::round(x / to) * to + 0.0);
  };
  const auto position = [&](int c) { return text(length.approx(pose.p_WP(c)), length.approx(1e-6)); };  // micrometres
  std::string result = fmt::format("p = ({}, {}, {}) {}", position(0), position(1), position(2), length.name());
  const AngleKind kind = shown_angles(scene.certificate).kind;
  const std::vector<std::string> symbols = angle_symbols(kind);
  const auto angles = angles_of(kind, scene.sampler.model().angles, pose.angles);
  for (std::size_t c = 0; c < symbols.size(); ++c) {
    result += fmt::format(", {} = {}°", symbols[c], text(degrees(angles[c]), 1e-3));
  }
  return result;
}

std::string distance_text(double metres) {
  constexpr double kShort = 0.1;
  return metres < kShort ? fmt::format("{:.3g} mm", std::round(metres * 1e6) / 1000) : fmt::format("{:.4g} m", metres);
}

namespace {

constexpr const char* kOnlyPose = "at the only pose of the path";

/// "4.2 m into the move", "after 41° of turning"; empty of a platform that stays where it is.
std::string travel_text(const ReportContext& scene, double position) {
  constexpr double kStill = 1e-9;  // [m], [rad]: less is rounding
  const auto segments = static_cast<double>(scene.certificate.path.segments());
  if (position <= 0) return "at the start of the move";
  if (position >= segments) return "at the end of the move";
  if (scene.travel.distance_m(segments) > kStill) {
    return fmt::format("{} into the move", distance_text(scene.travel.distance_m(position)));
  }
  if (!(scene.travel.turned_rad(segments) > kStill)) return "";
  return fmt::format("after {:.3g}° of turning", degrees(scene.travel.turned_rad(position)));
}

/// ", t = 3 s", if the path has times.
std::string time_text(const ReportContext& scene, double position) {
  const auto time = scene.travel.time_s(position);
  return time ? fmt::format(", t = {:.6g} s", *time) : "";
}

/// The segment that a position is on, the one before it at the end of the path.
double segment_of(const ReportContext& scene, double position) {
  const auto segments = static_cast<double>(scene.certificate.path.segments());
  return std::floor(std::clamp(position, 0.0, segments - 1));
}

/// "4.2 s after the start (segment 3, s = 0.2)"
std::string place_in_time(const ReportContext& scene, double position) {
  const double segment = segment_of(scene, position);
  const std::string in = fmt::format("(segment {}, s = {:.4g})", segment, position - segment);
  if (position <= 0) return "at the start of the move " + in;
  if (position >= static_cast<double>(scene.certificate.path.segments())) return "at the end of the move " + in;
  return fmt::format("{} after the start {}", seconds_text(scene.travel.time_s(position).value_or(0)), in);
}

}  // namespace

std::string place_text(const ReportContext& scene, double position) {
  if (scene.certificate.path.segments() == 0) return kOnlyPose;
  if (is_move(scene.certificate)) return place_in_time(scene, position);
  const std::string in = fmt::format("segment {}{}", segment_of(scene, position), time_text(scene, position));
  const std::string travel = travel_text(scene, position);
  return travel.empty() ? "in " + in : fmt::format("{} ({})", travel, in);
}

std::string place_in_full(const ReportContext& scene, double from, double to) {
  if (scene.certificate.path.segments() == 0) return kOnlyPose;
  const auto point = [&](double position) {
    const double segment = segment_of(scene, position);
    return fmt::format("segment {} at s = {:.6g}", segment, position - segment);
  };
  std::string text = point(from);
  if (point(to) != text) text = fmt::format("between {} and {}", text, point(to));
  const std::string travel = travel_text(scene, from);
  return fmt::format("{}{}{}{}", text, travel.empty() ? "" : ", ", travel, time_text(scene, from));
}

}  // namespace taut
