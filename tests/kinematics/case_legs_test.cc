// SPDX-License-Identifier: GPL-3.0-or-later
// Cases of legs: each leg is a case of its own, and what is wrong has its place in the file.
#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <array>
#include <nlohmann/json.hpp>

#include "base/input_error.h"
#include "case/case_of_legs.h"

namespace taut {
namespace {

using ::testing::AllOf;
using ::testing::HasSubstr;
using ::testing::StartsWith;
using ::testing::ThrowsMessage;

const std::string kTime = "time: {winches: {speed: 1 m/s}}\n";

/// Items begin on line 12, legs on line 20.
struct LegSections {
  std::string items =
      "    - {name: platform, mass: 8}\n"
      "    - {name: payload, mass: 12, legs: [carry]}\n"
      "    - {name: wind, force: 2, direction: horizontal, legs: [fetch, return]}\n";
  std::string space = "space: {slice: {py: 0, phi: 0, theta: 0, sigma: 0}}\n\n\n";
  std::string legs =
      "    - {name: fetch, waypoints: [{px: 0, pz: 7}, {px: -4, pz: 6}]}\n"
      "    - {name: carry, waypoints: [{px: -4, pz: 6}, {px: 4, pz: 6}]}\n"
      "    - {name: return, waypoints: [{px: 4, pz: 6}, {px: 0, pz: 7}]}\n";
  std::string tail = "expect: {verdict: proved, duration: [1, 2]}\n";

