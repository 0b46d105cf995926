// SPDX-License-Identifier: GPL-3.0-or-later
// Cells beyond both kinds of limits against poses by another route (tests/soundness/machine.h).
#include "map/both_limits.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <random>

#include "tests/map/problems.h"

namespace taut::testing {
namespace {

struct Broken {
  bool length = false, tension = false;
};

Broken broken_at(const Problem& problem, const campaign::Machine<BigFloat>& machine,
                 const campaign::RigidPose<BigFloat>& pose) {
  const campaign::StaticsAt<BigFloat> at = campaign::statics(machine, pose);
  Broken result;
  for (std::size_t i = 0; i < kCables; ++i) {
    const Limits& length = problem.robot.length_m[i];
    const Limits& tension = problem.robot.tension_N[i];
    const auto is_within = [](const BigFloat& x, const Limits& limits) {
      return x > oracle::big(limits.lower) && oracle::big(limits.upper) > x;
    };
    result.length |= !is_within(at.length[i], length);
    result.tension |= !is_within(at.tension_low[i], tension) || !is_within(at.tension_high[i], tension);
  }
  return result;
}

TEST(BothLimits, AreBrokenAtEveryPoseOfTheCells) {
  const Problem problem = robot2_sphere();
  const MapSpace space = make_map_space(problem.space);
  const CellMap map = subdivide(problem, space, {.undecided_share = 0.1});
  constexpr double kWidth = 1.0 / 1024;
  const std::vector<Cell> cells = cells_beyond_both(problem, map, kWidth);
  double share = 0;
  for (const Cell& cell : cells) share += cell.volume();

  const PrecisionScope precision(oracle::kBits);
  const ExactPoses poses(problem, space);
  const auto machine = campaign::make_machine<BigFloat>(problem);
  constexpr int kSide = 64;  // of a raster
  int both = 0;
  for (int n = 0; n < kSide * kSide; ++n) {
    const Broken broken = broken_at(problem, machine, poses.at({(n / kSide + 0.5) / kSide, (n % kSide + 0.5) / kSide}));
    both += broken.length && broken.tension ? 1 : 0;
  }
  const double expected = both / static_cast<double>(kSide * kSide);
  EXPECT_GT(expected, 0.001);
  EXPECT_LT(share, expected + 0.01);
  EXPECT_GT(share, 0.6 * expected);

  std::mt19937_64 random(3);
  std::uniform_real_distribution<double> uniform(0, 1);
  for (int n = 0; n < 400; ++n) {
    const Cell& cell = cells[random() % cells.size()];
    std::vector<double> t;
    for (std::size_t k = 0; k < 2; ++k) {
      // The corners of a cell are of it, too.
      const double share_of_width = random() % 3 == 0 ? static_cast<double>(random() % 2) : uniform(random);
      t.push_back(cell.lower(k) + share_of_width * 2 * cell.radius(k));
    }
    const Broken broken = broken_at(problem, machine, poses.at(t));
    EXPECT_TRUE(broken.length && broken.tension) << t[0] << ", " << t[1];
  }
}

TEST(BothLimits, AreNowhereWhereNoLengthIsBroken) {
  const Problem problem = robot1_slice();
  const CellMap map = subdivide(problem, make_map_space(problem.space), {.undecided_share = 0.2});
  EXPECT_EQ(map.share[static_cast<std::size_t>(CellKind::kLength)], 0);
  EXPECT_TRUE(cells_beyond_both(problem, map, 1.0 / 64).empty());
}

}  // namespace
}  // namespace taut::testing
