// SPDX-License-Identifier: GPL-3.0-or-later
#include "reports/summary/bodies_statement.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "problem/problem.h"
#include "reports/summary/scope.h"
#include "tests/support/meshes.h"

namespace taut {
namespace {

using ::testing::AllOf;
using ::testing::Contains;
using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::IsEmpty;
using ::testing::Not;
using ::testing::SizeIs;

BodyText hull_body(const std::string& name, std::vector<PointText> points, DecimalText radius = "0") {
  BodyText body;
  body.name = name;
  body.shape = HullText{std::move(points), std::move(radius)};
  return body;
}

BodyText box_body(const std::string& name, const std::array<DecimalText, 3>& half) {
  std::vector<PointText> corners;
  for (unsigned corner = 0; corner < 8; ++corner) {
    PointText& point = corners.emplace_back();
    for (unsigned k = 0; k < 3; ++k) point[k] = ((corner >> k & 1U) != 0 ? "" : "-") + half[k];
  }
  return hull_body(name, corners);
}

BodiesText crane_scene() {
  BodiesText bodies;
  bodies.platform = {box_body("container", {"1.2", "3.05", "1.3"})};
  bodies.platform[0].at_m = {"0", "0", "-2.2"};
  BodyText floor, stack = box_body("stack", {"1.2", "3.05", "1.3"});
  floor.name = "floor";
  floor.shape = HalfSpaceText{{"0", "0", "1"}};
  stack.at_m = {"0", "1", "1.3"};
  stack.rotation_rad[2] = "(10)*pi/180";
  stack.clearance_m = "0.3";
  bodies.obstacles = {floor, stack, hull_body("post", {{"7", "5", "0"}, {"7", "5", "6"}}, "0.15")};
  bodies.cables.diameter_m.fill("0.028");
  bodies.cables.free_ends_m.fill({"0.5", "0.4"});
  bodies.clearance_m = {"0.2", "0.2", "0.02", "0.01"};
  return bodies;
}

TEST(BodiesStatement, SaysTheExampleCranesBodiesInPeoplesUnits) {
  const BodiesText bodies = crane_scene();
  validate(bodies);
  EXPECT_THAT(
      lines(bodies_statement(bodies)),
      ElementsAre(
          "Pairs and their clearances: platform and obstacles, 3 pairs, 200 mm to 300 mm, as "
          "some have their own; cables and obstacles, 18 pairs, 200 mm to 300 mm, as some have their own; cables among "
          "each other, 15 pairs, 20 mm; cables and platform, 6 pairs, 10 mm.",
          "Cables: 28 mm thick, not checked on the 500 mm near the base and the 400 mm near the platform.",
          "'container', on the platform: a box of 2.4 × 6.1 × 2.6 m at (0, 0, -2.2) m.",
          "'floor', obstacle: all behind the plane through (0, 0, 0) m, which faces along (0, 0, 1).",
          "'stack', obstacle: a box of 2.4 × 6.1 × 2.6 m at (0, 1, 1.3) m, turned by yaw 10°; clearance 300 mm.",
          "'post', obstacle: all within 150 mm of the segment from (7, 5, 0) m to (7, 5, 6) m."));
}

TEST(BodiesStatement, SaysAnglesAsTheyAreAlsoWhereTheirSumsCancel) {
  BodiesText bodies = crane_scene();
  bodies.obstacles[1].rotation_rad = {"(0.0)*pi/180", "1 + 10^60 - 10^60", "(10 + 10^17 - 10^17)*pi/180"};
  EXPECT_THAT(lines(bodies_statement(bodies)),
              Contains(HasSubstr("at (0, 1, 1.3) m, turned by pitch 1 + 10^60 - 10^60 rad (57.2958°), "
                                 "yaw (10 + 10^17 - 10^17)*pi/180 rad (10°); clearance")));
  bodies.exit_cones = {{0, CableEnd::kBase, {"0", "0", "-1"}, "pi/7"}};
  EXPECT_THAT(lines(bodies_statement(bodies)),
              Contains("Exit cones, in half-angles: cable 1 at the base, pi/7 rad (25.7143°) around (0, 0, -1)."));
}

TEST(BodiesStatement, SaysWhatIsNotChecked) {
  BodiesText bodies = crane_scene();
  bodies.clearance_m = {"0.2", std::nullopt, std::nullopt, std::nullopt};
  const BodiesStatement statement = bodies_statement(bodies);
  EXPECT_EQ(statement.checked,
            "Pairs and their clearances: platform and obstacles, 3 pairs, 200 mm to 300 mm, as some have "
            "their own. Not checked: cables and obstacles, cables among each other, cables and platform.");
  EXPECT_THAT(statement.cables, IsEmpty());
  bodies.clearance_m = {};
  EXPECT_THAT(bodies_statement(bodies).checked,
              AllOf(HasSubstr("Not checked: platform and obstacles, "), Not(HasSubstr("Pairs and their clearances"))));
}

TEST(BodiesStatement, SaysEachShapeAndPlace) {
  BodiesText bodies;
  bodies.clearance_m[0] = "0";
  bodies.platform = {hull_body("ball", {{"0", "0", "1"}}, "0.5"),
                     hull_body("turned ball", {{"0", "0", "1"}}, "2"),
                     hull_body("point", {{"0.01", "0", "0"}}),
                     hull_body("edge", {{"0", "0", "0"}, {"1", "0", "0"}}),
                     hull_body("ramp", {{"0", "0", "0"}, {"3", "0", "0"}, {"0", "3", "0"}, {"0", "0", "2"}}),
                     box_body("soft box", {"0.001", "0.02", "0.3"})};
  bodies.platform[0].at_m = {"1", "0", "0"};
  bodies.platform[1].at_m = {"1", "0", "0"};
  bodies.platform[1].rotation_rad = {"(90)*pi/180", "0", "0.5"};
  std::get<HullText>(bodies.platform[5].shape).radius_m = "0.0005";
  std::vector<std::string> words;
  for (const auto& [name, text] : bodies_statement(bodies).bodies) words.push_back(text);
  EXPECT_THAT(words, ElementsAre("on the platform: a ball of radius 500 mm around (1, 0, 1) m",
                                 "on the platform: a ball of radius 2 m around (0, 0, 1) m at (1, 0, 0) m, turned by "
                                 "roll 90°, yaw 0.5 rad (28.6479°)",
                                 "on the platform: the point (10, 0, 0) mm",
                                 "on the platform: the segment from (0, 0, 0) m to (1, 0, 0) m",
                                 "on the platform: the convex hull of 4 points from (0, 0, 0) m to (3, 3, 2) m",
                                 "on the platform: all within 0.5 mm of a box of 2 × 40 × 600 mm"));
}

TEST(BodiesStatement, TellsCablesApart) {
  BodiesText bodies;
  bodies.clearance_m[2] = "0.01";
  bodies.cables.diameter_m.fill("0.01");
  bodies.cables.diameter_m[3] = "0.02";
  EXPECT_THAT(bodies_statement(bodies).cables,
              AllOf(HasSubstr("3: 10 mm thick"), HasSubstr("; 4: 20 mm thick, not checked on the 0 m near the base")));
}

TEST(BodiesStatement, NotesClearancesOfPairsPrismsAndMeshes) {
  CaseBodies bodies;
  bodies.text = crane_scene();
  bodies.text.pair_clearances_m = {{{"cable 2", "stack"}, "1.5"}};
  bodies.cylinders = {{"post", "0.00295"}};
  BodyText tool;
  tool.name = "tool";
  tool.shape = MeshText{"tool.stl", std::string(64, 'a'), "0.001"};
  bodies.text.platform.push_back(tool);
  auto mesh = std::make_shared<LoadedMesh>(repaired(
      {{{0, 0, 0}, {1, 0, 0}, {0, 2, 0}, {0, 0, 30}, {1, 0, 0}}, {{0, 2, 1}, {0, 1, 3}, {0, 3, 2}, {4, 2, 3}}}));
  bodies.meshes = {{"tool", mesh, {}}};
  const BodiesStatement closed = bodies_statement(bodies);
  EXPECT_THAT(closed.bodies, SizeIs(5));
  EXPECT_EQ(closed.bodies[1].second, "on the platform: the mesh 'tool.stl', in units of 1 mm");
  EXPECT_THAT(closed.notes,
              ElementsAre("'cable 2' and 'stack': clearance 1.5 m",
                          "'post': a prism takes the place of the cylinder, and reaches up to 2.95 mm farther",
                          "'tool': 4 triangles, from (0, 0, 0) to (1, 2, 30) mm in its own axes, watertight, 1 closed "
                          "part; 1 point merged with an equal one"));
  *mesh = repaired({{{0, 0, 0}, {1, 0, 0}, {0, 2, 0}}, {{0, 1, 2}, {2, 1, 0}}});
  EXPECT_EQ(
      bodies_statement(bodies).notes.back(),
      "'tool': 1 triangle, from (0, 0, 0) to (1, 2, 0) mm in its own axes, not watertight: 3 edges of one "
      "triangle, 0 of more than two: it has no inside, and only its surface is checked; 1 triangle left out: it is "
      "there twice, or is a segment, which stays");
}

TEST(BodiesStatement, SaysOfWhichMeshesOnlyTheSurfaceIsChecked) {
  BodiesText bodies = crane_scene();
  TriangleMesh open = testing::box_mesh({1, 1, 1});
  bodies.obstacles.push_back({.name = "whole", .shape = testing::mesh_text(open, 'a')});
  open.triangles.pop_back();
  bodies.obstacles.push_back({.name = "rock", .shape = testing::mesh_text(open, 'b')});
  bodies.obstacles.push_back({.name = "plane", .shape = testing::mesh_text(testing::one_sided_mesh(), 'c')});
  EXPECT_THAT(bodies_without_inside(bodies), ElementsAre("'rock'", "'plane'"));
  const BodiesStatement statement = bodies_statement(bodies);
  EXPECT_THAT(statement.bodies[4].second, Not(HasSubstr("no inside")));
  EXPECT_THAT(statement.bodies[5].second, HasSubstr("; it has no inside: only its surface is checked"));
  Problem problem;
  problem.bodies = bodies;
  EXPECT_THAT(not_covered(problem).front().brief, HasSubstr("what is inside of 'rock', 'plane'"));
}

TEST(BodiesStatement, SaysTheLeastClearanceOfAClass) {
  BodiesText bodies = crane_scene();
  bodies.obstacles[1].clearance_m.reset();
  EXPECT_THAT(bodies_statement(bodies).checked, HasSubstr("platform and obstacles, 3 pairs, 200 mm; "));
  bodies.pair_clearances_m = {{{"container", "stack"}, "0"}};
  EXPECT_THAT(bodies_statement(bodies).checked, HasSubstr("platform and obstacles, 3 pairs, 0 m to 200 mm"));
}

}  // namespace
}  // namespace taut
