// SPDX-License-Identifier: GPL-3.0-or-later
// Cells that the checker's kernel proves to hold no feasible pose, against an oracle of another route in 200 bits; and
// what is apart or joined on Robot 1's slices.
#include "certificate/no_path.h"

#include <gtest/gtest.h>

#include <random>
#include <string>
#include <vector>

#include "kinematics/margin.h"
#include "map/separation.h"
#include "tests/map/bodies.h"
#include "tests/map/problems.h"
#include "tests/map/random_map.h"

namespace taut::testing {
namespace {

using checker::OutsideReason;

Cell random_cell(Random& random, std::size_t axes) {
  Cell cell;
  for (std::size_t k = 0; k < axes; ++k) {
    cell.depth[k] = static_cast<std::uint8_t>(4 + random() % 5);
    cell.k[k] = static_cast<std::uint32_t>(random() % (1U << cell.depth[k]));
  }
  return cell;
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

/// By the kind of reason: lengths, balances that follow or are fixed, contact.
using ProvedCells = std::array<int, 4>;

/// @returns how many of the cells the kernel proves
ProvedCells hold_against_oracle(const Problem& problem, int cells, unsigned seed) {
  Random random(seed);
  const MapSpace space = make_map_space(problem.space);
  const OutsideCells outside(problem);
  const ExactPoses poses(problem, space);
  ProvedCells count{};
  std::optional<BodiesOracle> bodies;
  if (problem.bodies) bodies.emplace(problem);
  for (int n = 0; n < cells; ++n) {
    const Cell cell = random_cell(random, space.size());
    std::vector<checker::CellPart> parts;
    for (std::size_t k = 0; k < space.size(); ++k) parts.push_back({cell.k[k], cell.depth[k]});
    const auto& [tree, contacts] = outside.tree(parts, {{static_cast<OutsideReason::Kind>(n % 3), 0, 0}, {}});
    if (tree.empty()) continue;
    for (const char c : tree) {
      if (c >= 'A') ++count.at(c <= 'L' ? 0 : c <= 'l' ? 1 : c <= 'x' ? 2 : 3);
    }
    EXPECT_EQ(static_cast<std::size_t>(std::ranges::count(tree, checker::kContactLeaf)), contacts.size());
    const PrecisionScope precision(oracle::kBits);
    const auto machine = campaign::make_machine<BigFloat>(problem);
    for (int point = 0; point < 4; ++point) {
      const std::vector<double> t = random_point(random, cell, space.size());
      bool touches = false;
      for (const checker::ContactReason& contact : contacts) {
        touches = touches || bodies->slack(machine, poses.at(t), contact.pair).to_double() < 1e-12;
      }
      // Where the whole cell is one leaf, its own reason holds.
      EXPECT_TRUE(touches || (tree != "y" && !is_feasible(problem, machine, poses.at(t))))
          << t[0] << ", " << t[1] << ": " << tree;
    }
  }
  return count;
}

TEST(OutsideCells, HoldNoFeasiblePose) {
  constexpr int kCells = 80;
  const ProvedCells slice = hold_against_oracle(robot1_slice(), kCells, 1);
  EXPECT_GT(slice[1], 10);
  EXPECT_GT(slice[2], 0);
  EXPECT_GT(hold_against_oracle(robot1_with_items(false), kCells, 2)[1], 10);
  EXPECT_GT(hold_against_oracle(robot1_with_items(true), kCells, 3)[1], 10);
  EXPECT_GT(hold_against_oracle(robot1_sigma_free(), kCells, 4)[1], 10);
}

TEST(OutsideCells, HoldNoPoseWhoseBodiesAreApart) {
  Problem problem = with_bodies(robot1_slice());
  for (Limits& limits : problem.robot.tension_N) limits = {"0", "1e9"};  // contact alone decides
  EXPECT_GT(hold_against_oracle(problem, 150, 6)[3], 30);
  problem = with_bodies(robot1_sigma_free());
  for (Limits& limits : problem.robot.tension_N) limits = {"0", "1e9"};
  EXPECT_GT(hold_against_oracle(problem, 100, 7)[3], 20);
  problem = with_zones(robot1_slice());
  for (Limits& limits : problem.robot.tension_N) limits = {"0", "1e9"};
  EXPECT_GT(hold_against_oracle(problem, 150, 8)[3], 20);
  problem = with_exit_cones(robot1_slice());
  for (Limits& limits : problem.robot.tension_N) limits = {"0", "1e9"};
  EXPECT_GT(hold_against_oracle(problem, 150, 9)[3], 20);
}

TEST(OutsideCells, HoldNoPoseWithAllLengthsWithinLimits) {
  Problem problem = robot1_slice();
  for (Limits& limits : problem.robot.length_m) limits = {"0.34", "0.4"};
  EXPECT_GT(hold_against_oracle(problem, 60, 5)[0], 10);
}

TEST(OutsideCells, ProveNothingOfACellWithAFeasiblePose) {
  const Problem problem = robot1_slice();
  const Separation found =
      separate(problem, make_map_space(problem.space), problem.query[0], problem.query[1], SeparationOptions());
  ASSERT_EQ(found.answer, Separation::Answer::kJoined);
  const OutsideCells outside(problem);
  int inside = 0;
  found.map.for_each_leaf([&](const Cell& cell, std::uint32_t node) {
    if (found.map.nodes[node].kind != CellKind::kInside || ++inside % 29 != 0) return;
    EXPECT_EQ(outside.tree({{cell.k[0], cell.depth[0]}, {cell.k[1], cell.depth[1]}}, {}).tree, "");
  });
  EXPECT_GT(inside, 100);
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

/// Feasible poses on a raster, and what hangs together by steps between neighbouring ones. In double.
class Raster {
 public:
  static constexpr int kTurn = 360, kTilt = 180;

  explicit Raster(const Problem& problem) {
    const auto machine = campaign::make_machine<double>(problem);
    constexpr double kPi = 3.14159265358979323846;
    for (int i = 0; i < kTurn; ++i) {
      for (int j = 0; j < kTilt; ++j) {
        const double phi = kPi * (2.0 * (i + 0.5) / kTurn - 1), theta = kPi * (j + 0.5) / kTilt;
        const campaign::RigidPose<double> pose = {{0, 0, 0.35}, campaign::orientation(phi, theta, 34 * kPi / 180)};
        const campaign::StaticsAt<double> at = campaign::statics(machine, pose);
        state_[index(i, j)] = !is_feasible(problem, at) ? 0 : at.determinant > 0 ? 1 : -1;
      }
    }
  }
  static int index(int i, int j) { return ((i % kTurn + kTurn) % kTurn) * kTilt + j; }

  /// Numbers what hangs together by steps of phi or theta, and across theta = pi to phi + pi. A step never changes the
  /// sign of det J, as it would pass a singular pose.
  [[nodiscard]] std::vector<int> components() const {
    std::vector<int> component(state_.size(), -1);
    for (int start = 0, count = 0; start < kTurn * kTilt; ++start) {
      if (state_[start] == 0 || component[start] >= 0) continue;
      std::vector<int> pending = {start};
      component[start] = count;
      while (!pending.empty()) {
        const int i = pending.back() / kTilt, j = pending.back() % kTilt;
        pending.pop_back();
        std::vector<int> next = {index(i + 1, j), index(i - 1, j)};
        if (j > 0) next.push_back(index(i, j - 1));
        next.push_back(j + 1 < kTilt ? index(i, j + 1) : index(i + kTurn / 2, j));
        for (const int n : next) {
          if (state_[n] != state_[start] || component[n] >= 0) continue;
          component[n] = count;
          pending.push_back(n);
        }
      }
      ++count;
    }
    return component;
  }

 private:
  static bool is_feasible(const Problem& problem, const campaign::StaticsAt<double>& at) {
    bool result = true;
    for (std::size_t i = 0; i < kCables; ++i) {
      const auto within = [](double low, double high, const Limits& limits) {
        return low > std::stod(limits.lower) && high < std::stod(limits.upper);
      };
      result = result && within(at.tension_low[i], at.tension_high[i], problem.robot.tension_N[i]) &&
               within(at.length[i], at.length[i], problem.robot.length_m[i]);
    }
    return result;
  }
  std::vector<int> state_ = std::vector<int>(kTurn * kTilt);  ///< 0: infeasible; else the sign of det J
};

/// Limits are changed at random, so that passages are narrow where they are: no pair of poses that feasible poses of a
/// raster join is ever called apart.
TEST(Separation, IsNotContradictedByARaster) {
  Random random(34);
  int apart = 0, joined = 0;
  for (int trial = 0; trial < 12; ++trial) {
    Problem problem = robot1_slice();
    const std::string most = std::to_string(0.4 + 0.02 * static_cast<double>(random() % 10));
    const std::string least = std::to_string(0.02 + 0.01 * static_cast<double>(random() % 6));
    for (Limits& limits : problem.robot.tension_N) limits = {least, most};
    const Raster raster(problem);
    const std::vector<int> component = raster.components();
    std::vector<int> feasible;
    for (int n = 0; n < static_cast<int>(component.size()); ++n) {
      if (component[n] >= 0) feasible.push_back(n);
    }
    ASSERT_GT(feasible.size(), 100U);
    for (int pair = 0; pair < 6; ++pair) {
      const int a = feasible[random() % feasible.size()], b = feasible[random() % feasible.size()];
      const auto place = [](int at) -> std::vector<ExpressionText> {
        const int i = at / Raster::kTilt, j = at % Raster::kTilt;
        return {"pi*(" + std::to_string(2 * i + 1) + "/360-1)", "pi*" + std::to_string(2 * j + 1) + "/360"};
      };
      const Separation found = separated(problem, place(a), place(b));
      if (found.answer == Separation::Answer::kApart) {
        ++apart;
        EXPECT_NE(component[a], component[b]) << "limits " << least << " to " << most;
      } else if (found.answer == Separation::Answer::kJoined) {
        ++joined;
      }
    }
  }
  EXPECT_GT(apart, 8);
  EXPECT_GT(joined, 8);
}

TEST(Separation, SaysWhereAWayMightBe) {
  const Problem slice = robot1_slice();
  const Separation open = separate(slice, make_map_space(slice.space), {"-2.3", "1.6"}, {"-1.2", "2.0"},
                                   {.least_width = 1.0 / 16, .seconds = 60});
  ASSERT_EQ(open.answer, Separation::Answer::kOpen);
  ASSERT_TRUE(open.gap);
  EXPECT_GE(open.gap->cells, 1U);
  EXPECT_GT(open.open_share, 0);
  EXPECT_LE(open.open_share, 1);
  EXPECT_EQ(open.gap->at.size(), 2U);
}

}  // namespace
}  // namespace taut::testing
