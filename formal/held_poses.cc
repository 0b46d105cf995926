// SPDX-License-Identifier: GPL-3.0-or-later
#include "formal/held_poses.h"

#include <algorithm>

namespace taut::formal {
namespace {

/// The lengths at s, between two waypoints.
std::array<Rational, 6> lengths_at(const Waypoint& begin, const Waypoint& end, double s) {
  std::array<Rational, 6> lengths;
  for (std::size_t i = 0; i < lengths.size(); ++i) {
    const Rational first(begin.lengths_m()[i]);
    lengths[i] = first + Rational(s) * (Rational(end.lengths_m()[i]) - first);
  }
  return lengths;
}

}  // namespace

std::vector<HeldPose> held_poses(const Path& path) {
  std::vector<HeldPose> poses;
  for (std::size_t k = 0; k < path.segments(); ++k) {
    const Waypoint& begin = path.waypoints[k];
    const Waypoint& end = path.waypoints[k + 1];
    poses.push_back({begin.pose(), lengths_at(begin, end, 0), path.pose_tubes[k], k, 0});
    for (const InnerPose& inner : path.inner_poses[k]) {
      poses.push_back({inner.x, lengths_at(begin, end, inner.s), inner.tube, k, inner.s});
    }
    if (k + 1 == path.segments()) poses.push_back({end.pose(), lengths_at(begin, end, 1), {}, k, 1});
  }
  return poses;
}

}  // namespace taut::formal