  [[nodiscard]] std::string text() const {
    return "taut: 1\nname: crane\nunits: {force: kN, moment: kN*m, mass: t}\nrobot:\n"
           "  base_anchors: [[15, 10, 15], [15, 10, 15], [-15, 10, 15], [-15, 10, 15], [0, -10, 15], [0, -10, 15]]\n"
           "  platform_anchors: [[0, 1.5, 0], [1.3, -0.75, 0], [0, 1.5, 0], [-1.3, -0.75, 0], [1.3, -0.75, 0], "
           "[-1.3, -0.75, 0]]\n"
           "  tension: [2, 160]\n  length: [3, 35]\n"
           "load:\n  gravity: [0, 0, -9.81 m/s^2]\n  items:\n" +
           items + space + "query:\n  legs:\n" + legs + tail;
  }
};

CaseOfLegs parse(const LegSections& sections) { return parse_case_of_legs(sections.text(), "crane.yaml"); }

std::vector<std::string> names_of(const LoadText& load) {
  std::vector<std::string> names;
  for (const LoadItem& item : load.items) names.push_back(item.name);
  return names;
}

void expect_error(const LegSections& sections, const std::string& place, const std::string& what) {
  EXPECT_THAT([&] { (void)parse(sections); },
              ThrowsMessage<InputError>(AllOf(StartsWith("crane.yaml:" + place), HasSubstr(what))));
}

TEST(CaseLegs, AreCasesWithTheirItemsAndWaypoints) {
  const CaseOfLegs read = parse({});
  EXPECT_EQ(read.whole.problem.name, "crane");
  EXPECT_TRUE(read.whole.problem.query.empty());
  EXPECT_EQ(read.whole.expect, Expectation::kProved);
  EXPECT_EQ(read.whole.bounds.size(), 1U);
  ASSERT_EQ(read.legs.size(), 3U);
  EXPECT_EQ(read.legs[1].name, "carry");
  const Case& carry = read.legs[1].content;
  EXPECT_EQ(carry.problem.name, "crane, leg carry");
  EXPECT_EQ(carry.expect, Expectation::kNone);
  EXPECT_TRUE(carry.bounds.empty());
  EXPECT_EQ(carry.problem.query, (std::vector<std::vector<ExpressionText>>{{"-4", "6"}, {"4", "6"}}));
  EXPECT_EQ(names_of(carry.problem.load), (std::vector<std::string>{"platform", "payload"}));
  for (const std::size_t k : {0U, 2U}) {
    EXPECT_EQ(names_of(read.legs[k].content.problem.load), (std::vector<std::string>{"platform", "wind"}));
  }
}

TEST(CaseLegs, AreWhatACaseOfTheirOwnWouldSay) {
  const CaseOfLegs read = parse({});
  std::string text = LegSections().text();
  const auto replace = [&](const std::string& old, const std::string& by) {
    const std::size_t at = text.find(old);
    ASSERT_NE(at, std::string::npos) << old;
    text.replace(at, old.size(), by);
  };
  replace("name: crane\n", "name: \"crane, leg carry\"\n");
  replace(", legs: [carry]", "");
  replace("    - {name: wind, force: 2, direction: horizontal, legs: [fetch, return]}\n", "");
  const std::size_t legs = text.find("  legs:\n");
  text.replace(legs, text.find("expect") - legs, "  waypoints: [{px: -4, pz: 6}, {px: 4, pz: 6}]\n");
  EXPECT_EQ(to_json(read.legs[1].content.problem), to_json(parse_case(text, "alone.yaml").problem));
}

TEST(CaseLegs, AreRefusedByWhoeverDoesNotAllowThem) {
  EXPECT_THAT([] { (void)parse_case(LegSections().text(), "crane.yaml"); },
              ThrowsMessage<InputError>(AllOf(StartsWith("crane.yaml:"), HasSubstr("query.legs: got legs, expected "
                                                                                   "'waypoints'"))));
}

TEST(CaseLegs, OfUnknownOrDoubledNamesAreErrors) {
  LegSections s;
  s.items = "    - {name: platform, mass: 8, legs: [fetch, fly]}\n";
  expect_error(s, "12:", "expected one of the legs fetch, carry, return");
  s.items = "    - {name: platform, mass: 8, legs: [fetch, fetch]}\n";
  expect_error(s, "12:", "got 'fetch' twice");
  s.items = "    - {name: platform, mass: 8}\n    - {name: payload, mass: 12, legs: []}\n";
  expect_error(s, "13:", "got an item of no leg");
  s.items = "    - {name: platform, mass: 8, legs: [fetch, carry]}\n";
  expect_error(s, "20:", "got no item of the load in the leg 'return'");
  s = {};
  s.legs.replace(s.legs.find("name: return"), 12, "name: fetch");
  expect_error(s, "22:", "got 'fetch' twice");
  for (const char* name : {"a/b", "-a", "..", "''", "'a b'"}) {
    s = {};
    s.legs.replace(s.legs.find("name: return"), 12, std::string("name: ") + name);
    expect_error(s, "22:", "expected a name of 1 to 40 letters, digits");
  }
}

TEST(CaseLegs, ThatDoNotMeetAreErrors) {
  LegSections s;
  s.legs.replace(s.legs.find("[{px: -4, pz: 6}, {px: 4"), 16, "[{px: -4, pz: 5}");
  expect_error(s, "21:", "expected pz as the leg before it ends");
  s = {};
  s.legs.replace(s.legs.find("[{px: -4, pz: 6}, {px: 4"), 16, "[{px: -400 cm, pz: 6.0}");
  EXPECT_EQ(parse(s).legs.size(), 3U);
  s = {};
  s.legs = "    - {name: fetch, waypoints: [{px: 0, pz: 7}, {px: -4, pz: 6}]}\n";
  expect_error(s, "20:", "expected a list of 2 to 64 legs");
  s.legs = "    - {name: fetch, waypoints: [{px: 0, pz: 7}]}\n    - {name: carry, waypoints: []}\n";
  expect_error(s, "20:", "expected a list of at least two waypoints");
}

TEST(CaseLegs, HaveTheirErrorsWhereTheyAreInTheFile) {
  LegSections s;
  s.items.replace(s.items.find("mass: 12"), 8, "mass: -1");
  expect_error(s, "13:", "expected a mass above zero");
  s = {};
  s.legs.replace(s.legs.find("{px: 4, pz: 6}]"), 14, "{px: 4, py: 6}");
  expect_error(s, "21:", "py");
}

TEST(CaseLegs, WithoutAnyMassHaveNoMoves) {
  LegSections s;
  s.items =
      "    - {name: weight, force: [70, 80], direction: [0, 0, -1], legs: [fetch, return]}\n"
      "    - {name: payload, mass: 12, legs: [carry]}\n";
  EXPECT_EQ(parse(s).legs.size(), 3U);
  s.tail += kTime;
  expect_error(s, "", "mass");
}

TEST(CaseLegs, DoNotGoWithWhatHasNoLegsYet) {
  LegSections s;
  s.tail += "audit: {path: a.csv}\n";
  expect_error(s, "24:", "beside 'query.legs', expected none");
  s = {};
  s.space = "space: {slice: {py: 0, phi: 0, theta: 0, sigma: 0}, implicit: [px]}\n\n\n";
  expect_error(s, "15:", "got constraints beside 'query.legs'");
  s = {};
  s.tail += "query: {waypoints: []}\n";
  EXPECT_THROW((void)parse(s), InputError);
}

// ---- Bodies ---------------------------------------------------------------------------------------------------------

/// Bodies begin on line 24, those of the platform on line 30, obstacles on line 33.
struct BodySections : LegSections {
  std::string clearance = "  clearance: {default: 200 mm, cables-cables: 20 mm}\n";
  std::string more = "  pairs: [platform-obstacles, cables-obstacles, cables-cables]\n\n";
  std::string platform =
      "    - {name: spreader, box: [2, 2, 1], legs: [fetch, return]}\n"
      "    - {name: crate, box: [2, 2, 2], legs: [carry]}\n";
  std::string obstacles =
      "    - {name: floor, half_space: {point: [0, 0, 0], normal: [0, 0, 1]}}\n"
      "    - {name: crate before, box: [2, 2, 2], at: [-4, 0, 1], legs: [fetch]}\n"
      "    - {name: crate after, box: [2, 2, 2], at: [4, 0, 1], legs: [return]}\n";
  std::string end =
      "  contacts: [{pair: [crate, floor], at: [-4, 0, 6], within: 0.3, depth: 0.1}]\n"
      "  pair_clearances: [{pair: [spreader, crate before], clearance: 0.1}, {pair: [crate, floor], clearance: 0.3}]\n";

