// SPDX-License-Identifier: GPL-3.0-or-later
#include "planner/sampled_motion_validator.h"

#include <cmath>

#include "planner/edge_motion.h"

namespace taut {
namespace {

// Largest distance between samples: the change of position as a fraction of the platform's size, plus that of the
// parameters. A margin with curvature M per rad^2 dips by M step^2 / 8 between two samples, which is less than a
// clearance of 0.5 % up to M = 16.
constexpr double kStep = 0.05;
constexpr int kMostLevels = 12;  // of bisection

}  // namespace

bool SampledMotionValidator::operator()(const Coordinates& a, const Coordinates& b) const {
  double sign = 0;  // of det J
  BodySampler::Carried carried;
  const auto clear = [&](const Pose<double>& pose) {
    const Statics<double> statics = sampler_.statics(pose);
    if (!(sampler_.clearance(statics) > clearance_)) return false;
    if (sign == 0) sign = statics.determinant;
    if (!(statics.determinant * sign > 0)) return false;
    return bodies_ == nullptr || bodies_->is_clear(sampler_.model(), sampler_.rigid_pose(pose), carried);
  };
  const EdgeMotion motion(sampler_, a, b);
  const Pose<double> first = motion.pose(0);
  const Pose<double> last = motion.pose(1);
  if (!clear(last) || !clear(first) || !motion.looks_single()) return false;
  const double way = (last.p_WP - first.p_WP).norm() / sampler_.model().characteristic_length + (b - a).norm();
  double spacing = way;
  double half = 0.5;  // of the spacing, in s
  for (int level = 0; spacing > kStep && level < kMostLevels; ++level, spacing *= 0.5, half *= 0.5) {
    for (double s = half; s < 1.0; s += 2.0 * half) {
      if (!clear(motion.pose(s))) return false;
    }
  }
  return true;
}

}  // namespace taut
