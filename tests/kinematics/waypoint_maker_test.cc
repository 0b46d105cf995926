// SPDX-License-Identifier: GPL-3.0-or-later
#include "path_io/waypoint_maker.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <random>
#include <sstream>

#include "kinematics/geometry.h"
#include "tests/support/robots.h"

namespace taut {
namespace {

using ::testing::HasSubstr;
using ::testing::ThrowsMessage;

Matrix3<double> rotation_of(const TiltAndTorsion& angles) {
  return rotation<double>(angles.value(0), angles.value(1), angles.value(2));
}

class RandomPoses {
 public:
  double uniform(double low, double high) { return std::uniform_real_distribution<double>(low, high)(random_); }
  TiltedPose pose() {
    return {Vector3<double>(uniform(-1, 1), uniform(-1, 1), uniform(-1, 1)), uniform(-7, 7), uniform(-4, 4),
            uniform(-7, 7)};
  }

 private:
  std::mt19937_64 random_{3};
};

TEST(PoseConversion, QuaternionsAreTheRotationOfTheAngles) {
  RandomPoses random;
  for (int trial = 0; trial < 1000; ++trial) {
    const TiltedPose pose = random.pose();
    const Matrix3<double> expected = rotation(pose.phi, pose.theta, pose.sigma);
    EXPECT_LT((rigid_pose(pose).q.toRotationMatrix() - expected).norm(), 1e-14);
  }
}

TEST(PoseConversion, AnglesAreThoseOfTheQuaternionNextToThePrevious) {
  RandomPoses random;
  for (int trial = 0; trial < 1000; ++trial) {
    const TiltedPose pose = random.pose();
    const Eigen::Quaterniond q = rigid_pose(pose).q;
    const TiltAndTorsion alone = tilt_and_torsion(q, std::nullopt);
    EXPECT_LT((rotation_of(alone) - q.toRotationMatrix()).norm(), 1e-14);
    EXPECT_GE(alone.x[1], 0);
    const TiltAndTorsion near{
        {pose.phi + random.uniform(-0.1, 0.1), pose.theta + random.uniform(-0.1, 0.1), pose.sigma}, {}};
    const TiltAndTorsion found = tilt_and_torsion(q, near);
    EXPECT_LT((rotation_of(found) - q.toRotationMatrix()).norm(), 1e-13);
    if (std::abs(pose.theta) > M_PI - 0.2) continue;  // another wrap of theta, which never passes a half turn
    EXPECT_NEAR(found.value(0), pose.phi, 1e-11);
    EXPECT_NEAR(found.value(1), pose.theta, 1e-11);
    EXPECT_NEAR(found.value(2), pose.sigma, 1e-11);
  }
}

TEST(PoseConversion, AnglesThatDoNotMatterStay) {
  const TiltAndTorsion before{{1.0, 0.1, 0.3}, {2, 0, 4}};
  const TiltAndTorsion upright = tilt_and_torsion(Eigen::Quaterniond(1, 0, 0, 0), before);
  EXPECT_NEAR(upright.value(0), before.value(0), 1e-14);
  EXPECT_EQ(upright.x[1], 0);
  EXPECT_NEAR(upright.value(2), 4 * M_PI, 1e-14);
  const TiltAndTorsion upside_down = tilt_and_torsion(Eigen::Quaterniond(0, 1, 0, 0), before);
  EXPECT_NEAR(upside_down.value(2), before.value(2), 1e-14);
  EXPECT_LT((rotation_of(upside_down) - Eigen::Quaterniond(0, 1, 0, 0).toRotationMatrix()).norm(), 1e-14);
}

TEST(PoseConversion, LengthsLeadToThePoseTheyCameFrom) {
  const Problem problem = testing::robot1_slice();
  const PoseSampler sampler(problem);
  for (double theta = 0; theta < 0.6; theta += 0.1) {
    const RigidPose start = rigid_pose({Vector3<double>(0, 0, 0.35), 0.3, 0.2, 0.5});
    const RigidPose goal = rigid_pose({Vector3<double>(0.01, -0.02, 0.33), 0.3 + theta, 0.2, 0.5 + theta / 3});
    const auto found = pose_of_lengths(sampler.model(), cable_lengths(sampler.model(), goal), start);
    ASSERT_TRUE(found);
    EXPECT_LT((found->p - goal.p).norm(), 1e-10);
    EXPECT_GT(std::abs(found->q.dot(goal.q)), 1 - 1e-12);
  }
  EXPECT_FALSE(pose_of_lengths(sampler.model(), {0.3, 0.3, 9, 0.3, 0.3, 0.3},
                               rigid_pose({Vector3<double>(0, 0, 0.35), 0.3, 0.2, 0.5})));
}

struct Way {
  RigidPose start;
  std::array<double, kCables> lengths;
};

TEST(PoseConversion, LengthsLeadPastASingularPose) {
  const PoseSampler sampler(testing::robot1_slice());
  const Way ways[] = {{rigid_pose({Vector3<double>(0.04721, 0.00233, 0.3), -2.02239, 0.13456, 0.79145}),
                       {0.2985, 0.41256, 0.49969, 0.31206, 0.44673, 0.34441}},
                      {rigid_pose({Vector3<double>(0.02842, -0.02128, 0.4), 1.23635, 0.48762, 0.49451}),
                       {0.57464, 0.36149, 0.42669, 0.36844, 0.38736, 0.4744}}};
  for (const Way& way : ways) {
    const auto found = pose_of_lengths(sampler.model(), way.lengths, way.start);
    ASSERT_TRUE(found);
    const std::array<double, kCables> reached = cable_lengths(sampler.model(), *found);
    for (std::size_t i = 0; i < kCables; ++i) EXPECT_NEAR(reached[i], way.lengths[i], 1e-13);
  }
}

TEST(PoseConversion, LengthsDoNotLeadAcrossASingularPose) {
  // Newton's method, in too long steps, finds a pose beyond.
  const PoseSampler sampler(testing::robot1_slice());
  const Way ways[] = {{rigid_pose({Vector3<double>(-0.0294, -0.03603, 0.35), 1.71062, 0.49847, 0.7952}),
                       {0.478, 0.28332, 0.47342, 0.38539, 0.30109, 0.38757}},
                      {rigid_pose({Vector3<double>(-0.03466, -0.03374, 0.35), -1.90163, 0.37874, 0.34026}),
                       {0.58478, 0.43428, 0.24824, 0.45888, 0.28684, 0.20849}},
                      {rigid_pose({Vector3<double>(-0.02888, -0.00957, 0.3), 1.11026, 0.41375, 0.26672}),
                       {0.32653, 0.20178, 0.42012, 0.26287, 0.25275, 0.4127}}};
  for (const Way& way : ways) EXPECT_FALSE(pose_of_lengths(sampler.model(), way.lengths, way.start));
}

// --- Waypoints -------------------------------------------------------------------------------------------------------

std::vector<Waypoint> waypoints(const std::string& text, std::optional<Interpolation> law, const Problem& problem) {
  PathFile file(std::make_unique<std::istringstream>(text), "p.txt", problem.space);
  WaypointMaker maker(problem, file.header(), law.value_or(usual_law(file.header())), "p.txt");
  std::vector<Waypoint> result;
  for (PathRow row; file.next(row);) result.push_back(maker.next(row, file.start()));
  return result;
}

const std::string kAngleRows =
    "px[m],py[m],pz[m],phi[rad],theta[rad],sigma[rad]\n0,0,0.35,3,0.2,0.5\n0,0,0.35,3.2,0.2,0.5\n0,0,0.35,3.2,0.1,0."
    "7\n";

TEST(WaypointMaker, KeepsNumbersThatAreTheLawsOwn) {
  const Problem problem = testing::robot1_slice();
  EXPECT_EQ(waypoints("phi[rad],theta[rad]\n0.1,0.7\n", {}, problem), (std::vector<Waypoint>{{{0.1, 0.7}, {0, 0}}}));
  EXPECT_EQ(waypoints("0 0 0 0.35 0 0 0.6 -0.8\n", {}, problem),
            std::vector<Waypoint>{PosePoint({{0, 0, 0.35, 0, 0, 0.6, -0.8}})});
  EXPECT_EQ(waypoints("px[m],py[m],pz[m],phi[rad],theta[rad],sigma[rad]\n0,0,0.35,3,-0.2,0.5\n", {}, problem),
            (std::vector<Waypoint>{{{0, 0, 0.35, 3, -0.2, 0.5}, {0, 0, 0, 0, 0, 0}}}));
}

TEST(WaypointMaker, SaysWhatProblemIsAudited) {
  const Problem problem = testing::robot1_slice();
  PathHeader header;
  const WaypointMaker own(problem, header, Interpolation::kStraight, "p");
  EXPECT_TRUE(own.problem().query.empty());
  EXPECT_EQ(own.problem().space.parameters.size(), 2u);
  EXPECT_FALSE(own.is_converted());
  const WaypointMaker geodesic(problem, header, Interpolation::kGeodesic, "p");
  EXPECT_EQ(geodesic.problem().space.parameters.size(), 6u);
  EXPECT_TRUE(geodesic.is_converted());
}

TEST(WaypointMaker, ConvertsThereAndBack) {
  const Problem problem = testing::robot1_slice();
  const std::vector<Waypoint> angles = waypoints(kAngleRows, {}, problem);
  const std::vector<Waypoint> geodesic = waypoints(kAngleRows, Interpolation::kGeodesic, problem);
  std::string text = "px[m],py[m],pz[m],qx,qy,qz,qw\n";
  for (const Waypoint& w : geodesic) {
    for (std::size_t j = 0; j < 7; ++j) {
      char number[40];
      std::snprintf(number, sizeof number, "%s%.17g", j == 0 ? "" : ",", w.pose()[j]);
      text += number;
    }
    text += "\n";
  }
  const std::vector<Waypoint> back = waypoints(text, Interpolation::kStraight, problem);
  ASSERT_EQ(back.size(), angles.size());
  for (std::size_t k = 0; k < back.size(); ++k) {
    for (std::size_t j = 0; j < 6; ++j)
      EXPECT_NEAR(back[k].parameters().x[j] + M_PI * back[k].parameters().half_turns[j], angles[k].parameters().x[j],
                  1e-13);
  }
  EXPECT_NE(back[1].parameters().half_turns[3], 0) << "3.2 is a turn beyond the principal value";
}

TEST(WaypointMaker, FindsThePoseOfLengthsRowByRow) {
  const Problem problem = testing::robot1_slice();
  const std::vector<Waypoint> commanded = waypoints(kAngleRows, Interpolation::kCableLengths, problem);
  std::string text = "px[m],py[m],pz[m],phi[rad],theta[rad],sigma[rad],l1[m],l2[m],l3[m],l4[m],l5[m],l6[m]\n";
  for (const Waypoint& w : commanded) {
    text += text.ends_with("l6[m]\n") ? "0,0,0.35,3,0.2,0.5" : ",,,,,";
    for (const double length : w.lengths_m()) {
      char number[40];
      std::snprintf(number, sizeof number, ",%.17g", length);
      text += number;
    }
    text += "\n";
  }
  const std::vector<Waypoint> found = waypoints(text, {}, problem);
  for (std::size_t k = 0; k < found.size(); ++k) {
    for (std::size_t j = 0; j < 7; ++j) EXPECT_NEAR(found[k].pose()[j], commanded[k].pose()[j], 1e-11);
    EXPECT_EQ(found[k].lengths_m(), commanded[k].lengths_m());
  }
}

TEST(WaypointMaker, LengthsWithoutAPoseAreLost) {
  Problem problem = testing::robot1_slice();
  const std::string text = "l1[m],l2[m],l3[m],l4[m],l5[m],l6[m]\n0.3,0.3,0.3,0.3,0.3,0.3\n0.3,0.3,9,0.3,0.3,0.3\n";
  PathFile file(std::make_unique<std::istringstream>(text), "p.txt", problem.space);
  WaypointMaker maker(problem, file.header(), Interpolation::kCableLengths, "p.txt");
  for (PathRow row; file.next(row);) EXPECT_TRUE(have_lengths(maker.next(row, file.start())));
  EXPECT_TRUE(maker.lost_line());
  EXPECT_GT(maker.start_error_m(), 0.01);
  problem.query.clear();
  EXPECT_THAT([&] { WaypointMaker(problem, file.header(), Interpolation::kCableLengths, "p.txt"); },
              ThrowsMessage<InputError>(HasSubstr("p.txt: got cable lengths and no pose")));
  EXPECT_THAT([&] { WaypointMaker(problem, file.header(), Interpolation::kGeodesic, "p.txt"); },
              ThrowsMessage<InputError>(HasSubstr("expected the law cable-lengths")));
}

TEST(WaypointMaker, ControlPointsAreASplines) {
  const Problem problem = testing::robot1_slice();
  PathHeader header;
  header.format = PathFormat::kTautControlPoints;
  EXPECT_EQ(usual_law(header), Interpolation::kCubicBSpline);
  EXPECT_THROW(WaypointMaker(problem, header, Interpolation::kStraight, "p"), InputError);
  EXPECT_THROW(WaypointMaker(problem, PathHeader{}, Interpolation::kCubicBSpline, "p"), InputError);
}

}  // namespace
}  // namespace taut
