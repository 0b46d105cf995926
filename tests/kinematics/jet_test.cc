// SPDX-License-Identifier: GPL-3.0-or-later
// Jets against difference quotients in 300 bits.
#include "kinematics/jet.h"

#include <gtest/gtest.h>

#include "certify/arithmetic/slope_form.h"
#include "tests/support/enclosing.h"

namespace taut::testing {
namespace {

using Jet2 = Jet<BigFloat, 2>;

/// F's partial derivatives at random points of [0.3, 2]^2.
template <class F>
void expect_partials(F f) {
  const PrecisionScope precision(kExactBits);
  Operands operands(1);
  const BigFloat h(0x1p-80);
  for (int n = 0; n < 50; ++n) {
    const BigFloat x(operands.uniform(0.3, 2)), y(operands.uniform(0.3, 2));
    const Jet2 jet = f(Jet2(x, 0), Jet2(y, 1));
    const auto expect_near = [](const BigFloat& a, const BigFloat& b) {
      ASSERT_TRUE(abs(a - b) <= BigFloat(1e-40) * (BigFloat(1.0) + abs(b))) << digits(a) << " " << digits(b);
    };
    expect_near(jet.value, f(x, y));
    expect_near(jet.partial[0], (f(x + h, y) - f(x - h, y)) / (h + h));
    expect_near(jet.partial[1], (f(x, y + h) - f(x, y - h)) / (h + h));
  }
}

TEST(Jet, DifferentiatesRationalOperations) {
  expect_partials([](const auto& x, const auto& y) {
    using S = std::decay_t<decltype(x)>;
    return S((x * y - x / y + sqr(x - y) - (-y)) / (S(BigFloat(1.0)) + x * y));
  });
}
TEST(Jet, DifferentiatesRootsAndPowers) {
  expect_partials([](const auto& x, const auto& y) {
    using S = std::decay_t<decltype(x)>;
    return S(sqrt(x + sqr(y)) + pow_int(x, 3) * pow_int(y, -2) + pow_int(x, 1) + pow_int(y, 0));
  });
}
TEST(Jet, DifferentiatesTrigonometry) {
  expect_partials([](const auto& x, const auto& y) {
    using S = std::decay_t<decltype(x)>;
    const SinCos<S> sc = sincos(x * y);
    return S(sc.sin * cos(y) - sc.cos * sin(x) + tan(x / (y + y + x)));
  });
}
TEST(Jet, DifferentiatesExponentialsLogarithmsAndAngles) {
  expect_partials([](const auto& x, const auto& y) {
    using S = std::decay_t<decltype(x)>;
    return S(exp(x - y) * log(x + y) + atan2(x, y) - atan2(-y, x * x));
  });
}
TEST(Jet, DifferentiatesInverseTrigonometry) {
  expect_partials([](const auto& x, const auto& y) {
    using S = std::decay_t<decltype(x)>;
    const S small = sin(x * y) * S(0.75);
    return S(asin(small) * y - acos(small * sin(x)) + atan(x - y * y));
  });
}
TEST(Jet, DifferentiatesMixturesWithConstants) {
  const BigFloat k(0.75);
  expect_partials([&](const auto& x, const auto& y) {
    using S = std::decay_t<decltype(x)>;
    return S((x + k) * (y - k) + x * k);
  });
}

TEST(Jet, ConstantsHaveNoSlopeAndVariablesTheirOwn) {
  const Jet<double, 3> constant(2.5);
  const Jet<double, 3> variable(1.5, 1);
  EXPECT_EQ(constant.partial, (std::array<double, 3>{0, 0, 0}));
  EXPECT_EQ(variable.partial, (std::array<double, 3>{0, 1, 0}));
  EXPECT_EQ((constant * variable).partial, (std::array<double, 3>{0, 2.5, 0}));
}

// Two ways to differentiate on intervals: they enclose the same number.
TEST(Jet, MeetsTheCentredForm) {
  const auto f = [](const auto& t) {
    using S = std::decay_t<decltype(t)>;
    return S(sqrt(sqr(sin(t)) + exp(-t)) / (t * t + S(1.5)) + atan2(t, cos(t)) * pow_int(t, 3));
  };
  for (double t = -0.9; t < 1.0; t += 0.037) {
    Interval jet_slope, centred_slope;
    ASSERT_TRUE(run_upward([&] {
      jet_slope = f(Jet<Interval, 1>(Interval(t), 0)).partial[0];
      centred_slope = f(SlopeForm<Interval>(Interval(t), Interval(1.0), Interval(t))).slope;
    }));
    ASSERT_LE(jet_slope.lower(), centred_slope.upper());
    ASSERT_LE(centred_slope.lower(), jet_slope.upper());
    ASSERT_LT(spread(jet_slope) + spread(centred_slope), 1e-13);
  }
}

}  // namespace
}  // namespace taut::testing
