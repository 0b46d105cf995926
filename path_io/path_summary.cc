// SPDX-License-Identifier: GPL-3.0-or-later
#include "path_io/path_summary.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <utility>

namespace taut {
namespace {

std::string meaning(PathForm form, AngleKind angles) {
  switch (form) {
    case PathForm::kParameters: return "the case's parameters";
    case PathForm::kAngles: return fmt::format("positions and {}", angles_text(angles));
    case PathForm::kQuaternion: return "positions and quaternions";
    case PathForm::kCableLengths: break;
  }
  return "cable lengths";
}

double number(const Decimal& x) { return ScalarTraits<double>::from_decimal(x.text()); }

const char* meaning(PathFormat format) {
  switch (format) {
    case PathFormat::kTable: return "a table of";
    case PathFormat::kTum: return "TUM:";
    case PathFormat::kTautWaypoints: return "waypoints of taut:";
    case PathFormat::kTautControlPoints: break;
  }
  return "a spline's control points, of taut:";
}

std::string names(const Problem& problem) {
  std::vector<std::string> list;
  for (const Parameter& parameter : problem.space.parameters) list.push_back(parameter.name);
  return fmt::format("{}", fmt::join(list, ", "));
}

}  // namespace

std::string law_sentence(Interpolation law, const Problem& problem) {
  const char* const onto = problem.space.constraints.empty() ? "" : ", and from there onto the constraints";
  switch (law) {
    case Interpolation::kStraight:
      return fmt::format(
          "straight: between two waypoints {} each go from value to value at a constant rate, all at once{}",
          names(problem), onto);
    case Interpolation::kCubicBSpline:
      return fmt::format("spline: {} follow a cubic B-spline of which these are the control points{}", names(problem),
                         onto);
    case Interpolation::kGeodesic:
      return "geodesic: between two waypoints the platform's origin moves straight, and the platform turns about one "
             "axis, the shorter way, both at constant rates";
    case Interpolation::kCableLengths: break;
  }
  return "cable-lengths: between two waypoints the length of each cable changes at a constant rate, all at once; the "
         "pose is the one that the lengths imply";
}

PathSummary::PathSummary(const Problem& problem, PathHeader header)
    : header_(std::move(header)),
      angles_(header_.angles.kind),
      sampler_(problem),
      is_angle_(header_.coordinates.size()) {
  for (std::size_t j = 0; j < is_angle_.size(); ++j) {
    const bool is_parameter = header_.form == PathForm::kParameters;
    is_angle_[j] = is_parameter ? problem.space.parameters[j].kind == ParameterKind::kPeriodic
                                : header_.form == PathForm::kAngles && is_turn(angles_, j);
  }
}

std::vector<double> PathSummary::values(const PathRow& row) const {
  std::vector<double> result = row.x;
  for (std::size_t j = 0; j < result.size(); ++j) result[j] += std::numbers::pi * row.half_turns[j];
  return result;
}

void PathSummary::add_rest(const PathRow& row) {
  if (row.x != last_.x || row.half_turns != last_.half_turns) {
    rest_ = {};
    return;
  }
  ++repeats_;
  if (rest_.repeats++ == 0) {
    rest_.first_line = last_.line;
    rest_.begin_s = last_.time_s;
  }
  rest_.last_line = row.line;
  rest_.end_s = row.time_s;
  if (rest_.repeats > longest_rest_.repeats) longest_rest_ = rest_;
}

void PathSummary::add(const PathRow& row) {
  const std::vector<double> x = values(row);
  Vector3<double> origin;
  if (header_.form == PathForm::kParameters) {
    origin = sampler_.pose(x).p_WP;
  } else {
    for (int axis = 0; axis < 3; ++axis) origin(axis) = x[static_cast<std::size_t>(axis)];
  }
  if (rows_++ == 0) {
    first_ = row;
    lower_ = upper_ = x;
  } else {
    add_rest(row);
    origin_length_m_ += (origin - origin_).stableNorm();
    bool jumps = false;
    for (std::size_t j = 0; j < x.size(); ++j) {
      lower_[j] = std::min(lower_[j], x[j]);
      upper_[j] = std::max(upper_[j], x[j]);
      jumps |= is_angle_[j] && std::abs(x[j] - previous_[j]) > std::numbers::pi;
    }
    if (jumps && jumps_++ == 0) first_jump_line_ = row.line;
  }
  origin_ = origin;
  previous_ = x;
  last_ = row;
}

std::optional<double> PathSummary::seconds() const {
  if (!header_.time) return std::nullopt;
  return number(*last_.time_s) - number(*first_.time_s);
}

std::string PathSummary::rest_text() const {
  if (repeats_ == 0) return "";
  std::string text = fmt::format("  {} row{} the row before: the platform rests there", repeats_,
                                 repeats_ == 1 ? " repeats" : "s repeat");
  if (repeats_ > 1) {
    text += fmt::format(", longest in lines {} to {}", longest_rest_.first_line, longest_rest_.last_line);
  }
  if (longest_rest_.begin_s) {
    text += fmt::format("{} {:.7g} s", repeats_ > 1 ? ", which take" : " for",
                        number(*longest_rest_.end_s) - number(*longest_rest_.begin_s));
  }
  return text + "\n";
}

std::optional<double> PathSummary::origin_length_m() const {
  if (header_.form == PathForm::kCableLengths) return std::nullopt;
  return origin_length_m_;
}

std::string PathSummary::text() const {
  std::string text = fmt::format("{} {}, {} row{}, lines {} to {}\n", meaning(header_.format),
                                 meaning(header_.form, angles_), rows_, rows_ == 1 ? "" : "s", first_.line, last_.line);
  const std::vector<double> first = values(first_), last = values(last_);
  for (std::size_t j = 0; j < header_.coordinates.size(); ++j) {
    const PathColumn& column = header_.coordinates[j];
    const double unit = column.per_unit;
    text +=
        fmt::format("  {:<10} from {:.7g} to {:.7g}, within {:.7g} … {:.7g}{}{}", column.name, first[j] / unit,
                    last[j] / unit, lower_[j] / unit, upper_[j] / unit, column.unit.empty() ? "" : " ", column.unit);
    if (unit != 1)
      text += fmt::format(" ({:.7g} … {:.7g} {})", lower_[j], upper_[j], column.unit == "deg" ? "rad" : "m");
    text += "\n";
  }
  if (const auto length = origin_length_m()) text += fmt::format("  the origin's way is {:.7g} m long\n", *length);
  if (const auto time = seconds()) text += fmt::format("  the motion takes {:.7g} s\n", *time);
  text += rest_text();
  if (jumps_ > 0) {
    text += fmt::format(
        "  in {} row{}, first in line {}, an angle is more than a half turn from the row before: the path takes the "
        "long way round, as the numbers say\n",
        jumps_, jumps_ == 1 ? "" : "s", first_jump_line_);
  }
  if (header_.form != PathForm::kParameters && sampler_.constraints()) {
    text += "  the case's constraints are NOT asked of these poses: nothing is said of how far off them they are\n";
  }
  return text;
}

}  // namespace taut
