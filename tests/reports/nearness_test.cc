// SPDX-License-Identifier: GPL-3.0-or-later
#include "reports/summary/nearness.h"

#include <gtest/gtest.h>

#include <limits>

namespace taut {
namespace {

constexpr double kNaN = std::numeric_limits<double>::quiet_NaN();

TEST(Nearness, IsThatOfTheGreatestTensionToItsUpperLimit) {
  EXPECT_EQ(nearness_to_top({0, 0.374}, 0.5), Nearness::kCalm);
  EXPECT_EQ(nearness_to_top({0, 0.375}, 0.5), Nearness::kNear);
  EXPECT_EQ(nearness_to_top({0, 0.4751}, 0.5), Nearness::kClose);
  EXPECT_EQ(nearness_to_top({0, 0.5}, 0.5), Nearness::kOut);
  EXPECT_EQ(nearness_to_top({0, kNaN}, 0.5), Nearness::kOut);
}

TEST(Nearness, IsThatOfTheLeastTensionToItsLowerLimit) {
  EXPECT_EQ(nearness_to_slack({1.4, 9}, 1, 10), Nearness::kCalm);
  EXPECT_EQ(nearness_to_slack({1.3, 9}, 1, 10), Nearness::kNear);
  EXPECT_EQ(nearness_to_slack({1.05, 9}, 1, 10), Nearness::kClose);
  EXPECT_EQ(nearness_to_slack({1, 9}, 1, 10), Nearness::kOut);
  EXPECT_EQ(nearness_to_slack({kNaN, 9}, 1, 10), Nearness::kOut);
}

TEST(Nearness, ToALowerLimitOfZeroIsAShareOfTheWidth) {
  EXPECT_EQ(nearness_to_slack({3, 9}, 0, 10), Nearness::kCalm);
  EXPECT_EQ(nearness_to_slack({2, 9}, 0, 10), Nearness::kNear);
  EXPECT_EQ(nearness_to_slack({0.4, 9}, 0, 10), Nearness::kClose);
  EXPECT_EQ(nearness_to_slack({0, 9}, 0, 10), Nearness::kOut);
}

TEST(Nearness, OfALengthIsThatToTheNearerLimit) {
  EXPECT_EQ(nearness_of_length({20, 80}, 0, 100), Nearness::kCalm);
  EXPECT_EQ(nearness_of_length({20, 96}, 0, 100), Nearness::kNear);
  EXPECT_EQ(nearness_of_length({1, 80}, 0, 100), Nearness::kClose);
  EXPECT_EQ(nearness_of_length({0, 80}, 0, 100), Nearness::kOut);
  EXPECT_EQ(nearness_of_length({20, kNaN}, 0, 100), Nearness::kOut);
  EXPECT_EQ(nearness_of_length({kNaN, 80}, 0, 100), Nearness::kOut);
}

}  // namespace
}  // namespace taut
