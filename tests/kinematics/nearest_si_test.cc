// SPDX-License-Identifier: GPL-3.0-or-later
#include "problem/nearest_si.h"

#include <fmt/format.h>
#include <gtest/gtest.h>
#include <mpfr.h>

#include <cfenv>
#include <cmath>
#include <random>

#include "base/input_error.h"
#include "certify/arithmetic/big_float.h"

namespace taut {
namespace {

/// By MPFR, at 4096 bits, with ties (which no irrational number is) left to chance.
double by_mpfr(const std::string& text, const Unit& unit) {
  const PrecisionScope precision(4096);
  BigFloat value, other;
  mpfr_set_str(value.get(), text.c_str(), 10, MPFR_RNDN);
  if (unit.is_degree) {
    mpfr_const_pi(other.get(), MPFR_RNDN);
    mpfr_mul(value.get(), value.get(), other.get(), MPFR_RNDN);
    mpfr_div_ui(value.get(), value.get(), 180, MPFR_RNDN);
  } else {
    const Decimal exact = Decimal::parse(text) * unit.factor;
    mpfr_set_str(value.get(), exact.text().c_str(), 10, MPFR_RNDN);
  }
  return value.to_double(MPFR_RNDN);
}

TEST(NearestSi, IsTheNearestBinary64) {
  std::mt19937_64 random(5);
  const auto pick = [&](int n) { return std::uniform_int_distribution<int>(0, n - 1)(random); };
  for (const char* name : {"m", "mm", "cm", "km", "in", "ft", "rad", "deg"}) {
    const Unit unit = *find_unit(name);
    const NearestSi to_si(unit);
    for (int trial = 0; trial < 3'000; ++trial) {
      std::string digits = std::to_string(pick(10));
      for (int n = pick(trial % 10 == 0 ? 60 : 17); n > 0; --n) digits += std::to_string(pick(10));
      if (pick(2) == 0) digits.insert(static_cast<std::size_t>(pick(static_cast<int>(digits.size()))), ".");
      if (pick(3) == 0) digits += fmt::format("e{}", pick(40) - 20);
      if (pick(2) == 0) digits.insert(0, "-");
      const double expected = by_mpfr(digits, unit) + 0.0;
      const double seen = to_si(digits);
      ASSERT_EQ(seen, expected) << digits << " " << name;
      ASSERT_EQ(std::signbit(seen), std::signbit(expected)) << digits;
    }
  }
}

TEST(NearestSi, HoldsAtTheEndsOfTheRange) {
  for (const char* name : {"m", "deg"}) {
    const Unit unit = *find_unit(name);
    for (const char* text : {"1e-299", "-1e-299", "9.99e299", "0e500", "1000000000000000000000000000000000000000000"}) {
      EXPECT_EQ(NearestSi(unit)(text), by_mpfr(text, unit) + 0.0) << text << " " << name;
    }
  }
}

TEST(NearestSi, DecidesDegreesNextToATie) {
  // The decimal next to m·180/pi with m halfway between two binary64, to 90 digits: below and above it.
  const NearestSi degrees(*find_unit("deg"));
  const PrecisionScope precision(600);
  BigFloat tie(1.0), pi;
  mpfr_add_d(tie.get(), tie.get(), 0x1p-53, MPFR_RNDN);
  mpfr_const_pi(pi.get(), MPFR_RNDN);
  mpfr_mul_ui(tie.get(), tie.get(), 180, MPFR_RNDN);
  mpfr_div(tie.get(), tie.get(), pi.get(), MPFR_RNDN);
  char* text = nullptr;
  mpfr_asprintf(&text, "%.90RDf", tie.get());
  EXPECT_EQ(degrees(text), 1.0);
  mpfr_free_str(text);
  mpfr_asprintf(&text, "%.90RUf", tie.get());
  EXPECT_EQ(degrees(text), 1.0 + 0x1p-52);
  mpfr_free_str(text);
}

TEST(NearestSi, DoesNotDependOnTheRoundingMode) {
  const NearestSi degrees(*find_unit("deg")), inches(*find_unit("in"));
  const double expected = degrees("34"), length = inches("1.1");
  for (const int mode : {FE_UPWARD, FE_DOWNWARD, FE_TOWARDZERO}) {
    std::fesetround(mode);
    EXPECT_EQ(degrees("34"), expected);
    EXPECT_EQ(inches("1.1"), length);
    std::fesetround(FE_TONEAREST);
  }
}

TEST(NearestSi, ReadsDecimalsOnly) {
  const NearestSi metres(si_unit(Dimension::kLength));
  EXPECT_EQ(metres("+1.5E+1"), 15);
  EXPECT_EQ(metres(".5"), 0.5);
  EXPECT_EQ(metres("5."), 5);
  for (const char* text : {"", "-", ".", "1.2.3", "1e", "1e+", "1e+-2", "0x1", "nan", "inf", "1 ", "1e301", "1f"}) {
    EXPECT_THROW((void)metres(text), InputError) << text;
  }
}

}  // namespace
}  // namespace taut
