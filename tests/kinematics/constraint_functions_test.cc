// SPDX-License-Identifier: GPL-3.0-or-later
#include "kinematics/constraint_functions.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "base/input_error.h"
#include "case/case_file.h"

namespace taut {
namespace {

using ::testing::AllOf;
using ::testing::HasSubstr;
using ::testing::ThrowsMessage;

using Values = ConstraintFunctions::Vector;
using Jacobian = ConstraintFunctions::Jacobian;

/// A case in mm, with px, py, pz free, these constraints, and this first waypoint.
std::string text(const std::string& constraints, const std::string& waypoint) {
  return "taut: 1\nname: test\nunits: {length: mm}\n"
         "robot:\n"
         "  base_anchors: [[0, 220, 0], [0, 220, 0], [-190, -110, 0], [-190, -110, 0], [190, -110, 0], [190, -110, "
         "0]]\n"
         "  platform_anchors: [[0, 100, 0], [100, 0, 0], [0, -100, 0], [-100, 0, 0], [60, 80, 0], [80, 60, 0]]\n"
         "  tension: [0.05, 0.5]\n  length: [100, 550]\n"
         "load: {wrench: [0, 0, 1, 0, 0, 0], ellipsoid: {diagonal: [1, 1, 1, 1, 1, 1]}}\n"
         "space: {slice: {phi: 0, theta: 0, sigma: 0}, implicit: [" +
         constraints + "]}\nquery: {waypoints: [" + waypoint + ", {px: 0, py: 0, pz: 130}]}\n";
}

Case parse(const std::string& constraints, const std::string& waypoint = "{px: 0, py: 0, pz: 130}") {
  return parse_case(text(constraints, waypoint), "test.yaml",
                    [](const Case& read) { require_query_on_constraints(read.problem, read.units.length); });
}

const std::string kSphere = "px^2 + py^2 + pz^2 - 130^2";

TEST(ConstraintFunctions, EvaluateValuesAndDerivativesInSi) {
  const ConstraintFunctions c(parse(kSphere).problem);
  Values values;
  Jacobian jacobian;
  c.evaluate(Values(Eigen::Vector3d(0.13, 0, 0.1)), values, jacobian);
  EXPECT_NEAR(values[0], 1e4, 1e-8);
  EXPECT_NEAR(jacobian(0, 0), 2e6 * 0.13, 1e-6);
  EXPECT_NEAR(jacobian(0, 2), 2e6 * 0.1, 1e-6);
}

TEST(ConstraintFunctions, NormalsAreOrthonormalAndSpanTheRowsWhateverTheUnits) {
  Jacobian jacobian(2, 4);
  jacobian << 1, 2, 3, 4, 1e6, 0, -2e6, 1e5;
  const Eigen::Matrix<double, 2, 4> c = jacobian;
  const Eigen::Matrix<double, 4, 2> n = ConstraintFunctions::normals(jacobian);
  EXPECT_LT((n.transpose() * n - Eigen::Matrix2d::Identity()).norm(), 1e-14);
  EXPECT_LT((c - c * n * n.transpose()).norm(), 1e-8);
}

TEST(ConstraintFunctions, RankDoesNotDependOnUnits) {
  Jacobian jacobian(2, 3);
  jacobian << 1e-9, 0, 0, 0, 1e9, 0;
  EXPECT_EQ(ConstraintFunctions::rank(jacobian), 2);
  jacobian << 1, 2, 3, 1e9, 2e9, 3e9;
  EXPECT_EQ(ConstraintFunctions::rank(jacobian), 1);
  jacobian << 1, 2, 3, 0, 0, 0;
  EXPECT_EQ(ConstraintFunctions::rank(jacobian), 1);
  jacobian << 1, 2, 3, 0, NAN, 0;
  EXPECT_EQ(ConstraintFunctions::rank(jacobian), 0);
}

TEST(ConstraintFunctions, NearestLiesOnTheConstraintsAlongTheNormals) {
  const ConstraintFunctions c(parse(kSphere).problem);
  const auto reached = c.nearest(Values(Eigen::Vector3d(0.03, 0.04, 0.12) * 1.02));
  ASSERT_TRUE(reached);
  EXPECT_LT((*reached - Values(Eigen::Vector3d(0.03, 0.04, 0.12))).norm(), 1e-14);
  EXPECT_FALSE(c.nearest(Values(Eigen::Vector3d(0, 0, 0)))) << "the derivative vanishes at the centre";
}

TEST(QueryOnConstraints, AcceptsWaypointsTypedWithFewDigits) {
  EXPECT_NO_THROW((void)parse(kSphere, "{px: 75, py: 0, pz: 106}"));   // 0.15 mm off
  EXPECT_NO_THROW((void)parse(kSphere, "{px: 0, py: 0, pz: 130.9}"));  // of a tolerance of 1 mm
}

TEST(QueryOnConstraints, SaysHowFarAWaypointIsOff) {
  EXPECT_THAT(
      [] { (void)parse(kSphere, "{px: 0, py: 0, pz: 132}"); },
      ThrowsMessage<InputError>("test.yaml:11:21: query.waypoints[0]: got a waypoint that is 2 mm and 0 rad off the "
                                "constraints, expected at most 1 mm, or 0.01 rad"));
}

TEST(QueryOnConstraints, SaysWhereNothingIsNear) {
  EXPECT_THAT([] { (void)parse("px^2 + py^2 + pz^2 + 1", "{px: 1, py: 0, pz: 0}"); },
              ThrowsMessage<InputError>(HasSubstr("query.waypoints[0]: got a waypoint off the constraints")));
}

TEST(QueryOnConstraints, SaysWhichRankIsMissing) {
  for (const std::string& constraints : {kSphere + ", 2*px^2 + 2*py^2 + 2*pz^2 - 2*130^2", kSphere + ", pz - 130"}) {
    EXPECT_THAT(
        [&] { (void)parse(constraints); },
        ThrowsMessage<InputError>(AllOf(HasSubstr("test.yaml:10:56: space.implicit: got constraints of rank 1 at "
                                                  "query.waypoints[0], expected rank 2"))));
  }
  EXPECT_THAT([] { (void)parse("(px^2 + py^2 + pz^2 - 130^2)^2"); },
              ThrowsMessage<InputError>(HasSubstr("got constraints of rank 0 at query.waypoints[0], expected rank 1")));
}

}  // namespace
}  // namespace taut
