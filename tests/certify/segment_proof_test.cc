// SPDX-License-Identifier: GPL-3.0-or-later
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>

#include "base/input_error.h"
#include "certify/path_proof.h"
#include "certify/prover.h"
#include "tests/oracle/oracle_at_origin.h"
#include "tests/support/robots.h"

namespace taut {
namespace {

using testing::at;
using testing::robot1_slice;

const Waypoint kStart = at({-2.3, 1.6});
const Waypoint kNearStart = at({-2.25, 1.5});

void expect_cover(const std::vector<DyadicBox>& boxes) {
  ASSERT_FALSE(boxes.empty());
  EXPECT_EQ(boxes.front().lower(), Dyadic{});
  EXPECT_EQ(boxes.back().upper(), (Dyadic{1, 0}));
  for (std::size_t k = 1; k < boxes.size(); ++k) EXPECT_EQ(boxes[k - 1].upper(), boxes[k].lower());
}

TEST(QueryWaypoints, AreTheNearestBinary64OfEachExpression) {
  Problem problem = robot1_slice();
  std::string many = "0";  // with another expression, too many operations for one tape
  for (int k = 1; k <= 30; ++k) many += " + sin(" + std::to_string(k) + ")/7";
  problem.query = {{"cos(0.75)*pi/180", "sin(0.75)*pi/180 + 0.1"},
                   {"1 + 1.110223024625156540423631668090820312500e-16", "-0.0"},
                   {many, "1/3"}};
  const std::vector<Waypoint> waypoints = query_waypoints(problem);
  ASSERT_EQ(waypoints.size(), problem.query.size());
  for (std::size_t k = 0; k < waypoints.size(); ++k) {
    for (std::size_t j = 0; j < 2; ++j)
      EXPECT_EQ(waypoints[k].parameters().x[j], nearest_binary64(problem.query[k][j])) << k << j;
    EXPECT_EQ(waypoints[k].parameters().half_turns, std::vector<int>(2, 0));
  }
  EXPECT_FALSE(std::signbit(waypoints[1].parameters().x[1]));
}

TEST(QueryWaypoints, NameTheExpressionThatIsNoNumber) {
  Problem problem = robot1_slice();
  problem.query = {{"cos(1)", "1/(2 - 2)"}};
  try {
    (void)query_waypoints(problem);
    FAIL() << "1/(2 - 2) is no number";
  } catch (const InputError& error) {
    EXPECT_NE(std::string(error.what()).find("1/(2 - 2)"), std::string::npos) << error.what();
  }
}

TEST(Prover, ProvesAShortSegmentAndCoversItWithBoxes) {
  const Prover prover(robot1_slice());
  const SegmentProof proof = prover.prove(kStart, kNearStart);
  ASSERT_EQ(proof.verdict, Verdict::kProved) << proof.reason;
  expect_cover(proof.boxes);
  EXPECT_GT(proof.tension_N, 0);
  EXPECT_GT(proof.length_m, 0);
  EXPECT_GE(proof.wrench_scale, 1.0);
}

TEST(Prover, LearnsFromABoxHowLargeTheNextMayBe) {
  const Prover prover(robot1_slice());
  int judged = 0;
  int by_halving = 0;
  for (int k = 1; k <= 6; ++k) {
    const SegmentProof proof = prover.prove(kStart, at({-2.3 + 0.05 * k, 1.6 - 0.1 * k}));
    if (proof.verdict != Verdict::kProved) continue;
    expect_cover(proof.boxes);
    judged += proof.boxes_judged;
    by_halving += 2 * static_cast<int>(proof.boxes.size()) - 1;
  }
  ASSERT_GT(by_halving, 10);
  EXPECT_LT(judged, 0.9 * by_halving);
}

// The violation is at the middle of the whole segment, and strides begin with smaller boxes, of which none shows it
// before the walk is next to the limit.
TEST(Prover, RefutesByTheMiddleOfABoxThatStridesPassOver) {
  Problem problem = testing::free_flying(robot1_slice());
  problem.robot.base_anchors_m[0] = {"0", "0.25", "0"};
  problem.robot.platform_anchors_m[0] = {"0", "0.25", "0"};
  for (auto& limits : problem.robot.tension_N) limits = {"-1000", "1000"};
  for (auto& limits : problem.robot.length_m) limits = {"0.01", "10"};
  problem.robot.length_m[0].lower = "0.50000000000000000000000000000000000000000000000001";  // at x = 0 alone
  const auto place = [](double x) { return Waypoint{{x, 0, 0.5, 0, 0, 0}, std::vector<int>(6, 0)}; };
  const SegmentProof proof = Prover(problem).prove(place(-0.75), place(0.75));
  ASSERT_EQ(proof.verdict, Verdict::kRefuted) << proof.reason;
  EXPECT_EQ(proof.witness->box, DyadicBox{});
}

TEST(Prover, ProvesASegmentOfLengthZero) {
  const SegmentProof proof = Prover(robot1_slice()).prove(kStart, kStart);
  EXPECT_EQ(proof.verdict, Verdict::kProved);
  EXPECT_EQ(proof.boxes.size(), 1u);
}

TEST(Prover, ProvesNothingOfWaypointsOfAnotherLaw) {
  const Prover prover(testing::robot1_slice());
  const Waypoint parameters{{-2.3, 1.6}, {0, 0}};
  const Waypoint pose(PosePoint{{0, 0, 0.35, 0, 0, 0.6, 0.8}});
  const std::array segments = {Segment::straight(pose, pose), Segment::straight(parameters, pose),
                               Segment::between(Interpolation::kGeodesic, pose, parameters),
                               Segment::between(Interpolation::kCableLengths, pose, pose)};
  for (const Segment& segment : segments) EXPECT_EQ(prover.prove(segment).verdict, Verdict::kUndecided);
}

TEST(Prover, ProvesTheSameBothWays) {
  const Prover prover(robot1_slice());
  EXPECT_EQ(prover.prove(kNearStart, kStart).verdict, Verdict::kProved);
}

TEST(Prover, RefutesTheStraightMotionOfThePaperEitherWayRound) {
  const Prover prover(robot1_slice());
  for (const int half_turns : {0, -2}) {
    Waypoint goal = at({1.7, 1.7});
    goal.parameters().half_turns[0] = half_turns;
    const SegmentProof proof = prover.prove(kStart, goal);
    ASSERT_EQ(proof.verdict, Verdict::kRefuted);
    ASSERT_TRUE(proof.witness.has_value());
    EXPECT_TRUE(proof.boxes.empty() || proof.boxes.back().upper() < (Dyadic{1, 0}));
  }
}

TEST(Prover, TheWitnessOfARefutationStandsUpToTheOracle) {
  const Problem problem = robot1_slice();
  const Prover prover(problem);
  const Waypoint goal = at({1.7, 1.7});
  const SegmentProof proof = prover.prove(kStart, goal);
  ASSERT_EQ(proof.verdict, Verdict::kRefuted);
  ASSERT_FALSE(proof.witness->singular);
  const PrecisionScope precision(oracle::kBits);
  const BigFloat s(proof.witness->box.mid().approx());
  const oracle::Big6 pose = {BigFloat(0.0),
                             BigFloat(0.0),
                             oracle::big("0.35"),
                             BigFloat(-2.3) + s * (BigFloat(1.7) - BigFloat(-2.3)),
                             BigFloat(1.6) + s * (BigFloat(1.7) - BigFloat(1.6)),
                             BigFloat(34.0) * oracle::pi() / BigFloat(180.0)};
  const auto statics = oracle::statics(problem, pose);
  const auto i = static_cast<std::size_t>(proof.witness->margin.cable);
  switch (proof.witness->margin.kind) {
    case MarginKind::kTensionMin:
      EXPECT_LE(statics.tension[i] - statics.tension_radius[i], oracle::big(problem.robot.tension_N[i].lower));
      break;
    case MarginKind::kTensionMax:
      EXPECT_GE(statics.tension[i] + statics.tension_radius[i], oracle::big(problem.robot.tension_N[i].upper));
      break;
    case MarginKind::kLengthMin: EXPECT_LE(statics.length[i], oracle::big(problem.robot.length_m[i].lower)); break;
    case MarginKind::kLengthMax: EXPECT_GE(statics.length[i], oracle::big(problem.robot.length_m[i].upper)); break;
  }
}

TEST(Prover, AWholeTurnApartIsTheSameMotion) {
  const Prover prover(robot1_slice());
  Waypoint a = kStart;
  Waypoint b = kNearStart;
  a.parameters().half_turns[0] = b.parameters().half_turns[0] = 2;
  const SegmentProof here = prover.prove(kStart, kNearStart);
  const SegmentProof there = prover.prove(a, b);
  ASSERT_EQ(there.verdict, Verdict::kProved);
  EXPECT_NEAR(here.tension_N, there.tension_N, 1e-12);
}

TEST(Prover, TheFlippedImageIsTheSameMotion) {
  const Prover prover(robot1_slice());
  Waypoint a = at({-2.3, -1.6});
  Waypoint b = at({-2.25, -1.5});
  a.parameters().half_turns[0] = b.parameters().half_turns[0] = 1;
  const SegmentProof here = prover.prove(kStart, kNearStart);
  const SegmentProof there = prover.prove(a, b);
  ASSERT_EQ(there.verdict, Verdict::kProved);
  EXPECT_NEAR(here.wrench_scale, there.wrench_scale, 1e-9);
}

TEST(Prover, GoesThroughThetaZero) {
  const Prover prover(robot1_slice());
  EXPECT_EQ(prover.prove(at({-2.0, 0.05}), at({-2.0, -0.05})).verdict, Verdict::kProved);
}

/// The length of cable 1 of a platform that hangs still, as a limit: the margin is exactly zero.
TEST(Prover, StaysUndecidedWhereAMarginVanishesExactly) {
  Problem problem = testing::free_flying(robot1_slice());
  problem.robot.base_anchors_m[0] = {"0", "0.25", "0"};
  problem.robot.platform_anchors_m[0] = {"0", "0.25", "0"};
  for (auto& limits : problem.robot.tension_N) limits = {"-1000", "1000"};
  problem.robot.length_m[0].upper = "0.5";  // p = (0, 0, 0.5), R = I: cable 1 is exactly 0.5 m long
  const Waypoint pose = at({0, 0, 0.5, 0, 0, 0});
  const SegmentProof proof = Prover(problem).prove(pose, pose);
  EXPECT_NE(proof.verdict, Verdict::kProved);  // the limit is open: at it is not inside
  problem.robot.length_m[0].upper = "0.50000000000000000000000000000001";
  EXPECT_EQ(Prover(problem).prove(pose, pose).verdict, Verdict::kProved) << "a margin of 1e-32 m is positive";
  problem.robot.length_m[0].upper = "0.49999999999999999999999999999999";
  EXPECT_EQ(Prover(problem).prove(pose, pose).verdict, Verdict::kRefuted);
}

TEST(Prover, DoesNotProveThroughASingularity) {
  // Between q_s and the far side lies det J = 0; with limits this wide only the singularity stands in the way.
  Problem problem = robot1_slice();
  for (auto& limits : problem.robot.tension_N) limits = {"-1e12", "1e12"};
  for (auto& limits : problem.robot.length_m) limits = {"0", "100"};
  const Prover prover(problem);
  const SegmentProof proof = prover.prove(kStart, at({1.7, 1.7}));
  EXPECT_NE(proof.verdict, Verdict::kProved);
}

TEST(Prover, RefutesASingularSegmentByAChangeOfSign) {
  // A weightless platform has no tensions at all: w0 = 0, and only det J tells.
  Problem problem = robot1_slice();
  problem.load.wrench = {"0", "0", "0", "0", "0", "0"};
  for (std::size_t i = 0; i < 6; ++i) problem.load.ellipsoid.value()[i][i] = "1e300";
  for (auto& limits : problem.robot.tension_N) limits = {"-1e9", "1e9"};
  for (auto& limits : problem.robot.length_m) limits = {"0", "100"};
  const Prover prover(problem);
  const SegmentProof proof = prover.prove(kStart, at({1.7, 1.7}));
  ASSERT_EQ(proof.verdict, Verdict::kRefuted) << proof.reason;
  ASSERT_TRUE(proof.witness->singular);
  const auto model = [&] {
    const PrecisionScope precision(256);
    return make_mp_proof_model(problem);
  }();
  const PrecisionScope precision(256);
  EXPECT_EQ(determinant_sign(model, Segment::straight(kStart, at({1.7, 1.7})), proof.witness->box.lower()) *
                determinant_sign(model, Segment::straight(kStart, at({1.7, 1.7})), proof.witness->box.upper()),
            -1);
}

TEST(Prover, AnInterruptedProofIsUndecided) {
  const Prover prover(robot1_slice());
  std::stop_source stop;
  stop.request_stop();
  const SegmentProof proof = prover.prove(kStart, kNearStart, 0, stop.get_token());
  EXPECT_EQ(proof.verdict, Verdict::kUndecided);
  EXPECT_EQ(proof.reason.text(), "interrupted");
}

TEST(Prover, AClearanceAsksForMoreThanTheClaim) {
  const Prover prover(robot1_slice());
  const SegmentProof proof = prover.prove(kStart, kNearStart);
  ASSERT_EQ(proof.verdict, Verdict::kProved);
  // Half the range is 0.225 N for tensions, 0.225 m for lengths.
  const double share = std::min(proof.tension_N, proof.length_m) / 0.225;
  EXPECT_EQ(prover.prove(kStart, kNearStart, 0.9 * share).verdict, Verdict::kProved);
  const SegmentProof too_close = prover.prove(kStart, kNearStart, 0.9);
  EXPECT_EQ(too_close.verdict, Verdict::kUndecided) << "too close is no refutation";
  EXPECT_FALSE(too_close.witness.has_value());
}

TEST(Prover, ABudgetOfBoxesIsKept) {
  ProofOptions options;
  options.max_boxes = 1;
  const SegmentProof proof = Prover(robot1_slice(), options).prove(kStart, at({-2.3, 1.1}));
  EXPECT_EQ(proof.verdict, Verdict::kUndecided);
  EXPECT_LE(proof.boxes_judged, 2);
}

TEST(Prover, RestoresTheCallersRoundingMode) {
  const unsigned before = _mm_getcsr();
  const Prover prover(robot1_slice());
  (void)prover.prove(kStart, kNearStart);
  EXPECT_EQ(_mm_getcsr() & 0x6000u, before & 0x6000u);
}

TEST(Prover, AWildlyScaledProblemIsNeverProvedByOverflow) {
  Problem problem = robot1_slice();
  for (auto& row : problem.load.ellipsoid.value()) row.fill("0");
  for (std::size_t i = 0; i < 6; ++i) problem.load.ellipsoid.value()[i][i] = "1e-300";
  for (auto& anchor :
       problem.robot.platform_anchors_m) {  // of a platform too small to hold K: tensions beyond binary64
    for (DecimalText& coordinate : anchor) coordinate += "e-200";
  }
  const SegmentProof proof = Prover(problem).prove(kStart, kNearStart);
  EXPECT_NE(proof.verdict, Verdict::kProved);
}

/// px is the root of −1e−290, which is no real number, though binary64 and Boost's own root take it for 0.
TEST(Prover, AnUndefinedPoseIsNeitherProvedNorRefuted) {
  Problem problem = robot1_slice();
  problem.space.pose[0] = "sqrt(0.1 + 0.2 - 0.3 - 1e-290)";
  ProofOptions options;
  options.max_multiprecision_boxes = 200;
  const Prover prover(problem, options);
  EXPECT_EQ(prover.prove(kStart, kNearStart).verdict, Verdict::kUndecided);
  EXPECT_EQ(prover.prove(kStart, at({1.7, 1.7})).verdict, Verdict::kUndecided);
}

TEST(Prover, ClosedRangesAreKeptExactly) {
  Problem problem = robot1_slice();
  problem.space.flip.reset();
  problem.space.parameters[1].kind = ParameterKind::kRange;
  problem.space.parameters[1].range_lower = "-0.1";  // the nearest binary64 lies outside
  problem.space.parameters[1].range_upper = "pi/2";  // the nearest binary64 lies inside
  const Prover prover(problem);
  EXPECT_FALSE(prover.certainly_in_ranges(at({0, -0.1})));
  EXPECT_TRUE(prover.certainly_in_ranges(at({0, std::nextafter(-0.1, 0.0)})));
  EXPECT_TRUE(prover.certainly_in_ranges(at({0, 0x1.921fb54442d18p+0})));
  EXPECT_FALSE(prover.certainly_in_ranges(at({0, 0x1.921fb54442d19p+0})));
  EXPECT_EQ(prover.prove(kStart, kNearStart).verdict, Verdict::kUndecided) << "theta = 1.6 exceeds pi/2";
}

TEST(Prover, NamesTheParameterThatIsOutsideItsRange) {
  Problem problem = robot1_slice();
  problem.space.flip.reset();
  problem.space.parameters[1].kind = ParameterKind::kRange;
  problem.space.parameters[1].range_lower = "-0.1";
  problem.space.parameters[1].range_upper = "1.5";
  const Prover prover(problem);
  const SegmentProof beyond = prover.prove(at({0, 0}), at({0, 1.75}));
  EXPECT_EQ(beyond.reason.text(),
            "a waypoint lies outside the closed range of a parameter, or may: theta is 1.75, its range is from -0.1 to "
            "1.5 (SI: m, rad)");
  const SegmentProof rounded = prover.prove(at({0, -0.1}), at({0, 0}));
  EXPECT_NE(rounded.reason.text().find("theta is -0.1 and so, but for rounding, at an end of its range"),
            std::string::npos)
      << rounded.reason;
}

TEST(Prover, HalfTurnsNeedAPeriodicParameter) {
  const Prover prover(robot1_slice());
  Waypoint turned = kStart;
  turned.parameters().half_turns[1] = 2;  // theta
  EXPECT_NE(prover.prove(turned, turned).verdict, Verdict::kProved);
}

TEST(Prover, NumbersBeyondBinary64AreRefused) {
  Problem problem = robot1_slice();
  problem.robot.tension_N[0].upper = "1e400";
  EXPECT_THROW(Prover{problem}, InputError);
}

TEST(Prover, AnEllipsoidThatIsNotPositiveDefiniteIsRefused) {
  Problem problem = robot1_slice();
  problem.load.ellipsoid.value()[0][0] = "-1";
  EXPECT_ANY_THROW(Prover{problem});
}

}  // namespace
}  // namespace taut
