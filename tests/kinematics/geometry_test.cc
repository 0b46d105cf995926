// SPDX-License-Identifier: GPL-3.0-or-later
// Rotations, cable vectors and the force-density matrix.
#include "kinematics/geometry.h"

#include <gtest/gtest.h>

#include <Eigen/Dense>
#include <numbers>
#include <random>

#include "kinematics/pose_conversion.h"
#include "tests/support/robots.h"

namespace taut::testing {
namespace {

Pose<double> random_pose(std::mt19937_64& random) {
  const auto uniform = [&](double a, double b) { return std::uniform_real_distribution<double>(a, b)(random); };
  return {Vector3<double>(uniform(-0.12, 0.12), uniform(-0.12, 0.12), uniform(0.12, 0.42)),
          {uniform(-4, 4), uniform(-2, 2), uniform(-2, 2)}};
}

TEST(Rotation, IsAProductOfThreeTurns) {
  std::mt19937_64 random(1);
  for (int n = 0; n < 1000; ++n) {
    const Pose<double> q = random_pose(random);
    using Turn = Eigen::AngleAxisd;
    const Eigen::Vector3d y = Eigen::Vector3d::UnitY(), z = Eigen::Vector3d::UnitZ();
    const Eigen::Matrix3d expected =
        (Turn(q.angles[0], z) * Turn(q.angles[1], y) * Turn(q.angles[2] - q.angles[0], z)).toRotationMatrix();
    ASSERT_LT((rotation(q.angles[0], q.angles[1], q.angles[2]) - expected).norm(), 1e-14);
  }
}

TEST(Rotation, IsOrthonormalAndProper) {
  std::mt19937_64 random(2);
  for (int n = 0; n < 1000; ++n) {
    const Pose<double> q = random_pose(random);
    const Eigen::Matrix3d r = rotation(q.angles[0], q.angles[1], q.angles[2]);
    ASSERT_LT((r * r.transpose() - Eigen::Matrix3d::Identity()).norm(), 1e-14);
    ASSERT_NEAR(r.determinant(), 1.0, 1e-14);
  }
}

TEST(Rotation, IsTheSameForTheFlippedAngles) {
  std::mt19937_64 random(3);
  for (int n = 0; n < 1000; ++n) {
    const Pose<double> q = random_pose(random);
    const Eigen::Matrix3d flipped = rotation(q.angles[0] + std::numbers::pi, -q.angles[1], q.angles[2]);
    ASSERT_LT((rotation(q.angles[0], q.angles[1], q.angles[2]) - flipped).norm(), 1e-14);
  }
}

TEST(Rotation, IsAProductOfTurnsAboutTheAxesOfItsAngles) {
  std::mt19937_64 random(5);
  using Turn = Eigen::AngleAxisd;
  const Eigen::Vector3d x = Eigen::Vector3d::UnitX(), y = Eigen::Vector3d::UnitY(), z = Eigen::Vector3d::UnitZ();
  const auto is_same = [](const AnglesText& text, const Pose<double>& q, const Eigen::Quaterniond& expected) {
    const Angles<double> angles = make_angles<double>(text);
    const Matrix3<double> r_WP = rotation(angles, q.angles);
    const RigidPose pose = rigid_pose(angles, q);
    return (r_WP - expected.toRotationMatrix()).norm() < 1e-14 && pose.p == q.p_WP &&
           (r_WP - pose.q.toRotationMatrix()).norm() < 1e-14;
  };
  for (int n = 0; n < 300; ++n) {
    const Pose<double> q = random_pose(random);
    const auto& [a, b, c] = q.angles;
    EXPECT_TRUE(is_same({}, q, Turn(a, z) * Turn(b, y) * Turn(c - a, z)));
    EXPECT_TRUE(is_same({AngleKind::kRollPitchYaw}, q, Turn(c, z) * Turn(b, y) * Turn(a, x)));
    EXPECT_TRUE(is_same({AngleKind::kZyz}, q, Turn(a, z) * Turn(b, y) * Turn(c, z)));
    const Eigen::Vector3d axis(3, -4, 12);
    EXPECT_TRUE(is_same({AngleKind::kAxis, {"0.3", "-0.4", "1.2"}}, q, Eigen::Quaterniond(Turn(a, axis / 13))));
  }
}

TEST(Rotation, OfAPoseWithOtherAnglesIsThatOfTheSamePlatform) {
  // The same level pose, turned by 34 degrees about the vertical, in four parametrisations.
  const double turn = 34 * std::numbers::pi / 180;
  const std::pair<AnglesText, std::array<double, 3>> poses[] = {{{}, {0.9, 0, turn}},
                                                                {{AngleKind::kRollPitchYaw}, {0, 0, turn}},
                                                                {{AngleKind::kZyz}, {0.3, 0, turn - 0.3}},
                                                                {{AngleKind::kAxis}, {turn, 0, 0}}};
  const Eigen::Matrix3d expected = Eigen::AngleAxisd(turn, Eigen::Vector3d::UnitZ()).toRotationMatrix();
  for (const auto& [text, x] : poses) {
    EXPECT_LT((rotation(make_angles<double>(text), x) - expected).norm(), 1e-15) << name(text.kind);
  }
}

TEST(Rotation, WithoutTiltIsTorsionWhateverItsDirection) {
  const Eigen::Matrix3d expected = Eigen::AngleAxisd(0.4, Eigen::Vector3d::UnitZ()).toRotationMatrix();
  for (const double phi : {-2.0, 0.0, 1.5}) EXPECT_LT((rotation(phi, 0.0, 0.4) - expected).norm(), 1e-15);
}

TEST(Geometry, CableVectorsRunFromBaseToPlatform) {
  const Model<double> model = make_model<double>(robot1_slice());
  const Pose<double> untilted{Vector3<double>(0.01, 0.02, 0.35), {0.7, 0.0, 0.0}};
  const CableGeometry<double> g = cable_geometry(model, untilted);
  for (std::size_t i = 0; i < kCables; ++i) {
    const Eigen::Vector3d expected = untilted.p_WP + model.p_PB[i] - model.p_WA[i];
    EXPECT_LT((g.p_AB_W[i] - expected).norm(), 1e-15);
  }
  EXPECT_NEAR(length(Vector3<double>(3, 4, 12)), 13.0, 1e-15);
}

// D diag(1/d) is J about P_m; J about O is J about P_m, carried by a transform of determinant 1.
TEST(Geometry, ForceDensitiesOverLengthsAreTheForceJacobian) {
  std::mt19937_64 random(4);
  for (const Problem& problem : {robot1_slice(), robot2_sphere()}) {
    const Model<double> model = make_model<double>(problem);
    for (int n = 0; n < 200; ++n) {
      const Pose<double> q = random_pose(random);
      const CableGeometry<double> g = cable_geometry(model, q);
      const Eigen::Matrix3d r = rotation(q.angles[0], q.angles[1], q.angles[2]);
      const Eigen::Vector3d load_point = q.p_WP + r * model.p_PM;
      Matrix6<double> about_load, about_origin, scaled = g.force_density;
      Matrix6<double> transform = Matrix6<double>::Identity();
      for (int i = 0; i < kCables; ++i) {
        const auto k = static_cast<std::size_t>(i);
        const Eigen::Vector3d u = g.p_AB_W[k].normalized();
        about_load.col(i) << u, (r * (model.p_PB[k] - model.p_PM)).cross(u);
        about_origin.col(i) << u, model.p_WA[k].cross(u);
        scaled.col(i) /= length(g.p_AB_W[k]);
      }
      transform.block<3, 3>(3, 0) << 0, -load_point(2), load_point(1), load_point(2), 0, -load_point(0), -load_point(1),
          load_point(0), 0;
      ASSERT_LT((scaled - about_load).norm(), 1e-14);
      ASSERT_LT((transform * about_load - about_origin).norm(), 1e-14);
      ASSERT_NEAR(about_load.determinant(), about_origin.determinant(), 1e-14);
    }
  }
}

}  // namespace
}  // namespace taut::testing
