// SPDX-License-Identifier: GPL-3.0-or-later
// Planning around bodies: the 20 t crane, its container, and what stands in the hall.
#include <gtest/gtest.h>

#include "case/case_file.h"
#include "planner/planner.h"

namespace taut {
namespace {

HullText box_hull(const PointText& half) {
  HullText hull;
  for (unsigned k = 0; k < 8; ++k) {
    PointText corner;
    for (std::size_t axis = 0; axis < 3; ++axis) corner[axis] = ((k >> axis & 1U) != 0 ? "" : "-") + half[axis];
    hull.points_m.push_back(corner);
  }
  return hull;
}

BodyText block(const std::string& name, const PointText& half, const PointText& place) {
  BodyText body{.name = name, .shape = box_hull(half)};
  body.at_m = place;
  return body;
}

/// The case of the crane with its container, on a floor, and a stack of containers in between.
Case crane_with_stack() {
  Case result = load_case(TAUT_SOURCE_DIR "/cases/cranes/portal-20t.yaml");
  BodiesText bodies;
  bodies.platform = {block("container", {"1.2", "3.05", "1.3"}, {"0", "0", "-2.2"})};
  bodies.obstacles = {block("stack", {"1.2", "3.05", "1.3"}, {"0", "1", "1.3"})};
  bodies.obstacles[0].rotation_rad[2] = "(10)*pi/180";
  bodies.obstacles.push_back({.name = "floor", .shape = HalfSpaceText{{"0", "0", "1"}}});
  bodies.cables.diameter_m.fill("0.028");
  bodies.cables.free_ends_m.fill({"0.5", "0.4"});
  bodies.clearance_m = {"0.2", "0.2", "0.02", "0.01"};
  result.problem.bodies = bodies;
  validate(result.problem);
  return result;
}

TEST(PlanBodies, GoesAroundWhatStandsInTheWay) {
  Case the_case = crane_with_stack();
  Planner planner(the_case);
  const Plan plan = planner.plan({}, {});
  ASSERT_EQ(plan.proof.verdict, Verdict::kProved) << plan.proof.reason;
  EXPECT_GT(plan.path.segments(), 1U);  // the straight way is blocked: 6 m - 3.5 m is less than the stack's 2.6 m
  for (const SegmentProof& segment : plan.proof.segments) {
    EXPECT_GT(segment.clearance_m, 0);
    EXPECT_EQ(segment.directions.size(), segment.boxes.size());
  }
}

TEST(PlanBodies, NamesAStartInContact) {
  Case the_case = crane_with_stack();
  the_case.problem.query[0] = {"0", "0.5", "6", "0", "0", "0"};
  Planner planner(the_case);
  const Plan plan = planner.plan({}, {});
  EXPECT_EQ(plan.proof.verdict, Verdict::kRefuted) << plan.proof.reason;
  EXPECT_EQ(plan.refuted_waypoint, 0U);
  ASSERT_TRUE(plan.proof.witness && plan.proof.witness->contact);
  const BodiesText& bodies = *the_case.problem.bodies;
  EXPECT_EQ(name(bodies, pairs(bodies)[plan.proof.witness->contact->pair]), "container / stack");
}

}  // namespace
}  // namespace taut
