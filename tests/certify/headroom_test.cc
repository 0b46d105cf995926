// SPDX-License-Identifier: GPL-3.0-or-later
#include "certify/headroom.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <random>

#include "certify/path_proof.h"
#include "problem/decimal.h"
#include "tests/support/robots.h"

namespace taut {
namespace {

using testing::robot1_slice;

Path short_path() {
  Path path;
  for (const double theta : {0.2, 0.26, 0.33}) path.waypoints.push_back({{0.5, theta}, {0, 0}});
  return path;
}

Path still_path() {
  Path path;
  path.waypoints = {{{0.5, 0.25}, {0, 0}}, {{0.5, 0.25}, {0, 0}}};
  return path;
}

Verdict verdict(const Problem& problem, const Path& path) {
  const Prover prover(problem);
  Verdict worst = Verdict::kProved;
  for (std::size_t k = 0; k < path.segments(); ++k) {
    const Verdict found = prover.prove(prover.prepared(path.segment(k))).verdict;
    if (found == Verdict::kRefuted) return found;
    if (found == Verdict::kUndecided) worst = found;
  }
  return worst;
}

/// The problem at `more` times the share that was found.
Problem at(const Problem& problem, const ProvableShare& found, const char* more = "1") {
  const Problem whole = found.stated > 0 ? problem : with_unit_uncertainty(problem, found.of.kind);
  return with_uncertainty_scaled(whole, found.of, Decimal::parse(found.share) * Decimal::parse(more));
}

double number(const DecimalText& text) { return ScalarTraits<double>::from_decimal(text); }

const ProvableShare& share_of(const Headroom& headroom, UncertaintyKind kind) {
  return *std::ranges::find_if(headroom.shares, [&](const ProvableShare& share) { return share.of == kind; });
}

TEST(Headroom, SharesOfAProvedPathAreProvedAndNotFarFromWhereTheProofFails) {
  Problem problem = robot1_slice();
  problem.tolerances.emplace().position_m = "0.0002";
  problem.tolerances->cable_length_m.emplace().fill("0");
  const Path path = short_path();
  ASSERT_EQ(verdict(problem, path), Verdict::kProved);
  const Headroom found = find_headroom(problem, path, Verdict::kProved, "", {}, {});
  ASSERT_EQ(found.shares.size(), 1 + kUncertaintyKinds);
  EXPECT_EQ(found.shares.front().of, UncertaintyKind::kAll);
  for (const ProvableShare& share : found.shares) {
    EXPECT_TRUE(share.is_complete);
    EXPECT_GT(number(share.share), share.stated > 0 ? 1 : 1e-6) << name(share.of.kind);
    EXPECT_EQ(verdict(at(problem, share), path), Verdict::kProved) << name(share.of.kind);
    EXPECT_NE(verdict(at(problem, share, "1.1"), path), Verdict::kProved) << name(share.of.kind) << " " << share.share;
  }
  EXPECT_EQ(share_of(found, UncertaintyKind::kPosition).stated, 0.0002);
  EXPECT_LE(share_of(found, UncertaintyKind::kPosition).proved,
            0.0002 * number(share_of(found, UncertaintyKind::kPosition).share));
}

/// Of a path without tolerances that stays at one pose the largest share is known: (f0 − f_lo)/v and (f_hi − f0)/v.
TEST(Headroom, OfLoadsAloneIsNextToWhatIsExactlyKnown) {
  Problem problem = robot1_slice();
  const Path path = still_path();
  for (const char* factor : {"1", "7.5", "40"}) {
    const Problem scaled = with_uncertainty_scaled(problem, UncertaintyKind::kWrenchSet, Decimal::parse(factor));
    const PoseSampler sampler(scaled);
    const Statics<double> statics = sampler.statics(sampler.pose(path.waypoints[0]));
    const double exact = wrench_scale_approx(sampler.model(), statics);
    const Verdict before = verdict(scaled, path);
    ASSERT_EQ(before == Verdict::kProved, exact > 1);
    const Headroom found = find_headroom(scaled, path, before, "", {}, {});
    ASSERT_EQ(found.shares.size(), 1U);
    EXPECT_LT(number(found.shares[0].share), exact);
    EXPECT_GT(number(found.shares[0].share), 0.93 * exact);
    EXPECT_EQ(verdict(at(scaled, found.shares[0], "1.1"), path), Verdict::kRefuted);
  }
}

/// Machines within the share, by the equations in floating point.
double least_margin_of_random_machines(const Problem& problem, const Path& path, int count) {
  std::mt19937_64 random(7);
  std::normal_distribution<double> normal;
  const TolerancesText& t = *problem.tolerances;
  const PoseSampler sampler(problem);
  double least = 1e9;
  const auto within = [&](double size) {
    const Vector3<double> x(normal(random), normal(random), normal(random));
    return Vector3<double>(x.normalized() * size);
  };
  for (int n = 0; n < count; ++n) {
    Model<double> model = sampler.model();
    for (std::size_t i = 0; i < kCables; ++i) {
      model.p_WA[i] += within(number(t.base_anchor_m[i]));
      model.p_PB[i] += within(number(t.platform_anchor_m[i]));
    }
    for (std::size_t i = 0; i < kCables; ++i) model.p_MB[i] = model.p_PB[i] - model.p_PM;
    const double sign = n % 2 == 0 ? 1 : -1;
    for (int k = 0; k < 6; ++k) model.wrench(k) += sign * number(t.wrench[static_cast<std::size_t>(k)]);
    const Segment segment = path.segment(static_cast<std::size_t>(n) % path.segments());
    RigidPose pose = sampler.rigid_pose(segment, std::uniform_real_distribution<double>(0, 1)(random));
    pose.p += within(number(t.position_m));
    const Statics<double> at = statics(model, pose.p, Matrix3<double>(pose.q.toRotationMatrix()));
    for (const MarginId id : all_margins()) least = std::min(least, slack(model, limited_quantity(at, id), id));
  }
  return least;
}

TEST(Headroom, OfAnUnprovedPathIsAShareThatSamplingCannotRefute) {
  Problem problem = robot1_slice();
  TolerancesText& t = problem.tolerances.emplace();
  t.base_anchor_m.fill("0.004");
  t.platform_anchor_m.fill("0.004");
  t.wrench[2] = "0.2";
  t.position_m = "0.02";
  const Path path = short_path();
  const Verdict before = verdict(problem, path);
  ASSERT_NE(before, Verdict::kProved);
  EXPECT_LT(least_margin_of_random_machines(problem, path, 20000), 0);
  const Headroom found = find_headroom(problem, path, before, "", {}, {});
  const ProvableShare& all = found.shares.at(0);
  EXPECT_GT(number(all.share), 0.05);
  EXPECT_LT(number(all.share), 1);
  EXPECT_EQ(verdict(at(problem, all), path), Verdict::kProved);
  EXPECT_NE(verdict(at(problem, all, "1.1"), path), Verdict::kProved);
  EXPECT_GT(least_margin_of_random_machines(at(problem, all), path, 20000), 0);
  for (const ProvableShare& share : found.shares) {
    EXPECT_LT(number(share.share), 1) << name(share.of.kind);
    if (share.share == "0") continue;
    EXPECT_EQ(verdict(at(problem, share), path), Verdict::kProved) << name(share.of.kind);
  }
  ASSERT_TRUE(found.tightest);
  EXPECT_LT(found.tightest->budget.left(), 0);
  EXPECT_GT(found.tightest->budget.nominal, 0);
}

/// A block and a wind, with which the path is proved.
Problem robot_with_items() {
  Problem problem = robot1_slice();
  const std::array<RationalText, 3> at = problem.load.point_m;
  problem.load.ellipsoid.reset();
  problem.load.wrench.fill("0");
  problem.load.gravity_m_s2 = {"0", "0", "10"};
  problem.load.items = {{"block", Weight{"0.0995", "0.1005", at, "0.0005"}},
                        {"wind", Force{DiscOfVectors{"0.004", {"0", "0", "1"}}, Axes::kWorld, at}}};
  return problem;
}

TEST(Headroom, ListsLoadItemsByTheirNames) {
  Problem problem = robot_with_items();
  const Path path = short_path();
  ASSERT_EQ(verdict(problem, path), Verdict::kProved);
  std::vector<std::string> expected = {"all", "wrench_set", "load_item block", "load_item wind"};
  for (const bool has_tolerances : {false, true}) {
    if (has_tolerances) {
      problem.tolerances.emplace().position_m = "0.0002";
      expected = {"all",          "position",         "wrench_set", "load_item block", "load_item wind",
                  "base_anchors", "platform_anchors", "orientation"};
    }
    const Headroom found = find_headroom(problem, path, Verdict::kProved, "3", {}, {});
    std::vector<std::string> names;
    for (const ProvableShare& share : found.shares) {
      names.push_back(name(share.of.kind) + (share.of.item.empty() ? "" : " " + share.of.item));
      EXPECT_TRUE(share.is_complete);
      EXPECT_GT(number(share.share), share.stated > 0 ? 1 : 1e-6) << names.back();
      EXPECT_EQ(verdict(at(problem, share), path), Verdict::kProved) << names.back();
    }
    EXPECT_EQ(names, expected);
    const ProvableShare& wind = found.shares.at(has_tolerances ? 4 : 3);
    EXPECT_NE(verdict(at(problem, wind, "1.1"), path), Verdict::kProved) << wind.share;
  }
}

TEST(Headroom, OfALoadWithoutDeviationsIsNothingToState) {
  Problem problem = robot_with_items();
  problem.load.items = {{"block", Weight{"0.1", "0.1", problem.load.point_m, "0"}}};
  const Path path = short_path();
  ASSERT_EQ(verdict(problem, path), Verdict::kProved);
  const Headroom found = find_headroom(problem, path, Verdict::kProved, "", {}, {});
  EXPECT_TRUE(found.shares.empty());
  EXPECT_TRUE(found.tightest);
}

TEST(Headroom, SaysWhereTheNominalMachineItselfFails) {
  Problem problem = robot1_slice();
  const Path path = short_path();
  const PoseSampler sampler(problem);
  const Statics<double> at_start = sampler.statics(sampler.pose(path.waypoints[0]));
  problem.robot.tension_N[3].lower = std::to_string(at_start.tension[3] + 0.02);
  const Headroom found = find_headroom(problem, path, verdict(problem, path), "", {}, {});
  EXPECT_EQ(found.shares.at(0).share, "0");
  EXPECT_TRUE(found.shares.at(0).is_complete);
  EXPECT_EQ(found.nominal_provable, false);
  ASSERT_TRUE(found.nominal_violation);
  EXPECT_EQ(found.nominal_violation->margin, (MarginId{MarginKind::kTensionMin, 3}));
  EXPECT_EQ(found.tightest->budget.id, (MarginId{MarginKind::kTensionMin, 3}));
  EXPECT_LT(found.tightest->budget.nominal, -0.0199);
}

TEST(Headroom, StatesNoShareThatThereWasNoTimeToProve) {
  Problem problem = robot1_slice();
  problem.tolerances.emplace().position_m = "0.0002";
  std::stop_source source;
  source.request_stop();
  for (const Verdict verdict : {Verdict::kProved, Verdict::kUndecided}) {
    for (const ProvableShare& share :
         find_headroom(problem, short_path(), verdict, "", {}, source.get_token()).shares) {
      EXPECT_FALSE(share.is_complete);
      EXPECT_EQ(share.proved, verdict == Verdict::kProved ? share.stated : 0);
    }
  }
}

}  // namespace
}  // namespace taut
