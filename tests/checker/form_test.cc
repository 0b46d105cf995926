// SPDX-License-Identifier: GPL-3.0-or-later
#include "checker/form.h"

#include <gtest/gtest.h>

#include "tests/checker/fixtures.h"

namespace taut::checker {
namespace {

/// x = centre + radius u
Form variable(const mpq_class& centre, const mpq_class& radius) {
  return Form::enclose(Interval(centre), Interval(radius),
                       hull(Interval(mpq_class(centre - radius)), Interval(mpq_class(centre + radius))));
}

/// What a Form states, at random u: f(u) in range, and f(u) - f(0) in slope * u.
void expect_enclosed(const std::string& text, const mpq_class& centre, const mpq_class& radius, std::mt19937& random) {
  const Expression expression(text, {"x"}, {}, "test");
  Form form;
  try {
    form = expression.evaluate(std::vector<Form>{variable(centre, radius)});
  } catch (const Undefined&) {
    return;
  }
  const auto value = [&](const mpq_class& x) { return expression.evaluate(std::vector<Form>{Form(Interval(x))}).mid; };
  const Interval at_centre = value(centre);
  EXPECT_TRUE(meet(form.mid, at_centre)) << text;
  for (int sample = 0; sample < 10; ++sample) {
    const mpq_class u = random_rational(random, -1, 1);
    const Interval exact = value(centre + radius * u);
    EXPECT_TRUE(meet(form.range, exact)) << text << " at " << mpq_class(centre + radius * u).get_d();
    EXPECT_TRUE(meet(exact - at_centre, form.slope * Interval(u)))
        << text << " at " << mpq_class(centre + radius * u).get_d();
  }
}

TEST(Form, HoldsValuesAndSlopesOfEveryOperation) {
  const std::vector<std::string> expressions = {"x",
                                                "-x",
                                                "x + 1",
                                                "3 - x",
                                                "x*x - 2*x",
                                                "x/(x + 3)",
                                                "1/x",
                                                "2/(1 + x^2)",
                                                "x^2",
                                                "x^3",
                                                "x^-1",
                                                "x^(-2)",
                                                "x^0",
                                                "sqrt(x + 4)",
                                                "sqrt(x^2 + 1)",
                                                "sin(x)",
                                                "cos(3*x)",
                                                "tan(x)",
                                                "exp(-x^2)",
                                                "log(x + 5)",
                                                "atan2(x, 2)",
                                                "atan2(1, x)",
                                                "atan2(-1 - x^2, x - 1)",
                                                "atan2(sin(x), cos(x))",
                                                "asin(x/9)",
                                                "acos(sin(x)/2)",
                                                "atan(x^2 - x)",
                                                "sin(x)^2 + cos(x)^2",
                                                "x*sin(x)*exp(x/4)",
                                                "sqrt(2)*x",
                                                "sin(pi/7)*cos(x + pi)"};
  std::mt19937 random(4);
  for (const std::string& text : expressions) {
    for (int trial = 0; trial < 50; ++trial) {
      const mpq_class radius = random_rational(random, 0, 1) / (1 << (trial % 10));
      expect_enclosed(text, random_rational(random, -4, 4), radius, random);
    }
  }
}

TEST(Form, TheMeanValueTheoremBeatsDependency) {
  // x - x^2 on [0.49, 0.51]: of width 1e-4, directly 0.04.
  const Form x = variable(mpq_class(1, 2), mpq_class(1, 100));
  EXPECT_LT(width((x - x * x).range), 5e-4);
}

TEST(Form, AConstantNeedsNoDerivative) {
  const Form root = sqrt(Form(Interval(0)));  // where sqrt has no derivative
  EXPECT_TRUE(root.is_constant());
  EXPECT_TRUE(root.range.is_exactly_zero());
  EXPECT_THROW((void)sqrt(variable(1, 1)), Undefined);
}

TEST(Form, ExistsOnlyWhereTheFunctionIsContinuous) {
  EXPECT_THROW((void)(Form(Interval(1)) / variable(0, 1)), Undefined);
  EXPECT_THROW((void)atan2(variable(0, 1), Form(Interval(-1))), Undefined);
  EXPECT_THROW((void)power(variable(0, 1), -3), Undefined);
  EXPECT_THROW((void)asin(variable(0, 1)), Undefined) << "no derivative at 1";
  EXPECT_THROW((void)acos(variable(1, 1)), Undefined);
}

}  // namespace
}  // namespace taut::checker