  [[nodiscard]] LegSections whole() const {
    LegSections result = *this;
    result.tail += "bodies:\n" + clearance + "  cables: {diameter: 0.02, free_ends: 0.3}\n" + more + "  platform:\n" +
                   platform + "  obstacles:\n" + obstacles + end;
    return result;
  }
};

std::vector<std::string> names_of(const std::vector<BodyText>& bodies) {
  std::vector<std::string> names;
  for (const BodyText& body : bodies) names.push_back(body.name);
  return names;
}

using Names = std::vector<std::string>;

TEST(CaseLegs, HaveTheBodiesThatAreThere) {
  const CaseOfLegs read = parse(BodySections().whole());
  const auto bodies = [&](std::size_t k) { return read.legs.at(k).content.problem.bodies.value(); };
  EXPECT_EQ(names_of(bodies(0).platform), Names{"spreader"});
  EXPECT_EQ(names_of(bodies(0).obstacles), (Names{"floor", "crate before"}));
  EXPECT_EQ(names_of(bodies(1).platform), Names{"crate"});
  EXPECT_EQ(names_of(bodies(1).obstacles), Names{"floor"});
  EXPECT_EQ(names_of(bodies(2).platform), Names{"spreader"});
  EXPECT_EQ(names_of(bodies(2).obstacles), (Names{"floor", "crate after"}));
  const auto zones = [&](std::size_t k) { return bodies(k).contacts.size(); };
  EXPECT_EQ((std::array{zones(0), zones(1), zones(2)}), (std::array<std::size_t, 3>{0, 1, 0}));
  const auto own = [&](std::size_t k) { return bodies(k).pair_clearances_m; };
  ASSERT_EQ(own(0).size(), 1U);
  EXPECT_EQ(own(0)[0].clearance_m, "0.1");
  ASSERT_EQ(own(1).size(), 1U);
  EXPECT_EQ(own(1)[0].clearance_m, "0.3");
  EXPECT_TRUE(own(2).empty());
  for (std::size_t k = 0; k < 3; ++k) {
    EXPECT_EQ(bodies(k).cables, bodies(0).cables);
    EXPECT_EQ(bodies(k).clearance_m, bodies(0).clearance_m);
  }
}

TEST(CaseLegs, CheckOnlyPairsThatAreThere) {
  BodySections s;
  s.platform = "    - {name: crate, box: [2, 2, 2], legs: [carry]}\n\n";
  s.clearance = "  clearance: {platform-obstacles: 0.2, cables-obstacles: 0.3, cables-cables: 0.02}\n";
  s.end = "";
  for (const char* more : {"  pairs: [platform-obstacles, cables-obstacles, cables-cables]\n\n", "\n\n"}) {
    s.more = more;
    s.clearance = *more == '\n' ? "  clearance: {default: 0.3, platform-obstacles: 0.2}\n" : s.clearance;
    const CaseOfLegs read = parse(s.whole());
    const auto is_checked = [&](std::size_t k) {
      return read.legs.at(k).content.problem.bodies->clearance_m[0].has_value();
    };
    EXPECT_EQ((std::array{is_checked(0), is_checked(1), is_checked(2)}), (std::array{false, true, false})) << more;
    EXPECT_EQ(read.legs[1].content.problem.bodies->clearance_m[0], "0.2");
    EXPECT_TRUE(read.legs[0].content.problem.bodies->clearance_m[1]);
  }
}

TEST(CaseLegs, WithoutAnythingThatCouldTouchHaveNoBodies) {
  BodySections s;
  s.platform = "    - {name: crate, box: [2, 2, 2], legs: [carry]}\n\n";
  s.end = "";
  s.more = "  pairs: [platform-obstacles]\n\n";
  s.clearance = "  clearance: {platform-obstacles: 0.2}\n";
  const CaseOfLegs read = parse(s.whole());
  EXPECT_FALSE(read.legs[0].content.problem.bodies);
  EXPECT_FALSE(read.legs[0].content.bodies);
  EXPECT_TRUE(read.legs[1].content.problem.bodies);
  EXPECT_FALSE(read.legs[2].content.problem.bodies);
  ASSERT_EQ(read.whole.warnings.size(), 2U);
  EXPECT_THAT(read.whole.warnings[0], HasSubstr("bodies: no two bodies of the leg 'fetch' could touch"));
  s.end = "  exit_cones: [{cable: 1, end: base, axis: [0, 0, -1], half_angle: 80 deg}]\n";
  for (const CaseLeg& leg : parse(s.whole()).legs) {
    EXPECT_EQ(leg.content.problem.bodies.value().exit_cones.size(), 1U) << leg.name;
    EXPECT_EQ(leg.content.problem.bodies->clearance_m[0].has_value(), leg.name == "carry");
  }
}

TEST(CaseLegs, WithWrongBodiesAreErrors) {
  const auto replaced = [](std::string BodySections::*section, const std::string& old, const std::string& by) {
    BodySections s;
    std::string& text = s.*section;
    text.replace(text.find(old), old.size(), by);
    return s.whole();
  };
  expect_error(replaced(&BodySections::platform, "legs: [carry]", "legs: [fly]"),
               "31:", "one of the legs fetch, carry");
  expect_error(replaced(&BodySections::platform, "legs: [carry]", "legs: []"), "31:", "got a body of no leg");
  expect_error(replaced(&BodySections::obstacles, "crate after", "crate before"), "35:", "got 'crate before' twice");
  expect_error(replaced(&BodySections::obstacles, "crate before", "crate"), "34:", "got 'crate' twice");
  expect_error(replaced(&BodySections::end, "[crate, floor], at", "[crate, crate before], at"),
               "36:", "no leg has both");
  expect_error(replaced(&BodySections::end, "[crate, floor], at", "[crate, flor], at"), "36:", "'flor'");
  expect_error(replaced(&BodySections::platform, "box: [2, 2, 2]", "box: [2, 2]"), "31:", "three sides");
  BodySections s;
  s.platform = "    - {name: crate, box: [2, 2, 2], legs: [carry]}\n\n";
  s.obstacles = "    - {name: crate before, box: [2, 2, 2], at: [-4, 0, 1], legs: [fetch]}\n";
  s.end = "";
  expect_error(s.whole(), "27:", "expected bodies of both kinds");  // in no leg
}

}  // namespace
}  // namespace taut
