// SPDX-License-Identifier: GPL-3.0-or-later
// The fast interval: its packing, and its sine and cosine where they could go wrong.
#include "certify/arithmetic/interval.h"

#include <gtest/gtest.h>
#include <mpfr.h>

#include <cfenv>
#include <random>
#include <stdexcept>
#include <string>
#include <vector>

#include "base/input_error.h"
#include "tests/support/enclosing.h"

namespace taut::testing {
namespace {

TEST(Interval, KeepsItsEnds) {
  const Interval x(-1.5, 2.25);
  EXPECT_EQ(x.lower(), -1.5);
  EXPECT_EQ(x.upper(), 2.25);
  EXPECT_EQ(Interval(3.0).lower(), 3.0);
  EXPECT_EQ(Interval(3.0).upper(), 3.0);
  EXPECT_EQ(magnitude(x), 2.25);
  EXPECT_EQ(magnitude(-x), 2.25);
  EXPECT_TRUE(contains(x, -1.5));
  EXPECT_TRUE(contains(x, 2.25));
  EXPECT_FALSE(contains(x, 2.5));
}

TEST(Interval, RoundsBothEndsOutward) {
  Interval sum, product, quotient;
  ASSERT_TRUE(run_upward([&] {
    sum = Interval(1.0) + Interval(1e-17);
    product = Interval(0.1) * Interval(0.1);
    quotient = Interval(1.0) / Interval(10.0);
  }));
  EXPECT_EQ(sum.lower(), 1.0);
  EXPECT_EQ(sum.upper(), 1.0 + 0x1p-52);
  EXPECT_LT(product.lower(), product.upper());
  EXPECT_LT(quotient.lower(), quotient.upper());
}

TEST(Interval, RefusesDecimalsBeyondItsRange) {
  EXPECT_THROW((void)ScalarTraits<Interval>::from_decimal("1e400"), InputError);
  EXPECT_THROW((void)ScalarTraits<Interval>::from_decimal("-1.8e308"), InputError);
}

/// What MPFR makes of a decimal, rounded to binary64.
double by_mpfr(const std::string& text, mpfr_rnd_t direction) {
  mpfr_t value;
  mpfr_init2(value, 53);
  EXPECT_EQ(mpfr_set_str(value, text.c_str(), 10, direction), 0) << text;
  const double result = mpfr_get_d(value, direction);
  mpfr_clear(value);
  return result;
}

TEST(Interval, DecimalsAreTheNextNumbersBelowAndAboveInEveryRoundingMode) {
  std::mt19937_64 random(20);
  std::vector<std::string> texts = {"0",
                                    "-0",
                                    "0.0",
                                    "-0.000",
                                    "1",
                                    "-1",
                                    "5.",
                                    ".5",
                                    "-.5",
                                    "0.1",
                                    "9007199254740993",
                                    "999999999999999",
                                    "0.00000000000001",
                                    "0.000000000000000000001",
                                    "1e3",
                                    "-2.5e-7"};
  for (int k = 0; k < 4000; ++k) {
    std::string text = std::to_string(random() >> (random() % 64));
    if (text.size() > 17) text.resize(17);
    if (random() % 8 != 0) text.insert(random() % (text.size() + 1), ".");
    texts.push_back(random() % 2 == 0 ? "-" + text : text);
  }
  for (const std::string& text : texts) {
    const double lower = by_mpfr(text, MPFR_RNDD);
    const double upper = by_mpfr(text, MPFR_RNDU);
    for (const int mode : {FE_TONEAREST, FE_DOWNWARD, FE_TOWARDZERO, FE_UPWARD}) {
      std::fesetround(mode);
      const Interval x = ScalarTraits<Interval>::from_decimal(text);
      const int mode_after = std::fegetround();
      std::fesetround(FE_TONEAREST);
      EXPECT_EQ(mode_after, mode);
      EXPECT_EQ(x.lower(), lower) << text;
      EXPECT_EQ(x.upper(), upper) << text;
    }
  }
  for (const std::string text : {"", "-", ".", "1.2.3", "1a", "--1", "1-"}) {
    EXPECT_THROW((void)ScalarTraits<Interval>::from_decimal(text), std::invalid_argument) << text;
  }
}

TEST(Interval, ComparisonsNameTheirQuantifier) {
  EXPECT_TRUE(certainly_positive(Interval(0x1p-1074, 1.0)));
  EXPECT_FALSE(certainly_positive(Interval(0.0, 1.0)));
  EXPECT_TRUE(certainly_nonpositive(Interval(-1.0, 0.0)));
  EXPECT_TRUE(certainly_nonpositive(Interval(-1.0, -0.0)));
  EXPECT_FALSE(certainly_nonpositive(Interval(-1.0, 0x1p-1074)));
}

/// Widest of sin and cos over the points; counts those that are missed.
struct SineScan {
  double widest = 0;
  int misses = 0;
  double first_miss = 0;

