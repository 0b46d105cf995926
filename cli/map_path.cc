// SPDX-License-Identifier: GPL-3.0-or-later
#include "cli/map_path.h"

#include <fmt/format.h>

#include <cmath>

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

std::vector<std::vector<std::array<double, 2>>> path_on_map(const std::string& file, const Problem& problem,
                                                            const MapSpace& space) {
  constexpr int kSteps = 64;  // a segment
  const Path path = read_path(file, problem);
  const PoseSampler sampler(problem);
  std::vector<std::vector<std::array<double, 2>>> lines;
  for (std::size_t k = 0; k < std::max<std::size_t>(path.segments(), 1); ++k) {
    const Segment segment = path.segment(k);
    for (int n = 0; n <= kSteps; ++n) {
      const auto here = place(sampler.parameters(segment, static_cast<double>(n) / kSteps), space);
      const auto is_near = [&](const std::array<double, 2>& last) {
        return std::abs(here[0] - last[0]) < 0.25 && std::abs(here[1] - last[1]) < 0.25;
      };
      if (lines.empty() || !is_near(lines.back().back())) lines.emplace_back();
      lines.back().push_back(here);
    }
  }
  return lines;
}

}  // namespace taut
