// SPDX-License-Identifier: GPL-3.0-or-later
// Centred forms against 300-bit samples: value at the midpoint, slope and range of composite functions.
#include "certify/arithmetic/slope_form.h"

#include <gtest/gtest.h>

#include "tests/support/enclosing.h"

namespace taut::testing {
namespace {

template <class A>
class CenteredForm : public ::testing::Test {
 protected:
  /// F over many intervals T within [lower, upper].
  template <class F>
  static void expect_enclosures(double lower, double upper) {
    using I = typename A::I;
    constexpr int kIntervals = std::is_same_v<A, Fast> ? 400 : 100;
    Operands operands(20261121);
    for (int n = 0; n < kIntervals; ++n) {
      // Multiples of 2^-40, so that T, its midpoint and its radius are exact.
      const auto grid = [](double x) { return std::ldexp(std::nearbyint(std::ldexp(x, 40)), -40); };
      const double mid = grid(operands.uniform(lower, upper));
      double radius = grid(std::exp(operands.uniform(-25, 0.5)));
      if (operands.pick(10) == 0) radius = 0;
      if (mid - radius < lower || mid + radius > upper) radius = 0;
      SlopeForm<I> value;
      SlopeForm<I> tightened;
      const bool sound = A::run([&] {
        value = F::of(SlopeForm<I>(I(mid), I(1.0), I(mid - radius, mid + radius)));
        tightened = value;
        tightened.tighten(I(-radius, radius));
      });
      if (!sound) {  // T is too wide for a quotient, a root or a logarithm
        ASSERT_GT(radius, 1e-2) << mid;
        continue;
      }
      const PrecisionScope precision(kExactBits);
      const std::string where = hex(mid) + " +- " + hex(radius);
      const BigFloat at_mid = F::of(BigFloat(mid));
      ASSERT_TRUE(holds(value.at_mid, at_mid)) << where;
      const BigFloat error(1e-30);  // of 300 bits over a difference of 2^-53 or more
      for (int k = 0; k < 8; ++k) {
        const double t = k == 0 ? mid - radius : k == 1 ? mid + radius : mid + radius * operands.uniform(-1, 1);
        const BigFloat x(t);
        const BigFloat exact = F::of(x);
        ASSERT_TRUE(holds(value.range, exact)) << where << " at " << hex(t);
        ASSERT_TRUE(holds(tightened.range, exact)) << where << " at " << hex(t);
        if (t == mid) continue;
        const BigFloat slope = (exact - at_mid) / (x - BigFloat(mid));
        ASSERT_TRUE(holds(value.slope, slope, error))
            << where << " at " << hex(t) << ": " << digits(slope) << " is not in " << print(value.slope);
      }
    }
  }
};
using FormArithmetics = ::testing::Types<Fast, Mp53, Mp128>;
TYPED_TEST_SUITE(CenteredForm, FormArithmetics);

struct Polynomial {
  template <class S>
  static S of(const S& t) {
    return sqr(t) * t - S(2.0) * t + S(0.5) - (-t);
  }
};
struct Trigonometric {
  template <class S>
  static S of(const S& t) {
    return sin(t * S(3.0)) * cos(t) + tan(t * S(0.25));
  }
};
struct Root {
  template <class S>
  static S of(const S& t) {
    return sqrt(sqr(t) + S(0.5)) * sqrt(S(4.0) - t);
  }
};
struct Quotient {
  template <class S>
  static S of(const S& t) {
    return (t + S(1.0)) / (sqr(t) + S(2.0)) - t / (S(5.0) + t);
  }
};
struct ExponentialAndLogarithm {
  template <class S>
  static S of(const S& t) {
    return exp(t * S(0.5)) * log(sqr(t) + S(1.5)) - exp(-sqr(t));
  }
};
struct Angle {
  template <class S>
  static S of(const S& t) {
    return atan2(sin(t), cos(t) + S(1.5)) + atan2(S(2.0) + t * t, t);
  }
};
struct InverseTrigonometric {
  template <class S>
  static S of(const S& t) {
    const S u = sin(t) * S(0.875);
    return asin(u) * t - acos(u * cos(t)) + atan(t * t - S(2.0));
  }
};
struct Powers {
  template <class S>
  static S of(const S& t) {
    return pow_int(t, 3) + pow_int(sqr(t) + S(1.0), -2) - pow_int(t, 1) + pow_int(t, 0) + pow_int(t, 6);
  }
};
struct Everything {
  template <class S>
  static S of(const S& t) {
    const S u = sqrt(S(1.0) + sqr(sin(t)));
    const S v = atan2(u, exp(-t)) / (u + pow_int(cos(t), 2));
    return log(u + v * v) * tan(v * S(0.25)) - pow_int(v, 3) / S(3.0);
  }
};

TYPED_TEST(CenteredForm, EnclosesPolynomials) { this->template expect_enclosures<Polynomial>(-3, 3); }
TYPED_TEST(CenteredForm, EnclosesTrigonometricFunctions) { this->template expect_enclosures<Trigonometric>(-3, 3); }
TYPED_TEST(CenteredForm, EnclosesRoots) { this->template expect_enclosures<Root>(-3, 3); }
TYPED_TEST(CenteredForm, EnclosesQuotients) { this->template expect_enclosures<Quotient>(-3, 3); }
TYPED_TEST(CenteredForm, EnclosesExponentialsAndLogarithms) {
  this->template expect_enclosures<ExponentialAndLogarithm>(-3, 3);
}
TYPED_TEST(CenteredForm, EnclosesAngles) { this->template expect_enclosures<Angle>(-3, 3); }
TYPED_TEST(CenteredForm, EnclosesInverseTrigonometricFunctions) {
  this->template expect_enclosures<InverseTrigonometric>(-3, 3);
}
TYPED_TEST(CenteredForm, EnclosesPowers) { this->template expect_enclosures<Powers>(-3, 3); }
TYPED_TEST(CenteredForm, EnclosesCompositions) { this->template expect_enclosures<Everything>(-3, 3); }

/// sin has slope 0 between 0 and any multiple of pi, where its derivative is −1 or 1: only wide slopes can hold both.
TYPED_TEST(CenteredForm, EnclosesSlopesOfWideBoxes) {
  using I = typename TypeParam::I;
  for (const double radius : {0.49, 0.51, 1.0, 3.0, 3.5, 6.0, 40.0}) {
    for (const double mid : {0.0, 0.1, 1.5, -3.0, 10.0}) {
      SinCos<SlopeForm<I>> value;
      ASSERT_TRUE(TypeParam::run([&] { value = sincos(SlopeForm<I>(I(mid), I(1.0), I(mid - radius, mid + radius))); }));
      const PrecisionScope precision(kExactBits);
      const BigFloat m(mid);
      for (int k = -50; k <= 50; ++k) {
        const BigFloat x(mid + radius * k / 50);
        ASSERT_TRUE(holds(value.sin.range, sin(x))) << mid << " " << radius << " " << k;
        ASSERT_TRUE(holds(value.cos.range, cos(x))) << mid << " " << radius << " " << k;
        if (k == 0) continue;
        ASSERT_TRUE(holds(value.sin.slope, (sin(x) - sin(m)) / (x - m))) << mid << " " << radius << " " << k;
        ASSERT_TRUE(holds(value.cos.slope, (cos(x) - cos(m)) / (x - m))) << mid << " " << radius << " " << k;
      }
    }
  }
}

/// Slopes from the midpoint are half as wide as derivatives: of t² over 1 ± r they are in 2 ± r, not 2 ± 2r.
TYPED_TEST(CenteredForm, SlopesAreTighterThanDerivatives) {
  using I = typename TypeParam::I;
  SlopeForm<I> square;
  SlopeForm<I> product;
  ASSERT_TRUE(TypeParam::run([&] {
    const SlopeForm<I> t(I(1.0), I(1.0), I(0.75, 1.25));
    square = sqr(t);
    product = t * t;
  }));
  for (const SlopeForm<I>& x : {square, product}) EXPECT_LE(spread(x.slope), 0.5 * (1 + 1e-15));
}

TYPED_TEST(CenteredForm, LeavingADomainIsAFault) {
  using I = typename TypeParam::I;
  const auto faults = [](auto f) { return !TypeParam::run(f); };
  const SlopeForm<I> across_zero(I(0.5), I(1.0), I(-0.5, 1.5));
  const SlopeForm<I> constant_across_zero(I(-0.5, 1.5));
  for (const SlopeForm<I>& x : {across_zero, constant_across_zero}) {
    SlopeForm<I> y;
    EXPECT_TRUE(faults([&] { y = sqrt(x); }));
    EXPECT_TRUE(faults([&] { y = log(x); }));
    EXPECT_TRUE(faults([&] { y = asin(x); }));
    EXPECT_TRUE(faults([&] { y = acos(-x); }));
    EXPECT_TRUE(faults([&] { y = asin(x - SlopeForm<I>(0.5)); })) << "no slope at 1";
    EXPECT_TRUE(faults([&] { y = reciprocal(x); }));
    EXPECT_TRUE(faults([&] { y = SlopeForm<I>(0.0) / x; }));
    EXPECT_TRUE(faults([&] { y = pow_int(x, -1); }));
    EXPECT_TRUE(faults([&] { y = atan2(x, -sqr(x)); }));
  }
}

// The slope at 0 of a root is unbounded, so a range that reaches 0 is a fault too unless it is a constant.
TYPED_TEST(CenteredForm, RootThatReachesZeroIsAFault) {
  using I = typename TypeParam::I;
  SlopeForm<I> y;
  EXPECT_FALSE(TypeParam::run([&] { y = sqrt(SlopeForm<I>(I(0.5), I(1.0), I(0.0, 1.0))); }));
}

TYPED_TEST(CenteredForm, TighteningCancelsWhatTheRangeAloneCannot) {
  using I = typename TypeParam::I;
  SlopeForm<I> zero;
  SlopeForm<I> parabola;
  double plain = 0;
  ASSERT_TRUE(TypeParam::run([&] {
    const SlopeForm<I> t(I(0.5), I(1.0), I(0.5 - 0x1p-10, 0.5 + 0x1p-10));
    zero = t - t;
    zero.tighten(I(-0x1p-10, 0x1p-10));
    parabola = t - sqr(t);  // slope 0 at the midpoint
    plain = 0;
  }));
  plain = spread(parabola.range);
  ASSERT_TRUE(TypeParam::run([&] { parabola.tighten(I(-0x1p-10, 0x1p-10)); }));
  EXPECT_EQ(spread(zero.range), 0.0);
  EXPECT_GT(plain, 1e-3);
  EXPECT_LT(spread(parabola.range), 1e-5) << "second order in the radius";
}

}  // namespace
}  // namespace taut::testing
