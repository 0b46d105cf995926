// SPDX-License-Identifier: GPL-3.0-or-later
// The enclosing scalars that laws are typed over: how each is run, made and read.
#pragma once

#include <string>

#include "certify/arithmetic/interval.h"
#include "certify/arithmetic/mp_interval.h"
#include "tests/support/exact.h"

namespace taut::testing {

/// Interval under run_upward().
struct Fast {
  using I = Interval;
  static constexpr mpfr_prec_t kBits = 53;
  static I make(const Operand& x) { return {x.lower, x.upper}; }
  static I from_decimal(const std::string& text) { return ScalarTraits<I>::from_decimal(text); }
  static I pi() { return ScalarTraits<I>::pi(); }
  /// @returns whether `function` raised no fault.
  template <class F>
  static bool run(F&& function) {
    return run_upward(function);
  }
};

template <class Scalar, mpfr_prec_t Bits>
struct Multiprecision {
  using I = Scalar;
  static constexpr mpfr_prec_t kBits = Bits;
  static I make(const Operand& x) { return {x.lower, x.upper}; }
  static I from_decimal(const std::string& text) { return ScalarTraits<I>::from_decimal(text); }
  static I pi() { return ScalarTraits<I>::pi(); }
  template <class F>
  static bool run(F&& function) {
    const PrecisionScope precision(Bits);
    Faults<I>::clear();
    function();
    return !Faults<I>::raised();
  }
};
using Mp53 = Multiprecision<MpInterval, 53>;
using Mp128 = Multiprecision<MpInterval, 128>;
using Mp512 = Multiprecision<MpInterval, 512>;
/// The slow twin of Interval.
using Twin = Multiprecision<BoostInterval<double>, 53>;

inline BigFloat lower_end(const Interval& x) { return BigFloat(x.lower()); }
inline BigFloat upper_end(const Interval& x) { return BigFloat(x.upper()); }
inline BigFloat lower_end(const MpInterval& x) { return x.lower(); }
inline BigFloat upper_end(const MpInterval& x) { return x.upper(); }
inline BigFloat lower_end(const BoostInterval<double>& x) { return BigFloat(x.lower()); }
inline BigFloat upper_end(const BoostInterval<double>& x) { return BigFloat(x.upper()); }

template <class I>
bool holds(const I& enclosure, const BigFloat& value) {
  return lower_end(enclosure) <= value && value <= upper_end(enclosure);
}
/// As holds(), for a value known to within `error`.
template <class I>
bool holds(const I& enclosure, const BigFloat& value, const BigFloat& error) {
  return lower_end(enclosure) <= value + error && value - error <= upper_end(enclosure);
}
template <class I>
std::string print(const I& x) {
  return std::string("[").append(digits(lower_end(x))) + ", " + digits(upper_end(x)) + "]";
}
template <class I>
double spread(const I& x) {
  return BigFloat::apply_rounded(MPFR_RNDU, mpfr_sub, upper_end(x), lower_end(x)).to_double(MPFR_RNDU);
}

}  // namespace taut::testing
