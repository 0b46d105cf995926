// SPDX-License-Identifier: GPL-3.0-or-later
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <rapidcheck.h>

#include <cmath>
#include <filesystem>
#include <fstream>
#include <nlohmann/json.hpp>
#include <sstream>

#include "base/input_error.h"
#include "case/case_of_legs.h"

namespace taut {
namespace {

using ::testing::AllOf;
using ::testing::AnyOf;
using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::StartsWith;
using ::testing::ThrowsMessage;

const std::string kCaseFolder = std::string(TAUT_SOURCE_DIR) + "/cases/";

/// A good case, each of whose sections a test may replace.
struct Sections {
  std::string head = "taut: 1\nname: test\n";
  std::string units = "units: {length: mm, force: N, moment: N*m, mass: kg, angle: rad}\n";
  std::string robot =
      "robot:\n"
      "  base_anchors: [[0, 220, 0], [0, 220, 0], [-190, -110, 0], [-190, -110, 0], [190, -110, 0], [190, -110, 0]]\n"
      "  platform_anchors: [[-112, 65, 0], [112, 65, 0], [0, -130, 0], [-112, 65, 0], [112, 65, 0], [0, -130, 0]]\n";
  std::string limits = "  tension: [0.05, 0.5]\n  length: [100, 550]\n";
  std::string load = "load: {wrench: [0, 0, 1, 0, 0, 0], ellipsoid: {diagonal: [1, 1, 1, 1, 1, 1]}}\n";
  std::string space = "space: {slice: {px: 0, py: 0, pz: 350, sigma: 34 deg}}\n";
  std::string query = "query: {waypoints: [{phi: -2.3, theta: 1.6}, {phi: 1.7, theta: 1.7}]}\n";
  std::string tail;

