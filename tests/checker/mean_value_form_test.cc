// SPDX-License-Identifier: GPL-3.0-or-later
#include "checker/kernel/mean_value_form.h"

#include <gtest/gtest.h>

#include "problem/expression.h"
#include "tests/checker/kernel.h"

namespace taut::checker {
namespace {

const std::vector<std::string> kParameters = {"x", "y"};

Expression parse(const std::string& text) { return parse_expression(text, {kParameters, {}}, "test"); }

/// The value by the prover's parser and MPFR, to 200 bits; not a number where there is none.
class Exact {
 public:
  explicit Exact(const std::string& text) : evaluator_(ExpressionTape({text}, kParameters, {})) {}
  BigFloat operator()(const BigFloat& x, const BigFloat& y) const {
    const std::vector<BigFloat> at = {x, y};
    std::vector<BigFloat> value(1);
    evaluator_.evaluate(at, value);
    return value[0];
  }

 private:
  Evaluator<BigFloat> evaluator_;
};

/// Every operation of the grammar on random operands.
std::string random_expression(std::mt19937_64& random, int depth) {
  const auto pick = [&](int n) { return static_cast<int>(random() % static_cast<unsigned>(n)); };
  const auto number = [&] { return std::to_string(pick(4)) + "." + std::to_string(1 + pick(98)); };
  if (depth == 0) return pick(6) == 0 ? (pick(3) == 0 ? "pi" : number()) : pick(2) == 0 ? "x" : "y";
  const std::string a = "(" + random_expression(random, depth - 1) + ")";
  const std::string b = "(" + random_expression(random, depth - 1 - pick(depth)) + ")";
  switch (pick(19)) {
    case 0: return a + "+" + b;
    case 1: return a + "-" + b;
    case 2:
    case 3: return a + "*" + b;
    case 4: return a + "/" + b;
    case 5: return "-" + a;
    case 6: return a + "^" + std::to_string(pick(6) - 2);
    case 7: return "sqrt" + a;
    case 8: return "sqrt(" + a + "^2 + " + number() + ")";
    case 9: return "sin" + a;
    case 10: return "cos" + a;
    case 11: return "tan" + a;
    case 12: return "exp" + a;
    case 13: return "log" + a;
    case 14: return "asin(" + a + "/4)";
    case 15: return "acos(" + a + "/4)";
    case 16: return "atan" + a;
    default: return "atan2(" + a + "," + b + ")";
  }
}

/// A function of u that its form encloses: x + d(u) + y u with any d(u) in the ball `at`, any slope in `slope`.
struct Variable {
  double at, width, slope, slope_width;
  explicit Variable(std::mt19937_64& random) {
    const double size = std::exp(uniform(random, -14, 0.5));
    at = uniform(random, -3, 3);
    slope = size * uniform(random, -1, 1);
    width = random() % 2 == 0 ? 0 : size * uniform(random, 0, 1);
    slope_width = random() % 3 == 0 ? size * uniform(random, 0, 0.3) : 0;
    if (random() % 8 == 0) slope = slope_width = 0;
  }
  [[nodiscard]] MeanValueForm form() const {
    return {plus_minus(Ball(at), Ball(width)), slope == 0 ? Ball() : plus_minus(Ball(slope), Ball(slope_width))};
  }
  [[nodiscard]] BigFloat value(double u, std::mt19937_64& random) const {
    const auto within = [&] { return random() % 3 == 0 ? (random() % 2 == 0 ? -1.0 : 1.0) : uniform(random, -1, 1); };
    return BigFloat(at) + BigFloat(width) * BigFloat(within()) +
           (BigFloat(slope) + BigFloat(slope_width) * BigFloat(within())) * BigFloat(u);
  }
};

/// What a MeanValueForm states, at random u. @returns whether there is a form.
bool expect_enclosed(const std::string& text, std::mt19937_64& random) {
  const Expression expression = parse(text);
  const Exact exact(text);
  const Variable x(random), y(random);
  std::optional<MeanValueForm> form;
  try {
    form = expression.evaluate<MeanValueForm>(std::vector<MeanValueForm>{x.form(), y.form()});
  } catch (const Undefined&) {
  }
  for (const double u : samples(random, 50)) {
    const BigFloat value = exact(x.value(u, random), y.value(u, random));
    if (!form) continue;
    const double scale = std::min(1e290, 1e-30 * (1 + std::abs(value.to_double())));
    EXPECT_TRUE(holds(*form, u, value, scale))
        << text << " at u = " << u << ": " << testing::digits(value) << " is not in " << print(form->at) << " + u ("
        << print(form->slope) << ")";
    EXPECT_TRUE(holds(form->range(), value, scale)) << text << " at u = " << u;
    if (::testing::Test::HasFailure()) return true;
  }
  return form.has_value();
}

TEST(MeanValueForm, HoldsEveryFunctionOfTheGrammar) {
  const PrecisionScope oracle(kOracleBits);
  std::mt19937_64 random(4);
  for (const std::string text : {"x",
                                 "-x",
                                 "x + 1",
                                 "3 - x",
                                 "x*y",
                                 "x*x - 2*x",
                                 "x/(x + 3.5)",
                                 "1/x",
                                 "x/y",
                                 "2/(1 + x^2)",
                                 "x^1",
                                 "x^2",
                                 "x^3",
                                 "x^4",
                                 "x^7",
                                 "x^-1",
                                 "x^(-2)",
                                 "x^-3",
                                 "x^0",
                                 "sqrt(x + 4)",
                                 "sqrt(x^2 + 1)",
                                 "sqrt(x)",
                                 "sin(x)",
                                 "cos(3*x)",
                                 "tan(x)",
                                 "exp(-x^2)",
                                 "exp(x)",
                                 "log(x + 5)",
                                 "log(x)",
                                 "atan2(x, 2)",
                                 "atan2(1, x)",
                                 "atan2(x, y)",
                                 "atan2(-1 - x^2, x - 1)",
                                 "atan2(sin(x), cos(x))",
                                 "asin(x/4)",
                                 "acos(sin(x)/2)",
                                 "acos(x/3)",
                                 "atan(x)",
                                 "atan(x^2 - x)",
                                 "sin(x)^2 + cos(x)^2",
                                 "x*sin(x)*exp(x/4)",
                                 "sqrt(2)*x",
                                 "sin(pi/7)*cos(x + pi)"}) {
    int defined = 0;
    for (int trial = 0; trial < 60 && !HasFailure(); ++trial) {
      const WorkingPrecision precision(trial % 3 == 0 ? 32 : trial % 3 == 1 ? 64 : 150);
      defined += expect_enclosed(text, random) ? 1 : 0;
    }
    EXPECT_GT(defined, 10) << text;
  }
}

TEST(MeanValueForm, HoldsRandomExpressions) {
  const PrecisionScope oracle(kOracleBits);
  std::mt19937_64 random(5);
  const int trials = 6000;
  int defined = 0;
  for (int trial = 0; trial < trials && !HasFailure(); ++trial) {
    const WorkingPrecision precision(trial % 2 == 0 ? 64 : 128);
    defined += expect_enclosed(random_expression(random, 1 + trial % 4), random) ? 1 : 0;
  }
  EXPECT_GT(defined, trials / 3);
}

TEST(MeanValueForm, KnowsAFunctionToSecondOrder) {
  // x - x^2 on [0.49, 0.51]: of width 1e-4, directly 0.04.
  const MeanValueForm x(Ball(0.5), Ball(0.01));
  EXPECT_LT(width((x - x * x).range()), 5e-4);
  // As the box is halved, what is beyond first order is quartered.
  for (const std::string text : {"x*x", "x^3", "1/x", "sqrt(x)", "sin(x)", "exp(x)", "log(x)", "atan(x)", "asin(x)"}) {
    const auto rest = [&](double r) {
      const std::vector<MeanValueForm> at = {MeanValueForm(Ball(0.5), Ball(r)), MeanValueForm()};
      return width(parse(text).evaluate<MeanValueForm>(at).at);
    };
    EXPECT_LT(rest(0x1p-10), 0.3 * rest(0x1p-9)) << text;
    EXPECT_LT(rest(0x1p-10), 10 * 0x1p-20) << text;
  }
}

TEST(MeanValueForm, AConstantNeedsNoDerivative) {
  const MeanValueForm root = apply(Function::kSqrt, MeanValueForm(Ball(0)));  // where sqrt has no derivative
  EXPECT_TRUE(root.is_constant());
  EXPECT_TRUE(root.range().is_zero());
  EXPECT_TRUE(arb_contains_si(power(MeanValueForm(Ball(0)), 0).range().get(), 1));
  EXPECT_NO_THROW((void)apply(Function::kAsin, MeanValueForm(Ball(1))));
  EXPECT_THROW((void)apply(Function::kSqrt, MeanValueForm(Ball(1), Ball(1))), Undefined);
}

TEST(MeanValueForm, ExistsOnlyWhereTheFunctionIsDefinedAndContinuous) {
  const MeanValueForm u(Ball(), Ball(1));
  const MeanValueForm from_zero = u + MeanValueForm(Ball(1));
  EXPECT_THROW((void)(MeanValueForm(Ball(1)) / u), Undefined);
  EXPECT_THROW((void)(MeanValueForm(Ball(1)) / from_zero), Undefined);
  EXPECT_THROW((void)(MeanValueForm() / u), Undefined);
  EXPECT_THROW((void)atan2(u, MeanValueForm(Ball(-1))), Undefined);
  EXPECT_THROW((void)atan2(from_zero, -from_zero), Undefined);
  EXPECT_THROW((void)atan2(u, u), Undefined);
  EXPECT_THROW((void)power(u, -1), Undefined);
  EXPECT_THROW((void)power(u, -3), Undefined);
  EXPECT_THROW((void)apply(Function::kAsin, u), Undefined) << "no derivative at 1";
  EXPECT_THROW((void)apply(Function::kAcos, from_zero), Undefined);
  EXPECT_THROW((void)apply(Function::kLog, from_zero), Undefined);
  EXPECT_THROW((void)apply(Function::kSqrt, u), Undefined);
  EXPECT_THROW((void)parse("tan(x)").evaluate<MeanValueForm>(
                   std::vector<MeanValueForm>{u + MeanValueForm(Ball(1)), MeanValueForm()}),
               Undefined);
  EXPECT_NO_THROW((void)power(u, 3));
  EXPECT_NO_THROW((void)atan2(Ball(0.5) * u, MeanValueForm(Ball(1))));
  // Where the variable is in a ball, the form is about each number in it.
  EXPECT_THROW((void)(MeanValueForm(Ball(1)) / MeanValueForm(plus_minus(Ball(1), Ball(1)))), Undefined);
}

// ---- Jets -----------------------------------------------------------------------------------------------------------

TEST(Jet, DerivativesAreThoseOfDifferences) {
  const PrecisionScope oracle(400);
  const WorkingPrecision precision(128);
  std::mt19937_64 random(6);
  const BigFloat h(0x1p-120);
  int compared = 0;
  for (int trial = 0; trial < 3000; ++trial) {
    const std::string text = random_expression(random, 1 + trial % 3);
    const double x = uniform(random, -3, 3), y = uniform(random, -3, 3);
    const Exact f(text);
    try {
      std::vector<Jet> at = {Jet(Ball(x)), Jet(Ball(y))};
      at[0].by[0] = Ball(1);
      at[1].by[1] = Ball(1);
      const Jet seen = parse(text).evaluate<Jet>(at);
      const BigFloat two_h = BigFloat(2.0) * h;
      const BigFloat by_x = (f(BigFloat(x) + h, y) - f(BigFloat(x) - h, y)) / two_h;
      const BigFloat by_y = (f(x, BigFloat(y) + h) - f(x, BigFloat(y) - h)) / two_h;
      const double steep = std::abs(by_x.to_double()) + std::abs(by_y.to_double());
      if (!(steep < 1e3)) continue;  // of which third derivatives, too, are of modest size
      EXPECT_TRUE(holds(seen.value, f(x, y), 1e-60)) << text;
      EXPECT_TRUE(holds(seen.by[0], by_x, 1e-45)) << text << " by x at " << x << ", " << y;
      EXPECT_TRUE(holds(seen.by[1], by_y, 1e-45)) << text << " by y at " << x << ", " << y;
      for (std::size_t i = 2; i < Jet::kVariables; ++i) EXPECT_TRUE(seen.by[i].is_zero()) << text;
      ++compared;
    } catch (const Undefined&) {
    }
  }
  EXPECT_GT(compared, 1500);
}

TEST(Jet, OverABoxObeysTheMeanValueTheorem) {
  const PrecisionScope oracle(kOracleBits);
  std::mt19937_64 random(7);
  int compared = 0;
  for (int trial = 0; trial < 3000; ++trial) {
    const WorkingPrecision precision(trial % 2 == 0 ? 64 : 128);
    const std::string text = random_expression(random, 1 + trial % 4);
    const double x = uniform(random, -3, 3), y = uniform(random, -3, 3), r = std::exp(uniform(random, -10, 0));
    const Exact f(text);
    try {
      std::vector<Jet> box = {Jet(plus_minus(Ball(x), Ball(r))), Jet(plus_minus(Ball(y), Ball(r)))};
      box[0].by[0] = Ball(1);
      box[1].by[1] = Ball(1);
      const Jet seen = parse(text).evaluate<Jet>(box);
      ++compared;
      for (int k = 0; k < 10; ++k) {
        const auto inside = [&](double c) { return BigFloat(c) + BigFloat(r) * BigFloat(uniform(random, -1, 1)); };
        const BigFloat x0 = inside(x), y0 = inside(y), x1 = inside(x), y1 = inside(y);
        const BigFloat value = f(x0, y0), change = f(x1, y1) - value;
        const double scale = std::min(1e290, 1e-30 * (1 + std::abs(value.to_double())));
        EXPECT_TRUE(holds(seen.value, value, scale)) << text;
        const WorkingPrecision fine(512);
        const Ball bound = seen.by[0] * exactly(x1 - x0) + seen.by[1] * exactly(y1 - y0);
        EXPECT_TRUE(holds(bound, change, scale)) << text << " near " << x << ", " << y << " within " << r;
      }
    } catch (const Undefined&) {
    }
    if (HasFailure()) break;
  }
  EXPECT_GT(compared, 1000);
}

}  // namespace
}  // namespace taut::checker
