// SPDX-License-Identifier: GPL-3.0-or-later
// A move in binary64: what platform, winches and cables do at a time. Nothing here is proved.
#pragma once

#include <array>
#include <vector>

#include "kinematics/moving_load.h"
#include "kinematics/rates_sampler.h"
#include "kinematics/statics.h"
#include "kinematics/time_law.h"
#include "kinematics/time_limits.h"

namespace taut {

/// The machine as stated at one time of a move.
struct MoveSample {
  double time_s = 0;
  LawPoint place;           ///< σ, σ' and σ''; σ counts segments
  std::size_t segment = 0;  ///< on which it is,
  double s = 0;             ///< and where on that, in [0, 1]
  Rates<double> rates;
  WinchRates<double> winches;                                    ///< L̇ [m/s] and L̈ [m/s²]
  double load_speed = 0, load_acceleration = 0;                  ///< of the load point [m/s, m/s²]
  double load_angular_speed = 0, load_angular_acceleration = 0;  ///< of the platform [rad/s, rad/s²]
  Vector6<double> inertial_wrench;                               ///< w_in about P_m, axes of W [N, N m]
  Statics<double> statics;                                       ///< with tensions that balance w − w_in
  std::array<double, kCables> winch_power{};                     ///< |greatest tension over K| · |L̇| [W]

  /// The magnitude that a limit of this kind is about.
  [[nodiscard]] double size(RateId id) const;
};

/// Whether a path of a problem is a move in time that can be sampled; else it is passed slowly, or a pose at rest.
[[nodiscard]] bool is_in_time(const Problem& problem, const Path& path);

class MoveSampler {
 public:
  /// @throws InputError if the problem has no model in doubles.
  explicit MoveSampler(const Problem& problem);

  /// @param time_s  what is beyond the move is taken for the nearest end
  /// @pre is_in_time()
  [[nodiscard]] MoveSample at_time(const Path& path, double time_s) const;
  /// The same at a place that counts segments. While a move stands still there, all that is sampled is the same.
  [[nodiscard]] MoveSample at_place(const Path& path, double place) const;

  /// The first time at which a move has reached a place that counts segments, by halving [s].
  [[nodiscard]] static double time_of(const TimeLaw& law, double place);

 private:
  Model<double> model_;
  RatesSampler rates_;
  std::vector<MovingBody<double>> bodies_;
};

}  // namespace taut
