// SPDX-License-Identifier: GPL-3.0-or-later
#include "certify/gaps.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "certify/prover.h"
#include "tests/support/segments.h"

namespace taut::testing {
namespace {

using Kind = SurveyedBox::Kind;

const Dyadic kEnd{1, 0};

SurveyedBox part(Kind kind, DyadicBox box) {
  SurveyedBox result{std::move(box), kind, {}, {}};
  if (kind == Kind::kOpen) result.reason = {Undecided::kDepth, " " + result.box.lower().text()};
  if (kind != Kind::kOpen && kind != Kind::kProved) {
    result.witness = SegmentWitness{kind == Kind::kSingular, {MarginKind::kLengthMin, 2}, result.box};
  }
  return result;
}

std::vector<Gap> gaps_of(std::vector<SurveyedBox> boxes) {
  SegmentSurvey survey;
  survey.boxes = std::move(boxes);
  return gaps(survey);
}

TEST(Gaps, ThereAreNoneWhereAllIsProved) {
  EXPECT_TRUE(gaps_of({part(Kind::kProved, {0, 0})}).empty());
  EXPECT_TRUE(gaps_of({part(Kind::kProved, {0, 1}), part(Kind::kProved, {1, 1})}).empty());
}

TEST(Gaps, ARunIsOneGapWhateverItsBoxesAre) {
  const auto found =
      gaps_of({part(Kind::kProved, {0, 2}), part(Kind::kOpen, {2, 3}), part(Kind::kViolated, {3, 3}),
               part(Kind::kViolatedInside, {4, 3}), part(Kind::kOpen, {5, 3}), part(Kind::kProved, {3, 2})});
  ASSERT_EQ(found.size(), 1u);
  EXPECT_EQ(found[0].begin, (Dyadic{1, 2}));
  EXPECT_EQ(found[0].end, (Dyadic{3, 2}));
  ASSERT_TRUE(found[0].first && found[0].last);
  EXPECT_EQ(found[0].first->box, (DyadicBox{3 << 13, 16})) << "next to the end of what is violated throughout";
  EXPECT_EQ(found[0].last->box, (DyadicBox{4, 3}));
  EXPECT_TRUE(found[0].reason.empty());
}

TEST(Gaps, NameTheFirstSingularPoseInThem) {
  const auto found =
      gaps_of({part(Kind::kViolated, {0, 2}), part(Kind::kSingular, {2, 3}), part(Kind::kSingular, {3, 3}),
               part(Kind::kProved, {2, 2}), part(Kind::kViolated, {3, 2})});
  ASSERT_EQ(found.size(), 2u);
  ASSERT_TRUE(found[0].singular.has_value());
  EXPECT_EQ(found[0].singular->box, (DyadicBox{2, 3}));
  EXPECT_FALSE(found[1].singular.has_value());
}

TEST(Gaps, AnOpenOneHasTheReasonOfItsFirstBox) {
  const auto found = gaps_of(
      {part(Kind::kOpen, {0, 2}), part(Kind::kOpen, {1, 2}), part(Kind::kProved, {2, 2}), part(Kind::kOpen, {3, 2})});
  ASSERT_EQ(found.size(), 2u);
  EXPECT_FALSE(found[0].first.has_value());
  EXPECT_EQ(found[0].reason.text(), "bisection depth reached at 0");
  EXPECT_EQ(found[0].end, (Dyadic{1, 1}));
  EXPECT_EQ(found[1].reason.text(), "bisection depth reached at 3/4");
  EXPECT_EQ(found[1].end, kEnd);
}

void expect_cover(const SegmentSurvey& survey) {
  ASSERT_FALSE(survey.boxes.empty());
  EXPECT_EQ(survey.boxes.front().box.lower(), Dyadic{});
  EXPECT_EQ(survey.boxes.back().box.upper(), kEnd);
  for (std::size_t k = 1; k < survey.boxes.size(); ++k) {
    EXPECT_EQ(survey.boxes[k - 1].box.upper(), survey.boxes[k].box.lower());
  }
  for (const SurveyedBox& part : survey.boxes) {
    EXPECT_EQ(part.witness.has_value(), part.kind != Kind::kOpen && part.kind != Kind::kProved);
    EXPECT_EQ(part.reason.empty(), part.kind != Kind::kOpen);
    if (!part.witness) continue;
    EXPECT_LE(part.box.lower(), part.witness->box.lower());
    EXPECT_GE(part.box.upper(), part.witness->box.upper());
  }
}

/// Margin `id` at s, by the oracle.
BigFloat margin_at(const Space& space, const oracle::OracleStatics& at, MarginId id) {
  const auto i = static_cast<std::size_t>(id.cable);
  const auto& [f_low, f_high] = space.problem.robot.tension_N[i];
  const auto& [d_low, d_high] = space.problem.robot.length_m[i];
  switch (id.kind) {
    case MarginKind::kTensionMin: return at.tension[i] - at.tension_radius[i] - oracle::big(f_low);
    case MarginKind::kTensionMax: return oracle::big(f_high) - at.tension[i] - at.tension_radius[i];
    case MarginKind::kLengthMin: return at.length[i] - oracle::big(d_low);
    case MarginKind::kLengthMax: break;
  }
  return oracle::big(d_high) - at.length[i];
}

bool is_feasible(const Space& space, const oracle::OracleStatics& at) {
  for (const MarginKind kind :
       {MarginKind::kTensionMin, MarginKind::kTensionMax, MarginKind::kLengthMin, MarginKind::kLengthMax}) {
    for (int cable = 0; cable < kCables; ++cable) {
      if (!(margin_at(space, at, {kind, cable}) > BigFloat(0.0))) return false;
    }
  }
  return true;
}

/// Paths of random segments, each surveyed, against points of them.
TEST(Gaps, HoldEveryViolationAndBeginAndEndInOne) {
  constexpr int kPaths = 60;
  constexpr int kSegments = 4;
  constexpr int kSamples = 64;  // a segment
  const PrecisionScope precision(oracle::kBits);
  Operands operands(20261121);
  const std::vector<Space> spaces = {slice_space(), sphere_space(), curved_space()};
  int gaps_seen = 0;
  int violations_seen = 0;
  int proved_segments = 0;
  for (int trial = 0; trial < kPaths; ++trial) {
    const Space& space = spaces[static_cast<std::size_t>(trial % 3)];
    const Prover prover(space.problem);
    Path path;
    const double step = std::exp(operands.uniform(-4, 0.5));
    for (int k = 0; k <= kSegments; ++k) {
      Waypoint waypoint;
      for (std::size_t j = 0; j < space.box.size(); ++j) {
        const auto& [lower, upper] = space.box[j];
        const double x =
            k == 0 ? operands.uniform(lower, upper)
                   : path.waypoints.back().parameters().x[j] + step * operands.uniform(-1, 1) * (upper - lower) / 6;
        waypoint.parameters().x.push_back(std::clamp(x, lower, upper));
        waypoint.parameters().half_turns.push_back(0);
      }
      path.waypoints.push_back(waypoint);
    }
    std::vector<std::vector<Gap>> found;  // of each segment
    for (std::size_t k = 0; k < path.segments(); ++k) {
      const SegmentSurvey survey = prover.survey(path.segment(k));
      expect_cover(survey);
      const SegmentProof proof = prover.prove(path.segment(k));
      found.push_back(gaps(survey));
      EXPECT_EQ(proof.verdict == Verdict::kProved, found.back().empty());
      if (proof.verdict != Verdict::kProved) continue;
      ++proved_segments;
      EXPECT_EQ(survey.boxes_judged, proof.boxes_judged);
      EXPECT_EQ(survey.boxes.size(), proof.boxes.size());
      EXPECT_EQ(survey.tension_N, proof.tension_N);
      EXPECT_EQ(survey.wrench_scale, proof.wrench_scale);
    }
    const auto statics_at = [&](std::size_t k, const BigFloat& s) {
      return oracle::statics(space.problem, space.pose(parameters_at(path.waypoints[k], path.waypoints[k + 1], s)));
    };
    for (std::size_t k = 0; k < found.size(); ++k) {
      for (std::size_t n = 0; n < found[k].size(); ++n) {
        const Gap& gap = found[k][n];
        ++gaps_seen;
        EXPECT_LT(gap.begin, gap.end);
        EXPECT_TRUE(n == 0 || found[k][n - 1].end < gap.begin);
        EXPECT_EQ(gap.first.has_value(), gap.reason.empty());
        if (!gap.first) continue;
        for (const SegmentWitness& witness : {*gap.first, *gap.last}) {
          ++violations_seen;
          EXPECT_LE(gap.begin, witness.box.lower());
          EXPECT_LE(witness.box.upper(), gap.end);
          const auto oracle_at = [&](const Dyadic& s) { return statics_at(k, enclose<MpInterval>(s).lower()); };
          if (witness.singular) {
            EXPECT_LT(oracle_at(witness.box.lower()).determinant * oracle_at(witness.box.upper()).determinant,
                      BigFloat(0.0));
          } else {
            EXPECT_LE(margin_at(space, oracle_at(witness.box.mid()), witness.margin), BigFloat(0.0))
                << name(witness.margin.kind) << " at " << witness.box.mid().text() << " of " << k;
          }
        }
      }
    }
    for (std::size_t segment = 0; segment < found.size(); ++segment) {
      for (int k = 0; k < kSamples; ++k) {
        const Dyadic s = Dyadic::nearest(BigFloat(operands.uniform(0, 1)), 53);
        const bool is_outside =
            std::ranges::none_of(found[segment], [&](const Gap& gap) { return gap.begin <= s && s <= gap.end; });
        if (!is_outside) continue;
        EXPECT_TRUE(is_feasible(space, statics_at(segment, BigFloat(s.approx()))))
            << s.text() << " of segment " << segment << " of path " << trial;
      }
    }
  }
  EXPECT_GT(gaps_seen, 40);
  EXPECT_GT(violations_seen, 60);
  EXPECT_GT(proved_segments, 20);
}

/// Cable 1 of a platform that slides straight: its length is sqrt(x² + 1/4) with x = from + s (to − from).
struct Slide {
  Problem problem = free_flying(robot1_slice());
  Slide() {
    problem.robot.base_anchors_m[0] = {"0", "0.25", "0"};
    problem.robot.platform_anchors_m[0] = {"0", "0.25", "0"};
    for (auto& limits : problem.robot.tension_N) limits = {"-1000", "1000"};
    for (auto& limits : problem.robot.length_m) limits = {"0.01", "10"};
  }
  [[nodiscard]] SegmentSurvey survey(double from, double to) const {
    const auto at = [](double x) { return Waypoint{{x, 0, 0.5, 0, 0, 0}, std::vector<int>(6, 0)}; };
    const Waypoint a = at(from);
    const Waypoint b = at(to);
    return Prover(problem).survey(Segment::straight(a, b));
  }
};

TEST(Gaps, EndWhereTheLimitIsCrossed) {
  Slide slide;
  slide.problem.robot.length_m[0].lower = "0.5000063";  // |x| < 0.00251, at |s − 2/5| < 0.0837
  const SegmentSurvey survey = slide.survey(-0.012, 0.018);
  const auto found = gaps(survey);
  ASSERT_EQ(found.size(), 1u);
  const double half = std::sqrt(0.5000063 * 0.5000063 - 0.25) / 0.03;
  constexpr double kResolution = 0x1p-11;
  EXPECT_NEAR(found[0].begin.approx(), 0.4 - half, kResolution);
  EXPECT_NEAR(found[0].end.approx(), 0.4 + half, kResolution);
  EXPECT_NEAR(found[0].first->box.mid().approx(), 0.4 - half, kResolution);
  EXPECT_NEAR(found[0].last->box.mid().approx(), 0.4 + half, kResolution);
  EXPECT_LE(found[0].begin.approx(), 0.4 - half);
  EXPECT_GE(found[0].end.approx(), 0.4 + half);
  EXPECT_LT(survey.boxes_judged, 120) << "none are spent inside";
}

TEST(Gaps, AViolationFarThinnerThanTheResolutionIsFound) {
  Slide slide;
  slide.problem.robot.length_m[0].lower = "0.50000000000000000000000000000000000000000000000001";  // by 1e-50
  const SegmentSurvey survey = slide.survey(-0.01, 0.02);
  expect_cover(survey);
  const auto found = gaps(survey);
  ASSERT_EQ(found.size(), 1u);
  ASSERT_TRUE(found[0].first.has_value());
  EXPECT_NEAR(found[0].first->box.mid().approx(), 1.0 / 3, 1e-15);
  EXPECT_LT(found[0].end.approx() - found[0].begin.approx(), 0x1p-11);
}

TEST(Gaps, WhatVanishesIsOpenAndHidesNothing) {
  Slide slide;
  slide.problem.robot.length_m[0] = {"0.5", "0.50001"};  // touched at s = 1/3, passed at the end, where x > 0.00316
  const SegmentSurvey survey = slide.survey(-0.002, 0.004);
  expect_cover(survey);
  const auto found = gaps(survey);
  ASSERT_EQ(found.size(), 2u);
  EXPECT_FALSE(found[0].first.has_value());
  EXPECT_NE(found[0].reason.text().find("is zero"), std::string::npos) << found[0].reason;
  EXPECT_NEAR(found[0].begin.approx(), 1.0 / 3, 0x1p-10);
  EXPECT_NEAR(found[0].end.approx(), 1.0 / 3, 0x1p-10);
  ASSERT_TRUE(found[1].first.has_value());
  EXPECT_EQ(found[1].end, kEnd);
  EXPECT_LT(survey.boxes_judged, 400);
}

TEST(Gaps, AMarginThatIsZeroEverywhereTakesNoLongerThanBisection) {
  Slide slide;
  slide.problem.space.pose[0] = "0.001*cos(px)";  // x² + y² stays
  slide.problem.space.pose[1] = "0.001*sin(px)";
  slide.problem.space.parameters = {{"px", ParameterKind::kReal, "", ""}};
  for (std::size_t j = 3; j < 6; ++j) slide.problem.space.pose[j] = "0";
  slide.problem.space.pose[2] = "sqrt(0.249999)";
  slide.problem.robot.length_m[0].lower = "0.5";
  const Waypoint a{{0.1}, {0}};
  const Waypoint b{{0.4}, {0}};
  const SegmentSurvey survey = Prover(slide.problem).survey(Segment::straight(a, b));
  expect_cover(survey);
  for (const SurveyedBox& part : survey.boxes) EXPECT_EQ(part.kind, Kind::kOpen);
  EXPECT_LT(survey.boxes_multiprecision, 200);
  EXPECT_LE(survey.boxes.size(), std::size_t{1} << 12);
}

TEST(Gaps, ASingularPoseIsLocatedByTheSignsOfItsNeighbours) {
  Problem problem = robot1_slice();
  problem.load.wrench = {"0", "0", "0", "0", "0", "0"};
  for (std::size_t i = 0; i < 6; ++i) problem.load.ellipsoid.value()[i][i] = "1e300";
  for (auto& limits : problem.robot.tension_N) limits = {"-1e9", "1e9"};
  for (auto& limits : problem.robot.length_m) limits = {"0", "100"};
  const Waypoint a{{-2.3, 1.6}, {0, 0}};
  const Waypoint b{{1.7, 1.7}, {0, 0}};
  const SegmentSurvey survey = Prover(problem).survey(Segment::straight(a, b));
  expect_cover(survey);
  const auto found = gaps(survey);
  ASSERT_FALSE(found.empty());
  for (const Gap& gap : found) {
    EXPECT_LT(gap.end.approx() - gap.begin.approx(), 1e-3);
    ASSERT_TRUE(gap.first.has_value()) << gap.reason;
    EXPECT_TRUE(gap.first->singular);
  }
}

TEST(Gaps, AWaypointOutOfItsRangeLeavesTheSegmentOpen) {
  Problem problem = robot1_slice();
  problem.space.flip.reset();
  problem.space.parameters[1] = {"theta", ParameterKind::kRange, "0", "1.5"};
  const Waypoint a{{-2.3, 1.4}, {0, 0}};
  const Waypoint b{{-2.3, 1.6}, {0, 0}};
  const SegmentSurvey survey = Prover(problem).survey(Segment::straight(a, b));
  ASSERT_EQ(survey.boxes.size(), 1u);
  EXPECT_EQ(survey.boxes[0].kind, Kind::kOpen);
}

TEST(Gaps, WhatABudgetLeavesIsOpen) {
  ProofOptions options;
  options.max_boxes = 5;
  const Waypoint a{{-2.3, 1.6}, {0, 0}};
  const Waypoint b{{1.7, 1.7}, {0, 0}};
  const SegmentSurvey survey = Prover(robot1_slice(), options).survey(Segment::straight(a, b));
  expect_cover(survey);
  EXPECT_EQ(survey.boxes.back().kind, Kind::kOpen);
  EXPECT_EQ(survey.boxes.back().reason.text(), "the budget of boxes is spent");
}

}  // namespace
}  // namespace taut::testing
