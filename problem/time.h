// SPDX-License-Identifier: GPL-3.0-or-later
// What drives and people allow a move to do in time, beside the limits of tensions and lengths.
#pragma once

#include <array>
#include <optional>

#include "problem/text.h"

namespace taut {

/// Limits of magnitudes: constants above 0 in SI units and radians; nothing where no limit is stated.
struct TimeText {
  using Limit = std::optional<ExpressionText>;
  std::array<Limit, kCables> winch_speed_m_s, winch_acceleration_m_s2;  ///< of the commanded lengths
  Limit load_speed_m_s, load_acceleration_m_s2;                         ///< of the load point
  Limit load_angular_speed_rad_s, load_angular_acceleration_rad_s2;
  bool operator==(const TimeText&) const = default;
};

}  // namespace taut
