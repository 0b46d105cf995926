// SPDX-License-Identifier: GPL-3.0-or-later
// Whether an edge looks safe: poses sampled along it, in binary64. Thousands of times cheaper than a proof of an edge
// that is not safe, and no proof: what passes has still to be proved.
#pragma once

#include "atlas/manifold.h"
#include "kinematics/pose_sampler.h"

namespace taut {

class SampledMotionValidator {
 public:
  /// `clearance`: least distance to a limit, over half its range, that every sampled pose must keep.
  /// `sampler` has to outlive this.
  SampledMotionValidator(const PoseSampler& sampler, double clearance) : sampler_(sampler), clearance_(clearance) {}

  /// Whether all sampled poses of the motion from a to b (edge_motion.h) keep the clearance, with one sign of
  /// det J. Ends first, then ever finer: an unsafe edge is often found out by its middle.
  [[nodiscard]] bool operator()(const Coordinates& a, const Coordinates& b) const;

 private:
  const PoseSampler& sampler_;
  double clearance_;
};

}  // namespace taut
