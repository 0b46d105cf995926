// SPDX-License-Identifier: GPL-3.0-or-later
// What drives and people allow a move to do in time, beside the limits of tensions and lengths.
#pragma once

#include <array>
#include <limits>

#include "kinematics/model.h"

namespace taut {

/// Greatest magnitudes; infinite where nothing is asked. `speed` and `acceleration` are those of the load point P_m.
struct TimeLimits {
  static constexpr double kNone = std::numeric_limits<double>::infinity();
  std::array<double, kCables> winch_speed{kNone, kNone, kNone, kNone, kNone, kNone};         ///< |L̇_i| [m/s]
  std::array<double, kCables> winch_acceleration{kNone, kNone, kNone, kNone, kNone, kNone};  ///< |L̈_i| [m/s²]
  double speed = kNone;                                                                      ///< [m/s]
  double acceleration = kNone;                                                               ///< [m/s²]
  double angular_speed = kNone;                                                              ///< [rad/s]
  double angular_acceleration = kNone;                                                       ///< [rad/s²]
  double jerk = kNone;  ///< of P_m [m/s³], which a law is shaped by
};

/// What a limit in time is of.
enum class RateKind {
  kWinchSpeed,
  kWinchAcceleration,
  kLoadSpeed,
  kLoadAcceleration,
  kLoadAngularSpeed,
  kLoadAngularAcceleration
};

struct RateId {
  RateKind kind = RateKind::kWinchSpeed;
  int cable = 0;  ///< of winches
  bool operator==(const RateId&) const = default;
};

}  // namespace taut
