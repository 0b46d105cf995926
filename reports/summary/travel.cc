// SPDX-License-Identifier: GPL-3.0-or-later
#include "reports/summary/travel.h"

#include <algorithm>
#include <cmath>
#include <string>

#include "kinematics/pose_conversion.h"
#include "problem/scalar.h"
#include "reports/summary/numbers.h"

namespace taut {

namespace {

/// Between two neighbours, linearly; `steps` of them in all.
double interpolated(const std::vector<double>& values, double index) {
  if (values.empty()) return 0;
  const double last = static_cast<double>(values.size() - 1);
  const double clamped = std::clamp(index, 0.0, last);
  const auto k = std::min(static_cast<std::size_t>(clamped), values.size() - 1);
  const std::size_t next = std::min(k + 1, values.size() - 1);
  const double t = clamped - static_cast<double>(k);
  return (1 - t) * values[k] + t * values[next];
}

}  // namespace

Travel::Travel(const Sampler& sampler, const Path& path) {
  if (path.waypoints.empty()) return;
  constexpr std::size_t kPieces = 4096;  // of the whole path, about
  const std::size_t segments = path.segments();
  pieces_ = std::clamp<std::size_t>(kPieces / std::max<std::size_t>(segments, 1), 1, 64);
  std::optional<RigidPose> last;
  for (std::size_t i = 0; i <= segments * pieces_; ++i) {
    const RigidPose pose = sampler.rigid_pose(sampler.at(path, static_cast<double>(i) / static_cast<double>(pieces_)));
    distance_m_.push_back(last ? distance_m_.back() + (pose.p - last->p).stableNorm() : 0);
    turned_rad_.push_back(last ? turned_rad_.back() + pose.q.angularDistance(last->q) : 0);
    last = pose;
  }
  if (segments > 0) timing_ = path.timing;
  segments_ = static_cast<double>(segments);
  if (path.interpolation == Interpolation::kCubicBSpline) return;
  for (const std::string& time : path.times) times_s_.push_back(nearest_double(time));
}

double Travel::at(const std::vector<double>& values, double position) const {
  return interpolated(values, position * static_cast<double>(pieces_));
}

std::optional<double> Travel::time_s(double position) const {
  if (timing_ && position >= segments_) return timing_->duration_s();
  if (timing_) return position > 0 ? MoveSampler::time_of(*timing_, position) : 0;
  if (times_s_.empty()) return std::nullopt;
  return interpolated(times_s_, position);
}

}  // namespace taut
