// SPDX-License-Identifier: GPL-3.0-or-later
// Tensions at one pose: by hand, by Eigen, and by what they must balance.
#include "kinematics/statics.h"

#include <gtest/gtest.h>

#include <Eigen/Dense>
#include <random>

#include "certify/arithmetic/mp_interval.h"
#include "tests/support/robots.h"

namespace taut::testing {
namespace {

Matrix6<double> random_matrix(std::mt19937_64& random) {
  Matrix6<double> m;
  for (int i = 0; i < 36; ++i) m(i / 6, i % 6) = std::uniform_real_distribution<double>(-1, 1)(random);
  return m;
}

TEST(Invert, GivesInverseAndDeterminant) {
  std::mt19937_64 random(1);
  for (int n = 0; n < 200; ++n) {
    const Matrix6<double> m = random_matrix(random);
    Matrix6<double> inverse;
    double determinant = 0;
    ASSERT_TRUE(invert(m, inverse, determinant));
    ASSERT_NEAR(determinant, m.determinant(), 1e-12);
    ASSERT_LT((m * inverse - Matrix6<double>::Identity()).norm(), 1e-10 / std::abs(determinant));
  }
}

TEST(Invert, FollowsTheSignOfAPermutation) {
  Matrix6<double> m = Matrix6<double>::Zero();
  const int cycle[6] = {1, 2, 3, 4, 5, 0};  // odd
  for (int i = 0; i < 6; ++i) m(i, cycle[i]) = 1;
  Matrix6<double> inverse;
  double determinant = 0;
  ASSERT_TRUE(invert(m, inverse, determinant));
  EXPECT_EQ(determinant, -1.0);
  EXPECT_EQ(inverse, m.transpose());
}

TEST(Invert, RefusesASingularMatrix) {
  Matrix6<double> m = Matrix6<double>::Identity();
  m.row(3) = m.row(2);
  Matrix6<double> inverse;
  double determinant = 0;
  EXPECT_FALSE(invert(m, inverse, determinant));
}

TEST(Invert, RefusesEnclosuresThatHoldASingularMatrix) {
  Matrix6<MpInterval> m, inverse;
  for (int i = 0; i < 6; ++i) {
    for (int j = 0; j < 6; ++j) m(i, j) = MpInterval(i == j ? 1.0 : 0.0);
  }
  MpInterval determinant;
  EXPECT_TRUE(invert(m, inverse, determinant));
  m(4, 4) = MpInterval(-0.1, 2.0);
  EXPECT_FALSE(invert(m, inverse, determinant));
}

/// Cables of length 2 along the axes: x, y, z through the origin, x through (0,1,0), y through (0,0,1), z through
/// (1,0,0).
Model<double> axes_robot() {
  Model<double> model;
  const Vector3<double> ends[6] = {{0, 0, 0}, {0, 0, 0}, {0, 0, 0}, {0, 1, 0}, {0, 0, 1}, {1, 0, 0}};
  model.p_PM.setZero();
  for (int i = 0; i < 6; ++i) {
    const auto n = static_cast<std::size_t>(i);
    model.p_PB[n] = model.p_MB[n] = ends[i];
    model.p_WA[n] = ends[i] - 2 * Vector3<double>::Unit(i % 3);
    model.tension_lower[n] = 1;
    model.tension_upper[n] = 100;
  }
  model.wrench << 50, 60, 70, -10, -20, -30;
  model.has_ellipsoid = true;
  model.ellipsoid_is_diagonal = true;
  model.ellipsoid.setZero();
  model.ellipsoid_root.setZero();
  const double radii[6] = {3, 4, 5, 4, 12, 0.5};
  for (int i = 0; i < 6; ++i) {
    model.ellipsoid(i, i) = 1 / (radii[i] * radii[i]);
    model.ellipsoid_root(i, i) = radii[i];
  }
  return model;
}

// f4 = −Mz, f5 = −Mx, f6 = −My; f1 = Fx + Mz, f2 = Fy + Mx, f3 = Fz + My; v by Pythagoras.
TEST(Statics, OfCablesAlongTheAxesAreAsByHand) {
  const Model<double> model = axes_robot();
  const Statics<double> s = statics(model, Pose<double>{Vector3<double>::Zero(), {0, 0, 0}});
  ASSERT_TRUE(s.regular);
  const double tension[6] = {20, 50, 50, 30, 10, 20};
  const double tension_radius[6] = {std::hypot(3, 0.5), std::hypot(4, 4), 13, 0.5, 4, 12};
  for (std::size_t i = 0; i < 6; ++i) {
    EXPECT_NEAR(s.length[i], 2.0, 1e-15);
    EXPECT_NEAR(s.tension[i], tension[i], 1e-13);
    EXPECT_NEAR(s.tension_above[i], tension_radius[i], 1e-13);
  }
  EXPECT_NEAR(std::abs(s.determinant), 1.0, 1e-15);
  EXPECT_NEAR(wrench_scale_approx(model, s), 19.0 / 12, 1e-13) << "cable 6 down to its lower limit";
}

TEST(Statics, BalanceTheWrenchAndVaryByTheDiagonalOfTheInverseOfB) {
  std::mt19937_64 random(2);
  const auto uniform = [&](double a, double b) { return std::uniform_real_distribution<double>(a, b)(random); };
  Problem full = robot1_slice();
  full.load.ellipsoid.value()[0][1] = full.load.ellipsoid.value()[1][0] = "3000";
  full.load.ellipsoid.value()[2][4] = full.load.ellipsoid.value()[4][2] = "-20000";
  full.load.ellipsoid.value()[3][5] = full.load.ellipsoid.value()[5][3] = "123456";
  for (const Problem& problem : {robot1_slice(), robot2_sphere(), full}) {
    const Model<double> model = make_model<double>(problem);
    for (int n = 0; n < 300; ++n) {
      const Pose<double> q{Vector3<double>(uniform(-0.1, 0.1), uniform(-0.1, 0.1), uniform(0.15, 0.4)),
                           {uniform(-3, 3), uniform(0, 1.5), uniform(-0.8, 0.8)}};
      const Statics<double> s = statics(model, q);
      ASSERT_TRUE(s.regular);
      Matrix6<double> j = cable_geometry(model, q).force_density;
      Vector6<double> f0;
      for (int i = 0; i < 6; ++i) {
        j.col(i) /= s.length[static_cast<std::size_t>(i)];
        f0(i) = s.tension[static_cast<std::size_t>(i)];
      }
      const double condition = j.norm() * j.inverse().norm();
      if (condition > 1e4) continue;
      ASSERT_LT((j * f0 - model.wrench).norm(), 1e-14 * condition * f0.norm());
      ASSERT_NEAR(s.determinant, j.determinant(), 1e-14);
      const Matrix6<double> inverse_of_b = (j.transpose() * model.ellipsoid * j).inverse();
      for (int i = 0; i < 6; ++i) {
        const double v = s.tension_above[static_cast<std::size_t>(i)];
        ASSERT_NEAR(v, std::sqrt(inverse_of_b(i, i)), 1e-6 * v);
      }
    }
  }
}

TEST(Statics, OfASingularPoseAreNotRegularButHaveLengths) {
  Model<double> model = axes_robot();
  model.p_PB[3] = model.p_MB[3] = model.p_PB[0];
  model.p_WA[3] = model.p_WA[0];
  const Statics<double> s = statics(model, Pose<double>{Vector3<double>::Zero(), {0, 0, 0}});
  EXPECT_FALSE(s.regular);
  EXPECT_NEAR(s.length[3], 2.0, 1e-15);
  EXPECT_LT(wrench_scale_approx(model, s), -1e300);
}

}  // namespace
}  // namespace taut::testing
