// SPDX-License-Identifier: GPL-3.0-or-later
#include "problem/problem.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <functional>
#include <nlohmann/json.hpp>

#include "base/input_error.h"
#include "case/case_file.h"

namespace taut {
namespace {

using nlohmann::json;
using ::testing::HasSubstr;
using ::testing::ThrowsMessage;

const std::string kCases = std::string(TAUT_SOURCE_DIR) + "/cases/";

Problem slice() { return load_case(kCases + "robot1-slice-qs-qg.yaml").problem; }
Problem sphere() { return load_case(kCases + "robot2-sphere-q1-q2-q3.yaml").problem; }

TEST(ProblemJson, ReadsBackWhatItWrote) {
  for (const Problem& problem : {slice(), sphere()}) {
    const json written = to_json(problem);
    EXPECT_EQ(to_json(problem_from_json(written)), written);
    EXPECT_EQ(to_json(problem_from_json(json::parse(written.dump()))), written);
  }
}

TEST(ProblemJson, CarriesNoFractionalNumber) {
  const std::function<void(const json&)> visit = [&](const json& value) {
    EXPECT_FALSE(value.is_number_float());
    if (value.is_structured()) {
      for (const json& member : value) visit(member);
    }
  };
  visit(to_json(sphere()));
}

TEST(ProblemJson, RejectsEachMissingUnknownOrMistypedMember) {
  const json good = to_json(sphere());
  const json leaves = good.flatten();
  for (const auto& [pointer, leaf] : leaves.items()) {
    json bad = good;
    bad[json::json_pointer(pointer)] = 7;
    EXPECT_THROW((void)problem_from_json(bad), InputError) << pointer;
  }
  for (const char* pointer : {"", "/robot", "/load", "/space", "/space/pose", "/query", "/space/parameters/1"}) {
    json extra = good;
    extra[json::json_pointer(pointer)]["extra"] = "1";
    EXPECT_THROW((void)problem_from_json(extra), InputError) << pointer;
    for (const auto& [key, member] : good[json::json_pointer(pointer)].items()) {
      json bad = good;
      bad[json::json_pointer(pointer)].erase(key);
      EXPECT_THROW((void)problem_from_json(bad), InputError) << pointer << "/" << key;
    }
  }
  for (const json& other : {json(), json(1), json("x"), json::array()}) {
    EXPECT_THROW((void)problem_from_json(other), InputError);
  }
}

/// Validation of a good problem after `spoil` says `message`.
template <class Spoil>
void expect_rejected(Problem problem, Spoil spoil, const std::string& message) {
  ASSERT_NO_THROW(validate(problem));
  spoil(problem);
  EXPECT_THAT([&] { validate(problem); }, ThrowsMessage<FieldError>(HasSubstr(message)));
}

TEST(Validate, RejectsLimitsThatAreNone) {
  expect_rejected(
      slice(),
      [](Problem& p) {
        p.robot.tension_N[2] = {"0.5", "0.5"};
      },
      "robot.tension[2]: got [0.5, 0.5]");
  expect_rejected(
      slice(),
      [](Problem& p) {
        p.robot.length_m[0] = {"-0.1", "1"};
      },
      "expected 0 <= lower < upper");
  expect_rejected(
      slice(), [](Problem& p) { p.robot.length_m[0].upper = "inf"; }, "robot.length[0][1]: got 'inf'");
}

TEST(Validate, RejectsCablesThatAreTheSame) {
  expect_rejected(
      slice(), [](Problem& p) { p.robot.platform_anchors_m[1] = p.robot.platform_anchors_m[0]; },
      "robot: got the same two anchors for cables 1 and 2");
  expect_rejected(
      slice(),
      [](Problem& p) {
        p.robot.base_anchors_m.fill({"0", "0.0", "1"});
      },
      "robot.base_anchors: got the same point six times");
}

TEST(Validate, DecidesDefinitenessExactly) {
  const auto with_block = [](const std::string& off_diagonal) {
    return [=](Problem& p) {
      (*p.load.ellipsoid)[0][0] = "1";
      (*p.load.ellipsoid)[1][1] = "1";
      (*p.load.ellipsoid)[0][1] = (*p.load.ellipsoid)[1][0] = off_diagonal;
    };
  };
  Problem thin = slice();
  with_block("0.9999999999999999999999999999999999999999")(thin);
  EXPECT_NO_THROW(validate(thin));
  expect_rejected(slice(), with_block("1"), "positive definite");
  expect_rejected(slice(), with_block("-1.0000000000000000000000000000000000000001"), "positive definite");
  expect_rejected(
      slice(), [](Problem& p) { (*p.load.ellipsoid)[5][5] = "0"; }, "leading 6 x 6 block");
  expect_rejected(
      slice(), [](Problem& p) { (*p.load.ellipsoid)[0][4] = "1e-30"; }, "expected a symmetric matrix");
}

TEST(Validate, HoldsPeriodicParametersToTheirPeriod) {
  expect_rejected(
      sphere(), [](Problem& p) { p.space.pose[0] = "alpha1"; }, "space.pose.px: got 'alpha1'");
  expect_rejected(
      sphere(), [](Problem& p) { p.space.pose[3] = "alpha1/2"; }, "space.pose.phi: got 'alpha1/2'");
  Problem twice = sphere();
  twice.space.pose[3] = "2*alpha1 - pi";
  EXPECT_NO_THROW(validate(twice));
}

TEST(Validate, HoldsTheFlipToItsConditions) {
  const std::string message = "space.flip: expected";
  expect_rejected(
      slice(),
      [](Problem& p) {
        p.space.flip = {1, 0};
      },
      message);
  expect_rejected(
      slice(),
      [](Problem& p) {
        p.space.flip = {0, 0};
      },
      message);
  expect_rejected(
      slice(), [](Problem& p) { p.space.pose[5] = "phi"; }, message);
  expect_rejected(
      slice(), [](Problem& p) { p.space.pose[0] = "theta - theta"; }, message);
  expect_rejected(
      slice(), [](Problem& p) { p.space.pose[4] = "theta + 0"; }, message);
  expect_rejected(
      slice(), [](Problem& p) { p.space.parameters[0].kind = ParameterKind::kReal; }, message);
  expect_rejected(
      slice(),
      [](Problem& p) {
        p.space.parameters[1] = {"theta", ParameterKind::kRange, "0", "pi"};
      },
      message);
  expect_rejected(
      sphere(),
      [](Problem& p) {
        p.space.flip = {0, 1};
      },
      message);
}

TEST(Validate, HoldsTheQueryToTheSpace) {
  expect_rejected(
      slice(), [](Problem& p) { p.query.pop_back(); }, "query.waypoints: got 1 waypoints");
  expect_rejected(
      slice(), [](Problem& p) { p.query[1].pop_back(); }, "query.waypoints[1]: got 1 values");
  expect_rejected(
      slice(), [](Problem& p) { p.query[0][1] = "1/0"; }, "query.waypoints[0].theta: got '1/0'");
  expect_rejected(
      slice(), [](Problem& p) { p.query[0][1] = "phi"; }, "query.waypoints[0].theta: expression 'phi'");
  expect_rejected(
      sphere(), [](Problem& p) { p.query[0][1] = "1.5708"; }, "in the parameter's range [-pi/2, pi/2]");
  expect_rejected(
      sphere(), [](Problem& p) { p.space.parameters[1].range_upper = "-pi/2"; }, "lower < upper");
  Problem end = sphere();
  end.query[0][1] = "2*pi/4";
  EXPECT_NO_THROW(validate(end));
}

TEST(Validate, WantsADefinedPoseAtEachWaypoint) {
  expect_rejected(
      sphere(), [](Problem& p) { p.space.pose[2] = "1/(alpha2 - 0.75)"; },
      "space.pose.pz: got '1/(alpha2 - 0.75)', expected an expression with a finite value at query.waypoints[1]");
}

TEST(Validate, RejectsASpaceWithoutParametersOrWithBadExpressions) {
  expect_rejected(
      slice(), [](Problem& p) { p.space.parameters.clear(); }, "space.parameters: expected at least one");
  expect_rejected(
      slice(), [](Problem& p) { p.space.pose[2] = "0.35 +"; }, "space.pose.pz: expression");
  expect_rejected(
      slice(), [](Problem& p) { p.space.constants["pi"] = "3"; }, "name 'pi'");
  expect_rejected(
      slice(), [](Problem& p) { p.space.constants["k"] = "three"; }, "space.constants.k: got 'three'");
}

}  // namespace
}  // namespace taut
