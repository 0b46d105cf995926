// SPDX-License-Identifier: GPL-3.0-or-later
#include "checker/kernel/zero.h"

#include <gtest/gtest.h>

#include <cmath>
#include <functional>
#include <random>

#include "checker/kernel/errors.h"
#include "tests/checker/kernel.h"
#include "tests/support/checker_enclosing.h"

namespace taut::checker {
namespace {

const MeanValueForm kU(Ball(), Ball(1));
MeanValueForm constant(double x) { return MeanValueForm(Ball(x)); }

using Row = std::vector<Ball>;
using Rows = std::vector<Row>;

/// Some equations in the first unknowns.
class Given : public Equations {
 public:
  using OnForms = std::function<std::vector<MeanValueForm>(const Vector6<MeanValueForm>& y)>;
  using OnBalls = std::function<Rows(const Vector6<Ball>& Y)>;
  Given(std::size_t unknowns, OnForms residual, OnBalls jacobian)
      : unknowns_(unknowns), residual_(std::move(residual)), jacobian_(std::move(jacobian)) {}
  [[nodiscard]] std::size_t unknowns() const override { return unknowns_; }
  [[nodiscard]] Vector6<MeanValueForm> residual(const Vector6<MeanValueForm>& y) const override {
    Vector6<MeanValueForm> result;
    const std::vector<MeanValueForm> g = residual_(y);
    for (std::size_t i = 0; i < unknowns_; ++i) result[i] = g[i];
    return result;
  }
  [[nodiscard]] Matrix6<Ball> jacobian(const Vector6<Ball>& Y) const override {
    Matrix6<Ball> result;
    const Rows G = jacobian_(Y);
    for (std::size_t i = 0; i < unknowns_; ++i) {
      for (std::size_t j = 0; j < unknowns_; ++j) result[i][j] = G[i][j];
    }
    return result;
  }

