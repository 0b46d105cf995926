// SPDX-License-Identifier: GPL-3.0-or-later
#include "checker/kernel/machine.h"

#include <gtest/gtest.h>

#include <fstream>

#include "tests/checker/kernel.h"

namespace taut::checker {
namespace {

const Box kWhole = dyadic_box(0, 1, 0);

taut::Problem robot1() { return testing::free_flying(testing::robot1_slice()); }
taut::Problem robot2() { return testing::free_flying(testing::robot2_sphere()); }

Geometry geometry(const Machine& machine, const Problem& problem, const std::vector<double>& from,
                  const std::vector<double>& to, const Box& box = kWhole) {
  Path path;
  path.waypoints = {waypoint(from), waypoint(to)};
  return commanded_geometry(machine, problem, path, 0, box);
}

void expect_tight(const Ball& enclosure, const std::string& decimal) {
  const PrecisionScope oracle(kOracleBits);
  const BigFloat exact = oracle::big(decimal);
  EXPECT_TRUE(lower_end(enclosure) <= exact && exact <= upper_end(enclosure)) << decimal << ": " << print(enclosure);
  EXPECT_LT(width(enclosure), 1e-25 * std::abs(exact.to_double())) << decimal;
}

Ball determinant_of(const Geometry& geometry) {
  Matrix6<Ball> D;
  for (std::size_t i = 0; i < 6; ++i) {
    for (std::size_t j = 0; j < 6; ++j) D[i][j] = geometry.D[i][j].at;
  }
  return determinant(D);
}

TEST(Machine, HoldsTheOracleTightly) {
  const WorkingPrecision precision(128);
  const std::map<std::string, Problem> problems = {{"robot1", to_kernel(robot1())}, {"robot2", to_kernel(robot2())}};
  std::map<std::string, Machine> machines;
  for (const auto& [name, problem] : problems) machines.emplace(name, Machine(problem));
  std::ifstream lines(TAUT_SOURCE_DIR "/tests/oracle/poses.jsonl");
  int poses = 0;
  for (std::string line; std::getline(lines, line); ++poses) {
    const Json oracle = Json::parse(line);
    const Machine& machine = machines.at(oracle["robot"]);
    const Geometry there = geometry(machine, problems.at(oracle["robot"]), oracle["pose"], oracle["pose"]);
    const Tensions tensions = machine.tensions(there, Inverse(there.D));
    Ball det = determinant_of(there);
    for (std::size_t i = 0; i < kCables; ++i) {
      expect_tight(there.length[i].range(), oracle["length_m"][i]);
      expect_tight((there.length[i] * tensions.density[i]).range(), oracle["f0_N"][i]);
      expect_tight((there.length[i] * tensions.radius[1][i]).range(), oracle["v_N"][i]);
      det = det / there.length[i].range();
    }
    expect_tight(det, oracle["det_J"]);
  }
  EXPECT_EQ(poses, 600);
}

TEST(Machine, HoldsEveryPoseOfABox) {
  const PrecisionScope oracle(kOracleBits);
  std::mt19937_64 random(5);
  int shown = 0;
  for (int trial = 0; trial < 200 && !HasFailure(); ++trial) {
    taut::Problem stated = trial % 2 == 0 ? robot1() : robot2();
    if (trial % 3 == 0) {  // a tilted ellipsoid
      stated.load.ellipsoid.value()[0][1] = stated.load.ellipsoid.value()[1][0] = "3000";
      stated.load.ellipsoid.value()[2][4] = stated.load.ellipsoid.value()[4][2] = "-2500.5";
      for (std::size_t i = 0; i < 6; ++i) stated.load.ellipsoid.value()[i][i] = "10000.1";
    }
    const WorkingPrecision precision(trial % 4 == 0 ? 128 : 64);
    const Problem problem = to_kernel(stated);
    const Machine machine(problem);
    const auto exact = campaign::make_machine<BigFloat>(stated);
    std::vector<double> from = {uniform(random, -0.1, 0.1), uniform(random, -0.1, 0.1), uniform(random, 0.2, 0.4),
                                uniform(random, -3, 3),     uniform(random, -0.9, 0.9), uniform(random, -0.8, 0.8)};
    std::vector<double> to = from;
    const double step = std::exp(uniform(random, -12, -2));
    for (double& x : to) x += step * uniform(random, -1, 1);
    const Box box = dyadic_box(trial % 3, trial % 3 + 1, 2);
    try {
      const Geometry whole = geometry(machine, problem, from, to, box);
      const Tensions tensions = machine.tensions(whole, Inverse(whole.D));
      ++shown;
      for (const double u : samples(random, 8)) {
        const BigFloat s = place(box, u);
        std::array<BigFloat, 6> x;
        for (std::size_t j = 0; j < 6; ++j) x[j] = BigFloat(from[j]) + (BigFloat(to[j]) - BigFloat(from[j])) * s;
        const campaign::RigidPose<BigFloat> pose{{x[0], x[1], x[2]}, campaign::orientation(x[3], x[4], x[5])};
        const auto statics = campaign::statics(exact, pose);
        expect_pose(whole.pose, u, pose);
        for (std::size_t i = 0; i < kCables; ++i) {
          const MeanValueForm& length = whole.length[i];
          EXPECT_TRUE(holds(length, u, statics.length[i]));
          const BigFloat nominal = (statics.tension_low[i] + statics.tension_high[i]) / BigFloat(2.0);
          EXPECT_TRUE(holds(length * tensions.density[i], u, nominal, 1e-30)) << trial << " at " << u;
          EXPECT_TRUE(holds(length * tensions.radius[1][i], u, statics.tension_high[i] - nominal, 1e-30))
              << trial << " at " << u;
          EXPECT_TRUE(holds(length * tensions.extreme(i, 0), u, statics.tension_low[i], 1e-30)) << trial << " at " << u;
          EXPECT_TRUE(holds(length * tensions.extreme(i, 1), u, statics.tension_high[i], 1e-30))
              << trial << " at " << u;
        }
      }
    } catch (const Undefined&) {
    }
  }
  EXPECT_GT(shown, 80);
}

TEST(Machine, ASingularMatrixHasNoInverse) {
  const WorkingPrecision precision(128);
  const Problem problem = to_kernel(robot1());
  const Machine machine(problem);
  const std::vector<double> flat(6, 0);  // all cables in one plane
  const Geometry there = geometry(machine, problem, flat, flat);
  EXPECT_THROW((void)Inverse(there.D), Undefined);
  EXPECT_FALSE(certainly_positive(determinant_of(there)) || certainly_negative(determinant_of(there)));
}

TEST(Machine, ABoxAcrossASingularPoseIsNeverInverted) {
  const WorkingPrecision precision(128);
  const Problem problem = to_kernel(robot1());
  const Machine machine(problem);
  int sign_changes = 0;
  for (int k = 1; k < 30; ++k) {
    const std::vector<double> above = {0.01, 0.02, -std::ldexp(0.3, -k), 0.3, 0.01, 0.2};
    const std::vector<double> below = {0.01, 0.02, std::ldexp(0.2, -k), 0.3, 0.01, 0.2};
    const auto det = [&](const std::vector<double>& x) { return determinant_of(geometry(machine, problem, x, x)); };
    if (!certainly_negative(det(above) * det(below))) continue;
    ++sign_changes;
    EXPECT_THROW((void)Inverse(geometry(machine, problem, above, below).D), Undefined) << k;
  }
  EXPECT_GT(sign_changes, 5);
}

TEST(Machine, ACableWithoutLengthIsUndefined) {
  const WorkingPrecision precision(128);
  Problem problem = to_kernel(robot1());
  problem.platform_anchors[2] = problem.base_anchors[2];
  const std::vector<double> origin(6, 0);
  EXPECT_THROW((void)geometry(Machine(problem), problem, origin, origin), Undefined);
}

TEST(Machine, AnEllipsoidThatIsNotPositiveDefiniteIsRefused) {
  const WorkingPrecision precision(512);
  Problem problem = to_kernel(robot1());
  (*problem.ellipsoid)[0][1] = (*problem.ellipsoid)[1][0] = (*problem.ellipsoid)[0][0];
  (*problem.ellipsoid)[1][1] = (*problem.ellipsoid)[0][0];
  EXPECT_THROW((void)Machine(problem), Undefined);
  (*problem.ellipsoid)[0][1] = (*problem.ellipsoid)[1][0] = 0;
  EXPECT_NO_THROW((void)Machine(problem));
  (*problem.ellipsoid)[5][5] = -1;
  EXPECT_THROW((void)Machine(problem), Undefined);
  (*problem.ellipsoid)[5][5] = 0;
  EXPECT_THROW((void)Machine(problem), Undefined);
}

}  // namespace
}  // namespace taut::checker
