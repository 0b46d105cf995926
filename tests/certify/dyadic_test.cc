// SPDX-License-Identifier: GPL-3.0-or-later
#include "certify/arithmetic/dyadic.h"

#include <gtest/gtest.h>

#include <cmath>
#include <random>

#include "certify/arithmetic/rounding.h"

namespace taut {
namespace {

using boost::multiprecision::cpp_int;

cpp_int random_number(std::mt19937_64& random, int bits) {
  cpp_int k = 0;
  for (int have = 0; have < bits; have += 64) k = (k << 64) + random();
  return k & ((cpp_int(1) << bits) - 1);
}

/// Exact at this precision, for depths up to it.
BigFloat exact(const Dyadic& x) {
  BigFloat result;
  mpfr_set_str(result.get(), x.k.str().c_str(), 10, MPFR_RNDN);
  mpfr_div_2si(result.get(), result.get(), x.depth, MPFR_RNDN);
  return result;
}

TEST(Dyadic, IsWrittenInLowestTerms) {
  EXPECT_EQ((Dyadic{0, 0}).text(), "0");
  EXPECT_EQ((Dyadic{0, 7}).text(), "0");
  EXPECT_EQ((Dyadic{1, 0}).text(), "1");
  EXPECT_EQ((Dyadic{8, 3}).text(), "1");
  EXPECT_EQ((Dyadic{6, 4}).text(), "3/8");
  EXPECT_EQ((Dyadic{1, 52}).text(), "1/4503599627370496");
  EXPECT_EQ((Dyadic{1, 70}).text(), "1/1180591620717411303424");
}

TEST(Dyadic, IsComparedAsANumber) {
  EXPECT_EQ((Dyadic{1, 1}), (Dyadic{2, 2}));
  EXPECT_LT((Dyadic{1, 2}), (Dyadic{1, 1}));
  EXPECT_LT((Dyadic{1, 1}), (Dyadic{(cpp_int(1) << 199) + 1, 200}));
  EXPECT_GT((Dyadic{1, 1}), (Dyadic{(cpp_int(1) << 199) - 1, 200}));
}

TEST(Dyadic, IsTheNearestOfItsDepth) {
  EXPECT_EQ(Dyadic::nearest(BigFloat(0.3), 2), (Dyadic{1, 2}));
  EXPECT_EQ(Dyadic::nearest(BigFloat(0.4), 2), (Dyadic{2, 2}));
  EXPECT_EQ(Dyadic::nearest(BigFloat(-0.4), 5), (Dyadic{0, 0}));
  EXPECT_EQ(Dyadic::nearest(BigFloat(7.0), 5), (Dyadic{1, 0}));
  const PrecisionScope precision(512);
  const Dyadic fine{(cpp_int(1) << 400) / 3, 400};
  EXPECT_EQ(Dyadic::nearest(exact(fine), 400), fine);
  EXPECT_EQ(Dyadic::nearest(exact(fine), 3), (Dyadic{3, 3}));
}

TEST(DyadicBox, HasExactEndsAndHalvesThatMeet) {
  const DyadicBox box{5, 3};
  EXPECT_EQ(box.lower().approx(), 0.625);
  EXPECT_EQ(box.upper().approx(), 0.75);
  EXPECT_EQ(box.mid().approx(), 0.6875);
  EXPECT_EQ(box.radius(), 0.0625);
  EXPECT_EQ(box.left().lower(), box.lower());
  EXPECT_EQ(box.left().upper(), box.mid());
  EXPECT_EQ(box.right().lower(), box.mid());
  EXPECT_EQ(box.right().upper(), box.upper());
}

/// The binary64 fast path, the one beyond it, and MPFR where it can and where it can't hold the numbers.
TEST(DyadicBox, IsEnclosedAtEveryDepth) {
  std::mt19937_64 random(1);
  for (const int depth : {0, 1, 5, 30, 51, 52, 53, 54, 64, 65, 100, 300, 998, DyadicBox::kMaxDepth}) {
    for (int trial = 0; trial < 100; ++trial) {
      cpp_int k = random_number(random, depth);
      if (trial == 0) k = 0;
      if (trial == 1) k = (cpp_int(1) << depth) - 1;
      if (trial == 2 && depth > 60) k = (cpp_int(1) << 60) - 1;  // rounds up to a power of two
      const DyadicBox box{k, depth};
      EnclosedBox<Interval> fast;
      ASSERT_TRUE(run_upward([&] { fast = enclose<Interval>(box); }));
      const PrecisionScope precision(DyadicBox::kMaxDepth + 2);
      const BigFloat lower = exact(box.lower());
      const BigFloat upper = exact(box.upper());
      const BigFloat mid = exact(box.mid());
      const auto expect = [&](const auto& enclosure, const char* which) {
        EXPECT_LE(BigFloat(enclosure.range.lower()), lower) << which << " " << k << "/2^" << depth;
        EXPECT_GE(BigFloat(enclosure.range.upper()), upper) << which << " " << k << "/2^" << depth;
        EXPECT_LE(BigFloat(enclosure.mid.lower()), mid) << which << " " << k << "/2^" << depth;
        EXPECT_GE(BigFloat(enclosure.mid.upper()), mid) << which << " " << k << "/2^" << depth;
      };
      expect(fast, "binary64");
      const double width = fast.mid.upper() - fast.mid.lower();
      EXPECT_LE(width, fast.mid.upper() * 0x1p-52);
      if (depth <= 52) {
        EXPECT_EQ(width, 0);
        EXPECT_EQ(fast.mid.upper(), box.mid().approx());
        EXPECT_EQ(fast.range.lower(), box.lower().approx());
        EXPECT_EQ(fast.range.upper(), box.upper().approx());
      }
      for (const mpfr_prec_t bits : {64, 128, 1001}) {
        EnclosedBox<MpInterval> fine;
        {
          const PrecisionScope coarse(bits);
          fine = enclose<MpInterval>(box);
        }
        expect(fine, "MPFR");
        EXPECT_TRUE(depth >= bits || fine.mid.lower() == fine.mid.upper()) << "exact where it can be";
      }
    }
  }
}

}  // namespace
}  // namespace taut
