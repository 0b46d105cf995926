// SPDX-License-Identifier: GPL-3.0-or-later
#include "checker/expression.h"

#include <gtest/gtest.h>

#include "tests/checker/fixtures.h"

namespace taut::checker {
namespace {

const std::vector<std::string> kParameters = {"phi", "theta"};
const std::map<std::string, mpq_class> kConstants = {{"rs", mpq_class(13, 100)}};

Interval value(const std::string& text) {
  return Expression(text, kParameters, kConstants, "test")
      .evaluate(std::vector<Form>{Form(Interval(5)), Form(Interval(7))})
      .range;
}

void expect_exactly(const std::string& text, const mpq_class& expected) {
  EXPECT_TRUE(meet(value(text), Interval(expected))) << text;
  EXPECT_LT(width(value(text)), 1e-30) << text;
}

TEST(Expression, MeansTheUsualReading) {
  expect_exactly("1 - 2 - 3", -4);
  expect_exactly("8/4/2", 1);
  expect_exactly("2 + 3*4", 14);
  expect_exactly("-2^2", -4);
  expect_exactly("(-2)^2", 4);
  expect_exactly("2^3^2", 512);
  expect_exactly("2^-1", mpq_class(1, 2));
  expect_exactly("2^(-1)", mpq_class(1, 2));
  expect_exactly("2^-1^5", mpq_class(1, 2));
  expect_exactly("4^2*2", 32);
  expect_exactly("2*-3", -6);
  expect_exactly("--3", 3);
  expect_exactly("1e-4*1e4", 1);
  expect_exactly(".5 + 2.", mpq_class(5, 2));
  expect_exactly("phi - theta*rs", 5 - 7 * mpq_class(13, 100));
  expect_exactly("sqrt(9) + exp(0) + log(1) + sin(0) + cos(0) + tan(0)", 5);
  expect_exactly("atan2(1,-1)/pi", mpq_class(3, 4));
  expect_exactly("asin(1)/pi", mpq_class(1, 2));
  expect_exactly("acos(-1/2)/pi", mpq_class(2, 3));
  expect_exactly("atan(-1)/pi", mpq_class(-1, 4));
  expect_exactly("((34)) * (pi)/180 / pi", mpq_class(34, 180));
}

TEST(Expression, EnclosesADecimalInsteadOfRoundingIt) {
  const Interval tenth = value("0.1");
  EXPECT_LT(mpfr_cmp_q(tenth.lower(), mpq_class(1, 10).get_mpq_t()), 0);
  EXPECT_GT(mpfr_cmp_q(tenth.upper(), mpq_class(1, 10).get_mpq_t()), 0);
}

TEST(Expression, RefusesWhatTheGrammarDoesNotSay) {
  for (const std::string text :
       {"",         " ",       "1 +",      "* 2", "(1",    "1)",    "1 2",      "2phi",     "phi theta",
        "+1",       "1e",      "1e+",      ".",   "1..2",  "0x10",  "2^phi",    "2^0.5",    "2^1e2",
        "2^",       "2^99999", "2^9^9^9",  "sin", "sin 1", "sin()", "sin(1,2)", "atan2(1)", "atan2(1,2,3)",
        "omega",    "Pi",      "max(1,2)", "1,2", "1;",    "nan",   "inf",      "1e5000",   "phi\n+1",
        "\xc3\xbc", "1 = 1",   "[1]",      "1\t", "\t1",   "1\x7f", "1\r",      "\v1"}) {
    EXPECT_THROW((Expression(text, kParameters, kConstants, "test")), Malformed) << "'" << text << "'";
  }
  EXPECT_THROW((Expression(std::string("1\0+1", 4), {}, {}, "test")), Malformed);
}

TEST(Expression, SurvivesDeepNesting) {
  EXPECT_THROW((Expression(std::string(5000, '('), {}, {}, "test")), Malformed);
  EXPECT_THROW((Expression(std::string(5000, '-') + "1", {}, {}, "test")), Malformed);
  EXPECT_THROW((Expression("2^" + std::string(5000, '('), {}, {}, "test")), Malformed);
  std::string sum = "1";
  for (int i = 1; i < 4000; ++i) sum += "+1";
  expect_exactly(sum, 4000);
}

TEST(Expression, KnowsWhatItMentions) {
  const Expression expression("rs*theta + phi^0 - phi^0", kParameters, kConstants, "test");
  EXPECT_TRUE(expression.mentions(0));
  EXPECT_TRUE(expression.mentions(1));
  EXPECT_FALSE(Expression("rs*theta", kParameters, kConstants, "test").mentions(0));
}

std::optional<long> turns(const std::string& text) {
  return Expression(text, kParameters, kConstants, "test").turns(0);
}

TEST(Expression, CountsTheTurnsThatItsFormShows) {
  for (const auto& [text, expected] : std::map<std::string, long>{{"phi", 1},
                                                                  {"-phi", -1},
                                                                  {"phi - pi", 1},
                                                                  {"3*phi - phi*2.0", 1},
                                                                  {"-2*(phi + theta)", -2},
                                                                  {"theta", 0},
                                                                  {"phi - phi", 0},
                                                                  {"phi^1", 1},
                                                                  {"phi^0", 0},
                                                                  {"-(phi^0)*phi", -1},
                                                                  {"sin(phi)", 0},
                                                                  {"cos(2*phi + 1)*theta/rs", 0},
                                                                  {"atan2(sin(phi), cos(phi))", 0},
                                                                  {"exp(tan(phi)) + log(theta)^2", 0},
                                                                  {"sqrt(rs*sin(phi)^-2)", 0}}) {
    EXPECT_EQ(turns(text), std::optional(expected)) << text;
  }
  for (const std::string text : {"phi/2",
                                 "0.5*phi",
                                 "rs*phi",
                                 "phi*phi",
                                 "phi*theta",
                                 "pi*phi",
                                 "phi^2",
                                 "phi^-1",
                                 "1/phi",
                                 "sqrt(phi)",
                                 "exp(phi)",
                                 "log(phi)",
                                 "sin(phi/2)",
                                 "tan(pi*phi)",
                                 "cos(sin(phi)*phi)",
                                 "atan2(phi, 1)",
                                 "atan2(1, phi)",
                                 "2*3*phi/6",
                                 "1001*phi",
                                 "1e300*phi",
                                 "999*999*999*999*999*999*999*phi",
                                 "800*phi + 800*phi"}) {
    EXPECT_EQ(turns(text), std::nullopt) << text;
  }
}

/// A random expression of few words, nearly all of whose parts may close or not.
std::string random_expression(std::mt19937& random, int depth) {
  const auto one_of = [&](const std::vector<std::string>& words) { return words[random() % words.size()]; };
  const auto part = [&] { return "(" + random_expression(random, depth - 1) + ")"; };
  if (depth == 0) return one_of({"phi", "phi", "theta", "2", "3", "pi", "rs", "0.5"});
  switch (random() % 5) {
    case 0: return one_of({"sin", "cos", "tan"}) + part();
    case 1: return one_of({"exp(sin", "sqrt(2 + cos"}) + part() + ")";
    case 2: return "-" + part() + one_of({"^1", "^2", "^0", ""});
    default: return part() + one_of({"+", "-", "*", "*", "/"}) + part();
  }
}

TEST(Expression, GrowsByTheTurnsThatItCounts) {
  std::mt19937 random(20);
  const WorkingPrecision precision(256);
  int counted = 0;
  for (int i = 0; i < 5000; ++i) {
    const std::string text = random_expression(random, 3);
    const Expression expression(text, kParameters, kConstants, "test");
    const std::optional<long> k = expression.turns(0);
    if (!k || !expression.mentions(0)) continue;
    const Interval turn = Interval(2) * Interval::pi();
    const Interval phi{random_rational(random, -3, 3)};
    const Form theta{Interval(random_rational(random, -3, 3))};
    try {
      const Interval before = expression.evaluate(std::vector<Form>{Form(phi), theta}).range;
      const Interval after = expression.evaluate(std::vector<Form>{Form(phi + turn), theta}).range;
      EXPECT_TRUE(meet(after - before, Interval(static_cast<int>(*k)) * turn)) << text << " by " << *k;
      EXPECT_LT(width(after - before), 1e-9) << text;
      ++counted;
    } catch (const Undefined&) {
    }
  }
  EXPECT_GT(counted, 500);
}

TEST(Expression, ReservesPiAndTheFunctions) {
  for (const std::string name : {"pi", "sin", "atan", "atan2", "", "1a", "a-b", "a b"})
    EXPECT_FALSE(Expression::is_free_name(name));
  for (const std::string name : {"phi", "_x", "alpha2", "PI"}) EXPECT_TRUE(Expression::is_free_name(name));
}

}  // namespace
}  // namespace taut::checker
