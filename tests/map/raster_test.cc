// SPDX-License-Identifier: GPL-3.0-or-later
// A map against a raster of 2000 × 1000 poses: by another route (tests/soundness/machine.h) in binary64, and in 200
// bits wherever binary64 is within 1e-3 of a limit, which is where a map might err.
#include <gtest/gtest.h>
#include <tbb/parallel_for.h>

#include <array>
#include <atomic>

#include "map/subdivision.h"
#include "tests/map/bodies.h"
#include "tests/map/problems.h"

namespace taut::testing {
namespace {

struct RasterSize {
  int columns, rows;
};

/// The least slack of any cable, over half the range between the limits; negative where J is singular.
template <class S>
S least_slack(const Problem& problem, const campaign::Machine<S>& machine, const campaign::RigidPose<S>& pose) {
  const campaign::StaticsAt<S> at = campaign::statics(machine, pose);
  S least(1.0);
  if (!(at.determinant * at.determinant > S(0.0))) return S(-1.0);
  const auto consider = [&](const S& value, const Limits& limits) {
    const S lower = campaign::number<S>(limits.lower), upper = campaign::number<S>(limits.upper);
    const S half = (upper - lower) / S(2.0);
    for (const S& slack : std::array<S, 2>{(value - lower) / half, (upper - value) / half}) {
      if (least > slack) least = slack;
    }
  };
  for (std::size_t i = 0; i < kCables; ++i) {
    consider(at.tension_low[i], problem.robot.tension_N[i]);
    consider(at.tension_high[i], problem.robot.tension_N[i]);
    consider(at.length[i], problem.robot.length_m[i]);
  }
  return least;
}

CellKind kind_at(const CellMap& map, const std::array<double, 2>& t) {
  std::uint32_t node = 0;
  Cell cell;
  while (map.nodes[node].axis != MapNode::kLeaf) {
    const std::size_t axis = map.nodes[node].axis;
    const unsigned side = t.at(axis) > cell.mid(axis) ? 1 : 0;
    node = map.nodes[node].child + side;
    cell = cell.half(axis, side);
  }
  return map.nodes[node].kind;
}

struct Counts {
  std::atomic<int> proved{0}, in_200_bits{0}, inside{0}, contact{0};
};

void check(const Problem& problem, const CellMap& map, const RasterSize& raster, int column, Counts& counts) {
  constexpr double kNear = 1e-3;
  constexpr double kPi = 3.14159265358979323846;
  const ExactPoses poses(problem, map.space);
  const campaign::Machine<double> machine = campaign::make_machine<double>(problem);
  const PrecisionScope precision(oracle::kBits);
  const campaign::Machine<BigFloat> exact_machine = campaign::make_machine<BigFloat>(problem);
  std::optional<BodiesOracle> bodies;
  if (problem.bodies) bodies.emplace(problem);
  for (int row = 0; row < raster.rows; ++row) {
    const std::array<double, 2> t = {(column + 0.5) / raster.columns, (row + 0.5) / raster.rows};
    const CellKind kind = kind_at(map, t);
    const campaign::RigidPose<double> pose{{0, 0, 0.35},
                                           campaign::orientation((2 * t[0] - 1) * kPi, t[1] * kPi, 34 * kPi / 180)};
    const double slack = least_slack(problem, machine, pose);
    bool is_feasible = slack > 0;
    if (!(std::abs(slack) > kNear)) {
      ++counts.in_200_bits;
      is_feasible = least_slack(problem, exact_machine, poses.at({t[0], t[1]})) > BigFloat(0.0);
    }
    if (bodies && is_feasible) {
      constexpr double kNearBodies = 1e-7;  // [m]
      const double clear = bodies->least_slack(machine, pose);
      is_feasible = clear > 0;
      if (!(std::abs(clear) > kNearBodies)) {
        ++counts.in_200_bits;
        // Where hulls overlap that have no thickness, the nearest points are found to so much.
        is_feasible = bodies->least_slack(exact_machine, poses.at({t[0], t[1]})) > BigFloat(1e-12);
      }
      counts.contact += is_feasible ? 0 : 1;
    }
    counts.inside += is_feasible ? 1 : 0;
    if (kind == CellKind::kUndecided) continue;
    ++counts.proved;
    EXPECT_EQ(kind == CellKind::kInside, is_feasible) << t[0] << ", " << t[1];
  }
}

TEST(Raster, ContradictsNoCellOfRobot1sSlice) {
  const Problem problem = robot1_slice();
  const CellMap map =
      subdivide(problem, make_map_space(problem.space), {.least_width = 1.0 / 8192, .undecided_share = 0.0005});
  constexpr RasterSize kRaster = {2000, 1000};
  Counts counts;
  tbb::parallel_for(0, kRaster.columns, [&](int column) { check(problem, map, kRaster, column, counts); });
  const double all = static_cast<double>(kRaster.columns) * kRaster.rows;
  RecordProperty("proved", std::to_string(counts.proved));
  RecordProperty("in_200_bits", std::to_string(counts.in_200_bits));
  RecordProperty("inside", std::to_string(counts.inside));
  std::printf("%zu cells; of %.0f poses %d in proved cells, %d judged in 200 bits, %d feasible\n", map.leaves(), all,
              counts.proved.load(), counts.in_200_bits.load(), counts.inside.load());
  EXPECT_GT(counts.proved, 0.998 * all);
  EXPECT_GT(counts.in_200_bits, 1000);
  EXPECT_NEAR(counts.inside / all, 0.4955, 0.0005);
}

/// Bodies touch in much of what limits allow.
TEST(Raster, ContradictsNoCellWithBodies) {
  const Problem problem = with_bodies(robot1_slice());
  const CellMap map =
      subdivide(problem, make_map_space(problem.space), {.least_width = 1.0 / 4096, .undecided_share = 0.004});
  constexpr RasterSize kRaster = {700, 350};
  Counts counts;
  tbb::parallel_for(0, kRaster.columns, [&](int column) { check(problem, map, kRaster, column, counts); });
  const double all = static_cast<double>(kRaster.columns) * kRaster.rows;
  std::printf("%zu cells; of %.0f poses %d in proved cells, %d judged in 200 bits, %d feasible, %d in contact alone\n",
              map.leaves(), all, counts.proved.load(), counts.in_200_bits.load(), counts.inside.load(),
              counts.contact.load());
  EXPECT_GT(counts.proved, 0.99 * all);
  EXPECT_GT(counts.contact, 0.05 * all);
  EXPECT_GT(counts.inside, 0.05 * all);
}

}  // namespace
}  // namespace taut::testing