  [[nodiscard]] std::string text() const { return head + units + robot + limits + load + space + query + tail; }
};

Case parse(const Sections& sections) { return parse_case(sections.text(), "test.yaml"); }

void expect_rejected(const std::string& text, const std::string& message) {
  EXPECT_THAT([&] { (void)parse_case(text, "test.yaml"); },
              ThrowsMessage<InputError>(AllOf(StartsWith("test.yaml"), HasSubstr(message))))
      << text;
}
void expect_rejected(const Sections& sections, const std::string& message) {
  expect_rejected(sections.text(), message);
}

TEST(CaseFile, SaysWhatTheHeadOfADocumentShows) {
  EXPECT_EQ(parse(Sections()).document_fields, DocumentFields());
  Sections sections;
  sections.head +=
      "title: Turn in place, 174°\nmachine: 'Portal 2: six winches'\nsite: Hall B\n"
      "document: LP-17/3\nprepared_by: A. Niemi\n";
  sections.load =
      "load: {name: 20 ft container, wrench: [0, 0, 1, 0, 0, 0], ellipsoid: {diagonal: [1, 1, 1, 1, 1, 1]}}\n";
  const DocumentFields fields = parse(sections).document_fields;
  EXPECT_EQ(fields.title, "Turn in place, 174°");
  EXPECT_EQ(fields.machine, "Portal 2: six winches");
  EXPECT_EQ(fields.site, "Hall B");
  EXPECT_EQ(fields.load_name, "20 ft container");
  EXPECT_EQ(fields.document, "LP-17/3");
  EXPECT_EQ(fields.prepared_by, "A. Niemi");
  EXPECT_EQ(to_json(parse(sections).problem), to_json(parse(Sections()).problem)) << "no part of the problem";
}

TEST(CaseFile, RefusesWhatTheHeadOfADocumentCannotShow) {
  const auto with = [](const std::string& line) {
    Sections sections;
    sections.head += line + "\n";
    return sections;
  };
  expect_rejected(with("title: \"a\\u202Eb\""),
                  "test.yaml:3:8: title: got 'a\\xe2\\x80\\xaeb', expected one line of 1");
  expect_rejected(with("site: \"a\\nb\""), "test.yaml:3:7: site: got 'a\\x0ab', expected one line");
  expect_rejected(with("machine: \"\""), "machine: got '', expected one line");
  expect_rejected(with("prepared_by: [a, b]"), "prepared_by: got [a, b], expected one line");
  expect_rejected(with("title: " + std::string(121, 'x')), "expected one line of 1 to 120 characters");
  expect_rejected(with("document: 'a\"b'"), "document: got 'a\"b', expected at most 40 letters, digits, blanks");
  expect_rejected(with("load_name: a"), "got the unknown key 'load_name'");
  Sections sections;
  sections.load = "load: {name: \"\\e[31m\", wrench: [0, 0, 1, 0, 0, 0], ellipsoid: {diagonal: [1, 1, 1, 1, 1, 1]}}\n";
  expect_rejected(sections, "load.name: got '\\x1b[31m', expected one line");
}

TEST(CaseFile, IsUtf8) {
  Sections sections;
  sections.head = "taut: 1\nname: \"Ger\u00e4t \u20ac \U0001F680 \u07ff\ud7ff\uffff\U0010ffff\"\n";
  EXPECT_EQ(parse(sections).problem.name, "Ger\u00e4t \u20ac \U0001F680 \u07ff\ud7ff\uffff\U0010ffff");
  using std::string_literals::operator""s;
  for (const auto& [bytes, seen] : std::map<std::string, std::string>{{"\xff"s, "FF"},
                                                                      {"\0"s, "00"},
                                                                      {"\x80"s, "80"},
                                                                      {"\xc0\xaf"s, "C0"},          // overlong
                                                                      {"\xe0\x9f\xbf"s, "E0"},      // overlong
                                                                      {"\xf0\x8f\xbf\xbf"s, "F0"},  // overlong
                                                                      {"\xed\xa0\x80"s, "ED"},      // a surrogate
                                                                      {"\xf4\x90\x80\x80"s, "F4"},  // above U+10FFFF
                                                                      {"\xe2\x82"s, "E2"},
                                                                      {"\xc3"s, "C3"}}) {
    sections.head = "taut: 1\nname: \u00e4" + bytes + "\n";
    expect_rejected(sections, "test.yaml:2:8: got the byte 0x" + seen + ", expected UTF-8");
  }
  expect_rejected("taut: 1\xf0\x9f\x9a", "test.yaml:1:8: got the byte 0xF0");
}

TEST(CaseFile, ShowsNoControlCharacters) {
  Sections sections;
  sections.tail = "expect: \"\\e[2K\\rproved\"\n";
  expect_rejected(sections, R"(got '\x1b[2K\x0dproved')");
  sections.tail = "\"\\e[2K\": 1\n";
  expect_rejected(sections, R"(got the unknown key '\x1b[2K')");
  sections.tail = "";
  sections.space = "space: {slice: {px: \"1\\e\", py: 0, pz: 350, sigma: 34 deg}}\n";
  expect_rejected(sections, R"(\x1b)");
}

TEST(CaseFile, ShortensWhatItShowsToWholeCharacters) {
  Sections sections;
  sections.tail = "expect: " + std::string(59, 'x') + "\u00e4y\n";
  expect_rejected(sections, "got '" + std::string(59, 'x') + "…'");
}

TEST(CaseFile, ReadsThePapersSlice) {
  const Case read = load_case(kCaseFolder + "robot1-slice-qs-qg.yaml");
  const Problem& problem = read.problem;
  EXPECT_EQ(problem.name, "robot1-slice-qs-qg");
  EXPECT_THAT(problem.robot.base_anchors_m[2], ElementsAre("-0.1905256", "-0.11", "0"));
  EXPECT_THAT(problem.robot.platform_anchors_m[5], ElementsAre("0", "-0.13", "0"));
  EXPECT_EQ(problem.robot.tension_N[5], (Limits{"0.05", "0.5"}));
  EXPECT_EQ(problem.robot.length_m[0], (Limits{"0.1", "0.55"}));
  EXPECT_THAT(problem.load.point_m, ElementsAre("0.03", "0.014", "-0.021"));
  EXPECT_THAT((*problem.load.ellipsoid)[3], ElementsAre("0", "0", "0", "1000000", "0", "0"));
  EXPECT_THAT(problem.space.pose, ElementsAre("0", "0", "0.35", "phi", "theta", "(34)*pi/180"));
  ASSERT_EQ(problem.space.parameters.size(), 2u);
  EXPECT_EQ(problem.space.parameters[0].kind, ParameterKind::kPeriodic);
  EXPECT_EQ(problem.space.parameters[1].kind, ParameterKind::kReal);
  EXPECT_EQ(problem.space.flip, (std::array{0, 1}));
  EXPECT_THAT(problem.query, ElementsAre(ElementsAre("-2.3", "1.6"), ElementsAre("1.7", "1.7")));
  EXPECT_EQ(read.planner.strategy, Strategy::kAStar);
  EXPECT_EQ(read.planner.cost, Cost::kRotation);
  EXPECT_EQ(read.planner.radius, 0.15);
  EXPECT_EQ(read.expect, Expectation::kProved);
  EXPECT_THAT(read.description, HasSubstr("OUR RECONSTRUCTION"));
}

TEST(CaseFile, KnowsWhetherABudgetIsStated) {
  Sections sections;
  EXPECT_FALSE(parse(sections).planner.has_budget);
  sections.tail = "planner: {max_charts: 70}\n";
  EXPECT_TRUE(parse(sections).planner.has_budget);
  EXPECT_EQ(parse(sections).planner.max_charts, 70);
  EXPECT_TRUE(std::isinf(parse(sections).planner.max_seconds));
  sections.tail = "planner: {max_seconds: 0.2}\n";
  EXPECT_TRUE(parse(sections).planner.has_budget);
  EXPECT_EQ(parse(sections).planner.max_seconds, 0.2);
}

TEST(CaseFile, TravelMayNameAPointAndALengthPerRadian) {
  Sections sections;  // in mm
  sections.tail = "planner: {cost: travel}\n";
  EXPECT_EQ(parse(sections).planner.cost, Cost::kTravel);
  EXPECT_EQ(parse(sections).planner.travel.point_m, (std::array<double, 3>{0, 0, 0}));
  EXPECT_FALSE(parse(sections).planner.travel.per_radian_m);
  sections.tail = "planner: {cost: {travel: {point: [10, 2 cm, -0.5 m], per_radian: 125}}}\n";
  EXPECT_EQ(parse(sections).planner.cost, Cost::kTravel);
  EXPECT_EQ(parse(sections).planner.travel.point_m, (std::array<double, 3>{0.01, 0.02, -0.5}));
  EXPECT_EQ(parse(sections).planner.travel.per_radian_m, 0.125);
  sections.tail = "planner: {cost: {travel: {per_radian: 0}}}\n";
  EXPECT_EQ(parse(sections).planner.travel.per_radian_m, 0);
}

TEST(CaseFile, AnglesChooseTheCoordinatesOfAPose) {
  Sections sections;
  sections.query = "";
  sections.space = "space: {angles: roll-pitch-yaw, slice: {pz: 350, roll: 0, pitch: 5 deg}}\n";
  const SpaceText slice = parse(sections).problem.space;
  EXPECT_EQ(slice.angles, AnglesText{AngleKind::kRollPitchYaw});
  EXPECT_THAT(slice.pose, ElementsAre("px", "py", "0.35", "0", "(5)*pi/180", "yaw"));
  ASSERT_EQ(slice.parameters.size(), 3u);
  EXPECT_EQ(slice.parameters[2].name, "yaw");
  EXPECT_EQ(slice.parameters[2].kind, ParameterKind::kPeriodic);
  EXPECT_FALSE(slice.flip);

  sections.space = "space: {angles: zyz}\n";
  const SpaceText all = parse(sections).problem.space;
  EXPECT_THAT(all.pose, ElementsAre("px", "py", "pz", "alpha", "beta", "gamma"));
  EXPECT_EQ(all.parameters[4].kind, ParameterKind::kPeriodic);
  EXPECT_FALSE(all.flip);

  sections.space = "space: {angles: {axis: [0, 0.50, -1]}, free: {px: [0, 1], py: [0, 1], pz: [0, 1]}}\n";
  const SpaceText axis = parse(sections).problem.space;
  EXPECT_EQ(axis.angles.kind, AngleKind::kAxis);
  EXPECT_THAT(axis.angles.axis, ElementsAre("0", "0.5", "-1"));
  EXPECT_EQ(axis.parameters.size(), 4u);
  EXPECT_THAT(axis.pose, ElementsAre("px", "py", "pz", "turn", "0", "0"));

  sections.space = "space: {angles: tilt-and-torsion, slice: {px: 0, py: 0, pz: 350, sigma: 34 deg}}\n";
  EXPECT_EQ(parse(sections).problem.space.flip, (std::array{0, 1}));
  sections.space = "space: {angles: roll-pitch-yaw, implicit: ['px - 10*sin(yaw)', 'pitch - 0.1']}\n";
  EXPECT_THROW(parse(sections), InputError);  // pitch is periodic, and the constraint is not
  sections.space = "space: {angles: roll-pitch-yaw, implicit: ['px - 10*sin(yaw)', 'sin(pitch) - 0.1']}\n";
  EXPECT_THAT(parse(sections).problem.space.constraints, ElementsAre("(1000*px) - 10*sin(yaw)", "sin(pitch) - 0.1"));
}

TEST(CaseFile, UnderstandsTheAnglesOfOthers) {
  const std::pair<const char*, const char*> mistakes[] = {
      {"{slice: {px: 0, py: 0, pz: 350, yaw: 34 deg}}",
       "got the unknown key 'yaw', which is understood with 'angles: roll-pitch-yaw' under 'space' of the case (it has "
       "tilt-and-torsion angles), expected px, py, pz, phi, theta, sigma"},
      {"{slice: {px: 0, py: 0, pz: 350, gamma: 34 deg}}", "'angles: zyz'"},
      {"{slice: {px: 0, py: 0, pz: 350, torsion: 34 deg}}", "got the unknown key 'torsion', which is called sigma"},
      {"{slice: {px: 0, py: 0, pz: 350, rz: 34 deg}}", "'angles: roll-pitch-yaw'"},
      {"{angles: roll-pitch-yaw, slice: {px: 0, py: 0, pz: 350, sigma: 34 deg}}", "'angles: tilt-and-torsion'"},
      {"{angles: roll-pitch-yaw, implicit: [px*sin(sigma)]}",
       "got 'sigma', which is understood with 'angles: tilt-and-torsion'"},
      {"{angles: euler}", "space.angles: got 'euler', expected one of tilt-and-torsion, roll-pitch-yaw, zyz, {axis"},
      {"{angles: {axis: [0, 0, 0]}}", "space.angles.axis: got [0, 0, 0], expected a direction"},
      {"{angles: {axis: [0, 1e10, 0]}}", "expected a direction"},
      {"{angles: {axis: [0, 1]}}", "expected a direction: a list of three numbers"},
  };
  for (const auto& [space, message] : mistakes) {
    Sections sections;
    sections.query = "";
    sections.space = std::string("space: ") + space + "\n";
    expect_rejected(sections, message);
  }
  Sections sections;
  sections.query = "query: {waypoints: [{phi: 1, yaw: 1}, {phi: 1, theta: 1}]}\n";
  expect_rejected(sections, "got the unknown key 'yaw', which is understood with 'angles: roll-pitch-yaw'");
}

TEST(CaseFile, ConstraintsAreOfTheParametersInMetres) {
  Sections sections;
  sections.space = "space: {implicit: ['px^2 + py^2 + (pz - 306)^2 - 130^2', 1e3*sigma*px + exp(2*py)]}\n";
  const std::string pose = "{px: 0, py: 0, pz: 436, phi: 0, theta: 0, sigma: 0}";
  sections.query = "query: {waypoints: [" + pose + ", " + pose + "]}\n";
  EXPECT_THAT([&] { parse(sections); },
              ThrowsMessage<InputError>(HasSubstr("the periodic parameter sigma grows by 2*pi")));
  sections.space = "space: {implicit: ['px^2 + py^2 + (pz - 306)^2 - 130^2', 1e3*sin(sigma)*px + exp(2*py)]}\n";
  const SpaceText space = parse(sections).problem.space;
  EXPECT_EQ(space.parameters.size(), 6u);
  EXPECT_THAT(space.constraints, ElementsAre("(1000*px)^2 + (1000*py)^2 + ((1000*pz) - 306)^2 - 130^2",
                                             "1e3*sin(sigma)*(1000*px) + exp(2*(1000*py))"));
  EXPECT_EQ(space.flip, (std::array{3, 4})) << "neither phi nor theta is mentioned";
}

TEST(CaseFile, ConstraintsMentionWhatASliceFixes) {
  Sections sections;
  sections.units = "units: {length: in, angle: deg}\n";
  sections.space = "space: {slice: {py: 7, sigma: 34}, implicit: [px*py - theta*sin(sigma)]}\n";
  sections.query = "query: {waypoints: [{px: 0, pz: 1, phi: 2, theta: 0}, {px: 0, pz: 2, phi: 2, theta: 0}]}\n";
  const SpaceText space = parse(sections).problem.space;
  EXPECT_THAT(space.constraints, ElementsAre("(px/0.0254)*((0.1778)/0.0254) - theta*sin(((34)*pi/180))"));
  EXPECT_EQ(space.flip, std::nullopt) << "theta is mentioned";
}

TEST(CaseFile, ConstraintsMayComeWithABox) {
  Sections sections;
  sections.space = "space: {free: {px: [-1, 1], py: [-1, 1], pz: [0, 2]}, implicit: [px - py]}\n";
  const std::string pose = "{px: 0, py: 0, pz: 1, phi: 0, theta: 0, sigma: 0}";
  sections.query = "query: {waypoints: [" + pose + ", " + pose + "]}\n";
  const SpaceText space = parse(sections).problem.space;
  EXPECT_EQ(space.parameters[2].kind, ParameterKind::kRange);
  EXPECT_EQ(space.parameters[2].range_upper, "0.002");
  EXPECT_THAT(space.constraints, ElementsAre("(1000*px) - (1000*py)"));
}

TEST(CaseFile, WhatACheckObjectsToHasItsPlace) {
  const auto object = [](const Case& /*read*/) { throw FieldError("query.waypoints[1]", "this", "expected that"); };
  EXPECT_THAT([&] { (void)parse_case(Sections().text(), "test.yaml", object); },
              ThrowsMessage<InputError>("test.yaml:11:46: query.waypoints[1]: got this, expected that"));
}

TEST(CaseFile, AParameterThatIsNamedLikeAUnitIsAnOperand) {
  Sections sections;
  sections.space =
      "space: {surface: {parameters: {t: real}, pose: {px: 2*t, py: 0, pz: 350, phi: 0, theta: 1.5 + t, sigma: 0}}}\n";
  sections.query = "query: {waypoints: [{t: 0}, {t: 0.1}]}\n";
  const Case read = parse(sections);
  EXPECT_THAT(read.problem.space.pose[4], HasSubstr("1.5 + t"));
}

TEST(CaseFile, ReadsThePapersSphere) {
  const Case read = load_case(kCaseFolder + "robot2-sphere-q1-q2-q3.yaml");
  const Problem& problem = read.problem;
  EXPECT_THAT(problem.load.wrench, ElementsAre("0", "0", "5.886", "0", "0", "0"));
  EXPECT_EQ(problem.space.pose[2], "(zs - rs*sin(alpha2))*0.001");
  EXPECT_EQ(problem.space.pose[3], "alpha1 - pi");
  EXPECT_EQ(problem.space.pose[5], "0");
  EXPECT_EQ(problem.space.constants.at("zs"), "306");
  EXPECT_EQ(problem.space.parameters[1].range_upper, "pi/2");
  EXPECT_EQ(problem.space.flip, std::nullopt);
  EXPECT_THAT(problem.query[0], ElementsAre("0.55", "pi/2"));
  EXPECT_EQ(read.planner.cost, Cost::kGreatCircle);
}

TEST(CaseFile, EveryCaseOfTheProjectReadsAndTellsItsStory) {
  int files = 0;
  for (const auto& entry : std::filesystem::recursive_directory_iterator(kCaseFolder)) {
    if (entry.path().extension() != ".yaml") continue;
    ++files;
    const Case read = load_case_of_legs(entry.path().string()).whole;
    // What taut init makes of a published robot tells another story.
    EXPECT_THAT(read.description, AnyOf(HasSubstr("Expected: "), HasSubstr("aut init"))) << entry.path();
    EXPECT_NE(read.expect, Expectation::kNone) << entry.path();
  }
  EXPECT_GE(files, 6);
}

std::string contents(const std::string& path) {
  std::ifstream file(path);
  std::ostringstream buffer;
  buffer << file.rdbuf();
  return buffer.str();
}

TEST(CaseFile, ReadsTheExampleOfTheManual) {
  const std::string manual = contents(std::string(TAUT_SOURCE_DIR) + "/docs/case-format.md");
  const std::string fence = "```yaml\n";
  const std::size_t begin = manual.find(fence) + fence.size();
  EXPECT_EQ(parse_case(manual.substr(begin, manual.find("```", begin) - begin), "manual").problem.name, "lift");
}

TEST(CaseFile, ReadsTheLeadingCommentOnly) {
  Sections sections;
  sections.head = "# One.\n#\n#   two\ntaut: 1\n# not this\nname: x\n";
  EXPECT_EQ(parse(sections).description, "One.\n\n  two");
}

TEST(CaseFile, TakesSiWhereNoUnitsAreGiven) {
  Sections sections;
  sections.units = "";
  sections.space = "space: {slice: {px: 0, py: 0, pz: 0.35, sigma: 0}}\n";
  const Problem problem = parse(sections).problem;
  EXPECT_EQ(problem.space.pose[2], "0.35");
  EXPECT_EQ(problem.robot.length_m[0].upper, "550");
  EXPECT_THAT(problem.load.point_m, ElementsAre("0", "0", "0"));
}

TEST(CaseFile, ConvertsUnitsExactly) {
  Sections sections;
  sections.units = "units: {length: in, force: kN, moment: kN*mm, mass: g, angle: deg}\n";
  sections.limits = "  tension: [50 mN, 0.0005]\n  length: [3.9, 550 mm]\n";
  sections.load =
      "load: {point: [1, 1 ft, 1 cm], wrench: [0, 0, 1, 0, 2 N*mm, 3], "
      "ellipsoid: {matrix: [[4, 0, 0, 0, 1, 0], [0, 4, 0, 0, 0, 0], [0, 0, 4, 0, 0, 0], "
      "[0, 0, 0, 4, 0, 0], [1, 0, 0, 0, 4, 0], [0, 0, 0, 0, 0, 4]]}}\n";
  sections.space = "space: {slice: {px: 0, py: 1/3, pz: 10, sigma: pi/4 rad}}\n";
  sections.query = "query: {waypoints: [{phi: 10, theta: 0}, {phi: 1.5 rad, theta: 90/4}]}\n";
  const Problem problem = parse(sections).problem;
  EXPECT_EQ(problem.robot.tension_N[0], (Limits{"0.05", "0.5"}));
  EXPECT_EQ(problem.robot.length_m[0], (Limits{"0.09906", "0.55"}));
  EXPECT_THAT(problem.load.point_m, ElementsAre("0.0254", "0.3048", "0.01"));
  EXPECT_THAT(problem.load.wrench, ElementsAre("0", "0", "1000", "0", "0.002", "3"));
  EXPECT_EQ((*problem.load.ellipsoid)[0][0], "0.000004");  // 4 per kN^2
  EXPECT_EQ((*problem.load.ellipsoid)[0][4], "0.001");     // 1 per kN · kN*mm
  EXPECT_EQ((*problem.load.ellipsoid)[4][4], "4");         // 4 per (kN*mm)^2
  EXPECT_THAT(problem.space.pose, ElementsAre("0", "(1/3)*0.0254", "0.254", "phi", "theta", "pi/4"));
  EXPECT_THAT(problem.query, ElementsAre(ElementsAre("(10)*pi/180", "0"), ElementsAre("1.5", "(90/4)*pi/180")));
}

TEST(CaseFile, HangsAMassExactly) {
  Sections sections;
  sections.load = "load: {mass: 600 g, gravity: [0.1, 0, -9.81], ellipsoid: {diagonal: [1, 1, 1, 1, 1, 1]}}\n";
  EXPECT_THAT(parse(sections).problem.load.wrench, ElementsAre("0.06", "0", "-5.886", "0", "0", "0"));
}

TEST(CaseFile, TakesSixPairsOfLimits) {
  Sections sections;
  sections.limits = "  tension: [[1, 2], [1, 3], [1, 4], [1, 5], [1, 6], [1, 7]]\n  length: [100, 550]\n";
  EXPECT_EQ(parse(sections).problem.robot.tension_N[5], (Limits{"1", "7"}));
}

TEST(CaseFile, FreesAllSixCoordinatesInABox) {
  Sections sections;
  sections.space = "space: {free: {pz: [50, 600], px: [-300, 300], py: [-30 cm, 300]}}\n";
  const std::string pose = "px: 0, py: 10, pz: 350, phi: 0, theta: 0, sigma: 0";
  sections.query = "query: {waypoints: [{" + pose + "}, {" + pose + "}]}\n";
  const SpaceText space = parse(sections).problem.space;
  EXPECT_THAT(space.pose, ElementsAre("px", "py", "pz", "phi", "theta", "sigma"));
  EXPECT_EQ(space.parameters[1].range_lower, "-0.3");
  EXPECT_EQ(space.parameters[2].range_upper, "0.6");
  EXPECT_EQ(space.parameters[5].kind, ParameterKind::kPeriodic);
  EXPECT_EQ(space.flip, (std::array{3, 4}));
  sections.query = "query: {waypoints: [{" + pose + "}, {" + pose + ", pz: 1}]}\n";
  expect_rejected(sections, "got 'pz' twice");
}

TEST(CaseFile, RejectsABoxThatIsNone) {
  Sections sections;
  sections.query = "query: {waypoints: [{px: 0, py: 0, pz: 0, phi: 0, theta: 0, sigma: 0}]}\n";
  sections.space = "space: {free: {px: [300, -300], py: [0, 1], pz: [0, 1]}}\n";
  expect_rejected(sections, "test.yaml:10:20: space.parameters.px: got [300, -300], expected lower < upper");
  sections.space = "space: {free: {px: [1, 1], py: [0, 1], pz: [0, 1]}}\n";
  expect_rejected(sections, "got [1, 1], expected lower < upper");
  sections.space = "space: {free: {px: [0, 1], py: 1, pz: [0, 1]}}\n";
  expect_rejected(sections, "space.free.py: got '1', expected a range [lower, upper]");
}

TEST(CaseFile, BoundsCoordinatesThatASliceLeavesFree) {
  Sections sections;
  sections.space =
      "space: {slice: {px: [-300, 0.25 m], py: 0, pz: [1/4, 600], phi: 0, theta: 0.1, sigma: [-10 deg, 1]}}\n";
  sections.query = "query: {waypoints: [{px: -300, pz: 300, sigma: 0}, {px: 250, pz: 500, sigma: 1}]}\n";
  const Problem level = parse(sections).problem;
  const SpaceText& space = level.space;
  ASSERT_EQ(space.parameters.size(), 3u);
  for (const Parameter& parameter : space.parameters)
    EXPECT_EQ(parameter.kind, ParameterKind::kRange) << parameter.name;
  EXPECT_THAT(space.pose, ElementsAre("px", "0", "pz", "0", "0.1", "sigma"));
  EXPECT_EQ(space.parameters[0].range_lower, "-0.3");
  EXPECT_EQ(space.parameters[0].range_upper, "0.25");
  EXPECT_EQ(space.parameters[2].range_upper, "1");
  EXPECT_THAT(level.query[1], ElementsAre("0.25", "0.5", "1"));

  // What is bounded keeps its names apart: theta = 0 and phi = pi are ends there.
  sections.space = "space: {slice: {px: 0, py: 0, pz: 350, theta: [0, 1], sigma: 0}}\n";
  sections.query = "query: {waypoints: [{phi: 0, theta: 0.5}, {phi: 1, theta: 1}]}\n";
  EXPECT_EQ(parse(sections).problem.space.flip, std::nullopt);
  EXPECT_EQ(parse(sections).problem.space.parameters[0].kind, ParameterKind::kPeriodic);

  sections.query = "query: {waypoints: [{phi: 0, theta: 0.5}, {phi: 1, theta: 1.01}]}\n";
  expect_rejected(sections, "query.waypoints[1].theta: got '1.01', expected a value in the parameter's range [0, 1]");
  sections.space = "space: {slice: {px: 0, py: 0, pz: 350, theta: [1, 0], sigma: 0}}\n";
  expect_rejected(sections, "test.yaml:10:47: space.parameters.theta: got [1, 0], expected lower < upper");
  sections.space = "space: {slice: {px: 0, py: 0, pz: 350, theta: [0, 1, 2], sigma: 0}}\n";
  expect_rejected(sections, "space.slice.theta: got [0, 1, 2], expected a range [lower, upper]");
  sections.space = "space: {slice: {px: 0, py: 0, pz: 350, theta: [0, 3 mm], sigma: 0}}\n";
  expect_rejected(sections, "space.slice.theta[1]: got '3 mm', expected a number or constant");
}

TEST(CaseFile, FlipsOnlyWherePhiAndThetaAreFree) {
  Sections sections;
  sections.space = "space: {slice: {px: 0, py: 0, pz: 350, phi: 0}}\n";
  sections.query = "query: {waypoints: [{theta: 0, sigma: 0}, {theta: 1, sigma: 1}]}\n";
  EXPECT_EQ(parse(sections).problem.space.flip, std::nullopt);
  sections.space = "space: {slice: {px: 0, py: 0, phi: 0, theta: pi/2, sigma: 0}}\n";
  sections.query = "query: {waypoints: [{pz: 300}, {pz: 12 in}]}\n";
  const Problem lift = parse(sections).problem;
  EXPECT_EQ(lift.space.pose[4], "pi/2");
  EXPECT_THAT(lift.query, ElementsAre(ElementsAre("0.3"), ElementsAre("0.3048")));
}

TEST(CaseFile, PlacesEachMistake) {
  Sections sections;
  sections.limits = "  tension: [0.05, 0.5]\n  length: [550, 100]\n";
  expect_rejected(sections, "test.yaml:8:11: robot.length[0]: got [550, 100], expected 0 <= lower < upper");
  sections.limits = "  tension: [0.05, oops]\n  length: [100, 550]\n";
  expect_rejected(sections, "test.yaml:7:19: robot.tension[1]: got 'oops', expected a decimal number");
}

TEST(CaseFile, SuggestsTheKeyThatWasMeant) {
  Sections sections;
  sections.tail = "exepct: proved\n";
  expect_rejected(sections, "got the unknown key 'exepct', did you mean 'expect'? expected taut, name");
  sections.tail = "entirely_different: 1\n";
  expect_rejected(sections, "got the unknown key 'entirely_different', expected taut, name");
}

TEST(CaseFile, MissesEachRequiredSection) {
  const auto missing = [](std::string Sections::*section, const std::string& key) {
    Sections sections;
    sections.*section = "";
    expect_rejected(sections, "expected the key '" + key + "'");
  };
  missing(&Sections::head, "taut");
  missing(&Sections::limits, "tension");
  missing(&Sections::load, "load");
  missing(&Sections::space, "space");
}

TEST(CaseFile, NeedsNeitherSpaceNorQueryForAnAudit) {
  Sections sections;
  sections.query = "";
  EXPECT_TRUE(parse_case(sections.text(), "test.yaml").problem.query.empty());
  sections.space = "";
  const Problem problem = parse_case(sections.text(), "test.yaml").problem;
  EXPECT_EQ(problem.space.parameters.size(), 6U);
  EXPECT_THAT(problem.space.pose, ElementsAre("px", "py", "pz", "phi", "theta", "sigma"));
}

TEST(CaseFile, ReadsTolerancesExactly) {
  Sections sections;
  sections.tail =
      "tolerances: {base_anchors: 0.5, platform_anchors: [0.1, 0.2, 0.3 cm, 0, 0, 0], load_point: 2, "
      "wrench: [0, 0, 0.05, 0, 0, 0], position: 1, orientation: 0.2 deg, cable_length: 1}\n" +
      sections.tail;
  const TolerancesText t = parse_case(sections.text(), "test.yaml").problem.tolerances.value();
  EXPECT_THAT(t.base_anchor_m, testing::Each("0.0005"));
  EXPECT_THAT(t.platform_anchor_m, ElementsAre("0.0001", "0.0002", "0.003", "0", "0", "0"));
  EXPECT_EQ(t.load_point_m, "0.002");
  EXPECT_THAT(t.wrench, ElementsAre("0", "0", "0.05", "0", "0", "0"));
  EXPECT_EQ(t.position_m, "0.001");
  EXPECT_EQ(t.orientation_rad, "(0.2)*pi/180");
  EXPECT_THAT(t.cable_length_m.value(), testing::Each("0.001"));
}

TEST(CaseFile, RefusesTolerancesThatAreNone) {
  for (const auto& [typed, message] : std::vector<std::pair<std::string, std::string>>{
           {"{position: -1}", "tolerances.position: got '-1', expected a tolerance >= 0"},
           {"{base_anchors: [0, 0, 0, 0, 0, -1]}", "expected a tolerance >= 0"},
           {"{orientation: 60 deg}", "expected an angle from 0 to below 1 rad"},
           {"{mass: 1}", "a tolerance of the mass only where 'load' has 'mass' and 'gravity'"},
           {"{anchors: 1}", "anchors"},
           {"{position: 1, position: 2}", "position"},
           {"{cable_length: nan}", "cable_length"}}) {
    Sections sections;
    sections.tail = "tolerances: " + typed + "\n" + sections.tail;
    expect_rejected(sections, message);
  }
}

/// One section replaced, and what is said about it.
struct Mistake {
  std::string Sections::*section;
  std::string text;
  std::string message;
};

TEST(CaseFile, RejectsEveryMistake) {
  const std::string e = "ellipsoid: {diagonal: [1, 1, 1, 1, 1, 1]}";
  const std::string w = "wrench: [0, 0, 1, 0, 0, 0]";
  const std::string surface = "space: {surface: {parameters: {phi: periodic, theta: real}, pose: {px: 0, py: 0, pz: ";
  const std::vector<Mistake> mistakes = {
      {&Sections::head, "taut: 2\nname: x\n", "taut: got '2', expected 1"},
      {&Sections::head, "taut: 1\nname: [x]\n", "name: got [x], expected a name"},
      {&Sections::head, "taut: 1\nname:\n", "name: got nothing, expected a name"},
      {&Sections::head, "taut: 1\nname: \"a\\nb\"\n", "expected a name"},
      {&Sections::head, "taut: 1\nname: a\nname: b\n", "got 'name' twice"},
      {&Sections::head, "taut: 1\nname: a\n? [1]\n: 2\n", "got a compound key"},
      {&Sections::units, "units: {length: yard}\n", "units.length: got 'yard', expected one of m, mm, cm, km, in, ft"},
      {&Sections::units, "units: {length: N}\n", "expected one of m, mm"},
      {&Sections::units, "units: {moment: N*in}\n", "units.moment: got 'N*in'"},
      {&Sections::units, "units: {tempo: s}\n", "got the unknown key 'tempo'"},
      {&Sections::units, "units: mm\n", "units: got 'mm', expected a map"},
      {&Sections::robot, "robot:\n  base_anchors: [[0, 0, 0]]\n",
       "robot.base_anchors: got a list of 1, expected a list of six"},
      {&Sections::limits, "  tension: [-1, 0.5]\n  length: [1, 2]\n", "robot.tension[0]: got [-1, 0.5], expected 0 <="},
      {&Sections::limits, "  tension: [1, .nan]\n  length: [1, 2]\n", "got '.nan', expected a decimal number"},
      {&Sections::limits, "  tension: [1, .inf]\n  length: [1, 2]\n", "got '.inf', expected a decimal number"},
      {&Sections::limits, "  tension: [1, 1e999]\n  length: [1, 2]\n", "got '1e999', expected zero or a magnitude"},
      {&Sections::limits, "  tension: [1, 2 mm]\n  length: [1, 2]\n", "got '2 mm', expected a force"},
      {&Sections::limits, "  tension: [1, 1e299 MN]\n  length: [1, 2]\n", "expected zero or a magnitude"},
      {&Sections::limits, "  tension: [1, ]\n  length: [1, 2]\n", "expected a pair [lower, upper], or six of them"},
      {&Sections::limits, "  tension: [1, '']\n  length: [1, 2]\n", "got '', expected a force"},
      {&Sections::limits, "  tension: 5\n  length: [1, 2]\n", "robot.tension: got '5', expected a pair"},
      {&Sections::limits, "  tension: [[1, 2], [3, 4]]\n  length: [1, 2]\n", "robot.tension: got a list of 2"},
      {&Sections::load, "load: {" + e + "}\n", "load: got neither of 'wrench' and 'mass'"},
      {&Sections::load, "load: {mass: 1, " + w + ", " + e + "}\n", "load: got both of 'wrench' and 'mass'"},
      {&Sections::load, "load: {mass: 1, " + e + "}\n", "load: got no 'gravity'"},
      {&Sections::load, "load: {mass: 0, gravity: [0, 0, 9.81], " + e + "}\n",
       "load.mass: got '0', expected a mass above"},
      {&Sections::load, "load: {gravity: [0, 0, 1], " + w + ", " + e + "}\n", "load.gravity: got [0, 0, 1], expected"},
      {&Sections::load, "load: {" + w + "}\n", "expected the key 'ellipsoid'"},
      {&Sections::load, "load: {" + w + ", ellipsoid: {diagonal: [1, 1, 1]}}\n",
       "load.ellipsoid.diagonal: got [1, 1, 1]"},
      {&Sections::load, "load: {" + w + ", ellipsoid: {diagonal: [1, 1, 1, 1, 1, -1]}}\n", "positive definite"},
      {&Sections::load, "load: {" + w + ", ellipsoid: {}}\n", "load.ellipsoid: got 0 keys"},
      {&Sections::load, "load: {wrench: [0, 0, 1 N*m, 0, 0, 0], " + e + "}\n", "got '1 N*m', expected a force"},
      {&Sections::space, "space: {slice: {px: 0}, free: {}}\n", "space: got 2 kinds of space"},
      {&Sections::space, "space: {}\n", "space: got 0 kinds of space"},
      {&Sections::space, "space: {implicit: [px], surface: {}}\n", "space: got 2 kinds of space"},
      {&Sections::space, "space: {implicit: px}\n", "test.yaml:10:19: space.implicit: got 'px', expected a list"},
      {&Sections::space, "space: {implicit: []}\n", "space.implicit: got [], expected at least one constraint"},
      {&Sections::space, "space: {implicit: [[px]]}\n", "space.implicit[0]: got [px], expected an expression"},
      {&Sections::space, "space: {implicit: [px + qx]}\n",
       "test.yaml:10:20: space.implicit[0]: expression 'px + qx', column 6: got 'qx', expected a number, one of the "
       "names px,"},
      {&Sections::space, "space: {slice: {px: 0, py: 0, pz: 350, sigma: 0}, implicit: [px + pz - 3]}\n",
       "space.implicit[0]: got 'px + pz - 3', expected an expression that mentions a coordinate"},
      {&Sections::space, "space: {slice: {px: 0, py: 0, pz: 350, sigma: 0}, implicit: [phi - 1]}\n",
       "space.implicit[0]: got 'phi - 1', expected the same value when the periodic parameter phi grows by 2*pi"},
      {&Sections::space, "space: {slice: {px: 0, py: 0, pz: 350, sigma: 0}, implicit: [theta, theta + 1]}\n",
       "space.implicit: got [theta, theta + 1], expected fewer than the 2 parameters"},
      {&Sections::space, "space: {slice: {px: 0, py: 0, pz: 1, phi: 0, theta: 0, sigma: 0}}\n",
       "got all six coordinates"},
      {&Sections::space, "space: {slice: {px: 0, py: 0, pz: 1/0, sigma: 0}}\n",
       "got '1/0', expected an expression with a finite"},
      {&Sections::space, "space: {slice: {px: 0, py: 0, pz: 350, sigma: 3 mm}}\n",
       "got '3 mm', expected a number or constant"},
      {&Sections::space, "space: {slice: {px: 0, py: 0, pz: 3 +, sigma: 0}}\n",
       "space.slice.pz: expression '3 +', column 4"},
      {&Sections::space, "space: {free: {px: [0, 1], py: [0, 1]}}\n", "space.free: got no 'pz'"},
      {&Sections::space, surface + "0, phi: phi, theta: theta}}}\n", "space.surface.pose: got no 'sigma'"},
      {&Sections::space, surface + "0, phi: phi, theta: theta, sigma: psi}}}\n",
       "expected a number, one of the names phi, theta"},
      {&Sections::space, surface + "phi, phi: phi, theta: theta, sigma: 0}}}\n",
       "space.surface.pose.pz: got 'phi', expected the same value when the periodic parameter phi grows by 2*pi"},
      {&Sections::space, surface + "0, phi: phi, theta: theta, sigma: 0}, constants: {k: two}}}\n",
       "got 'two', expected a decimal"},
      {&Sections::space, surface + "0, phi: phi, theta: theta, sigma: 0}, constants: {phi: 2}}}\n",
       "expected to be given once"},
      {&Sections::space, "space: {surface: {parameters: {}, pose: {}}}\n", "got no parameter"},
      {&Sections::space, "space: {surface: {parameters: {phi: round}, pose: {}}}\n",
       "got 'round', expected 'periodic', 'real' or"},
      {&Sections::query, "query: {waypoints: [{phi: 1, theta: 1}]}\n", "expected at least two"},
      {&Sections::query, "query: {waypoints: []}\n", "expected a list of at least two"},
      {&Sections::query, "query: {waypoints: 7}\n", "query.waypoints: got '7', expected a list"},
      {&Sections::query, "query: {waypoints: [{phi: 1, theta: 1}, {phi: 1}]}\n", "query.waypoints[1]: got no 'theta'"},
      {&Sections::query, "query: {waypoints: [{phi: 1, theta: 1}, {phi: 1, teta: 1}]}\n", "did you mean 'theta'?"},
      {&Sections::query, "query: {waypoints: [{phi: 1, theta: 1}, {phi: 1, theta: log(0)}]}\n",
       "expected an expression with a finite"},
      {&Sections::query, "query: {waypoints: [{phi: 1, theta: 1}, {phi: 1, theta: [1]}]}\n",
       "got [1], expected a number"},
      {&Sections::tail, "planner: {strategy: dijkstra}\n",
       "planner.strategy: got 'dijkstra', expected one of astar, greedy"},
      {&Sections::tail, "planner: {cost: time}\n", "expected one of rotation, great_circle, parameters"},
      {&Sections::tail, "planner: {cost: {rotation: 1}}\n", "got the unknown key 'rotation', expected travel"},
      {&Sections::tail, "planner: {cost: {travel: {}, travel: {}}}\n", "got 'travel' twice"},
      {&Sections::tail, "planner: {cost: {travel: {per_radian: -1 mm}}}\n",
       "planner.cost.travel.per_radian: got '-1 mm', expected a length >= 0"},
      {&Sections::tail, "planner: {cost: {travel: {per_radian: 1 N}}}\n", "got '1 N', expected a length"},
      {&Sections::tail, "planner: {cost: {travel: {point: [1, 2]}}}\n",
       "planner.cost.travel.point: got [1, 2], expected a point of the platform: a list of three lengths"},
      {&Sections::tail, "planner: {radius: 0}\n", "planner.radius: got '0', expected a number above zero"},
      {&Sections::tail, "planner: {epsilon: .inf}\n", "planner.epsilon: got '.inf', expected a decimal number"},
      {&Sections::tail, "planner: {max_charts: 1.5}\n", "planner.max_charts: got '1.5', expected a whole number"},
      {&Sections::tail, "planner: {max_seconds: 0}\n", "planner.max_seconds: got '0', expected a number above zero"},
      {&Sections::tail, "planner: {max_charts: 99999999999999}\n", "expected a whole number from 1"},
      {&Sections::tail, "expect: yes\n", "expect: got 'yes', expected one of proved, refuted, undecided"},
      {&Sections::tail, "---\ntaut: 1\n", "got several YAML documents"},
      {&Sections::tail, "expect: [proved\n", "got text that is not YAML"},
      {&Sections::tail, "expect: *nobody\n", "got text that is not YAML"},
  };
  for (const Mistake& mistake : mistakes) {
    Sections sections;
    sections.*mistake.section = mistake.text;
    expect_rejected(sections, mistake.message);
  }
}

TEST(CaseFile, RejectsFilesThatAreNoCases) {
  for (const char* text : {"", "# nothing\n", "just words\n", "[1, 2]\n", "42\n", "\t\n", "{", "%\n"})
    expect_rejected(text, "expected");
  expect_rejected(std::string(2 << 20, ' '), "got more than");
  EXPECT_THROW((void)load_case("/nonexistent/case.yaml"), InputError);
  EXPECT_THROW((void)load_case(kCaseFolder), InputError);
}

TEST(CaseFile, IsNotBroughtDownByHostileYaml) {
  expect_rejected(std::string(500000, '['), "expected");
  expect_rejected(std::string(500000, '{'), "expected");
  for (const char* stray : {"}", "]", "a: 1\n---\n}", "taut: 1\n}\n", "taut: 1\n...\n]", ","})
    expect_rejected(stray, "expected");
  std::string nested = "taut: ";
  nested.append(5000, '[').append(5000, ']').append("\n");
  expect_rejected(nested, "expected");
  expect_rejected("a: &a [*a]\ntaut: *a\n", "expected");
  std::string bomb = "a0: &a0 [x, x]\n";
  for (int i = 1; i < 60; ++i) {
    const std::string previous = "*a" + std::to_string(i - 1);
    std::ostringstream line;
    line << "a" << i << ": &a" << i << " [" << previous << ", " << previous << "]\n";
    bomb += line.str();
  }
  expect_rejected(bomb, "unknown key");
}

TEST(CaseFile, TakesAliases) {
  Sections sections;
  sections.limits = "  tension: &pair [1, 2]\n  length: *pair\n";
  EXPECT_EQ(parse(sections).problem.robot.length_m[0], (Limits{"0.001", "0.002"}));
}

TEST(CaseFileLaws, MutatedCasesAreReadOrRejectedButNeverCrash) {
  const std::string good = contents(kCaseFolder + "robot2-sphere-q1-q2-q3.yaml");
  EXPECT_TRUE(rc::check([&] {
    std::string text = good;
    for (int i = *rc::gen::inRange(1, 6); i > 0; --i) {
      const auto at = static_cast<std::size_t>(*rc::gen::inRange(0, static_cast<int>(text.size())));
      const auto length = static_cast<std::size_t>(*rc::gen::inRange(0, 12));
      text.replace(at, length, *rc::gen::container<std::string>(rc::gen::inRange(' ', '~')));
    }
    try {
      const Problem problem = parse_case(text, "mutant.yaml").problem;
      const nlohmann::json json = to_json(problem);
      RC_ASSERT(to_json(problem_from_json(json)) == json);
    } catch (const InputError& error) {
      RC_ASSERT(std::string(error.what()).starts_with("mutant.yaml"));
    }
  }));
}

}  // namespace
}  // namespace taut
