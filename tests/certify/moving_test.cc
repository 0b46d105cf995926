// SPDX-License-Identifier: GPL-3.0-or-later
// Moves in time, proved and refuted, against Newton and Euler at 400 bits: particles whose places are differentiated
// numerically, and statics that are written a second time.
#include "certify/motion/moving.h"

#include <gtest/gtest.h>

#include <cmath>
#include <cstdlib>
#include <map>
#include <string>
#include <tuple>

#include "certify/box_proof.h"
#include "certify/prover.h"
#include "tests/support/implied_moves.h"
#include "tests/support/moves.h"

namespace taut::testing {
namespace {

/// Everything that a claim limits, at a time.
struct Truth {
  std::array<BigFloat, kCables> low, high, winch_speed, winch_acceleration;
  BigFloat speed, acceleration;
};
Truth truth(const MovingMachine& machine, const oracle::Move& move, const BigFloat& t) {
  const Problem& problem = machine.problem;
  const oracle::Big6 inertia = move.inertia(machine.particles(), oracle::big(problem.load.point_m), t);
  Problem with_inertia = problem;
  for (std::size_t k = 0; k < 6; ++k) {
    const BigFloat w = oracle::big(problem.load.wrench[k]) - inertia[k];
    with_inertia.load.wrench[k] = w.to_decimal(80, MPFR_RNDN);
  }
  const oracle::OracleStatics statics = oracle::statics(with_inertia, move.pose(t));
  Truth result;
  for (std::size_t i = 0; i < kCables; ++i) {
    result.low[i] = statics.tension[i] - statics.tension_radius[i];
    result.high[i] = statics.tension[i] + statics.tension_radius[i];
    std::tie(result.winch_speed[i], result.winch_acceleration[i]) =
        move.winch(oracle::big(problem.robot.base_anchors_m[i]), oracle::big(problem.robot.platform_anchors_m[i]), t);
  }
  const auto [v, a] = move.rates(oracle::big(problem.load.point_m), t);
  const oracle::Big3 origin = {BigFloat(0.0), BigFloat(0.0), BigFloat(0.0)};
  result.speed = oracle::distance(v, origin);
  result.acceleration = oracle::distance(a, origin);
  return result;
}

/// How far a move is from its limits, by what is limited: not positive where one is reached.
std::map<std::string, BigFloat> slacks(const Problem& problem, const Truth& x) {
  std::map<std::string, BigFloat> result;
  const auto add = [&](const std::string& what, const BigFloat& value, const TimeText::Limit& limit) {
    if (limit) result[what] = oracle::big(*limit) - abs(value);
  };
  for (std::size_t i = 0; i < kCables; ++i) {
    const std::string cable = std::to_string(i);
    const auto& [lower, upper] = problem.robot.tension_N[i];
    result["tension_min" + cable] = x.low[i] - oracle::big(lower);
    result["tension_max" + cable] = oracle::big(upper) - x.high[i];
    add("winch speed" + cable, x.winch_speed[i], problem.time->winch_speed_m_s[i]);
    add("winch acceleration" + cable, x.winch_acceleration[i], problem.time->winch_acceleration_m_s2[i]);
    add("winch power" + cable, x.high[i] * x.winch_speed[i], problem.time->winch_power_W[i]);
  }
  add("speed", x.speed, problem.time->load_speed_m_s);
  add("acceleration", x.acceleration, problem.time->load_acceleration_m_s2);
  return result;
}

std::string limit_of(const SegmentWitness& witness) {
  if (!witness.rate) return name(witness.margin.kind) + std::to_string(witness.margin.cable);
  const std::string cable = std::to_string(witness.rate->cable);
  switch (witness.rate->kind) {
    case RateKind::kWinchSpeed: return "winch speed" + cable;
    case RateKind::kWinchAcceleration: return "winch acceleration" + cable;
    case RateKind::kWinchPower: return "winch power" + cable;
    case RateKind::kLoadSpeed: return "speed";
    default: return "acceleration";
  }
}

/// Proves or refutes a move whose limits are near what it does, where `is_limited`, and holds both to Newton and Euler.
void expect_true_verdicts(MovingMachine& machine, const Path& path, const oracle::Move& move, bool is_limited,
                          Operands& operands, int trial, std::map<std::string, int>& count) {
  const BigFloat error = oracle::big("1e-20");
  if (is_limited) {
    const PrecisionScope precision(oracle::kMovingBits);
    const Truth middle = truth(machine, move, BigFloat(path.timing->duration_s() * operands.uniform(0.2, 0.8)));
    const auto near = [&](const BigFloat& x) -> TimeText::Limit {
      if (operands.pick(2) == 0) return std::nullopt;
      return MovingMachine::exact_text(std::abs(x.to_double(MPFR_RNDN)) * operands.uniform(0.9, 8) + 1e-6);
    };
    for (std::size_t i = 0; i < kCables; ++i) {
      machine.problem.time->winch_speed_m_s[i] = near(middle.winch_speed[i]);
      machine.problem.time->winch_acceleration_m_s2[i] = near(middle.winch_acceleration[i]);
      machine.problem.time->winch_power_W[i] = near(middle.high[i] * middle.winch_speed[i]);
    }
    machine.problem.time->load_speed_m_s = near(middle.speed);
    machine.problem.time->load_acceleration_m_s2 = near(middle.acceleration);
  }
  const bool may_stop = operands.pick(4) == 0;
  const double stopping_s = 0x1p-10 * std::ceil(0x1p10 * path.timing->duration_s() * operands.uniform(0.05, 0.5));
  if (may_stop) machine.problem.time->stopping_time_s = MovingMachine::exact_text(stopping_s);
  const Prover prover(machine.problem, {.max_bits = 256, .max_boxes = 4000, .max_multiprecision_boxes = 50});
  bool all_proved = true;
  for (std::size_t k = 0; k < path.segments(); ++k) {
    const SegmentProof proof = prover.prove(path.segment(k));
    all_proved = all_proved && proof.verdict == Verdict::kProved;
    if (proof.verdict == Verdict::kUndecided) ++count["undecided"];
    if (proof.verdict != Verdict::kRefuted || proof.witness->singular) continue;
    const std::string limit = limit_of(*proof.witness);
    if (limit.starts_with("length")) continue;  // that has nothing to do with time
    ++count[proof.witness->rate ? "too fast" : "tension"];
    const PrecisionScope precision(oracle::kMovingBits);
    const BigFloat s = BigFloat(static_cast<double>(k)) + BigFloat(proof.witness->box.mid().approx());
    oracle::Move run = slowed(move, time_at(*path.timing, s), BigFloat(1.0), BigFloat(0.0));
    if (const auto& slowing = proof.witness->slowing) {
      ++count["slowed down"];
      ASSERT_TRUE(may_stop);
      run = slowed(move, time_at(*path.timing, s), oracle::big(slowing->speed),
                   BigFloat(static_cast<double>(slowing->change)) / BigFloat(stopping_s));
    }
    EXPECT_LT(slacks(machine.problem, truth(machine, run, BigFloat(0.0))).at(limit), error) << trial << ": " << limit;
  }
  if (!all_proved) return;
  ++count["proved"];
  const PrecisionScope precision(oracle::kMovingBits);
  constexpr int kTimes = 12;
  for (int n = 0; n < kTimes; ++n) {
    const BigFloat t(path.timing->duration_s() * operands.uniform(1e-9, 1 - 1e-9));
    oracle::Move run = slowed(move, t, BigFloat(1.0), BigFloat(0.0));
    if (may_stop && n % 4 != 0) {
      const double share = operands.pick(3) == 0 ? operands.uniform(0, 1) : operands.pick(2);
      const double change = (1 - 1e-9) / stopping_s * (operands.pick(2) == 0 ? -1 : 1);
      run = slowed(move, t, BigFloat(share), BigFloat(change));
    }
    for (const auto& [limit, slack] : slacks(machine.problem, truth(machine, run, BigFloat(0.0)))) {
      EXPECT_GT(slack, -error) << trial << ": " << limit;
    }
  }
}

/// For campaigns: TAUT_TRIALS instead of so many, and TAUT_SEED instead of a seed, where the environment has them.
int trials(int usual) {
  const char* const stated = std::getenv("TAUT_TRIALS");
  return stated == nullptr ? usual : std::stoi(stated);
}
std::uint64_t seed(std::uint64_t usual) {
  const char* const stated = std::getenv("TAUT_SEED");
  return stated == nullptr ? usual : std::stoull(stated);
}

TEST(Moving, ProofsAndRefutationsAgreeWithNewtonAndEuler) {
  Operands operands(seed(29));
  std::map<std::string, int> count;
  const int number = trials(120);
  for (int trial = 0; trial < number; ++trial) {
    MovingMachine machine(operands);
    const bool is_limited = trial % 2 == 0;  // else by tensions alone
    const Path path = some_move(operands, is_limited ? 0.2 : 0.05);
    expect_true_verdicts(machine, path, oracle_of(path), is_limited, operands, trial, count);
  }
  for (const auto& [what, times] : count) std::printf("%s: %d\n", what.c_str(), times);
  EXPECT_GT(count["proved"], number / 4);
  EXPECT_GT(count["tension"], number / 8);
  EXPECT_GT(count["too fast"], number / 8);
  EXPECT_LT(count["undecided"], number / 30);
}

TEST(Moving, ProofsAndRefutationsOfImpliedMotionsAgreeWithNewtonAndEuler) {
  Operands operands(seed(47));
  std::map<std::string, int> count;
  const int number = trials(48);
  for (int trial = 0; trial < number; ++trial) {
    const auto kind = static_cast<ImpliedMove::Kind>(trial / 2 % ImpliedMove::kKinds);
    const bool is_limited = trial % 2 == 0;
    ImpliedMove implied(operands, kind, is_limited ? 0.2 : 0.05);
    expect_true_verdicts(implied.machine, implied.path, implied.move(), is_limited, operands, trial, count);
  }
  for (const auto& [what, times] : count) std::printf("%s: %d\n", what.c_str(), times);
  EXPECT_GT(count["proved"], number / 8);
  EXPECT_GT(count["tension"], number / 16);
  EXPECT_GT(count["too fast"], number / 16);
}

TEST(Moving, TheFastestProvedMoveIsNearTheSlowestRefutedOne) {
  Operands operands(31);
  int found = 0;
  constexpr int kMoves = 8;
  for (int trial = 0; found < kMoves; ++trial) {
    ASSERT_LT(trial, 10 * kMoves);
    MovingMachine machine(operands);
    if (machine.mass < 0.2) continue;
    Path path = some_move(operands, 0.2);
    const Prover prover(machine.problem, {.max_bits = 256});
    const auto verdict = [&](double step_s) {
      path.timing->step_s = step_s;
      Verdict result = Verdict::kProved;
      for (std::size_t k = 0; k < path.segments() && result == Verdict::kProved; ++k) {
        result = prover.prove(path.segment(k)).verdict;
      }
      return result;
    };
    double slow = 8 * path.timing->step_s, fast = slow / 1024;
    if (verdict(slow) != Verdict::kProved) continue;
    ++found;
    ASSERT_EQ(verdict(fast), Verdict::kRefuted);
    while (slow > 1.001 * fast) {
      const double middle = std::sqrt(slow * fast);
      const Verdict at_middle = verdict(middle);
      ASSERT_NE(at_middle, Verdict::kUndecided) << trial << " " << middle;
      (at_middle == Verdict::kProved ? slow : fast) = middle;
    }
    path.timing->step_s = slow;
    const PrecisionScope precision(oracle::kMovingBits);
    const oracle::Move move = oracle_of(path);
    BigFloat least(1e9);
    constexpr int kTimes = 60;
    for (int n = 0; n < kTimes; ++n) {
      const BigFloat t(path.timing->duration_s() * (n + 0.5) / kTimes);
      for (const auto& [limit, slack] : slacks(machine.problem, truth(machine, move, t))) {
        if (limit.starts_with("tension") && slack < least) least = slack;
      }
    }
    EXPECT_GT(least, -oracle::big("1e-20"));
    EXPECT_LT(least.to_double(MPFR_RNDN), 0.2) << "of 6.48 N between the limits";
  }
}

TEST(Moving, MachinesThatDeviateKeepTheLimitsOfProofs) {
  Operands operands(37);
  int proved = 0;
  constexpr int kMoves = 8;
  for (int trial = 0; proved < kMoves; ++trial) {
    ASSERT_LT(trial, 30 * kMoves);
    MovingMachine machine(operands);
    const SomeTolerances tolerances(operands, 0.02);
    machine.problem.tolerances = tolerances.text();
    const Path path = some_move(operands, 0.1);
    const Prover prover(machine.problem, {.max_bits = 256});
    bool all_proved = true;
    for (std::size_t k = 0; all_proved && k < path.segments(); ++k) {
      all_proved = prover.prove(path.segment(k), 0, {}, ProofAim::kProve).verdict == Verdict::kProved;
    }
    if (!all_proved) continue;
    ++proved;
    const PrecisionScope precision(oracle::kMovingBits);
    const oracle::Move commanded = oracle_of(path);
    constexpr int kMachines = 12;
    for (int n = 0; n < kMachines; ++n) {
      const BigFloat t(path.timing->duration_s() * operands.uniform(1e-9, 1 - 1e-9));
      MovingMachine other = machine;
      other.problem = tolerances.some_machine(machine.problem, operands);
      const oracle::Move move = tolerances.some_move(commanded, operands);
      for (const auto& [limit, slack] : slacks(other.problem, truth(other, move, t))) {
        if (!limit.starts_with("tension")) continue;
        EXPECT_GT(slack, -oracle::big("1e-20")) << trial << ": " << limit;
      }
    }
  }
}

/// The proof of the first segment that is not proved, and its number k; of the last one, where all are.
SegmentProof first_unproved(const Problem& problem, const Path& path, std::size_t& k) {
  const Prover prover(problem, {.max_bits = 256, .max_boxes = 4000, .max_multiprecision_boxes = 50});
  SegmentProof proof = prover.prove(path.segment(0));
  for (k = 0; proof.verdict == Verdict::kProved && k + 1 < path.segments();) proof = prover.prove(path.segment(++k));
  return proof;
}

TEST(Moving, MovesThatMayStopKeepTheirLimitsAtEverySpeed) {
  Operands operands(43);
  std::map<std::string, int> count;
  constexpr int kTrials = 60;
  for (int trial = 0; trial < kTrials; ++trial) {
    MovingMachine machine(operands);
    const Path path = some_move(operands, 0.1);
    const double stopping_s = 0x1p-10 * std::ceil(0x1p10 * path.timing->duration_s() * operands.uniform(0.05, 0.5));
    const PrecisionScope precision(oracle::kMovingBits);
    const oracle::Move move = oracle_of(path);
    const Truth middle = truth(machine, move, BigFloat(path.timing->duration_s() * 0.5));
    machine.problem.time->load_acceleration_m_s2 =
        MovingMachine::exact_text(middle.acceleration.to_double(MPFR_RNDN) * operands.uniform(1, 20) + 1e-3);
    std::size_t k = 0;
    const bool is_proved_by_law = first_unproved(machine.problem, path, k).verdict == Verdict::kProved;
    machine.problem.time->stopping_time_s = MovingMachine::exact_text(stopping_s);
    const SegmentProof proof = first_unproved(machine.problem, path, k);
    const bool is_proved_slowed = proof.verdict == Verdict::kProved;
    EXPECT_LE(is_proved_slowed, is_proved_by_law) << trial;
    if (!is_proved_by_law) continue;
    bool is_broken = false;
    constexpr int kTimes = 30;
    for (int n = 0; n < kTimes; ++n) {
      const double at = path.timing->duration_s() * operands.uniform(1e-6, 1 - 1e-6);
      const double share = operands.pick(3) == 0 ? operands.uniform(0, 1) : 1;
      const double change = (1 - 1e-9) / stopping_s * (operands.pick(2) == 0 ? -1 : 1);
      for (const auto& [limit, slack] :
           slacks(machine.problem,
                  truth(machine, slowed(move, BigFloat(at), BigFloat(share), BigFloat(change)), BigFloat(0.0)))) {
        is_broken = is_broken || slack < BigFloat(0.0);
        if (is_proved_slowed) {
          EXPECT_GT(slack, -oracle::big("1e-20")) << trial << ": " << limit;
        }
      }
    }
    const bool is_refuted = proof.verdict == Verdict::kRefuted;
    ++count[is_proved_slowed ? "proved" : is_refuted ? "refuted" : is_broken ? "broken" : "open"];
    if (!is_refuted) continue;
    ASSERT_TRUE(proof.witness->slowing) << trial;
    const auto& [share, change] = *proof.witness->slowing;
    const BigFloat place = BigFloat(static_cast<double>(k)) + BigFloat(proof.witness->box.mid().approx());
    const oracle::Move run = slowed(move, time_at(*path.timing, place), oracle::big(share),
                                    BigFloat(static_cast<double>(change)) / BigFloat(stopping_s));
    const std::string limit = limit_of(*proof.witness);
    EXPECT_LT(slacks(machine.problem, truth(machine, run, BigFloat(0.0))).at(limit), oracle::big("1e-20")) << limit;
  }
  for (const auto& [what, times] : count) std::printf("%s: %d\n", what.c_str(), times);
  EXPECT_GT(count["proved"], kTrials / 10);
  EXPECT_GE(count["refuted"], kTrials / 12) << "as machines brake, of moves that are proved at full speed";
  EXPECT_LE(count["broken"] + count["open"], kTrials / 30);
}

enum class LimitOf { kTension, kPower };

/// Proves moves with a limit that the machine as stated keeps by a little, and refutes them where it may deviate.
std::map<std::string, int> refute_by_deviations(LimitOf limited, int trials, Operands& operands) {
  std::map<std::string, int> count;
  for (int trial = 0; trial < trials; ++trial) {
    MovingMachine machine(operands);
    const Path path = some_move(operands, 0.1);
    {
      const PrecisionScope precision(oracle::kMovingBits);
      const oracle::Move move = oracle_of(path);
      double least = 1e9;
      std::array<double, kCables> power{};
      constexpr int kTimes = 40;
      for (int n = 0; n < kTimes; ++n) {
        const Truth there = truth(machine, move, BigFloat(path.timing->duration_s() * (n + 0.5) / kTimes));
        for (const BigFloat& low : there.low) least = std::min(least, low.to_double(MPFR_RNDN));
        for (std::size_t i = 0; i < kCables; ++i) {
          power[i] = std::max(power[i], abs(there.high[i] * there.winch_speed[i]).to_double(MPFR_RNDN));
        }
      }
      if (limited == LimitOf::kPower) {
        const auto i = static_cast<std::size_t>(std::ranges::max_element(power) - power.begin());
        machine.problem.time->winch_power_W[i] = MovingMachine::exact_text(power[i] * operands.uniform(1.001, 1.02));
        for (Limits& limits : machine.problem.robot.tension_N) limits = {"0.0001", "1000"};
      } else {
        const double lower = least - operands.uniform(0.001, 0.06);
        if (!(lower > 0)) continue;
        for (Limits& limits : machine.problem.robot.tension_N) limits.lower = MovingMachine::exact_text(lower);
      }
    }
    std::size_t k = 0;
    if (first_unproved(machine.problem, path, k).verdict != Verdict::kProved) continue;
    machine.problem.tolerances = SomeTolerances(operands, 0.01).text();
    const SegmentProof proof = first_unproved(machine.problem, path, k);
    ++count[proof.verdict == Verdict::kProved ? "proved" : proof.verdict == Verdict::kRefuted ? "refuted" : "open"];
    if (proof.verdict != Verdict::kRefuted) continue;
    const SegmentWitness& witness = *proof.witness;
    if (!witness.deviation) {
      ADD_FAILURE() << trial;
      continue;
    }
    const PrecisionScope precision(oracle::kMovingBits);
    const oracle::Move commanded = oracle_of(path);
    const BigFloat t = time_at(*path.timing, BigFloat(static_cast<double>(k)) + BigFloat(witness.box.mid().approx()));
    const Deviation& by = *witness.deviation;
    MovingMachine other = machine;
    const auto move_by = [](auto& anchors, const auto& deviations) {
      for (std::size_t i = 0; i < kCables; ++i) {
        for (std::size_t c = 0; c < 3; ++c) {
          anchors[i][c] = (oracle::big(anchors[i][c]) + oracle::big(deviations[i][c])).to_decimal(80, MPFR_RNDN);
        }
      }
    };
    move_by(other.problem.robot.base_anchors_m, by.base_anchors_m);
    move_by(other.problem.robot.platform_anchors_m, by.platform_anchors_m);
    const oracle::Move move = tracked(commanded, t, oracle::big(by.position_m), oracle::big(by.turn));
    const std::string limit = limit_of(witness);
    if (limit.starts_with("length")) continue;
    ++count[witness.rate ? "of a power" : "of a tension"];
    Truth there = truth(other, move, t);
    there.winch_speed = truth(machine, commanded, t).winch_speed;
    EXPECT_LT(slacks(other.problem, there).at(limit), oracle::big("1e-20")) << trial << ": " << limit;
  }
  for (const auto& [what, times] : count) std::printf("%s: %d\n", what.c_str(), times);
  return count;
}

TEST(Moving, MachinesThatDeviateRefuteMoves) {
  Operands operands(47);
  constexpr int kTrials = 60;
  auto count = refute_by_deviations(LimitOf::kTension, kTrials, operands);
  EXPECT_GE(count["of a tension"], kTrials / 6);
  EXPECT_LE(count["open"], kTrials / 6);
}

TEST(Moving, MachinesThatDeviateNeedMorePowerThanTheirWinchesHave) {
  Operands operands(53);
  constexpr int kTrials = 40;
  auto count = refute_by_deviations(LimitOf::kPower, kTrials, operands);
  EXPECT_GE(count["of a power"], kTrials / 6);
  EXPECT_LE(count["open"], kTrials / 6);
}

TEST(Moving, InertiaOverPartsOfTimesIsThatOfEachTime) {
  Operands operands(53);
  int in_several_parts = 0;
  for (int trial = 0; trial < 100; ++trial) {
    MovingMachine machine(operands);
    if (trial % 4 == 0) machine.problem.time->stopping_time_s = "0.5";
    const Path path = some_move(operands, 0.1);
    const Segment segment = path.segment(static_cast<std::size_t>(operands.pick(static_cast<int>(path.segments()))));
    const double from = 0x1p-8 * static_cast<double>(operands.pick(200)), to = from + 0x1p-8 * 50;
    const int halvings = trial % (MovingModel<Interval>::kMostHalvings + 1);
    std::vector<std::pair<Interval, Vector6<Interval>>> parts;
    ASSERT_TRUE(run_upward([&] {
      const ProofModel<Interval> model = make_proof_model(machine.problem);
      const EnclosedBox<Interval> box{Interval(from, to), Interval((from + to) / 2)};
      const double radius = (to - from) / 2;
      const auto motion = undisturbed_motion(model, segment, box, Interval(-radius, radius));
      const auto over = model.moving->over(model.model, segment, box.range, {motion, box.mid});
      ASSERT_TRUE(over);
      for (const auto& [here, load] : model.moving->load_in_parts(*over, halvings)) {
        parts.emplace_back(here, load.wrench);
      }
    }));
    in_several_parts += parts.size() > 1 ? 1 : 0;
    const PrecisionScope precision(oracle::kMovingBits);
    const oracle::Move move = oracle_of(path);
    for (int n = 0; n < 10; ++n) {
      const double place = operands.uniform(from, to);
      const BigFloat t = time_at(*path.timing, BigFloat(static_cast<double>(segment.index)) + BigFloat(place));
      const oracle::Big6 inertia = move.inertia(machine.particles(), oracle::big(machine.problem.load.point_m), t);
      bool is_anywhere = false;
      for (const auto& [here, wrench] : parts) {
        if (place < here.lower() || place > here.upper()) continue;
        is_anywhere = true;
        for (std::size_t k = 0; k < 6; ++k) {
          const double x = inertia[k].to_double(MPFR_RNDN), rounding = 1e-12 * (1 + std::abs(x));
          EXPECT_LE(wrench(static_cast<int>(k)).lower() - rounding, x) << trial;
          EXPECT_GE(wrench(static_cast<int>(k)).upper() + rounding, x) << trial;
        }
      }
      EXPECT_TRUE(is_anywhere) << trial;
    }
  }
  EXPECT_GT(in_several_parts, 50);
}

/// Of a move, with these limits of tensions.
BoxEnclosure<Interval> enclose_with_limits(Problem problem, const Segment& segment, const DyadicBox& box,
                                           const std::array<std::array<double, 2>, kCables>& limits) {
  for (std::size_t i = 0; i < kCables; ++i) {
    problem.robot.tension_N[i] = {MovingMachine::exact_text(limits[i][0]), MovingMachine::exact_text(limits[i][1])};
  }
  BoxEnclosure<Interval> result;
  EXPECT_TRUE(run_upward([&] { result = enclose_box(make_proof_model(problem), segment, box); }));
  return result;
}

TEST(Moving, TensionsOverPartsOfTimesAreThoseOfEachTime) {
  Operands operands(59);
  constexpr int kTrials = 120;
  std::array<int, 2> narrowed{};  // of moves that may stop, too
  for (int trial = 0; trial < kTrials; ++trial) {
    MovingMachine machine(operands);
    const bool may_stop = trial % 3 == 0;
    const double stopping_s = 0.5;
    if (may_stop) machine.problem.time->stopping_time_s = MovingMachine::exact_text(stopping_s);
    const Path path = some_move(operands, 0.1);
    const Segment segment = path.segment(static_cast<std::size_t>(operands.pick(static_cast<int>(path.segments()))));
    const int depth = 2 + operands.pick(4);
    const DyadicBox box{operands.pick(1 << depth), depth};
    std::array<std::array<double, 2>, kCables> limits;
    limits.fill({-1e6, 1e6});
    const BoxEnclosure<Interval> whole = enclose_with_limits(machine.problem, segment, box, limits);
    Segment still = segment;
    still.timing = nullptr;
    const BoxEnclosure<Interval> at_rest = enclose_with_limits(machine.problem, still, box, limits);
    if (!at_rest.regular || !whole.regular) continue;
    // With limits next to what tensions are at rest, parts of the times are asked.
    for (std::size_t i = 0; i < kCables; ++i) {
      limits[i] = {at_rest.low[i].range.lower() - 1e-6, at_rest.high[i].range.upper() + 1e-6};
    }
    const BoxEnclosure<Interval> parts = enclose_with_limits(machine.problem, segment, box, limits);
    const auto width = [](const SlopeForm<Interval>& x) { return x.range.upper() - x.range.lower(); };
    narrowed[may_stop ? 1 : 0] += width(parts.low[0]) < 0.95 * width(whole.low[0]) ? 1 : 0;
    const PrecisionScope precision(oracle::kMovingBits);
    const oracle::Move move = oracle_of(path);
    for (int n = 0; n < 8; ++n) {
      const double place = operands.uniform(box.lower().approx(), box.upper().approx());
      const BigFloat t = time_at(*path.timing, BigFloat(static_cast<double>(segment.index)) + BigFloat(place));
      const double share = may_stop && n % 2 == 0 ? operands.uniform(0, 1) : 1;
      const double change = may_stop ? operands.uniform(-1, 1) / stopping_s : 0;
      const Truth true_there = truth(machine, slowed(move, t, BigFloat(share), BigFloat(change)), BigFloat(0.0));
      const auto is_in = [](const SlopeForm<Interval>& tension, const BigFloat& x) {
        const double there = x.to_double(MPFR_RNDN), rounding = 1e-12 * (1 + std::abs(there));
        return tension.range.lower() - rounding <= there && there <= tension.range.upper() + rounding;
      };
      for (std::size_t i = 0; i < kCables; ++i) {
        EXPECT_TRUE(is_in(parts.low[i], true_there.low[i])) << trial;
        EXPECT_TRUE(is_in(parts.high[i], true_there.high[i])) << trial;
      }
    }
  }
  EXPECT_GT(narrowed[0], kTrials / 4);
  EXPECT_GT(narrowed[1], kTrials / 12);
}

TEST(Moving, ATurnOfThePlatformChangesItsInertiaByNoMoreThanIsSaid) {
  Operands operands(41);
  for (int trial = 0; trial < 200; ++trial) {
    MovingMachine machine(operands);
    const Path path = some_move(operands, 0.1);
    const Segment segment = path.segment(0);
    const double s = operands.uniform(0, 1), turn = operands.uniform(0, 0.3);
    const PathRates<double> at = PathRatesModel<double, 2>(machine.problem).along_curve(segment, s);
    const Rates<double> rates = by_time(at, operands.uniform(0, 3), operands.uniform(-9, 9));
    const std::vector<MovingBody<double>> bodies = make_moving_bodies<double>(machine.problem.load);
    const Eigen::Vector3d axis(operands.uniform(-1, 1), operands.uniform(-1, 1), operands.uniform(-1, 1));
    const Matrix3<double> turned = Eigen::AngleAxisd(turn * (1 - 1e-9), axis.normalized()).toRotationMatrix() * at.r_WP;
    const Vector6<double> change = inertial_wrench(bodies, turned, rates) - inertial_wrench(bodies, at.r_WP, rates);
    Vector6<Interval> said;
    ASSERT_TRUE(run_upward([&] {
      Moving<Interval> undisturbed;
      for (int k = 0; k < 9; ++k) undisturbed.r_WP(k) = Interval(at.r_WP(k));
      const auto exact = [](const Vector3<double>& v) {
        return Vector3<Interval>(Interval(v(0)), Interval(v(1)), Interval(v(2)));
      };
      undisturbed.rates = {exact(rates.velocity), exact(rates.acceleration), exact(rates.angular_velocity),
                           exact(rates.angular_acceleration)};
      said = MovingModel<Interval>(machine.problem).change(undisturbed, Interval(turn));
    }));
    for (int k = 0; k < 6; ++k) {
      const double rounding = 1e-10 * (1 + std::abs(change(k)));
      EXPECT_LE(lower_bound(said(k)) - rounding, change(k));
      EXPECT_GE(upper_bound(said(k)) + rounding, change(k));
    }
  }
}

}  // namespace
}  // namespace taut::testing
