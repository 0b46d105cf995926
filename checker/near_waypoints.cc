// SPDX-License-Identifier: GPL-3.0-or-later
#include "checker/near_waypoints.h"

#include <algorithm>

namespace taut::checker {
namespace {

/// The mean of |b_i| [m].
Ball platform_size(const Machine& machine) {
  Ball sum;
  for (const Vector3<Ball>& b : machine.platform) sum += sqrt(squared_norm(b));
  return sum / Ball(6);
}

/// At the end of the box where u = `end`.
void require_near(const Machine& machine, const Problem& problem, const Path& path, std::size_t k, const Box& box,
                  int end) {
  const std::span<const Waypoint> controls = path.controls(k);
  // At either end of a straight segment one matters, of a spline's three; the one of a path that stays matters itself.
  const std::size_t others = controls.size() == 1 ? 0 : 1;
  const auto stated = controls.subspan(end < 0 ? 0 : others, controls.size() - others);
  const auto near = path.law == Law::kCubicBSpline ? stated : end < 0 ? stated.first(1) : stated.last(1);
  std::vector<MeanValueForm> there = parameters(problem, path, k, box);
  for (MeanValueForm& x : there) x = MeanValueForm(x.at + Ball(end) * x.slope);
  const Vector6<MeanValueForm> reached = coordinates(problem, there);
  std::vector<Vector6<MeanValueForm>> asked;
  for (const Waypoint& waypoint : near) asked.push_back(coordinates(problem, stated_parameters(waypoint)));
  for (std::size_t i = 0; i < 6; ++i) {
    const Ball slack = Ball(mpq_class(1, 50)) * (i < 3 ? platform_size(machine) : Ball(1));
    for (const int side : {-1, 1}) {
      const auto is_as_far = [&](const Vector6<MeanValueForm>& other) {  // on that side
        return certainly_nonnegative(slack + Ball(side) * (other[i].range() - reached[i].range()));
      };
      if (std::ranges::none_of(asked, is_as_far)) {
        throw Undefined("the pose on the constraints may not be next to what the path states at a waypoint");
      }
    }
  }
}

}  // namespace

std::vector<MeanValueForm> stated_parameters(const Waypoint& waypoint) {
  std::vector<MeanValueForm> result;
  for (std::size_t j = 0; j < waypoint.x.size(); ++j) {
    result.emplace_back(Ball(waypoint.x[j]) + Ball(waypoint.half_turns[j]) * Ball::pi());
  }
  return result;
}

void require_near_waypoints(const Machine& machine, const Problem& problem, const Path& path, std::size_t k,
                            const Box& box) {
  if (problem.constraints.empty() || has_poses(path.law)) return;
  if (box.begin == 0) require_near(machine, problem, path, k, box, -1);
  if (box.end == 1) require_near(machine, problem, path, k, box, 1);
}

}  // namespace taut::checker
