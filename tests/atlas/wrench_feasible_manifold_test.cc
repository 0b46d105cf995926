// SPDX-License-Identifier: GPL-3.0-or-later
#include "atlas/wrench_feasible_manifold.h"

#include <gtest/gtest.h>

#include "base/input_error.h"
#include "kinematics/constraint_functions.h"
#include "tests/atlas/surfaces.h"
#include "tests/support/robots.h"

namespace taut {
namespace {

using testing::coordinates;

/// A pose of Robot 2 on the sphere.
Coordinates on_sphere(double phi, double theta) {
  return coordinates({-0.13 * std::sin(theta) * std::cos(phi), -0.13 * std::sin(theta) * std::sin(phi),
                      0.306 - 0.13 * std::cos(theta), phi, theta});
}

Coordinates with_sigma(const Coordinates& q, double sigma) {
  Coordinates result(q.size() + 1);
  result << q, sigma;
  return result;
}

struct Space {
  Problem problem;
  Coordinates at;
  int dimension;
};

std::vector<Space> spaces() {
  const Coordinates q = on_sphere(0.55 - 3.14, 0.5);
  std::vector<Space> all = {{testing::robot2_implicit_sphere(false), q, 2},
                            {testing::robot2_implicit_sphere(true), with_sigma(q, 0.1), 3}};
  Problem position_on_sphere = testing::robot2_implicit_sphere(true);
  position_on_sphere.space.constraints = {"px^2 + py^2 + (pz - 0.306)^2 - 0.13^2"};
  all.push_back({position_on_sphere, with_sigma(q, 0.1), 5});
  Problem meridian = testing::robot2_implicit_sphere(false);
  meridian.space.constraints.emplace_back("sin(phi + 2.59)");
  all.push_back({meridian, q, 1});
  all.push_back({testing::robot2_sphere(), coordinates({0.55, 1.07}), 2});
  return all;
}

TEST(WrenchFeasibleManifold, HasAsManyDimensionsAsTheConstraintsLeave) {
  for (const Space& space : spaces()) {
    const auto manifold = make_wrench_feasible_manifold(space.problem);
    EXPECT_EQ(manifold->dimension(), space.dimension);
    EXPECT_EQ(manifold->coordinate_dimension(), static_cast<int>(space.problem.space.parameters.size()));
  }
}

TEST(WrenchFeasibleManifold, TheFrameRepeatsItsCoordinatesAndHasAnOrthonormalTangent) {
  for (const Space& space : spaces()) {
    const auto manifold = make_wrench_feasible_manifold(space.problem);
    Frame frame;
    ASSERT_TRUE(manifold->frame_at(space.at, frame)) << space.dimension;
    EXPECT_EQ(Coordinates(frame.coordinates()), space.at);
    const Eigen::MatrixXd gram = frame.tangent().transpose() * frame.tangent();
    EXPECT_LT((gram - Eigen::MatrixXd::Identity(space.dimension, space.dimension)).norm(), 1e-12);
  }
}

TEST(WrenchFeasibleManifold, ASmallStepOnTheTangentSpaceStaysOnItToSecondOrder) {
  constexpr double kStep = 1e-5;
  for (const Space& space : spaces()) {
    const auto manifold = make_wrench_feasible_manifold(space.problem);
    Frame frame;
    Frame moved;
    ASSERT_TRUE(manifold->frame_at(space.at, frame));
    for (int k = 0; k < space.dimension; ++k) {
      TangentVector u = TangentVector::Zero(space.dimension);
      u[k] = kStep;
      Coordinates q;
      ASSERT_TRUE(manifold->project(frame, u, q));
      ASSERT_TRUE(manifold->frame_at(q, moved));
      EXPECT_LT((moved.point() - frame.point() - frame.tangent() * u).norm(), 2e-8) << space.dimension << ", " << k;
    }
  }
}

TEST(WrenchFeasibleManifold, ProjectedPointsLieOnTheConstraints) {
  for (const Space& space : spaces()) {
    if (space.problem.space.constraints.empty()) continue;
    const auto manifold = make_wrench_feasible_manifold(space.problem);
    const ConstraintFunctions constraints(space.problem);
    Frame frame;
    ASSERT_TRUE(manifold->frame_at(space.at, frame));
    Coordinates q;
    ASSERT_TRUE(manifold->project(frame, TangentVector::Constant(space.dimension, 0.1), q));
    ConstraintFunctions::Vector values;
    ConstraintFunctions::Jacobian jacobian;
    constraints.evaluate(q, values, jacobian);
    EXPECT_LT(values.norm(), 1e-12);
    EXPECT_GT((q - space.at).norm(), 0.001);
  }
}

TEST(WrenchFeasibleManifold, CoordinatesALittleOffTheConstraintsNameThePointOnThem) {
  const auto manifold = make_wrench_feasible_manifold(testing::robot2_implicit_sphere(false));
  const Coordinates exact = on_sphere(-2.59, 0.5);
  Coordinates typed = exact;
  typed[0] += 3e-4;
  Frame frame;
  Frame on;
  ASSERT_TRUE(manifold->frame_at(typed, frame));
  EXPECT_EQ(Coordinates(frame.coordinates()), typed);
  Coordinates projected;
  ASSERT_TRUE(manifold->project(frame, TangentVector::Zero(2), projected));
  ASSERT_TRUE(manifold->frame_at(projected, on));
  EXPECT_LT((frame.point() - on.point()).norm(), 1e-12);
}

TEST(WrenchFeasibleManifold, EndsWhereTheConstraintsLoseRank) {
  Problem problem = testing::robot2_implicit_sphere(false);
  problem.space.constraints = {"px^2 + py^2"};  // only the axis, where its derivative vanishes
  Frame frame;
  EXPECT_FALSE(make_wrench_feasible_manifold(problem)->frame_at(on_sphere(0, 0), frame));
}

TEST(WrenchFeasibleManifold, RefusesMoreParametersThanAPoseHas) {
  Problem problem = testing::robot2_sphere();
  for (int j = 0; j < 5; ++j)
    problem.space.parameters.push_back({"t" + std::to_string(j), ParameterKind::kReal, "", ""});
  EXPECT_THROW((void)make_wrench_feasible_manifold(problem), InputError);
}

}  // namespace
}  // namespace taut
