// SPDX-License-Identifier: GPL-3.0-or-later
// Multiprecision intervals: precision, its mixing, and Boost's silent answers that would not be faults by themselves.
#include "certify/arithmetic/mp_interval.h"

#include <gtest/gtest.h>

#include <thread>

#include "tests/support/enclosing.h"

namespace taut::testing {
namespace {

TEST(MpInterval, WorksAtThePrecisionInScope) {
  EXPECT_EQ(working_precision(), 128);
  double coarse, fine;
  {
    const PrecisionScope precision(64);
    coarse = spread(MpInterval(1.0) / MpInterval(3.0));
  }
  {
    const PrecisionScope precision(256);
    fine = spread(MpInterval(1.0) / MpInterval(3.0));
  }
  EXPECT_EQ(working_precision(), 128);
  EXPECT_GT(coarse, 1e-21);
  EXPECT_LT(coarse, 1e-19);
  EXPECT_GT(fine, 0.0);
  EXPECT_LT(fine, 1e-76);
}

TEST(MpInterval, EachThreadHasItsOwnPrecision) {
  const PrecisionScope precision(256);
  mpfr_prec_t other = 0;
  std::thread([&] { other = working_precision(); }).join();
  EXPECT_EQ(other, 128);
}

// Constants are made at one precision and used at another: they must be rounded outward, never silently to nearest.
TEST(MpInterval, FinerOperandsAreRoundedOutward) {
  MpInterval third;
  {
    const PrecisionScope precision(256);
    third = MpInterval(1.0) / MpInterval(3.0);
  }
  const PrecisionScope precision(53);
  const auto check = [&](const MpInterval& x, double factor) {
    const PrecisionScope exact(kExactBits);
    EXPECT_TRUE(holds(x, BigFloat(factor) / BigFloat(3.0))) << print(x);
  };
  check(third, 1);
  check(-third, -1);
  check(-(-third), 1);
  check(third + MpInterval(0.0), 1);
  check(third * MpInterval(1.0), 1);
  check(MpInterval(0.0) - third, -1);
  check(hull(third, third), 1);
  check(third + third, 2);
  EXPECT_LE(lower_bound(third), 1.0 / 3.0);
  EXPECT_LT(lower_bound(third), upper_bound(third));
}

// Boost.Interval clips the negative part of an operand of sqrt: sqrt([−1, 4]) = [0, 2], and no word of it.
TEST(MpInterval, RootOfAPartlyNegativeIntervalIsAFault) {
  Faults<MpInterval>::clear();
  (void)sqrt(MpInterval(-1.0, 4.0));
  EXPECT_TRUE(Faults<MpInterval>::raised());
  Faults<BoostInterval<double>>::clear();
  (void)sqrt(BoostInterval<double>(-1.0, 4.0));
  EXPECT_TRUE(Faults<BoostInterval<double>>::raised());
  Faults<MpInterval>::clear();
}

// Boost.Interval has 0 / [−1, 1] = 0, also where the divisor is 0.
TEST(MpInterval, ZeroOverAnIntervalWithZeroIsAFault) {
  for (const auto& [lower, upper] : {std::pair(-1.0, 1.0), std::pair(0.0, 1.0), std::pair(-1.0, 0.0)}) {
    Faults<MpInterval>::clear();
    (void)(MpInterval(0.0) / MpInterval(lower, upper));
    EXPECT_TRUE(Faults<MpInterval>::raised());
  }
  Faults<MpInterval>::clear();
}

TEST(MpInterval, TwinOverflowsAsAFault) {
  Faults<BoostInterval<double>>::clear();
  (void)(BoostInterval<double>(1e200) * BoostInterval<double>(1e200));
  EXPECT_TRUE(Faults<BoostInterval<double>>::raised());
  Faults<BoostInterval<double>>::clear();
}

TEST(MpInterval, BoundsAsDoublesAreOutward) {
  const MpInterval third = MpInterval(1.0) / MpInterval(3.0);
  EXPECT_LT(lower_bound(third), upper_bound(third));
  EXPECT_EQ(std::nextafter(lower_bound(third), 1.0), upper_bound(third));
  EXPECT_TRUE(certainly_positive(third));
  EXPECT_FALSE(certainly_nonpositive(third));
  EXPECT_TRUE(certainly_nonpositive(MpInterval(-1.0, 0.0)));
  EXPECT_FALSE(certainly_positive(MpInterval(0.0, 1.0)));
}

TEST(BigFloat, NegationAndMagnitudeKeepTheDigits) {
  BigFloat third;
  {
    const PrecisionScope precision(256);
    third = BigFloat(1.0) / BigFloat(3.0);
  }
  const PrecisionScope precision(53);
  const BigFloat back = -(-third);
  EXPECT_TRUE(back == third);
  EXPECT_TRUE(abs(-third) == third);
  BigFloat copy = BigFloat(1.0);
  copy = third;
  EXPECT_TRUE(copy == third);
  EXPECT_FALSE(third + BigFloat(0.0) == third) << "arithmetic is at the working precision";
}

}  // namespace
}  // namespace taut::testing
