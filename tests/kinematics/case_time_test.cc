// SPDX-License-Identifier: GPL-3.0-or-later
// Limits in time and boxes of inertia: what cases say, what problems state, and their JSON.
#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <rapidcheck/gtest.h>

#include <cmath>
#include <limits>
#include <nlohmann/json.hpp>
#include <numbers>

#include "base/input_error.h"
#include "case/case_file.h"
#include "problem/expression.h"
#include "problem/rational.h"

namespace taut {
namespace {

using nlohmann::json;
using ::testing::AllOf;
using ::testing::Each;
using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::IsEmpty;
using ::testing::Optional;
using ::testing::StartsWith;
using ::testing::ThrowsMessage;

/// A portal crane, each of whose sections a test may replace. `time` begins on line 19.
struct TimeSections {
  std::string units = "units: {length: m, force: kN, moment: kN*m, mass: t, angle: deg, time: s}\n";
  std::string load =
      "load:\n"
      "  gravity: [0, 0, -9.81 m/s^2]\n"
      "  items:\n"
      "    - {name: platform, mass: 8}\n"
      "    - {name: payload, mass: 12, at: [0, 0, -1.2], inertia: {box: [2.4, 1/3, 260 cm]}}\n";
  std::string space = "space:\n  free: {px: [-8, 8], py: [-5, 5], pz: [3, 10]}\n";
  std::string query =
      "query:\n"
      "  waypoints: [{px: -4, py: 0, pz: 6, phi: 0, theta: 0, sigma: 0},\n"
      "              {px: 4, py: 0, pz: 6, phi: 0, theta: 0, sigma: 0}]\n";
  std::string time = "time: {winches: {speed: 1 m/s}}\n";
  std::string tail;

