// SPDX-License-Identifier: GPL-3.0-or-later
// Floating-point samples of a certificate's path, for pictures. Nothing here is proved.
#pragma once

#include <optional>
#include <vector>

#include "kinematics/move_sampler.h"
#include "kinematics/pose_sampler.h"
#include "kinematics/statics.h"

namespace taut {

/// A pose of the path. `position` counts segments: k + s is the point s of segment k.
struct PathSample {
  double position = 0;
  std::vector<double> parameters;
  Pose<double> pose;
  Statics<double> statics;            ///< of a move with the inertia of the load
  std::optional<MoveSample> in_time;  ///< of a move
};

/// Evaluates poses and statics of one problem in floating point.
class Sampler {
 public:
  explicit Sampler(const Problem& problem);

  [[nodiscard]] const Model<double>& model() const { return poses_.model(); }
  [[nodiscard]] Pose<double> pose(const std::vector<double>& parameters) const { return poses_.pose(parameters); }
  [[nodiscard]] Pose<double> pose(const Waypoint& waypoint) const { return poses_.pose(waypoint); }
  [[nodiscard]] RigidPose rigid_pose(const PathSample& sample) const { return poses_.rigid_pose(sample.pose); }
  [[nodiscard]] PathSample at(const Path& path, double position) const;
  /// About `budget` poses in order, including both ends and, if the budget allows, every waypoint; of a move equally
  /// spaced in time.
  [[nodiscard]] std::vector<PathSample> along(const Path& path, std::size_t budget) const;

 private:
  /// is_in_time() of the problem and this path.
  [[nodiscard]] bool is_timed(const Path& path) const;
  /// @param position  within the path
  [[nodiscard]] PathSample pose_at(const Path& path, double position) const;

  PoseSampler poses_;
  std::optional<MoveSampler> moves_;  ///< of a problem with limits in time
};

/// λ = x + π half_turns.
[[nodiscard]] std::vector<double> resolved(const Waypoint& waypoint);

/// A quantity of a sample that is outside its limits.
struct SampledViolation {
  int cable = 0;  ///< 0…5
  bool is_length = false;
  bool is_upper = false;  ///< which limit
  double value = 0;       ///< [N, m]
  double position = 0;
};
/// The violation furthest beyond its limit, relative to the width between limits. Singular samples have no tensions.
[[nodiscard]] std::optional<SampledViolation> worst_violation(const Model<double>& model,
                                                              const std::vector<PathSample>& samples);
/// Positions of samples at which det J has another sign than at the sample before.
[[nodiscard]] std::vector<double> sign_changes(const std::vector<PathSample>& samples);

/// How far inside their limits all tensions and all lengths are at a pose: the least of the six cables, as a share of
/// the width between its limits. Positive exactly where all of them are kept; not positive, and possibly infinite, at a
/// singular pose.
struct Reserves {
  double tension = 0;
  double length = 0;
};
[[nodiscard]] Reserves reserves(const Model<double>& model, const Statics<double>& statics);

}  // namespace taut
