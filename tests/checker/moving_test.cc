// SPDX-License-Identifier: GPL-3.0-or-later
// What the kernel says of moves in time, against particles whose places are differentiated numerically at 400 bits.
#include "checker/kernel/moving.h"

#include <gtest/gtest.h>

#include "certificate/implied_motion.h"
#include "checker/kernel/box_proof.h"
#include "checker/kernel/second_jet.h"
#include "checker/witness.h"
#include "tests/checker/kernel.h"
#include "tests/support/implied_moves.h"
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

Path path_to_kernel(const taut::Path& path) {
  Path result;
  switch (path.interpolation) {
    case Interpolation::kStraight: result.law = Law::kStraight; break;
    case Interpolation::kCubicBSpline: result.law = Law::kCubicBSpline; break;
    case Interpolation::kGeodesic: result.law = Law::kGeodesic; break;
    case Interpolation::kCableLengths: result.law = Law::kCableLengths; break;
  }
  for (const taut::Waypoint& w : path.waypoints) {
    const bool has_pose = taut::has_poses(path.interpolation);
    result.waypoints.push_back({numbers(w), half_turns(w), has_pose ? std::vector<double>() : w.parameters().normals});
  }
  result.tubes = path.tubes;
  for (const taut::PoseTube& tube : path.pose_tubes) result.pose_tubes.push_back({tube.position, tube.turn});
  for (const auto& poses : path.inner_poses) {
    std::vector<InnerPose>& inner = result.inner_poses.emplace_back();
    for (const taut::InnerPose& pose : poses) {
      inner.push_back({mpq_class(pose.s), pose.x, {pose.tube.position, pose.tube.turn}});
    }
  }
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
      require_time_law(path);
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
  for (const Law law : {Law::kGeodesic, Law::kCableLengths}) {
    EXPECT_TRUE(is_law({point(0), point(1)}, law, {0, 0, 0, 1, 1, 1}));
    EXPECT_FALSE(is_law({point(0), point(1)}, law, {-0.25, 0, 0.25, 0.75, 1, 1.25}));
    EXPECT_FALSE(is_law(corner, law, {0, 0, 0, 0.5, 1, 1.5, 2, 2, 2}));
  }
  const std::vector<Waypoint> still = {point(0), point(0), point(0), point(1), point(1), point(1)};
  EXPECT_TRUE(is_law(still, Law::kCubicBSpline, {-1, 0, 1, 2, 3, 4}));
  EXPECT_FALSE(is_law({still.begin() + 1, still.end()}, Law::kCubicBSpline, {-1, 0, 1, 2, 3}));
  std::vector<Waypoint> turning = still;
  turning[0].normals = {1};  // on constraints, repeated control points rest only with their normals
  EXPECT_FALSE(is_law(turning, Law::kCubicBSpline, {-1, 0, 1, 2, 3, 4}));
}

