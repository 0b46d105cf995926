// SPDX-License-Identifier: GPL-3.0-or-later
// Cells against an oracle of another route (tests/soundness/machine.h) in 200 bits: random poses of a cell that is
// proved inside are feasible, with deviations too; those of a cell that is proved outside violate what it says.
#include "map/cell_proof.h"

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <random>

#include "map/subdivision.h"
#include "tests/map/bodies.h"
#include "tests/map/problems.h"
#include "tests/map/random_map.h"

namespace taut::testing {
namespace {

constexpr std::array<MarginId, 4 * kCables> kMargins = all_margins();

class CellOracle {
 public:
  explicit CellOracle(const Problem& problem)
      : space_(make_map_space(problem.space)),
        problem_(problem),
        poses_(problem_, space_),
        machine_(campaign::make_machine<BigFloat>(problem)),
        tolerances_(campaign::make_tolerances<BigFloat>(problem)) {
    if (problem.bodies) bodies_.emplace(problem);
  }

  /// Slacks of all margins; all negative where J is singular.
  [[nodiscard]] std::vector<BigFloat> slacks(const campaign::Machine<BigFloat>& machine,
                                             const campaign::RigidPose<BigFloat>& pose) const {
    const campaign::StaticsAt<BigFloat> at = campaign::statics(machine, pose);
    std::vector<BigFloat> result;
    for (const MarginId& margin : kMargins) {
      const auto i = static_cast<std::size_t>(margin.cable);
      const Limits& tension = problem_.robot.tension_N[i];
      const Limits& length = problem_.robot.length_m[i];
      switch (margin.kind) {
        case MarginKind::kTensionMin: result.push_back(at.tension_low[i] - oracle::big(tension.lower)); break;
        case MarginKind::kTensionMax: result.push_back(oracle::big(tension.upper) - at.tension_high[i]); break;
        case MarginKind::kLengthMin: result.push_back(at.length[i] - oracle::big(length.lower)); break;
        case MarginKind::kLengthMax: result.push_back(oracle::big(length.upper) - at.length[i]); break;
      }
    }
    return result;
  }

  /// Whether what is proved of a cell holds at a pose of it.
  void check(Random& random, const Cell& cell, const MapNode& node) const {
    const PrecisionScope precision(oracle::kBits);
    const std::vector<double> t = random_point(random, cell, space_.size());
    const campaign::RigidPose<BigFloat> pose = poses_.at(t);
    const std::vector<BigFloat> slack = slacks(machine_, pose);
    const BigFloat zero(0.0);
    const bool is_feasible = std::ranges::all_of(slack, [&](const BigFloat& x) { return x > zero; });
    switch (node.kind) {
      case CellKind::kUndecided: break;
      case CellKind::kInside:
        EXPECT_TRUE(is_feasible) << t[0] << ", " << t[1];
        expect_apart(machine_, pose);
        check_deviation(random, pose);
        break;
      case CellKind::kLength:
      case CellKind::kTension: EXPECT_FALSE(slack[node.reason] > zero) << t[0] << ", " << t[1]; break;
      case CellKind::kUnbalanced: EXPECT_FALSE(is_feasible) << t[0] << ", " << t[1]; break;
      case CellKind::kContact:
        EXPECT_LT(bodies_->slack(machine_, pose, node.reason).to_double(), 1e-12)
            << t[0] << ", " << t[1] << ": " << bodies_->name(node.reason);
        break;
    }
    if (node.regular) {
      EXPECT_TRUE(abs(campaign::statics(machine_, pose).determinant) > zero);
    }
  }

  [[nodiscard]] const MapSpace& space() const { return space_; }

