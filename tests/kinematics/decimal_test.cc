// SPDX-License-Identifier: GPL-3.0-or-later
#include "problem/decimal.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <rapidcheck.h>

#include <cfenv>
#include <limits>

#include "base/input_error.h"
#include "problem/scalar.h"
#include "problem/units.h"

namespace taut {
namespace {

using boost::multiprecision::cpp_int;
using boost::multiprecision::cpp_rational;
using ::testing::HasSubstr;
using ::testing::ThrowsMessage;

std::string canonical(const std::string& text) { return Decimal::parse(text).text(); }

TEST(Decimal, HasOneTextForEachValue) {
  const std::vector<std::pair<std::string, std::string>> cases = {{"0", "0"},
                                                                  {"-0.000e7", "0"},
                                                                  {"0.220", "0.22"},
                                                                  {"+.5", "0.5"},
                                                                  {"5.", "5"},
                                                                  {"-007.50", "-7.5"},
                                                                  {"010", "10"},
                                                                  {"1e4", "10000"},
                                                                  {"1E+4", "10000"},
                                                                  {"1e-4", "0.0001"},
                                                                  {"1.25e-9", "1.25e-9"},
                                                                  {"1e-7", "0.0000001"},
                                                                  {"1e-8", "1e-8"},
                                                                  {"1e20", "100000000000000000000"},
                                                                  {"1e21", "1e21"},
                                                                  {"123e30", "1.23e32"},
                                                                  {"0e999", "0"},
                                                                  {"1e0000000000004", "10000"}};
  for (const auto& [typed, expected] : cases) EXPECT_EQ(canonical(typed), expected) << typed;
}

TEST(Decimal, RejectsWhatIsNoDecimal) {
  for (const char* text : {"", " ", "-", ".", "e5", "1e", "1e+", "1e5.5", "0x10", "1,5", "1 ", " 1", "--1", "nan",
                           "inf", ".inf", "1_000", "1.2.3", "٣"}) {
    EXPECT_THAT([&] { (void)Decimal::parse(text); }, ThrowsMessage<InputError>(HasSubstr("expected"))) << text;
  }
}

TEST(Decimal, RejectsTheHugeAndTheTiny) {
  EXPECT_EQ(canonical("9e299"), "9e299");
  EXPECT_EQ(canonical("1e-300"), "1e-300");
  const std::string many(Decimal::kMaxDigits + 1, '1');
  for (const std::string& text : {std::string("1e300"), std::string("9e-301"), std::string("1e99999999999999999999"),
                                  std::string("1e-2147483648"), many}) {
    EXPECT_THROW((void)Decimal::parse(text), InputError) << text;
  }
  EXPECT_THROW((void)(Decimal::parse("1e200") * Decimal::parse("1e200")), InputError);
}

TEST(Decimal, MultipliesExactly) {
  EXPECT_EQ((Decimal::parse("-190.5256") * Decimal::parse("0.001")).text(), "-0.1905256");
  EXPECT_EQ((Decimal::parse("0.6") * Decimal::parse("9.81")).text(), "5.886");
}

Decimal arbitrary_decimal() {
  const auto mantissa = *rc::gen::arbitrary<long long>();
  const int exponent = *rc::gen::inRange(-40, 40);
  return Decimal::parse(std::to_string(mantissa) + "e" + std::to_string(exponent));
}

TEST(DecimalLaws, TextReadsBackAsTheSameValue) {
  EXPECT_TRUE(rc::check([] {
    const Decimal x = arbitrary_decimal();
    RC_ASSERT(Decimal::parse(x.text()) == x);
    RC_ASSERT(canonical(x.text()) == x.text());
  }));
}

TEST(DecimalLaws, AgreesWithRationals) {
  EXPECT_TRUE(rc::check([] {
    const Decimal x = arbitrary_decimal();
    const Decimal y = arbitrary_decimal();
    RC_ASSERT((x * y).rational() == cpp_rational(x.rational() * y.rational()));
    RC_ASSERT((x < y) == (x.rational() < y.rational()));
    RC_ASSERT((x == y) == (x.rational() == y.rational()));
  }));
}

TEST(FromDecimal, IsTheNearestDoubleInAnyRoundingMode) {
  for (const int mode : {FE_TONEAREST, FE_UPWARD, FE_DOWNWARD, FE_TOWARDZERO}) {
    std::fesetround(mode);
    const double tenth = ScalarTraits<double>::from_decimal("0.1");
    const double limit = ScalarTraits<double>::from_decimal("-190.5256");
    const int kept = std::fegetround();
    std::fesetround(FE_TONEAREST);
    EXPECT_EQ(tenth, 0.1);
    EXPECT_EQ(limit, -190.5256);
    EXPECT_EQ(kept, mode);
  }
}

TEST(FromDecimal, IsAtMostHalfAnUlpAway) {
  EXPECT_TRUE(rc::check([] {
    const Decimal x = arbitrary_decimal();
    const double d = ScalarTraits<double>::from_decimal(x.text());
    const auto distance = [&](double value) { return cpp_rational(abs(cpp_rational(value) - x.rational())); };
    RC_ASSERT(distance(d) <= distance(std::nextafter(d, std::numeric_limits<double>::infinity())));
    RC_ASSERT(distance(d) <= distance(std::nextafter(d, -std::numeric_limits<double>::infinity())));
  }));
}

TEST(Units, ConvertExactly) {
  const auto to_si = [](const std::string& text) {
    const auto [value, unit] = split_unit(text);
    return decimal_to_si(value, unit.value());
  };
  EXPECT_EQ(to_si("350 mm"), "0.35");
  EXPECT_EQ(to_si("350mm"), "0.35");
  EXPECT_EQ(to_si("12 in"), to_si("1 ft"));
  EXPECT_EQ(to_si("1e3 km"), "1000000");
  EXPECT_EQ(to_si("2.5 MN"), "2500000");
  EXPECT_EQ(to_si("2.5 mN"), "0.0025");
  EXPECT_EQ(to_si("2 kN*mm"), "2");
  EXPECT_EQ(to_si("3 t"), "3000");
  EXPECT_EQ(to_si("34 deg"), "(34)*pi/180");
  EXPECT_EQ(to_si("0 deg"), "0");
  EXPECT_EQ(to_si("-1.5 rad"), "-1.5");
  EXPECT_EQ(to_si("5 deg/s"), "(5)*pi/180");
  EXPECT_EQ(to_si("5deg/s^2"), "(5)*pi/180");
  EXPECT_EQ(to_si("0.1 rad/s"), "0.1");
  EXPECT_EQ(to_si("80 cm/s^3"), "0.8");
  EXPECT_EQ(to_si("60 kW"), "60000");
  EXPECT_EQ(to_si("3 mW"), "0.003");
  EXPECT_EQ(to_si("0.1 kHz"), "100");
}

TEST(Units, AreSplitOnlyFromValues) {
  EXPECT_EQ(split_unit("alpha1 - pi rad").first, "alpha1 - pi");
  EXPECT_EQ(split_unit("(1+2)mm").first, "(1+2)");
  EXPECT_EQ(split_unit("20 m/min").second->dimension, Dimension::kSpeed);
  EXPECT_EQ(split_unit("20 min").second->dimension, Dimension::kTime);
  for (const char* text : {"zs - rs*sin", "r2m", "m", "x*m", "10"}) {
    EXPECT_FALSE(split_unit(text).second) << text;
  }
}

TEST(Units, OfSiHaveTheFactorOne) {
  for (int i = 0; i <= static_cast<int>(Dimension::kInertia); ++i) {
    const auto dimension = static_cast<Dimension>(i);
    const Unit unit = si_unit(dimension);
    EXPECT_EQ(unit.dimension, dimension) << unit.name;
    EXPECT_EQ(unit.factor.text(), "1") << unit.name;
    EXPECT_EQ(unit.divisor, 1) << unit.name;
    EXPECT_FALSE(unit.is_degree) << unit.name;
    EXPECT_TRUE(unit_names(dimension).starts_with(unit.name)) << "the first of messages";
    EXPECT_NE(dimension_name(dimension), std::string()) << unit.name;
  }
}

TEST(Units, WrapExpressions) {
  EXPECT_EQ(expression_to_si("a + b", *find_unit("mm")), "(a + b)*0.001");
  EXPECT_EQ(expression_to_si("a + b", *find_unit("m")), "a + b");
  EXPECT_EQ(expression_to_si("a + b", *find_unit("deg")), "(a + b)*pi/180");
}

}  // namespace
}  // namespace taut
