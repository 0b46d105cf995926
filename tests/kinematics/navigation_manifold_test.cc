// SPDX-License-Identifier: GPL-3.0-or-later
// The navigation manifold: x(q) satisfies F, dx/dq lies in the kernel of dF.
#include "kinematics/navigation_manifold.h"

#include <gtest/gtest.h>

#include <Eigen/Dense>

#include "tests/support/enclosing.h"
#include "tests/support/robots.h"

namespace taut::testing {
namespace {

using Layout = NavigationLayout;
constexpr mpfr_prec_t kBits = 200;

std::array<double, 6> random_pose(Operands& operands) {
  return {operands.uniform(-0.1, 0.1), operands.uniform(-0.1, 0.1), operands.uniform(0.15, 0.4),
          operands.uniform(-3, 3),     operands.uniform(-0.1, 1.5), operands.uniform(-0.8, 0.8)};
}

template <class S>
Pose<S> pose(const std::array<double, 6>& q) {
  return {Vector3<S>(S(q[0]), S(q[1]), S(q[2])), {S(q[3]), S(q[4]), S(q[5])}};
}

Problem with_skewed_ellipsoid() {
  Problem problem = robot1_slice();
  problem.load.ellipsoid.value()[0][1] = problem.load.ellipsoid.value()[1][0] = "3000";
  problem.load.ellipsoid.value()[2][4] = problem.load.ellipsoid.value()[4][2] = "-20000";
  problem.load.ellipsoid.value()[3][5] = problem.load.ellipsoid.value()[5][3] = "123456";
  return problem;
}

std::vector<Problem> problems() { return {robot1_slice(), robot2_sphere(), with_skewed_ellipsoid()}; }

/// The largest |x| of a group relative to its own unit is near 1 (but for slacks), so absolute bounds do at 200 bits.
double largest(const Eigen::Matrix<BigFloat, kNavigationEquations, 1>& f) {
  double result = 0;
  for (int i = 0; i < kNavigationEquations; ++i) result = std::max(result, abs(f(i)).to_double());
  return result;
}

TEST(NavigationManifold, ResidualVanishesOnItAndNowhereNear) {
  const PrecisionScope precision(kBits);
  Operands operands(1);
  for (const Problem& problem : problems()) {
    const Model<BigFloat> model = make_model<BigFloat>(problem);
    for (int n = 0; n < 40; ++n) {
      NavigationTangent<BigFloat> x;
      ASSERT_TRUE(navigation_tangent(model, pose<BigFloat>(random_pose(operands)), x));
      ASSERT_LT(largest(navigation_residual(model, x.point)), 1e-35);
      // F depends on every variable: none can be moved alone.
      for (int k = 0; k < kNavigationVariables && n == 0; ++k) {
        NavigationPoint<BigFloat> moved = x.point;
        moved(k) += BigFloat(1e-3);
        ASSERT_GT(largest(navigation_residual(model, moved)), 1e-9) << "variable " << k;
      }
    }
  }
}

TEST(NavigationManifold, ResidualIsSmallInFloatingPoint) {
  Operands operands(2);
  for (const Problem& problem : problems()) {
    const Model<double> model = make_model<double>(problem);
    for (int n = 0; n < 10'000 / 3; ++n) {
      NavigationTangent<double> x;
      const std::array<double, 6> q = random_pose(operands);
      ASSERT_TRUE(navigation_tangent(model, pose<double>(q), x));
      const Statics<double> s = statics(model, pose<double>(q));
      if (std::abs(s.determinant) < 1e-4) continue;  // ill-conditioned; 200 bits look after those
      const auto f = navigation_residual(model, x.point);
      const double slack = x.point.tail<18>().cwiseAbs().maxCoeff();
      const double tension = x.point.segment<6>(Layout::kTensions).cwiseAbs().maxCoeff();
      const double b_scale =
          model.ellipsoid.cwiseAbs().maxCoeff() * x.point.segment<36>(Layout::kVariations).cwiseAbs().maxCoeff();
      ASSERT_LT(f.head<24>().cwiseAbs().maxCoeff(), 1e-15);                                // (1), (2)
      ASSERT_LT(f.segment<6>(24).cwiseAbs().maxCoeff(), 1e-11 * (1 + tension));            // (4)
      ASSERT_LT(f.segment<36>(30).cwiseAbs().maxCoeff(), 1e-9 * (1 + b_scale));            // (5), (6)
      ASSERT_LT(f.tail<18>().cwiseAbs().maxCoeff(), 1e-11 * (1 + slack) * (1 + tension));  // (10)–(12)
    }
  }
}

TEST(NavigationManifold, TangentIsInTheKernelOfTheResidualsDerivative) {
  const PrecisionScope precision(kBits);
  Operands operands(3);
  const BigFloat h(0x1p-60);
  for (const Problem& problem : problems()) {
    const Model<BigFloat> model = make_model<BigFloat>(problem);
    for (int n = 0; n < 5; ++n) {
      NavigationTangent<BigFloat> x;
      ASSERT_TRUE(navigation_tangent(model, pose<BigFloat>(random_pose(operands)), x));
      for (int k = 0; k < 6; ++k) {
        NavigationPoint<BigFloat> ahead = x.point, behind = x.point;
        double size = 1;
        for (int i = 0; i < kNavigationVariables; ++i) {
          ahead(i) += h * x.tangent(i, k);
          behind(i) -= h * x.tangent(i, k);
          size = std::max(size, abs(x.tangent(i, k)).to_double());
        }
        const auto f_ahead = navigation_residual(model, ahead);
        const auto f_behind = navigation_residual(model, behind);
        for (int i = 0; i < kNavigationEquations; ++i) {
          const double slope = ((f_ahead(i) - f_behind(i)) / (h + h)).to_double();
          // The third derivative times h^2 remains, 1e-36 in size; F is of fourth degree at most in B, E 1e6.
          ASSERT_LT(std::abs(slope), 1e-26 * std::pow(size, 4)) << "equation " << i << ", direction " << k;
        }
      }
    }
  }
}

TEST(NavigationManifold, TangentIsTheDerivativeOfThePoint) {
  const PrecisionScope precision(kBits);
  Operands operands(4);
  for (const Problem& problem : problems()) {
    const Model<BigFloat> model = make_model<BigFloat>(problem);
    for (int n = 0; n < 5; ++n) {
      const std::array<double, 6> q = random_pose(operands);
      NavigationTangent<BigFloat> x;
      ASSERT_TRUE(navigation_tangent(model, pose<BigFloat>(q), x));
      for (std::size_t k = 0; k < 6; ++k) {
        const BigFloat h(0x1p-60);
        const auto moved = [&](const BigFloat& by) {
          Pose<BigFloat> p = pose<BigFloat>(q);
          BigFloat* const coordinates[] = {&p.p_WP(0),   &p.p_WP(1),   &p.p_WP(2),
                                           &p.angles[0], &p.angles[1], &p.angles[2]};
          *coordinates[k] += by;
          NavigationTangent<BigFloat> result;
          EXPECT_TRUE(navigation_tangent(model, p, result));
          return result.point;
        };
        const NavigationPoint<BigFloat> ahead = moved(h), behind = moved(-h);
        for (int i = 0; i < kNavigationVariables; ++i) {
          const BigFloat slope = (ahead(i) - behind(i)) / (h + h);
          const BigFloat& expected = x.tangent(i, static_cast<int>(k));
          ASSERT_TRUE(abs(slope - expected) <= BigFloat(1e-20) * (BigFloat(1.0) + abs(expected)))
              << "variable " << i << ", direction " << k << ": " << digits(slope) << " " << digits(expected);
        }
      }
    }
  }
}

// v_i^T B v_i = 1, (row j of B) v_i = 0, v_ii as statics has it; B from Eigen.
TEST(NavigationManifold, VariationsAreTheExtremesOfTheTensionEllipsoid) {
  Operands operands(5);
  for (const Problem& problem : problems()) {
    const Model<double> model = make_model<double>(problem);
    for (int n = 0; n < 200; ++n) {
      const Pose<double> q = pose<double>(random_pose(operands));
      const Statics<double> s = statics(model, q);
      if (std::abs(s.determinant) < 1e-3) continue;
      NavigationTangent<double> x;
      ASSERT_TRUE(navigation_tangent(model, q, x));
      Matrix6<double> j = cable_geometry(model, q).force_density;
      for (int i = 0; i < 6; ++i) j.col(i) /= s.length[static_cast<std::size_t>(i)];
      const Matrix6<double> b = j.transpose() * model.ellipsoid * j;
      for (int i = 0; i < 6; ++i) {
        const Vector6<double> v = x.point.segment<6>(Layout::kVariations + 6 * i);
        const Vector6<double> bv = b * v;
        ASSERT_NEAR(v.dot(bv), 1.0, 1e-8);
        for (int k = 0; k < 6; ++k) {
          if (k == i) continue;
          ASSERT_NEAR(bv(k) * v(i), 0.0, 1e-8);
        }
        ASSERT_NEAR(v(i), s.tension_above[static_cast<std::size_t>(i)], 1e-12);
      }
    }
  }
}

TEST(NavigationManifold, SlacksAreOneAtMidRange) {
  Model<double> model = make_model<double>(robot1_slice());
  const Pose<double> q = pose<double>({0, 0, 0.35, 1.7, 1.2, 0.6});
  const Statics<double> s = statics(model, q);
  for (std::size_t i = 0; i < 6; ++i) {
    model.length_lower[i] = s.length[i] - 0.1;
    model.length_upper[i] = s.length[i] + 0.1;
    model.tension_lower[i] = s.tension[i] - s.tension_above[i] - 0.5;
    model.tension_upper[i] = s.tension[i] - s.tension_above[i] + 0.5;
  }
  NavigationTangent<double> x;
  ASSERT_TRUE(navigation_tangent(model, q, x));
  for (int i = 0; i < 6; ++i) {
    EXPECT_NEAR(x.point(Layout::kLengthSlack + i), 1.0, 1e-12);
    EXPECT_NEAR(x.point(Layout::kLowSlack + i), 1.0, 1e-12);
    EXPECT_NEAR(x.point(Layout::kHighSlack + i), 0.5 / (0.5 - 2 * s.tension_above[static_cast<std::size_t>(i)]), 1e-10);
  }
}

TEST(NavigationManifold, ResidualEnclosuresHoldZero) {
  Operands operands(6);
  for (const Problem& problem : problems()) {
    const Model<MpInterval> model = make_model<MpInterval>(problem);
    for (int n = 0; n < 5; ++n) {
      Faults<MpInterval>::clear();
      NavigationTangent<MpInterval> x;
      ASSERT_TRUE(navigation_tangent(model, pose<MpInterval>(random_pose(operands)), x));
      const auto f = navigation_residual(model, x.point);
      ASSERT_FALSE(Faults<MpInterval>::raised());
      for (int i = 0; i < kNavigationEquations; ++i) {
        ASSERT_TRUE(contains(f(i), 0.0)) << "equation " << i << " " << print(f(i));
        ASSERT_LT(spread(f(i)), 1e-18) << "equation " << i;
      }
    }
  }
}

TEST(NavigationManifold, HasNoPointOverASingularPose) {
  Model<double> model = make_model<double>(robot1_slice());
  model.p_PB[1] = model.p_PB[0];
  model.p_MB[1] = model.p_MB[0];
  model.p_WA[1] = model.p_WA[0];
  NavigationTangent<double> x;
  EXPECT_FALSE(navigation_tangent(model, pose<double>({0, 0, 0.35, 0, 0, 0.6}), x));
}

}  // namespace
}  // namespace taut::testing
