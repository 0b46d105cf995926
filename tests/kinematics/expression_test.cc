// SPDX-License-Identifier: GPL-3.0-or-later
#include "problem/expression.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <rapidcheck.h>

#include <cmath>
#include <numbers>

#include "base/input_error.h"

namespace taut {
namespace {

using ::testing::HasSubstr;
using ::testing::ThrowsMessage;

const std::vector<std::string> kNames = {"x", "y"};
const std::map<std::string, DecimalText> kConstants = {{"rs", "130"}, {"zs", "306"}};

double value_at(const std::string& text, double x, double y) {
  const ExpressionTape tape({text}, kNames, kConstants);
  std::array<double, 1> value = {};
  Evaluator<double>(tape).evaluate(std::array{x, y}, value);
  return value[0];
}

double value_of(const std::string& text) { return evaluate_constant<double>(text); }

TEST(Expression, KnowsAPlainDecimal) {
  for (const char* plain : {"0", "-0", "12", "-0.3", "007", "1.50"}) {
    EXPECT_TRUE(is_plain_decimal(plain)) << plain;
    EXPECT_EQ(value_of(plain), value_of("(" + std::string(plain) + ")")) << plain;
  }
  for (const char* other : {"", "-", ".5", "5.", "1.2.3", "--1", "1e3", "+1", "1-2", " 1", "pi"}) {
    EXPECT_FALSE(is_plain_decimal(other)) << other;
  }
  EXPECT_FALSE(is_plain_decimal(std::string(2000, '1')));
}

TEST(Expression, BindsAsUsual) {
  EXPECT_EQ(value_of("1+2*3"), 7);
  EXPECT_EQ(value_of("(1+2)*3"), 9);
  EXPECT_EQ(value_of("7-4-2"), 1);
  EXPECT_EQ(value_of("16/4/2"), 2);
  EXPECT_EQ(value_of("-2^2"), -4);
  EXPECT_EQ(value_of("(-2)^2"), 4);
  EXPECT_EQ(value_of("2*-3"), -6);
  EXPECT_EQ(value_of("2--3"), 5);
  EXPECT_EQ(value_of("1e1+1E-1+.5+2."), 12.6);
}

TEST(Expression, RaisesToIntegerPowers) {
  EXPECT_EQ(value_of("2^3^2"), 512);  // to the right
  EXPECT_EQ(value_of("2^-1"), 0.5);
  EXPECT_EQ(value_of("2^(-3)"), 0.125);
  EXPECT_EQ(value_of("5^0"), 1);
  EXPECT_EQ(value_of("5^1"), 5);
  EXPECT_EQ(value_of("2^64"), std::exp2(64));
}

TEST(Expression, KnowsItsFunctions) {
  const double x = 0.3, y = 0.7;
  EXPECT_EQ(value_at("sqrt(x)", x, y), std::sqrt(x));
  EXPECT_EQ(value_at("sin(x)", x, y), std::sin(x));
  EXPECT_EQ(value_at("cos(x)", x, y), std::cos(x));
  EXPECT_EQ(value_at("tan(x)", x, y), std::tan(x));
  EXPECT_EQ(value_at("exp(x)", x, y), std::exp(x));
  EXPECT_EQ(value_at("log(x)", x, y), std::log(x));
  EXPECT_EQ(value_at("asin(x)", x, y), std::asin(x));
  EXPECT_EQ(value_at("acos(x)", x, y), std::acos(x));
  EXPECT_EQ(value_at("atan(x)", x, y), std::atan(x));
  EXPECT_EQ(value_at("atan2(x, y)", x, y), std::atan2(x, y));
  EXPECT_EQ(value_of("pi"), std::numbers::pi);
}

TEST(Expression, EvaluatesThePapersSphere) {
  const double a = 0.55, b = 0.75;
  EXPECT_DOUBLE_EQ(value_at("(rs*cos(y)*cos(x))*0.001", a, b), 0.13 * std::cos(b) * std::cos(a));
  EXPECT_DOUBLE_EQ(value_at("(zs - rs*sin(y))*0.001", a, b), 0.306 - 0.13 * std::sin(b));
}

TEST(ExpressionTape, SharesEqualSubexpressions) {
  const ExpressionTape tape({"sin(x+y)*cos(y+x)", "cos(x + y)", "2.0*x", "x*2"}, kNames, {});
  EXPECT_EQ(std::ranges::count(tape.instructions(), Op::kSin, &Instruction::op), 1);
  EXPECT_EQ(std::ranges::count(tape.instructions(), Op::kAdd, &Instruction::op), 1);
  EXPECT_EQ(tape.outputs()[2], tape.outputs()[3]);
}

TEST(ExpressionTape, PutsTheCosineRightAfterTheSine) {
  const ExpressionTape tape({"cos(x) + sin(y) + sin(x)"}, kNames, {});
  const std::vector<Instruction>& code = tape.instructions();
  int pairs = 0;
  for (std::size_t i = 0; i < code.size(); ++i) {
    if (code[i].op == Op::kCos) {
      ASSERT_GT(i, 0u);
      EXPECT_EQ(code[i - 1].op, Op::kSin);
      EXPECT_EQ(code[i - 1].a, code[i].a);
      ++pairs;
    }
  }
  EXPECT_EQ(pairs, 2);
  EXPECT_EQ(std::ranges::count(code, Op::kSin, &Instruction::op), pairs);
}

TEST(ExpressionTape, KnowsWhatDependsOnWhat) {
  const ExpressionTape tape({"sin(x)^2", "atan2(1, y)", "rs", "x - x", "3^-2"}, kNames, kConstants);
  EXPECT_TRUE(tape.depends_on(0, 0));
  EXPECT_FALSE(tape.depends_on(0, 1));
  EXPECT_TRUE(tape.depends_on(1, 1));
  EXPECT_FALSE(tape.depends_on(2, 0));
  EXPECT_TRUE(tape.depends_on(3, 0));  // it is written there
  EXPECT_FALSE(tape.depends_on(4, 0));
}

TEST(ExpressionTape, CountsTurns) {
  const auto turns = [](const std::string& text) { return ExpressionTape({text}, kNames, kConstants).turns(0, 0); };
  EXPECT_EQ(turns("x - pi"), 1);
  EXPECT_EQ(turns("pi/2 - 2*x"), -2);
  EXPECT_EQ(turns("-2*x + x*3"), 1);
  EXPECT_EQ(turns("rs*cos(3*x)*sin(x + y)^2"), 0);
  EXPECT_EQ(turns("y*y"), 0);
  EXPECT_EQ(turns("sin(sin(x))"), 0);
  EXPECT_EQ(turns("rs*x"), 130);
  for (const char* text :
       {"x/2", "0.5*x", "sin(x/2)", "x*x", "x^2", "x*y", "sqrt(x)", "x*pi", "exp(x)", "atan2(x, 1)", "1/x", "1001*x"}) {
    EXPECT_EQ(turns(text), std::nullopt) << text;
  }
}

TEST(ExpressionLaws, TurnsAreWhatEvaluationShows) {
  for (const char* text :
       {"x - pi", "pi/2 - 2*x", "-2*x + x*3", "rs*cos(3*x)*sin(x + y)^2", "tan(2*x)", "sin(cos(x))"}) {
    const ExpressionTape tape({text}, kNames, kConstants);
    for (const double x : {-2.0, 0.1, 1.3}) {
      const double grown = value_at(text, x + 2 * std::numbers::pi, 0.4) - value_at(text, x, 0.4);
      EXPECT_NEAR(grown, 2 * std::numbers::pi * tape.turns(0, 0).value(), 1e-9) << text;
    }
  }
}

/// An expression as text, and its value by C++'s own arithmetic.
struct Sample {
  std::string text;
  double value;
};

Sample arbitrary_expression(int depth) {
  const int kind = *rc::gen::inRange(0, depth > 0 ? 9 : 3);
  if (kind == 0) return {"x", 0.3};
  if (kind == 1) return {"y", 0.7};
  if (kind == 2) {
    const int n = *rc::gen::inRange(0, 50);
    return {std::to_string(n) + "e-1", ScalarTraits<double>::from_decimal(std::to_string(n) + "e-1")};
  }
  const Sample a = arbitrary_expression(depth - 1);
  if (kind == 3) return {"-(" + a.text + ")", -a.value};
  if (kind == 4) return {"sin(" + a.text + ")", std::sin(a.value)};
  if (kind == 5) return {"cos( " + a.text + ")", std::cos(a.value)};
  const Sample b = arbitrary_expression(depth - 1);
  if (kind == 6) return {"(" + a.text + ")+(" + b.text + ")", a.value + b.value};
  if (kind == 7) return {"(" + a.text + ") - (" + b.text + ")", a.value - b.value};
  return {"(" + a.text + ")*(" + b.text + ")", a.value * b.value};
}

TEST(ExpressionLaws, EvaluatesLikeCpp) {
  EXPECT_TRUE(rc::check([] {
    const Sample sample = arbitrary_expression(4);
    RC_ASSERT(value_at(sample.text, 0.3, 0.7) == sample.value);
  }));
}

TEST(Expression, SaysWhereAndWhatIsWrong) {
  const std::vector<std::pair<std::string, std::string>> cases = {
      {"", "column 1: got its end, expected a value"},
      {"   ", "expected a value"},
      {"(1", "column 3: got its end, expected ')'"},
      {"1)", "column 2: got ')', expected an operator or the end"},
      {"2**3", "column 3: got '*3', expected a value"},
      {"x y", "column 3: got 'y', expected an operator"},
      {"sin x", "column 5: got 'x', expected '('"},
      {"atan2(x)", "column 8: got ')', expected ','"},
      {"2^2.5", "column 3: got '2.5', expected an integer exponent from -64 to 64"},
      {"2^65", "expected an integer exponent"},
      {"2^9^9", "expected an integer exponent"},
      {"2^x", "expected an integer exponent"},
      {"1 + foo", "column 5: got 'foo', expected a number, one of the names x, y, rs, zs, pi, or a function"},
      {"foo(x)", "column 1"},
      {"+1", "expected a value"},
      {"1e999", "expected zero or a magnitude"},
      {"nan", "expected a number"},
      {"1\n+2", "expected printable ASCII"},
      {"π", "expected printable ASCII"},
  };
  for (const auto& [text, message] : cases) {
    EXPECT_THAT(([&, t = text] { ExpressionTape({t}, kNames, kConstants); }),
                ThrowsMessage<InputError>(HasSubstr(message)))
        << text;
  }
}

std::string repeat(const std::string& text, int n) {
  std::string result;
  for (int i = 0; i < n; ++i) result += text;
  return result;
}

TEST(Expression, IsNotBroughtDownByHostileText) {
  EXPECT_EQ(value_of(repeat("(", 190) + "1" + repeat(")", 190)), 1);
  for (const std::string& text :
       {repeat("(", 300) + "1" + repeat(")", 300), repeat("-", 300) + "1", repeat("(", 5000), repeat("sin(", 1000),
        "1" + repeat("+1", 5000), repeat(" ", 100000), "1" + repeat("9", 2000)}) {
    EXPECT_THROW(ExpressionTape({text}, {}, {}), InputError) << text.substr(0, 20);
  }
  std::string many_operations = "x";
  for (int i = 0; i < 300; ++i) many_operations += "+x*" + std::to_string(i);
  EXPECT_THAT([&] { ExpressionTape({many_operations}, kNames, {}); },
              ThrowsMessage<InputError>(HasSubstr("at most 256 distinct operations")));
}

TEST(ExpressionTape, RejectsBadNames) {
  for (const char* name : {"", "2x", "pi", "sin", "atan", "a b", "ä", "a-b"}) {
    EXPECT_THROW(ExpressionTape({"1"}, {name}, {}), InputError) << name;
    EXPECT_THROW(ExpressionTape({"1"}, {}, {{name, "1"}}), InputError) << name;
  }
  EXPECT_THROW(ExpressionTape({"1"}, {"x", "x"}, {}), InputError);
  EXPECT_THROW(ExpressionTape({"1"}, {"x"}, {{"x", "1"}}), InputError);
}

}  // namespace
}  // namespace taut
