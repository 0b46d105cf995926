// SPDX-License-Identifier: GPL-3.0-or-later
// The problem in numbers: enclosed decimals, the load frame, and the axes of K.
#include "kinematics/model.h"

#include <gtest/gtest.h>

#include <Eigen/Dense>

#include "tests/support/enclosing.h"
#include "tests/support/robots.h"

namespace taut::testing {
namespace {

Problem with_full_ellipsoid() {
  Problem problem = robot1_slice();
  // M M^T for a lower triangular M of integers.
  const int m[6][6] = {{90, 0, 0, 0, 0, 0},    {-20, 110, 0, 0, 0, 0},   {7, 31, 80, 0, 0, 0},
                       {12, -9, 4, 900, 0, 0}, {0, 3, 21, -140, 700, 0}, {-5, 8, 2, 60, 33, 1000}};
  for (std::size_t i = 0; i < 6; ++i) {
    for (std::size_t j = 0; j < 6; ++j) {
      int sum = 0;
      for (std::size_t k = 0; k < 6; ++k) sum += m[i][k] * m[j][k];
      problem.load.ellipsoid.value()[i][j] = std::to_string(sum);
    }
  }
  return problem;
}

TEST(Model, EnclosesEveryDecimalOfTheProblem) {
  const Problem problem = robot1_slice();
  const Model<MpInterval> model = make_model<MpInterval>(problem);
  const PrecisionScope precision(kExactBits);
  const auto exact = [](const DecimalText& text) { return ScalarTraits<BigFloat>::from_decimal(text); };
  for (std::size_t i = 0; i < 6; ++i) {
    for (int axis = 0; axis < 3; ++axis) {
      const auto k = static_cast<std::size_t>(axis);
      const BigFloat b = exact(problem.robot.platform_anchors_m[i][k]);
      EXPECT_TRUE(holds(model.p_WA[i](axis), exact(problem.robot.base_anchors_m[i][k])));
      EXPECT_TRUE(holds(model.p_PB[i](axis), b));
      EXPECT_TRUE(holds(model.p_MB[i](axis), b - exact(problem.load.point_m[k])));
    }
    EXPECT_TRUE(holds(model.tension_lower[i], exact(problem.robot.tension_N[i].lower)));
    EXPECT_TRUE(holds(model.tension_upper[i], exact(problem.robot.tension_N[i].upper)));
    EXPECT_TRUE(holds(model.length_lower[i], exact(problem.robot.length_m[i].lower)));
    EXPECT_TRUE(holds(model.length_upper[i], exact(problem.robot.length_m[i].upper)));
    EXPECT_TRUE(holds(model.wrench(static_cast<int>(i)), exact(problem.load.wrench[i])));
  }
  EXPECT_GT(spread(model.tension_lower[0]), 0.0) << "0.05 is no binary number";
}

TEST(Model, ReadsSiUnits) {
  const Model<double> model = make_model<double>(robot1_slice());
  EXPECT_EQ(model.p_WA[0](1), 0.22);
  EXPECT_EQ(model.p_PB[0](0), -0.1125833);
  EXPECT_EQ(model.length_upper[5], 0.55);
  EXPECT_EQ(model.p_PM(2), -0.021);
  EXPECT_EQ(model.ellipsoid(3, 3), 1e6);
  EXPECT_NEAR(model.characteristic_length, 0.13, 1e-6);
}

TEST(Model, DiagonalEllipsoidsAreKnownAsSuch) {
  EXPECT_TRUE(make_model<double>(robot1_slice()).ellipsoid_is_diagonal);
  EXPECT_FALSE(make_model<double>(with_full_ellipsoid()).ellipsoid_is_diagonal);
}

// K = {w0 + L z : |z| <= 1} with (L z)^T E (L z) = |z|^2.
TEST(Model, RootOfTheEllipsoidMapsTheUnitBallOntoK) {
  for (const Problem& problem : {robot1_slice(), robot2_sphere(), with_full_ellipsoid()}) {
    const Model<double> model = make_model<double>(problem);
    const Matrix6<double>& l = model.ellipsoid_root;
    EXPECT_LT((l.transpose() * model.ellipsoid * l - Matrix6<double>::Identity()).norm(), 1e-11);
    EXPECT_LT((l * l.transpose() * model.ellipsoid - Matrix6<double>::Identity()).norm(), 1e-9);
    for (int i = 0; i < 6; ++i) {
      for (int j = 0; j < i; ++j) EXPECT_EQ(l(i, j), 0.0) << "upper triangular";
    }
  }
}

TEST(Model, RootOfTheEllipsoidIsEnclosed) {
  const Model<MpInterval> model = make_model<MpInterval>(with_full_ellipsoid());
  for (int i = 0; i < 6; ++i) {
    for (int j = 0; j < 6; ++j) {
      MpInterval sum(0.0);
      for (int k = 0; k < 6; ++k) {
        for (int m = 0; m < 6; ++m) {
          sum = sum + model.ellipsoid_root(k, i) * model.ellipsoid(k, m) * model.ellipsoid_root(m, j);
        }
      }
      EXPECT_TRUE(contains(sum, i == j ? 1.0 : 0.0));
      EXPECT_LT(spread(sum), 1e-30);
    }
  }
}

TEST(Model, RefusesAnEllipsoidThatIsNotPositiveDefinite) {
  Problem problem = robot1_slice();
  problem.load.ellipsoid.value()[2][2] = "0";
  EXPECT_THROW((void)make_model<double>(problem), InputError);
  EXPECT_THROW((void)make_model<MpInterval>(problem), InputError);
  problem.load.ellipsoid.value()[2][2] = "1e4";
  problem.load.ellipsoid.value()[2][0] = problem.load.ellipsoid.value()[0][2] = "1e4";  // singular, exactly
  EXPECT_THROW((void)make_model<MpInterval>(problem), InputError);
}

TEST(Model, PoseTapeEvaluatesTheSixExpressions) {
  const Evaluator<double> pose(pose_tape(robot1_slice()));
  const std::array<double, 2> parameters = {0.3, 1.1};
  const Pose<double> q = evaluate_pose(pose, std::span<const double>(parameters));
  EXPECT_EQ(q.p_WP, Vector3<double>(0, 0, 0.35));
  EXPECT_EQ(q.angles[0], 0.3);
  EXPECT_EQ(q.angles[1], 1.1);
  EXPECT_NEAR(q.angles[2], 0.593411945678072, 1e-15);
}

}  // namespace
}  // namespace taut::testing
