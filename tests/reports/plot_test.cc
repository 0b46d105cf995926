#include "reports/plot.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <limits>

namespace taut {
namespace {

using ::testing::DoubleNear;
using ::testing::ElementsAre;

TEST(Ticks, AreRoundNumbersWithinTheSpan) {
  EXPECT_THAT(ticks({0.05, 0.52}, 5),
              ElementsAre(DoubleNear(0.1, 1e-12), DoubleNear(0.2, 1e-12), DoubleNear(0.3, 1e-12),
                          DoubleNear(0.4, 1e-12), DoubleNear(0.5, 1e-12)));
  EXPECT_THAT(ticks({-3.2, 3.2}, 6), ElementsAre(-3, -2, -1, 0, 1, 2, 3));
}

TEST(Ticks, CountWholeThingsByWholeNumbers) { EXPECT_THAT(ticks({0, 2}, 8, true), ElementsAre(0, 1, 2)); }

TEST(Ticks, AreNoneForAnEmptyOrEndlessSpan) {
  EXPECT_TRUE(ticks({1, 1}, 5).empty());
  EXPECT_TRUE(ticks({0, std::numeric_limits<double>::infinity()}, 5).empty());
}

TEST(Coordinate, IsShortAndFinite) {
  EXPECT_EQ(coordinate(12.34), "12.3");
  EXPECT_EQ(coordinate(12.0), "12");
  EXPECT_EQ(coordinate(-0.01), "0");
  EXPECT_EQ(coordinate(1e300), "100000");
  EXPECT_EQ(coordinate(std::nan("")), "100000");
}

TEST(Plot, PutsTheUpperEndOfTheYAxisOnTop) {
  const Plot plot(100, 50, {{0, 10}, {}}, {{0, 5}, {}});
  EXPECT_EQ(plot.polyline({{0, 0}, {10, 5}}), "M0 50L100 0");
}

TEST(Plot, BreaksALineWhereAPointIsNotFinite) {
  const Plot plot(10, 10, {{0, 10}, {}}, {{0, 10}, {}});
  EXPECT_EQ(plot.polyline({{0, 0}, {1, std::nan("")}, {2, 0}, {3, 0}}), "M0 10M2 10L3 10");
}

}  // namespace
}  // namespace taut