 private:
  void check_deviation(Random& random, const campaign::RigidPose<BigFloat>& commanded) const {
    using namespace campaign;
    if (!problem_.tolerances) return;
    campaign::Deviation deviation;
    campaign::for_each_block(deviation, [&](std::span<double> block) {
      std::normal_distribution<double> normal;
      double square = 0;
      for (double& x : block) {
        x = normal(random);
        square += x * x;
      }
      for (double& x : block) x *= 0.999999 / std::sqrt(square);
    });
    // Anchors that are typed as one point move as one.
    const auto move_as_one = [&](const auto& anchors, auto& by) {
      for (std::size_t i = 0; i < kCables; ++i) {
        by[i] = by[static_cast<std::size_t>(std::ranges::find(anchors, anchors[i]) - anchors.begin())];
      }
    };
    if (bodies_) {
      move_as_one(problem_.robot.base_anchors_m, deviation.a);
      move_as_one(problem_.robot.platform_anchors_m, deviation.b);
    }
    const auto machine = campaign::deviate(machine_, tolerances_, deviation);
    campaign::RigidPose<BigFloat> pose = commanded;
    if (tolerances_.length_controlled) {
      campaign::Six<BigFloat> wanted = campaign::lengths(machine_, commanded);
      for (std::size_t i = 0; i < kCables; ++i) {
        wanted[i] = wanted[i] + tolerances_.length[i] * BigFloat(deviation.length[i]);
      }
      const auto held = campaign::hold(machine, pose, wanted, 50);
      ASSERT_TRUE(held);
      pose = *held;
    }
    pose.p = pose.p + campaign::scaled(tolerances_.position, deviation.position);
    pose.r = campaign::turn(campaign::scaled(tolerances_.turn, deviation.turn)) * pose.r;
    for (const BigFloat& x : slacks(machine, pose)) EXPECT_TRUE(x > BigFloat(0.0));
    expect_apart(machine, pose);
  }

  void expect_apart(const campaign::Machine<BigFloat>& machine, const campaign::RigidPose<BigFloat>& pose) const {
    for (std::size_t n = 0; bodies_ && n < bodies_->pairs(); ++n) {
      EXPECT_TRUE(bodies_->slack(machine, pose, n) > BigFloat(0.0)) << bodies_->name(n);
    }
  }

