// SPDX-License-Identifier: GPL-3.0-or-later
// The checker's balls as one more arithmetic of enclosing.h, with the names that the prover's scalars have.
#pragma once

#include <stdexcept>
#include <string>

#include "checker/format/exact.h"
#include "checker/kernel/mean_value_form.h"
#include "tests/support/enclosing.h"

namespace taut {
namespace checker {

inline Ball sin(const Ball& x) { return value(Function::kSin, x); }
inline Ball cos(const Ball& x) { return value(Function::kCos, x); }
inline Ball tan(const Ball& x) { return sin(x) / cos(x); }  // as Expression::evaluate has it
inline Ball exp(const Ball& x) { return value(Function::kExp, x); }
inline Ball log(const Ball& x) { return value(Function::kLog, x); }
inline Ball asin(const Ball& x) { return value(Function::kAsin, x); }
inline Ball acos(const Ball& x) { return value(Function::kAcos, x); }
inline Ball atan(const Ball& x) { return value(Function::kAtan, x); }
inline Ball atan2(const Ball& y, const Ball& x) { return atan2(MeanValueForm(y), MeanValueForm(x)).range(); }
inline Ball pow_int(const Ball& x, int n) { return power(x, n); }
inline Ball reciprocal(const Ball& x) { return value(Function::kInverse, x); }

/// The exact number, as far as it is an end of few bits.
inline Ball exactly(const BigFloat& x) {
  return Ball::make([&](arb_ptr r) { arf_set_mpfr(arb_midref(r), x.get()); });
}

/// The ends of the ball, rounded outward to more bits than a result of some operation on binary64 can be told apart by.
inline constexpr mpfr_prec_t kEndBits = 2100;
inline BigFloat exactly(const Ball& number) {
  const PrecisionScope precision(kEndBits);
  BigFloat result;
  arf_get_mpfr(result.get(), arb_midref(number.get()), MPFR_RNDN);
  return result;
}
inline BigFloat lower_end(const Ball& x) {
  return exactly(Ball::make([&](arb_ptr r) { arb_get_lbound_arf(arb_midref(r), x.get(), kEndBits); }));
}
inline BigFloat upper_end(const Ball& x) {
  return exactly(Ball::make([&](arb_ptr r) { arb_get_ubound_arf(arb_midref(r), x.get(), kEndBits); }));
}

}  // namespace checker

namespace testing {

/// At a precision of `Bits`.
template <int Bits>
struct Checker {
  using I = checker::Ball;
  static constexpr mpfr_prec_t kBits = Bits;
  /// A ball that holds all of them: the least one, up to rounding.
  static I make(const Operand& x) { return hull(I(x.lower), I(x.upper)); }
  static I from_decimal(const std::string& text) {
    const auto number = checker::parse_decimal(text);
    if (!number) throw std::invalid_argument(text);
    return I(*number);
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
    }
  }
};

}  // namespace testing
}  // namespace taut
