// SPDX-License-Identifier: GPL-3.0-or-later
// Derivatives by Leibniz' rule against jets of jets of jets, which apply the chain rule once for each.
#include "kinematics/taylor.h"

#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <random>
#include <string>
#include <vector>

#include "kinematics/jet.h"
#include "problem/expression.h"

namespace taut {
namespace {

using Third = Taylor<double, 3>;
using NestedJet = Jet<Jet<Jet<double, 1>, 1>, 1>;

NestedJet nested(const std::array<double, 4>& d) {
  const auto once = [](double x, double x1) {
    Jet<double, 1> result(x);
    result.partial[0] = x1;
    return result;
  };
  const auto twice = [&](double x, double x1, double x2) {
    Jet<Jet<double, 1>, 1> result(once(x, x1));
    result.partial[0] = once(x1, x2);
    return result;
  };
  NestedJet result(twice(d[0], d[1], d[2]));
  result.partial[0] = twice(d[1], d[2], d[3]);
  return result;
}
std::array<double, 4> derivatives(const NestedJet& x) {
  return {x.value.value.value, x.partial[0].value.value, x.partial[0].partial[0].value,
          x.partial[0].partial[0].partial[0]};
}

TEST(Taylor, DerivesAsNestedJetsDo) {
  const std::vector<std::string> functions = {"x + y",
                                              "x - y",
                                              "x*y",
                                              "x/y",
                                              "-x",
                                              "x^2",
                                              "x^3",
                                              "x^-2",
                                              "x^7",
                                              "x^0",
                                              "sqrt(y)",
                                              "sin(x)",
                                              "cos(x)",
                                              "tan(x)",
                                              "exp(x)",
                                              "log(y)",
                                              "asin(x)",
                                              "acos(x)",
                                              "atan(y)",
                                              "atan2(x, y)",
                                              "sin(x*y)/exp(y)",
                                              "3 - 2*x",
                                              "x*0.5",
                                              "(x + 1)*(y - 2)^2/(1 + x^2)",
                                              "atan2(sqrt(y), x)*log(1 + exp(x*y))"};
  std::mt19937_64 random(5);
  const auto number = [&](double from, double to) { return std::uniform_real_distribution<double>(from, to)(random); };
  for (const std::string& text : functions) {
    const ExpressionTape tape({text}, {"x", "y"}, {});
    for (int trial = 0; trial < 20; ++trial) {
      const std::array<double, 4> x = {number(-0.8, 0.8), number(-1, 1), number(-1, 1), number(-1, 1)};
      const std::array<double, 4> y = {number(0.5, 2), number(-1, 1), number(-1, 1), number(-1, 1)};
      std::array<Third, 1> mine;
      std::array<NestedJet, 1> other;
      Evaluator<Third>(tape).evaluate(std::array{Third(x), Third(y)}, mine);
      Evaluator<NestedJet>(tape).evaluate(std::array{nested(x), nested(y)}, other);
      const std::array<double, 4> expected = derivatives(other[0]);
      for (std::size_t n = 0; n < 4; ++n) {
        EXPECT_NEAR(mine[0].d[n], expected[n], 1e-10 * (1 + std::abs(expected[n]))) << text << ", derivative " << n;
      }
    }
  }
}

}  // namespace
}  // namespace taut
