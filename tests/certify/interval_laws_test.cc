// SPDX-License-Identifier: GPL-3.0-or-later
// Laws of the prover's interval arithmetics, in the way of the tests of IEEE 1788 (ITF1788): a result contains the
// exact range, found by MPFR alone to 2100 bits (tests/support/interval_operations.h); it is at most a few ulps beyond
// it at either end; and it is a fault wherever some member of the operands is outside of the domain or the range
// overflows. Those of the checker's balls: tests/checker/ball_test.cc.
//
// There are no empty and no unbounded intervals here: where IEEE 1788 has them, these raise a fault.
//
// TAUT_INTERVAL_CASES=N: random cases an operation (the slow suite).
#include <gtest/gtest.h>

#include <algorithm>
#include <cstdlib>
#include <functional>
#include <vector>

#include "tests/support/interval_operations.h"

namespace taut::testing {
namespace {

template <class A>
class IntervalLaws : public ::testing::Test {
 protected:
  /// Holds f(a, b) to the law of Op.
  template <class Op>
  void expect_enclosure(const Operand& a, const Operand& b) {
    if (failures_ > 20) return;
    const auto where = [&] { return std::string(Op::kName) + " at " + hex(a) + ", " + hex(b); };
    const auto fail = [&](const std::string& what) {
      if (++failures_ <= 5) ADD_FAILURE() << what << ": " << where();
    };
    typename A::I result;
    const bool sound = A::run([&] { result = Op::apply(A::make(a), A::make(b)); });
    ++cases_;
    if (sound) ++sound_;
    const PrecisionScope precision(kOracleBits);
    if (!Op::defined(a, b)) {
      if (sound) fail("undefined for a member, yet no fault");
      return;
    }
    const Range range = Op::range(a, b);
    const bool is_extreme =
        extreme(a) || (Op::kOperands == 2 && extreme(b)) || extreme(range.lower) || extreme(range.upper);
    if (!sound) {
      if (!is_extreme && !Op::kMayGiveUp) fail("a fault within the domain");
      return;
    }
    const BigFloat lower = lower_end(result);
    const BigFloat upper = upper_end(result);
    if (!finite(lower) || !finite(upper)) return fail("no fault, yet " + print(result));
    if (!(lower <= range.lower && range.upper <= upper)) {
      return fail("the range from " + digits(range.lower) + " to " + digits(range.upper) + " is not in " +
                  print(result));
    }
    if (!is_extreme) {
      const double ulps =
          std::max(ulps_beyond(lower, range.lower, A::kBits), ulps_beyond(upper, range.upper, A::kBits));
      if (ulps > Op::kUlps) fail(std::to_string(ulps) + " ulps beyond the range");
    }
  }

  template <class Op>
  void expect_enclosures() {
    Operands operands(20261121);
    cases_ = sound_ = failures_ = 0;
    for (int n = 0; n < random_cases(); ++n) {
      const Operand a = random_operand<Op>(operands);
      expect_enclosure<Op>(a, Op::kOperands == 2 ? operands.interval() : a);
    }
    EXPECT_GT(sound_, cases_ / 8) << Op::kName;
    for (const Operand& a : directed_operands()) {
      if (Op::kOperands == 1) expect_enclosure<Op>(a, a);
    }
    if (Op::kOperands == 1) return;
    // All pairs of points, and of others a share that differs from operation to operation.
    const std::size_t points = 94;
    for (std::size_t i = 0; i < directed_operands().size(); i += i < points ? 1 : 7) {
      for (std::size_t k = i % 5; k < directed_operands().size(); k += i < points && k < points ? 3 : 17) {
        expect_enclosure<Op>(directed_operands()[i], directed_operands()[k]);
      }
    }
  }

