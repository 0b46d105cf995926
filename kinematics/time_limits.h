// SPDX-License-Identifier: GPL-3.0-or-later
// What drives and people allow a move to do in time, beside the limits of tensions and lengths.
#pragma once

#include <array>
#include <limits>
#include <vector>

#include "kinematics/model.h"
#include "problem/problem.h"

namespace taut {

/// Greatest magnitudes; infinite where nothing is asked. `speed` and `acceleration` are those of the load point P_m.
struct TimeLimits {
  static constexpr double kNone = std::numeric_limits<double>::infinity();
  std::array<double, kCables> winch_speed{kNone, kNone, kNone, kNone, kNone, kNone};         ///< |L̇_i| [m/s]
  std::array<double, kCables> winch_acceleration{kNone, kNone, kNone, kNone, kNone, kNone};  ///< |L̈_i| [m/s²]
  std::array<double, kCables> winch_power{kNone, kNone, kNone, kNone, kNone, kNone};         ///< f_i |L̇_i| [W]
  double speed = kNone;                                                                      ///< [m/s]
  double acceleration = kNone;                                                               ///< [m/s²]
  double angular_speed = kNone;                                                              ///< [rad/s]
  double angular_acceleration = kNone;                                                       ///< [rad/s²]
  double jerk = kNone;  ///< of P_m [m/s³], which a law is shaped by
};

/// What a problem states, in floating point: for proposals. Nothing limits a jerk.
[[nodiscard]] TimeLimits make_time_limits(const Problem& problem);

/// What a limit in time is of.
enum class RateKind {
  kWinchSpeed,
  kWinchAcceleration,
  kWinchPower,
  kLoadSpeed,
  kLoadAcceleration,
  kLoadAngularSpeed,
  kLoadAngularAcceleration
};

inline constexpr std::array kRateKinds = {RateKind::kWinchSpeed,
                                          RateKind::kWinchAcceleration,
                                          RateKind::kWinchPower,
                                          RateKind::kLoadSpeed,
                                          RateKind::kLoadAcceleration,
                                          RateKind::kLoadAngularSpeed,
                                          RateKind::kLoadAngularAcceleration};

/// As certificates name it.
[[nodiscard]] constexpr const char* name(RateKind kind) {
  switch (kind) {
    case RateKind::kWinchSpeed: return "winch_speed";
    case RateKind::kWinchAcceleration: return "winch_acceleration";
    case RateKind::kWinchPower: return "winch_power";
    case RateKind::kLoadSpeed: return "load_speed";
    case RateKind::kLoadAcceleration: return "load_acceleration";
    case RateKind::kLoadAngularSpeed: return "load_angular_speed";
    case RateKind::kLoadAngularAcceleration: break;
  }
  return "load_angular_acceleration";
}

/// Whether it is of one winch, not of the load.
[[nodiscard]] constexpr bool is_of_winch(RateKind kind) {
  return kind == RateKind::kWinchSpeed || kind == RateKind::kWinchAcceleration || kind == RateKind::kWinchPower;
}

[[nodiscard]] constexpr bool is_speed(RateKind kind) {
  return kind == RateKind::kWinchSpeed || kind == RateKind::kLoadSpeed || kind == RateKind::kLoadAngularSpeed;
}

struct RateId {
  RateKind kind = RateKind::kWinchSpeed;
  int cable = 0;  ///< of winches
  bool operator==(const RateId&) const = default;
};

/// A limit that a problem states of a move.
struct RateLimit {
  RateId id;
  ExpressionText text;  ///< SI
  double value = 0;     ///< rounded
};
/// All of them, in the order of RateKind, and for winches of cables.
[[nodiscard]] std::vector<RateLimit> rate_limits(const TimeText& time);
/// The expression of one of them. @pre it is stated
[[nodiscard]] const ExpressionText& limit_of(const TimeText& time, RateId id);

}  // namespace taut
