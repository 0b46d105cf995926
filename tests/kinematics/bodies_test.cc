// SPDX-License-Identifier: GPL-3.0-or-later
// Bodies of a problem: their pairs, what is refused, and JSON.
#include "problem/bodies.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <map>
#include <nlohmann/json.hpp>
#include <set>

#include "base/input_error.h"
#include "case/case_file.h"

namespace taut {
namespace {

using nlohmann::json;
using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::ThrowsMessage;

BodyText ball(const std::string& name, std::optional<DecimalText> clearance = {}) {
  BodyText body;
  body.name = name;
  body.clearance_m = std::move(clearance);
  body.shape = HullText{{{"0", "0", "0"}}, "0.5"};
  return body;
}

BodyText shaped(const std::string& name, decltype(BodyText::shape) shape) {
  BodyText body = ball(name);
  body.shape = std::move(shape);
  return body;
}

/// Two bodies of the platform, a hull and a mesh, and three obstacles, one of each shape; all classes are checked.
BodiesText scene() {
  BodiesText bodies;
  bodies.platform = {ball("deck"), shaped("tool", MeshText{"tool.stl", std::string(64, 'a'), "0.001"})};
  bodies.platform[1].rotation_rad = {"0", "0", "(90)*pi/180"};
  bodies.obstacles = {shaped("floor", HalfSpaceText{{"0", "0", "1"}}), ball("stack", "0.3"),
                      shaped("rock", MeshText{"rock.ply", std::string(64, '0'), "1"})};
  bodies.cables.diameter_m.fill("0.028");
  bodies.cables.free_ends_m.fill({"0.5", "0.4"});
  bodies.clearance_m = {"0.2", "0.1", "0.02", "0.01"};
  return bodies;
}

template <class Spoil>
void expect_refused(Spoil spoil, const std::string& message) {
  BodiesText bodies = scene();
  ASSERT_NO_THROW(validate(bodies));
  spoil(bodies);
  EXPECT_THAT([&] { validate(bodies); }, ThrowsMessage<FieldError>(HasSubstr(message)));
}

TEST(Pairs, AreCountedClassByClass) {
  const BodiesText bodies = scene();
  std::vector<std::string> names;
  for (const BodyPair& pair : pairs(bodies)) names.push_back(name(bodies, pair));
  ASSERT_EQ(names.size(), 2U * 3 + 6 * 3 + 15 + 6 * 2);
  EXPECT_EQ(names[0], "deck / floor");
  EXPECT_EQ(names[1], "deck / stack");
  EXPECT_EQ(names[3], "tool / floor");
  EXPECT_EQ(names[6], "cable 1 / floor");
  EXPECT_EQ(names[10], "cable 2 / stack");
  EXPECT_EQ(names[24], "cable 1 / cable 2");
  EXPECT_EQ(names[29], "cable 2 / cable 3");
  EXPECT_EQ(names[38], "cable 5 / cable 6");
  EXPECT_EQ(names[39], "cable 1 / deck");
  EXPECT_EQ(names.back(), "cable 6 / tool");
}

TEST(Pairs, OfAClassWithoutAClearanceAreNotChecked) {
  BodiesText bodies = scene();
  bodies.clearance_m[static_cast<std::size_t>(PairClass::kCablesObstacles)].reset();
  EXPECT_EQ(pairs(bodies).size(), 2U * 3 + 15 + 6 * 2);
  bodies.clearance_m = {};
  EXPECT_TRUE(pairs(bodies).empty());
}

TEST(Pairs, HaveTheirOwnClearanceElseTheirBodiesElseTheirClass) {
  BodiesText bodies = scene();
  bodies.platform[0].clearance_m = "0.4";
  bodies.pair_clearances_m = {{{"rock", "deck"}, "0.05"}, {{"cable 5", "cable 2"}, "0.001"}};
  validate(bodies);
  std::map<std::string, DecimalText> clearance;
  for (const BodyPair& pair : pairs(bodies)) clearance[name(bodies, pair)] = pair.clearance_m;
  EXPECT_EQ(clearance["tool / floor"], "0.2");
  EXPECT_EQ(clearance["tool / stack"], "0.3");
  EXPECT_EQ(clearance["deck / stack"], "0.4");  // the greater one of two
  EXPECT_EQ(clearance["deck / floor"], "0.4");
  EXPECT_EQ(clearance["deck / rock"], "0.05");
  EXPECT_EQ(clearance["cable 1 / stack"], "0.3");
  EXPECT_EQ(clearance["cable 1 / floor"], "0.1");
  EXPECT_EQ(clearance["cable 2 / cable 5"], "0.001");
  EXPECT_EQ(clearance["cable 1 / deck"], "0.4");
  EXPECT_EQ(clearance["cable 1 / tool"], "0.01");
}

ContactText contact(const std::array<std::string, 2>& pair, DecimalText within = "0.3", DecimalText depth = "0.005") {
  return {pair, {{"1", "2", "3"}, std::move(within), std::move(depth)}};
}

TEST(Pairs, HaveTheirZonesOfContact) {
  BodiesText bodies = scene();
  bodies.contacts = {contact({"floor", "deck"}), contact({"deck", "stack"}), contact({"deck", "floor"}, "0.1", "0.02")};
  validate(bodies);
  std::map<std::string, std::vector<ContactZoneText>> zones;
  for (const BodyPair& pair : pairs(bodies)) zones[name(bodies, pair)] = pair.zones;
  EXPECT_EQ(zones["deck / floor"], (std::vector{bodies.contacts[0].zone, bodies.contacts[2].zone}));
  EXPECT_EQ(zones["deck / stack"], std::vector{bodies.contacts[1].zone});
  EXPECT_TRUE(zones["tool / floor"].empty());
  EXPECT_TRUE(zones["cable 1 / floor"].empty());
}

TEST(Bodies, WithWrongContactsAreRejected) {
  const auto with = [](std::vector<ContactText> entries) { return [entries](BodiesText& b) { b.contacts = entries; }; };
  expect_refused(with({contact({"deck", "stock"})}), "bodies.contacts[0].pair[1]: got 'stock'");
  expect_refused(with({contact({"deck", "tool"})}), "expected two bodies that move");
  expect_refused(with({contact({"cable 1", "floor"})}), "bodies.contacts[0].pair: got 'cable 1' and 'floor'");
  expect_refused(with({contact({"cable 1", "deck"})}), "expected a body of the platform and an obstacle");
  expect_refused(with({contact({"deck", "floor"}), contact({"tool", "floor"})}),
                 "bodies.contacts[1].pair: got 'tool' and 'floor', expected a body of the platform and an obstacle, "
                 "neither of them a mesh");
  expect_refused(with({contact({"deck", "rock"})}), "neither of them a mesh");
  expect_refused(with({contact({"deck", "floor"}, "0")}), "bodies.contacts[0].within: got 0, expected a length > 0");
  expect_refused(with({contact({"deck", "floor"}, "nan")}), "bodies.contacts[0].within");
  expect_refused(with({contact({"deck", "floor"}, "1", "-0.1")}), "bodies.contacts[0].depth: got -0.1");
  expect_refused(with({contact({"deck", "floor"}), contact({"deck", "floor"})}), "the same contact twice");
  expect_refused(with({65, contact({"deck", "floor"})}), "bodies.contacts: got 65 contacts, expected at most 64");
  expect_refused(
      [](BodiesText& b) {
        (b.contacts = {contact({"deck", "floor"})})[0].zone.at_m[2] = "x";
      },
      "bodies.contacts[0].at[2]");
  expect_refused(
      [](BodiesText& b) {
        b.contacts = {contact({"deck", "floor"})};
        b.clearance_m[0].reset();
      },
      "the class 'platform-obstacles' is not");
}

ExitConeText cone(std::size_t cable, CableEnd end = CableEnd::kBase, ExpressionText half_angle = "(60)*pi/180") {
  return {cable, end, {"0", "0.5", "-1"}, std::move(half_angle)};
}

TEST(Pairs, OfExitConesAreTheLast) {
  BodiesText bodies = scene();
  const std::size_t others = pairs(bodies).size();
  bodies.exit_cones = {cone(4, CableEnd::kPlatform), cone(0)};
  validate(bodies);
  const std::vector<BodyPair> all = pairs(bodies);
  ASSERT_EQ(all.size(), others + 2);
  EXPECT_EQ(name(bodies, all[others]), "cable 5 / exit cone at the platform");
  EXPECT_EQ(name(bodies, all[others + 1]), "cable 1 / exit cone at the base");
  EXPECT_EQ(all.back().clearance_m, "0");
}

TEST(Bodies, WithWrongExitConesAreRejected) {
  const auto with = [](std::vector<ExitConeText> cones) { return [cones](BodiesText& b) { b.exit_cones = cones; }; };
  expect_refused(with({cone(6)}), "bodies.exit_cones[0].cable: got 7, expected a cable, 1 to 6");
  expect_refused(with({cone(1), cone(1, CableEnd::kPlatform), cone(1)}),
                 "bodies.exit_cones[2]: got a second exit cone of cable 2 at the base");
  for (const char* angle : {"0", "-1", "pi/2", "2", "1/0", "x", ""}) {
    expect_refused(with({cone(0, CableEnd::kBase, angle)}), "bodies.exit_cones[0].half_angle");
  }
  expect_refused(
      [](BodiesText& b) {
        (b.exit_cones = {cone(0)})[0].axis = {"0", "0", "0"};
      },
      "bodies.exit_cones[0].axis: got [0, 0, 0], expected a direction");
  expect_refused([](BodiesText& b) { (b.exit_cones = {cone(0)})[0].axis[1] = "1e9"; }, "below 1e9");
}

TEST(Bodies, WithWrongNamesAreRejected) {
  expect_refused([](BodiesText& b) { b.platform[1].name = "floor"; }, "bodies.obstacles[0].name: got 'floor' twice");
  expect_refused([](BodiesText& b) { b.platform[0].name = "cable 6"; }, "bodies.platform[0].name: got 'cable 6'");
  expect_refused([](BodiesText& b) { b.platform[0].name = ""; }, "expected a name");
  expect_refused([](BodiesText& b) { b.platform[0].name = "a\nb"; }, "expected a name");
  expect_refused([](BodiesText& b) { b.obstacles.resize(65, b.obstacles[0]); }, "got 65 bodies, expected at most 64");
  BodiesText other = scene();
  other.platform[0].name = "cable 7";  // there is none
  EXPECT_NO_THROW(validate(other));
}

TEST(Bodies, OfImpossibleShapesAreRejected) {
  const auto hull = [](BodiesText& b) -> HullText& { return std::get<HullText>(b.platform[0].shape); };
  const auto tool = [](BodiesText& b) -> MeshText& { return std::get<MeshText>(b.platform[1].shape); };
  expect_refused([&](BodiesText& b) { hull(b).points_m.clear(); }, "bodies.platform[deck].points: got 0 points");
  expect_refused([&](BodiesText& b) { hull(b).points_m.resize(1001, {"0", "0", "0"}); }, "expected 1 to 1000 points");
  expect_refused([&](BodiesText& b) { hull(b).points_m[0][2] = "nan"; }, "bodies.platform[deck].points[0][2]");
  expect_refused([&](BodiesText& b) { hull(b).points_m[0][2] = "1/3"; }, "bodies.platform[deck].points[0][2]");
  expect_refused([&](BodiesText& b) { hull(b).radius_m = "-0.1"; }, "bodies.platform[deck].radius: got -0.1");
  expect_refused(
      [](BodiesText& b) {
        b.obstacles[0].shape = HalfSpaceText{{"0", "0", "0"}};
      },
      "bodies.obstacles[floor].half_space.normal: got [0, 0, 0], expected a direction");
  expect_refused([](BodiesText& b) { b.obstacles[0].shape = HalfSpaceText{{"0", "1e9", "0"}}; }, "below 1e9");
  expect_refused([](BodiesText& b) { b.obstacles[0].rotation_rad[2] = "1"; }, "bodies.obstacles[floor].half_space");
  expect_refused(
      [](BodiesText& b) {
        b.platform[0].shape = HalfSpaceText{{"0", "0", "1"}};
      },
      "bodies.platform[deck]: got a half-space on the platform");
  expect_refused([&](BodiesText& b) { tool(b).file = ""; }, "bodies.platform[tool].mesh");
  expect_refused([&](BodiesText& b) { tool(b).sha256 = std::string(64, 'A'); }, "bodies.platform[tool].sha256");
  expect_refused([&](BodiesText& b) { tool(b).sha256.pop_back(); }, "expected 64 lower-case hex digits");
  expect_refused([&](BodiesText& b) { tool(b).unit_m = "0"; }, "bodies.platform[tool].unit: got 0");
}

TEST(Bodies, WithWrongNumbersAreRejected) {
  expect_refused([](BodiesText& b) { b.obstacles[1].clearance_m = "-1"; }, "bodies.obstacles[stack].clearance: got -1");
  expect_refused([](BodiesText& b) { b.obstacles[1].at_m[1] = "x"; }, "bodies.obstacles[stack].at[1]");
  expect_refused([](BodiesText& b) { b.obstacles[1].rotation_rad[1] = "phi"; }, "obstacles[stack].rotation.pitch");
  expect_refused([](BodiesText& b) { b.obstacles[1].rotation_rad[0] = "1/0"; }, "obstacles[stack].rotation.roll");
  expect_refused([](BodiesText& b) { b.cables.diameter_m[4] = "-0.01"; }, "bodies.cables.diameter[4]: got -0.01");
  expect_refused([](BodiesText& b) { b.cables.free_ends_m[5][1] = "-1"; }, "bodies.cables.free_ends[5][1]: got -1");
  expect_refused([](BodiesText& b) { b.clearance_m[2] = "-1"; }, "bodies.clearance.cables-cables: got -1");
}

TEST(Bodies, WithWrongPairsAreRejected) {
  const auto with = [](std::vector<PairClearanceText> entries) {
    return [entries](BodiesText& b) { b.pair_clearances_m = entries; };
  };
  expect_refused(with({{{"deck", "stock"}, "0"}}), "bodies.pair_clearances[0].pair[1]: got 'stock'");
  expect_refused(with({{{"deck", "tool"}, "0"}}), "got 'deck' and 'tool', expected two bodies that move");
  expect_refused(with({{{"floor", "stack"}, "0"}}), "expected two bodies that move");
  expect_refused(with({{{"cable 2", "cable 2"}, "0"}}), "expected two bodies that move");
  expect_refused(with({{{"deck", "stack"}, "-0.1"}}), "bodies.pair_clearances[0].clearance: got -0.1");
  expect_refused(with({{{"deck", "stack"}, "0.1"}, {{"stack", "deck"}, "0.2"}}),
                 "bodies.pair_clearances[1].pair: got 'stack' and 'deck' twice");
  expect_refused(
      [](BodiesText& b) {
        b.pair_clearances_m = {{{"deck", "stack"}, "0.1"}};
        b.clearance_m[0].reset();
      },
      "the class 'platform-obstacles' is not");
}

Problem with_bodies() {
  Problem problem = load_case(std::string(TAUT_SOURCE_DIR) + "/cases/robot1-slice-qs-qg.yaml").problem;
  problem.bodies = scene();
  problem.bodies->pair_clearances_m = {{{"rock", "deck"}, "0.05"}};
  problem.bodies->contacts = {contact({"floor", "deck"}), contact({"deck", "stack"})};
  problem.bodies->exit_cones = {cone(2), cone(2, CableEnd::kPlatform)};
  return problem;
}

TEST(BodiesJson, ReadsBackWhatItWrote) {
  const Problem problem = with_bodies();
  const json written = to_json(problem);
  EXPECT_EQ(problem_from_json(json::parse(written.dump())).bodies, problem.bodies);
  EXPECT_EQ(to_json(problem_from_json(written)), written);
  Problem without = problem;
  without.bodies.reset();
  EXPECT_FALSE(to_json(without).contains("bodies"));
}

TEST(BodiesJson, RejectsEachMissingUnknownOrMistypedMember) {
  const json good = to_json(with_bodies());
  const json leaves = good["bodies"].flatten();
  ASSERT_GT(leaves.size(), 40U);
  for (const auto& [pointer, leaf] : leaves.items()) {
    json bad = good;
    bad["bodies"][json::json_pointer(pointer)] = leaf.is_number() ? json("7") : json(7);
    EXPECT_THROW((void)problem_from_json(bad), InputError) << pointer;
  }
  const std::set<std::string> optional = {"contacts",         "exit_cones",    "pair_clearances_m",
                                          "rotation_rad",     "clearance_m",   "platform-obstacles",
                                          "cables-obstacles", "cables-cables", "cables-platform"};
  for (const char* place :
       {"", "/platform/0", "/platform/0/hull", "/platform/1", "/platform/1/mesh", "/obstacles/0",
        "/obstacles/0/half_space", "/cables", "/clearance_m", "/pair_clearances_m/0", "/contacts/1", "/exit_cones/0"}) {
    const json::json_pointer pointer("/bodies" + std::string(place));
    json extra = good;
    extra[pointer]["extra"] = "1";
    EXPECT_THROW((void)problem_from_json(extra), InputError) << place;
    for (const auto& [key, member] : good[pointer].items()) {
      if (optional.contains(key) && !(std::string(place).empty() && key == "clearance_m") &&
          std::string(place) != "/pair_clearances_m/0") {
        continue;
      }
      json bad = good;
      bad[pointer].erase(key);
      EXPECT_THROW((void)problem_from_json(bad), InputError) << place << "/" << key;
    }
  }
  json two_shapes = good;
  two_shapes["bodies"]["obstacles"][0]["hull"] = good["bodies"]["platform"][0]["hull"];
  EXPECT_THROW((void)problem_from_json(two_shapes), InputError);
  json no_pairs = good;
  no_pairs["bodies"]["pair_clearances_m"] = json::array();
  EXPECT_THROW((void)problem_from_json(no_pairs), InputError);
  json no_contacts = good;
  no_contacts["bodies"]["contacts"] = json::array();
  EXPECT_THROW((void)problem_from_json(no_contacts), InputError);
}

}  // namespace
}  // namespace taut
