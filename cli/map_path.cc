// SPDX-License-Identifier: GPL-3.0-or-later
#include "cli/map_path.h"

#include <fmt/format.h>

#include <cmath>

#include "app/chart_outlines.h"
#include "base/input_error.h"
#include "kinematics/pose_sampler.h"
#include "path_io/waypoint_maker.h"

namespace taut {
namespace {

/// The place of parameters in the space.
std::array<double, 2> place(const std::vector<double>& parameters, const MapSpace& space) {
  std::array<double, 2> t{};
  for (std::size_t k = 0; k < 2; ++k) {
    const auto lower = evaluate_constant<double>(space.axes[k].lower);
    t.at(k) = (parameters[k] - lower) / (evaluate_constant<double>(space.axes[k].upper) - lower);
  }
  if (space.flip) {
    double& theta = t.at(space.flip->theta);
    theta -= 2 * std::floor((theta + 1) / 2);  // in [−1, 1)
    if (theta < 0) {
      theta = -theta;
      t.at(space.flip->phi) += 0.5;
    }
  }
  for (std::size_t k = 0; k < 2; ++k) {
    if (space.axes[k].kind == MapAxis::Kind::kTurn) t.at(k) -= std::floor(t.at(k));
  }
  return t;
}

/// Adds a place to the last line, or begins a new one where it is not beside that line's end.
void extend(std::vector<MapLine>& lines, const std::array<double, 2>& here) {
  const auto is_beside = [&](const std::array<double, 2>& last) {
    return std::abs(here[0] - last[0]) < 0.25 && std::abs(here[1] - last[1]) < 0.25;
  };
  if (lines.empty() || (!lines.back().empty() && !is_beside(lines.back().back()))) lines.emplace_back();
  lines.back().push_back(here);
}

/// The parameters that are so far from others. φ and θ are a direction, which moves along a great circle: near θ = 0 a
/// small step changes φ by much.
std::vector<double> moved(const std::array<double, 2>& from, const std::array<double, 2>& step, const MapSpace& space) {
  if (!space.flip) return {from[0] + step[0], from[1] + step[1]};
  const std::size_t phi = space.flip->phi, theta = space.flip->theta;
  const double sin_phi = std::sin(from.at(phi)), cos_phi = std::cos(from.at(phi));
  const double sin_theta = std::sin(from.at(theta)), cos_theta = std::cos(from.at(theta));
  const double along = step.at(theta), across = sin_theta * step.at(phi);
  const double length = std::hypot(along, across);
  const double share = length > 0 ? std::sin(length) / length : 1;
  const double outward = sin_theta * std::cos(length) + cos_theta * share * along;
  const double z = cos_theta * std::cos(length) - sin_theta * share * along;
  const double x = cos_phi * outward - sin_phi * share * across;
  const double y = sin_phi * outward + cos_phi * share * across;
  std::vector<double> result(2);
  result.at(phi) = std::atan2(y, x);
  result.at(theta) = std::atan2(std::hypot(x, y), z);
  return result;
}

Path read_path(const std::string& name, const Problem& problem) {
  PathFile file(name, problem.space);
  if (file.header().form != PathForm::kParameters) {
    throw InputError(ErrorCode::kUse,
                     fmt::format("--path: got {}, whose rows are poses or cable lengths, expected a file of the case's "
                                 "own parameters, such as path.csv",
                                 name));
  }
  Path path;
  path.interpolation = usual_law(file.header());
  for (PathRow row; file.next(row);) path.waypoints.push_back({row.x, row.half_turns});
  return path;
}

}  // namespace

std::vector<MapLine> path_on_map(const std::string& file, const Problem& problem, const MapSpace& space) {
  constexpr int kSteps = 64;  // a segment
  const Path path = read_path(file, problem);
  const PoseSampler sampler(problem);
  std::vector<MapLine> lines;
  for (std::size_t k = 0; k < std::max<std::size_t>(path.segments(), 1); ++k) {
    const Segment segment = path.segment(k);
    for (int n = 0; n <= kSteps; ++n) {
      extend(lines, place(sampler.parameters(segment, static_cast<double>(n) / kSteps), space));
    }
  }
  return lines;
}

std::vector<MapLine> charts_on_map(const std::string& file, const Case& the_case, const MapSpace& space) {
  constexpr int kSteps = 6;  // an edge
  std::vector<MapLine> lines;
  for (const ChartOutline& chart : chart_outlines(the_case, file)) {
    lines.emplace_back();
    const std::size_t corners = chart.corners.size();
    for (std::size_t edge = 0; edge < corners; ++edge) {
      const auto& from = chart.corners[edge];
      const auto& to = chart.corners[(edge + 1) % corners];
      for (int n = edge == 0 ? 0 : 1; n <= kSteps; ++n) {
        const double s = static_cast<double>(n) / kSteps;
        const std::array<double, 2> step = {from[0] + s * (to[0] - from[0]), from[1] + s * (to[1] - from[1])};
        extend(lines, place(moved(chart.centre, step, space), space));
      }
    }
  }
  return lines;
}

}  // namespace taut