  [[nodiscard]] std::string text() const {
    return "taut: 1\nname: crane\n" + units +
           "robot:\n"
           "  base_anchors: [[15, 10, 15], [15, 10, 15], [-15, 10, 15], [-15, 10, 15], [0, -10, 15], [0, -10, 15]]\n"
           "  platform_anchors: [[0, 1.5, 0], [1.3, -0.75, 0], [0, 1.5, 0], [-1.3, -0.75, 0], [1.3, -0.75, 0], "
           "[-1.3, -0.75, 0]]\n"
           "  tension: [2, 160]\n  length: [3, 35]\n" +
           load + space + query + time + tail;
  }
};

Case parse(const TimeSections& sections) { return parse_case(sections.text(), "crane.yaml"); }
Case with_time(const std::string& time) {
  TimeSections sections;
  sections.time = time;
  return parse(sections);
}

const std::string kAll =
    "time:\n"
    "  winches: {speed: 1 m/s, acceleration: 0.5 m/s^2, power: 60 kW}\n"
    "  load: {speed: 800 mm/s, acceleration: 0.2 m/s^2, angular_speed: 5 deg/s, angular_acceleration: 0.1 rad/s^2}\n"
    "  jerk: 50 cm/s^3\n"
    "  rate: 1 kHz\n";

TEST(CaseTime, IsExact) {
  const Case read = with_time(kAll);
  ASSERT_TRUE(read.problem.time);
  const TimeText& time = *read.problem.time;
  EXPECT_THAT(time.winch_speed_m_s, Each(Optional(std::string("1"))));
  EXPECT_THAT(time.winch_acceleration_m_s2, Each(Optional(std::string("0.5"))));
  EXPECT_THAT(time.winch_power_W, Each(Optional(std::string("60000"))));
  EXPECT_EQ(time.load_speed_m_s, "0.8");
  EXPECT_EQ(time.load_acceleration_m_s2, "0.2");
  EXPECT_EQ(time.load_angular_speed_rad_s, "(5)*pi/180");
  EXPECT_EQ(time.load_angular_acceleration_rad_s2, "0.1");
  EXPECT_EQ(read.move.jerk_m_s3, 0.5);
  EXPECT_EQ(read.move.rate_Hz, 1000);
  EXPECT_THAT(read.warnings, IsEmpty());
}

TEST(CaseTime, StatesNoMoreThanTheCaseDoes) {
  const Case read = with_time("time: {load: {speed: 1/3}}\n");
  TimeText only_speed;
  only_speed.load_speed_m_s = "1/3";
  EXPECT_EQ(read.problem.time, only_speed);
  EXPECT_EQ(read.move.jerk_m_s3, std::numeric_limits<double>::infinity());
  EXPECT_EQ(read.move.rate_Hz, 100);
  const Case timeless = with_time("");
  EXPECT_FALSE(timeless.problem.time);
  EXPECT_EQ(timeless.move.jerk_m_s3, std::numeric_limits<double>::infinity());
}

/// With an item of accelerations, and lengths that run straight between rows.
Case between_rows(const std::string& time, const std::string& tail = "") {
  TimeSections sections;
  sections.load += "    - {name: drives, acceleration: 0.05}\n";
  sections.time = "time:\n" + time + "  between_rows: straight\n";
  sections.tail = tail;
  return parse(sections);
}

TEST(CaseTime, HasRowsWhoseErrorsFollowFromLimits) {
  const Problem stated =
      between_rows("  winches: {acceleration: [0.5, 0.5, 0.5, 1/3, 0.5, 2]}\n  rate: 30 Hz\n").problem;
  ASSERT_TRUE(stated.time->rows);
  // 1/30 s and 1 ns, rounded up to 1e-12 s; a h²/8 and 1 nm, rounded up to 1e-12 m
  EXPECT_EQ(stated.time->rows->step_s, "0.033333334334");
  const Rational step = parse_rational("0.033333334334");
  for (std::size_t i = 0; i < kCables; ++i) {
    const Rational more = parse_rational(stated.time->rows->error_m[i]) -
                          evaluate_exactly(*stated.time->winch_acceleration_m_s2[i]) * step * step / 8;
    EXPECT_GE(more, Rational(1, 1'000'000'000));
    EXPECT_LT(more, Rational(1001, 1'000'000'000'000));
  }
  EXPECT_TRUE(stated.tolerances) << "which are all zero";
  EXPECT_FALSE(stated.tolerances->cable_length_m);

  const Problem usual = between_rows("  winches: {acceleration: 0.5}\n", "tolerances: {position: 1 mm}\n").problem;
  EXPECT_EQ(usual.time->rows->step_s, "0.010000001");
  EXPECT_THAT(usual.time->rows->error_m, Each(std::string("0.000006251002")));
  EXPECT_EQ(usual.tolerances->position_m, "0.001");
  EXPECT_EQ(problem_from_json(json::parse(to_json(usual).dump())).time, usual.time);
}

TEST(CaseTime, HasRowsOnlyWhereTheirErrorsAreKnown) {
  const auto rejects = [](const std::string& time, const std::string& message) {
    EXPECT_THAT([&] { (void)between_rows(time); },
                ThrowsMessage<InputError>(AllOf(StartsWith("crane.yaml:"), HasSubstr(message))))
        << time;
  };
  rejects("  winches: {speed: 1}\n", "time.between_rows: got no limit of the acceleration of winch 1, expected one");
  rejects("  winches: {acceleration: 1}\n  rate: 0.0009\n", "time.between_rows: got it with a rate below 1/1000 Hz");
  rejects("  load: {speed: 1}\n", "time.between_rows: got no limit of the acceleration of winch 1, expected one");
  EXPECT_THAT([&] { (void)with_time("time: {winches: {acceleration: 1}, between_rows: straight}\n"); },
              ThrowsMessage<InputError>(HasSubstr("time.between_rows: got no item 'acceleration' in the load")));
  for (const char* const wrong : {"cubic", "true", "[straight]", "''", "100 Hz"}) {
    const std::string time = std::string("time: {winches: {acceleration: 1}, between_rows: ") + wrong + "}\n";
    EXPECT_THAT([&] { (void)with_time(time); }, ThrowsMessage<InputError>(HasSubstr("crane.yaml:19:"))) << wrong;
    EXPECT_THAT([&] { (void)with_time(time); }, ThrowsMessage<InputError>(HasSubstr("expected 'straight': drives run")))
        << wrong;
  }
}

TEST(CaseTime, MayDifferFromWinchToWinch) {
  const TimeText time =
      *with_time("time: {winches: {speed: [1, 0.5 m/s, 1/3, 20 m/min, 36 km/h, 90 cm/s]}}\n").problem.time;
  EXPECT_THAT(time.winch_speed_m_s,
              ElementsAre(Optional(std::string("1")), Optional(std::string("0.5")), Optional(std::string("1/3")),
                          Optional(std::string("1/3")), Optional(std::string("10")), Optional(std::string("0.9"))));
}

TEST(CaseTime, HasBareNumbersInUnitsThatAreClear) {
  const auto angular_speed = [](const std::string& units, const std::string& text) {
    TimeSections sections;
    sections.units = "units: {mass: t, force: kN" + units + "}\n";
    sections.time = "time: {load: {angular_speed: " + text + "}}\n";
    return parse(sections).problem.time->load_angular_speed_rad_s.value();
  };
  EXPECT_EQ(angular_speed(", angle: deg", "5"), "(5)*pi/180");
  EXPECT_EQ(angular_speed(", angle: deg", "pi/36 rad/s"), "pi/36");
  EXPECT_EQ(angular_speed(", angle: rad", "0.05"), "0.05");
  EXPECT_EQ(angular_speed("", "3/2 deg/s"), "(3/2)*pi/180");
  EXPECT_EQ(*with_time("time: {winches: {power: 60}}\n").problem.time->winch_power_W[0], "60");

  const auto rejects = [](const std::string& units, const std::string& time) {
    TimeSections sections;
    sections.units = "units: {mass: t, force: kN, " + units + "}\n";
    sections.space = "";
    sections.query = "";
    sections.time = time;
    EXPECT_THAT([&] { (void)parse(sections); },
                ThrowsMessage<InputError>(HasSubstr("expected a number with its unit, one of")))
        << units << time;
    sections.units = "units: {mass: t, force: kN}\n";
    EXPECT_NO_THROW((void)parse(sections)) << time;
  };
  for (const char* limit : {"winches: {speed: 500}", "winches: {acceleration: [1, 1, 1, 1, 1, 1]}",
                            "load: {speed: 1/2}", "load: {acceleration: (1/2)}", "load: {speed: 1 m/s}, jerk: 3"}) {
    rejects("length: mm", fmt::format("time: {{{}}}\n", limit));
    rejects("time: min", fmt::format("time: {{{}}}\n", limit));
  }
  rejects("time: min", "time: {load: {angular_speed: 1}}\n");
}

/// The box that stands for moments of inertia has them, to 12 digits, and none of less.
RC_GTEST_PROP(CaseTimeLaws, MomentsOfInertiaAreThoseOfTheirBox, ()) {
  const auto part = [] { return *rc::gen::inRange<long>(1, 1'000'000); };
  const std::array<long, 3> squares = {part(), part(), part()};  // of sides, up to a factor: no moment is too large
  std::array<Rational, 3> moments;
  for (std::size_t k = 0; k < 3; ++k) moments[k] = Rational(squares[(k + 1) % 3] + squares[(k + 2) % 3]);
  TimeSections sections;
  const std::string old = "inertia: {box: [2.4, 1/3, 260 cm]}";
  sections.load.replace(
      sections.load.find(old), old.size(),
      fmt::format("mass_tolerance: 2 %, inertia: {{moments: [{} kg*m^2, {} t*m^2, {} kg*cm^2]}}", moments[0].str(),
                  Rational(moments[1] / 1000).str(), Rational(moments[2] * 10000).str()));
  const Case read = parse(sections);
  const Weight weight = std::get<Weight>(read.problem.load.items.at(1).what);
  std::array<Rational, 3> side;
  for (std::size_t k = 0; k < 3; ++k) side[k] = parse_rational(weight.inertia_box.value()[k]);
  for (std::size_t k = 0; k < 3; ++k) {
    const Rational& a = side[(k + 1) % 3];
    const Rational& b = side[(k + 2) % 3];
    const Rational of_box = Rational(12000, 12) * (a * a + b * b);
    RC_ASSERT(of_box >= moments[k]);
    RC_ASSERT(of_box - moments[k] <= moments[k] * Rational(3, 1'000'000'000'000));
  }
}

TEST(CaseTime, MakesBoxesOfInertiaAPartOfTheLoad) {
  TimeSections sections;
  const Case in_time = parse(sections);
  const Weight weight = std::get<Weight>(in_time.problem.load.items.at(1).what);
  EXPECT_THAT(weight.inertia_box, Optional(ElementsAre("2.4", "1/3", "2.6")));
  EXPECT_FALSE(std::get<Weight>(in_time.problem.load.items.at(0).what).inertia_box);
  EXPECT_THAT(in_time.warnings, IsEmpty());
  sections.time = "";
  const Case timeless = parse(sections);
  EXPECT_FALSE(std::get<Weight>(timeless.problem.load.items.at(1).what).inertia_box);
  EXPECT_THAT(timeless.warnings,
              ElementsAre(AllOf(StartsWith("crane.yaml:13:"),
                                HasSubstr("load.items[payload].inertia: is not used without 'time': what is proved"))));
}

TEST(CaseTime, WarnsOfPartsOfTheLoadWithoutMass) {
  TimeSections sections;
  sections.load += "    - {name: hook, wrench: [0, 0, -1, 0, 0, 0]}\n";
  const std::vector<std::string> warnings = parse(sections).warnings;
  EXPECT_THAT(warnings,
              ElementsAre("crane.yaml:20:7: time: inertia is that of the items with a mass; what is stated as a wrench "
                          "has none, and adds no inertia"));
  sections.time = "";
  EXPECT_THAT(parse(sections).warnings, ElementsAre(HasSubstr("is not used without 'time'")));
}

TEST(CaseTime, MayHaveBoundsOfItsDuration) {
  TimeSections sections;
  sections.tail = "expect: {verdict: proved, duration: [15, 1 min]}\n";
  const Case read = parse(sections);
  ASSERT_EQ(read.bounds.size(), 1U);
  EXPECT_EQ(read.bounds[0].quantity, "duration");
  EXPECT_EQ(read.bounds[0].lower, 15);
  EXPECT_EQ(read.bounds[0].upper, 60);
  sections.tail = "expect: {verdict: proved, duration: [15 m, null]}\n";
  EXPECT_THAT([&] { (void)parse(sections); },
              ThrowsMessage<InputError>(HasSubstr("expect.duration[0]: got '15 m', expected a time")));
}

void expect_rejected(const TimeSections& sections, const std::string& message) {
  EXPECT_THAT([&] { (void)parse(sections); },
              ThrowsMessage<InputError>(AllOf(StartsWith("crane.yaml:"), HasSubstr(message))))
      << sections.text();
}

TEST(CaseTime, IsRefusedWithPlaceFieldAndValue) {
  const std::vector<std::pair<std::string, std::string>> mistakes = {
      {"time:\n", "crane.yaml:20:1: time: got nothing, expected a map with the keys winches, load, jerk, rate"},
      {"time: {}\n", "crane.yaml:19:7: time: got no limit, expected at least one, under 'winches' or 'load'"},
      {"time: {jerk: 1 m/s^3, rate: 100 Hz}\n", "crane.yaml:19:7: time: got no limit, expected at least one"},
      {"time: 3\n", "time: got '3', expected a map with the keys"},
      {"time: [1]\n", "time: got [1], expected a map with the keys"},
      {"time: {winch: {speed: 1}}\n", "got the unknown key 'winch', did you mean 'winches'? expected winches, load,"},
      {"time: {winches: {}}\n",
       "crane.yaml:19:17: time.winches: got no limit, expected at least one of speed, acceleration, power"},
      {"time: {load: {}}\n", "time.load: got no limit, expected at least one of speed, acceleration, angular_speed,"},
      {"time: {load: {speed: 1}, winches: }\n", "time.winches: got nothing, expected a map"},
      {"time:\n  winches:\n    speed: 0\n",
       "crane.yaml:21:12: time.winches.speed[0]: got '0', expected a limit above zero"},
      {"time: {winches: {speed: -1 m/s}}\n", "time.winches.speed[0]: got '-1 m/s', expected a limit above zero"},
      {"time: {winches: {speed: [1, 1, 1, 0 m/s, 1, 1]}}\n",
       "crane.yaml:19:35: time.winches.speed[3]: got '0 m/s', expected a limit above zero"},
      {"time: {winches: {power: 1 - 1}}\n", "time.winches.power[0]: got '1 - 1', expected a limit above zero"},
      {"time: {winches: {speed: [1, 1, 1, 1, 1]}}\n",
       "crane.yaml:19:25: time.winches.speed: got [1, 1, 1, 1, 1], expected a limit of speed, or six of them"},
      {"time: {winches: {speed: [1, 1, 1, 1, 1, 1, 1]}}\n", "got a list of 7, expected a limit of speed, or six"},
      {"time: {winches: {speed: []}}\n", "time.winches.speed: got [], expected a limit of speed, or six of them"},
      {"time: {winches: {speed: {a: 1}}}\n", "time.winches.speed: got a map, expected a limit of speed, or six"},
      {"time: {winches: {speed: [1, 1, 1, null, 1, 1]}}\n", "time.winches.speed[3]: got nothing, expected a speed"},
      {"time: {winches: {speed: }}\n", "time.winches.speed: got nothing, expected a limit of speed, or six of them"},
      {"time: {winches: {speed: \"\"}}\n", "time.winches.speed: got '', expected a speed"},
      {"time: {winches: {speed: NaN}}\n", "time.winches.speed: got 'NaN', expected a speed: a number or an expression"},
      {"time: {winches: {speed: .inf}}\n", "time.winches.speed: got '.inf', expected a speed"},
      {"time: {winches: {speed: 1/0}}\n", "time.winches.speed: got '1/0', expected no division by zero"},
      {"time: {winches: {speed: 1 m}}\n",
       "got '1 m', expected a speed: a number or an expression such as 1/6^2, bare "
       "(m/s) or with one of the units m/s, cm/s, mm/s, km/h, m/min"},
      {"time: {winches: {speed: 1e13 m/s}}\n",
       "got '1e13 m/s', expected a limit above zero: from 1e-12 to 1e+12 in SI units and radians"},
      {"time: {winches: {acceleration: 1 m/s}}\n", "got '1 m/s', expected an acceleration"},
      {"time: {winches: {power: 60 kN}}\n", "got '60 kN', expected a power: a number or an expression"},
      {"time: {winches: {jerk: 1}}\n", "time.winches: got the unknown key 'jerk', expected speed, acceleration, power"},
      {"time: {load: {power: 1}}\n", "time.load: got the unknown key 'power'"},
      {"time: {load: {speed: 0}}\n", "crane.yaml:19:22: time.load.speed: got '0', expected a limit above zero"},
      {"time: {load: {speed: [1, 1, 1, 1, 1, 1]}}\n", "time.load.speed: got [1, 1, 1, 1, 1, 1], expected a speed"},
      {"time: {load: {acceleration: -1e-3}}\n", "time.load.acceleration: got '-1e-3', expected a limit above zero"},
      {"time: {load: {angular_speed: 0 deg/s}}\n",
       "time.load.angular_speed: got '0 deg/s', expected a limit above zero"},
      {"time: {load: {angular_speed: -pi rad/s}}\n",
       "time.load.angular_speed: got '-pi rad/s', expected a limit above zero"},
      {"time: {load: {angular_speed: 5 deg}}\n",
       "time.load.angular_speed: got '5 deg', expected a number or constant expression, bare (deg/s) or with one of "
       "the units rad/s, deg/s"},
      {"time: {load: {angular_speed: nan}}\n", "time.load.angular_speed: expression 'nan'"},
      {"time: {load: {angular_speed: inf deg/s}}\n", "time.load.angular_speed: expression 'inf'"},
      {"time: {load: {angular_speed: log(0)}}\n", "time.load.angular_speed: got 'log(0)', expected a limit above zero"},
      {"time: {load: {angular_acceleration: 5 deg/s}}\n",
       "time.load.angular_acceleration: got '5 deg/s', expected a number or constant expression"},
      {"time: {load: {speed: 1}, jerk: 0}\n", "crane.yaml:19:32: time.jerk: got '0', expected a jerk above zero"},
      {"time: {load: {speed: 1}, jerk: -1}\n", "time.jerk: got '-1', expected a jerk above zero"},
      {"time: {load: {speed: 1}, jerk: inf}\n", "time.jerk: got 'inf', expected a jerk: a number or an expression"},
      {"time: {load: {speed: 1}, jerk: 1 m/s^2}\n", "time.jerk: got '1 m/s^2', expected a jerk"},
      {"time: {load: {speed: 1}, jerk: [1]}\n", "time.jerk: got [1], expected a jerk"},
      {"time: {load: {speed: 1}, rate: 0}\n",
       "crane.yaml:19:32: time.rate: got '0', expected a rate above zero, and at most 10000 Hz"},
      {"time: {load: {speed: 1}, rate: -5 Hz}\n", "time.rate: got '-5 Hz', expected a rate above zero"},
      {"time: {load: {speed: 1}, rate: 10.1 kHz}\n", "time.rate: got '10.1 kHz', expected a rate above zero, and at"},
      {"time: {load: {speed: 1}, rate: 10 ms}\n", "time.rate: got '10 ms', expected a frequency"},
      {"time: {load: {speed: 1}, rate: nan}\n", "time.rate: got 'nan', expected a frequency"},
  };
  for (const auto& [time, message] : mistakes) {
    TimeSections sections;
    sections.time = time;
    expect_rejected(sections, message);
  }
}

TEST(CaseTime, IsRefusedBesideWhatItDoesNotGoWith) {
  TimeSections massless;
  massless.load =
      "load:\n"
      "  gravity: [0, 0, -9.81]\n"
      "  items:\n"
      "    - {name: hook, force: [100, 120], direction: [0, 0, -1]}\n"
      "    - {name: wind, force: 3, direction: any}\n";
  expect_rejected(massless,
                  "load.items: got no mass, expected a load with at least one item of kind 'mass' beside 'time'");
  massless.load =
      "load:\n"
      "  gravity: [0, 0, -9.81 m/s^2]\n"
      "  mass: 12\n"
      "  ellipsoid: {semi_axes: [1, 1, 1, 1, 1, 1]}\n\n";
  expect_rejected(massless, "expected a load with at least one item of kind 'mass' beside 'time'");
  TimeSections around_items;
  around_items.load.insert(around_items.load.find("  items:"), "  ellipsoid: around_items\n");
  expect_rejected(around_items,
                  "crane.yaml:20:7: time: got a load with 'ellipsoid: around_items', expected the items alone");
  for (TimeSections sections : {massless, around_items}) {
    sections.time = "";
    EXPECT_NO_THROW((void)parse(sections)) << sections.text();
  }
}

TEST(CaseTime, RefusesBoxesThatAreNone) {
  for (const auto& [box, message] : std::vector<std::pair<std::string, std::string>>{
           {"{box: [2, 0, 3]}", "load.items[payload].inertia.box[1]: got '0', expected a length above zero"},
           {"{box: [2, 1, -3]}", "load.items[payload].inertia.box[2]: got '-3', expected a length above zero"},
           {"{box: [2, 1, 2000 km]}",
            "load.items[payload].inertia.box[2]: got '2000 km', expected a length above zero, "
            "and at most 1000000 m"},
           {"{box: [2, 1]}", "load.items[payload].inertia.box: got [2, 1], expected the three lengths of a box"},
           {"{box: 2}", "load.items[payload].inertia.box: got '2', expected the three lengths of a box"},
           {"{box: [2, 1, nan]}", "load.items[payload].inertia.box[2]: got 'nan', expected a length"},
           {"{ball: 2}", "load.items[payload].inertia: got the unknown key 'ball'"},
           {"{box: [1, 1, 1], moments: [1 kg*m^2, 1 kg*m^2, 1 kg*m^2]}",
            "load.items[payload].inertia.moments: got it beside 'box', expected one of them"},
           {"{moments: [1, 1 kg*m^2, 1 kg*m^2]}",
            "load.items[payload].inertia.moments[0]: got '1', expected a moment of inertia with its unit, one of "
            "kg*m^2"},
           {"{moments: [1 kg*m^2, 1 kg*m^2, 2 kg*m^2]}",
            "load.items[payload].inertia.moments[2]: got '2 kg*m^2', expected a moment of inertia below the sum of"},
           {"{moments: [7 t*m^2, 1 t*m^2, 2 t*m^2]}",
            "load.items[payload].inertia.moments[0]: got '7 t*m^2', expected a moment of inertia below the sum of"},
           {"{moments: [1 kg*m^2, 0 kg*m^2, 1 kg*m^2]}",
            "load.items[payload].inertia.moments[1]: got '0 kg*m^2', expected a moment of inertia above zero"},
           {"{moments: [1 kg*m^2, 1 kg*m^2]}",
            "load.items[payload].inertia.moments: got [1 kg*m^2, 1 kg*m^2], expected three moments of inertia"},
           {"{moments: [1 kg, 1 kg*m^2, 1 kg*m^2]}", "load.items[payload].inertia.moments[0]: got '1 kg'"},
           {"{}", "load.items[payload].inertia: got no 'box'"}}) {
    for (const bool in_time : {true, false}) {
      if (!in_time && box.find("km") != std::string::npos) continue;
      TimeSections sections;
      const std::string good = "{box: [2.4, 1/3, 260 cm]}";
      sections.load.replace(sections.load.find(good), good.size(), box);
      if (!in_time) sections.time = "";
      expect_rejected(sections, message);
    }
  }
  TimeSections force;
  force.load += "    - {name: wind, force: 3, direction: any, inertia: {box: [1, 1, 1]}}\n";
  expect_rejected(force, "got 'inertia' beside 'force'");
}

// --- The problem and its JSON --------------------------------------------------------------------------------------

Problem timed_crane() { return with_time(kAll).problem; }

TEST(ProblemTime, HasJsonWithKeysInOrder) {
  const json written = to_json(timed_crane());
  EXPECT_EQ(written["time"].dump(), R"({"load_acceleration_m_s2":"0.2","load_angular_acceleration_rad_s2":"0.1",)"
                                    R"("load_angular_speed_rad_s":"(5)*pi/180","load_speed_m_s":"0.8",)"
                                    R"("winch_acceleration_m_s2":["0.5","0.5","0.5","0.5","0.5","0.5"],)"
                                    R"("winch_power_W":["60000","60000","60000","60000","60000","60000"],)"
                                    R"("winch_speed_m_s":["1","1","1","1","1","1"]})");
  EXPECT_EQ(written["load"]["items"][1]["weight"].dump(),
            R"({"at_m":["0","0","-1.2"],"at_tolerance_m":"0","inertia_box_m":["2.4","1/3","2.6"],)"
            R"("mass_kg":["12000","12000"]})");
  EXPECT_FALSE(written["load"]["items"][0]["weight"].contains("inertia_box_m"));
  EXPECT_FALSE(to_json(with_time("").problem).contains("time"));
}

TEST(ProblemTime, ReadsBackWhatItWrote) {
  Problem partial = timed_crane();
  partial.time->winch_power_W = {};
  partial.time->winch_speed_m_s[2] = std::nullopt;
  partial.time->load_speed_m_s = std::nullopt;
  const json written = to_json(partial);
  EXPECT_TRUE(written["time"]["winch_speed_m_s"][2].is_null());
  EXPECT_FALSE(written["time"].contains("winch_power_W"));
  EXPECT_FALSE(written["time"].contains("load_speed_m_s"));
  for (const Problem& problem : {timed_crane(), partial, with_time("").problem}) {
    const Problem again = problem_from_json(json::parse(to_json(problem).dump()));
    EXPECT_EQ(again.time, problem.time);
    EXPECT_EQ(again.load.items, problem.load.items);
    EXPECT_EQ(to_json(again), to_json(problem));
  }
}

TEST(ProblemTime, RejectsJsonThatIsNone) {
  const json good = to_json(timed_crane());
  ASSERT_NO_THROW((void)problem_from_json(good));
  for (const char* key : {"load_acceleration_m_s2", "load_angular_acceleration_rad_s2", "load_angular_speed_rad_s",
                          "load_speed_m_s", "winch_acceleration_m_s2", "winch_power_W", "winch_speed_m_s"}) {
    json without = good;
    without["time"].erase(key);
    EXPECT_NO_THROW((void)problem_from_json(without)) << key;
    for (const json& wrong :
         {json(), json(1), json(0.5), json::array(), json(std::vector<std::string>(5, "1")),
          json(std::vector<std::string>(7, "1")), json(std::vector<std::string>(6, "0")), json(std::vector<int>(6, 1)),
          json(std::vector<json>(6)), json("0"), json("-1"), json("nan"), json("px"), json("")}) {
      json bad = good;
      bad["time"][key] = wrong;
      EXPECT_THROW((void)problem_from_json(bad), FieldError) << key << " " << wrong;
    }
  }
  const auto expect_refused = [&](const json& time, const std::string& message) {
    json bad = good;
    bad["time"] = time;
    EXPECT_THAT([&] { (void)problem_from_json(bad); }, ThrowsMessage<FieldError>(HasSubstr(message))) << time;
  };
  expect_refused(json::object(), "time: ");
  expect_refused(json(), "time: ");
  expect_refused(json::array(), "time: ");
  expect_refused({{"winch_speed_m_s", std::vector<json>(6)}}, "a limit of at least one cable");
  expect_refused({{"load_speed_m_s", "1"}, {"jerk", "1"}}, "jerk");
  for (const json& box :
       {json(), json("1"), json::array(), json({"1", "1"}), json({"1", "1", "0"}), json({"1", "-1", "1"}),
        json({"1", "1", "1000001"}), json({"1", "1", "x"}), json({"1", "1", 1})}) {
    json bad = good;
    bad["load"]["items"][0]["weight"]["inertia_box_m"] = box;
    EXPECT_THROW((void)problem_from_json(bad), FieldError) << box;
  }
  json timeless = good;
  timeless.erase("time");
  EXPECT_THAT([&] { (void)problem_from_json(timeless); },
              ThrowsMessage<FieldError>("load.items[payload].inertia: got a box, expected none in a problem without "
                                        "'time'"));
}

template <class Spoil>
void expect_invalid(Spoil spoil, const std::string& message) {
  Problem problem = timed_crane();
  ASSERT_NO_THROW(validate(problem));
  spoil(problem);
  EXPECT_THAT([&] { validate(problem); }, ThrowsMessage<FieldError>(StartsWith(message)));
}

TEST(ProblemTime, IsValidated) {
  expect_invalid([](Problem& p) { p.time.emplace(); }, "time: got no limit, expected at least one");
  expect_invalid([](Problem& p) { p.time->winch_power_W[4] = "0"; },
                 "time.winches.power[4]: got '0', expected a limit above zero");
  expect_invalid([](Problem& p) { p.time->winch_acceleration_m_s2[0] = "1/0"; }, "time.winches.acceleration[0]: got");
  expect_invalid([](Problem& p) { p.time->load_angular_acceleration_rad_s2 = "a"; },
                 "time.load.angular_acceleration: expression 'a'");
  // Exactly zero, yet above it in binary64.
  expect_invalid([](Problem& p) { p.time->load_angular_speed_rad_s = "sin(pi)"; },
                 "time.load.angular_speed: got 'sin(pi)', expected a limit above zero");
  const auto run_straight = [](Problem& p) {
    p.tolerances.emplace();
    p.time->winch_acceleration_m_s2.fill("8");
    p.time->rows = RowsText{"0.5", {"3", "3", "3", "3", "3", "3"}};
  };
  expect_invalid(
      [&](Problem& p) {
        run_straight(p);
        p.time->rows->error_m[1] = "0.25";
      },
      "time.rows.error_m[1]: got 0.25, expected more than an eighth of");
  expect_invalid(
      [&](Problem& p) {
        run_straight(p);
        p.time->rows->error_m[5] = "-3";
      },
      "time.rows.error_m[5]: got -3, expected more");
  expect_invalid(
      [&](Problem& p) {
        run_straight(p);
        p.time->rows->step_s = "0";
      },
      "time.rows.step_s: got 0, expected a time above zero");
  expect_invalid(
      [&](Problem& p) {
        run_straight(p);
        p.time->rows->step_s = "nan";
      },
      "time.rows.step_s: got 'nan'");
  expect_invalid(
      [&](Problem& p) {
        run_straight(p);
        p.time->winch_acceleration_m_s2[3].reset();
      },
      "time.rows: got no limit of the acceleration of winch 4");
  expect_invalid(
      [&](Problem& p) {
        run_straight(p);
        p.time->winch_acceleration_m_s2[3] = "sqrt(2)";
      },
      "time.winches.acceleration[3]: got 'sqrt(2)', expected a number");
  expect_invalid(
      [&](Problem& p) {
        run_straight(p);
        p.tolerances.reset();
      },
      "tolerances: got none, expected some");
  expect_invalid([](Problem& p) { p.time->load_speed_m_s = "1e999"; }, "time.load.speed: expression '1e999'");
  expect_invalid(
      [](Problem& p) {
        for (LoadItem& item : p.load.items) {
          auto& weight = std::get<Weight>(item.what);
          weight.mass_lower = weight.mass_upper = "0";
        }
        p.load.items.push_back(
            {"hook", Force{SegmentOfVectors{{"0", "0", "-1"}, "1", "2"}, Axes::kWorld, {"0", "0", "0"}}});
      },
      "load.items: got no mass, expected a load with at least one item of kind 'mass'");
}

TEST(ProblemTime, LeavesTheProblemOfThePathAlone) {
  const Problem path_alone = without_time(timed_crane());
  EXPECT_FALSE(path_alone.time);
  EXPECT_NO_THROW(validate(path_alone));
  EXPECT_EQ(to_json(path_alone), to_json(with_time("").problem));
  EXPECT_EQ(to_json(without_time(path_alone)), to_json(path_alone));
}

/// Limits are the exact quotients of what was typed.
RC_GTEST_PROP(CaseTimeLaws, ConvertExactly, ()) {
  const long whole = *rc::gen::inRange<long>(1, 1'000'000);
  const long below = *rc::gen::inRange<long>(1, 1'000);
  const TimeText time = *with_time(fmt::format("time: {{winches: {{speed: {0}/{1} km/h, power: {0}/{1} kW}}, load: "
                                               "{{acceleration: {0}/{1} mm/s^2, angular_speed: {0}/{1} deg/s}}}}\n",
                                               whole, below))
                             .problem.time;
  const Rational typed(whole, below);
  RC_ASSERT(evaluate_exactly(*time.winch_speed_m_s[5]) == typed * Rational(5, 18));
  RC_ASSERT(evaluate_exactly(*time.winch_power_W[0]) == typed * 1000);
  RC_ASSERT(evaluate_exactly(*time.load_acceleration_m_s2) == typed / 1000);
  const auto angular = evaluate_constant<double>(*time.load_angular_speed_rad_s);
  const double expected = static_cast<double>(whole) / static_cast<double>(below) * std::numbers::pi / 180;
  RC_ASSERT(std::abs(angular - expected) <= 1e-14 * expected);
}

}  // namespace
}  // namespace taut
