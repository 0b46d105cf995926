// SPDX-License-Identifier: GPL-3.0-or-later
// Cases of legs: each leg is a case of its own, and what is wrong has its place in the file.
#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

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
struct Sections {
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

CaseOfLegs parse(const Sections& sections) { return parse_case_of_legs(sections.text(), "crane.yaml"); }

std::vector<std::string> names_of(const LoadText& load) {
  std::vector<std::string> names;
  for (const LoadItem& item : load.items) names.push_back(item.name);
  return names;
}

void expect_error(const Sections& sections, const std::string& place, const std::string& what) {
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
  std::string text = Sections().text();
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
  EXPECT_THAT([] { (void)parse_case(Sections().text(), "crane.yaml"); },
              ThrowsMessage<InputError>(AllOf(StartsWith("crane.yaml:"), HasSubstr("query.legs: got legs, expected "
                                                                                   "'waypoints'"))));
}

TEST(CaseLegs, OfUnknownOrDoubledNamesAreErrors) {
  Sections s;
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
  Sections s;
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
  Sections s;
  s.items.replace(s.items.find("mass: 12"), 8, "mass: -1");
  expect_error(s, "13:", "expected a mass above zero");
  s = {};
  s.legs.replace(s.legs.find("{px: 4, pz: 6}]"), 14, "{px: 4, py: 6}");
  expect_error(s, "21:", "py");
}

TEST(CaseLegs, WithoutAnyMassHaveNoMoves) {
  Sections s;
  s.items =
      "    - {name: weight, force: [70, 80], direction: [0, 0, -1], legs: [fetch, return]}\n"
      "    - {name: payload, mass: 12, legs: [carry]}\n";
  EXPECT_EQ(parse(s).legs.size(), 3U);
  s.tail += kTime;
  expect_error(s, "", "mass");
}

TEST(CaseLegs, DoNotGoWithWhatHasNoLegsYet) {
  for (const char* tail : {"bodies: {clearance: 1}\n", "audit: {path: a.csv}\n"}) {
    Sections s;
    s.tail += tail;
    expect_error(s, "24:", "beside 'query.legs', expected none");
  }
  Sections s;
  s.space = "space: {slice: {py: 0, phi: 0, theta: 0, sigma: 0}, implicit: [px]}\n\n\n";
  expect_error(s, "15:", "got constraints beside 'query.legs'");
  s = {};
  s.tail += "query: {waypoints: []}\n";
  EXPECT_THROW((void)parse(s), InputError);
}

}  // namespace
}  // namespace taut
