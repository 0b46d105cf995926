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

/// Both above 0.
struct TableRounding {
  double position_m = 0;        ///< by which the platform's origin may be displaced; not above what was typed
  double angle_rad = 0;         ///< by which the platform may be turned; likewise
  std::string position, angle;  ///< as typed, with units
};

/// Reads "0.1mm,0.01deg". @throws InputError, of kind kUse and naming `option`.
[[nodiscard]] TableRounding read_table_rounding(const std::string& text, const std::string& option);

/// Of a program's numbers. @throws InputError naming the field.
[[nodiscard]] TableRounding table_rounding(double position_m, double angle_rad);

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
