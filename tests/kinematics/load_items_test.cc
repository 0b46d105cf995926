// SPDX-License-Identifier: GPL-3.0-or-later
// Loads that consist of items: what cases say, and what comes of it, exactly.
#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <rapidcheck/gtest.h>

#include <nlohmann/json.hpp>

#include "base/input_error.h"
#include "case/case_file.h"
#include "problem/load.h"
#include "problem/rational.h"

namespace taut {
namespace {

using ::testing::AllOf;
using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::StartsWith;
using ::testing::ThrowsMessage;

constexpr const char* kUnits = "units: {length: m, force: kN, moment: kN*m, mass: t, angle: deg, time: s}\n";

/// A portal crane whose load, from line 7 on, is `load`.
std::string loaded_crane(const std::string& load, const std::string& rest = "") {
  return std::string("taut: 1\nname: crane\n") + kUnits +
         "robot:\n"
         "  {base_anchors: [[15, 10, 15], [15, 10, 15], [-15, 10, 15], [-15, 10, 15], [0, -10, 15], [0, -10, 15]], "
         "platform_anchors: [[0, 1.5, 0], [1.3, -0.75, 0], [0, 1.5, 0], [-1.3, -0.75, 0], [1.3, -0.75, 0], "
         "[-1.3, -0.75, 0]],\n   tension: [2, 160], length: [3, 35]}\n" +
         load + rest;
}

const std::string kGravity = "load:\n  gravity: [0, 0, -9.81 m/s^2]\n  items:\n";
const std::string kPlatform = "    - {name: platform, mass: 8}\n";

LoadText load_of(const std::string& items) {
  return parse_case(loaded_crane(kGravity + items), "crane.yaml").problem.load;
}
LoadText read_with_platform(const std::string& item) { return load_of(kPlatform + "    - " + item + "\n"); }

template <class What>
const What& get(const LoadText& load, std::size_t k) {
  return std::get<What>(load.items.at(k).what);
}

TEST(LoadItems, OfTheExampleCraneAreExact) {
  const LoadText load = load_of(
      "    - {name: platform, mass: 8, at: [0, 0, 0]}\n"
      "    - {name: payload, mass: 12, mass_tolerance: 2 %, at: [0, 0, -1.2], at_tolerance: 50 mm}\n"
      "    - {name: wind, force: 6, direction: horizontal, at: [0, 0, -1]}\n");
  EXPECT_THAT(load.gravity_m_s2, ElementsAre("0", "0", "-9.81"));
  ASSERT_EQ(load.items.size(), 3U);
  EXPECT_EQ(get<Weight>(load, 0), (Weight{"8000", "8000", {"0", "0", "0"}, "0"}));
  EXPECT_EQ(load.items[1].name, "payload");
  EXPECT_EQ(get<Weight>(load, 1), (Weight{"11760", "12240", {"0", "0", "-1.2"}, "0.05"}));
  EXPECT_EQ(get<Force>(load, 2), (Force{DiscOfVectors{"6000", {"0", "0", "-9.81"}}, Axes::kWorld, {"0", "0", "-1"}}));
  EXPECT_FALSE(load.ellipsoid);
}

TEST(LoadItems, HaveMassesByToleranceOrByRange) {
  EXPECT_EQ(get<Weight>(load_of("    - {name: a, mass: 12 t, mass_tolerance: 240 kg}\n"), 0).mass_lower, "11760");
  EXPECT_EQ(get<Weight>(load_of("    - {name: a, mass: [0, 1/3]}\n"), 0).mass_upper, "1000/3");
  EXPECT_EQ(get<Weight>(load_of("    - {name: a, mass: 1/6^2 t}\n"), 0).mass_lower, "250/9");
}

TEST(LoadItems, ActAtTheLoadPointUnlessTheySayWhere) {
  const LoadText load =
      parse_case(
          loaded_crane("load:\n  point: [0, 0, -0.5]\n  gravity: [0, 0, -9.81]\n  items: [{name: a, mass: 1}]\n"), "c")
          .problem.load;
  EXPECT_THAT(get<Weight>(load, 0).at, ElementsAre("0", "0", "-0.5"));
}

TEST(LoadItems, AreForcesOfEveryShape) {
  EXPECT_EQ(get<Force>(read_with_platform("{name: f, force: 0.1, direction: any, axes: P}"), 1),
            (Force{BallOfVectors{"100"}, Axes::kPlatform, {"0", "0", "0"}}));
  EXPECT_EQ(get<Force>(read_with_platform("{name: f, force: 2, direction: [1, 1/3, 0]}"), 1).set,
            VectorSet(SegmentOfVectors{{"1", "1/3", "0"}, "0", "2000"}));
  EXPECT_EQ(get<Force>(read_with_platform("{name: f, force: [-1, 20 N], direction: [0, 0, -1]}"), 1).set,
            VectorSet(SegmentOfVectors{{"0", "0", "-1"}, "-1000", "20"}));
  EXPECT_EQ(get<Moment>(read_with_platform("{name: m, moment: 2, direction: [0, 0, 1]}"), 1),
            (Moment{SegmentOfVectors{{"0", "0", "1"}, "0", "2000"}, Axes::kWorld}));
}

TEST(LoadItems, OfABoxAreThreeSegments) {
  const LoadText load =
      read_with_platform("{name: tool, force_box: [[-1, 1], [0, 0], [0, 2]], axes: P, at: [0, 0, -2]}");
  ASSERT_EQ(load.items.size(), 3U);  // nothing acts along y
  EXPECT_EQ(load.items[1].name, "tool x");
  EXPECT_EQ(get<Force>(load, 2),
            (Force{SegmentOfVectors{{"0", "0", "1"}, "0", "2000"}, Axes::kPlatform, {"0", "0", "-2"}}));
}

TEST(LoadItems, OfWindAreItsPressureOnTheArea) {
  const LoadText load = read_with_platform("{name: gust, wind: {drag_area: 12 m^2, speed: 20 m/s}}");
  EXPECT_EQ(get<Force>(load, 1).set, VectorSet(DiscOfVectors{"3000", {"0", "0", "-9.81"}}));  // 1.25/2 · 12 · 400
  const LoadText thin =
      read_with_platform("{name: gust, wind: {drag_area: 12, speed: 20, air_density: 1.2 kg/m^3}, at_tolerance: 0.1}");
  EXPECT_EQ(std::get<DiscOfVectors>(get<Force>(thin, 1).set).radius, "2880");
  EXPECT_EQ(thin.items[2].name, "gust, moment");
  EXPECT_EQ(get<Moment>(thin, 2), (Moment{BallOfVectors{"288"}, Axes::kWorld}));
  const LoadText fast = read_with_platform("{name: gust, wind: {drag_area: 12 m^2, speed: 72 km/h}}");
  EXPECT_EQ(get<Force>(fast, 1), get<Force>(load, 1));
  const LoadText odd = read_with_platform("{name: gust, wind: {drag_area: 1 m^2, speed: 50 km/h}}");
  EXPECT_EQ(std::get<DiscOfVectors>(get<Force>(odd, 1).set).radius, "78125/648");  // 1.25/2 · (500/36)²
}

TEST(LoadItems, OfAnAccelerationActOnEveryMassWhereverItStands) {
  const LoadText load = load_of(
      "    - {name: swing, acceleration: 0.2 m/s^2}\n"
      "    - {name: platform, mass: 8}\n"
      "    - {name: payload, mass: 12, mass_tolerance: 2 %, at: [0, 0, -1.2], at_tolerance: 50 mm}\n");
  ASSERT_EQ(load.items.size(), 5U);
  EXPECT_EQ(load.items[2].name, "swing of platform");
  EXPECT_EQ(get<Force>(load, 2).set, VectorSet(BallOfVectors{"1600"}));
  EXPECT_EQ(load.items[3].name, "swing of payload");
  EXPECT_EQ(get<Force>(load, 3), (Force{BallOfVectors{"2448"}, Axes::kWorld, {"0", "0", "-1.2"}}));
  EXPECT_EQ(get<Moment>(load, 4), (Moment{BallOfVectors{"122.4"}, Axes::kWorld}));
}

TEST(LoadItems, AreLoadCases) {
  const LoadText load =
      read_with_platform("{name: cases, wrenches: [[0, 0, -1, 0, 0, 0], [1, 0, -1, 0, 0, 2 N*m]], axes: P}");
  const LoadCases& cases = get<LoadCases>(load, 1);
  ASSERT_EQ(cases.wrenches.size(), 2U);
  EXPECT_THAT(cases.wrenches[1], ElementsAre("1000", "0", "-1000", "0", "0", "2"));
  EXPECT_EQ(cases.axes, Axes::kPlatform);
  EXPECT_EQ(get<LoadCases>(read_with_platform("{name: hook, wrench: [0, 0, -1, 0, 0, 0]}"), 1).wrenches.size(), 1U);
}

TEST(LoadItems, OfAForceInOneDirectionMakeNoMomentAboutIt) {
  const LoadText load =
      read_with_platform("{name: hook, force: [60, 60], direction: [0, 0, -2], axes: P, at_tolerance: 0.5}");
  const auto& moment = get<Moment>(load, 2);
  const auto& disc = std::get<DiscOfVectors>(moment.set);
  EXPECT_EQ(disc.radius, "30000");
  EXPECT_THAT(disc.normal, ElementsAre("0", "0", "-2"));
  EXPECT_EQ(moment.axes, Axes::kPlatform);
}

TEST(LoadItems, MayIncludeOneEllipsoid) {
  const LoadText load = read_with_platform(
      "{name: paper, wrench: [0, 0, -1, 0, 0, 0], ellipsoid: {semi_axes: [6, 1/7, 100 N, 0.02, 0.02, 0.02]}}");
  ASSERT_TRUE(load.ellipsoid);
  EXPECT_THAT(load.wrench, ElementsAre("0", "0", "-1000", "0", "0", "0"));
  EXPECT_EQ((*load.ellipsoid)[0][0], "1/36000000");
  EXPECT_EQ((*load.ellipsoid)[1][1], "0.000049");
  EXPECT_EQ((*load.ellipsoid)[2][2], "0.0001");
  EXPECT_EQ(load.items.size(), 1U);
}

TEST(LoadItems, AreReadBackFromTheirJson) {
  const Problem problem =
      parse_case(
          loaded_crane(kGravity +
                       "    - {name: platform, mass: [8, 25/3], at_tolerance: 1 cm}\n"
                       "    - {name: wind, force: 6, direction: horizontal}\n"
                       "    - {name: any, moment: 1, direction: any, axes: P}\n"
                       "    - {name: tool, force_box: [[-1, 1], [-1, 1], [0, 2]], axes: P}\n"
                       "    - {name: cases, wrenches: [[0, 0, -1, 0, 0, 0], [1, 0, -1, 0, 0, 2]]}\n"
                       "    - {name: e, wrench: [0, 0, -1, 0, 0, 0], ellipsoid: {semi_axes: [3, 3, 3, 1, 1, 1]}}\n"),
          "crane.yaml")
          .problem;
  const nlohmann::json written = to_json(problem);
  const Problem again = problem_from_json(written);
  EXPECT_EQ(to_json(again), written);
  EXPECT_EQ(again.load.items, problem.load.items);
  EXPECT_EQ(written["load"]["items"][1],
            (nlohmann::json{{"name", "wind"},
                            {"force",
                             {{"disc", {{"radius", "6000"}, {"normal", {"0", "0", "-9.81"}}}},
                              {"axes", "W"},
                              {"at_m", {"0", "0", "0"}}}}}));
  // Every member is needed and typed, and no other is allowed.
  const nlohmann::json leaves = written["load"].flatten();
  for (const auto& [pointer, leaf] : leaves.items()) {
    nlohmann::json bad = written;
    bad["load"][nlohmann::json::json_pointer(pointer)] = 7;
    EXPECT_THROW((void)problem_from_json(bad), InputError) << pointer;
  }
  for (std::size_t k = 0; k < problem.load.items.size(); ++k) {
    nlohmann::json extra = written;
    extra["load"]["items"][k]["more"] = "1";
    EXPECT_THROW((void)problem_from_json(extra), InputError) << k;
    for (const auto& [kind, content] : written["load"]["items"][k].items()) {
      nlohmann::json bad = written;
      bad["load"]["items"][k].erase(kind);
      EXPECT_THROW((void)problem_from_json(bad), InputError) << k << kind;
    }
  }
}

TEST(LoadItems, OfEveryKindMakeOneLoad) {
  const Case every_kind = load_case(std::string(TAUT_SOURCE_DIR) + "/tests/fuzz/seeds/load_items.yaml");
  const LoadText& load = every_kind.problem.load;
  std::vector<std::string> names;
  for (const LoadItem& item : load.items) names.push_back(item.name);
  EXPECT_THAT(names, ElementsAre("platform", "payload", "hook", "wind", "wind, moment", "gust", "push", "any", "tool x",
                                 "tool y", "tool z", "tool, moment", "slewing", "twist x", "twist z", "cases", "one",
                                 "swing of platform", "swing of payload", "swing of payload, moment", "swing of hook"));
  // A force that is off by 1 cm, the diagonal of the box: sqrt(1 + 1 + 4) kN, rounded up.
  const Rational radius = parse_rational(std::get<BallOfVectors>(get<Moment>(load, 11).set).radius);
  EXPECT_GE(radius * radius, 600);
  EXPECT_LE(radius * radius, Rational(600) * (1 + Rational(1, 100'000'000'000)));
  EXPECT_THAT(every_kind.warnings,
              ElementsAre(HasSubstr("load.items[payload].inertia: is not used"),
                          HasSubstr("load.items[swing].acceleration: accelerates the items with a mass")));
  EXPECT_EQ(problem_from_json(to_json(every_kind.problem)).load.items, load.items);
}

TEST(LoadItems, LeaveTheJsonOfOtherLoadsAsItWas) {
  const Problem problem =
      parse_case(loaded_crane("load: {wrench: [0, 0, -1, 0, 0, 0], ellipsoid: {diagonal: [4, 4, 4, 4, 4, 4]}}\n"), "c")
          .problem;
  const nlohmann::json load = to_json(problem)["load"];
  EXPECT_EQ(load.size(), 3U);
  EXPECT_EQ(load["ellipsoid"][0].dump(), R"(["0.000004","0","0","0","0","0"])");
}

/// An exact product of what was typed, by an independent route: rationals of the digits.
RC_GTEST_PROP(LoadItems, ConvertExactly, ()) {
  const long whole = *rc::gen::inRange<long>(1, 1'000'000);
  const long below = *rc::gen::inRange<long>(1, 1'000);
  const long percent = *rc::gen::inRange<long>(0, 101);
  const LoadText load =
      load_of(fmt::format("    - {{name: a, mass: {}/{} kg, mass_tolerance: {} %}}\n", whole, below, percent));
  const Rational mass(whole, below);
  const Rational deviation = mass * Rational(percent, 100);
  RC_ASSERT(parse_rational(get<Weight>(load, 0).mass_lower) == mass - deviation);
  RC_ASSERT(parse_rational(get<Weight>(load, 0).mass_upper) == mass + deviation);
  const LoadText wind = read_with_platform(
      fmt::format("{{name: w, wind: {{drag_area: {} cm^2, speed: {}/{} m/s}}}}", whole, whole, below));
  const Rational speed(whole, below);
  RC_ASSERT(parse_rational(std::get<DiscOfVectors>(get<Force>(wind, 1).set).radius) ==
            Rational(5, 8) * Rational(whole, 10'000) * speed * speed);
}

void expect_load_rejected(const std::string& text, const std::string& message) {
  EXPECT_THAT([&] { (void)parse_case(text, "crane.yaml"); },
              ThrowsMessage<InputError>(AllOf(StartsWith("crane.yaml"), HasSubstr(message))))
      << text;
}

TEST(LoadItems, AreRefusedWithPlaceNameAndValue) {
  const std::vector<std::pair<std::string, std::string>> mistakes = {
      {"{name: a, mass: -3}", "crane.yaml:11:23: load.items[a].mass: got '-3', expected a mass above zero"},
      {"{name: a, mass: 3, mass_tolerance: 4}",
       "crane.yaml:11:42: load.items[a].mass_tolerance: got '4', expected a tolerance from 0 to the mass itself, which "
       "is '3'"},
      {"{name: a, mass: 3, mass_tolerance: 101 %}", "expected a tolerance from 0 to the mass itself"},
      {"{name: a, mass: [3, 2]}", "load.items[a].mass: got [3, 2], expected 0 <= lower <= upper"},
      {"{name: a, mass: [2, 3], mass_tolerance: 1}", "got a tolerance of a range of masses"},
      {"{name: a, mass: 3, at_tolerance: -1}", "load.items[a].at_tolerance: got '-1', expected a tolerance >= 0"},
      {"{name: a, mass: 3 kN}", "load.items[a].mass: got '3 kN', expected a mass: a number or an expression"},
      // What no machine has, and what could not be said in another unit.
      {"{name: a, force: 1e-299 kN, direction: any}",
       "crane.yaml:11:24: load.items[a].force: got '1e-299 kN', expected zero or a magnitude between 1e-100 and 1e100 "
       "N"},
      {"{name: a, mass: 1e99 t}", "got '1e99 t', expected zero or a magnitude between 1e-100 and 1e100 kg"},
      {"{name: a, mass: 1e308 t}", "load.items[a].mass: expression '1e308', column 1: got '1e308', expected zero or a"},
      {"{name: a, mass: 1e-400}",
       "load.items[a].mass: expression '1e-400', column 1: got '1e-400', expected zero or a"},
      {"{name: a, force: 1e400, direction: any}", "load.items[a].force: expression '1e400', column 1: got '1e400'"},
      {"{name: a, mass: 3 tonnes}", "bare (t) or with one of the units kg, g, t"},
      {"{name: a, mass: sqrt(4)}", "load.items[a].mass: got 'sqrt(4)', expected a mass"},
      {"{name: a, mass: 1/0}", "load.items[a].mass: got '1/0', expected no division by zero"},
      {"{name: a, mas: 3}", "did you mean 'mass'?"},
      {"{name: a}", "load.items[a]: got no load in one item, expected exactly one of mass, force,"},
      {"{name: a, mass: 3, force: 2}", "load.items[a]: got mass, force in one item, expected exactly one"},
      {"{name: a, mass: 3, direction: any}",
       "got 'direction' beside 'mass', expected nothing there but mass_tolerance"},
      {"{name: platform, mass: 3}", "load.items[1].name: got 'platform' twice"},
      {"{mass: 3}", "load.items[1]: got no 'name'"},
      {"{name: a, force: 3}", "load.items[a]: got no 'direction'"},
      {"{name: a, force: -3, direction: any}", "got '-3', expected a force above zero; its direction says"},
      {"{name: a, force: 3, direction: up}", "got 'up', expected 'any', 'horizontal', or a vector"},
      {"{name: a, force: 3, direction: [0, 0, 0]}", "got [0, 0, 0], expected a direction other than zero"},
      {"{name: a, force: 3, direction: horizontal, axes: P}", "expected 'any' or a vector where axes are P"},
      {"{name: a, force: [1, 2], direction: any}", "got 'any', expected a vector, as the force is a range"},
      {"{name: a, force: [2, 1], direction: [0, 0, 1]}", "got [2, 1], expected lower <= upper"},
      {"{name: a, force_box: [[0, 0], [0, 0], [0, 0]]}", "expected a box that contains more than zero"},
      {"{name: a, force_box: [[1, 0], [0, 0], [0, 0]]}", "got [1, 0], expected lower <= upper"},
      {"{name: a, wind: {drag_area: 12 m, speed: 20}}", "got '12 m', expected an area: a number"},
      {"{name: a, wind: {drag_area: 12, speed: 0}}", "got '0', expected a speed above zero"},
      {"{name: a, wind: {drag_area: 12, speed: 40 kn}}", "or with one of the units m/s, cm/s, mm/s, km/h"},
      {"{name: a, wind: {drag_area: 12, speed: -20}}", "got '-20', expected a speed above zero"},
      {"{name: a, wind: {drag_area: -12, speed: 20}}", "got '-12', expected an area above zero"},
      {"{name: a, mass: [-1, 2]}", "load.items[a].mass: got [-1, 2], expected 0 <= lower <= upper"},
      {"{name: a, mass: 0}", "load.items[a].mass: got '0', expected a mass above zero"},
      {"{name: a, mass: 3, mass_tolerance: -1}", "got '-1', expected a tolerance from 0 to the mass itself"},
      {"{name: a, mass: 3, wind: {drag_area: 12, speed: 20}}", "got mass, wind in one item, expected exactly one"},
      {"{name: a, wrenches: []}", "expected a list of 1 to 64 wrenches"},
      {"{name: a, wrench: [0, 0, 1, 0, 0, 0], ellipsoid: {semi_axes: [1, 1, 0, 1, 1, 1]}}",
       "got '0', expected a force above zero"},
      {"{name: a, wrench: [0, 0, -1, 0, 0, 0], ellipsoid: {diagonal: [1, 1, -1, 1, 1, 1]}}", "positive definite"},
      {"{name: up, force: [200, 300], direction: [0, 0, 1]}", "expected a downward load"},
      {"{name: " + std::string(101, 'a') + ", mass: 3}", "expected a name of 1 to 100 characters"},
  };
  for (const auto& [item, message] : mistakes) {
    expect_load_rejected(loaded_crane(kGravity + kPlatform + "    - " + item + "\n"), message);
  }
}

TEST(LoadItems, AreRefusedWhereTheWholeIsNoLoad) {
  expect_load_rejected(loaded_crane("load: {items: [{name: a, mass: 3}]}\n"), "expected gravity, such as");
  expect_load_rejected(loaded_crane("load: {items: [{name: wind, force: 6, direction: horizontal}]}\n"),
                       "got a load whose nominal force is zero, expected a weight");
  expect_load_rejected(
      loaded_crane("load: {gravity: [0, 0, -9.81], items: [{name: wind, force: 6, direction: horizontal}]}\n"),
      "got a load whose nominal force is zero");
  expect_load_rejected(loaded_crane("load: {gravity: [0, 0, -9.81], items: [{name: s, acceleration: 1}]}\n"),
                       "no item with a mass");
  expect_load_rejected(loaded_crane("load: {gravity: [0, 0, -9.81], mass: 3, items: [{name: a, mass: 3}]}\n"),
                       "beside 'items'");
  const std::string sphere = "ellipsoid: {semi_axes: [1, 1, 1, 1, 1, 1]}";
  expect_load_rejected(loaded_crane("load: {wrench: [0, 0, 0, 0, 0, 0], " + sphere + "}\n"),
                       "load.wrench: got [0, 0, 0, 0, 0, 0], expected a load that keeps the cables taut");
  expect_load_rejected(loaded_crane("load: {mass: 3, gravity: [0, 0, 0], " + sphere + "}\n"),
                       "load.gravity: got [0, 0, 0], expected a load that keeps the cables taut");
  expect_load_rejected(loaded_crane("load: {mass: -3, gravity: [0, 0, -9.81], " + sphere + "}\n"),
                       "load.mass: got '-3', expected a mass above zero");
  expect_load_rejected(
      loaded_crane("load: {gravity: [0, 0, 9.81], items: [{name: a, mass: 3}, {name: b, force: [50, 60], "
                   "direction: [0, 0, -1]}]}\n"),
      "got a nominal force of -2.557e+04 N along gravity, expected a downward load");
  expect_load_rejected(loaded_crane("load: {gravity: [0, 0, -9.81], mass: 3, ellipsoid: around_items}\n"),
                       "load.ellipsoid: got 'around_items' without 'items', expected items, or E itself");
  const std::string around = "load:\n  gravity: [0, 0, -9.81]\n  ellipsoid: around_items\n";
  expect_load_rejected(loaded_crane(around), "got neither of 'wrench' and 'mass', expected one of them, or 'items'");
  expect_load_rejected(loaded_crane(around + "  wrench: [0, 0, 1, 0, 0, 0]\n  items:\n" + kPlatform),
                       "load.wrench: got a wrench beside 'ellipsoid: around_items', expected it as one of the items");
  expect_load_rejected(
      loaded_crane(around + "  items:\n" + kPlatform + "    - {name: e, wrench: [0, 0, -1, 0, 0, 0], " + sphere +
                   "}\n"),
      "load.ellipsoid: got 'around_items' and an item that is an ellipsoid, expected one or the other");
  expect_load_rejected(loaded_crane(around + "  items:\n    - {name: a, mass: 3, mass_tolerance: 4}\n"),
                       "load.items[a]");
  expect_load_rejected(loaded_crane(around + "  items:\n    - {name: wind, force: 6, direction: horizontal}\n"),
                       "got a load whose nominal force is zero");
  expect_load_rejected(
      loaded_crane("load: {gravity: [0, 0, -9.81], ellipsoid: arround_items, items: [{name: a, mass: 3}]}\n"),
      "load.ellipsoid: got 'arround_items', expected");
  expect_load_rejected(loaded_crane("load: {items: []}\n"), "load.items: got [], expected a list of items");
  expect_load_rejected(loaded_crane(kGravity + kPlatform, "tolerances: {mass: 1}\n"),
                       "got a tolerance of a load that has items");
  expect_load_rejected(loaded_crane(kGravity + kPlatform, "tolerances: {load_point: 1}\n"),
                       "'mass_tolerance' or 'at_tolerance'");
}

TEST(LoadItems, MayBeReplacedByAnEllipsoidAroundThem) {
  const std::string items =
      kPlatform + "    - {name: payload, mass: 12, mass_tolerance: 2 %, at: [0, 0, -1.2], at_tolerance: 50 mm}\n";
  const Case plain = parse_case(loaded_crane(kGravity + items), "crane.yaml");
  EXPECT_FALSE(plain.items_in_ellipsoid);
  const Case around = parse_case(
      loaded_crane("load:\n  gravity: [0, 0, -9.81]\n  ellipsoid: around_items\n  items:\n" + items), "crane.yaml");
  ASSERT_TRUE(around.items_in_ellipsoid);
  EXPECT_EQ(to_json(*around.items_in_ellipsoid), to_json(plain.problem.load));
  EXPECT_TRUE(around.problem.load.items.empty());
  ASSERT_TRUE(around.problem.load.ellipsoid);
  EXPECT_THAT(around.problem.load.point_m, ElementsAre("0", "0", "-0.72"));
  EXPECT_THAT(around.problem.load.wrench, ElementsAre("0", "0", "-196200", "0", "0", "0"));
}

TEST(LoadItems, StateTolerancesInTheSingularToo) {
  const Problem problem =
      parse_case(loaded_crane(kGravity + kPlatform, "tolerances: {base_anchor: 10 mm, platform_anchors: 5 mm}\n"), "c")
          .problem;
  EXPECT_EQ(problem.tolerances->base_anchor_m[5], "0.01");
  EXPECT_EQ(problem.tolerances->platform_anchor_m[0], "0.005");
  expect_load_rejected(loaded_crane(kGravity + kPlatform, "tolerances: {base_anchor: 10 mm, base_anchors: 5 mm}\n"),
                       "got both of");
  expect_load_rejected(loaded_crane(kGravity + kPlatform, "tolerances: {base_anchor: [0, 0, 0, 0, 0, -1]}\n"),
                       "crane.yaml:11:43: tolerances.base_anchors[5]: got '-1', expected a tolerance >= 0");
}

TEST(Case, WarnsOfADiagonalThatLooksLikeSemiAxes) {
  const auto warnings = [](const std::string& load) { return parse_case(loaded_crane(load), "crane.yaml").warnings; };
  const std::string w0 = "wrench: [0, 0, -200, 0, 0, 0], ";
  EXPECT_THAT(warnings("load: {" + w0 + "ellipsoid: {diagonal: [6, 6, 1, 3, 3, 1]}}\n"),
              ElementsAre(AllOf(HasSubstr("crane.yaml:7:61: load.ellipsoid.diagonal"), HasSubstr("by only 0.408"),
                                HasSubstr("semi_axes: [6, 6, 1, 3, 3, 1]"))));
  EXPECT_THAT(warnings("load: {" + w0 + "ellipsoid: {diagonal: [1/36, 1/36, 1, 1/9, 1/9, 1]}}\n"), ElementsAre());
  EXPECT_THAT(warnings("load: {" + w0 + "ellipsoid: {semi_axes: [6, 6, 1, 3, 3, 1]}}\n"), ElementsAre());
  EXPECT_THAT(warnings(kGravity + kPlatform +
                       "    - {name: e, wrench: [0, 0, 0, 0, 0, 0], ellipsoid: {diagonal: [6, 6, 2, 3, 3, 1]}}\n"),
              ElementsAre(HasSubstr("load.items[e].ellipsoid.diagonal")));
}

}  // namespace
}  // namespace taut
