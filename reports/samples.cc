#include "reports/samples.h"

#include <algorithm>
#include <cmath>

namespace taut {

namespace {

/// Keeps in `closest` the nearer of it and value's distances from both limits.
void consider(std::optional<Closest>& closest, int cable, double low, double high, double lower, double upper,
              double position) {
  for (const bool is_upper : {false, true}) {
    const double margin = is_upper ? upper - high : low - lower;
    if (!closest || margin < closest->margin) {
      closest = Closest{cable, is_upper, margin, margin / (upper - lower), position};
    }
  }
}

}  // namespace

std::vector<double> resolved(const Waypoint& waypoint) {
  std::vector<double> result(waypoint.x);
  for (std::size_t j = 0; j < result.size(); ++j) result[j] += waypoint.half_turns[j] * ScalarTraits<double>::pi();
  return result;
}

PathSample Sampler::at(const Path& path, double position) const {
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
  sample.statics = poses_.statics(sample.pose);
  return sample;
}

std::vector<PathSample> Sampler::along(const Path& path, std::size_t budget) const {
  std::vector<PathSample> samples;
  if (path.waypoints.empty()) return samples;
  const std::size_t segments = path.segments();
  if (segments == 0) return {at(path, 0)};
  const std::size_t per_segment = std::max<std::size_t>(1, budget / segments);
  const std::size_t count = std::min(per_segment * segments, std::max(budget, std::size_t{2}));
  for (std::size_t i = 0; i <= count; ++i) {
    samples.push_back(at(path, static_cast<double>(i * segments) / static_cast<double>(count)));
  }
  return samples;
}

std::optional<Closest> closest_tension(const Model<double>& model, const std::vector<PathSample>& samples) {
  std::optional<Closest> closest;
  for (const PathSample& sample : samples) {
    if (!sample.statics.regular) continue;
    for (std::size_t i = 0; i < kCables; ++i) {
      const double f0 = sample.statics.tension[i];
      const double v = sample.statics.variation[i];
      consider(closest, static_cast<int>(i), f0 - v, f0 + v, model.tension_lower[i], model.tension_upper[i],
               sample.position);
    }
  }
  return closest;
}

std::optional<Closest> closest_length(const Model<double>& model, const std::vector<PathSample>& samples) {
  std::optional<Closest> closest;
  for (const PathSample& sample : samples) {
    for (std::size_t i = 0; i < kCables; ++i) {
      const double d = sample.statics.length[i];
      consider(closest, static_cast<int>(i), d, d, model.length_lower[i], model.length_upper[i], sample.position);
    }
  }
  return closest;
}

Feasibility feasibility(const Model<double>& model, const Statics<double>& statics) {
  bool tension = statics.regular;
  bool length = true;
  for (std::size_t i = 0; i < kCables; ++i) {
    length = length && statics.length[i] > model.length_lower[i] && statics.length[i] < model.length_upper[i];
    tension = tension && statics.tension[i] - statics.variation[i] > model.tension_lower[i] &&
              statics.tension[i] + statics.variation[i] < model.tension_upper[i];
  }
  if (tension) return length ? Feasibility::kInside : Feasibility::kLengthOut;
  return length ? Feasibility::kTensionOut : Feasibility::kBothOut;
}

}  // namespace taut
