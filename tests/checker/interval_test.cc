// SPDX-License-Identifier: GPL-3.0-or-later
#include "checker/interval.h"

#include <gtest/gtest.h>

#include <functional>

#include "tests/checker/fixtures.h"

namespace taut::checker {
namespace {

constexpr int kTrials = 2000;

/// Two random rationals as the ends of an interval, and a third one in it.
struct Sample {
  Interval interval;
  mpq_class inside;
  explicit Sample(std::mt19937& random, int lower = -8, int upper = 8) {
    const mpq_class a = random_rational(random, lower, upper);
    const mpq_class b = random() % 4 == 0 ? a : random_rational(random, lower, upper);
    inside = a + (b - a) * random_rational(random, 0, 1);
    interval = hull(Interval(a), Interval(b));
  }
};

TEST(Interval, HoldsARationalThatIsNoBinaryNumber) {
  const Interval third(mpq_class(1, 3));
  EXPECT_LT(mpfr_cmp_q(third.lower(), mpq_class(1, 3).get_mpq_t()), 0);
  EXPECT_GT(mpfr_cmp_q(third.upper(), mpq_class(1, 3).get_mpq_t()), 0);
  EXPECT_LT(width(third), 1e-37);
}

TEST(Interval, HoldsTheExactResultOfRationalOperations) {
  std::mt19937 random(1);
  const WorkingPrecision coarse(24);  // so that nearly every operation has to round
  for (int trial = 0; trial < kTrials; ++trial) {
    const Sample x(random), y(random);
    const auto holds = [](const Interval& enclosure, const mpq_class& exact) {
      return mpfr_cmp_q(enclosure.lower(), exact.get_mpq_t()) <= 0 &&
             mpfr_cmp_q(enclosure.upper(), exact.get_mpq_t()) >= 0;
    };
    EXPECT_TRUE(holds(x.interval + y.interval, x.inside + y.inside));
    EXPECT_TRUE(holds(x.interval - y.interval, x.inside - y.inside));
    EXPECT_TRUE(holds(x.interval * y.interval, x.inside * y.inside));
    EXPECT_TRUE(holds(-x.interval, -x.inside));
    EXPECT_TRUE(holds(abs(x.interval), abs(x.inside)));
    EXPECT_TRUE(holds(sqr(x.interval), x.inside * x.inside));
    EXPECT_TRUE(holds(power(x.interval, 5), x.inside * x.inside * x.inside * x.inside * x.inside));
    EXPECT_TRUE(holds(max(x.interval, y.interval), std::max(x.inside, y.inside)));
    EXPECT_TRUE(holds(hull(x.interval, y.interval), y.inside));
    try {
      EXPECT_TRUE(holds(x.interval / y.interval, x.inside / y.inside));
      EXPECT_TRUE(holds(power(y.interval, -2), 1 / (y.inside * y.inside)));
    } catch (const Undefined&) {
      EXPECT_TRUE(contains(y.interval, Interval(0)));
    }
  }
}

TEST(Interval, HoldsTheValuesOfFunctionsAtThirtyTimesThePrecision) {
  struct Case {
    std::function<Interval(const Interval&)> function;
    int lower, upper;
  };
  const std::vector<Case> cases = {
      {[](const Interval& x) { return sin(x); }, -8, 8}, {[](const Interval& x) { return cos(x); }, -8, 8},
      {[](const Interval& x) { return exp(x); }, -8, 8}, {[](const Interval& x) { return atan(x); }, -8, 8},
      {[](const Interval& x) { return sqrt(x); }, 0, 8}, {[](const Interval& x) { return log(x); }, 1, 8}};
  std::mt19937 random(2);
  for (const Case& c : cases) {
    for (int trial = 0; trial < kTrials; ++trial) {
      const WorkingPrecision coarse(17);
      const Sample x(random, c.lower, c.upper);
      const Interval enclosure = c.function(x.interval);
      const WorkingPrecision fine(512);
      EXPECT_TRUE(contains(enclosure, c.function(Interval(x.inside))));
    }
  }
}

TEST(Interval, Atan2HoldsTheAngleInEveryQuadrant) {
  std::mt19937 random(3);
  int defined = 0;
  for (int trial = 0; trial < kTrials; ++trial) {
    const Sample x(random), y(random);
    try {
      const Interval enclosure = atan2(y.interval, x.interval);
      mpfr_t exact;  // by MPFR itself, not by our case distinction
      mpfr_init2(exact, 512);
      const WorkingPrecision fine(512);
      mpfr_atan2(exact, Interval(y.inside).lower(), Interval(x.inside).lower(), MPFR_RNDN);
      EXPECT_LE(mpfr_cmp(enclosure.lower(), exact), 0);
      EXPECT_GE(mpfr_cmp(enclosure.upper(), exact), 0);
      mpfr_clear(exact);
      ++defined;
    } catch (const Undefined&) {
    }
  }
  EXPECT_GT(defined, kTrials / 4);
}

TEST(Interval, Atan2IsUndefinedAtTheOriginAndAcrossItsCut) {
  EXPECT_THROW((void)atan2(Interval(0), Interval(0)), Undefined);
  EXPECT_THROW((void)atan2(Interval::plus_minus_one(), Interval(-1)), Undefined);
  EXPECT_TRUE(contains(atan2(Interval(0), Interval(-1)), Interval::pi()));
}

TEST(Interval, RefusesWhatItCannotBound) {
  EXPECT_THROW((void)(Interval(1) / Interval(0)), Undefined);
  EXPECT_THROW((void)(Interval(1) / Interval::plus_minus_one()), Undefined);
  EXPECT_THROW((void)sqrt(Interval::plus_minus_one()), Undefined);
  EXPECT_THROW((void)log(Interval(0)), Undefined);
  EXPECT_THROW((void)exp(exp(Interval(1000))), Undefined);
  EXPECT_THROW((void)sin(exp(Interval(100000))), Undefined);
}

TEST(Interval, ComparesInThreeValues) {
  const Interval both = Interval::plus_minus_one();
  EXPECT_FALSE(certainly_positive(both) || certainly_negative(both) || certainly_nonnegative(both) ||
               certainly_nonpositive(both));
  EXPECT_TRUE(certainly_nonnegative(Interval(0)) && certainly_nonpositive(Interval(0)));
  EXPECT_FALSE(certainly_positive(Interval(0)) || certainly_negative(Interval(0)));
  EXPECT_TRUE(certainly_positive(Interval(1)) && certainly_negative(Interval(-1)));
}

TEST(Interval, DisjointEnclosuresOfOneNumberAreAnInternalFault) {
  EXPECT_THROW((void)intersection(Interval(0), Interval(1)), std::logic_error);
}

TEST(Interval, WorkingPrecisionEndsWithItsScope) {
  const double before = width(Interval::pi());
  {
    const WorkingPrecision fine(512);
    EXPECT_LT(width(Interval::pi()), 1e-150);
  }
  EXPECT_EQ(width(Interval::pi()), before);
}

}  // namespace
}  // namespace taut::checker
