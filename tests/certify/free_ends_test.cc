// SPDX-License-Identifier: GPL-3.0-or-later
#include "certify/free_ends.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <string>
#include <vector>

#include "certify/headroom.h"
#include "problem/decimal.h"
#include "tests/support/robots.h"

namespace taut {
namespace {

double number(const DecimalText& text) { return ScalarTraits<double>::from_decimal(text); }

Path short_path() {
  Path path;
  for (const double theta : {0.2, 0.26, 0.33}) path.waypoints.push_back(testing::at({0.5, theta}));
  return path;
}

BodyText ball(const std::string& name, const PointText& at, const DecimalText& radius) {
  return {.name = name, .at_m = at, .shape = HullText{{{"0", "0", "0"}}, radius}};
}

/// Robot 1 with cables of 2 mm, and no pairs yet.
Problem robot() {
  Problem problem = testing::robot1_slice();
  problem.query.clear();
  problem.bodies.emplace().cables.diameter_m.fill("0.002");
  return problem;
}

void check(Problem& problem, PairClass kind) { problem.bodies->clearance_m[static_cast<std::size_t>(kind)] = "0.001"; }

bool is_proved(const Problem& problem, const Path& path) {
  validate(problem);
  const Prover prover(problem);
  for (std::size_t k = 0; k < path.segments(); ++k) {
    if (prover.prove(prover.prepared(path.segment(k))).verdict != Verdict::kProved) return false;
  }
  return true;
}

/// What is found for a path that is not proved as it is.
std::optional<ProvedFreeEnds> found(const Problem& problem, const Path& path, std::stop_token stop = {}) {
  EXPECT_FALSE(is_proved(problem, path));
  const Prover prover(problem);
  std::vector<Segment> segments;
  for (std::size_t k = 0; k < path.segments(); ++k) segments.push_back(prover.prepared(path.segment(k)));
  return find_free_ends(prover, segments, stop);
}

// A cable leaves the middle of a ball straight: its body is clear of it beyond the ball's radius, half its own
// diameter and the clearance, at every pose.
TEST(FreeEnds, AreTheShortestWithWhichACableClearsABallAroundItsAnchor) {
  Problem at_platform = robot();
  at_platform.bodies->platform = {ball("lug", at_platform.robot.platform_anchors_m[0], "0.0103")};
  check(at_platform, PairClass::kCablesPlatform);
  const auto near_platform = found(at_platform, short_path());
  ASSERT_TRUE(near_platform);
  EXPECT_EQ(near_platform->free_ends, (FreeEnds{std::nullopt, "0.013"})) << "0.0103 + 0.001 + 0.001, upwards";
  EXPECT_TRUE(near_platform->is_complete);
  EXPECT_TRUE(is_proved(with_free_ends(at_platform, near_platform->free_ends), short_path()));
  EXPECT_FALSE(is_proved(with_free_ends(at_platform, {std::nullopt, "0.012"}), short_path()));

  Problem at_base = robot();
  at_base.bodies->obstacles = {ball("pulley", at_base.robot.base_anchors_m[2], "0.0203")};
  check(at_base, PairClass::kCablesObstacles);
  const auto near_base = found(at_base, short_path());
  ASSERT_TRUE(near_base);
  EXPECT_EQ(near_base->free_ends, (FreeEnds{"0.023", std::nullopt}));

  Problem both = at_platform;
  both.bodies->obstacles = at_base.bodies->obstacles;
  check(both, PairClass::kCablesObstacles);
  const auto at_both = found(both, short_path());
  ASSERT_TRUE(at_both);
  EXPECT_EQ(at_both->free_ends, (FreeEnds{"0.023", "0.013"}));
}

// Two cables with a common anchor, at the angle α, are (diameter + clearance) / (2 sin ½α) along them far enough apart.
TEST(FreeEnds, TellCablesApartThatShareAnAnchor) {
  Problem problem = robot();
  check(problem, PairClass::kCablesCables);
  const Path path = short_path();
  const auto result = found(problem, path);
  ASSERT_TRUE(result);
  const Prover prover(problem);
  const PoseSampler& sampler = prover.sampler();
  std::array<double, 2> truth{};
  for (std::size_t k = 0; k < path.segments(); ++k) {
    for (int sample = 0; sample <= 20; ++sample) {
      const RigidPose pose = sampler.rigid_pose(path.segment(k), sample / 20.0);
      const auto along = [&](std::size_t i) {
        return Vector3<double>(pose.p + pose.q * sampler.model().p_PB[i] - sampler.model().p_WA[i]).normalized();
      };
      for (const auto& pair : prover.bodies()->bodies().pairs) {
        const double half_sine = 0.5 * (along(pair.first) - along(pair.second)).norm();
        for (const std::size_t end : {0U, 1U}) {
          if (end == 0 ? pair.shares_base : pair.shares_platform) {
            truth[end] = std::max(truth[end], 0.003 / (2 * half_sine));
          }
        }
      }
    }
  }
  for (const std::size_t end : {0U, 1U}) {
    ASSERT_TRUE(result->free_ends[end]) << end;
    EXPECT_GE(number(*result->free_ends[end]), truth[end]) << end;
    EXPECT_LE(number(*result->free_ends[end]), 1.12 * truth[end]) << end << ": two digits, upwards";
  }
}

TEST(FreeEnds, AreNotSoughtWhereSomethingElseTouches) {
  const Path path = short_path();
  const Prover prover(robot());
  const RigidPose pose = prover.sampler().rigid_pose(path.segment(0), 0.5);
  const Model<double>& model = prover.sampler().model();
  const Vector3<double> a = model.p_WA[0], b = pose.p + pose.q * model.p_PB[0];
  const auto obstacle = [&](double share) {
    const Vector3<double> x = a + share * (b - a);
    return ball("stone", {std::to_string(x(0)), std::to_string(x(1)), std::to_string(x(2))}, "0.005");
  };
  for (const double share : {0.5, 0.95}) {  // in the middle; near the platform, where only a free end would hide it
    Problem problem = robot();
    problem.bodies->obstacles = {obstacle(share)};
    check(problem, PairClass::kCablesObstacles);
    EXPECT_FALSE(found(problem, path)) << share;
    // Not either beside a ball that free ends would help against.
    problem.bodies->platform = {ball("lug", problem.robot.platform_anchors_m[0], "0.0103")};
    check(problem, PairClass::kCablesPlatform);
    EXPECT_FALSE(found(problem, path)) << share;
  }
  Problem hit = robot();
  hit.bodies->platform = {ball("lug", hit.robot.platform_anchors_m[0], "0.0103")};
  hit.bodies->obstacles = {obstacle(1)};
  check(hit, PairClass::kCablesPlatform);
  check(hit, PairClass::kPlatformObstacles);
  EXPECT_FALSE(found(hit, path));
}

TEST(FreeEnds, KeepLongerOnesAsTheyAre) {
  Problem problem = robot();
  problem.bodies->platform = {ball("lug", problem.robot.platform_anchors_m[0], "0.0103")};
  problem.bodies->cables.free_ends_m[1] = {"0.01", "0.05"};
  check(problem, PairClass::kCablesPlatform);
  const Problem longer = with_free_ends(problem, {"0.02", "0.04"});
  EXPECT_EQ(longer.bodies->cables.free_ends_m[0], (std::array<DecimalText, 2>{"0.02", "0.04"}));
  EXPECT_EQ(longer.bodies->cables.free_ends_m[1], (std::array<DecimalText, 2>{"0.02", "0.05"}));
}

TEST(FreeEnds, AreWhatTheHeadroomOfAnUnprovedPathHas) {
  Problem problem = robot();
  problem.bodies->platform = {ball("lug", problem.robot.platform_anchors_m[0], "0.0103")};
  check(problem, PairClass::kCablesPlatform);
  const Headroom headroom = find_headroom(problem, short_path(), Verdict::kRefuted, "", {}, {});
  ASSERT_TRUE(headroom.free_ends);
  EXPECT_EQ(headroom.free_ends->free_ends[1], "0.013");
  const Problem enough = with_free_ends(problem, headroom.free_ends->free_ends);
  EXPECT_FALSE(find_headroom(enough, short_path(), Verdict::kProved, "", {}, {}).free_ends) << "of a proved path";

  std::stop_source stopped;
  stopped.request_stop();
  EXPECT_FALSE(found(problem, short_path(), stopped.get_token())) << "nothing was proved";
}

}  // namespace
}  // namespace taut
