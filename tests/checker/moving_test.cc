// SPDX-License-Identifier: GPL-3.0-or-later
// What the kernel says of moves in time, against particles whose places are differentiated numerically at 400 bits.
#include "checker/kernel/moving.h"

#include <gtest/gtest.h>

#include "checker/kernel/box_proof.h"
#include "tests/checker/kernel.h"
#include "tests/support/moves.h"

namespace taut::checker {
namespace {

using testing::Operands;

constexpr double kError = 1e-25;  ///< of the oracle

mpq_class exact(double x) { return mpq_class(x); }
Expression constant(const std::string& text) { return parse_expression(text, {}, ""); }

/// The same machine for the kernel.
Problem to_kernel_in_time(const testing::MovingMachine& machine) {
  taut::Problem timeless = machine.problem;
  timeless.time.reset();
  timeless.load.items.clear();
  Problem problem = to_kernel(timeless);
  LoadItem item;
  Weight weight{{exact(machine.mass), exact(machine.mass)}, 0};
  weight.inertia_box = {exact(machine.box[0]), exact(machine.box[1]), exact(machine.box[2])};
  item.set = weight;
  item.at = {exact(machine.at[0]), exact(machine.at[1]), exact(machine.at[2])};
  problem.items = {item};
  problem.gravity = {0, 0, 0};
  TimeLimits& limits = problem.time.emplace();
  for (std::size_t i = 0; i < kCables; ++i) limits.winch_speed[i] = limits.winch_acceleration[i] = constant("0");
  limits.load_speed = limits.load_acceleration = constant("0");
  limits.load_angular_speed = limits.load_angular_acceleration = constant("0");
  return problem;
}

Path to_kernel(const taut::Path& path) {
  Path result;
  result.law = path.interpolation == Interpolation::kStraight ? Law::kStraight : Law::kCubicBSpline;
  for (const taut::Waypoint& w : path.waypoints) result.waypoints.push_back({w.x, w.half_turns, {}});
  result.timing = TimeLaw{path.timing->step_s, path.timing->controls};
  return result;
}

struct RandomMove {
  testing::MovingMachine machine;
  taut::Path path;
  std::size_t k;
  Box box;

