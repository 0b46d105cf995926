// SPDX-License-Identifier: GPL-3.0-or-later
#include "certify/arithmetic/big_float.h"

#include <gtest/gtest.h>

#include <utility>
#include <vector>

namespace taut {
namespace {

/// A third at this precision: all of its limbs are used.
BigFloat third(mpfr_prec_t bits) {
  const PrecisionScope precision(bits);
  return BigFloat(1.0) / BigFloat(3.0);
}

/// That `x` is the third of so many bits: MPFR's own number says so.
void expect_third(const BigFloat& x, mpfr_prec_t bits) {
  EXPECT_EQ(mpfr_get_prec(x.get()), bits);
  mpfr_t expected;
  mpfr_init2(expected, bits);
  mpfr_set_ui(expected, 1, MPFR_RNDN);
  mpfr_div_ui(expected, expected, 3, MPFR_RNDN);
  EXPECT_NE(mpfr_equal_p(x.get(), expected), 0);
  mpfr_clear(expected);
}

// In place, just in place, just on the heap, on the heap.
constexpr mpfr_prec_t kPrecisions[] = {53, 128, BigFloat::kInPlaceBits, BigFloat::kInPlaceBits + 1, 4096};

TEST(BigFloat, CopiesAndMovesAcrossPrecisionsAreValues) {
  for (const mpfr_prec_t from : kPrecisions) {
    const BigFloat x = third(from);
    expect_third(x, from);
    BigFloat copied(x);
    BigFloat moved(std::move(copied));
    expect_third(moved, from);
    copied = x;  // what was moved from may be assigned to
    expect_third(copied, from);
    for (const mpfr_prec_t to : kPrecisions) {
      BigFloat y = third(to);
      y = x;
      expect_third(y, from);
      BigFloat z = third(to);
      z = std::move(y);
      expect_third(z, from);
      std::swap(z, copied);
      expect_third(z, from);
      expect_third(copied, from);
    }
    expect_third(x, from);
  }
}

TEST(BigFloat, IsAssignedToItself) {
  for (const mpfr_prec_t bits : kPrecisions) {
    BigFloat x = third(bits);
    const BigFloat& same = x;
    x = same;
    expect_third(x, bits);
    BigFloat& mine = x;
    x = std::move(mine);
    expect_third(x, bits);
  }
}

TEST(BigFloat, KeepsItsLimbsWhereAVectorMovesIt) {
  std::vector<BigFloat> many;
  for (int k = 0; k < 1000; ++k) many.push_back(third(kPrecisions[static_cast<std::size_t>(k) % 5]));
  for (std::size_t k = 0; k < many.size(); ++k) expect_third(many[k], kPrecisions[k % 5]);
}

TEST(BigFloat, IsPrintedAsMpfrPrintsIt) {
  for (const double x : {0.0, -0.0, 1.0, -2.5, 9.9999999, 1e-5, 1e100, -1e-300, 5e-324}) {
    for (const int digits : {2, 6, 40}) {
      char* expected = nullptr;
      mpfr_asprintf(&expected, "%.*RDe", digits - 1, BigFloat(x).get());
      EXPECT_EQ(BigFloat(x).to_decimal(digits, MPFR_RNDD), expected);
      mpfr_free_str(expected);
      mpfr_asprintf(&expected, "%.*RUe", digits - 1, BigFloat(x).get());
      EXPECT_EQ(BigFloat(x).to_decimal(digits, MPFR_RNDU), expected);
      mpfr_free_str(expected);
    }
  }
}

TEST(BigFloat, CopiesOfZerosInfinitiesAndNaNKeepKindAndSignAndNaNIsAFault) {
  for (const mpfr_prec_t bits : kPrecisions) {
    const PrecisionScope precision(bits);
    const BigFloat one(1.0);
    const BigFloat minus_zero = -BigFloat(0.0);
    const BigFloat minus_infinity = -(one / BigFloat(0.0));
    BigFloat nan;
    mpfr_set_nan(nan.get());
    const BigFloat zero_copy = minus_zero;
    const BigFloat infinity_copy = minus_infinity;
    EXPECT_TRUE(mpfr_zero_p(zero_copy.get()) != 0 && mpfr_signbit(zero_copy.get()) != 0);
    EXPECT_TRUE(mpfr_inf_p(infinity_copy.get()) != 0 && mpfr_signbit(infinity_copy.get()) != 0);
    mpfr_clear_flags();
    const BigFloat nan_copy = nan;
    EXPECT_NE(mpfr_nan_p(nan_copy.get()), 0);
    EXPECT_NE(mpfr_nanflag_p(), 0) << "a fault";
    mpfr_clear_flags();
  }
}

}  // namespace
}  // namespace taut
