// SPDX-License-Identifier: GPL-3.0-or-later
#include "planner/time_budget.h"

#include <gtest/gtest.h>

#include <atomic>
#include <limits>
#include <stop_token>

namespace taut {
namespace {

constexpr double kNever = std::numeric_limits<double>::infinity();

void wait_until_over(const TimeBudget& budget) {
  std::atomic<bool> is_over = false;
  const std::stop_callback on_stop(budget.token(), [&] {
    is_over = true;
    is_over.notify_all();
  });
  is_over.wait(false);
}

TEST(TimeBudget, EndsByItself) {
  TimeBudget budget(1e-3, {});
  wait_until_over(budget);
  EXPECT_TRUE(budget.token().stop_requested());
}

TEST(TimeBudget, EndsWithItsParent) {
  std::stop_source parent;
  TimeBudget limited(1e6, parent.get_token()), unlimited(kNever, parent.get_token());
  EXPECT_FALSE(limited.token().stop_requested());
  EXPECT_FALSE(unlimited.token().stop_requested());
  parent.request_stop();
  for (TimeBudget* budget : {&limited, &unlimited}) {
    EXPECT_TRUE(budget->token().stop_requested());
    EXPECT_TRUE(budget->token().stop_requested());
  }
}

TEST(TimeBudget, IsOverWhereNothingIsLeft) {
  TimeBudget none(0, {}), less(-1, {});
  EXPECT_TRUE(none.token().stop_requested());
  EXPECT_TRUE(less.token().stop_requested());
}

TEST(TimeBudget, TakesTimesThatNoClockHolds) {
  TimeBudget budget(1e300, {});
  EXPECT_FALSE(budget.token().stop_requested());
}

}  // namespace
}  // namespace taut
