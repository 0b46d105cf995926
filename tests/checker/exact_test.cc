// SPDX-License-Identifier: GPL-3.0-or-later
#include "checker/exact.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "checker/kernel/errors.h"

namespace taut::checker {
namespace {

TEST(Exact, ADecimalIsTheRationalThatWasTyped) {
  EXPECT_EQ(parse_decimal("0.05", "x"), mpq_class(1, 20));
  EXPECT_EQ(parse_decimal("-0.0210", "x"), mpq_class(-21, 1000));
  EXPECT_EQ(parse_decimal("1e-4", "x"), mpq_class(1, 10000));
  EXPECT_EQ(parse_decimal("1.25E+2", "x"), 125);
  EXPECT_EQ(parse_decimal("007", "x"), 7);
  EXPECT_EQ(parse_decimal("-0", "x"), 0);
  EXPECT_EQ(parse_decimal("1e400", "x") * parse_decimal("1e-400", "x"), 1);
}

TEST(Exact, RefusesWhatIsNoDecimal) {
  for (const std::string text : {"", "-", ".", "e5", "1e", "1e+", "1 ", " 1", "1,5", "nan", "inf", "0x1p0", "--1",
                                 "1e1001", "1e99999999999999999999", "1/2", "1.2.3", "١"}) {
    EXPECT_THROW((void)parse_decimal(text, "x"), Malformed) << text;
  }
  EXPECT_THROW((void)parse_decimal(std::string(1001, '1'), "x"), Malformed);
  EXPECT_THROW((void)parse_decimal(std::string("1\0", 2), "x"), Malformed);
}

TEST(Exact, ADyadicIsInLowestTermsAndInTheUnitInterval) {
  EXPECT_EQ(parse_dyadic("0", "x"), 0);
  EXPECT_EQ(parse_dyadic("1", "x"), 1);
  EXPECT_EQ(parse_dyadic("3/8", "x"), mpq_class(3, 8));
  EXPECT_EQ(parse_dyadic("1/1267650600228229401496703205376", "x"), mpq_class(1, mpz_class(1) << 100));
  for (const std::string text : {"", "2", "0/1", "1/1", "0/2", "2/4", "1/3", "3/2", "-1/2", "1/02", "01/2", "1/", "/2",
                                 "1/2/4", "1/2 ", "0.5", "1/0"}) {
    EXPECT_THROW((void)parse_dyadic(text, "x"), Malformed) << text;
  }
}

TEST(Exact, ABinary64ReadsBackBitForBit) {
  EXPECT_EQ(parse_binary64("-0x1.2666666666666p+1", "x"), -2.3);
  EXPECT_EQ(parse_binary64("0x0p+0", "x"), 0);
  EXPECT_EQ(parse_binary64("0x0.0000000000001p-1022", "x"), std::numeric_limits<double>::denorm_min());
  EXPECT_EQ(parse_binary64("0x1.fffffffffffffp+1023", "x"), std::numeric_limits<double>::max());
  for (const std::string text : {"", "1.5", "0x1.8p0", "0x3p+0", "0x1.80p+0", "0X1P+0", "0x1.26666666666668p+1",
                                 "0x1p+1024", "inf", "nan", "-nan", " 0x1p+0", "0x1p+0 ", "0x1p", "+0x1p+0"}) {
    EXPECT_THROW((void)parse_binary64(text, "x"), Malformed) << text;
  }
}

}  // namespace
}  // namespace taut::checker
