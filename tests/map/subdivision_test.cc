// SPDX-License-Identifier: GPL-3.0-or-later
#include "map/subdivision.h"

#include <gtest/gtest.h>
#include <tbb/global_control.h>

#include <cstring>

#include "kinematics/pose_sampler.h"
#include "tests/map/problems.h"

namespace taut::testing {
namespace {

CellMap map_of(const Problem& problem, const SubdivisionOptions& options) {
  return subdivide(problem, make_map_space(problem.space), options);
}

TEST(Subdivision, CoversTheSpaceOnceAndCountsItsShares) {
  const CellMap map = map_of(robot1_slice(), {.undecided_share = 0.05});
  EXPECT_EQ(map.end, CellMap::End::kShare);
  EXPECT_LE(map.share[0], 0.05);
  std::array<double, kCellKinds> share{};
  std::size_t leaves = 0;
  double next = 0;  // in the order of the tree
  map.for_each_leaf([&](const Cell& cell, std::uint32_t node) {
    share[static_cast<std::size_t>(map.nodes[node].kind)] += cell.volume();
    next += cell.volume();
    ++leaves;
  });
  EXPECT_EQ(next, 1.0);
  EXPECT_EQ(share, map.share);
  EXPECT_EQ(leaves, map.leaves());
}

TEST(Subdivision, IsTheSameOnAnyNumberOfThreads) {
  const Problem problem = robot1_slice();
  std::optional<CellMap> first;
  for (const std::size_t threads : {1, 2, 5}) {
    const tbb::global_control limit(tbb::global_control::max_allowed_parallelism, threads);
    const CellMap map = map_of(problem, {.undecided_share = 0.05});
    if (!first) first = map;
    EXPECT_TRUE(are_same(*first, map)) << threads;
  }
}

TEST(Subdivision, EndsWhereItIsTold) {
  const Problem problem = robot1_slice();
  const CellMap coarse = map_of(problem, {.least_width = 1.0 / 32, .undecided_share = 0});
  EXPECT_EQ(coarse.end, CellMap::End::kWidth);
  coarse.for_each_leaf([&](const Cell& cell, std::uint32_t) {
    EXPECT_LE(cell.depth[0], 5);
    EXPECT_LE(cell.depth[1], 5);
    EXPECT_EQ(cell.depth[2], 0);
  });
  const CellMap few = map_of(problem, {.undecided_share = 0, .most_cells = 10000});
  EXPECT_EQ(few.end, CellMap::End::kCells);
  EXPECT_LE(few.leaves(), 10000);
  std::stop_source source;
  source.request_stop();
  const CellMap none = map_of(problem, {.stop = source.get_token()});
  EXPECT_EQ(none.end, CellMap::End::kStopped);
  EXPECT_EQ(none.leaves(), 1);
  EXPECT_EQ(none.share[0], 1);
}

/// More work only decides more: no cell's verdict contradicts a larger one's.
TEST(Subdivision, NeverTakesBackWhatItProved) {
  const Problem problem = robot1_slice();
  const CellMap coarse = map_of(problem, {.undecided_share = 0.2});
  const CellMap fine = map_of(problem, {.undecided_share = 0.02});
  for (const std::size_t kind : {1, 2, 3, 4}) EXPECT_GE(fine.share[kind], coarse.share[kind]);
}

/// Poses of a raster in floating point: none contradicts the cell in which it is, unless it is within rounding of a
/// limit.
TEST(Subdivision, AgreesWithARaster) {
  const Problem problem = robot1_slice();
  const CellMap map = map_of(problem, {.undecided_share = 0.01});
  const PoseSampler sampler(problem);
  constexpr double kPi = 3.14159265358979323846;
  constexpr int kColumns = 500, kRows = 250;
  int inside = 0, inside_by_map = 0, undecided = 0;
  for (int column = 0; column < kColumns; ++column) {
    for (int row = 0; row < kRows; ++row) {
      const std::array<double, 2> t = {(column + 0.5) / kColumns, (row + 0.5) / kRows};
      std::uint32_t node = 0;
      Cell cell;
      while (map.nodes[node].axis != MapNode::kLeaf) {
        const std::size_t axis = map.nodes[node].axis;
        const unsigned side = t[axis] > cell.mid(axis) ? 1 : 0;
        node = map.nodes[node].child + side;
        cell = cell.half(axis, side);
      }
      const std::vector<double> parameters = {(2 * t[0] - 1) * kPi, t[1] * kPi};
      const double clearance = sampler.clearance(sampler.statics(sampler.pose(parameters)));
      inside += clearance > 0 ? 1 : 0;
      const CellKind kind = map.nodes[node].kind;
      undecided += kind == CellKind::kUndecided ? 1 : 0;
      inside_by_map += kind == CellKind::kInside ? 1 : 0;
      if (kind == CellKind::kInside) {
        EXPECT_GT(clearance, -1e-9) << parameters[0] << ", " << parameters[1];
      } else if (is_outside(kind)) {
        EXPECT_LT(clearance, 1e-9) << parameters[0] << ", " << parameters[1];
      }
    }
  }
  const double raster = inside / static_cast<double>(kColumns * kRows);
  EXPECT_NEAR(raster, 0.4955, 0.002);
  EXPECT_LE(map.share[1], raster + 0.001);
  EXPECT_GE(map.share[0] + map.share[1], raster - 0.001);
  EXPECT_NEAR(inside_by_map / static_cast<double>(kColumns * kRows), map.share[1], 0.003);
  EXPECT_NEAR(undecided / static_cast<double>(kColumns * kRows), map.share[0], 0.003);
}

}  // namespace
}  // namespace taut::testing
