// SPDX-License-Identifier: GPL-3.0-or-later
// Cases of legs through the library: planned as the command plans them, each leg with a theorem of its own.
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <taut/taut.h>

#include <algorithm>
#include <string>

namespace {

using taut::Certificate;
using taut::Verdict;
using testing::HasSubstr;

/// Robot 1 lifts a payload of so many kilograms, which is a body of the platform while it does.
taut::Case lift(const std::string& payload, const std::string& tail = "") {
  return taut::Case::parse(R"(taut: 1
name: lift
title: Lifting
units: {length: mm, force: N, moment: N*m, mass: kg, angle: deg, time: s}
robot:
  base_anchors: [[0, 220, 0], [0, 220, 0], [-190.5256, -110, 0], [-190.5256, -110, 0], [190.5256, -110, 0],
                 [190.5256, -110, 0]]
  platform_anchors: [[-112.5833, 65, 0], [112.5833, 65, 0], [0, -130, 0], [-112.5833, 65, 0], [112.5833, 65, 0],
                     [0, -130, 0]]
  tension: [0.05, 0.8]
  length: [100, 550]
load:
  gravity: [0, 0, 9.81]
  point: [30, 14, -21]
  items:
    - {name: platform, mass: 0.1}
    - {name: payload, mass: )" +
                               payload +
                               R"(, legs: [carry]}
    - {name: any, force: 0.001, direction: any}
bodies:
  clearance: 5 mm
  platform:
    - {name: payload, ball: {radius: 10, at: [0, 0, 40]}, legs: [carry]}
    - {name: plate, ball: {radius: 20}}
  obstacles:
    - {name: payload before, ball: {radius: 10, at: [0, 150, 330]}, legs: [fetch]}
    - {name: mast, capsule: {from: [-300, 300, 0], to: [-300, 300, 900], radius: 30}}
space:
  slice: {px: 0, py: 0, phi: 0, theta: 0, sigma: 34}
query:
  legs:
    - {name: fetch, waypoints: [{pz: 350}, {pz: 330}]}
    - {name: carry, waypoints: [{pz: 330}, {pz: 340}]}
planner: {strategy: astar, cost: parameters}
)" + tail,
                           "lift.yaml");
}

const char* const kSpeed = "time: {load: {speed: 50 mm/s, acceleration: 100 mm/s^2}, rate: 20 Hz}\n";

TEST(LegsInTheLibrary, AreCasesOfTheirOwn) {
  const taut::Case the_case = lift("0.01");
  EXPECT_EQ(the_case.query_waypoints(), 0U);
  const auto legs = the_case.legs();
  ASSERT_EQ(legs.size(), 2U);
  EXPECT_EQ(legs[0].first, "fetch");
  EXPECT_EQ(legs[1].second.name(), "lift, leg carry");
  EXPECT_EQ(legs[1].second.query_waypoints(), 2U);
  EXPECT_TRUE(legs[1].second.legs().empty());
  const auto has = [](const std::vector<std::string>& lines, const std::string& begin, const std::string& what) {
    return std::ranges::any_of(lines, [&](const std::string& line) {
      return line.starts_with(begin) && line.find(what) != std::string::npos;
    });
  };
  EXPECT_TRUE(has(the_case.load_statement(), "leg carry: ", "payload"));
  EXPECT_FALSE(has(the_case.load_statement(), "leg fetch: ", "payload"));
  EXPECT_TRUE(has(the_case.bodies_statement(), "leg fetch: ", "payload before"));
  EXPECT_FALSE(has(the_case.bodies_statement(), "leg carry: ", "payload before"));
  EXPECT_THAT(the_case.summary(), HasSubstr("Leg 2 of 2, carry"));
  EXPECT_THAT(the_case.summary_json(), HasSubstr("\"lift, leg carry\""));
  EXPECT_THAT(the_case.drawing_svg(), HasSubstr("<svg"));
}

