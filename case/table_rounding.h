// SPDX-License-Identifier: GPL-3.0-or-later
// The rounding that a user states of a table with times: how far its rows may be from the move that is fitted to them.
#pragma once

#include <optional>
#include <string>

#include "problem/units.h"

namespace taut {

/// The largest that may be stated.
inline constexpr double kMostRounding_m = 1;
inline constexpr double kMostRounding_rad = 0.2;

/// Of a table of poses a position and an angle, of one of cable lengths a length. Each is above 0 if it is stated, and
/// not above what was typed.
struct TableRounding {
  double position_m = 0;                      ///< by which the platform's origin may be displaced
  double angle_rad = 0;                       ///< by which the platform may be turned
  double length_m = 0;                        ///< by which each cable may be longer or shorter
  std::string position{}, angle{}, length{};  ///< as typed, with units; empty if not stated

  [[nodiscard]] bool is_of_lengths() const { return !length.empty(); }
  /// "0.1 mm and 0.01 deg", or "0.1 mm".
  [[nodiscard]] std::string text() const { return is_of_lengths() ? length : position + " and " + angle; }
};

/// Reads "0.1mm,0.01deg", or "0.1mm" of cable lengths. @throws InputError, of kind kUse and naming `option`.
[[nodiscard]] TableRounding read_table_rounding(const std::string& text, const std::string& option);

/// Of a program's numbers: those that are not stated are 0. @throws InputError naming the field.
[[nodiscard]] TableRounding table_rounding(double position_m, double angle_rad, double length_m);

struct RoundingSize {
  double si = 0;
  std::string text;
};
/// Reads "0.1 mm"; nothing unless it is such a size of this dimension.
/// @param bare  unit of a number that has none; nothing: it needs one
[[nodiscard]] std::optional<RoundingSize> read_rounding_size(const std::string& text, Dimension dimension,
                                                             const std::optional<Unit>& bare = {});
/// What such a size of lengths or angles has to be.
[[nodiscard]] std::string rounding_expected(Dimension dimension);

}  // namespace taut
