// SPDX-License-Identifier: GPL-3.0-or-later
#include "planner/edge_motion.h"

#include <gtest/gtest.h>

#include "tests/support/robots.h"

namespace taut {
namespace {

constexpr double kRadius = 0.13;  // [m]

Coordinates on_sphere(double phi, double theta) {
  Coordinates q(5);
  q << -kRadius * std::sin(theta) * std::cos(phi), -kRadius * std::sin(theta) * std::sin(phi),
      0.306 - kRadius * std::cos(theta), phi, theta;
  return q;
}

TEST(EdgeMotion, IsStraightInTheParametersWithoutConstraints) {
  const PoseSampler sampler(testing::robot1_slice());
  const Coordinates a = Eigen::Vector2d(-2.25, 1.5);
  const Coordinates b = Eigen::Vector2d(-2.0, 1.0);
  const EdgeMotion motion(sampler, a, b);
  EXPECT_EQ(motion.pose(0.5).angles[0], -2.125);
  EXPECT_EQ(motion.pose(0.5).angles[1], 1.25);
}

TEST(EdgeMotion, StaysOnTheConstraints) {
  const PoseSampler sampler(testing::robot2_implicit_sphere(false));
  const EdgeMotion motion(sampler, on_sphere(0.5, 0.8), on_sphere(0.9, 0.6));
  for (const double s : {0.0, 0.2, 0.5, 0.9, 1.0}) {
    const Pose<double> pose = motion.pose(s);
    const Vector3<double> centre(0, 0, 0.306);
    const Vector3<double> axis(std::sin(pose.angles[1]) * std::cos(pose.angles[0]),
                               std::sin(pose.angles[1]) * std::sin(pose.angles[0]), std::cos(pose.angles[1]));
    EXPECT_LT((pose.p_WP + kRadius * axis - centre).norm(), 1e-14);
  }
  EXPECT_NEAR(motion.pose(0).angles[0], 0.5, 1e-14);
  EXPECT_NEAR(motion.pose(1).angles[1], 0.6, 1e-14);
}

TEST(EdgeMotion, AgreesWithTheProversMotion) {
  const PoseSampler sampler(testing::robot2_implicit_sphere(false));
  const Coordinates a = on_sphere(0.5, 0.8);
  const Coordinates b = on_sphere(0.9, 0.6);
  const auto waypoint = [&](const Coordinates& q) {
    Waypoint w{{q.data(), q.data() + q.size()}, std::vector<int>(5, 0)};
    w.parameters().normals = sampler.constraints()->normals(w);
    return w;
  };
  const Waypoint from = waypoint(a);
  const Waypoint to = waypoint(b);
  const Pose<double> expected = sampler.pose(sampler.parameters(Segment::straight(from, to), 0.375));
  EXPECT_LT((EdgeMotion(sampler, a, b).pose(0.375).p_WP - expected.p_WP).norm(), 1e-14);
}

TEST(EdgeMotion, IsNotANumberWhereThereIsNoPoseOnTheConstraints) {
  Problem problem = testing::robot2_implicit_sphere(false);
  problem.space.constraints = {"px^2 - 0.01"};  // two planes, with none between
  const PoseSampler sampler(problem);
  Coordinates a(5);
  Coordinates b(5);
  a << -0.1, 0, 0.3, 0, 0;
  b << 0.1, 0, 0.3, 0, 0;
  EXPECT_TRUE(std::isnan(EdgeMotion(sampler, a, b).pose(0.5).p_WP.x()));
}

}  // namespace
}  // namespace taut