  void at(double x) {
    SinCos<Interval> sc;
    const bool sound = run_upward([&] { sc = sincos(Interval(x)); });
    const PrecisionScope precision(kExactBits);
    const BigFloat exact(x);
    if (!sound || !holds(sc.sin, sin(exact)) || !holds(sc.cos, cos(exact))) {
      if (misses++ == 0) first_miss = x;
    }
    widest = std::max({widest, spread(sc.sin), spread(sc.cos)});
  }
};

TEST(Interval, SineAndCosineEncloseAndAreFourUlpsOfOneWide) {
  Operands operands(1);
  SineScan scan;
  for (int n = 0; n < 60'000; ++n) scan.at(operands.uniform(-8, 8));
  for (int n = 0; n < 10'000; ++n) scan.at(std::ldexp(operands.uniform(-1, 1), -operands.pick(1074)));
  EXPECT_EQ(scan.misses, 0) << hex(scan.first_miss);
  EXPECT_LE(scan.widest, 4 * 0x1p-52);
  RecordProperty("widest_ulps_of_one", std::to_string(std::ldexp(scan.widest, 52)));
}

// The table is read at the nearest multiple of 1/32; halfway between two of them the choice changes. Just below 1/64,
// rounding upward picks 1/32, and the distance to it is no binary64.
TEST(Interval, SineAndCosineEncloseWhereTheTableEntryChanges) {
  SineScan scan;
  for (int k = 0; k <= 8 * 64; ++k) {
    double below = k / 64.0;
    double above = k / 64.0;
    for (int n = 0; n < 8; ++n) {
      for (const double x : {below, above, -below, -above}) scan.at(x);
      below = std::nextafter(below, -10.0);
      above = std::nextafter(above, 10.0);
    }
  }
  EXPECT_EQ(scan.misses, 0) << hex(scan.first_miss);
  EXPECT_LE(scan.widest, 1e-13) << "the last few are beyond the table";
}

TEST(Interval, SineAndCosineEncloseNearMultiplesOfAQuarterTurn) {
  SineScan near, far;
  for (int k = -1000; k <= 1000; ++k) {
    double x = k * 1.5707963267948966;
    for (int n = 0; n < 3; ++n, x = std::nextafter(x, 1e9)) near.at(x);
  }
  for (int k = 1; k < 630'000; k += 701) far.at(k * 1.5707963267948966);
  EXPECT_EQ(near.misses, 0) << hex(near.first_miss);
  EXPECT_EQ(far.misses, 0) << hex(far.first_miss);
  EXPECT_LE(near.widest, 1e-12);
  EXPECT_LE(far.widest, 1e-9) << "an ulp of 2 pi a turn";
}

TEST(Interval, SineAndCosineOfHugeArgumentsAreUnknown) {
  for (const double x : {1e6, 1e22, -1e300, std::numeric_limits<double>::max()}) {
    SinCos<Interval> sc;
    EXPECT_TRUE(run_upward([&] { sc = sincos(Interval(x)); }));
    EXPECT_EQ(sc.sin.lower(), -1.0);
    EXPECT_EQ(sc.cos.upper(), 1.0);
  }
}

// Every extremum within an interval counts, also where it lies an ulp inside an end.
TEST(Interval, SineAndCosineOfWideIntervalsReachTheirExtrema) {
  Operands operands(2);
  for (int n = 0; n < 20'000; ++n) {
    const double center = operands.pick(11) * 1.5707963267948966 - 7.853981633974483;
    double lower = center - (operands.coin(0.5) ? operands.uniform(0, 1.6) : operands.pick(3) * 0x1p-51);
    double upper = center + (operands.coin(0.5) ? operands.uniform(0, 1.6) : operands.pick(3) * 0x1p-51);
    SinCos<Interval> sc;
    ASSERT_TRUE(run_upward([&] { sc = sincos(Interval(lower, upper)); }));
    const PrecisionScope precision(kExactBits);
    for (const double x : {lower, center, upper, operands.inside({lower, upper})}) {
      ASSERT_TRUE(holds(sc.sin, sin(BigFloat(x))) && holds(sc.cos, cos(BigFloat(x)))) << hex(Operand{lower, upper});
    }
    ASSERT_GE(sc.sin.lower(), -1.0 - 0x1p-50);
    ASSERT_LE(sc.cos.upper(), 1.0 + 0x1p-50);
  }
}

TEST(Interval, MonotonePiecesAreAsTightAsTheirEnds) {
  SinCos<Interval> sc;
  ASSERT_TRUE(run_upward([&] { sc = sincos(Interval(0.25, 1.25)); }));
  EXPECT_NEAR(sc.sin.lower(), std::sin(0.25), 1e-15);
  EXPECT_NEAR(sc.sin.upper(), std::sin(1.25), 1e-15);
  EXPECT_NEAR(sc.cos.lower(), std::cos(1.25), 1e-15);
  EXPECT_NEAR(sc.cos.upper(), std::cos(0.25), 1e-15);
}

TEST(Interval, AgreesWithItsTwinOverMpfr) {
  Operands operands(3);
  const PrecisionScope precision(53);
  for (int n = 0; n < 20'000; ++n) {
    const Operand a{operands.uniform(-5, 0), operands.uniform(0, 5)};
    const Operand b{operands.uniform(0.5, 1), operands.uniform(1, 5)};
    Interval fast;
    ASSERT_TRUE(run_upward([&] {
      const Interval x(a.lower, a.upper), y(b.lower, b.upper);
      fast = (x * y - sqr(x)) * sqrt(y) + exp(y) * log(y) - atan2(y, x);
    }));
    const BoostInterval<double> x(a.lower, a.upper), y(b.lower, b.upper);
    const BoostInterval<double> slow = (x * y - sqr(x)) * sqrt(y) + exp(y) * log(y) - atan2(y, x);
    ASSERT_LE(fast.lower(), slow.upper());
    ASSERT_LE(slow.lower(), fast.upper());
    const double scale = std::max(std::abs(slow.lower()), std::abs(slow.upper()));
    ASSERT_NEAR(fast.lower(), slow.lower(), 1e-14 * scale);
    ASSERT_NEAR(fast.upper(), slow.upper(), 1e-14 * scale);
  }
}

}  // namespace
}  // namespace taut::testing
