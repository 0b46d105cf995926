// SPDX-License-Identifier: GPL-3.0-or-later
// Converts typed numbers to SI and binary64 with a single rounding, to nearest. It is fast, for tables with many
// numbers.
#pragma once

#include <optional>
#include <string>
#include <string_view>

#include "problem/units.h"

namespace taut {

/// A converter for all numbers of one unit.
class NearestSi {
 public:
  explicit NearestSi(Unit unit);

  [[nodiscard]] const Unit& unit() const { return unit_; }

  /// The binary64 nearest to the exact value, in SI, of the decimal `text` in this unit (ties to even; −0 becomes 0).
  /// Degrees are multiples of pi/180, enclosed as finely as the rounding needs. The result is independent of the
  /// rounding mode.
  /// @throws InputError as Decimal::parse() does.
  [[nodiscard]] double operator()(std::string_view text) const;

 private:
  /// The result computed with `bits` bits of precision; nothing if they don't decide the rounding, or if the text is
  /// zero or not a decimal.
  [[nodiscard]] std::optional<double> at_precision(const std::string& text, long bits) const;

  Unit unit_;
  std::string factor_;
};

}  // namespace taut