 private:
  std::size_t unknowns_;
  OnForms residual_;
  OnBalls jacobian_;
};

/// y^2 = c + rate u.
Given square(double c, double rate = 0) {
  return {1, [=](const auto& y) { return std::vector{sqr(y[0]) - constant(c) - Ball(rate) * kU}; },
          [](const auto& Y) { return Rows{Row{Ball(2) * Y[0]}}; }};
}

/// slope y = rate u, the slope somewhere in the ball.
Given line(const Ball& slope, const Ball& rate) {
  return {1, [=](const auto& y) { return std::vector{slope * y[0] - rate * kU}; },
          [=](const auto&) { return Rows{Row{slope}}; }};
}

/// A circle about (a, 0) and one about (-a, 0), of radii r and q + rate u, meet at two points, one above.
Given circles(double a, double r, double q, double rate, double from_y) {
  return {2,
          [=](const auto& y) {
            const MeanValueForm second = constant(q) + Ball(rate) * kU, up = y[1] + constant(from_y);
            return std::vector{sqr(y[0] - constant(a)) + sqr(up) - constant(r * r),
                               sqr(y[0] + constant(a)) + sqr(up) - sqr(second)};
          },
          [=](const auto& Y) {
            const Ball up = Y[1] + Ball(from_y);
            return Rows{Row{Ball(2) * (Y[0] - Ball(a)), Ball(2) * up}, Row{Ball(2) * (Y[0] + Ball(a)), Ball(2) * up}};
          }};
}

bool may_be(const MeanValueForm& form, double u, const BigFloat& value) {
  const WorkingPrecision precision(1024);
  return arb_overlaps((form.at + form.slope * Ball(u)).get(), plus_minus(exactly(value), Ball(1e-50)).get()) != 0;
}
TEST(Zero, IsTheOneOfARootForEveryU) {
  // y^2 = 1/4 + u/16.
  const PrecisionScope oracle(200);
  for (const int narrowings : {0, 1, 2, 8}) {
    const Given equations{
        1, [](const auto& y) { return std::vector{sqr(y[0] + constant(0.5)) - constant(0.25) - Ball(1.0 / 16) * kU}; },
        [](const auto& Y) { return Rows{Row{Ball(2) * Y[0] + Ball(1)}}; }};
    const Vector6<MeanValueForm> y = only_zero(equations, Ball(0.25), {{0.0}, {1.0 / 16}, 0.008, narrowings});
    for (int k = -50; k <= 50; ++k) {
      const double u = k / 50.0;
      const BigFloat exact = sqrt(BigFloat(0.25) + BigFloat(u) / BigFloat(16.0)) - BigFloat(0.5);
      EXPECT_TRUE(may_be(y[0], u, exact)) << u << " with " << narrowings;
      EXPECT_TRUE(arb_overlaps(y[0].range().get(), exactly(exact).get())) << u;
    }
    EXPECT_LT(width(y[0].range()), 0.15) << "the zero moves by 0.13";
  }
}

TEST(Zero, IsWhereCirclesAndSpheresMeet) {
  const PrecisionScope oracle(200);
  std::mt19937_64 random(1);
  const auto uniform = [&](double a, double b) { return std::uniform_real_distribution<double>(a, b)(random); };
  int shown = 0;
  for (int trial = 0; trial < 300; ++trial) {
    const double a = uniform(0.3, 1), r = uniform(1.2, 2), q = r + uniform(-0.02, 0.02), rate = uniform(-0.005, 0.005);
    const auto exact = [&](double u) {  // x = (q^2 - r^2) / 4a
      const BigFloat second = BigFloat(q) + BigFloat(rate) * BigFloat(u), big_r(r * r), big_a(a);
      const BigFloat x = (second * second - big_r) / (BigFloat(4.0) * big_a);
      return std::pair{x, sqrt(big_r - (x - big_a) * (x - big_a))};
    };
    const double up = std::ldexp(std::round(exact(0).second.to_double() * 256), -8);
    const Given equations = circles(a, r, q, rate, up);
    NearZero near;
    for (const auto component : {0, 1}) {
      const auto at = [&](double u) {
        return component == 0 ? exact(u).first.to_double() : exact(u).second.to_double() - up;
      };
      near.at.push_back(at(0));
      near.slope.push_back((at(1) - at(-1)) / 2);
    }
    near.radius = 0.001;
    near.narrowings = trial % 5;
    try {
      const Vector6<MeanValueForm> y = only_zero(equations, Ball(0.125), near);
      ++shown;
      for (int k = -8; k <= 8; ++k) {
        const auto& [x, above] = exact(k / 8.0);
        EXPECT_TRUE(may_be(y[0], k / 8.0, x)) << trial;
        EXPECT_TRUE(may_be(y[1], k / 8.0, above - BigFloat(up))) << trial;
      }
      for (std::size_t i = 2; i < 6; ++i) EXPECT_TRUE(y[i].range().is_zero());
    } catch (const Undefined&) {
    }
  }
  EXPECT_GT(shown, 100);
}

TEST(Zero, NarrowingsOnlyNarrow) {
  const auto zero = [](int narrowings) {
    return only_zero(square(1.0 / 16, 1.0 / 256), Ball(0.375), {{0.25}, {1.0 / 128}, 0.001, narrowings})[0];
  };
  // The tube holds -1/4 as well.
  EXPECT_THROW((void)zero(0), Undefined);
  const auto shifted = [](int narrowings) {
    const Given equations{1,
                          [](const auto& y) {
                            return std::vector{sqr(y[0] + constant(0.25)) - constant(1.0 / 16) - Ball(1.0 / 256) * kU};
                          },
                          [](const auto& Y) { return Rows{Row{Ball(2) * Y[0] + Ball(0.5)}}; }};
    return only_zero(equations, Ball(0.1875), {{0}, {1.0 / 128}, 0.01, narrowings})[0];
  };
  double before = width(shifted(0).range());
  for (int narrowings = 1; narrowings <= 8; ++narrowings) {
    const double now = width(shifted(narrowings).range());
    EXPECT_LE(now, before * (1 + 0x1p-20)) << narrowings;
    before = now;
  }
  EXPECT_LT(before, 0.0165) << "it moves by 0.0157";
}

TEST(Zero, RefusesADoubleZero) {
  EXPECT_THROW((void)only_zero(square(0), Ball(1), {{0}, {0}, 0.5}), Undefined);
  EXPECT_THROW((void)only_zero(square(0), Ball(0x1p-30), {{0}, {0}, 0x1p-40}), Undefined);
}

TEST(Zero, RefusesTwoCloseZerosInOneTube) {
  for (int k = 1; k < 40; ++k) {
    const double apart = std::ldexp(1, -k);  // y (y - apart)
    const Given equations{1, [=](const auto& y) { return std::vector{y[0] * (y[0] - constant(apart))}; },
                          [=](const auto& Y) { return Rows{Row{Ball(2) * Y[0] - Ball(apart)}}; }};
    EXPECT_THROW((void)only_zero(equations, Ball(apart), {{0}, {0}, apart / 64}), Undefined) << k;
    EXPECT_THROW((void)only_zero(equations, Ball(1), {{0}, {0}, apart / 64}), Undefined) << k;
    EXPECT_THROW((void)only_zero(equations, Ball(0.5 * apart), {{0}, {0}, apart / 64}), Undefined) << k;
    EXPECT_NO_THROW((void)only_zero(equations, Ball(0.2 * apart), {{0}, {0}, apart / 64})) << k;
  }
}

TEST(Zero, RefusesATubeThatIsTooWide) {
  // -1/4 is in it as well.
  EXPECT_THROW((void)only_zero(square(1.0 / 16), Ball(1), {{0.25}, {0}, 0.01}), Undefined);
  EXPECT_THROW((void)only_zero(square(1.0 / 16), Ball(0.3), {{0.25}, {0}, 0.01}), Undefined);
  // Only one in it, but the derivative vanishes there.
  EXPECT_THROW((void)only_zero(square(4), Ball(2.5), {{2}, {0}, 0.01}), Undefined);
}

TEST(Zero, RefusesAZeroOutsideOfTheTube) {
  const Given far{1, [](const auto& y) { return std::vector{y[0] - constant(2)}; },
                  [](const auto&) { return Rows{Row{Ball(1)}}; }};
  EXPECT_THROW((void)only_zero(far, Ball(1), {{0}, {0}, 0.5}), Undefined);
  EXPECT_THROW((void)only_zero(far, Ball(1), {{2}, {0}, 0.5}), Undefined);
  EXPECT_THROW((void)only_zero(far, Ball(1), {{1}, {0}, 1}), Undefined);
  EXPECT_NO_THROW((void)only_zero(far, Ball(2.5), {{2}, {0}, 0.5}));
}

TEST(Zero, RefusesAZeroThatLeavesTheTubeForSomeU) {
  EXPECT_NO_THROW((void)only_zero(line(Ball(1), Ball(0.75)), Ball(1), {{0}, {0.75}, 0.25}));
  EXPECT_THROW((void)only_zero(line(Ball(1), Ball(1.015625)), Ball(1), {{0}, {1.015625}, 0x1p-40}), Undefined);
  EXPECT_THROW((void)only_zero(line(Ball(1), Ball(1.015625)), Ball(1), {{0}, {0.9375}, 0.0625}), Undefined);
}

TEST(Zero, RefusesAGuessThatItsOwnNewtonStepLeaves) {
  EXPECT_THROW((void)only_zero(line(Ball(1), Ball(0.5)), Ball(1), {{0}, {0}, 0.25}), Undefined);
  EXPECT_THROW((void)only_zero(line(Ball(1), Ball(0.5)), Ball(1), {{0}, {0.5 + 0x1p-20}, 0x1p-30}), Undefined);
  EXPECT_THROW((void)only_zero(line(Ball(1), Ball(0.5)), Ball(1), {{0x1p-20}, {0.5}, 0x1p-30}), Undefined);
  EXPECT_NO_THROW((void)only_zero(line(Ball(1), Ball(0.5)), Ball(1), {{0}, {0.5}, 0x1p-30}));
}

TEST(Zero, RefusesWhereTheDerivativeMayVanish) {
  const Ball slope = hull(Ball(-0x1p-10), Ball(1));
  EXPECT_THROW((void)only_zero(line(slope, Ball(0.125)), Ball(1), {{0}, {0}, 0.5}), Undefined);
  EXPECT_THROW((void)only_zero(line(Ball(0), Ball(0)), Ball(1), {{0}, {0}, 0.5}), Undefined);
}

}  // namespace
}  // namespace taut::checker