TEST(LegsInTheLibrary, ArePlannedAndProvedAsOneAndEach) {
  const taut::Case the_case = lift("0.01", kSpeed);
  taut::PlanOptions options;
  options.headroom_seconds = 5;
  const Certificate whole = taut::plan(the_case, options);
  ASSERT_EQ(whole.verdict(), Verdict::kProved) << whole.reason();
  EXPECT_EQ(whole.case_name(), "lift");
  EXPECT_EQ(whole.document_fields().front().second, "Lifting");
  EXPECT_FALSE(whole.theorem()->margins());
  EXPECT_THAT(whole.theorem()->claim(), HasSubstr("There are 2 legs"));
  EXPECT_TRUE(whole.samples().empty());
  EXPECT_TRUE(whole.path().waypoints.empty());
  const auto legs = whole.legs();
  ASSERT_EQ(legs.size(), 2U);
  std::size_t boxes = 0, segments = 0;
  double duration = 0;
  for (const auto& [name, leg] : legs) {
    EXPECT_EQ(leg.verdict(), Verdict::kProved) << name;
    EXPECT_EQ(leg.case_name(), "lift, leg " + name);
    EXPECT_GT(leg.theorem()->margins()->clearance_m.value(), 0);
    EXPECT_THAT(whole.text(), HasSubstr(leg.text().substr(0, leg.text().find_last_not_of('\n') + 1)));
    EXPECT_TRUE(leg.move_plan());
    boxes += leg.boxes();
    segments += leg.segments();
    duration += leg.duration_s().value();
  }
  EXPECT_EQ(std::pair(whole.boxes(), whole.segments()), std::pair(boxes, segments));
  EXPECT_DOUBLE_EQ(whole.duration_s().value(), duration);
  const taut::Table poses = whole.poses(20);
  EXPECT_NEAR(poses.values[poses.values.size() - poses.columns.size()], duration, 1e-9);
  EXPECT_THAT(whole.winches_csv(20), HasSubstr("# leg carry: from"));
  EXPECT_THAT(whole.headroom(), HasSubstr("\"leg\""));
  EXPECT_THAT(taut::report(whole), HasSubstr("All 2 legs are proved"));

  taut::CheckOptions about;
  about.the_case = the_case;
  EXPECT_EQ(taut::check(whole, about).outcome, taut::Outcome::kAccepted);
  about.the_case = lift("0.02", kSpeed);
  EXPECT_EQ(taut::check(whole, about).outcome, taut::Outcome::kRejected);

  const Certificate loaded = Certificate::parse(whole.text());
  EXPECT_EQ(loaded.verdict(), Verdict::kUnchecked);
  EXPECT_FALSE(loaded.theorem());
  ASSERT_EQ(loaded.legs().size(), 2U);
  EXPECT_EQ(loaded.legs()[0].second.verdict(), Verdict::kUnchecked);
  EXPECT_EQ(loaded.legs()[0].second.text(), legs[0].second.text());
  EXPECT_THROW((void)loaded.winches(), taut::InputError);
}

TEST(LegsInTheLibrary, OneThatIsRefutedRefutesAll) {
  taut::PlanOptions options;
  options.headroom_seconds = 0;
  const Certificate whole = taut::plan(lift("1"), options);
  ASSERT_EQ(whole.verdict(), Verdict::kRefuted);
  EXPECT_FALSE(whole.theorem()->witness());
  EXPECT_EQ(whole.legs()[0].second.verdict(), Verdict::kProved);
  EXPECT_EQ(whole.legs()[1].second.theorem()->witness()->kind.substr(0, 7), "tension");
  EXPECT_EQ(whole.headroom(), "");
  EXPECT_THROW((void)whole.path_csv(), taut::InputError);
  EXPECT_THROW((void)whole.controller_csv(), taut::InputError);
}

TEST(LegsInTheLibrary, AreRefusedWhereOnePathIsMeant) {
  const taut::Case the_case = lift("0.01");
  const auto field_of = [](const auto& call) -> std::string {
    try {
      call();
    } catch (const taut::InputError& error) {
      return error.field();
    }
    return "no error";
  };
  EXPECT_EQ(field_of([&] { (void)taut::audit(the_case, "path.csv"); }), "query.legs");
  EXPECT_EQ(field_of([&] { (void)taut::prove(the_case, {}); }), "query.legs");
  EXPECT_EQ(field_of([&] { (void)taut::sensitivity(the_case); }), "query.legs");
  taut::PlanOptions options;
  options.save_atlas = "never-written.atlas";
  EXPECT_EQ(field_of([&] { (void)taut::plan(the_case, options); }), "save_atlas");
}

}  // namespace
