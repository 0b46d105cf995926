// SPDX-License-Identifier: GPL-3.0-or-later
#include "kinematics/pose_sampler.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "kinematics/motion_length.h"
#include "kinematics/pose_conversion.h"

namespace taut {

PoseSampler::PoseSampler(const Problem& problem)
    : model_(make_model<double>(problem)), tape_(pose_tape(problem)), pose_(tape_) {
  if (!problem.space.constraints.empty()) constraints_.emplace(problem);
}

std::vector<double> PoseSampler::parameters(const Segment& segment, double s) const {
  if (has_poses(segment.law)) {
    if (model_.angles.kind != AngleKind::kTiltAndTorsion) throw std::logic_error("a law of poses in other angles");
    const RigidPose at = rigid_pose(segment, s);
    const TiltAndTorsion angles = tilt_and_torsion(at.q, std::nullopt);
    return {at.p(0), at.p(1), at.p(2), angles.x[0], angles.x[1], angles.x[2]};
  }
  if (constraints_) return constraints_->parameters(segment, s);
  return curve_parameters(segment, s);
}

RigidPose PoseSampler::rigid_pose(const Segment& segment, double s) const {
  if (!has_poses(segment.law)) {
    return rigid_pose(pose(parameters(segment, s)));
  }
  const RigidPose reference = pose_between(segment, s);
  if (segment.law != Interpolation::kCableLengths) return reference;
  return pose_of_lengths(model_, lengths_at(segment, s), reference).value_or(reference);
}

double PoseSampler::distance_to_constraints(const Segment& segment, bool at_end) const {
  if (!constraints_) return 0;
  const auto coordinates = [&](const std::vector<double>& parameters) {
    const Pose<double> at = pose(parameters);
    const double size = model_.characteristic_length;
    return std::array<double, 6>{at.p_WP(0) / size, at.p_WP(1) / size, at.p_WP(2) / size,
                                 at.angles[0],      at.angles[1],      at.angles[2]};
  };
  const std::array<double, 6> reached = coordinates(parameters(segment, at_end ? 1 : 0));
  std::array<double, 6> lowest, highest;
  lowest.fill(HUGE_VAL);
  highest.fill(-HUGE_VAL);
  auto stated = segment.controls().subspan(at_end ? 1 : 0, segment.controls().size() - 1);
  for (const Waypoint* waypoint : stated) {
    const std::array<double, 6> here = coordinates(curve_parameters(Segment::straight(*waypoint, *waypoint), 0));
    for (std::size_t i = 0; i < here.size(); ++i) {
      lowest[i] = std::min(lowest[i], here[i]);
      highest[i] = std::max(highest[i], here[i]);
    }
  }
  double distance = 0;
  for (std::size_t i = 0; i < reached.size(); ++i) {
    distance = std::max({distance, lowest[i] - reached[i], reached[i] - highest[i]});
  }
  return distance;
}

double PoseSampler::clearance(const Statics<double>& statics) const {
  if (!statics.regular) return -1.0;
  double least = 1.0;
  for (std::size_t i = 0; i < kCables; ++i) {
    const double tension_room = std::min(statics.tension[i] - statics.tension_below[i] - model_.tension_lower[i],
                                         model_.tension_upper[i] - statics.tension[i] - statics.tension_above[i]);
    const double length_room =
        std::min(statics.length[i] - model_.length_lower[i], model_.length_upper[i] - statics.length[i]);
    least = std::min({least, 2.0 * tension_room / (model_.tension_upper[i] - model_.tension_lower[i]),
                      2.0 * length_room / (model_.length_upper[i] - model_.length_lower[i])});
  }
  return least;
}

}  // namespace taut
