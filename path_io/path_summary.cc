// SPDX-License-Identifier: GPL-3.0-or-later
#include "path_io/path_summary.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <utility>

namespace taut {
namespace {

constexpr double kPi = 3.14159265358979323846;

std::string meaning(PathForm form, AngleKind angles) {
  switch (form) {
    case PathForm::kParameters: return "the case's parameters";
    case PathForm::kAngles: return fmt::format("positions and {}", angles_text(angles));
    case PathForm::kQuaternion: return "positions and quaternions";
    case PathForm::kCableLengths: break;
  }
  return "cable lengths";
}

const char* meaning(PathFormat format) {
  switch (format) {
    case PathFormat::kTable: return "a table of";
    case PathFormat::kTum: return "TUM:";
    case PathFormat::kTautWaypoints: return "waypoints of taut:";
    case PathFormat::kTautControlPoints: break;
  }
  return "a spline's control points, of taut:";
}

}  // namespace

PathSummary::PathSummary(const Problem& problem, PathHeader header)
    : header_(std::move(header)),
      angles_(problem.space.angles.kind),
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
  for (std::size_t j = 0; j < result.size(); ++j) result[j] += kPi * row.half_turns[j];
  return result;
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
    origin_length_m_ += (origin - origin_).stableNorm();
    bool jumps = false;
    for (std::size_t j = 0; j < x.size(); ++j) {
      lower_[j] = std::min(lower_[j], x[j]);
      upper_[j] = std::max(upper_[j], x[j]);
      jumps |= is_angle_[j] && std::abs(x[j] - previous_[j]) > kPi;
    }
    if (jumps && jumps_++ == 0) first_jump_line_ = row.line;
  }
  origin_ = origin;
  previous_ = x;
  last_ = row;
}

std::optional<double> PathSummary::seconds() const {
  if (!header_.time) return std::nullopt;
  const auto s = [](const PathRow& row) { return ScalarTraits<double>::from_decimal(row.time_s->text()); };
  return s(last_) - s(first_);
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
  if (jumps_ > 0) {
    text += fmt::format(
        "  in {} row{}, first in line {}, an angle is more than a half turn from the row before: the path takes the "
        "long way round, as the numbers say\n",
        jumps_, jumps_ == 1 ? "" : "s", first_jump_line_);
  }
  return text;
}

}  // namespace taut
