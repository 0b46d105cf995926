// SPDX-License-Identifier: GPL-3.0-or-later
// Decides whether an edge looks safe from poses sampled along it, in binary64. This is thousands of times cheaper than
// a failing proof, but it is no proof: edges that pass have still to be proved.
#pragma once

#include "atlas/manifold.h"
#include "certify/bodies/nearest.h"
#include "kinematics/pose_sampler.h"

namespace taut {

class SampledMotionValidator {
 public:
  /// `clearance`: least distance to a limit, over half its range, that every sampled pose must keep.
  /// `sampler` and `bodies`, null where the problem has none, have to outlive this.
  SampledMotionValidator(const PoseSampler& sampler, double clearance, const BodySampler* bodies = nullptr)
      : sampler_(sampler), clearance_(clearance), bodies_(bodies) {}

  /// Whether all sampled poses of the motion from a to b (edge_motion.h) keep the clearance, with one sign of det J,
  /// and bodies theirs.
  /// The ends are sampled first, then the middle and ever finer points, because the middle often shows that an edge is
  /// unsafe.
  [[nodiscard]] bool operator()(const Coordinates& a, const Coordinates& b) const;

 private:
  const PoseSampler& sampler_;
  double clearance_;
  const BodySampler* bodies_;
};

}  // namespace taut