  MapSpace space_;
  Problem problem_;
  ExactPoses poses_;
  campaign::Machine<BigFloat> machine_;
  campaign::Tolerances<BigFloat> tolerances_;
  std::optional<BodiesOracle> bodies_;
};

/// Every kind of cell that `kinds` names is among those checked, as many of each as there are tries for it.
void check_cells(const Problem& problem, const SubdivisionOptions& options, const std::vector<CellKind>& kinds,
                 int tries = 400) {
  const CellOracle oracle(problem);
  const CellMap map = subdivide(problem, oracle.space(), options);
  std::array<std::vector<std::pair<Cell, std::uint32_t>>, kCellKinds> leaves;
  map.for_each_leaf([&](const Cell& cell, std::uint32_t node) {
    leaves[static_cast<std::size_t>(map.nodes[node].kind)].emplace_back(cell, node);
  });
  Random random(7);
  for (const CellKind kind : kinds) {
    const auto& cells = leaves[static_cast<std::size_t>(kind)];
    ASSERT_FALSE(cells.empty()) << static_cast<int>(kind);
    for (int n = 0; n < tries; ++n) {
      // Half of them among the largest, which claim most.
      const std::size_t range = n % 2 == 0 ? cells.size() : std::min<std::size_t>(cells.size(), 20);
      const auto& [cell, node] = cells[random() % range];
      oracle.check(random, cell, map.nodes[node]);
    }
  }
}

using enum CellKind;

TEST(CellProof, AgreesWithTheOracleOnRobot1) {
  check_cells(robot1_slice(), {.undecided_share = 0.03}, {kInside, kTension, kUnbalanced});
}

TEST(CellProof, AgreesWithTheOracleWhereLengthsAreLimited) {
  Problem problem = robot1_slice();
  problem.robot.length_m[1] = {"0.25", "0.42"};
  problem.robot.length_m[4] = {"0.3", "0.45"};
  check_cells(problem, {.undecided_share = 0.05}, {kInside, kLength, kTension, kUnbalanced});
}

TEST(CellProof, AgreesWithTheOracleOnASphere) {
  check_cells(robot2_sphere(), {.undecided_share = 0.1}, {kInside, kLength, kTension, kUnbalanced});
}

TEST(CellProof, AgreesWithTheOracleForItems) {
  check_cells(robot1_with_items(false), {.undecided_share = 0.05}, {kInside, kTension, kUnbalanced}, 150);
  check_cells(robot1_with_items(true), {.undecided_share = 0.05}, {kInside, kTension, kUnbalanced}, 150);
}

TEST(CellProof, AgreesWithTheOracleForDeviations) {
  for (const bool length_controlled : {false, true}) {
    check_cells(robot1_with_tolerances(length_controlled), {.least_width = 1.0 / 256, .undecided_share = 0.1},
                {kInside, kTension, kUnbalanced}, 150);
  }
}

TEST(CellProof, AgreesWithTheOracleInThreeCoordinates) {
  check_cells(robot1_sigma_free(), {.undecided_share = 0.4, .most_cells = 200'000}, {kInside, kTension, kUnbalanced},
              150);
}

TEST(CellProof, AgreesWithTheOracleForBodies) {
  check_cells(with_bodies(robot1_slice()), {.undecided_share = 0.1}, {kInside, kTension, kUnbalanced, kContact});
  check_cells(with_bodies(robot1_with_items(true)), {.undecided_share = 0.2}, {kInside, kContact}, 100);
  check_cells(with_bodies(robot1_sigma_free()), {.undecided_share = 0.5, .most_cells = 150'000}, {kInside, kContact},
              150);
}

TEST(CellProof, AgreesWithTheOracleForBodiesThatMayTouchSomewhere) {
  check_cells(with_zones(robot1_slice()), {.undecided_share = 0.1}, {kInside, kTension, kUnbalanced, kContact});
  check_cells(with_zones(robot1_sigma_free()), {.undecided_share = 0.5, .most_cells = 100'000}, {kInside, kContact},
              100);
}

TEST(CellProof, AgreesWithTheOracleForBodiesOfMachinesThatDeviate) {
  for (const bool length_controlled : {false, true}) {
    check_cells(with_bodies(robot1_with_tolerances(length_controlled)),
                {.least_width = 1.0 / 256, .undecided_share = 0.2}, {kInside, kContact}, 100);
  }
}

/// Bodies that overlap deeply are told in large cells, though no two of their points stay together there: a stick that
/// reaches far into a box, both without thickness and clearance.
TEST(CellProof, TellsDeepContactInLargeCells) {
  Problem problem = robot1_slice();
  BodiesText bodies;
  bodies.platform = {box_body("stick", {"0.01", "0.01", "0.1"}, {"0", "0", "0.1"})};
  bodies.obstacles = {box_body("block", {"0.2", "0.2", "0.1"}, {"0", "0", "0.45"})};
  bodies.clearance_m[0] = "0";
  problem.bodies = bodies;
  validate(problem);
  const CellMap map = subdivide(problem, make_map_space(problem.space), {.undecided_share = 0.03});
  double largest = 0;
  map.for_each_leaf([&](const Cell& cell, std::uint32_t node) {
    if (map.nodes[node].kind == kContact) largest = std::max(largest, cell.volume());
  });
  EXPECT_GT(largest, 1.0 / 300);
  EXPECT_LT(map.leaves(), 40'000U);
}

TEST(CellProof, AgreesWithTheOracleForExitCones) {
  check_cells(with_exit_cones(robot1_slice()), {.undecided_share = 0.05}, {kInside, kContact});
  check_cells(with_exit_cones(robot1_with_tolerances(false)), {.least_width = 1.0 / 256, .undecided_share = 0.2},
              {kInside, kContact}, 100);
}

/// As above, but the block may be entered by less than it is entered.
TEST(CellProof, TellsWhereBodiesAreDeeperThanTheyMayBe) {
  Problem problem = robot1_slice();
  BodiesText bodies;
  bodies.platform = {box_body("stick", {"0.01", "0.01", "0.1"}, {"0", "0", "0.1"})};
  bodies.obstacles = {box_body("block", {"0.2", "0.2", "0.1"}, {"0", "0", "0.45"})};
  bodies.clearance_m[0] = "0";
  bodies.contacts = {{{"block", "stick"}, {{"0", "0", "0"}, "10", "0.02"}}};
  problem.bodies = bodies;
  check_cells(problem, {.undecided_share = 0.1}, {kContact});
}

TEST(CellProof, RefusesMeshes) {
  Problem problem = with_bodies(robot1_slice());
  problem.bodies->obstacles.push_back({.name = "part", .shape = MeshText{"part.stl", std::string(64, '0'), "1"}});
  EXPECT_THROW((void)make_cell_proof(problem, make_map_space(problem.space)), FieldError);
}

/// Cells that hold a singular pose are never inside, and never said to be regular.
TEST(CellProof, NeverCallsACellRegularThatHoldsASingularPose) {
  const Problem problem = robot1_slice();
  const MapSpace space = make_map_space(problem.space);
  const CellMap map = subdivide(problem, space, {.undecided_share = 0.02});
  const CellOracle oracle(problem);
  const campaign::Machine<double> machine = campaign::make_machine<double>(problem);
  const auto determinant = [&](double t0, double t1) {
    const double pi = 3.14159265358979323846;
    const campaign::RigidPose<double> pose{{0, 0, 0.35},
                                           campaign::orientation((2 * t0 - 1) * pi, t1 * pi, 34 * pi / 180)};
    return campaign::statics(machine, pose).determinant;
  };
  int mixed = 0;
  map.for_each_leaf([&](const Cell& cell, std::uint32_t node) {
    int positive = 0;
    for (const auto& [a, b] : {std::pair{cell.lower(0), cell.lower(1)},
                               {cell.upper(0), cell.lower(1)},
                               {cell.lower(0), cell.upper(1)},
                               {cell.upper(0), cell.upper(1)}}) {
      positive += determinant(a, b) > 0 ? 1 : 0;
    }
    if (positive == 0 || positive == 4) return;
    ++mixed;
    EXPECT_FALSE(map.nodes[node].regular);
    EXPECT_NE(map.nodes[node].kind, kInside);
  });
  EXPECT_GT(mixed, 50);
}

/// Infeasible poses in a strip or spot far thinner than a cell are not overlooked.
TEST(CellProof, DoesNotOverlookAThinStrip) {
  const Problem problem = robot1_slice();
  const MapSpace space = make_map_space(problem.space);
  const CellMap map = subdivide(problem, space, {.undecided_share = 0.05});
  // The largest inside cell, and the greatest length of a cable over it.
  Cell largest;
  double volume = 0;
  map.for_each_leaf([&](const Cell& cell, std::uint32_t node) {
    if (map.nodes[node].kind != kInside || cell.volume() <= volume) return;
    volume = cell.volume();
    largest = cell;
  });
  const PrecisionScope precision(oracle::kBits);
  const ExactPoses poses(problem, space);
  const campaign::Machine<BigFloat> machine = campaign::make_machine<BigFloat>(problem);
  Random random(3);
  for (int n = 0; n < 200; ++n) {
    const std::vector<double> t = random_point(random, largest, 2);
    const BigFloat length = campaign::lengths(machine, poses.at(t))[static_cast<std::size_t>(n) % 6];
    // The cable is too long at t, by a nanometre.
    Problem tight = problem;
    DecimalText& limit = tight.robot.length_m[static_cast<std::size_t>(n) % 6].upper;
    limit = fmt::format("{:.12f}", length.to_double() - 1e-9);
    ASSERT_TRUE(length > oracle::big(limit));
    EXPECT_NE(make_cell_proof(tight, space)->judge(largest).kind, kInside);
  }
}

}  // namespace
}  // namespace taut::testing
