// SPDX-License-Identifier: GPL-3.0-or-later
#include <gtest/gtest.h>

#include <random>

#include "checker/format/expression_parser.h"
#include "checker/kernel/errors.h"
#include "checker/kernel/mean_value_form.h"

namespace taut::checker {
namespace {

const Names kNames = {{"phi", "theta"}, {{"rs", mpq_class(13, 100)}}};

Expression parse(const std::string& text) { return parse_expression(text, kNames, "test"); }

Ball value(const Expression& expression, const Ball& phi, const Ball& theta) {
  return expression.evaluate<MeanValueForm>(std::vector<MeanValueForm>{MeanValueForm(phi), MeanValueForm(theta)})
      .range();
}

Ball value(const std::string& text) {
  const WorkingPrecision precision(128);
  return value(parse(text), Ball(5), Ball(7));
}

double width(const Ball& x) { return 2 * mag_get_d(arb_radref(x.get())); }

bool contains(const Ball& x, const mpq_class& number) {
  fmpq_t q;
  fmpq_init(q);
  fmpq_set_mpq(q, number.get_mpq_t());
  const bool result = arb_contains_fmpq(x.get(), q) != 0;
  fmpq_clear(q);
  return result;
}

void expect_exactly(const std::string& text, const mpq_class& expected) {
  EXPECT_TRUE(contains(value(text), expected)) << text;
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
  const Ball tenth = value("0.1");
  EXPECT_TRUE(contains(tenth, mpq_class(1, 10)));
  EXPECT_GT(width(tenth), 0);
  EXPECT_LT(width(tenth), 1e-30);
}

TEST(Expression, RefusesWhatTheGrammarDoesNotSay) {
  for (const std::string text :
       {"",         " ",       "1 +",      "* 2", "(1",    "1)",    "1 2",      "2phi",     "phi theta",
        "+1",       "1e",      "1e+",      ".",   "1..2",  "0x10",  "2^phi",    "2^0.5",    "2^1e2",
        "2^",       "2^99999", "2^9^9^9",  "sin", "sin 1", "sin()", "sin(1,2)", "atan2(1)", "atan2(1,2,3)",
        "omega",    "Pi",      "max(1,2)", "1,2", "1;",    "nan",   "inf",      "1e5000",   "phi\n+1",
        "\xc3\xbc", "1 = 1",   "[1]",      "1\t", "\t1",   "1\x7f", "1\r",      "\v1"}) {
    EXPECT_THROW((void)parse(text), Malformed) << "'" << text << "'";
  }
  EXPECT_THROW((void)parse(std::string("1\0+1", 4)), Malformed);
}

TEST(Expression, SurvivesDeepNesting) {
  EXPECT_THROW((void)parse(std::string(5000, '(')), Malformed);
  EXPECT_THROW((void)parse(std::string(5000, '-') + "1"), Malformed);
  EXPECT_THROW((void)parse("2^" + std::string(5000, '(')), Malformed);
  expect_exactly(std::string(100, '(') + "7" + std::string(100, ')'), 7);
  std::string sum = "1";
  for (int i = 1; i < 4000; ++i) sum += "+1";
  expect_exactly(sum, 4000);
}

TEST(Expression, KnowsWhatItMentions) {
  const Expression expression = parse("rs*theta + phi^0 - phi^0");
  EXPECT_TRUE(mentions(expression, 0));
  EXPECT_TRUE(mentions(expression, 1));
  EXPECT_FALSE(mentions(parse("rs*theta"), 0));
}

std::optional<long> turns(const std::string& text) { return turns(parse(text), 0); }

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

/// A random expression of few words, most parts of which may or may not close.
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
  const auto random_angle = [&] { return Ball(mpq_class(static_cast<long>(random() % 6001) - 3000, 1000)); };
  int counted = 0;
  for (int i = 0; i < 5000; ++i) {
    const std::string text = random_expression(random, 3);
    const Expression expression = parse(text);
    const std::optional<long> k = turns(expression, 0);
    if (!k || !mentions(expression, 0)) continue;
    const Ball turn = Ball(2) * Ball::pi();
    const Ball phi = random_angle();
    const Ball theta = random_angle();
    try {
      const Ball difference = value(expression, phi + turn, theta) - value(expression, phi, theta);
      EXPECT_NE(arb_overlaps(difference.get(), (Ball(static_cast<int>(*k)) * turn).get()), 0) << text << " by " << *k;
      EXPECT_LT(width(difference), 1e-9) << text;
      ++counted;
    } catch (const Undefined&) {
    }
  }
  EXPECT_GT(counted, 500);
}

TEST(Expression, ReservesPiAndTheFunctions) {
  for (const std::string name : {"pi", "sin", "atan", "atan2", "", "1a", "a-b", "a b"}) {
    EXPECT_FALSE(is_free_name(name)) << name;
  }
  for (const std::string name : {"phi", "_x", "alpha2", "PI"}) EXPECT_TRUE(is_free_name(name));
}

}  // namespace
}  // namespace taut::checker
