// SPDX-License-Identifier: GPL-3.0-or-later
#include "checker/krawczyk.h"

#include <gtest/gtest.h>

#include <functional>

#include "checker/kernel/errors.h"
#include "tests/checker/fixtures.h"

namespace taut::checker {
namespace {

const Interval kOne(1);
Interval ratio(int a, int b) { return Interval(mpq_class(a, b)); }
Interval all_u() { return Interval::plus_minus_one(); }

/// (1 + y1)^2 = 1 + u/8 and (1 + y1) y2 = u/16 + shift: y1 = root - 1, y2 = (u/16 + shift)/root with root = sqrt(1 + u/8).
class Rooted : public Equations {
 public:
  explicit Rooted(const Interval& shift = Interval(0)) : shift_(shift) {}
  [[nodiscard]] std::size_t unknowns() const override { return 2; }
  [[nodiscard]] Derivatives derivatives(const Vector6<Interval>& Y) const override {
    Derivatives g;
    g.by_y[0][0] = Interval(2) * (kOne + Y[0]);
    g.by_y[1][0] = Y[1];
    g.by_y[1][1] = kOne + Y[0];
    g.by_u[0] = ratio(-1, 8);
    g.by_u[1] = ratio(-1, 16);
    return g;
  }
  [[nodiscard]] Vector6<Interval> at_middle(const Vector6<Interval>& y) const override {
    return {sqr(kOne + y[0]) - kOne, (kOne + y[0]) * y[1] - shift_};
  }

 private:
  Interval shift_;
};

/// One unknown: p(y) - rate u = 0.
class OneUnknown : public Equations {
 public:
  using Function = std::function<Interval(const Interval&)>;
  OneUnknown(Function value, Function derivative, const Interval& rate)
      : value_(std::move(value)), derivative_(std::move(derivative)), rate_(rate) {}
  [[nodiscard]] std::size_t unknowns() const override { return 1; }
  [[nodiscard]] Derivatives derivatives(const Vector6<Interval>& Y) const override {
    Derivatives g;
    g.by_y[0][0] = derivative_(Y[0]);
    g.by_u[0] = -rate_;
    return g;
  }
  [[nodiscard]] Vector6<Interval> at_middle(const Vector6<Interval>& y) const override { return {value_(y[0])}; }

 private:
  Function value_, derivative_;
  Interval rate_;
};

OneUnknown line(const Interval& slope, const Interval& rate) {
  return {[slope](const Interval& y) { return slope * y; }, [slope](const Interval&) { return slope; }, rate};
}

/// y^2 - c.
OneUnknown square(const Interval& c) {
  return {[c](const Interval& y) { return sqr(y) - c; }, [](const Interval& y) { return Interval(2) * y; },
          Interval(0)};
}

TEST(Krawczyk, HoldsTheOnlyZeroAndItsSlopeForEveryU) {
  const Rooted equations;
  const Zero zero = only_zero(equations, ratio(1, 4), approximate_zero(equations));
  for (int k = -50; k <= 50; ++k) {
    const Interval u = ratio(k, 50);
    const Interval root = sqrt(kOne + u / Interval(8));
    EXPECT_TRUE(contains(zero.y[0], root - kOne)) << k;
    EXPECT_TRUE(contains(zero.y[1], u / Interval(16) / root)) << k;
    const Interval root_slope = kOne / (Interval(16) * root);
    EXPECT_TRUE(contains(zero.slope[0], root_slope)) << k;
    EXPECT_TRUE(contains(zero.slope[1], kOne / (Interval(16) * root) - u / Interval(16) * root_slope / sqr(root))) << k;
  }
  EXPECT_LT(width(zero.y[0]), 0.14) << "the zero moves by 0.125";
  EXPECT_LT(width(zero.slope[0]), 0.02);
  for (std::size_t i = 2; i < 6; ++i) EXPECT_TRUE(contains(Interval(0), zero.y[i]));
}

TEST(Krawczyk, FindsTheZeroFromAfar) {
  const Vector6<Interval> y = approximate_zero(Rooted(ratio(1, 16)));
  EXPECT_LT(width(y[1]), 1e-30);
  EXPECT_TRUE(contains(ratio(1, 16) + ratio(1, 1 << 20) * all_u(), y[1]));
}

TEST(Krawczyk, RefusesADoubleZero) { EXPECT_THROW((void)only_zero(square(Interval(0)), kOne, {}), Undefined); }

TEST(Krawczyk, RefusesTwoZerosInOneTube) {
  const OneUnknown equations = square(ratio(1, 16));
  EXPECT_THROW((void)only_zero(equations, kOne, {ratio(1, 4)}), Undefined);
  EXPECT_THROW((void)only_zero(equations, ratio(3, 10), {ratio(1, 4)}), Undefined) << "-1/4 is in it as well";
  const OneUnknown unlike{[](const Interval& y) { return (y - ratio(1, 4)) * (y + ratio(1, 2)); },
                          [](const Interval& y) { return Interval(2) * y + ratio(1, 4); }, ratio(1, 1000)};
  EXPECT_THROW((void)only_zero(unlike, kOne, {ratio(1, 4)}), Undefined);
}

TEST(Krawczyk, RefusesAZeroOutsideOfTheTube) {
  const OneUnknown far{[](const Interval& y) { return y - Interval(2); }, [](const Interval&) { return kOne; },
                       Interval(0)};
  EXPECT_THROW((void)only_zero(far, kOne, {}), Undefined);
  EXPECT_THROW((void)only_zero(far, kOne, {Interval(2)}), Undefined);
}

TEST(Krawczyk, RefusesAZeroThatLeavesTheTubeForSomeU) {
  EXPECT_NO_THROW((void)only_zero(line(kOne, kOne), kOne, {})) << "the tube is closed";
  EXPECT_THROW((void)only_zero(line(kOne, kOne + Interval(mpq_class(1, mpz_class(1) << 100))), kOne, {}), Undefined);
  EXPECT_THROW((void)only_zero(line(kOne, ratio(101, 100)), kOne, {}), Undefined);
}

TEST(Krawczyk, RefusesWhereTheDerivativeMayVanish) {
  const Interval slope = hull(ratio(-1, 1000), kOne);
  EXPECT_THROW((void)only_zero(line(slope, ratio(1, 10)), kOne, {}), Undefined);
}

}  // namespace
}  // namespace taut::checker
