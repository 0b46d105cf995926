// SPDX-License-Identifier: GPL-3.0-or-later
// The floating-point environment: set, kept, restored; and the measured reasons why it is handled as it is.
#include "certify/arithmetic/rounding.h"

#include <gtest/gtest.h>
#include <mpfr.h>

// Boost's own transcendentals, for the comparison below: never with mp_interval.h, whose functions they would rival.
#include <boost/numeric/interval.hpp>
#include <cfenv>
#include <cmath>
#include <random>
#include <thread>
#include <vector>

#include "certify/arithmetic/interval.h"

namespace taut {
namespace {

volatile double one = 1.0;
volatile double tiny = 1e-17;
volatile double three = 3.0;
volatile double zero = 0.0;

/// +1, 0 or −1: how this thread rounds, told from a sum and a difference.
int direction() {
  const double sum = one + tiny;
  const double difference = one - tiny;
  return sum > 1.0 ? 1 : difference < 1.0 ? -1 : 0;
}

TEST(Rounding, SelfTestPasses) { EXPECT_NO_THROW(rounding_self_test()); }

TEST(Rounding, RunsUpwardAndRestoresTheCallersMode) {
  for (const int mode : {FE_TONEAREST, FE_DOWNWARD, FE_TOWARDZERO, FE_UPWARD}) {
    std::fesetround(mode);
    const int before = direction();
    int inside = 0;
    const bool sound = run_upward([&] { inside = direction(); });
    const int after = direction();
    const int mode_after = std::fegetround();
    std::fesetround(FE_TONEAREST);
    EXPECT_TRUE(sound);
    EXPECT_EQ(inside, 1);
    EXPECT_EQ(after, before);
    EXPECT_EQ(mode_after, mode);
  }
}

TEST(Rounding, OutlastsTheReadingOfADecimal) {
  int after = 0;
  double tenth = 0;
  const bool sound = run_upward([&] {
    tenth = ScalarTraits<double>::from_decimal("0.1");
    after = direction();
  });
  EXPECT_TRUE(sound);
  EXPECT_EQ(tenth, 0.1);
  EXPECT_EQ(after, 1);
}

TEST(Rounding, RestoresTheCallersModeAfterAnException) {
  std::fesetround(FE_DOWNWARD);
  bool thrown = false;
  try {
    (void)run_upward([] { throw std::runtime_error("x"); });
  } catch (const std::runtime_error&) {
    thrown = true;
  }
  const int after = std::fegetround();
  std::fesetround(FE_TONEAREST);
  EXPECT_TRUE(thrown);
  EXPECT_EQ(after, FE_DOWNWARD);
}

TEST(Rounding, ReportsInvalidDivisionByZeroAndOverflow) {
  volatile double huge = 1e300;
  volatile double result = 0;
  EXPECT_FALSE(run_upward([&] { result = zero / zero; }));
  EXPECT_FALSE(run_upward([&] { result = one / zero; }));
  EXPECT_FALSE(run_upward([&] { result = huge * huge; }));
  EXPECT_FALSE(run_upward([&] { result = std::sqrt(-one); }));
  EXPECT_TRUE(run_upward([&] { result = one / three; })) << "inexact is no fault";
  volatile double small = 1e-300;
  EXPECT_TRUE(run_upward([&] { result = small * small; })) << "underflow is no fault";
}

TEST(Rounding, StartsWithoutTheCallersFaultsAndHandsThemBack) {
  Faults<Interval>::clear();
  Faults<Interval>::raise();
  const bool sound = run_upward([] {});
  const bool kept = Faults<Interval>::raised();
  Faults<Interval>::clear();
  EXPECT_TRUE(sound);
  EXPECT_TRUE(kept);
}

TEST(Rounding, AnInnerRunNeitherLosesNorAddsFaultsOfTheOuter) {
  bool inner = true;
  const bool outer_faulted = run_upward([&] {
    Faults<Interval>::raise();
    inner = run_upward([] {});
  });
  EXPECT_TRUE(inner);
  EXPECT_FALSE(outer_faulted);
  int after = 0;
  const bool outer_sound = run_upward([&] {
    inner = run_upward([] { Faults<Interval>::raise(); });
    after = direction();
  });
  EXPECT_FALSE(inner);
  EXPECT_TRUE(outer_sound);
  EXPECT_EQ(after, 1);
}

TEST(Rounding, ANearestGuardKeepsEarlierFaultsAndTheMode) {
  int within = 2;
  int after = 0;
  const bool sound = run_upward([&] {
    Faults<Interval>::raise();
    {
      const rounding_detail::NearestGuard nearest;
      within = direction();
    }
    after = direction();
  });
  EXPECT_EQ(within, 0);
  EXPECT_EQ(after, 1);
  EXPECT_FALSE(sound);
}

TEST(Rounding, EachThreadHasItsOwnMode) {
  constexpr int kThreads = 4;
  std::vector<int> wrong(kThreads, 0);
  std::vector<std::thread> threads;
  for (int t = 0; t < kThreads; ++t) {
    threads.emplace_back([t, &wrong] {
      std::fesetround(t % 2 == 0 ? FE_DOWNWARD : FE_TONEAREST);
      const int outside = t % 2 == 0 ? -1 : 0;
      int& count = wrong[static_cast<std::size_t>(t)];
      for (int n = 0; n < 20'000; ++n) {
        int inside = 0;
        Interval third;
        const bool sound = run_upward([&] {
          inside = direction();
          third = Interval(one) / Interval(three) + sincos(Interval(n)).sin * Interval(zero);
        });
        const bool encloses = third.lower() < third.upper() && third.upper() - third.lower() < 1e-15;
        if (!sound || inside != 1 || direction() != outside || !encloses) ++count;
      }
      mpfr_free_cache2(MPFR_FREE_LOCAL_CACHE);  // what the table of sines left to this thread
    });
  }
  for (std::thread& thread : threads) thread.join();
  EXPECT_EQ(wrong, std::vector<int>(kThreads, 0));
}

// ---- Why it is done this way ---------------------------------------------------------------------------------------

bool cosine_is_in(double x, double lower, double upper) {
  mpfr_t c;
  mpfr_init2(c, 200);
  mpfr_set_d(c, x, MPFR_RNDN);
  mpfr_cos(c, c, MPFR_RNDN);
  const bool inside = mpfr_cmp_d(c, lower) >= 0 && mpfr_cmp_d(c, upper) <= 0;
  mpfr_clear(c);
  return inside;
}

// Boost.Interval's transcendentals set the mode and call libm, which owes nothing to the mode.
TEST(Rounding, BoostsOwnCosineDoesNotEncloseAndOursDoes) {
  using namespace boost::numeric;
  using BoostsOwn =
      interval<double, interval_lib::policies<interval_lib::save_state<interval_lib::rounded_transc_std<double>>,
                                              interval_lib::checking_base<double>>>;
  std::mt19937_64 random(1);
  int boosts_misses = 0;
  int our_misses = 0;
  for (int n = 0; n < 100'000; ++n) {
    const double x = std::uniform_real_distribution<double>(0, 3)(random);
    const BoostsOwn boosts = cos(BoostsOwn(x));
    Interval ours;
    ASSERT_TRUE(run_upward([&] { ours = cos(Interval(x)); }));
    if (!cosine_is_in(x, boosts.lower(), boosts.upper())) ++boosts_misses;
    if (!cosine_is_in(x, ours.lower(), ours.upper())) ++our_misses;
  }
  RecordProperty("boosts_misses_per_1e5", boosts_misses);
  EXPECT_GT(boosts_misses, 0) << "libm may have become correctly rounded";
  EXPECT_EQ(our_misses, 0);
}

// g++ 12.2 with -frounding-math corrupts static constexpr arrays of double made from literals of long double
// (boostorg/math issue 1133). Arrays from literals of double, the only kind in certify/, are what they say.
TEST(Rounding, ConstantArraysOfDoublesAreWhatTheySay) {
  static constexpr double kArray[] = {0.1, 0.2, 0x1.5555555555555p-3, 3.14159265358979323846, 1.0 / 3.0};
  const char* const texts[] = {"0.1", "0.2", "0x1.5555555555555p-3", "3.14159265358979323846"};
  for (std::size_t i = 0; i < std::size(texts); ++i) {
    volatile double stored = kArray[i];
    mpfr_t value;
    mpfr_init2(value, 53);
    mpfr_strtofr(value, texts[i], nullptr, 0, MPFR_RNDN);
    const double expected = mpfr_get_d(value, MPFR_RNDN);
    EXPECT_EQ(stored, expected) << texts[i];
    mpfr_clear(value);
  }
}

}  // namespace
}  // namespace taut