  int failures_ = 0;
  int cases_ = 0;
  int sound_ = 0;
};

using Arithmetics = ::testing::Types<Fast, Mp53, Mp128, Mp512, Twin>;
struct ArithmeticNames {
  template <class A>
  static std::string GetName(int i) {
    static const char* const kNames[] = {"Interval", "Mp53", "Mp128", "Mp512", "BoostDouble"};
    return kNames[i];
  }
};
TYPED_TEST_SUITE(IntervalLaws, Arithmetics, ArithmeticNames);

TYPED_TEST(IntervalLaws, OperationsEncloseTheirRange) {
  for_each_operation([&]<class Op>() { this->template expect_enclosures<Op>(); });
}

// The oracle is right: points of a box have their values in the range, as MPFR rounds them to nearest; and ranges that
// can be told by hand are those.
TEST(IntervalOracle, HoldsTheValuesOfMembers) {
  Operands operands(7);
  const PrecisionScope precision(kOracleBits);
  for_each_operation([&]<class Op>() {
    for (int n = 0; n < 500; ++n) {
      const Operand a = random_operand<Op>(operands);
      const Operand b = operands.interval();
      if (!Op::defined(a, b)) continue;
      const Range range = Op::range(a, b);
      for (int k = 0; k < 4; ++k) {
        const BigFloat value = Op::apply(BigFloat(operands.inside(a)), BigFloat(operands.inside(b)));
        ASSERT_TRUE(range.lower <= value && value <= range.upper) << Op::kName << hex(a) << hex(b);
      }
    }
  });
}

template <class Op>
void expect_range(Operand a, Operand b, double lower, double upper) {
  const PrecisionScope precision(kOracleBits);
  ASSERT_TRUE(Op::defined(a, b)) << Op::kName << hex(a) << hex(b);
  const Range range = Op::range(a, b);
  EXPECT_EQ(range.lower.to_double(MPFR_RNDD), lower) << Op::kName << hex(a) << hex(b);
  EXPECT_EQ(range.upper.to_double(MPFR_RNDU), upper) << Op::kName << hex(a) << hex(b);
}

TEST(IntervalOracle, KnowsWhatIsKnown) {
  const Operand none{0, 0};
  expect_range<Add>({1, 2}, {3, 4}, 4, 6);
  expect_range<Subtract>({1, 2}, {3, 4}, -3, -1);
  expect_range<Multiply>({-1, 2}, {-3, 4}, -6, 8);
  expect_range<Multiply>({0, 0}, {-1e308, 1e308}, 0, 0);
  expect_range<Divide>({-1, 2}, {-4, -0.5}, -4, 2);
  expect_range<Reciprocal>({0.5, 4}, none, 0.25, 2);
  expect_range<Negate>({-1, 3}, none, -3, 1);
  expect_range<Square>({-1, 3}, none, 0, 9);
  expect_range<Square>({-3, -2}, none, 4, 9);
  expect_range<Root>({4, 9}, none, 2, 3);
  expect_range<Power<0>>({-1, 3}, none, 1, 1);
  expect_range<Power<2>>({-2, 1}, none, 0, 4);
  expect_range<Power<3>>({-2, 1}, none, -8, 1);
  expect_range<Power<-1>>({-2, -1}, none, -1, -0.5);
  expect_range<Power<-2>>({-2, -1}, none, 0.25, 1);
  expect_range<Power<-3>>({1, 2}, none, 0.125, 1);
  expect_range<Sine>({0, 2}, none, 0, 1);
  expect_range<Sine>({-2, 0}, none, -1, 0);
  expect_range<Sine>({3, 5}, none, -1, 0x1.210386db6d55cp-3);
  expect_range<Sine>({0, 7}, none, -1, 1);
  expect_range<Sine>({1e22, 1e22}, none, -0x1.b453ab76bf398p-1, -0x1.b453ab76bf397p-1);
  expect_range<Sine>({0x1.921fb54442d18p+0, 0x1.921fb54442d19p+0}, none, 0x1.fffffffffffffp-1, 1);
  expect_range<Cosine>({-1, 1}, none, 0x1.14a280fb5068bp-1, 1);
  expect_range<Cosine>({3, 4}, none, -1, -0x1.4eaa606db24c0p-1);
  expect_range<Cosine>({0, 0}, none, 1, 1);
  expect_range<Tangent>({-1, 1}, none, -0x1.8eb245cbee3a6p+0, 0x1.8eb245cbee3a6p+0);
  expect_range<Exponential>({0, 1}, none, 1, 0x1.5bf0a8b14576ap+1);
  expect_range<Logarithm>({1, 2}, none, 0, 0x1.62e42fefa39f0p-1);
  expect_range<Arcsine>({-1, 1}, none, -0x1.921fb54442d19p+0, 0x1.921fb54442d19p+0);
  expect_range<Arccosine>({-1, 1}, none, 0, 0x1.921fb54442d19p+1);
  expect_range<Arctangent>({-1, 1}, none, -0x1.921fb54442d19p-1, 0x1.921fb54442d19p-1);
  expect_range<Angle>({-1, 1}, {1, 2}, -0x1.921fb54442d19p-1, 0x1.921fb54442d19p-1);
  expect_range<Angle>({1, 1}, {-1, 0}, 0x1.921fb54442d18p+0, 0x1.2d97c7f3321d3p+1);
  for (const Operand& pole : {Operand{1.5, 1.6}, Operand{-1.6, -1.5}, Operand{0, 10}, Operand{1e22, 1.1e22}}) {
    EXPECT_FALSE(Tangent::defined(pole, none)) << hex(pole);
  }
}

TYPED_TEST(IntervalLaws, ThinProductsEnclose) {
  using I = typename TypeParam::I;
  if constexpr (requires(I x) { 2.0 * x; }) {
    Operands operands(2);
    for (int n = 0; n < 10'000; ++n) {
      const double x = operands.point();
      const Operand a = operands.interval();
      I result;
      // A number of the ends' type times an interval.
      const bool sound = TypeParam::run([&] {
        if constexpr (std::is_same_v<I, MpInterval>) {
          result = BigFloat(x) * TypeParam::make(a);
        } else {
          result = x * TypeParam::make(a);
        }
      });
      if (!sound) continue;
      const PrecisionScope precision(kOracleBits);
      const Range range = Multiply::range({x, x}, a);
      ASSERT_TRUE(lower_end(result) <= range.lower && range.upper <= upper_end(result))
          << hex(x) << " * " << hex(a) << " gave " << print(result);
    }
  }
}

TYPED_TEST(IntervalLaws, HullsAndIntersectionsAreExact) {
  using I = typename TypeParam::I;
  Operands operands(4);
  for (int n = 0; n < 10'000; ++n) {
    const Operand a = operands.interval();
    const Operand b = operands.interval();
    I joined, meet;
    ASSERT_TRUE(TypeParam::run([&] { joined = hull(TypeParam::make(a), TypeParam::make(b)); }));
    ASSERT_TRUE(lower_end(joined) == BigFloat(std::min(a.lower, b.lower)) &&
                upper_end(joined) == BigFloat(std::max(a.upper, b.upper)));
    const bool met = TypeParam::run([&] { meet = intersect(TypeParam::make(a), TypeParam::make(b)); });
    const double lower = std::max(a.lower, b.lower);
    const double upper = std::min(a.upper, b.upper);
    ASSERT_EQ(met, lower <= upper) << hex(a) << hex(b);
    ASSERT_TRUE(!met || (lower_end(meet) == BigFloat(lower) && upper_end(meet) == BigFloat(upper)));
  }
}

TYPED_TEST(IntervalLaws, RationalOperationsAreInclusionIsotone) {
  using I = typename TypeParam::I;
  Operands operands(5);
  const std::vector<std::function<I(const I&, const I&)>> operations = {
      [](const I& a, const I& b) { return I(a + b); }, [](const I& a, const I& b) { return I(a - b); },
      [](const I& a, const I& b) { return I(a * b); }, [](const I& a, const I& b) { return I(a / b); },
      [](const I& a, const I&) { return I(sqr(a)); },  [](const I& a, const I&) { return I(sqrt(a)); }};
  for (int n = 0; n < 10'000; ++n) {
    const Operand a = operands.interval();
    const Operand b = operands.interval();
    const double a1 = operands.inside(a), a2 = operands.inside(a);
    const double b1 = operands.inside(b), b2 = operands.inside(b);
    for (const auto& f : operations) {
      I inner, outer;
      if (!TypeParam::run([&] { outer = f(TypeParam::make(a), TypeParam::make(b)); })) continue;
      ASSERT_TRUE(TypeParam::run([&] {
        inner = f(TypeParam::make({std::min(a1, a2), std::max(a1, a2)}),
                  TypeParam::make({std::min(b1, b2), std::max(b1, b2)}));
      })) << hex(a)
          << hex(b);
      ASSERT_TRUE(lower_end(outer) <= lower_end(inner) && upper_end(inner) <= upper_end(outer)) << hex(a) << hex(b);
    }
  }
}

TYPED_TEST(IntervalLaws, DecimalsEncloseTheTypedNumber) {
  using I = typename TypeParam::I;
  std::vector<std::string> texts = {"0",
                                    "-0",
                                    "0.1",
                                    "-0.0210",
                                    "1e-4",
                                    "34",
                                    "1e22",
                                    "1e23",
                                    "2.5e-3",
                                    "1e-400",
                                    "-1e-320",
                                    "0.3",
                                    "1.0000000000000001110223024625156540",
                                    "9007199254740993",
                                    "123456789012345678901234567890",
                                    "4.9e-324",
                                    "2e-324",
                                    "1.7976931348623157e308",
                                    "2.2250738585072011e-308",
                                    "-190.5256e-3"};
  Operands operands(6);
  for (int n = 0; n < 2000; ++n) {
    texts.push_back((operands.coin(0.5) ? "-" : "") + std::to_string(operands.pick(1000)) + "." +
                    std::to_string(operands.pick(1'000'000'000)) + "e" + std::to_string(operands.pick(40) - 20));
  }
  for (const std::string& text : texts) {
    I result;
    ASSERT_TRUE(TypeParam::run([&] { result = TypeParam::from_decimal(text); }));
    const PrecisionScope precision(kOracleBits);
    BigFloat below, above;
    mpfr_set_str(below.get(), text.c_str(), 10, MPFR_RNDD);
    mpfr_set_str(above.get(), text.c_str(), 10, MPFR_RNDU);
    ASSERT_TRUE(lower_end(result) <= below && above <= upper_end(result)) << text << " gave " << print(result);
    if (!extreme(below)) {
      ASSERT_LE(ulps_beyond(lower_end(result), below, TypeParam::kBits), 1.0) << text;
      ASSERT_LE(ulps_beyond(upper_end(result), above, TypeParam::kBits), 1.0) << text;
    }
  }
  for (const char* text : {"", "x", "1e", "0.1.2"}) {
    EXPECT_THROW((void)TypeParam::from_decimal(text), std::invalid_argument) << text;
  }
}

TYPED_TEST(IntervalLaws, PiIsOneUlpWide) {
  using I = typename TypeParam::I;
  I pi;
  ASSERT_TRUE(TypeParam::run([&] { pi = TypeParam::pi(); }));
  const PrecisionScope precision(kOracleBits);
  const BigFloat value = ScalarTraits<BigFloat>::pi();  // no rounding of which is an end of fewer bits
  EXPECT_TRUE(holds(pi, value)) << print(pi);
  EXPECT_LE(ulps_beyond(lower_end(pi), value, TypeParam::kBits), 1.0);
  EXPECT_LE(ulps_beyond(upper_end(pi), value, TypeParam::kBits), 1.0);
}

TYPED_TEST(IntervalLaws, LeavingADomainIsAFault) {
  using I = typename TypeParam::I;
  const auto faults = [](auto f) {
    I result;
    return !TypeParam::run([&] { result = f(); });
  };
  const auto make = [](double lower, double upper) { return TypeParam::make({lower, upper}); };
  const auto point = [](double x) { return TypeParam::make({x, x}); };
  const double tiny = std::numeric_limits<double>::denorm_min();
  for (const Operand zero : {Operand{0, 0}, Operand{-0.0, -0.0}, Operand{-1, 1}, Operand{0, 1}, Operand{-1, 0},
                             Operand{-tiny, tiny}, Operand{-1, -0.0}}) {
    const I divisor = make(zero.lower, zero.upper);
    EXPECT_TRUE(faults([&] { return point(1.0) / divisor; })) << hex(zero);
    EXPECT_TRUE(faults([&] { return point(0.0) / divisor; })) << "0 / " << hex(zero);
    EXPECT_TRUE(faults([&] { return reciprocal(divisor); })) << hex(zero);
    EXPECT_TRUE(faults([&] { return pow_int(divisor, -2); })) << hex(zero);
  }
  EXPECT_TRUE(faults([&] { return sqrt(make(-1.0, 4.0)); }));
  EXPECT_TRUE(faults([&] { return sqrt(make(-tiny, 4.0)); }));
  EXPECT_TRUE(faults([&] { return sqrt(make(-4.0, -1.0)); }));
  EXPECT_FALSE(faults([&] { return sqrt(make(0.0, 4.0)); }));
  EXPECT_FALSE(faults([&] { return sqrt(make(-0.0, 4.0)); }));
  EXPECT_TRUE(faults([&] { return log(make(0.0, 1.0)); }));
  EXPECT_TRUE(faults([&] { return log(make(-1.0, 1.0)); }));
  EXPECT_TRUE(faults([&] { return atan2(point(0.0), point(-1.0)); }));
  EXPECT_TRUE(faults([&] { return atan2(point(-0.0), point(-1.0)); }));
  EXPECT_TRUE(faults([&] { return atan2(point(0.0), point(0.0)); }));
  EXPECT_TRUE(faults([&] { return atan2(make(-1.0, 1.0), make(-1.0, 1.0)); }));
  EXPECT_TRUE(faults([&] { return atan2(make(0.0, 1.0), make(-1.0, 1.0)); }));
  EXPECT_TRUE(faults([&] { return atan2(make(-1.0, -0.0), make(-1.0, 1.0)); }));
  EXPECT_FALSE(faults([&] { return atan2(make(-1.0, 1.0), make(0.5, 1.0)); }));
  EXPECT_FALSE(faults([&] { return atan2(make(0.5, 1.0), make(-1.0, 1.0)); }));
  EXPECT_FALSE(faults([&] { return atan2(make(-1.0, -0.5), make(-1.0, 1.0)); }));
  EXPECT_TRUE(faults([&] { return intersect(make(0.0, 1.0), make(2.0, 3.0)); }));
  EXPECT_TRUE(faults([&] { return tan(make(1.5, 1.6)); }));
  for (const double beyond : {0x1.0000000000001p+0, -0x1.0000000000001p+0, 2.0, -1e300}) {
    EXPECT_TRUE(faults([&] { return asin(point(beyond)); })) << beyond;
    EXPECT_TRUE(faults([&] { return acos(hull(point(beyond), point(0.5))); })) << beyond;
  }
  EXPECT_FALSE(faults([&] { return asin(make(-1.0, 1.0)) + acos(make(-1.0, 1.0)); }));
}

TYPED_TEST(IntervalLaws, OverflowIsAFault) {
  using I = typename TypeParam::I;
  I result = TypeParam::make({1e300, 1e300});
  EXPECT_FALSE(TypeParam::run([&] {
    for (int n = 0; n < 64; ++n) result = result * result;  // beyond any exponent range
  }));
  EXPECT_FALSE(TypeParam::run([&] { result = exp(exp(TypeParam::make({100.0, 100.0}))); }));
}

// Calls into MPFR and back set and restore the rounding mode.
TYPED_TEST(IntervalLaws, AFaultStaysRaised) {
  using I = typename TypeParam::I;
  const auto point = [](double x) { return TypeParam::make({x, x}); };
  I result;
  EXPECT_FALSE(TypeParam::run([&] {
    result = reciprocal(TypeParam::make({-1.0, 1.0}));
    result = exp(point(1.0)) + log(point(2.0)) + atan2(point(1.0), point(2.0)) + asin(point(0.5)) + acos(point(0.5)) +
             atan(point(0.5)) + Sine::apply(point(1e5), point(0)) + TypeParam::from_decimal("1");
  }));
  EXPECT_TRUE(TypeParam::run([&] { result = point(1.0) + point(2.0); })) << "the next run starts without faults";
}

TYPED_TEST(IntervalLaws, QuestionsAreAnsweredForEveryMember) {
  Operands operands(8);
  const auto ask = [](const Operand& x) {
    const auto interval = TypeParam::make(x);
    EXPECT_EQ(certainly_positive(interval), x.lower > 0) << hex(x);
    EXPECT_EQ(certainly_nonpositive(interval), x.upper <= 0) << hex(x);
    EXPECT_EQ(lower_bound(interval), x.lower) << hex(x);
    EXPECT_EQ(upper_bound(interval), x.upper) << hex(x);
    EXPECT_TRUE(magnitude(interval) == std::max(std::abs(x.lower), std::abs(x.upper))) << hex(x);
    EXPECT_TRUE(extreme(x) || contains(interval, midpoint_approx(interval))) << hex(x);
  };
  const auto compare = [](const Operand& x, const Operand& y) {
    const auto a = TypeParam::make(x);
    EXPECT_EQ(contains(a, y.lower), x.lower <= y.lower && y.lower <= x.upper) << hex(x) << hex(y);
  };
  (void)TypeParam::run([&] {
    for (const Operand& x : directed_operands()) {
      ask(x);
      compare(x, operands.interval());
      compare(x, x);
    }
    for (int n = 0; n < 3000; ++n) {
      ask(operands.interval());
      compare(operands.interval(), operands.interval());
    }
  });
}

}  // namespace
}  // namespace taut::testing
