// SPDX-License-Identifier: GPL-3.0-or-later
// What drives and people allow a move to do in time, beside the limits of tensions and lengths.
#pragma once

#include <array>
#include <nlohmann/json_fwd.hpp>
#include <optional>

#include "base/json_cursor.h"
#include "problem/text.h"

namespace taut {

/// Rows of a table of lengths, between which each drive runs its cable straight (theory.md, 14, "Rows"). That differs
/// from the lengths of path and law by at most a h²/8 plus what the rows are off, with a winch's acceleration below a.
struct RowsText {
  DecimalText step_s;                        ///< h: two rows are no farther apart in time
  std::array<DecimalText, kCables> error_m;  ///< how far lengths that run so may be from those of path and law
  bool operator==(const RowsText&) const = default;
};

/// Limits of magnitudes: constants above 0 in SI units and radians; nothing where no limit is stated.
struct TimeText {
  using Limit = std::optional<ExpressionText>;
  std::array<Limit, kCables> winch_speed_m_s, winch_acceleration_m_s2;  ///< of the commanded lengths
  /// Of the product of a cable's greatest tension and its commanded speed, hoisting or lowering [W].
  std::array<Limit, kCables> winch_power_W;
  Limit load_speed_m_s, load_acceleration_m_s2;  ///< of the load point
  Limit load_angular_speed_rad_s, load_angular_acceleration_rad_s2;
  /// Not a magnitude: in this time or more a move may be slowed down from its full speed to rest, or up again, at any
  /// place [s]. Nothing where it is run at its full speed alone.
  Limit stopping_time_s;
  /// Lengths may be off by `error_m` beside tolerances; then winch_acceleration_m_s2 is stated of all cables.
  std::optional<RowsText> rows;
  bool operator==(const TimeText&) const = default;
};

/// Limits are from the one to the other, in SI units: what no machine has is a slip.
inline constexpr double kLeastRateLimit = 1e-12;
inline constexpr double kGreatestRateLimit = 1e12;

/// Checks that there is a limit, and that each is a constant within these bounds. It is evaluated in binary64, to tell
/// mistakes; of rows, that their errors are above a h²/8, exactly. Messages name limits as cases do:
/// "time.winches.speed[2]", "time.load.angular_speed". @throws FieldError
void validate(const TimeText& time);

/// The `time` object of a certificate's problem. @pre there is a limit
[[nodiscard]] nlohmann::json to_json(const TimeText& time);
/// Inverse of to_json, without validating. @throws FieldError
[[nodiscard]] TimeText time_from_json(const JsonCursor& value);

}  // namespace taut
