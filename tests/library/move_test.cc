// SPDX-License-Identifier: GPL-3.0-or-later
// Moves that are planned: proved, near the fastest law, and as slow or as fast as is asked for.
#include "planner/move.h"

#include <gtest/gtest.h>

#include <cmath>

#include "base/input_error.h"
#include "certify/headroom.h"
#include "kinematics/move_sampler.h"
#include "kinematics/path_rates.h"
#include "planner/planner.h"
#include "tests/support/robots.h"

namespace taut {
namespace {

/// The portal crane with limits in time: of the load and of winches.
Case crane(bool has_tolerances) {
  Case the_case = load_case(TAUT_SOURCE_DIR "/cases/cranes/portal-20t.yaml");
  if (has_tolerances) {
    the_case.problem.tolerances->position_m = "0.02";
  } else {
    the_case.problem.tolerances.reset();
  }
  TimeText& time = the_case.problem.time.emplace();
  time.load_speed_m_s = "0.8";
  time.load_acceleration_m_s2 = "0.2";
  time.load_angular_speed_rad_s = "5*pi/180";
  time.winch_speed_m_s.fill("1");
  time.winch_acceleration_m_s2.fill("0.5");
  the_case.move.jerk_m_s3 = 1;
  return the_case;
}

Path spline_of(const std::vector<Waypoint>& points) {
  Path path;
  path.interpolation = Interpolation::kCubicBSpline;
  for (const Waypoint& point : points) path.waypoints.insert(path.waypoints.end(), 3, point);
  return path;
}
Path crane_path(const Case& the_case) {
  const std::vector<Waypoint> query = query_waypoints(the_case.problem);
  return spline_of({query.front(), query.back()});
}

PlannedMove plan_move(const Case& the_case, const Path& path, const MoveRequest& request = {}) {
  const Prover prover(the_case.problem);
  return plan_move(the_case, prover, path, request, {}, {});
}

TEST(Move, ACraneIsProvedNearItsFastestLaw) {
  const Case the_case = crane(false);
  const PlannedMove move = plan_move(the_case, crane_path(the_case));
  ASSERT_EQ(move.proof.verdict, Verdict::kProved) << move.proof.reason;
  ASSERT_TRUE(move.path.timing && move.statistics.fastest_s);
  EXPECT_EQ(complaint(move.path), "");
  EXPECT_EQ(move.path.waypoints, crane_path(the_case).waypoints);
  const MoveStatistics& statistics = move.statistics;
  EXPECT_EQ(statistics.duration_s, move.path.timing->duration_s());
  EXPECT_EQ(statistics.planned_s, statistics.duration_s);
  EXPECT_GT(statistics.duration_s, *statistics.fastest_s);
  EXPECT_LT(statistics.duration_s, 1.15 * *statistics.fastest_s);
  // 8 m at 0.8 m/s, with 4 s to speed up and to slow down.
  EXPECT_GT(statistics.duration_s, 8 / 0.8 + 0.8 / 0.2);
  EXPECT_EQ(std::ldexp(move.path.timing->step_s, 20), std::round(std::ldexp(move.path.timing->step_s, 20)));
}

TEST(Move, WhatTolerancesTakeIsLeftToTensionsFromTheBegin) {
  const Case the_case = crane(true);
  const Path path = crane_path(the_case);
  const Prover prover(the_case.problem);
  constexpr std::size_t kGrid = 8;
  const std::vector<TensionLoss> losses = tension_losses(prover, path, kGrid);
  ASSERT_EQ(losses.size(), path.segments() * kGrid + 1);
  const PoseSampler sampler(the_case.problem);
  for (std::size_t i = 0; i < losses.size(); ++i) {
    EXPECT_GT(losses[i].turn, 0.3 * 3.14 / 180);
    EXPECT_LT(losses[i].turn, 0.4 * 3.15 / 180);
    const std::size_t k = std::min(i / kGrid, path.segments() - 1);
    const double s = static_cast<double>(i - k * kGrid) / kGrid;
    const Statics<double> at_rest = sampler.statics(sampler.rigid_pose(path.segment(k), s));
    for (std::size_t cable = 0; cable < kCables; ++cable) {
      // The path is proved, so that it is not all there is.
      const double low = at_rest.tension[cable] - at_rest.tension_below[cable] - sampler.model().tension_lower[cable];
      EXPECT_GT(losses[i].newtons[cable][0], 10);
      EXPECT_LT(losses[i].newtons[cable][0], low);
      EXPECT_GT(losses[i].newtons[cable][1], 10);
    }
  }
  EXPECT_TRUE(tension_losses(Prover(crane(false).problem), path, kGrid).empty());
  const PlannedMove move = plan_move(the_case, path);
  ASSERT_EQ(move.proof.verdict, Verdict::kProved) << move.proof.reason;
  EXPECT_LE(move.statistics.tries, 6) << "the proposal knows what deviations take";
  EXPECT_LT(move.statistics.duration_s, 1.5 * *move.statistics.fastest_s);
}

TEST(Move, IsAsSlowAsIsAskedFor) {
  const Case the_case = crane(false);
  const PlannedMove slow = plan_move(the_case, crane_path(the_case), {.speed_share = 0.4});
  ASSERT_EQ(slow.proof.verdict, Verdict::kProved) << slow.proof.reason;
  EXPECT_NEAR(slow.statistics.speed_share, 0.4, 1e-4);
  EXPECT_LE(slow.statistics.speed_share, 0.4);
  EXPECT_NEAR(slow.statistics.planned_s, plan_move(the_case, crane_path(the_case)).statistics.duration_s, 1e-9);
}

TEST(Move, ItsGreatestSpeedIsProvedAndALittleMoreIsRefuted) {
  const Case the_case = crane(false);
  const PlannedMove fast = plan_move(the_case, crane_path(the_case), {.seeks_greatest_speed = true});
  ASSERT_EQ(fast.proof.verdict, Verdict::kProved) << fast.proof.reason;
  ASSERT_TRUE(fast.statistics.greatest);
  const GreatestSpeed& greatest = *fast.statistics.greatest;
  EXPECT_GE(greatest.proved, 1);
  EXPECT_NEAR(fast.statistics.speed_share, greatest.proved, 1e-9);
  ASSERT_TRUE(greatest.refuted && greatest.witness);
  EXPECT_GT(*greatest.refuted, greatest.proved);
  EXPECT_LE(*greatest.refuted, 1.01 * greatest.proved);
  ASSERT_TRUE(greatest.witness->rate);  // this crane's tensions have much to spare
  Path faster = fast.path;
  faster.timing->step_s = fast.path.timing->step_s * greatest.proved / *greatest.refuted;
  EXPECT_EQ(prove_path(Prover(the_case.problem), faster).verdict, Verdict::kRefuted);
}

TEST(Move, SlowsDownUntilItIsProvedWhereNothingWasProposed) {
  const Case the_case = crane(false);
  Path standing = crane_path(the_case);  // of no length: no limit bounds a speed
  standing.waypoints.assign(standing.waypoints.size(), standing.waypoints.front());
  const PlannedMove move = plan_move(the_case, standing);
  EXPECT_EQ(move.proof.verdict, Verdict::kProved) << move.proof.reason;
  EXPECT_FALSE(move.statistics.fastest_s);
  EXPECT_EQ(*move.path.timing, resting_law(standing));

  // Tensions of a case alone, which a law of a second a segment breaks.
  Case light = crane(false);
  light.problem.time.emplace().load_acceleration_m_s2 = "1e-4";
  const Path path = crane_path(light);
  const Prover prover(light.problem);
  Path hasty = path;
  hasty.timing = resting_law(path);
  EXPECT_NE(prove_path(prover, hasty).verdict, Verdict::kProved);
  const PlannedMove slow = plan_move(light, path);
  EXPECT_EQ(slow.proof.verdict, Verdict::kProved) << slow.proof.reason;
  EXPECT_GT(slow.statistics.duration_s, 2 * std::sqrt(8 / 1e-4));
}

/// What a proof leaves is that of the machine in motion, and where little is left is where its tensions say.
TEST(Move, ItsHeadroomIsThatOfTheMachineInMotion) {
  Case the_case = crane(true);
  // Tensions bind: hard starts, and little above the least tension.
  the_case.problem.time->load_acceleration_m_s2 = "0.6";
  the_case.problem.time->winch_acceleration_m_s2.fill("2");
  the_case.move.jerk_m_s3 = 3;
  const PlannedMove move = plan_move(the_case, crane_path(the_case));
  ASSERT_EQ(move.proof.verdict, Verdict::kProved) << move.proof.reason;
  const Problem& problem = the_case.problem;
  const Headroom found = find_headroom(problem, move.path, Verdict::kProved, "1", {}, {});
  ASSERT_GT(found.shares.size(), 4U);
  const DecimalText& share = found.shares.front().share;
  const auto verdict_at = [&](const DecimalText& factor) {
    const Problem scaled = with_uncertainty_scaled(problem, UncertaintyKind::kAll, Decimal::parse(factor));
    return prove_path(Prover(scaled), move.path).verdict;
  };
  EXPECT_GE(ScalarTraits<double>::from_decimal(share), 1);
  EXPECT_EQ(verdict_at(share), Verdict::kProved);
  EXPECT_NE(verdict_at((Decimal::parse(share) * Decimal::parse("1.1")).text()), Verdict::kProved);
  Path still = move.path;
  still.timing.reset();
  const Headroom at_rest = find_headroom(without_time(problem), still, Verdict::kProved, "1", {}, {});
  EXPECT_LE(ScalarTraits<double>::from_decimal(share),
            1.03 * ScalarTraits<double>::from_decimal(at_rest.shares.front().share));
  ASSERT_TRUE(found.tightest && !found.tightest->singular);

  // While it speeds up, margins are those of tensions with inertia.
  const MoveSample sample = MoveSampler(problem).at_time(move.path, 0.1 * move.statistics.duration_s);
  const PoseSampler sampler(problem);
  const RigidPose pose = sampler.rigid_pose(move.path.segment(sample.segment), sample.s);
  const auto budgets = MarginDifferentiator(problem, false).budgets(pose, sample.inertial_wrench);
  ASSERT_TRUE(budgets);
  double most_apart = 0;
  for (const MarginBudget& budget : *budgets) {
    if (budget.id.kind != MarginKind::kTensionMin) continue;
    const auto cable = static_cast<std::size_t>(budget.id.cable);
    EXPECT_NEAR(budget.quantity, sample.statics.tension[cable], 1e-9 * std::abs(sample.statics.tension[cable]));
    most_apart = std::max(most_apart, std::abs(budget.quantity - sampler.statics(pose).tension[cable]));
  }
  EXPECT_GT(most_apart, 50);
}

TEST(Move, IsRefutedWhereItsPathIsNotFeasibleAtRest) {
  Case the_case = crane(false);
  for (Limits& limits : the_case.problem.robot.tension_N) limits.upper = "40000";
  const PlannedMove move = plan_move(the_case, crane_path(the_case));
  EXPECT_EQ(move.proof.verdict, Verdict::kRefuted);
  ASSERT_TRUE(move.proof.witness);
  EXPECT_EQ(complaint(move.path), "");
}

TEST(Move, CornersAndStopsAreKept) {
  const Case the_case = crane(false);
  std::vector<Waypoint> points = query_waypoints(the_case.problem);
  Waypoint middle = points.front();
  middle.parameters().x[0] = 0;
  middle.parameters().x[2] += 1;
  points.insert(points.begin() + 1, middle);
  const Path corner{points};
  for (const Path& path : {corner, spline_of(points)}) {
    EXPECT_EQ(resting_law(path).controls.size(), path.interpolation == Interpolation::kStraight ? 9U : 11U);
    Path slow = path;
    slow.timing = resting_law(path);
    EXPECT_EQ(complaint(slow), "");
    const PlannedMove move = plan_move(the_case, path);
    ASSERT_EQ(move.proof.verdict, Verdict::kProved) << move.proof.reason;
    ASSERT_TRUE(move.statistics.fastest_s);
    EXPECT_LT(move.statistics.duration_s, 1.3 * *move.statistics.fastest_s);
    EXPECT_EQ(complaint(move.path), "");
  }
}

TEST(Move, StopsWhenTold) {
  const Case the_case = crane(false);
  std::stop_source source;
  source.request_stop();
  const Prover prover(the_case.problem);
  const PlannedMove move = plan_move(the_case, prover, crane_path(the_case), {}, source.get_token(), {});
  EXPECT_EQ(move.proof.verdict, Verdict::kUndecided);
  EXPECT_LE(move.statistics.tries, 2);
}

TEST(Move, OfACaseIsThePlan) {
  Case the_case = crane(false);
  int most_tries = 0;
  Planner planner(the_case);
  const Plan plan = planner.plan([&](const PlanProgress& at) { most_tries = std::max(most_tries, at.move_tries); }, {});
  ASSERT_EQ(plan.proof.verdict, Verdict::kProved) << plan.proof.reason;
  ASSERT_TRUE(plan.move && plan.path.timing);
  EXPECT_EQ(most_tries, plan.move->tries);
  EXPECT_EQ(prove_path(Prover(the_case.problem), plan.path).verdict, Verdict::kProved);
  // The same path as without limits in time, of which nothing depends on the law.
  const Case at_rest = [&] {
    Case same = the_case;
    same.problem.time.reset();
    return same;
  }();
  const Plan still = Planner(at_rest).plan({}, {});
  EXPECT_EQ(still.path.waypoints, plan.path.waypoints);
  EXPECT_FALSE(still.move || still.path.timing);
  EXPECT_EQ(planner.atlas_bytes(), [&] {
    Planner other(at_rest);
    static_cast<void>(other.plan({}, {}));
    return other.atlas_bytes();
  }());
}

}  // namespace
}  // namespace taut
