// SPDX-License-Identifier: GPL-3.0-or-later
#include "planner/smooth.h"

#include <gtest/gtest.h>

#include <cmath>

#include "kinematics/motion_length.h"
#include "tests/support/robots.h"

namespace taut {
namespace {

using testing::at;
using testing::robot1_slice;

double length(const Path& path) {
  return motion_length(path, curve_parameters, [](const std::vector<double>& a, const std::vector<double>& b) {
    return std::hypot(a[0] - b[0], a[1] - b[1]);
  });
}

Waypoint halfway(const Waypoint& a, const Waypoint& b) {
  return at({0.5 * (a.parameters().x[0] + b.parameters().x[0]), 0.5 * (a.parameters().x[1] + b.parameters().x[1])});
}

/// A corner within the wrench-feasible part of the slice.
const Path kCorner{{at({-2.3, 1.6}), at({-2.2, 1.3}), at({-1.9, 1.2})}};

TEST(Smooth, RoundsACornerProvesItAndIsShorter) {
  const Prover prover(robot1_slice());
  ASSERT_EQ(prove_path(prover, kCorner).verdict, Verdict::kProved);
  const auto rounded = smooth(kCorner, {0, 2}, {prover, 0, length, halfway});
  ASSERT_TRUE(rounded);
  EXPECT_EQ(rounded->path.interpolation, Interpolation::kCubicBSpline);
  EXPECT_EQ(rounded->proof.verdict, Verdict::kProved);
  EXPECT_EQ(rounded->proof.segments.size(), rounded->path.segments());
  EXPECT_LT(rounded->length, length(kCorner));
  EXPECT_EQ(curve_parameters(rounded->path.segment(0), 0), kCorner.waypoints.front().parameters().x);
  EXPECT_EQ(curve_parameters(rounded->path.segment(rounded->path.segments() - 1), 1),
            kCorner.waypoints.back().parameters().x);
}

TEST(Smooth, PassesThroughEachStop) {
  const Prover prover(robot1_slice());
  const auto rounded = smooth(kCorner, {0, 1, 2}, {prover, 0, length, halfway});
  ASSERT_TRUE(rounded);
  int passed = 0;
  for (std::size_t k = 0; k < rounded->path.segments(); ++k) {
    if (curve_parameters(rounded->path.segment(k), 0) == kCorner.waypoints[1].parameters().x) ++passed;
  }
  EXPECT_GE(passed, 1);
}

TEST(Smooth, HugsThePathWhereTheInsideOfTheCornerComesTooCloseToALimit) {
  const Prover prover(robot1_slice());
  const auto coarse = smooth(kCorner, {0, 2}, {prover, 0, length, halfway});
  ASSERT_TRUE(coarse);
  // The largest clearance of the path itself, in steps of a fiftieth. Its spline needs control points near the corner.
  const auto has = [&](const Path& path, double clearance) {
    for (std::size_t k = 0; k < path.segments(); ++k) {
      if (prover.prove(path.segment(k), clearance).verdict != Verdict::kProved) return false;
    }
    return true;
  };
  double clearance = 0;
  while (has(kCorner, clearance + 0.02)) clearance += 0.02;
  ASSERT_GT(clearance, 0);
  const auto careful = smooth(kCorner, {0, 2}, {prover, clearance, length, halfway});
  ASSERT_TRUE(careful);
  EXPECT_TRUE(has(careful->path, clearance));
  EXPECT_GE(careful->path.segments(), coarse->path.segments());
}

TEST(Smooth, GivesNothingForAPathThatIsNotFeasible) {
  const Prover prover(robot1_slice());
  const Path infeasible{{at({-2.3, 1.6}), at({-0.3, 1.65}), at({1.7, 1.7})}};
  EXPECT_FALSE(smooth(infeasible, {0, 2}, {prover, 0, length, halfway}));
}

}  // namespace
}  // namespace taut
