// SPDX-License-Identifier: GPL-3.0-or-later
// Typed numbers to SI and binary64, with one rounding and that to nearest: for tables, where there are many.
#pragma once

#include <optional>
#include <string>
#include <string_view>

#include "problem/units.h"

namespace taut {

/// Made once for all numbers of one unit.
class NearestSi {
 public:
  explicit NearestSi(Unit unit);

  [[nodiscard]] const Unit& unit() const { return unit_; }

  /// The binary64 nearest to the exact value, in SI, of the decimal `text` of that unit (ties to even; −0 to 0). Degrees are
  /// multiples of pi/180, enclosed as finely as it takes. Independent of the rounding mode.
  /// @throws InputError as Decimal::parse() does.
  [[nodiscard]] double operator()(std::string_view text) const;

 private:
  /// Nothing where that many bits of precision don't decide, the text is not a decimal, or it is zero.
  [[nodiscard]] std::optional<double> at_precision(const std::string& text, long bits) const;

  Unit unit_;
  std::string factor_;
};

}  // namespace taut
