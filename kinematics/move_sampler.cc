// SPDX-License-Identifier: GPL-3.0-or-later
#include "kinematics/move_sampler.h"

#include <algorithm>
#include <stdexcept>

namespace taut {

MoveSampler::MoveSampler(const Problem& problem, const Path& path) : path_(path), sampler_(problem), rates_(problem) {
  if (!path.timing || path.segments() == 0 || !PathRatesModel<double>::knows(path.interpolation)) {
    throw std::logic_error("expected a move in time");
  }
}

MoveSample MoveSampler::at(double t) const {
  MoveSample sample;
  sample.t = std::clamp(t, 0.0, duration_s());
  sample.law = at_time(*path_.timing, sample.t);
  sample.law.s = std::clamp(sample.law.s, 0.0, static_cast<double>(path_.segments()));
  sample.segment = std::min(static_cast<std::size_t>(sample.law.s), path_.segments() - 1);
  sample.s = sample.law.s - static_cast<double>(sample.segment);
  const Segment segment = path_.segment(sample.segment);
  const PathRates<double> by_s = rates_.at(segment, sample.s);
  sample.pose = sampler_.rigid_pose(segment, sample.s);
  sample.length = cable_lengths(sampler_.model(), sample.pose);
  sample.winches =
      winch_rates(sampler_.model(), by_s.p, by_s.r_WP, by_time(by_s, sample.law.rate, sample.law.acceleration));
  return sample;
}

}  // namespace taut
