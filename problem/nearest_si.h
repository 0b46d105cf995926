// Typed numbers to SI and binary64, with one rounding and that to nearest: for tables, where there are many.
#pragma once

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
  Unit unit_;
  unsigned long factor_digits_ = 0;  ///< the unit's factor is factor_digits_ · 10^factor_exponent_
  int factor_exponent_ = 0;
};

}  // namespace taut
