// SPDX-License-Identifier: GPL-3.0-or-later
#include "problem/rational.h"

#include <gtest/gtest.h>
#include <rapidcheck/gtest.h>

#include <string>

#include "base/input_error.h"

namespace taut {
namespace {

Rational fraction(long above, long below) { return {above, below}; }

TEST(Rational, ReadsDecimalsAndFractions) {
  EXPECT_EQ(parse_rational("0.125"), fraction(1, 8));
  EXPECT_EQ(parse_rational("-1/36"), fraction(-1, 36));
  EXPECT_EQ(parse_rational("010/4"), fraction(5, 2));
  EXPECT_EQ(parse_rational("0/7"), 0);
}

TEST(Rational, RejectsWhatIsNeither) {
  for (const char* text : {"", "/", "1/", "/2", "1/0", "1/-2", "+1/2", "--1/2", "1/2/3", "1.5/2", " 1/2", "1e3/2",
                           "0x1/2", "1 /2", "nan"}) {
    EXPECT_THROW(static_cast<void>(parse_rational(text)), InputError) << text;
  }
  EXPECT_THROW(static_cast<void>(parse_rational("1/" + std::string(301, '3'))), InputError);
}

TEST(Rational, WritesADecimalWhereThereIsOneAndElseLowestTerms) {
  EXPECT_EQ(rational_text(fraction(1, 8)), "0.125");
  EXPECT_EQ(rational_text(fraction(-2, 72)), "-1/36");
  EXPECT_EQ(rational_text(fraction(12'000, 1)), "12000");
  EXPECT_EQ(rational_text(fraction(0, 5)), "0");
  EXPECT_EQ(rational_text(Rational(1) / 3 * 3), "1");
}

TEST(Rational, RefusesToWriteWhatItCouldNotRead) {
  const Rational tiny = Rational(1) / boost::multiprecision::pow(boost::multiprecision::cpp_int(3), 700);
  EXPECT_THROW(static_cast<void>(rational_text(tiny)), InputError);
}

RC_GTEST_PROP(Rational, ReadsWhatItWrote, (long above, long below)) {
  RC_PRE(below != 0);
  const Rational value = Rational(above) / Rational(below);
  RC_ASSERT(parse_rational(rational_text(value)) == value);
  RC_ASSERT(rational_text(parse_rational(rational_text(value))) == rational_text(value));
}

TEST(Rational, EvaluatesExpressionsExactly) {
  EXPECT_EQ(evaluate_exactly("1/6^2"), fraction(1, 36));
  EXPECT_EQ(evaluate_exactly("0.1 + 0.2 - 0.3"), 0);
  EXPECT_EQ(evaluate_exactly("-2^2*(3 - 1)/7"), fraction(-8, 7));
  EXPECT_EQ(evaluate_exactly("10^-3"), fraction(1, 1000));
}

TEST(Rational, RefusesExpressionsWithoutAnExactValue) {
  for (const char* text : {"pi", "sqrt(4)", "sin(0)", "x", "1/(2 - 2)", "(2 - 2)^-1", "1 2", "", "(9^64)^64^2",
                           "((9^64)^64)^64", "atan2(1, 0)"}) {
    EXPECT_THROW(static_cast<void>(evaluate_exactly(text)), InputError) << text;
  }
}

RC_GTEST_PROP(Rational, RootsAreAboveAndNear, (unsigned long above, unsigned long below, bool is_large)) {
  RC_PRE(below != 0);
  Rational x = Rational(above) / Rational(below);
  if (is_large) x *= Rational(boost::multiprecision::pow(boost::multiprecision::cpp_int(10), 600));
  const Rational root = root_above(x);
  RC_ASSERT(root * root >= x);
  const Rational smaller = root * (1 - Rational(1, 1'000'000'000'000));
  RC_ASSERT(x == 0 || smaller * smaller < x);
}

TEST(Rational, IsTheNearestDoubleOfShortFractions) {
  EXPECT_EQ(from_rational<double>("1/3"), 1.0 / 3.0);
  EXPECT_EQ(from_rational<double>("-7/4"), -1.75);
  EXPECT_EQ(from_rational<double>("0.1"), 0.1);
}

}  // namespace
}  // namespace taut
