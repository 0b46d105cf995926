// SPDX-License-Identifier: GPL-3.0-or-later
#include "reports/summary/samples.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace taut {

std::vector<double> resolved(const Waypoint& waypoint) {
  const ParameterPoint& point = waypoint.parameters();
  std::vector<double> result(point.x);
  for (std::size_t j = 0; j < result.size(); ++j) result[j] += point.half_turns[j] * ScalarTraits<double>::pi();
  return result;
}

Sampler::Sampler(const Problem& problem) : poses_(problem) {
  if (problem.time) moves_.emplace(problem);
}

bool Sampler::is_timed(const Path& path) const { return moves_ && path.timing && path.segments() > 0; }

PathSample Sampler::at(const Path& path, double position) const {
  PathSample sample = pose_at(path, position);
  if (is_timed(path)) {
    sample.in_time = moves_->at_place(path, position);
    sample.statics = sample.in_time->statics;
  } else {
    sample.statics = poses_.statics(sample.pose);
  }
  return sample;
}

PathSample Sampler::pose_at(const Path& path, double position) const {
  const std::size_t segments = path.segments();
  const bool at_end = position >= static_cast<double>(segments);
  const std::size_t k = at_end && segments > 0 ? segments - 1 : static_cast<std::size_t>(position);
  const bool at_last_waypoint = at_end && path.interpolation == Interpolation::kStraight;
  const Waypoint& last = path.waypoints.back();
  PathSample sample;
  sample.position = position;
  sample.parameters = at_last_waypoint ? poses_.parameters(Segment::straight(last, last), 0)
                                       : poses_.parameters(path.segment(k), position - static_cast<double>(k));
  sample.pose = pose(sample.parameters);
  return sample;
}

std::vector<PathSample> Sampler::along(const Path& path, std::size_t budget) const {
  std::vector<PathSample> samples;
  if (path.waypoints.empty()) return samples;
  const std::size_t segments = path.segments();
  if (segments == 0) return {at(path, 0)};
  if (is_timed(path)) {
    const std::size_t count = std::max(budget, std::size_t{2});
    for (std::size_t i = 0; i <= count; ++i) {
      const double share = static_cast<double>(i) / static_cast<double>(count);
      MoveSample in_time = moves_->at_time(path, share * path.timing->duration_s());
      // A law's value at its ends is exact but for rounding.
      if (i == 0) in_time.place.s = 0;
      if (i == count) in_time.place.s = static_cast<double>(segments);
      PathSample& sample = samples.emplace_back(pose_at(path, in_time.place.s));
      sample.statics = in_time.statics;
      sample.in_time = std::move(in_time);
    }
    return samples;
  }
  const std::size_t per_segment = std::max<std::size_t>(1, budget / segments);
  const std::size_t count = std::min(per_segment * segments, std::max(budget, std::size_t{2}));
  for (std::size_t i = 0; i <= count; ++i) {
    samples.push_back(at(path, static_cast<double>(i * segments) / static_cast<double>(count)));
  }
  return samples;
}

std::optional<SampledViolation> worst_violation(const Model<double>& model, const std::vector<PathSample>& samples) {
  std::optional<SampledViolation> worst;
  double furthest = 0;
  for (const PathSample& sample : samples) {
    const Statics<double>& at = sample.statics;
    for (std::size_t i = 0; i < kCables; ++i) {
      const auto consider = [&](bool is_length, bool is_upper, double value, double beyond, double width) {
        if (!(beyond >= furthest * width)) return;
        furthest = beyond / width;
        worst = SampledViolation{static_cast<int>(i), is_length, is_upper, value, sample.position};
      };
      const auto both = [&](bool is_length, double low, double high, double lower, double upper) {
        consider(is_length, false, low, lower - low, upper - lower);
        consider(is_length, true, high, high - upper, upper - lower);
      };
      both(true, at.length[i], at.length[i], model.length_lower[i], model.length_upper[i]);
      if (!at.regular) continue;
      both(false, at.tension[i] - at.tension_below[i], at.tension[i] + at.tension_above[i], model.tension_lower[i],
           model.tension_upper[i]);
    }
  }
  return worst;
}

std::vector<double> sign_changes(const std::vector<PathSample>& samples) {
  std::vector<double> changes;
  bool is_positive = false;
  bool has_sign = false;
  for (const PathSample& sample : samples) {
    if (!sample.statics.regular) continue;
    const bool positive = sample.statics.determinant > 0;
    if (has_sign && positive != is_positive) changes.push_back(sample.position);
    is_positive = positive;
    has_sign = true;
  }
  return changes;
}

Reserves reserves(const Model<double>& model, const Statics<double>& statics) {
  constexpr double kInfinity = std::numeric_limits<double>::infinity();
  const auto within = [](double low, double high, double lower, double upper) {
    const double least = std::min(low - lower, upper - high) / (upper - lower);
    if (low > lower && high < upper) return least;
    return least <= 0 ? least : -kInfinity;  // also for NaN
  };
  Reserves least = {statics.regular ? kInfinity : -kInfinity, kInfinity};
  for (std::size_t i = 0; i < kCables; ++i) {
    const double length = statics.length[i];
    least.length = std::min(least.length, within(length, length, model.length_lower[i], model.length_upper[i]));
    if (!statics.regular) continue;
    const double tension = statics.tension[i];
    least.tension =
        std::min(least.tension, within(tension - statics.tension_below[i], tension + statics.tension_above[i],
                                       model.tension_lower[i], model.tension_upper[i]));
  }
  return least;
}

}  // namespace taut
