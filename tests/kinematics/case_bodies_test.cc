// SPDX-License-Identifier: GPL-3.0-or-later
// Bodies of a case: what users may say, and what comes of it, exactly.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <filesystem>
#include <fstream>
#include <random>

#include "base/input_error.h"
#include "case/bodies.h"
#include "case/case_file.h"
#include "case/fields.h"
#include "case/inside.h"
#include "case/prism.h"

namespace taut {
namespace {

using ::testing::AllOf;
using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::SizeIs;
using ::testing::StartsWith;
using ::testing::ThrowsMessage;

/// The crane of the examples: anchors in m.
RobotText crane() {
  RobotText robot;
  robot.length_m.fill({"3", "35"});
  robot.base_anchors_m = {{{"15", "10", "15"},
                           {"15", "10", "15"},
                           {"-15", "10", "15"},
                           {"-15", "10", "15"},
                           {"0", "-10", "15"},
                           {"0", "-10", "15"}}};
  robot.platform_anchors_m = {{{"0", "1.5", "0"},
                               {"1.3", "-0.75", "0"},
                               {"0", "1.5", "0"},
                               {"-1.3", "-0.75", "0"},
                               {"1.3", "-0.75", "0"},
                               {"-1.3", "-0.75", "0"}}};
  return robot;
}

/// Reads `yaml`, what is behind `bodies:`; bare numbers are in m and degrees.
CaseBodies read(const std::string& yaml, const std::filesystem::path& folder = {}) {
  using namespace case_fields;
  Places places("crane.yaml");
  const Units units(Field(places, YAML::Load("{length: m, angle: deg}"), "units").map({"length", "angle"}));
  try {
    return read_bodies(Field(places, YAML::Load(yaml), "bodies"), units, folder, crane());
  } catch (const FieldError& error) {
    places.fail(error);
  }
}

constexpr const char* kCables = "cables: {diameter: 28 mm, free_ends: [0.5, 0.4]}\n";
/// A case with one obstacle, in line 3.
std::string with_obstacle(const std::string& body) {
  return std::string("clearance: 200 mm\n") + kCables + "obstacles: [" + body + "]\n";
}
BodyText obstacle(const std::string& body) { return read(with_obstacle(body)).text.obstacles.at(0); }
const HullText& hull(const BodyText& body) { return std::get<HullText>(body.shape); }

void expect_rejected(const std::string& yaml, const std::string& message) {
  EXPECT_THAT([&] { (void)read(yaml); },
              ThrowsMessage<InputError>(AllOf(StartsWith("crane.yaml:"), HasSubstr(message))))
      << yaml;
}
void expect_obstacle_rejected(const std::string& body, const std::string& message) {
  expect_rejected(with_obstacle(body), message);
}

TEST(CaseBodies, OfTheExampleCraneAreExact) {
  const BodiesText bodies = read(R"(
clearance: {default: 200 mm, cables-cables: 20 mm, cables-platform: 10 mm}
cables: {diameter: 28 mm, free_ends: [0.5, 0.4]}
platform:
  - {name: deck, box: [2, 1.6, 0.2], at: [0, 0, -0.15]}
  - {name: container, box: [2.4, 6.1, 2.6], at: [0, 0, -2.2]}
obstacles:
  - {name: floor, half_space: {point: [0, 0, 0], normal: [0, 0, 1]}}
  - {name: stack, box: [2.4, 6.1, 2.6], at: [0, 1, 1.3], yaw: 10}
  - {name: post, capsule: {from: [7, 5, 0], to: [7, 5, 6], radius: 0.15}}
pairs: [platform-obstacles, cables-obstacles, cables-cables, cables-platform]
)")
                                .text;
  EXPECT_THAT(bodies.clearance_m, ElementsAre("0.2", "0.2", "0.02", "0.01"));
  EXPECT_EQ(bodies.cables.diameter_m[5], "0.028");
  EXPECT_THAT(bodies.cables.free_ends_m[5], ElementsAre("0.5", "0.4"));
  ASSERT_THAT(bodies.platform, SizeIs(2));
  EXPECT_THAT(bodies.platform[0].at_m, ElementsAre("0", "0", "-0.15"));
  EXPECT_THAT(hull(bodies.platform[0]).points_m.front(), ElementsAre("-1", "-0.8", "-0.1"));
  EXPECT_THAT(hull(bodies.platform[0]).points_m.back(), ElementsAre("1", "0.8", "0.1"));
  EXPECT_EQ(hull(bodies.platform[0]).radius_m, "0");
  ASSERT_THAT(bodies.obstacles, SizeIs(3));
  EXPECT_THAT(std::get<HalfSpaceText>(bodies.obstacles[0].shape).normal, ElementsAre("0", "0", "1"));
  EXPECT_THAT(bodies.obstacles[1].rotation_rad, ElementsAre("0", "0", "(10)*pi/180"));
  EXPECT_THAT(hull(bodies.obstacles[2]).points_m, SizeIs(2));
  EXPECT_EQ(hull(bodies.obstacles[2]).radius_m, "0.15");
  EXPECT_EQ(pairs(bodies).size(), 2U * 3 + 6 * 3 + 15 + 6 * 2);
}

TEST(CaseBodies, MayHaveEachShape) {
  EXPECT_EQ(obstacle("{name: a, ball: {at: [0, 0, 1], radius: 100 cm}, clearance: 3 mm}").clearance_m, "0.003");
  EXPECT_EQ(hull(obstacle("{name: a, ball: {at: [0, 0, 1], radius: 100 cm}}")), (HullText{{{"0", "0", "1"}}, "1"}));
  EXPECT_EQ(hull(obstacle("{name: a, ball: {radius: 1}, at: [0, 0, 1]}")), (HullText{{{"0", "0", "0"}}, "1"}));
  EXPECT_EQ(hull(obstacle("{name: a, points: [[0, 0, 0], [3, 0, 0], [0, 3 mm, 0]], radius: 0}")),
            (HullText{{{"0", "0", "0"}, {"3", "0", "0"}, {"0", "0.003", "0"}}, "0"}));
  EXPECT_EQ(hull(obstacle("{name: a, points: [[1, 2, 3]]}")).radius_m, "0");
  const BodyText turned = obstacle("{name: a, box: [1, 1, 1], rotation: {roll: 30, yaw: 0.5 rad}}");
  EXPECT_THAT(turned.rotation_rad, ElementsAre("(30)*pi/180", "0", "0.5"));
  const BodyText wall = obstacle("{name: a, half_space: {point: [20, 0, 0], normal: [-2, 0, 0]}}");
  EXPECT_THAT(wall.at_m, ElementsAre("20", "0", "0"));
}

TEST(CaseBodies, ThatAreWrongAreRejectedWithTheirPlace) {
  expect_obstacle_rejected("{name: a, box: [1, 1, 0]}",
                           "crane.yaml:3:35: bodies.obstacles[a].box[2]: got '0', expected a length above zero");
  expect_obstacle_rejected("{name: a, box: [1, 1, -1]}", "expected a length above zero");
  expect_obstacle_rejected("{name: a, box: [1, 1, .nan]}", "got '.nan', expected a decimal number");
  expect_obstacle_rejected("{name: a, box: [1, 1, nan]}", "got 'nan'");
  expect_obstacle_rejected("{name: a, box: [1, 1]}", "bodies.obstacles[a].box: got [1, 1], expected the three sides");
  expect_obstacle_rejected("{name: a, box: [1 kg, 1, 1]}", "expected a length: a decimal number, bare (m)");
  expect_obstacle_rejected("{name: a, ball: {radius: 0}}", "bodies.obstacles[a].ball.radius: got '0'");
  expect_obstacle_rejected("{name: a, ball: {at: [0, 0, 0]}}", "got no 'radius'");
  expect_obstacle_rejected("{name: a, capsule: {from: [0, 0, 1], to: [0, 0, 1000 mm], radius: 1}}",
                           "expected another point than 'from'");
  expect_obstacle_rejected("{name: a, cylinder: {from: [0, 0, 1], to: [0, 0, 2], radius: -1}}", "a length above zero");
  expect_obstacle_rejected("{name: a, points: []}", "expected a list of 1 to 1000 points");
  expect_obstacle_rejected("{name: a, points: [[1, 2]]}",
                           "bodies.obstacles[a].points[0]: got [1, 2], expected a point");
  expect_obstacle_rejected("{name: a, points: [[1, 2, 3]], radius: -1}", "a length >= 0");
  expect_obstacle_rejected("{name: a, half_space: {point: [0, 0, 0], normal: [0, 0, 0]}}", "expected a direction");
  expect_obstacle_rejected("{name: a, half_space: {point: [0, 0, 0], normal: [0, 0, 1]}, yaw: 3}", "got 'yaw' beside");
  expect_obstacle_rejected("{name: a, box: [1, 1, 1], radius: 1}", "got 'radius' beside 'box', expected it beside");
  expect_obstacle_rejected("{name: a, box: [1, 1, 1], ball: {radius: 1}}", "got box, ball in one body");
  expect_obstacle_rejected("{name: a}", "got no shape in one body, expected exactly one of box, ball, capsule");
  expect_obstacle_rejected("{name: a, sphere: {radius: 1}}", "got the unknown key 'sphere'");
  expect_obstacle_rejected("{box: [1, 1, 1]}", "got no 'name'");
  expect_obstacle_rejected("{name: cable 2, box: [1, 1, 1]}", "this one is a cable's");
  expect_obstacle_rejected("{name: a, box: [1, 1, 1]}, {name: a, box: [1, 1, 1]}",
                           "crane.yaml:3:47: bodies.obstacles[1].name: got 'a', expected a name of its own");
  expect_obstacle_rejected("{name: a, box: [1, 1, 1], yaw: 1, rotation: {yaw: 1}}", "got both of 'yaw' and");
  expect_obstacle_rejected("{name: a, box: [1, 1, 1], yaw: phi}",
                           "bodies.obstacles[a].yaw: expression 'phi', column 1");
  expect_obstacle_rejected("{name: a, box: [1, 1, 1], clearance: -1 mm}", "a length >= 0");
  expect_rejected(
      "{clearance: 1, platform: [{name: f, half_space: {point: [0, 0, 0], normal: [0, 0, 1]}}], cables: "
      "{diameter: 0, free_ends: 1}}",
      "bodies.platform[f]: got a half-space on the platform");
}

// --- Cables, clearances and classes --------------------------------------------------------------------------------

TEST(CaseCables, MayHaveOneOrSixOfEach) {
  const auto cables = [](const std::string& text) {
    return read("{clearance: 0, pairs: [cables-cables], cables: " + text + "}").text.cables;
  };
  const CableBodiesText one = cables("{diameter: 2 cm, free_ends: 300 mm}");
  EXPECT_EQ(one.diameter_m[3], "0.02");
  EXPECT_THAT(one.free_ends_m[3], ElementsAre("0.3", "0.3"));
  const CableBodiesText six =
      cables("{diameter: [1, 2, 3, 4, 5, 6], free_ends: [[1, 2], [3, 4], 5, [7, 8], [9, 10], [11, 12]]}");
  EXPECT_EQ(six.diameter_m[5], "6");
  EXPECT_THAT(six.free_ends_m[2], ElementsAre("5", "5"));
  EXPECT_THAT(six.free_ends_m[5], ElementsAre("11", "12"));
  for (const char* wrong : {"{diameter: 1}", "{free_ends: 1}", "{diameter: -1, free_ends: 1}",
                            "{diameter: [1, 2], free_ends: 1}", "{diameter: 1, free_ends: [1, -2]}",
                            "{diameter: 1, free_ends: [1, 2, 3]}", "{diameter: 1, free_ends: {base: 1}}"}) {
    expect_rejected(std::string("{clearance: 0, cables: ") + wrong + "}", "bodies.cables");
  }
}

constexpr const char* kDeck = "platform: [{name: deck, box: [1, 1, 1 mm]}]\n";
constexpr const char* kPost = "obstacles: [{name: post, ball: {radius: 1}}]\n";

TEST(CasePairs, AreAtLeastOneClass) {
  expect_rejected("{clearance: 1, platform: [{name: f, ball: {radius: 1}}], obstacles: [], pairs: []}",
                  "bodies.pairs: got an empty list, expected one class of pairs or more");
}

TEST(CasePairs, AreAllThatThereAreBodiesForUnlessStated) {
  const auto checked = [](const std::string& yaml) {
    std::string classes;
    const BodiesText bodies = read(yaml).text;
    for (const auto& clearance : bodies.clearance_m) classes += clearance ? "x" : "-";
    return classes;
  };
  const std::string all = std::string("clearance: 0.1\n") + kCables + kDeck + kPost;
  EXPECT_EQ(checked(all), "xxxx");
  EXPECT_EQ(checked(std::string("clearance: 0.1\n") + kDeck + kPost), "x---");
  EXPECT_EQ(checked(std::string("clearance: 0.1\n") + kCables), "--x-");
  EXPECT_EQ(checked(std::string("clearance: 0.1\n") + kCables + kPost), "-xx-");
  EXPECT_EQ(checked(all + "pairs: [cables-cables, platform-obstacles]\n"), "x-x-");
  expect_rejected(all + "pairs: []\n", "bodies.pairs: got an empty list, expected one class of pairs or more");
  expect_rejected("{clearance: 1}", "got nothing that could touch");
  expect_rejected(all + "pairs: [cables]\n", "bodies.pairs[0]: got 'cables', expected one of platform-obstacles");
  expect_rejected(all + "pairs: [cables-cables, cables-cables]\n", "got 'cables-cables' twice");
  expect_rejected(std::string("clearance: 0.1\n") + kCables + "pairs: [cables-obstacles]\n",
                  "got 'cables-obstacles' without 'obstacles'");
  expect_rejected(std::string("clearance: 0.1\n") + kPost + "pairs: [cables-obstacles]\n",
                  "got 'cables-obstacles' without 'cables'");
}

TEST(CasePairs, HaveTheClearanceOfTheirClass) {
  const std::string bodies = std::string(kCables) + kDeck + kPost;
  EXPECT_THAT(read("clearance: {default: 0.1, cables-cables: 2 mm}\n" + bodies).text.clearance_m,
              ElementsAre("0.1", "0.1", "0.002", "0.1"));
  EXPECT_THAT(read("clearance: {cables-cables: 2 mm}\npairs: [cables-cables]\n" + bodies).text.clearance_m,
              ElementsAre(std::nullopt, std::nullopt, "0.002", std::nullopt));
  EXPECT_THAT(read("clearance: {cables-cables: 2 mm, cables-platform: 1}\npairs: [cables-cables]\n" + bodies)
                  .text.clearance_m[3],
              std::nullopt);
  expect_rejected("clearance: {cables-cables: 2 mm}\n" + bodies,
                  "crane.yaml:1:12: bodies.clearance: got no clearance of 'platform-obstacles'");
  expect_rejected(std::string("clearance: {default: 1, cables-platform: 1}\n") + kCables,
                  "bodies.clearance.cables-platform: got a clearance of 'cables-platform', expected bodies");
  expect_rejected(bodies, "got no 'clearance'");
  expect_rejected("clearance: [1, 2]\n" + bodies, "expected a length, or a map with the keys default");
  expect_rejected("clearance: -1\n" + bodies, "a length >= 0");
  expect_rejected("clearance: {default: 1, cables: 1}\n" + bodies, "got the unknown key 'cables'");
}

TEST(CasePairs, MayHaveAClearanceOfTheirOwn) {
  const std::string bodies = std::string("clearance: 0.1\n") + kCables + kDeck + kPost;
  const BodiesText text = read(bodies + "pair_clearances: [{pair: [post, deck], clearance: 1 cm}]\n").text;
  EXPECT_EQ(text.pair_clearances_m, (std::vector<PairClearanceText>{{{"post", "deck"}, "0.01"}}));
  EXPECT_EQ(pairs(text).front().clearance_m, "0.01");
  expect_rejected(bodies + "pair_clearances: [{pair: [post, dock], clearance: 1 cm}]\n",
                  "crane.yaml:5:33: bodies.pair_clearances[0].pair[1]: got 'dock', expected the name of a body");
  expect_rejected(
      bodies + "pair_clearances: [{pair: [post, deck], clearance: 1}, {pair: [deck, post], clearance: 2}]\n",
      "expected one clearance for each pair");
  expect_rejected(bodies + "pair_clearances: []\n", "got an empty list, expected one pair or more");
  expect_rejected(bodies + "pair_clearances: [{pair: [post], clearance: 1}]\n", "expected the names of two bodies");
}

TEST(CasePairs, MayTouchSomewhere) {
  const std::string bodies = std::string("clearance: 0.1\n") + kCables + kDeck + kPost;
  const std::string contact = "{pair: [post, deck], at: [0, 1 m, 2], within: 30 cm, depth: 5 mm}";
  const BodiesText text = read(bodies + "contacts: [" + contact + "]\n").text;
  EXPECT_EQ(text.contacts, (std::vector<ContactText>{{{"post", "deck"}, {{"0", "1", "2"}, "0.3", "0.005"}}}));
  EXPECT_EQ(pairs(text).front().zones.size(), 1U);
  const auto expect_spoilt = [&](const std::string& from, const std::string& to, const std::string& message) {
    std::string spoilt = contact;
    spoilt.replace(spoilt.find(from), from.size(), to);
    expect_rejected(bodies + "contacts: [" + spoilt + "]\n", message);
  };
  expect_spoilt("30 cm", "0", "bodies.contacts[0].within: got '0', expected a length above zero");
  expect_spoilt("5 mm", "-5 mm", "bodies.contacts[0].depth: got '-5 mm', expected a length above zero");
  expect_spoilt("5 mm", "5 deg", "bodies.contacts[0].depth");
  expect_spoilt(", depth: 5 mm", "", "got no 'depth'");
  expect_spoilt("depth", "deep", "got the unknown key 'deep'");
  expect_spoilt("2]", "2, 3]", "a point: a list of three lengths");
  expect_spoilt("deck", "dock", "bodies.contacts[0].pair[1]: got 'dock', expected the name of a body");
  expect_rejected(bodies + "contacts: []\n", "got an empty list, expected one contact or more");
  expect_rejected(bodies + "contacts: 3\n", "expected a list of contacts");
}

TEST(CaseExitCones, AreReadOfOneCableOrSome) {
  const auto cones = [](const std::string& text) { return read("exit_cones: [" + text + "]\n").text.exit_cones; };
  const std::string rest = ", end: base, axis: [0, 0, -1], half_angle: 60 deg}";
  const auto all = cones("{cable: all" + rest);
  ASSERT_EQ(all.size(), 6U);
  EXPECT_EQ(all[5], (ExitConeText{5, CableEnd::kBase, {"0", "0", "-1"}, "(60)*pi/180"}));
  EXPECT_EQ(cones("{cable: [2, 4]" + rest + ", {cable: 1, end: platform, axis: [1, 2, 3], half_angle: 0.5 rad}").size(),
            3U);
  const auto expect_wrong = [&](const std::string& cone, const std::string& message) {
    expect_rejected("exit_cones: [" + cone + "]\n", message);
  };
  expect_wrong("{cable: 7" + rest, "bodies.exit_cones[0].cable: got '7', expected a cable, 1 to 6");
  expect_wrong("{cable: [1, x]" + rest, "expected a cable, 1 to 6");
  expect_wrong("{cable: [1, 1]" + rest, "bodies.exit_cones[1]: got a second exit cone of cable 1 at the base");
  expect_wrong("{cable: []" + rest, "got no exit cone");
  expect_wrong("{cable: 1, end: top, axis: [0, 0, -1], half_angle: 60 deg}", "bodies.exit_cones[0].end: got 'top'");
  expect_wrong("{cable: 1, end: base, axis: [0, 0, 0], half_angle: 60 deg}", "expected a direction");
  expect_wrong("{cable: 1, end: base, axis: [0, 0, -1], half_angle: 90 deg}", "expected an angle above 0 and below 90");
  expect_wrong("{cable: 1, end: base, axis: [0, 0, -1], half_angle: 60 mm}", "bodies.exit_cones[0].half_angle");
  expect_wrong("{cable: 1, end: base, axis: [0, 0, -1]}", "got no 'half_angle'");
  expect_rejected("exit_cones: [{cable: all" + rest + "]\nclearance: 1\n", "got a clearance of nothing");
  EXPECT_TRUE(pairs(read("exit_cones: [{cable: 1" + rest + "]\n").text).size() == 1);
}

// --- Anchors ---------------------------------------------------------------------------------------------------------

TEST(CaseAnchors, InsideOfBodiesAreRejectedWhereTheCableAlwaysTouches) {
  // The base's anchors of cables 1 and 2 are at (15, 10, 15); free ends are 0.5 m and 0.4 m.
  expect_obstacle_rejected("{name: gantry, box: [2, 2, 2], at: [15, 10, 15]}",
                           "crane.yaml:3:13: bodies.obstacles[gantry]: got a body with the base anchor of cable 1");
  expect_obstacle_rejected("{name: wall, half_space: {point: [14, 0, 0], normal: [-1, 0, 0]}}", "anchor of cable 1");
  expect_obstacle_rejected("{name: ball, ball: {at: [-15, 10, 15], radius: 0.4}}", "anchor of cable 3");
  expect_obstacle_rejected("{name: plate, box: [5, 5, 1 mm], at: [0, -10, 15], clearance: 0.7}", "anchor of cable 5");
  // What the cable's free end comes out of.
  EXPECT_NO_THROW((void)obstacle("{name: gantry, box: [2, 2, 0.4], at: [15, 10, 15]}"));
  EXPECT_NO_THROW((void)obstacle("{name: wall, half_space: {point: [15, 0, 0], normal: [-1, 0, 0]}}"));
  EXPECT_NO_THROW((void)obstacle("{name: ball, ball: {at: [-15, 10, 15], radius: 0.25}}"));
  // On the platform, whose anchors are within 1.5 m.
  const auto deck = [](const std::string& body) {
    return std::string("clearance: 10 mm\n") + kCables + "platform: [" + body + "]\n";
  };
  expect_rejected(deck("{name: deck, box: [4, 4, 4]}"), "bodies.platform[deck]: got a body with the platform anchor");
  EXPECT_NO_THROW((void)read(deck("{name: deck, box: [4, 4, 0.2]}")));
  EXPECT_NO_THROW((void)read(deck("{name: deck, box: [4, 4, 4]}") + "pairs: [cables-cables]\n"));
}

TEST(ContainsBall, AgreesWithWhatBoxesAndBallsContain) {
  using case_fields::contains_ball_approx;
  const auto box = [](const std::string& more) { return obstacle("{name: a, box: [2, 4, 6]" + more + "}"); };
  const PointText origin = {"0", "0", "0"};
  EXPECT_TRUE(contains_ball_approx(box(""), origin, 0.88, 0));  // 1 / 1.13
  EXPECT_FALSE(contains_ball_approx(box(""), origin, 1.01, 0));
  EXPECT_TRUE(contains_ball_approx(box(""), origin, 1.3, 0.5));
  EXPECT_FALSE(contains_ball_approx(box(""), origin, 1.51, 0.5));
  EXPECT_TRUE(contains_ball_approx(box(", at: [10, 0, 0], yaw: 90"), {"11.5", "0", "0"}, 0.4, 0));
  EXPECT_FALSE(contains_ball_approx(box(", at: [10, 0, 0]"), {"11.5", "0", "0"}, 0.1, 0));
  EXPECT_TRUE(contains_ball_approx(box(", at: [10, 0, 0]"), {"11.5", "0", "0"}, 0.1, 0.65));
  const BodyText ball = obstacle("{name: a, ball: {radius: 1}}");
  EXPECT_TRUE(contains_ball_approx(ball, {"0.5", "0", "0"}, 0.4, 0));
  EXPECT_FALSE(contains_ball_approx(ball, {"0.5", "0", "0"}, 0.51, 0));
  const BodyText capsule = obstacle("{name: a, capsule: {from: [0, 0, 0], to: [3, 0, 0], radius: 1}}");
  EXPECT_TRUE(contains_ball_approx(capsule, {"2", "0", "0"}, 0.88, 0));
  EXPECT_FALSE(contains_ball_approx(capsule, {"3.5", "0", "0"}, 0.6, 0));
  const BodyText flat = obstacle("{name: a, points: [[0, 0, 0], [3, 0, 0], [0, 3, 0], [3, 3, 0], [1, 1, 0]]}");
  EXPECT_FALSE(contains_ball_approx(flat, {"1", "1", "0"}, 0.1, 0));
  EXPECT_TRUE(contains_ball_approx(flat, {"1", "1", "0"}, 0, 0));
  EXPECT_TRUE(contains_ball_approx(flat, {"1", "1", "0.5"}, 0.1, 0.62));
}

// --- Cylinders -------------------------------------------------------------------------------------------------------

using Vector = std::array<double, 3>;

double dot(const Vector& a, const Vector& b) { return a[0] * b[0] + a[1] * b[1] + a[2] * b[2]; }

Vector vector_of(const PointText& point) {
  Vector result{};
  for (std::size_t k = 0; k < 3; ++k) result[k] = ScalarTraits<double>::from_decimal(point[k]);
  return result;
}

/// How far the prism reaches farther than the cylinder, in the worst direction and in the best: by support functions.
std::array<double, 2> reach_beyond(const std::vector<PointText>& prism, const PointText& from, const PointText& to,
                                   double radius) {
  std::vector<Vector> corners;
  for (const PointText& point : prism) corners.push_back(vector_of(point));
  const Vector a = vector_of(from), b = vector_of(to), w = {b[0] - a[0], b[1] - a[1], b[2] - a[2]};
  std::mt19937 random(7);  // NOLINT(cert-msc51-cpp): the same each time
  std::normal_distribution<double> normal;
  std::array<double, 2> result = {1e9, 0};
  for (int trial = 0; trial < 20000; ++trial) {
    Vector u = {normal(random), normal(random), normal(random)};
    if (trial % 2 == 1) {  // across the axis, where the cylinder is round
      const double along = dot(u, w) / dot(w, w);
      for (std::size_t k = 0; k < 3; ++k) u[k] -= along * w[k];
    }
    const double size = std::sqrt(dot(u, u));
    for (double& x : u) x /= size;
    const double along = dot(u, w) / std::sqrt(dot(w, w));
    const double cylinder = std::max(dot(u, a), dot(u, b)) + radius * std::sqrt(std::max(0.0, 1 - along * along));
    double of_prism = -1e300;
    for (const Vector& corner : corners) of_prism = std::max(of_prism, dot(u, corner));
    result[0] = std::min(result[0], of_prism - cylinder);
    result[1] = std::max(result[1], of_prism - cylinder);
  }
  return result;
}

TEST(CylinderOfACase, IsAPrismAroundItWhoseExcessIsStated) {
  struct Trial {
    PointText from, to;
    const char* radius;
  };
  for (const auto& [from, to, radius] :
       {Trial{{"0", "0", "0"}, {"0", "0", "6"}, "0.15"}, Trial{{"7", "5", "0"}, {"7", "9", "0"}, "2"},
        Trial{{"1", "2", "3"}, {"-4", "0.5", "6.25"}, "0.3"}, Trial{{"0", "0", "0"}, {"0.01", "0", "0.02"}, "5"},
        Trial{{"0", "0", "0"}, {"30", "40", "0.001"}, "0.001"}}) {
    const case_fields::Prism prism = case_fields::prism_around_cylinder(from, to, radius);
    EXPECT_THAT(prism.points_m, SizeIs(2 * case_fields::kPrismSides));
    const double r = ScalarTraits<double>::from_decimal(radius);
    const double excess = ScalarTraits<double>::from_decimal(prism.excess_m);
    const auto [least, most] = reach_beyond(prism.points_m, from, to, r);
    EXPECT_GE(least, -1e-12);
    EXPECT_LE(most, excess);
    EXPECT_GE(most, 0.9 * excess);  // it is no empty promise
    EXPECT_NEAR(excess, 0.0196 * r, 2e-4 * r);
  }
}

TEST(CylinderOfACase, AlongAnAxisHasShortNumbers) {
  const CaseBodies bodies =
      read(with_obstacle("{name: post, cylinder: {from: [7, 5, 0], to: [7, 5, 6], radius: 0.15}}"));
  ASSERT_THAT(bodies.cylinders, SizeIs(1));
  EXPECT_EQ(bodies.cylinders[0].body, "post");
  EXPECT_EQ(bodies.cylinders[0].excess_m, "0.00295");
  for (const PointText& point : hull(bodies.text.obstacles[0]).points_m) {
    for (const DecimalText& x : point) EXPECT_LE(x.size(), 9U) << x;
    EXPECT_TRUE(point[2] == "0" || point[2] == "6") << point[2];
  }
}

TEST(CylinderOfACase, OfExtremeShapeIsRightOrRefused) {
  const CaseBodies coin = read(with_obstacle(
      "{name: a, cylinder: {from: [0, 0, 0], to: [1e-30, 2e-30, 0.3e-30], radius: 1e30}, at: [0, 0, 9e30]}"));
  EXPECT_NEAR(ScalarTraits<double>::from_decimal(coin.cylinders.at(0).excess_m), 0.0196e30, 2e-4 * 1e30);
  expect_obstacle_rejected("{name: a, cylinder: {from: [0, 0, 0], to: [1e50, 2e50, 3e50], radius: 1 mm}}",
                           "bodies.obstacles[a].cylinder: expected a cylinder whose length and radius are of sizes");
}

// --- Meshes ----------------------------------------------------------------------------------------------------------

class MeshesOfACase : public ::testing::Test {
 protected:
  void SetUp() override {
    folder_ = std::filesystem::path(::testing::TempDir()) /
              ("bodies-" + std::string(::testing::UnitTest::GetInstance()->current_test_info()->name()));
    std::filesystem::create_directories(folder_);
    std::ofstream(folder_ / "tool.obj") << "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n";
    std::ofstream(folder_ / "empty.stl") << "";
  }
  void TearDown() override { std::filesystem::remove_all(folder_); }
  CaseBodies read_tool(const std::string& body) {
    return read(std::string("clearance: 10 mm\n") + kCables + "platform: [{name: tool, " + body + "}]\n", folder_);
  }
  void expect_tool_rejected(const std::string& body, const std::string& message) {
    EXPECT_THAT([&] { (void)read_tool(body); },
                ThrowsMessage<InputError>(AllOf(StartsWith("crane.yaml:3:"), HasSubstr(message))));
  }
  std::filesystem::path folder_;
};

TEST_F(MeshesOfACase, AreNamedByTheirDigest) {
  const CaseBodies bodies = read_tool("mesh: tool.obj, unit: mm, at: [0, 0, -1], rotation: {yaw: 90}");
  const MeshText mesh{"tool.obj", "697b00ab13410c52a542d2e9c63711fcc04e9cbf6c0d3439a9b43cc812e6e713", "0.001"};
  EXPECT_EQ(std::get<MeshText>(bodies.text.platform[0].shape), mesh);
  EXPECT_THAT(bodies.text.platform[0].at_m, ElementsAre("0", "0", "-1"));
  ASSERT_THAT(bodies.meshes, SizeIs(1));
  EXPECT_EQ(bodies.meshes[0].body, "tool");
  EXPECT_FALSE(bodies.meshes[0].mesh->report.is_watertight());
}

TEST_F(MeshesOfACase, ThatAreWrongAreRejectedWithTheirPlace) {
  expect_tool_rejected("mesh: none.obj, unit: mm",
                       "bodies.platform[tool].mesh: got 'none.obj', which could not be read: No such file");
  expect_tool_rejected("mesh: empty.stl, unit: mm", "got 'empty.stl', which is no whole stl file, expected a mesh");
  expect_tool_rejected("mesh: tool.step, unit: mm", "expected the name of an STL, OBJ or PLY file");
  expect_tool_rejected("mesh: tool.obj", "got no 'unit'");
  expect_tool_rejected("mesh: tool.obj, unit: kg", "expected the unit of the mesh's coordinates, one of m");
  expect_tool_rejected("box: [1, 1, 1], unit: mm", "got 'unit' beside 'box', expected it beside 'mesh' only");
}

TEST(CaseFile, ReadsBodiesIntoTheProblem) {
  const Case stack = load_case(TAUT_SOURCE_DIR "/cases/cranes/portal-20t-stack.yaml");
  ASSERT_TRUE(stack.bodies && stack.problem.bodies);
  EXPECT_EQ(stack.bodies->text, *stack.problem.bodies);
  EXPECT_EQ(pairs(*stack.problem.bodies).size(), 2U + 12 + 15 + 6);
}

}  // namespace
}  // namespace taut
