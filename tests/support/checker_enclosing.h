// SPDX-License-Identifier: GPL-3.0-or-later
// The checker's interval as one more arithmetic of enclosing.h, with the names that the prover's scalars have.
#pragma once

#include <cmath>
#include <stdexcept>
#include <string>

#include "checker/exact.h"
#include "checker/interval.h"
#include "tests/support/enclosing.h"

namespace taut {
namespace checker {

inline Interval tan(const Interval& x) { return sin(x) / cos(x); }  // as Expression::evaluate has it
inline Interval pow_int(const Interval& x, int n) { return power(x, n); }
inline Interval reciprocal(const Interval& x) { return Interval(1) / x; }
inline Interval intersect(const Interval& a, const Interval& b) { return intersection(a, b); }

inline BigFloat exactly(mpfr_srcptr x) {
  const PrecisionScope precision(mpfr_get_prec(x));
  BigFloat result;
  mpfr_set(result.get(), x, MPFR_RNDN);
  return result;
}
inline BigFloat lower_end(const Interval& x) { return exactly(x.lower()); }
inline BigFloat upper_end(const Interval& x) { return exactly(x.upper()); }

}  // namespace checker

namespace testing {

/// At a precision of `Bits`; what it throws counts as a fault.
template <int Bits>
struct Checker {
  using I = checker::Interval;
  static constexpr mpfr_prec_t kBits = Bits;
  static constexpr bool kHasCut = true;  ///< atan2(0, x) is pi for x < 0
  static I make(const Operand& x) { return hull(I(mpq_class(x.lower)), I(mpq_class(x.upper))); }
  static I from_decimal(const std::string& text) {
    try {
      return I(checker::parse_decimal(text, "test"));
    } catch (const checker::Malformed& error) {
      throw std::invalid_argument(error.what());
    }
  }
  static I pi() { return I::pi(); }
  template <class F>
  static bool run(F&& function) {
    const checker::WorkingPrecision precision(Bits);
    try {
      function();
      return true;
    } catch (const checker::Undefined&) {
      return false;
    } catch (const std::logic_error&) {  // two enclosures that do not meet
      return false;
    }
  }
};

}  // namespace testing
}  // namespace taut
