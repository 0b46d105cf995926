// SPDX-License-Identifier: GPL-3.0-or-later
// Plans and proofs for robots that share nothing with the paper's: no paired anchors, no plane, no axis that is down.
#include <fmt/format.h>
#include <gtest/gtest.h>

#include <numbers>
#include <tuple>

#include "certificate/certificate_writer.h"
#include "certificate/elaborate.h"
#include "checker/check.h"
#include "planner/planner.h"
#include "reports/page/html_report.h"

namespace taut {
namespace {

using Anchors = std::array<std::array<int, 3>, 6>;  // [mm]

struct Robot {
  Anchors base = {{{0, 300, 0}, {0, 300, 0}, {-260, -150, 0}, {-260, -150, 0}, {260, -150, 0}, {260, -150, 0}}};
  Anchors platform = {{{-130, 75, 0}, {130, 75, 0}, {0, -150, 0}, {-130, 75, 0}, {130, 75, 0}, {0, -150, 0}}};
  std::string position = "px: 0, py: 0, pz: 400";
  std::string gravity = "[0, 0, 9.81]";
  std::string ellipsoid = "{diagonal: [1e4, 1e4, 1e4, 1e4, 1e4, 1e4]}";
  std::string query = "{phi: -1, theta: 0.2}, {phi: 1.5, theta: 0.3}";
};

std::string list(const Anchors& anchors) {
  std::string text;
  for (const auto& [x, y, z] : anchors) text += fmt::format("{}[{}, {}, {}]", text.empty() ? "" : ", ", x, y, z);
  return "[" + text + "]";
}

Case case_of(const Robot& robot) {
  return parse_case(
      fmt::format("taut: 1\nname: any\nunits: {{length: mm}}\n"
                  "robot: {{base_anchors: {}, platform_anchors: {}, tension: [0.1, 20], length: [100, 900]}}\n"
                  "load: {{mass: 0.6, gravity: {}, point: [5, -4, 3], ellipsoid: {}}}\n"
                  "space: {{slice: {{{}, sigma: 0.1}}}}\nquery: {{waypoints: [{}]}}\n",
                  list(robot.base), list(robot.platform), robot.gravity, robot.ellipsoid, robot.position, robot.query),
      "test.yaml");
}

/// Plans, and checks the proof by samples and the report by making it.
void expect_proved(const Robot& robot) {
  const Case the_case = case_of(robot);
  const Plan plan = Planner(the_case).plan({}, {});
  EXPECT_EQ(plan.proof.verdict, Verdict::kProved) << plan.proof.reason;
  const PoseSampler sampler(the_case.problem);
  for (std::size_t k = 0; k < plan.path.segments(); ++k) {
    for (int i = 0; i <= 20; ++i) {
      const Pose<double> pose = sampler.pose(sampler.parameters(plan.path.segment(k), i / 20.0));
      EXPECT_GT(sampler.clearance(sampler.statics(pose)), 0);
    }
  }
  const Certificate certificate = elaborate(the_case.problem, plan.path, plan.proof);
  const checker::CheckResult checked = checker::check(certificate_text(certificate));
  ASSERT_TRUE(checked.theorem) << checked.message;
  EXPECT_EQ(checked.theorem->verdict(), checker::Theorem::Verdict::kProved);
  EXPECT_NE(html_report(checked).find("proved"), std::string::npos);
}

/// Every anchor its own, none in the plane of the others.
Robot irregular() {
  Robot robot;
  robot.base = {
      {{20, 300, 5}, {-35, 280, -20}, {-260, -130, 30}, {-230, -170, -10}, {250, -160, -35}, {275, -120, 15}}};
  robot.platform = {{{-130, 80, 10}, {120, 75, -15}, {10, -150, 20}, {-115, 60, -30}, {140, 55, 5}, {-15, -140, -5}}};
  return robot;
}

TEST(AnyAnchors, ThePapersKindOfRobot) { expect_proved(Robot()); }

TEST(AnyAnchors, TwelvePointsInTwoPlanes) {
  Robot robot = irregular();
  for (auto& anchor : robot.base) anchor[2] = 0;
  for (auto& anchor : robot.platform) anchor[2] = 0;
  expect_proved(robot);
}

TEST(AnyAnchors, NeitherBaseNorPlatformPlanar) { expect_proved(irregular()); }

TEST(AnyAnchors, AFullEllipsoid) {
  Robot robot;
  robot.ellipsoid =
      "{matrix: [[2e4, 3e3, -1e3, 500, 0, 2e3], [3e3, 1e4, 0, -800, 1e3, 0], [-1e3, 0, 1.5e4, 0, 700, -2e3],"
      " [500, -800, 0, 3e4, 2e3, 0], [0, 1e3, 700, 2e3, 1e4, -500], [2e3, 0, -2e3, 0, -500, 2e4]]}";
  expect_proved(robot);
}

/// Turned in the world by (x, y, z) -> (x, -y, -z): z points up, and the base is above.
TEST(AnyAnchors, ABaseAboveWithZUp) {
  Robot robot = irregular();
  for (auto& [x, y, z] : robot.base) std::tie(y, z) = std::pair(-y, -z + 800);
  for (auto& [x, y, z] : robot.platform) std::tie(y, z) = std::pair(-y, -z);
  robot.position = "px: 0, py: 0, pz: 400";  // 800 - 400
  robot.gravity = "[0, 0, -9.81]";
  Case the_case = case_of(robot);
  the_case.problem.load.point_m = {"0.005", "0.004", "-0.003"};
  // R' = X R X with X the turn: Rz(-phi) Ry(-theta) Rz(-(sigma - phi)), which takes (phi, theta, sigma) to
  // (pi - phi, theta, -sigma).
  the_case.problem.space.pose[5] = "-0.1";
  the_case.problem.query = {{"pi + 1", "0.2"}, {"pi - 1.5", "0.3"}};
  EXPECT_EQ(Planner(the_case).plan({}, {}).proof.verdict, Verdict::kProved);
  const PoseSampler down(case_of(irregular()).problem);
  const PoseSampler up(the_case.problem);
  for (const double phi : {-1.0, 1.5}) {
    const Statics<double> hanging = down.statics(down.pose(std::array{phi, 0.2}));
    const Statics<double> turned = up.statics(up.pose(std::array{std::numbers::pi - phi, 0.2}));
    for (std::size_t i = 0; i < kCables; ++i) {
      EXPECT_NEAR(hanging.tension[i], turned.tension[i], 1e-12);
      EXPECT_NEAR(hanging.tension_above[i], turned.tension_above[i], 1e-12);
    }
  }
}

/// Turned by (x, y, z) -> (z, x, y): the base stands upright, and gravity pulls along x.
TEST(AnyAnchors, ABaseOnAWall) {
  Robot robot = irregular();
  for (auto& [x, y, z] : robot.base) std::tie(x, y, z) = std::tuple(z, x, y);
  for (auto& [x, y, z] : robot.platform) std::tie(x, y, z) = std::tuple(z, x, y);
  robot.position = "px: 400, py: 0, pz: 0";
  robot.gravity = "[9.81, 0, 0]";
  robot.query = "{phi: -1, theta: 0.2}, {phi: 1.5, theta: 0.3}";
  expect_proved(robot);
}

}  // namespace
}  // namespace taut
