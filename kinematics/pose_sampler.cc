#include "kinematics/pose_sampler.h"

#include <algorithm>

#include "kinematics/motion_length.h"
#include "kinematics/pose_conversion.h"

namespace taut {
namespace {

/// px … sigma of a segment under a law with poses.
std::vector<double> free_coordinates(const Model<double>& model, const Segment& segment, double s) {
  std::array<RigidPose, 2> ends;
  std::array<double, kCables> lengths{};
  for (std::size_t end = 0; end < 2; ++end) {
    const std::vector<double>& x = segment.control[end]->x;
    ends[end] = {Vector3<double>(x[0], x[1], x[2]), Eigen::Quaterniond(x[6], x[3], x[4], x[5]).normalized()};
    if (segment.law != Interpolation::kCableLengths) continue;
    for (std::size_t i = 0; i < kCables; ++i) lengths[i] += (end == 0 ? 1 - s : s) * x[7 + i];
  }
  RigidPose pose{(1 - s) * ends[0].p + s * ends[1].p, ends[0].q.slerp(s, ends[1].q)};
  if (segment.law == Interpolation::kCableLengths) pose = pose_of_lengths(model, lengths, pose).value_or(pose);
  const TiltAndTorsion angles = tilt_and_torsion(pose.q, std::nullopt);
  return {pose.p(0), pose.p(1), pose.p(2), angles.x[0], angles.x[1], angles.x[2]};
}

}  // namespace

PoseSampler::PoseSampler(const Problem& problem)
    : model_(make_model<double>(problem)), tape_(pose_tape(problem)), pose_(tape_) {
  if (!problem.space.constraints.empty()) constraints_.emplace(problem);
}

std::vector<double> PoseSampler::parameters(const Segment& segment, double s) const {
  if (has_poses(segment.law)) return free_coordinates(model_, segment, s);
  if (constraints_) return constraints_->parameters(segment, s);
  return curve_parameters(segment, s);
}

RigidPose PoseSampler::rigid_pose(const Segment& segment, double s) const {
  if (!has_poses(segment.law)) {
    return taut::rigid_pose(pose(parameters(segment, s)));
  }
  const RigidPose reference = pose_between(segment, s);
  if (segment.law != Interpolation::kCableLengths) return reference;
  constexpr std::size_t kFirstLength = 7;
  std::array<double, kCables> wanted;
  for (std::size_t i = 0; i < kCables; ++i) {
    wanted[i] = (1 - s) * segment.control[0]->x[kFirstLength + i] + s * segment.control[1]->x[kFirstLength + i];
  }
  return pose_of_lengths(model_, wanted, reference).value_or(reference);
}

double PoseSampler::clearance(const Statics<double>& statics) const {
  if (!statics.regular) return -1.0;
  double least = 1.0;
  for (std::size_t i = 0; i < kCables; ++i) {
    const double tension_room = std::min(statics.tension[i] - statics.variation[i] - model_.tension_lower[i],
                                         model_.tension_upper[i] - statics.tension[i] - statics.variation[i]);
    const double length_room =
        std::min(statics.length[i] - model_.length_lower[i], model_.length_upper[i] - statics.length[i]);
    least = std::min({least, 2.0 * tension_room / (model_.tension_upper[i] - model_.tension_lower[i]),
                      2.0 * length_room / (model_.length_upper[i] - model_.length_lower[i])});
  }
  return least;
}

}  // namespace taut