/// That what the kernel says of a box holds at a time at which the move is there.
void expect_as_particles(const Moving& said, const testing::MovingMachine& machine, const oracle::Move& move,
                         const BigFloat& t, int trial) {
  const taut::Problem& problem = machine.problem;
  const oracle::Big6 inertia = move.inertia(machine.particles(), oracle::big(problem.load.point_m), t);
  for (std::size_t i = 0; i < 6; ++i) EXPECT_TRUE(holds(said.inertia[i], inertia[i], kError)) << trial << " " << i;
  const auto [v, a] = move.rates(oracle::big(problem.load.point_m), t);
  const oracle::Big3 origin = {BigFloat(0.0), BigFloat(0.0), BigFloat(0.0)};
  for (const RateMargin& margin : said.margins) {
    const auto winch = [&] {
      return move.winch(oracle::big(problem.robot.base_anchors_m[margin.cable]),
                        oracle::big(problem.robot.platform_anchors_m[margin.cable]), t);
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

TEST(KernelMoving, InertiaAndRatesAreThoseOfParticles) {
  const PrecisionScope oracle(oracle::kMovingBits);
  Operands operands(3);
  double widest = 0;
  for (int trial = 0; trial < 60; ++trial) {
    const bool is_small = trial % 3 == 0;
    const RandomMove random(operands, is_small ? 24 : operands.pick(7));
    const Problem problem = to_kernel_in_time(random.machine);
    const Path path = path_to_kernel(random.path);
    const WorkingPrecision precision(random.box.bits);
    const Machine machine(problem);
    const Moving said = moving(machine, problem, path, random.k, random.box);
    const oracle::Move move = testing::oracle_of(random.path);
    for (const double u : {-1.0, 1.0, operands.uniform(-1, 1)}) {
      expect_as_particles(said, random.machine, move, random.time(u), trial);
    }
    for (const Ball& x : said.inertia) {
      if (is_small) widest = std::max(widest, width(x));
    }
  }
  EXPECT_LT(widest, 1e-3);
}

TEST(KernelMoving, AtAPlaceInertiaIsKnownFarBeyondTheTimesOfAWideBox) {
  const PrecisionScope oracle(oracle::kMovingBits);
  Operands operands(71);
  double widest = 0;
  for (int trial = 0; trial < 20; ++trial) {
    RandomMove random(operands, 6);
    if (random.box.begin == 0) continue;  // at rest
    random.box.end = random.box.begin;
    const Problem problem = to_kernel_in_time(random.machine);
    const WorkingPrecision precision(random.box.bits);
    const Moving said = moving(Machine(problem), problem, path_to_kernel(random.path), random.k, random.box);
    for (const Ball& x : said.inertia) widest = std::max(widest, width(x));
  }
  EXPECT_GT(widest, 0);
  EXPECT_LT(widest, 1e-12);
}

/// Tensions with what inertia takes.
oracle::OracleStatics statics_of(const taut::Problem& problem, const testing::MovingMachine& machine,
                                 const oracle::Move& move, const BigFloat& t) {
  taut::Problem with_inertia = problem;
  const oracle::Big6 inertia = move.inertia(machine.particles(), oracle::big(problem.load.point_m), t);
  for (std::size_t k = 0; k < 6; ++k) {
    with_inertia.load.wrench[k] = BigFloat(oracle::big(problem.load.wrench[k]) - inertia[k]).to_decimal(80, MPFR_RNDN);
  }
  return oracle::statics(with_inertia, move.pose(t));
}

/// The least distance of a tension from its limits.
BigFloat least_slack(const taut::Problem& problem, const testing::MovingMachine& machine, const oracle::Move& move,
                     const BigFloat& t) {
  const oracle::OracleStatics statics = statics_of(problem, machine, move, t);
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
    return prove_box(Machine(problem), problem, path_to_kernel(random.path), random.k, random.box).tension;
  } catch (const Undefined&) {
    return std::nullopt;
  }
}

/// The move at the time `at` of its law, at a share of its speed that changes at a rate: at t = 0.
oracle::Move braking(const oracle::Move& move, const BigFloat& at, double share, const BigFloat& change) {
  return oracle::Move(
      [=, &move](const BigFloat& t) { return move.pose(at + BigFloat(share) * t + change / BigFloat(2.0) * t * t); });
}

TEST(KernelMoving, LimitsAreKeptOnLargeBoxesJustWhereParticlesKeepThem) {
  // A limit a quarter above all that is seen takes parts of so large a box; one 1 % below what is seen is broken.
  const PrecisionScope oracle(oracle::kMovingBits);
  Operands operands(57);
  int parted = 0;
  for (int trial = 0; trial < 24; ++trial) {
    RandomMove random(operands, 2);
    Problem problem = to_kernel_in_time(random.machine);
    const Path path = path_to_kernel(random.path);
    const bool may_stop = trial % 2 == 0;
    const double stopping_s = 0.5;
    TimeLimits limits;
    if (may_stop) limits.stopping_time = constant("0.5");
    const oracle::Move move = testing::oracle_of(random.path);
    BigFloat fastest(0.0), strongest(0.0), load(0.0);
    constexpr int kTimes = 24;
    for (int n = 0; n <= kTimes; ++n) {
      const BigFloat at = random.time(-1 + 2.0 * n / kTimes);
      for (const double change : may_stop ? std::vector<double>{-1 / stopping_s, 1 / stopping_s} : std::vector{0.0}) {
        for (const double share : may_stop ? std::vector{0.0, 0.5, 1.0} : std::vector{1.0}) {
          const oracle::Move braked = braking(move, at, share, BigFloat(change));
          const auto [v, a] =
              braked.winch(oracle::big(random.machine.problem.robot.base_anchors_m[1]),
                           oracle::big(random.machine.problem.robot.platform_anchors_m[1]), BigFloat(0.0));
          const auto rates = braked.rates(oracle::big(random.machine.problem.load.point_m), BigFloat(0.0));
          const oracle::Big3 origin = {BigFloat(0.0), BigFloat(0.0), BigFloat(0.0)};
          fastest = std::max(fastest, abs(v));
          strongest = std::max(strongest, abs(a));
          load = std::max(load, oracle::distance(rates.second, origin));
        }
      }
    }
    const WorkingPrecision precision(random.box.bits);
    const Machine machine(problem);
    const auto keeps = [&](double share) {
      const auto at = [&](const BigFloat& x) {
        return constant(testing::MovingMachine::exact_text(share * x.to_double(MPFR_RNDN) + 1e-9));
      };
      limits.winch_speed[1] = at(fastest);
      limits.winch_acceleration[1] = at(strongest);
      limits.load_acceleration = at(load);
      problem.time = limits;
      try {
        (void)moving_within_limits(machine, problem, path, random.k, random.box);
      } catch (const Undefined&) {
        return false;
      }
      return true;
    };
    EXPECT_FALSE(keeps(0.99)) << trial;
    EXPECT_TRUE(keeps(1.25)) << trial;
    const Moving whole = moving(machine, problem, path, random.k, random.box);
    const auto is_kept = [](const RateMargin& margin) { return certainly_positive(margin.value); };
    if (!std::ranges::all_of(whole.margins, is_kept)) ++parted;
  }
  EXPECT_GT(parted, 5) << "boxes that are far too large to be proved at one go";
}

TEST(KernelMoving, InertiaAndRatesOfImpliedMotionsAreThoseOfParticles) {
  const PrecisionScope oracle(oracle::kMovingBits);
  Operands operands(43);
  std::array<int, testing::ImpliedMove::kKinds> said_of{};
  double widest = 0;
  constexpr int kTrials = 32;
  for (int trial = 0; trial < kTrials; ++trial) {
    const auto kind = static_cast<std::size_t>(trial % testing::ImpliedMove::kKinds);
    const testing::ImpliedMove implied(operands, static_cast<testing::ImpliedMove::Kind>(kind), 0.1);
    const Problem problem = to_kernel_in_time(implied.machine);
    const Path path = path_to_kernel(implied.path);
    const auto k = static_cast<std::size_t>(operands.pick(static_cast<int>(path.segments())));
    const int depth = trial % 3 == 0 ? 24 : 6 + operands.pick(4), begin = operands.pick(1 << depth);
    Box box = dyadic_box(begin, begin + 1, depth);
    const WorkingPrecision precision(box.bits);
    const Machine machine(problem);
    if (is_implied(problem, path)) {
      const auto spans = [&](const InnerPose& pose) { return box.begin < pose.s && pose.s < box.end; };
      if (!path.inner_poses.empty() && std::ranges::any_of(path.inner_poses[k], spans)) continue;
      box.near = find_motion(machine, problem, path, k, box);
      if (!box.near) continue;
    }
    std::optional<Moving> said;
    try {
      said = moving(machine, problem, path, k, box);
    } catch (const Undefined&) {
      continue;
    }
    ++said_of[kind];
    const oracle::Move move = implied.move();
    for (const double u : {-1.0, 1.0, operands.uniform(-1, 1)}) {
      const BigFloat at = BigFloat(static_cast<double>(k)) + place(box, u);
      expect_as_particles(*said, implied.machine, move, testing::time_at(*implied.path.timing, at), trial);
    }
    for (const Ball& x : said->inertia) {
      if (depth == 24) widest = std::max(widest, width(x));
    }
  }
  for (const int count : said_of) EXPECT_GT(count, kTrials / testing::ImpliedMove::kKinds * 3 / 4);
  std::printf("widest w_in of boxes of 2^-24: %.3g\n", widest);
  EXPECT_LT(widest, 1e-3);
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

// ---- Power ----------------------------------------------------------------------------------------------------------

/// The greatest tension of each cable times the magnitude of that cable's commanded speed.
std::array<BigFloat, kCables> powers(const oracle::OracleStatics& statics, const testing::MovingMachine& machine,
                                     const oracle::Move& commanded, const BigFloat& t) {
  std::array<BigFloat, kCables> result;
  for (std::size_t i = 0; i < kCables; ++i) {
    const BigFloat speed = commanded
                               .winch(oracle::big(machine.problem.robot.base_anchors_m[i]),
                                      oracle::big(machine.problem.robot.platform_anchors_m[i]), t)
                               .first;
    result[i] = (statics.tension[i] + statics.tension_radius[i]) * abs(speed);
  }
  return result;
}

/// Whether a box is proved with a limit of the power of one cable, beside limits of tensions and lengths that hold.
bool is_power_proved(const RandomMove& random, std::size_t cable, double limit) {
  Problem problem = to_kernel_in_time(random.machine);
  problem.time.emplace().winch_power[cable] = constant(fmt::format("{:.17g}", limit));
  const WorkingPrecision precision(random.box.bits);
  try {
    (void)prove_box(Machine(problem), problem, path_to_kernel(random.path), random.k, random.box);
  } catch (const Undefined&) {
    return false;
  }
  return true;
}

TEST(KernelMoving, APowerIsProvedExactlyWhereItIsBelowItsLimit) {
  const PrecisionScope oracle(oracle::kMovingBits);
  Operands operands(15);
  int proved = 0, asked = 0;
  for (int trial = 0; trial < 30; ++trial) {
    const RandomMove random(operands, 9);
    if (!proved_bound(random)) continue;
    const oracle::Move move = testing::oracle_of(random.path);
    std::array<double, kCables> greatest{};
    for (const double u : {-1.0, 0.0, 1.0}) {
      const BigFloat t = random.time(u);
      const oracle::OracleStatics statics = statics_of(random.machine.problem, random.machine, move, t);
      const auto power = powers(statics, random.machine, move, t);
      for (std::size_t i = 0; i < kCables; ++i) greatest[i] = std::max(greatest[i], power[i].to_double());
    }
    for (std::size_t i = 0; i < kCables; ++i) {
      ++asked;
      EXPECT_FALSE(is_power_proved(random, i, greatest[i] * (1 - 1e-12))) << trial << " " << i;
      proved += is_power_proved(random, i, greatest[i] * 1.1 + 1e-3) ? 1 : 0;
    }
  }
  EXPECT_GT(asked, 120);
  EXPECT_GT(proved, asked * 8 / 10);
}

TEST(KernelMoving, MachinesThatDeviateKeepALimitOfPower) {
  const PrecisionScope oracle(oracle::kMovingBits);
  Operands operands(17);
  int proved = 0, near = 0;
  for (int trial = 0; trial < 24; ++trial) {
    RandomMove random(operands, 9);
    const oracle::Move commanded = testing::oracle_of(random.path);
    const auto as_stated = powers(statics_of(random.machine.problem, random.machine, commanded, random.time(0)),
                                  random.machine, commanded, random.time(0));
    const testing::SomeTolerances tolerances(operands, 0.05);
    random.machine.problem.tolerances = tolerances.text();
    random.box.parts = 2;
    random.box.guesses = 4;
    const auto cable = static_cast<std::size_t>(operands.pick(kCables));
    // The least limit of a geometric series that is proved.
    double limit = as_stated[cable].to_double();
    for (int k = 0; k < 60 && !is_power_proved(random, cable, limit); ++k) limit *= 1.05;
    if (!is_power_proved(random, cable, limit)) continue;
    ++proved;
    for (int n = 0; n < 8; ++n) {
      const taut::Problem other = tolerances.some_machine(random.machine.problem, operands);
      const oracle::Move move = tolerances.some_move(commanded, operands);
      const BigFloat t = random.time(operands.uniform(-1, 1));
      const auto power = powers(statics_of(other, random.machine, move, t), random.machine, commanded, t);
      EXPECT_LT(power[cable], BigFloat(limit)) << trial;
      if (power[cable] > BigFloat(as_stated[cable].to_double() * 1.01)) ++near;
    }
  }
  EXPECT_GT(proved, 15);
  EXPECT_GT(near, 10) << "deviations matter";
}

// ---- Witnesses ------------------------------------------------------------------------------------------------------

constexpr std::array kRates = {WitnessKind::kWinchSpeed,
                               WitnessKind::kWinchAcceleration,
                               WitnessKind::kWinchPower,
                               WitnessKind::kLoadSpeed,
                               WitnessKind::kLoadAcceleration,
                               WitnessKind::kLoadAngularSpeed,
                               WitnessKind::kLoadAngularAcceleration};

/// ω and its rate: with E the columns of R, [ω] = E' E^T and [ω'] = E'' E^T + E' E'^T.
std::pair<oracle::Big3, oracle::Big3> rotation_rates(const oracle::Move& move, const BigFloat& t) {
  std::array<oracle::Big3, 3> columns, first, second;
  const oracle::Big3 origin = {BigFloat(0.0), BigFloat(0.0), BigFloat(0.0)};
  const oracle::Big6 pose = move.pose(t);
  const auto [v, a] = move.rates(origin, t);
  for (std::size_t k = 0; k < 3; ++k) {
    oracle::Big3 e = origin;
    e[k] = BigFloat(1.0);
    columns[k] = oracle::place(pose, e);
    std::tie(first[k], second[k]) = move.rates(e, t);
    for (std::size_t c = 0; c < 3; ++c) {
      columns[k][c] -= pose[c];
      first[k][c] -= v[c];
      second[k][c] -= a[c];
    }
  }
  const auto skew = [&](std::size_t i, std::size_t j, bool is_rate) {
    BigFloat sum(0.0);
    for (std::size_t k = 0; k < 3; ++k) {
      sum += is_rate ? second[k][i] * columns[k][j] + first[k][i] * first[k][j] : first[k][i] * columns[k][j];
    }
    return sum;
  };
  return {{skew(2, 1, false), skew(0, 2, false), skew(1, 0, false)},
          {skew(2, 1, true), skew(0, 2, true), skew(1, 0, true)}};
}

/// What a witness of the kind is about, at a time.
BigFloat quantity_of(const testing::MovingMachine& machine, const oracle::Move& move, WitnessKind kind,
                     std::size_t cable, const BigFloat& t) {
  const oracle::Big3 none = {BigFloat(0.0), BigFloat(0.0), BigFloat(0.0)};
  const auto winch = [&] {
    return move.winch(oracle::big(machine.problem.robot.base_anchors_m[cable]),
                      oracle::big(machine.problem.robot.platform_anchors_m[cable]), t);
  };
  const auto load = [&] { return move.rates(oracle::big(machine.problem.load.point_m), t); };
  const auto statics = [&] { return statics_of(machine.problem, machine, move, t); };
  switch (kind) {
    case WitnessKind::kTensionMin: return statics().tension[cable] - statics().tension_radius[cable];
    case WitnessKind::kTensionMax: return statics().tension[cable] + statics().tension_radius[cable];
    case WitnessKind::kWinchSpeed: return abs(winch().first);
    case WitnessKind::kWinchAcceleration: return abs(winch().second);
    case WitnessKind::kWinchPower: return powers(statics(), machine, move, t)[cable];
    case WitnessKind::kLoadSpeed: return oracle::distance(load().first, none);
    case WitnessKind::kLoadAcceleration: return oracle::distance(load().second, none);
    case WitnessKind::kLoadAngularSpeed: return oracle::distance(rotation_rates(move, t).first, none);
    case WitnessKind::kLoadAngularAcceleration: return oracle::distance(rotation_rates(move, t).second, none);
    default: throw std::logic_error("a kind of which nothing is asked");
  }
}

/// The machine with limits of all kinds.
Problem limited(const testing::MovingMachine& machine, const std::string& limit) {
  Problem problem = to_kernel_in_time(machine);
  TimeLimits& limits = problem.time.emplace();
  for (std::size_t i = 0; i < kCables; ++i) {
    limits.winch_speed[i] = limits.winch_acceleration[i] = limits.winch_power[i] = constant(limit);
  }
  limits.load_speed = limits.load_acceleration = constant(limit);
  limits.load_angular_speed = limits.load_angular_acceleration = constant(limit);
  return problem;
}

TEST(KernelMoving, WitnessesSayWhatParticlesDo) {
  const PrecisionScope oracle(oracle::kMovingBits);
  Operands operands(19);
  int narrow = 0, all = 0;
  for (int trial = 0; trial < 30; ++trial) {
    const RandomMove random(operands, 10);
    const Problem problem = limited(random.machine, "1");
    const Path path = path_to_kernel(random.path);
    const oracle::Move move = testing::oracle_of(random.path);
    const WorkingPrecision precision(128);
    const Machine machine(problem);
    Witness witness;
    witness.at = {random.k, random.box.begin};
    witness.at_box.bits = 128;
    const BigFloat t = random.time(-1);
    const auto expect = [&](WitnessKind kind) {
      witness.kind = kind;
      const BigFloat truth = quantity_of(random.machine, move, kind, witness.cable, t);
      const Ball seen = witnessed_quantity(machine, problem, path, witness);
      EXPECT_TRUE(holds(seen, truth, kError)) << trial << ": " << print(seen) << " is not " << testing::digits(truth);
      ++all;
      if (width(seen) < 1e-3 * (1 + std::abs(truth.to_double()))) ++narrow;
    };
    for (std::size_t cable = 0; cable < kCables; ++cable) {
      witness.cable = cable;
      expect(WitnessKind::kTensionMin);
      expect(WitnessKind::kTensionMax);
      for (const WitnessKind kind : kRates) {
        if (is_of_winch(rate_of(kind).value())) expect(kind);
      }
    }
    witness.cable = 0;
    for (const WitnessKind kind : kRates) {
      if (!is_of_winch(rate_of(kind).value())) expect(kind);
    }
  }
  EXPECT_GT(narrow, all * 9 / 10);
}

TEST(KernelMoving, WitnessesOfMovesThatAreSlowedDownSayWhatParticlesDo) {
  const PrecisionScope oracle(oracle::kMovingBits);
  Operands operands(20);
  for (int trial = 0; trial < 12; ++trial) {
    const RandomMove random(operands, 10);
    Problem problem = limited(random.machine, "1");
    problem.time->stopping_time = constant("0.5");
    const Path path = path_to_kernel(random.path);
    const oracle::Move move = testing::oracle_of(random.path);
    const WorkingPrecision precision(128);
    const Machine machine(problem);
    for (const int change : {-1, 1}) {
      Witness witness;
      witness.at = {random.k, random.box.begin};
      witness.at_box.bits = 128;
      const double share = operands.uniform(0, 1);
      witness.slowing = {exact(share), change};
      witness.cable = static_cast<std::size_t>(operands.pick(kCables));
      const oracle::Move run = testing::slowed(move, random.time(-1), BigFloat(share), BigFloat(2.0 * change));
      for (const WitnessKind kind :
           {WitnessKind::kTensionMin, WitnessKind::kTensionMax, WitnessKind::kWinchAcceleration,
            WitnessKind::kWinchPower, WitnessKind::kLoadAcceleration, WitnessKind::kLoadAngularAcceleration}) {
        witness.kind = kind;
        if (kind == WitnessKind::kLoadAcceleration) witness.cable = 0;
        const BigFloat truth = quantity_of(random.machine, run, kind, witness.cable, BigFloat(0.0));
        const Ball seen = witnessed_quantity(machine, problem, path, witness);
        EXPECT_TRUE(holds(seen, truth, kError)) << trial << ": " << print(seen) << " is not " << testing::digits(truth);
        EXPECT_LT(width(seen), 1e-2 * (1 + std::abs(truth.to_double()))) << trial;
      }
    }
  }
}

TEST(KernelMoving, WitnessesOfMachinesThatDeviateSayWhatParticlesDo) {
  const PrecisionScope oracle(oracle::kMovingBits);
  Operands operands(22);
  for (int trial = 0; trial < 12; ++trial) {
    RandomMove random(operands, 10);
    TolerancesText& tolerances = random.machine.problem.tolerances.emplace();
    tolerances.base_anchor_m.fill("0.01");
    tolerances.platform_anchor_m.fill("0.01");
    tolerances.position_m = "0.1";
    tolerances.orientation_rad = "0.5";
    Problem problem = limited(random.machine, "1");
    problem.time->stopping_time = constant("0.5");
    const Path path = path_to_kernel(random.path);
    Witness witness;
    witness.at = {random.k, random.box.begin};
    witness.at_box.bits = 128;
    WitnessDeviation& by = witness.deviation.emplace();
    const auto some = [&](std::array<mpq_class, 3>& x, double most) {
      oracle::Big3 result;
      for (std::size_t c = 0; c < 3; ++c) {
        const double value = operands.uniform(-most, most);
        x[c] = exact(value);
        result[c] = BigFloat(value);
      }
      return result;
    };
    taut::Problem other = random.machine.problem;
    for (std::size_t i = 0; i < kCables; ++i) {
      const oracle::Big3 a = some(by.base_anchors[i], 0.005), b = some(by.platform_anchors[i], 0.005);
      for (std::size_t c = 0; c < 3; ++c) {
        auto &base = other.robot.base_anchors_m[i][c], &platform = other.robot.platform_anchors_m[i][c];
        base = (oracle::big(base) + a[c]).to_decimal(80, MPFR_RNDN);
        platform = (oracle::big(platform) + b[c]).to_decimal(80, MPFR_RNDN);
      }
    }
    const oracle::Big3 position = some(by.position, 0.05), turn = some(by.turn, 0.1);
    const BigFloat t = random.time(-1);
    const oracle::Move move = testing::tracked(testing::oracle_of(random.path), t, position, turn);
    const WorkingPrecision precision(128);
    const Machine machine(problem);
    for (const bool is_slowed : {false, true}) {
      if (is_slowed) witness.slowing = {mpq_class(1, 4), -1};
      const oracle::Move run = is_slowed ? testing::slowed(move, t, BigFloat(0.25), BigFloat(-2.0))
                                         : testing::slowed(move, t, BigFloat(1.0), BigFloat(0.0));
      for (const WitnessKind kind : {WitnessKind::kTensionMin, WitnessKind::kTensionMax}) {
        for (witness.cable = 0; witness.cable < kCables; ++witness.cable) {
          witness.kind = kind;
          testing::MovingMachine deviating = random.machine;
          deviating.problem = other;
          const BigFloat truth = quantity_of(deviating, run, kind, witness.cable, BigFloat(0.0));
          const Ball seen = witnessed_quantity(machine, problem, path, witness);
          EXPECT_TRUE(holds(seen, truth, kError))
              << trial << ": " << print(seen) << " is not " << testing::digits(truth);
          EXPECT_LT(width(seen), 1e-2 * (1 + std::abs(truth.to_double()))) << trial;
        }
      }
    }
  }
}

TEST(KernelMoving, ARateIsConfirmedOnlyWhereItIsNotBelowItsLimit) {
  const PrecisionScope oracle(oracle::kMovingBits);
  Operands operands(21);
  const RandomMove random(operands, 10);
  const Path path = path_to_kernel(random.path);
  const WorkingPrecision precision(128);
  for (const WitnessKind kind : kRates) {
    Witness witness;
    witness.kind = kind;
    witness.at = {random.k, random.box.begin};
    witness.at_box.bits = 128;
    witness.cable = is_of_winch(rate_of(kind).value()) ? 3 : 0;
    const Problem any = limited(random.machine, "1");
    const double value = approx(witnessed_quantity(Machine(any), any, path, witness));
    const auto confirm = [&](double lower, double upper, double limit) {
      witness.value_lower = exact(lower);
      witness.value_upper = exact(upper);
      const Problem problem = limited(random.machine, fmt::format("sqrt({:.17g}^2)", limit));
      confirm_violation(Machine(problem), problem, path, witness);
    };
    const double off = 0.01 * (1 + value);
    EXPECT_NO_THROW(confirm(value - off, value + off, std::max(value - 2 * off, 1e-9))) << static_cast<int>(kind);
    EXPECT_THROW(confirm(value - off, value + off, value), Rejected) << "the value may be below the limit";
    EXPECT_THROW(confirm(value + off, value + 2 * off, value), Rejected) << "the rate is not so large";
    EXPECT_THROW(confirm(value - 2 * off, value - off, 1e-9), Rejected) << "the rate is larger";
    Problem without = any;
    without.time = TimeLimits{};
    EXPECT_THROW((void)witnessed_quantity(Machine(without), without, path, witness), Rejected);
    Path at_rest = path;
    at_rest.timing.reset();
    EXPECT_THROW((void)witnessed_quantity(Machine(any), any, at_rest, witness), Rejected);
    witness.loads.emplace();
    EXPECT_THROW((void)witnessed_quantity(Machine(any), any, path, witness), Rejected);
    witness.loads.reset();
    if (kind == WitnessKind::kWinchPower) continue;  // of which the machine may deviate
    witness.deviation.emplace();
    EXPECT_THROW((void)witnessed_quantity(Machine(any), any, path, witness), Rejected);
  }
}

/// Tensions are those of w - w_in for every mass and centre of gravity, that of the one worst load included.
TEST(KernelMoving, AWitnessHoldsTheTensionsOfEveryMass) {
  const PrecisionScope oracle(oracle::kMovingBits);
  Operands operands(23);
  for (int trial = 0; trial < 12; ++trial) {
    const RandomMove random(operands, 10);
    Problem problem = limited(random.machine, "1");
    auto& weight = std::get<Weight>(problem.items[0].set);
    weight.mass = {exact(random.machine.mass / 2), exact(random.machine.mass)};
    const Path path = path_to_kernel(random.path);
    const oracle::Move move = testing::oracle_of(random.path);
    const WorkingPrecision precision(128);
    Witness witness;
    witness.at = {random.k, random.box.begin};
    witness.at_box.bits = 128;
    for (const double share : {0.5, 0.75, 1.0}) {
      testing::MovingMachine lighter = random.machine;
      lighter.mass *= share;
      for (std::size_t cable = 0; cable < kCables; ++cable) {
        witness.cable = cable;
        for (const WitnessKind kind : {WitnessKind::kTensionMin, WitnessKind::kTensionMax, WitnessKind::kWinchPower}) {
          witness.kind = kind;
          const Ball seen = witnessed_quantity(Machine(problem), problem, path, witness);
          EXPECT_TRUE(holds(seen, quantity_of(lighter, move, kind, cable, random.time(-1)), kError)) << trial;
        }
      }
    }
  }
}

TEST(KernelMoving, AWitnessIsAboutAllTimesAtWhichTheMoveIsThere) {
  const PrecisionScope oracle(oracle::kMovingBits);
  Operands operands(25);
  const testing::MovingMachine some(operands);
  const Problem problem = limited(some, "1");
  Path path;
  path.waypoints = {waypoint({0, 0, 0.3, 0, 0.1, 0}), waypoint({0.02, 0, 0.3, 0, 0.1, 0.1})};
  // From 0 to 1/2, where it rests from 1.5 s on, until 2 s, and then on to 1.
  path.timing = TimeLaw{0.5, {0, 0, 0, 0.5, 0.5, 0.5, 0.5, 1, 1, 1}};
  ASSERT_NO_THROW(require_time_law(path));
  const WorkingPrecision precision(128);
  const Machine machine(problem);
  Witness witness;
  witness.at_box.bits = 128;
  witness.kind = WitnessKind::kLoadAcceleration;
  witness.at = {0, mpq_class(1, 2)};
  const Ball resting = witnessed_quantity(machine, problem, path, witness);
  EXPECT_TRUE(holds(resting, BigFloat(0.0))) << "it rests for a while: " << print(resting);
  EXPECT_LT(width(resting), 1e-2);
  witness.at.s = mpq_class(1, 4);
  witness.kind = WitnessKind::kLoadSpeed;
  const Ball passing = witnessed_quantity(machine, problem, path, witness);
  EXPECT_TRUE(certainly_positive(passing)) << print(passing);
  witness.at.s = mpq_class(1, 2);
  EXPECT_TRUE(holds(witnessed_quantity(machine, problem, path, witness), BigFloat(0.0)));
  // Where it rests, tensions are those of the machine at rest.
  Path at_rest = path;
  at_rest.timing.reset();
  witness.kind = WitnessKind::kTensionMax;
  for (std::size_t cable = 0; cable < kCables; ++cable) {
    witness.cable = cable;
    const Ball of_move = witnessed_quantity(machine, problem, path, witness);
    EXPECT_TRUE(is_within(witnessed_quantity(machine, problem, at_rest, witness), plus_minus(of_move, Ball(1e-25))));
  }
  // So they are in a problem with limits in time and a path without a law, at any place.
  Problem timeless = problem;
  timeless.time.reset();
  std::get<Weight>(timeless.items[0].set).inertia_box.reset();
  for (const mpq_class& s : {mpq_class(0), mpq_class(1, 4), mpq_class(1)}) {
    witness.at.s = s;
    const Ball with_limits = witnessed_quantity(machine, problem, at_rest, witness);
    const Ball without = witnessed_quantity(Machine(timeless), timeless, at_rest, witness);
    EXPECT_TRUE(arb_equal(with_limits.get(), without.get()));
  }
}

TEST(KernelMoving, ThatKMayGrowIsNotClaimed) {
  Operands operands(27);
  int proved = 0;
  for (int trial = 0; trial < 10; ++trial) {
    const RandomMove random(operands, 10);
    Problem problem = to_kernel_in_time(random.machine);
    problem.time.emplace();
    const WorkingPrecision precision(random.box.bits);
    try {
      const Bounds bounds = prove_box(Machine(problem), problem, path_to_kernel(random.path), random.k, random.box);
      EXPECT_TRUE(arb_equal_si(bounds.wrench_scale.get(), 1));
      ++proved;
    } catch (const Undefined&) {
      continue;
    }
  }
  EXPECT_GT(proved, 5);
}

TEST(KernelMoving, TakesNothingForAConstantWhoseDerivativesVanishAtAPoint) {
  const SecondJet q(Ball(), Ball(1), Ball());
  EXPECT_THROW((void)apply(Function::kSqrt, power(q, 4)), Undefined) << "it is q^2, and bends";
  EXPECT_THROW((void)apply(Function::kAsin, SecondJet(Ball(1)) - power(q, 4)), Undefined);
  EXPECT_THROW((void)atan2(power(q, 3), SecondJet(Ball(-1))), Undefined);
  EXPECT_NO_THROW((void)apply(Function::kSqrt, SecondJet(Ball()) - SecondJet(Ball())));
}

}  // namespace
}  // namespace taut::checker
