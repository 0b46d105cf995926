// SPDX-License-Identifier: GPL-3.0-or-later
#include "app/path_hints.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <utility>
#include <vector>

namespace taut {
namespace {

constexpr double kDegrees = 180 / std::numbers::pi;

Eigen::Quaterniond quaternion(const std::vector<double>& x) {
  return Eigen::Quaterniond(x[6], x[3], x[4], x[5]).normalized();
}

RigidPose pose_of(const PoseSampler& sampler, PathForm form, const std::vector<double>& x) {
  if (form == PathForm::kQuaternion) return {Vector3<double>(x[0], x[1], x[2]), quaternion(x)};
  if (form == PathForm::kParameters) return sampler.rigid_pose(sampler.pose(x));
  Pose<double> pose{Vector3<double>(x[0], x[1], x[2]), {}};
  std::copy(x.begin() + 3, x.end(), pose.angles.begin());
  return sampler.rigid_pose(pose);
}

bool is_feasible(const PoseSampler& sampler, PathForm form, const std::vector<double>& x) {
  return sampler.clearance(sampler.statics(pose_of(sampler, form, x))) > 0;
}

/// The angle by which the platform is turned [rad], from 0 to π.
double turned(const Eigen::Quaterniond& q) { return 2 * std::atan2(q.vec().norm(), std::abs(q.w())); }

std::string quaternion_hint(const PoseSampler& sampler, const PathHeader& header, const PathRow& first) {
  std::vector<double> other = first.x;
  for (std::size_t k = 0; k < 4; ++k) other[3 + k] = first.x[3 + (k + 1) % 4];  // the first number as w
  const double as_read = turned(quaternion(first.x));
  const double as_other = turned(quaternion(other));
  constexpr double kMuch = 2 * std::numbers::pi / 3;
  constexpr double kLittle = std::numbers::pi / 3;
  const bool is_plausible = is_feasible(sampler, header.form, other) || (as_read > kMuch && as_other < kLittle);
  if (!is_plausible) return "";
  return fmt::format(
      "In line {} the quaternion, read as x, y, z, w, turns the platform by {:.3g} degrees to a pose that is outside "
      "the limits. Read as w, x, y, z it would turn it by {:.3g} degrees: is the file's w its first number?\n",
      first.line, as_read * kDegrees, as_other * kDegrees);
}

}  // namespace

std::string column_hint(const PoseSampler& sampler, const PathHeader& header, const PathRow& first) {
  if (header.form == PathForm::kCableLengths) return "";
  PathRow row = first;
  for (std::size_t j = 0; j < row.x.size(); ++j) row.x[j] += std::numbers::pi * row.half_turns[j];
  if (is_feasible(sampler, header.form, row.x)) return "";
  if (header.form == PathForm::kQuaternion) {
    if (std::string hint = quaternion_hint(sampler, header, row); !hint.empty()) return hint;
  }
  const std::size_t exchangeable = header.form == PathForm::kQuaternion ? 3 : row.x.size();
  for (std::size_t i = 0; i < exchangeable; ++i) {
    for (std::size_t j = i + 1; j < exchangeable; ++j) {
      if (header.coordinates[i].unit != header.coordinates[j].unit) continue;
      std::vector<double> exchanged = row.x;
      std::swap(exchanged[i], exchanged[j]);
      if (!is_feasible(sampler, header.form, exchanged)) continue;
      return fmt::format(
          "In line {} the pose is outside the limits. With {} and {} exchanged it would be within all of them: are "
          "these two columns swapped?\n",
          first.line, header.coordinates[i].name, header.coordinates[j].name);
    }
  }
  return "";
}

}  // namespace taut
