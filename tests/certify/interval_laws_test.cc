// Laws of every enclosing scalar: results contain the exact value, leave no domain silently, and are tight.
#include <gtest/gtest.h>

#include <algorithm>
#include <functional>
#include <vector>

#include "tests/support/enclosing.h"

namespace taut::testing {
namespace {

// ---- Operations ------------------------------------------------------------------------------------------------------
// kUlps bounds the width of a result of thin operands, in ulps of the result. kMayGiveUp allows faults inside the domain.

struct Operation {
  static constexpr double kUlps = 1;
  static constexpr bool kMayGiveUp = false;
  static constexpr bool kCostly = false;
  static bool defined(const Operand&, const Operand&) { return true; }
};
struct Add : Operation {
  template <class S>
  static S apply(const S& a, const S& b) {
    return a + b;
  }
};
struct Subtract : Operation {
  template <class S>
  static S apply(const S& a, const S& b) {
    return a - b;
  }
};
struct Multiply : Operation {
  template <class S>
  static S apply(const S& a, const S& b) {
    return a * b;
  }
};
bool holds_zero(const Operand& x) { return x.lower <= 0 && x.upper >= 0; }
struct Divide : Operation {
  static constexpr double kUlps = 4;  // Interval multiplies by a reciprocal
  static bool defined(const Operand&, const Operand& b) { return !holds_zero(b); }
  template <class S>
  static S apply(const S& a, const S& b) {
    return a / b;
  }
};
struct Square : Operation {
  template <class S>
  static S apply(const S& a, const S&) {
    return sqr(a);
  }
};
struct Root : Operation {
  static constexpr double kUlps = 2;  // one too many where the root is exact
  static bool defined(const Operand& a, const Operand&) { return a.lower >= 0; }
  template <class S>
  static S apply(const S& a, const S&) {
    return sqrt(a);
  }
};
struct Sine : Operation {
  static constexpr bool kCostly = true;
  static constexpr double kUlps = 1e300;  // near a zero the width is bounded in ulps of 1; interval_test.cc
  template <class S>
  static S apply(const S& a, const S&) {
    return sincos(a).sin;
  }
};
struct Cosine : Sine {
  template <class S>
  static S apply(const S& a, const S&) {
    return sincos(a).cos;
  }
};
struct Tangent : Sine {
  static constexpr bool kMayGiveUp = true;  // near a pole
  template <class S>
  static S apply(const S& a, const S&) {
    return tan(a);
  }
  static bool defined(const Operand& a, const Operand&) {
    // The number of poles below each end.
    const PrecisionScope precision(1400);
    const auto turns = [](double x) {
      BigFloat n = BigFloat(x) / ScalarTraits<BigFloat>::pi() + BigFloat(0.5);
      mpfr_floor(n.get(), n.get());
      return n;
    };
    return turns(a.lower) == turns(a.upper);
  }
};
struct Exponential : Operation {
  static constexpr bool kCostly = true;
  template <class S>
  static S apply(const S& a, const S&) {
    return exp(a);
  }
};
struct Logarithm : Operation {
  static constexpr bool kCostly = true;
  static bool defined(const Operand& a, const Operand&) { return a.lower > 0; }
  template <class S>
  static S apply(const S& a, const S&) {
    return log(a);
  }
};
struct Angle : Operation {
  static constexpr bool kCostly = true;
  static bool defined(const Operand& y, const Operand& x) { return !(holds_zero(y) && x.lower <= 0); }
  template <class S>
  static S apply(const S& y, const S& x) {
    return atan2(y, x);
  }
};
template <int N>
struct Power : Operation {
  static constexpr double kUlps = N > 0 ? 2 * N : -2 * N + 2;
  static bool defined(const Operand& a, const Operand&) { return N >= 0 || !holds_zero(a); }
  template <class S>
  static S apply(const S& a, const S&) {
    return pow_int(a, N);
  }
};

// ---- The law ---------------------------------------------------------------------------------------------------------

bool extreme(const BigFloat& x) {
  const BigFloat size = abs(x);
  return size > BigFloat(1e290) || (size < BigFloat(1e-290) && size != BigFloat(0.0));
}
bool extreme(const Operand& x) { return extreme(BigFloat(x.lower)) || extreme(BigFloat(x.upper)); }

/// Width in ulps of `value`.
template <class I>
double ulps(const I& x, const BigFloat& value, mpfr_prec_t bits) {
  BigFloat width = upper_end(x) - lower_end(x);
  mpfr_mul_2si(width.get(), width.get(), bits - mpfr_get_exp(value.get()), MPFR_RNDU);
  return width.to_double(MPFR_RNDU);
}

template <class A>
class IntervalLaws : public ::testing::Test {
 protected:
  static typename A::I make(const Operand& x) { return {x.lower, x.upper}; }

