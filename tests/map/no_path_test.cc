// SPDX-License-Identifier: GPL-3.0-or-later
// Cells that the checker's kernel proves to hold no feasible pose, against an oracle of another route in 200 bits; and
// what is apart or joined on Robot 1's slices.
#include "certificate/no_path.h"

#include <gtest/gtest.h>

#include <random>

#include "kinematics/margin.h"
#include "map/separation.h"
#include "tests/map/problems.h"

namespace taut::testing {
namespace {

using Random = std::mt19937_64;
using checker::OutsideReason;

Cell random_cell(Random& random, std::size_t axes) {
  Cell cell;
  for (std::size_t k = 0; k < axes; ++k) {
    cell.depth[k] = static_cast<std::uint8_t>(4 + random() % 5);
    cell.k[k] = static_cast<std::uint32_t>(random() % (1U << cell.depth[k]));
  }
  return cell;
}

std::vector<double> random_point(Random& random, const Cell& cell, std::size_t axes) {
  std::vector<double> t;
  for (std::size_t k = 0; k < axes; ++k) {
    const double share = std::uniform_real_distribution<double>(0, 1)(random);
    const double inner = cell.lower(k) + share * (cell.upper(k) - cell.lower(k));
    t.push_back(random() % 3 == 0 ? (random() % 2 == 0 ? cell.lower(k) : cell.upper(k)) : inner);
  }
  return t;
}

/// Whether the machine as typed holds all loads at a pose. In 200 bits.
bool is_feasible(const Problem& problem, const campaign::Machine<BigFloat>& machine,
                 const campaign::RigidPose<BigFloat>& pose) {
  const campaign::StaticsAt<BigFloat> at = campaign::statics(machine, pose);
  bool result = true;
  for (std::size_t i = 0; i < kCables; ++i) {
    const Limits& tension = problem.robot.tension_N[i];
    const Limits& length = problem.robot.length_m[i];
    result = result && at.tension_low[i] > oracle::big(tension.lower) &&
             at.tension_high[i] < oracle::big(tension.upper) && at.length[i] > oracle::big(length.lower) &&
             at.length[i] < oracle::big(length.upper);
  }
  return result;
}

/// @returns how many of the cells the kernel proves, by the kind of reason
std::array<int, 3> hold_against_oracle(const Problem& problem, int cells, unsigned seed) {
  Random random(seed);
  const MapSpace space = make_map_space(problem.space);
  const OutsideCells outside(problem);
  const ExactPoses poses(problem, space);
  std::array<int, 3> count{};
  for (int n = 0; n < cells; ++n) {
    const Cell cell = random_cell(random, space.size());
    std::vector<checker::CellPart> parts;
    for (std::size_t k = 0; k < space.size(); ++k) parts.push_back({cell.k[k], cell.depth[k]});
    const std::string tree = outside.tree(parts, {static_cast<OutsideReason::Kind>(n % 3), 0, 0});
    if (tree.empty()) continue;
    for (const char c : tree) {
      if (c >= 'A') ++count.at(c <= 'L' ? 0 : c <= 'l' ? 1 : 2);
    }
    const PrecisionScope precision(oracle::kBits);
    const auto machine = campaign::make_machine<BigFloat>(problem);
    for (int point = 0; point < 4; ++point) {
      const std::vector<double> t = random_point(random, cell, space.size());
      EXPECT_FALSE(is_feasible(problem, machine, poses.at(t))) << t[0] << ", " << t[1] << ": " << tree;
    }
  }
  return count;
}

TEST(OutsideCells, HoldNoFeasiblePose) {
  constexpr int kCells = 200;
  const std::array<int, 3> slice = hold_against_oracle(robot1_slice(), kCells, 1);
  EXPECT_GT(slice[1], 20);
  EXPECT_GT(slice[2], 5);
  EXPECT_GT(hold_against_oracle(robot1_with_items(false), kCells, 2)[1], 20);
  EXPECT_GT(hold_against_oracle(robot1_with_items(true), kCells, 3)[1], 20);
  EXPECT_GT(hold_against_oracle(robot1_sigma_free(), kCells, 4)[1], 20);
}

TEST(OutsideCells, HoldNoPoseWithAllLengthsWithinLimits) {
  Problem problem = robot1_slice();
  for (Limits& limits : problem.robot.length_m) limits = {"0.34", "0.4"};
  EXPECT_GT(hold_against_oracle(problem, 200, 5)[0], 20);
}

TEST(OutsideCells, ProveNothingOfACellWithAFeasiblePose) {
  const Problem problem = robot1_slice();
  const Separation found =
      separate(problem, make_map_space(problem.space), problem.query[0], problem.query[1], SeparationOptions());
  ASSERT_EQ(found.answer, Separation::Answer::kJoined);
  const OutsideCells outside(problem);
  int inside = 0;
  found.map.for_each_leaf([&](const Cell& cell, std::uint32_t node) {
    if (found.map.nodes[node].kind != CellKind::kInside || ++inside % 7 != 0) return;
    EXPECT_EQ(outside.tree({{cell.k[0], cell.depth[0]}, {cell.k[1], cell.depth[1]}}, {}), "");
  });
  EXPECT_GT(inside, 20);
}

// ---- Separation -----------------------------------------------------------------------------------------------------

Separation separated(const Problem& problem, std::vector<ExpressionText> from, std::vector<ExpressionText> to) {
  return separate(problem, make_map_space(problem.space), from, to, {.seconds = 60});
}

TEST(Separation, PartsTheRegionsOfRobot1sSlice) {
  using Answer = Separation::Answer;
  const Problem slice = robot1_slice();
  EXPECT_EQ(separated(slice, {"-2.3", "1.6"}, {"1.7", "1.7"}).answer, Answer::kJoined);
  EXPECT_EQ(separated(slice, {"-2.3", "1.6"}, {"-1.2", "2.0"}).answer, Answer::kApart);
  EXPECT_EQ(separated(slice, {"-1.2", "2.0"}, {"0.8", "1.8"}).answer, Answer::kApart);
  // The same pose, stated otherwise.
  EXPECT_EQ(separated(slice, {"-2.3", "1.6"}, {"1.7 + pi", "-1.7"}).answer, Answer::kJoined);
}

TEST(Separation, IgnoresTolerances) {
  const Problem problem = robot1_with_tolerances(false);
  EXPECT_EQ(separated(problem, {"-2.3", "1.6"}, {"-1.2", "2.0"}).answer, Separation::Answer::kApart);
}

TEST(Separation, SaysWhereAWayMightBe) {
  const Problem slice = robot1_slice();
  const Separation open = separate(slice, make_map_space(slice.space), {"-2.3", "1.6"}, {"-1.2", "2.0"},
                                   {.least_width = 1.0 / 16, .seconds = 60});
  ASSERT_EQ(open.answer, Separation::Answer::kOpen);
  ASSERT_TRUE(open.gap);
  EXPECT_GE(open.gap->cells, 1U);
  EXPECT_GT(open.open_share, 0);
  EXPECT_LT(open.open_share, 1);
}

}  // namespace
}  // namespace taut::testing
