// SPDX-License-Identifier: GPL-3.0-or-later
#include "checker/format/exact.h"

#include <gtest/gtest.h>

#include <cmath>
#include <cstdio>
#include <limits>

namespace taut::checker {
namespace {

TEST(Exact, ADecimalIsTheRationalThatWasTyped) {
  EXPECT_EQ(parse_decimal("0.05"), mpq_class(1, 20));
  EXPECT_EQ(parse_decimal("-0.0210"), mpq_class(-21, 1000));
  EXPECT_EQ(parse_decimal("1e-4"), mpq_class(1, 10000));
  EXPECT_EQ(parse_decimal("1.25E+2"), mpq_class(125));
  EXPECT_EQ(parse_decimal("007"), mpq_class(7));
  EXPECT_EQ(parse_decimal(".5"), mpq_class(1, 2));
  EXPECT_EQ(parse_decimal("2."), mpq_class(2));
  EXPECT_EQ(parse_decimal("-0"), mpq_class(0));
  EXPECT_EQ(*parse_decimal("1e400") * *parse_decimal("1e-400"), 1);
  EXPECT_EQ(*parse_decimal("1e1000") * *parse_decimal("1e-1000"), 1);
}

TEST(Exact, ARationalIsADecimalOrAFraction) {
  EXPECT_EQ(parse_rational("-0.0210"), mpq_class(-21, 1000));
  EXPECT_EQ(parse_rational("-1/36"), mpq_class(-1, 36));
  EXPECT_EQ(parse_rational("010/04"), mpq_class(5, 2));
  EXPECT_EQ(parse_rational("0/5"), mpq_class(0));
  EXPECT_EQ(*parse_rational("1/" + std::string(300, '9')) * *parse_rational(std::string(300, '9') + "/1"), 1);
  for (const std::string text : {"", "/", "1/", "/2", "1/0", "1/-2", "1/2/3", "1 /2", "1/2 ", "+1/2", "--1/2", "1.5/2",
                                 "1/2.5", "1e2/3", "0x1/2", "nan/1"}) {
    EXPECT_FALSE(parse_rational(text)) << text;
  }
  EXPECT_FALSE(parse_rational("1/1" + std::string(300, '0')));
  EXPECT_FALSE(parse_rational("1" + std::string(300, '0') + "/1"));
}

TEST(Exact, RefusesWhatIsNoDecimal) {
  for (const std::string text : {"",
                                 "-",
                                 ".",
                                 "e5",
                                 "1e",
                                 "1e+",
                                 "1e-",
                                 "1 ",
                                 " 1",
                                 "1,5",
                                 "nan",
                                 "inf",
                                 "0x1p0",
                                 "--1",
                                 "+1",
                                 "1e1001",
                                 "1e-1001",
                                 "1e+-1",
                                 "1e99999999999999999999",
                                 "1/2",
                                 "1.2.3",
                                 "1e1.0",
                                 "-.",
                                 ".e1",
                                 "١"}) {
    EXPECT_EQ(parse_decimal(text), std::nullopt) << text;
  }
  EXPECT_NE(parse_decimal(std::string(1000, '1')), std::nullopt);
  EXPECT_EQ(parse_decimal(std::string(1001, '1')), std::nullopt);
  EXPECT_EQ(parse_decimal(std::string("1\0", 2)), std::nullopt);
}

TEST(Exact, ADyadicIsInLowestTermsAndInTheUnitInterval) {
  EXPECT_EQ(parse_dyadic("0"), mpq_class(0));
  EXPECT_EQ(parse_dyadic("1"), mpq_class(1));
  EXPECT_EQ(parse_dyadic("3/8"), mpq_class(3, 8));
  EXPECT_EQ(parse_dyadic("1/1267650600228229401496703205376"), mpq_class(1, mpz_class(1) << 100));
  for (const std::string text :
       {"",   "2",  "0/1", "1/1",   "0/2",  "2/4",  "1/3",  "3/2", "-1/2", "1/-2", "1/02", "01/2",
        "1/", "/2", "/",   "1/2/4", "1/2 ", " 1/2", "1 /2", "0.5", "1/0",  "0/0",  "00"}) {
    EXPECT_EQ(parse_dyadic(text), std::nullopt) << text;
  }
  EXPECT_NE(parse_dyadic("1/" + mpz_class(mpz_class(1) << 1003).get_str()), std::nullopt);
  EXPECT_EQ(parse_dyadic("1/" + mpz_class(mpz_class(1) << 1004).get_str()), std::nullopt);
}

TEST(Exact, ABinary64ReadsBackBitForBit) {
  EXPECT_EQ(parse_binary64("-0x1.2666666666666p+1"), -2.3);
  EXPECT_EQ(parse_binary64("0x0p+0"), 0.0);
  EXPECT_TRUE(std::signbit(*parse_binary64("-0x0p+0")));
  EXPECT_EQ(parse_binary64("0x0.0000000000001p-1022"), std::numeric_limits<double>::denorm_min());
  EXPECT_EQ(parse_binary64("0x1.fffffffffffffp+1023"), std::numeric_limits<double>::max());
  for (const std::string text :
       {"",         "1.5",      "0x1.8p0",   "0x3p+0",    "0x1.80p+0", "0X1P+0", "0x1.26666666666668p+1",
        "0x1.8P+0", "0x1.Fp+0", "0x1p+1024", "0x1p-1075", "0x0.8p+1",  "inf",    "0xinf",
        "nan",      "-nan",     "0xnan",     " 0x1p+0",   "0x1p+0 ",   "0x1p",   "+0x1p+0",
        "--0x1p+0", "0x-1p+0",  "0x",        "-",         "1p+0"}) {
    EXPECT_EQ(parse_binary64(text), std::nullopt) << text;
  }
}

TEST(Exact, PrintsABinary64AsPrintfDoes) {
  for (const double x : {0.0, -0.0, 1.0, -2.3, 0.1, 1e-300, -1e300, 5e-324, -2.2250738585072009e-308, 0.34,
                         std::numeric_limits<double>::max(), std::numeric_limits<double>::min()}) {
    char expected[64];
    std::snprintf(expected, sizeof expected, "%a", x);
    EXPECT_EQ(print_binary64(x), expected);
    EXPECT_EQ(parse_binary64(expected), x);
  }
}

}  // namespace
}  // namespace taut::checker
