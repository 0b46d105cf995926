// SPDX-License-Identifier: GPL-3.0-or-later
// A move in time, in floating point: where the platform is at a time, how it moves, and what its winches do.
//
// For tables; nothing here is proved.
#pragma once

#include <array>

#include "kinematics/moving_load.h"
#include "kinematics/path_rates.h"
#include "kinematics/pose_sampler.h"
#include "kinematics/time_law.h"

namespace taut {

/// A move at one time.
struct MoveSample {
  double t = 0;             ///< [s]
  LawPoint law;             ///< σ, in [0, S], and its derivatives
  std::size_t segment = 0;  ///< on which it is,
  double s = 0;             ///< and where on that, in [0, 1]
  RigidPose pose;
  std::array<double, kCables> length{};  ///< [m]
  WinchRates<double> winches;
};

class MoveSampler {
 public:
  /// Refers to the path, which must outlive it. @pre path.timing, of straight segments or a spline through parameters,
  /// in a space without constraints. @throws InputError if the problem has no model in doubles.
  MoveSampler(const Problem& problem, const Path& path);

  [[nodiscard]] double duration_s() const { return path_.timing->duration_s(); }
  /// @param t  in [0, T]; what is beyond is taken for the nearest end
  [[nodiscard]] MoveSample at(double t) const;

 private:
  const Path& path_;
  PoseSampler sampler_;
  PathRatesModel<double> rates_;
};

}  // namespace taut
