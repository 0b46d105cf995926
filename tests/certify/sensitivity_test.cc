// SPDX-License-Identifier: GPL-3.0-or-later
#include "certify/sensitivity.h"

#include <gtest/gtest.h>

#include <algorithm>

#include "problem/decimal.h"
#include "tests/support/robots.h"

namespace taut {
namespace {

using testing::robot1_slice;

Path short_path() {
  Path path;
  for (const double theta : {0.2, 0.26, 0.33}) path.waypoints.push_back({{0.5, theta}, {0, 0}});
  return path;
}

Verdict verdict(const Problem& problem) {
  const Prover prover(problem);
  const Path path = short_path();
  Verdict worst = Verdict::kProved;
  for (std::size_t k = 0; k < path.segments(); ++k) {
    const Verdict found = prover.prove(prover.prepared(path.segment(k))).verdict;
    if (found != Verdict::kProved) worst = found;
  }
  return worst;
}

double number(const DecimalText& text) { return ScalarTraits<double>::from_decimal(text); }

const Decimal kMillimetre = Decimal::parse("0.001");

/// A robot whose lower tension limit lies just above what one cable has.
Problem slack_robot() {
  Problem problem = robot1_slice();
  problem.tolerances.emplace().base_anchor_m.fill("0.0005");
  const auto tightest = tightest_place(problem, short_path());
  const MarginBudget& budget = tightest->budget;
  EXPECT_EQ(budget.id.kind, MarginKind::kTensionMin);
  const double limit = budget.limit + budget.left() + 0.002;
  for (Limits& limits : problem.robot.tension_N) limits.lower = std::to_string(limit);
  return problem;
}

TEST(Sensitivity, ChangesAreProvedAndLittleLessIsNot) {
  const Problem problem = slack_robot();
  ASSERT_NE(verdict(problem), Verdict::kProved);
  const Sensitivity found = find_sensitivity(problem, short_path(), Verdict::kRefuted, kMillimetre, {}, {});
  ASSERT_TRUE(found.tightest);
  EXPECT_NEAR(found.tightest->budget.left(), -0.002, 2e-5);
  std::size_t proved = 0;
  for (const ProvedChange& change : found.changes) {
    EXPECT_TRUE(change.is_complete);
    if (!change.value) continue;
    ++proved;
    EXPECT_EQ(verdict(with_change(problem, change.change, Decimal::parse(*change.value))), Verdict::kProved);
    const double before = number(change.before);
    const double less = before + 0.8 * (number(*change.value) - before);
    EXPECT_NE(verdict(with_change(problem, change.change, Decimal::parse(std::to_string(less)))), Verdict::kProved)
        << static_cast<int>(change.change.kind) << ": " << change.before << " to " << *change.value;
  }
  EXPECT_GE(proved, 3U) << found.changes.size();
  const auto limit = std::ranges::find_if(
      found.changes, [](const ProvedChange& c) { return c.change.kind == Change::Kind::kTensionLower; });
  ASSERT_NE(limit, found.changes.end());
  ASSERT_TRUE(limit->value);
  EXPECT_NEAR(number(limit->before) - number(*limit->value), 0.002, 0.0004);
  EXPECT_LE(limit->value->size(), 8U) << *limit->value;
}

TEST(Sensitivity, DerivativesAreSortedByWhatStepsGain) {
  const Problem problem = slack_robot();
  const Sensitivity found = find_sensitivity(problem, short_path(), Verdict::kProved, kMillimetre, {}, {});
  EXPECT_TRUE(found.changes.empty()) << "none are sought for a proved path";
  ASSERT_GT(found.derivatives.size(), 40U);
  for (std::size_t i = 1; i < found.derivatives.size(); ++i) {
    const auto gain = [&](const Derivative& d) { return std::abs(d.value) * natural_step(problem, d.parameter); };
    EXPECT_GE(gain(found.derivatives[i - 1]), gain(found.derivatives[i]));
  }
}

TEST(Sensitivity, StatesNoChangeThatThereWasNoTimeToProve) {
  std::stop_source source;
  source.request_stop();
  const Sensitivity found =
      find_sensitivity(slack_robot(), short_path(), Verdict::kRefuted, kMillimetre, {}, source.get_token());
  EXPECT_FALSE(found.changes.empty());
  for (const ProvedChange& change : found.changes) {
    EXPECT_FALSE(change.value);
    EXPECT_FALSE(change.is_complete);
  }
}

TEST(Sensitivity, AChangeOfLimitsLeavesCablesThatHaveRoom) {
  Problem problem = robot1_slice();
  problem.robot.tension_N[2].lower = "0.01";
  const Problem changed = with_change(problem, {Change::Kind::kTensionLower}, Decimal::parse("0.02"));
  EXPECT_EQ(changed.robot.tension_N[2].lower, "0.01");
  EXPECT_EQ(changed.robot.tension_N[3].lower, "0.02");
  EXPECT_THROW(with_change(problem, {Change::Kind::kTensionLower}, Decimal::parse("-1")), InputError);
}

}  // namespace
}  // namespace taut