  RandomMove(Operands& operands, int depth)
      : machine(operands),
        path(testing::some_move(operands, 0.1)),
        k(static_cast<std::size_t>(operands.pick(static_cast<int>(path.segments())))) {
    const int begin = operands.pick(1 << depth);
    box = dyadic_box(begin, begin + 1, depth);
  }
  [[nodiscard]] BigFloat time(double u) const {
    return testing::time_at(*path.timing, BigFloat(static_cast<double>(k)) + place(box, u));
  }
};

TEST(KernelMoving, LawsThatAreNoneOrDoNotRestAreRejected) {
  Operands operands(9);
  const Problem problem = to_kernel_in_time(testing::MovingMachine(operands));
  const auto point = [](double x) { return Waypoint{{x, 0, 0.3, 0, 0, 0}, std::vector<int>(6, 0), {}}; };
  const auto is_law = [&](std::vector<Waypoint> points, Law law, std::vector<double> controls, double step = 0.5) {
    Path path;
    path.law = law;
    path.waypoints = std::move(points);
    path.timing = TimeLaw{step, std::move(controls)};
    try {
      require_time_law(problem, path);
    } catch (const Rejected&) {
      return false;
    }
    return true;
  };
  const std::vector<Waypoint> corner = {point(0), point(0.01), point(0.02)};
  EXPECT_TRUE(is_law(corner, Law::kStraight, {0, 0, 0, 0.5, 1, 1, 1, 1.5, 2, 2, 2}));
  for (const std::vector<double>& wrong : std::vector<std::vector<double>>{{0, 0, 0, 0.5, 1, 1.5, 2, 2, 2},
                                                                           {-0.25, 0, 0.25, 0.75, 1.25, 1.75, 2, 2.25},
                                                                           {0, 0, 0, 1, 1, 1, 1.5, 2, 2.5},
                                                                           {0, 0, 0, 1, 1, 1, 2, 3, 3, 3},
                                                                           {0, 0, 0, 1.5, 1, 1, 1, 2, 2, 2},
                                                                           {0, 0, 0x1p-60, 1, 1, 1, 2, 2, 2},
                                                                           {0, 0, 0}}) {
    EXPECT_FALSE(is_law(corner, Law::kStraight, wrong)) << wrong[2];
  }
  EXPECT_FALSE(is_law(corner, Law::kStraight, {0, 0, 0, 1, 1, 1, 2, 2, 2}, 0));
  EXPECT_FALSE(is_law({point(0), point(1)}, Law::kGeodesic, {0, 0, 0, 1, 1, 1}));
  const std::vector<Waypoint> still = {point(0), point(0), point(0), point(1), point(1), point(1)};
  EXPECT_TRUE(is_law(still, Law::kCubicBSpline, {-1, 0, 1, 2, 3, 4}));
  EXPECT_FALSE(is_law({still.begin() + 1, still.end()}, Law::kCubicBSpline, {-1, 0, 1, 2, 3}));
}

TEST(KernelMoving, InertiaAndRatesAreThoseOfParticles) {
  const PrecisionScope oracle(oracle::kMovingBits);
  Operands operands(3);
  double widest = 0;
  for (int trial = 0; trial < 60; ++trial) {
    const bool is_small = trial % 3 == 0;
    const RandomMove random(operands, is_small ? 24 : operands.pick(7));
    const Problem problem = to_kernel_in_time(random.machine);
    const Path path = to_kernel(random.path);
    const WorkingPrecision precision(random.box.bits);
    const Machine machine(problem);
    const Moving said = moving(machine, problem, path, random.k, random.box);
    const oracle::Move move = testing::oracle_of(random.path);
    for (const double u : {-1.0, 1.0, operands.uniform(-1, 1)}) {
      const BigFloat t = random.time(u);
      const oracle::Big6 inertia =
          move.inertia(random.machine.particles(), oracle::big(random.machine.problem.load.point_m), t);
      for (std::size_t i = 0; i < 6; ++i) EXPECT_TRUE(holds(said.inertia[i], inertia[i], kError)) << trial << " " << i;
      const auto [v, a] = move.rates(oracle::big(random.machine.problem.load.point_m), t);
      const oracle::Big3 origin = {BigFloat(0.0), BigFloat(0.0), BigFloat(0.0)};
      for (const RateMargin& margin : said.margins) {
        const auto winch = [&] {
          return move.winch(oracle::big(random.machine.problem.robot.base_anchors_m[margin.cable]),
                            oracle::big(random.machine.problem.robot.platform_anchors_m[margin.cable]), t);
        };
        BigFloat rate(0.0);
        switch (margin.kind) {
          case RateKind::kWinchSpeed: rate = abs(winch().first); break;
          case RateKind::kWinchAcceleration: rate = abs(winch().second); break;
          case RateKind::kLoadSpeed: rate = oracle::distance(v, origin); break;
          case RateKind::kLoadAcceleration: rate = oracle::distance(a, origin); break;
          default: continue;
        }
        EXPECT_TRUE(holds(margin.value, -rate, kError)) << trial << " " << static_cast<int>(margin.kind);
      }
    }
    for (const Ball& x : said.inertia) {
      if (is_small) widest = std::max(widest, width(x));
    }
  }
  EXPECT_LT(widest, 1e-3);
}

/// The least distance of a tension from its limits, with what inertia takes.
BigFloat least_slack(const taut::Problem& problem, const testing::MovingMachine& machine, const oracle::Move& move,
                     const BigFloat& t) {
  taut::Problem with_inertia = problem;
  const oracle::Big6 inertia = move.inertia(machine.particles(), oracle::big(problem.load.point_m), t);
  for (std::size_t k = 0; k < 6; ++k) {
    with_inertia.load.wrench[k] = BigFloat(oracle::big(problem.load.wrench[k]) - inertia[k]).to_decimal(80, MPFR_RNDN);
  }
  const oracle::OracleStatics statics = oracle::statics(with_inertia, move.pose(t));
  BigFloat least(1e9);
  for (std::size_t i = 0; i < kCables; ++i) {
    const auto& [lower, upper] = problem.robot.tension_N[i];
    for (const BigFloat& slack : {statics.tension[i] - statics.tension_radius[i] - oracle::big(lower),
                                  oracle::big(upper) - statics.tension[i] - statics.tension_radius[i]}) {
      if (slack < least) least = slack;
    }
  }
  return least;
}

/// What is proved of tensions on the box; nothing where the box is too wide.
std::optional<Ball> proved_bound(const RandomMove& random) {
  Problem problem = to_kernel_in_time(random.machine);
  problem.time.emplace();
  const WorkingPrecision precision(random.box.bits);
  try {
    return prove_box(Machine(problem), problem, to_kernel(random.path), random.k, random.box).tension;
  } catch (const Undefined&) {
    return std::nullopt;
  }
}

TEST(KernelMoving, BoxesAreProvedWithInertia) {
  const PrecisionScope oracle(oracle::kMovingBits);
  Operands operands(5);
  int proved = 0, tight = 0;
  for (int trial = 0; trial < 60; ++trial) {
    const RandomMove random(operands, 9);
    const std::optional<Ball> bound = proved_bound(random);
    if (!bound) continue;
    ++proved;
    const oracle::Move move = testing::oracle_of(random.path);
    BigFloat least(1e9);
    for (const double u : {-1.0, 0.0, 1.0}) {
      const BigFloat slack = least_slack(random.machine.problem, random.machine, move, random.time(u));
      if (slack < least) least = slack;
    }
    EXPECT_LE(upper_end(*bound), least + BigFloat(kError)) << trial;
    if (upper_end(*bound) > least - BigFloat(0.1) * (BigFloat(1.0) + abs(least))) ++tight;
  }
  EXPECT_GT(proved, 50);
  EXPECT_GT(tight, 45);
}

TEST(KernelMoving, MachinesThatDeviateKeepTheBoundsOfBoxes) {
  const PrecisionScope oracle(oracle::kMovingBits);
  Operands operands(7);
  int proved = 0;
  for (int trial = 0; trial < 40; ++trial) {
    RandomMove random(operands, 9);
    const testing::SomeTolerances tolerances(operands, 0.05);
    random.machine.problem.tolerances = tolerances.text();
    random.box.parts = 2;
    random.box.guesses = 4;
    const std::optional<Ball> bound = proved_bound(random);
    if (!bound) continue;
    ++proved;
    const oracle::Move commanded = testing::oracle_of(random.path);
    for (int n = 0; n < 6; ++n) {
      const taut::Problem other = tolerances.some_machine(random.machine.problem, operands);
      const oracle::Move move = tolerances.some_move(commanded, operands);
      const BigFloat slack = least_slack(other, random.machine, move, random.time(operands.uniform(-1, 1)));
      EXPECT_LE(upper_end(*bound), slack + BigFloat(kError)) << trial;
    }
  }
  EXPECT_GT(proved, 30);
}

}  // namespace
}  // namespace taut::checker