  template <class Op>
  void expect_enclosures() {
    constexpr int kSamples = Op::kCostly ? A::kSamples / 4 : A::kSamples;
    Operands operands(20261121);
    double widest = 0;
    int failures = 0;
    int sound_results = 0;
    const auto fail = [&](const std::string& what) {
      if (++failures <= 3) ADD_FAILURE() << what;
    };
    for (int n = 0; n < kSamples && failures < 100; ++n) {
      const Operand a = operands.interval();
      const Operand b = operands.interval();
      typename A::I result;
      const bool sound = A::run([&] { result = Op::apply(make(a), make(b)); });
      const auto where = [&] { return hex(a) + ", " + hex(b); };
      if (!Op::defined(a, b)) {
        if (sound) fail("undefined, yet no fault, at " + where());
        continue;
      }
      const PrecisionScope precision(kExactBits);
      BigFloat value;
      bool may_overflow = extreme(a) || extreme(b);
      if (!sound) {
        for (const double x : {a.lower, a.upper}) {
          for (const double y : {b.lower, b.upper}) {
            may_overflow = may_overflow || extreme(Op::apply(BigFloat(x), BigFloat(y)));
          }
        }
      }
      for (int k = 0; k < (a.thin() && b.thin() ? 1 : 4); ++k) {
        const BigFloat x(k == 0 ? a.lower : operands.inside(a));
        const BigFloat y(k == 0 ? b.upper : operands.inside(b));
        value = Op::apply(x, y);
        may_overflow = may_overflow || extreme(value);
        if (sound && !holds(result, value)) {
          fail("f(" + digits(x) + ", " + digits(y) + ") = " + digits(value) + " is not in " + print(result) + " = f(" +
               where() + ")");
        }
      }
      if (!sound) {
        if (!may_overflow && !Op::kMayGiveUp) fail("a fault within the domain, at " + where());
        continue;
      }
      ++sound_results;
      if (a.thin() && b.thin() && !may_overflow && mpfr_regular_p(value.get()) != 0) {
        const double w = ulps(result, value, A::kBits);
        if (w > widest) widest = w;
        if (w > Op::kUlps) fail("width of " + std::to_string(w) + " ulps at " + where());
      }
    }
    EXPECT_GT(sound_results, kSamples / 8);
    this->RecordProperty("widest_ulps", std::to_string(widest));
  }
};

using Arithmetics = ::testing::Types<Fast, Mp53, Mp128, Twin>;
struct ArithmeticNames {
  template <class A>
  static std::string GetName(int i) {
    static const char* const kNames[] = {"Interval", "Mp53", "Mp128", "BoostDouble"};
    return kNames[i];
  }
};
TYPED_TEST_SUITE(IntervalLaws, Arithmetics, ArithmeticNames);

TYPED_TEST(IntervalLaws, SumsEnclose) { this->template expect_enclosures<Add>(); }
TYPED_TEST(IntervalLaws, DifferencesEnclose) { this->template expect_enclosures<Subtract>(); }
TYPED_TEST(IntervalLaws, ProductsEnclose) { this->template expect_enclosures<Multiply>(); }
TYPED_TEST(IntervalLaws, QuotientsEnclose) { this->template expect_enclosures<Divide>(); }
TYPED_TEST(IntervalLaws, SquaresEnclose) { this->template expect_enclosures<Square>(); }
TYPED_TEST(IntervalLaws, RootsEnclose) { this->template expect_enclosures<Root>(); }
TYPED_TEST(IntervalLaws, SinesEnclose) { this->template expect_enclosures<Sine>(); }
TYPED_TEST(IntervalLaws, CosinesEnclose) { this->template expect_enclosures<Cosine>(); }
TYPED_TEST(IntervalLaws, TangentsEnclose) { this->template expect_enclosures<Tangent>(); }
TYPED_TEST(IntervalLaws, ExponentialsEnclose) { this->template expect_enclosures<Exponential>(); }
TYPED_TEST(IntervalLaws, LogarithmsEnclose) { this->template expect_enclosures<Logarithm>(); }
TYPED_TEST(IntervalLaws, AnglesEnclose) { this->template expect_enclosures<Angle>(); }
TYPED_TEST(IntervalLaws, PowersEnclose) {
  this->template expect_enclosures<Power<0>>();
  this->template expect_enclosures<Power<1>>();
  this->template expect_enclosures<Power<2>>();
  this->template expect_enclosures<Power<3>>();
  this->template expect_enclosures<Power<7>>();
  this->template expect_enclosures<Power<-1>>();
  this->template expect_enclosures<Power<-2>>();
  this->template expect_enclosures<Power<-3>>();
}

TYPED_TEST(IntervalLaws, ThinProductsEnclose) {
  using I = typename TypeParam::I;
  Operands operands(2);
  for (int n = 0; n < TypeParam::kSamples; ++n) {
    const double x = operands.point();
    const Operand a = operands.interval();
    I result;
    // A number of the ends' type times an interval.
    const bool sound = TypeParam::run([&] {
      if constexpr (std::is_same_v<I, MpInterval>) {
        result = BigFloat(x) * I(a.lower, a.upper);
      } else {
        result = x * I(a.lower, a.upper);
      }
    });
    if (!sound) continue;
    const PrecisionScope precision(kExactBits);
    for (const double y : {a.lower, a.upper, operands.inside(a)}) {
      const BigFloat value = BigFloat(x) * BigFloat(y);
      ASSERT_TRUE(holds(result, value)) << hex(x) << " * " << hex(a) << " gave " << print(result);
    }
  }
}

TYPED_TEST(IntervalLaws, NegationIsExact) {
  using I = typename TypeParam::I;
  Operands operands(3);
  for (int n = 0; n < 1000; ++n) {
    const Operand a = operands.interval();
    I result;
    ASSERT_TRUE(TypeParam::run([&] { result = -I(a.lower, a.upper); }));
    ASSERT_TRUE(lower_end(result) == BigFloat(-a.upper) && upper_end(result) == BigFloat(-a.lower)) << hex(a);
  }
}

TYPED_TEST(IntervalLaws, HullsAndIntersectionsAreExact) {
  using I = typename TypeParam::I;
  Operands operands(4);
  for (int n = 0; n < 10'000; ++n) {
    const Operand a = operands.interval();
    const Operand b = operands.interval();
    I joined, meet;
    ASSERT_TRUE(TypeParam::run([&] { joined = hull(I(a.lower, a.upper), I(b.lower, b.upper)); }));
    ASSERT_TRUE(lower_end(joined) == BigFloat(std::min(a.lower, b.lower)) &&
                upper_end(joined) == BigFloat(std::max(a.upper, b.upper)));
    const bool met = TypeParam::run([&] { meet = intersect(I(a.lower, a.upper), I(b.lower, b.upper)); });
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
      if (!TypeParam::run([&] { outer = f(I(a.lower, a.upper), I(b.lower, b.upper)); })) continue;
      ASSERT_TRUE(TypeParam::run([&] {
        inner = f(I(std::min(a1, a2), std::max(a1, a2)), I(std::min(b1, b2), std::max(b1, b2)));
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
    ASSERT_TRUE(TypeParam::run([&] { result = ScalarTraits<I>::from_decimal(text); }));
    const PrecisionScope precision(kExactBits);
    const BigFloat value = ScalarTraits<BigFloat>::from_decimal(text);
    ASSERT_TRUE(holds(result, value)) << text << " gave " << print(result);
    if (mpfr_regular_p(value.get()) != 0 && !extreme(value)) {
      ASSERT_LE(ulps(result, value, TypeParam::kBits), 1.0) << text;
    }
  }
  for (const char* text : {"", "x", "1e", "0.1.2"}) {
    EXPECT_THROW((void)ScalarTraits<I>::from_decimal(text), std::invalid_argument) << text;
  }
}

TYPED_TEST(IntervalLaws, PiIsOneUlpWide) {
  using I = typename TypeParam::I;
  I pi;
  ASSERT_TRUE(TypeParam::run([&] { pi = ScalarTraits<I>::pi(); }));
  const PrecisionScope precision(kExactBits);
  const BigFloat value = ScalarTraits<BigFloat>::pi();
  EXPECT_TRUE(holds(pi, value)) << print(pi);
  EXPECT_LE(ulps(pi, value, TypeParam::kBits), 1.0);
}

TYPED_TEST(IntervalLaws, LeavingADomainIsAFault) {
  using I = typename TypeParam::I;
  const auto faults = [](auto f) {
    I result;
    return !TypeParam::run([&] { result = f(); });
  };
  const double tiny = std::numeric_limits<double>::denorm_min();
  for (const Operand zero : {Operand{0, 0}, Operand{-0.0, -0.0}, Operand{-1, 1}, Operand{0, 1}, Operand{-1, 0},
                             Operand{-tiny, tiny}, Operand{-1, -0.0}}) {
    const I divisor(zero.lower, zero.upper);
    EXPECT_TRUE(faults([&] { return I(1.0) / divisor; })) << hex(zero);
    EXPECT_TRUE(faults([&] { return I(0.0) / divisor; })) << "0 / " << hex(zero);
    EXPECT_TRUE(faults([&] { return reciprocal(divisor); })) << hex(zero);
    EXPECT_TRUE(faults([&] { return pow_int(divisor, -2); })) << hex(zero);
  }
  EXPECT_TRUE(faults([] { return sqrt(I(-1.0, 4.0)); }));
  EXPECT_TRUE(faults([&] { return sqrt(I(-tiny, 4.0)); }));
  EXPECT_TRUE(faults([] { return sqrt(I(-4.0, -1.0)); }));
  EXPECT_FALSE(faults([] { return sqrt(I(0.0, 4.0)); }));
  EXPECT_FALSE(faults([] { return sqrt(I(-0.0, 4.0)); }));
  EXPECT_TRUE(faults([] { return log(I(0.0, 1.0)); }));
  EXPECT_TRUE(faults([] { return log(I(-1.0, 1.0)); }));
  EXPECT_TRUE(faults([] { return atan2(I(0.0), I(-1.0)); }));
  EXPECT_TRUE(faults([] { return atan2(I(-0.0), I(-1.0)); }));
  EXPECT_TRUE(faults([] { return atan2(I(0.0), I(0.0)); }));
  EXPECT_TRUE(faults([] { return atan2(I(-1.0, 1.0), I(-1.0, 1.0)); }));
  EXPECT_TRUE(faults([] { return atan2(I(0.0, 1.0), I(-1.0, 1.0)); }));
  EXPECT_TRUE(faults([] { return atan2(I(-1.0, -0.0), I(-1.0, 1.0)); }));
  EXPECT_FALSE(faults([] { return atan2(I(-1.0, 1.0), I(0.5, 1.0)); }));
  EXPECT_FALSE(faults([] { return atan2(I(0.5, 1.0), I(-1.0, 1.0)); }));
  EXPECT_FALSE(faults([] { return atan2(I(-1.0, -0.5), I(-1.0, 1.0)); }));
  EXPECT_TRUE(faults([] { return intersect(I(0.0, 1.0), I(2.0, 3.0)); }));
  EXPECT_TRUE(faults([] { return tan(I(1.5, 1.6)); }));
}

TYPED_TEST(IntervalLaws, OverflowIsAFault) {
  using I = typename TypeParam::I;
  I result(1e300);
  EXPECT_FALSE(TypeParam::run([&] {
    for (int n = 0; n < 64; ++n) result = result * result;  // beyond any exponent range
  }));
  EXPECT_FALSE(TypeParam::run([&] { result = exp(exp(I(100.0))); }));
}

TYPED_TEST(IntervalLaws, AFaultStaysRaised) {
  using I = typename TypeParam::I;
  I result;
  EXPECT_FALSE(TypeParam::run([&] {
    result = reciprocal(I(-1.0, 1.0));
    // Calls into MPFR and back, which set and restore the rounding mode.
    result =
        exp(I(1.0)) + log(I(2.0)) + atan2(I(1.0), I(2.0)) + sincos(I(1e5)).sin + ScalarTraits<I>::from_decimal("1");
  }));
  EXPECT_TRUE(TypeParam::run([&] { result = I(1.0) + I(2.0); })) << "the next run starts without faults";
}

}  // namespace
}  // namespace taut::testing
