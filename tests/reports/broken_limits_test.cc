// SPDX-License-Identifier: GPL-3.0-or-later
#include "reports/summary/broken_limits.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>

#include "reports/summary/key_numbers.h"
#include "reports/summary/sentences.h"
#include "tests/reports/sample_certificates.h"

namespace taut {
namespace {

using nlohmann::json;
using ::testing::Contains;
using ::testing::HasSubstr;
using ::testing::MatchesRegex;
using ::testing::Not;
using ::testing::StartsWith;

json violation(const char* kind, int cable, const char* limit, const char* low, const char* high, int segment,
               const char* s) {
  return {{"at", {{"segment", segment}, {"s", s}}},
          {"kind", kind},
          {"cable", cable},
          {"limit", limit},
          {"value", {low, high}},
          {"proof", {{"bits", 64}}},
          {"motion", json::array()}};
}

json stretch(const json& first, const json& last, int segment, const char* from, const char* to) {
  return {{"inner", {first, last}},
          {"outer", {{{"segment", segment}, {"s", from}}, {{"segment", segment}, {"s", to}}}},
          {"reason", nullptr}};
}

/// An audit with two violated stretches and an open one.
json refuted_audit() {
  const json slight = violation("tension_min", 6, "0.05", "0.0498", "0.0499", 0, "1/8");
  const json longer = violation("length_max", 2, "0.55", "0.56", "0.57", 0, "1/4");
  const json graver = violation("tension_min", 6, "0.05", "0.02", "0.03", 1, "3/8");
  json result = sample::refuted();
  result["problem"]["query"]["waypoints"] = json::array();
  result["witness"] = slight;
  json open = stretch(slight, slight, 1, "3/4", "1");
  open["inner"] = nullptr;
  open["reason"] = "open";
  result["stretches"] = {stretch(slight, longer, 0, "0", "1/2"), stretch(graver, graver, 1, "1/4", "1/2"), open};
  result["source"] = {{"file", "logs/monday.csv"}, {"sha256", std::string(64, 'd')}};
  return result;
}

std::vector<BrokenLimit> proved(const json& certificate) {
  std::vector<BrokenLimit> all = broken_limits(sample::scene(certificate));
  std::erase_if(all, [](const BrokenLimit& broken) { return !broken.is_proved(); });
  return all;
}

TEST(BrokenLimits, NameEachLimitOnceWhereItIsBrokenMostAndTheGravestFirst) {
  const std::vector<BrokenLimit> all = proved(refuted_audit());
  ASSERT_EQ(all.size(), 2u);
  EXPECT_EQ(all[0].margin, (MarginId{MarginKind::kTensionMin, 5}));
  EXPECT_EQ(all[0].value, 0.03);  // the end that is next to the limit
  EXPECT_EQ(all[0].limit, "0.05");
  EXPECT_NEAR(all[0].severity, 0.02 / 0.45, 1e-12);
  EXPECT_EQ(all[0].position, 1.375);
  EXPECT_EQ(all[0].stretches, 2u);
  EXPECT_EQ(all[1].margin, (MarginId{MarginKind::kLengthMax, 1}));
  EXPECT_EQ(all[1].value, 0.56);
  EXPECT_NEAR(all[1].severity, 0.01 / 0.45, 1e-12);
  EXPECT_EQ(all[1].stretches, 1u);
}

TEST(BrokenLimits, CountTheCertificatesOwnWitnessInTheStretchThatContainsIt) {
  json certificate = refuted_audit();
  certificate["witness"] = violation("tension_max", 1, "0.5", "0.9", "1", 1, "7/16");
  const std::vector<BrokenLimit> all = proved(certificate);
  ASSERT_EQ(all.size(), 3u);
  EXPECT_EQ(all[0].margin, (MarginId{MarginKind::kTensionMax, 0}));
  EXPECT_EQ(all[0].stretches, 1u);
  EXPECT_EQ(all[1].stretches, 2u);
}

TEST(BrokenLimits, PutASingularPoseBeforeAnyLimit) {
  json certificate = refuted_audit();
  json singular = sample::singular()["witness"];
  singular["at"] = {{"segment", 1}, {"s", "5/16"}};
  singular["to"] = {{"segment", 1}, {"s", "11/32"}};
  certificate["stretches"][1]["inner"][0] = singular;
  const std::vector<BrokenLimit> all = proved(certificate);
  ASSERT_EQ(all.size(), 3u);
  EXPECT_TRUE(all[0].is_singular);
  EXPECT_TRUE(std::isinf(all[0].severity));
  EXPECT_EQ(all[0].position, 1.3125);
  EXPECT_EQ(all[0].to, 1.34375);
  EXPECT_EQ(all[0].stretches, 1u);
}

/// The scene with what its samples show replaced: every tension is 0.2 N but in sample `at`.
ReportContext with_tension(const json& certificate, std::size_t at, std::size_t cable, double tension) {
  ReportContext scene = sample::scene(certificate);
  for (PathSample& sample : scene.samples) {
    sample.statics.regular = true;
    sample.statics.determinant = 1;
    sample.statics.tension.fill(0.2);
    sample.statics.tension_below.fill(0);
    sample.statics.tension_above.fill(0);
    sample.statics.length.fill(0.3);
  }
  scene.samples[at].statics.tension[cable] = tension;
  return scene;
}

TEST(BrokenLimits, ThatOnlySamplesShowComeLastAndAreNotProved) {
  const ReportContext scene = with_tension(refuted_audit(), 100, 3, -7);
  const std::vector<BrokenLimit> all = broken_limits(scene);
  ASSERT_EQ(all.size(), 3u);
  EXPECT_FALSE(all[2].is_proved());
  EXPECT_EQ(all[2].margin, (MarginId{MarginKind::kTensionMin, 3}));
  EXPECT_EQ(all[2].value, -7);
  EXPECT_EQ(all[2].limit, "0.05");
  EXPECT_EQ(all[2].position, scene.samples[100].position);
  EXPECT_EQ(all[2].stretches, 0u);
}

TEST(BrokenLimits, ThatAreProvedAreNotSaidAgainBySamples) {
  for (const BrokenLimit& broken : broken_limits(with_tension(refuted_audit(), 100, 5, -7))) {
    EXPECT_TRUE(broken.is_proved());
  }
}

TEST(BrokenLimits, ShowAChangeOfSignBetweenSamplesAsASingularPose) {
  ReportContext scene = with_tension(refuted_audit(), 0, 0, 0.2);
  for (std::size_t i = 300; i < scene.samples.size(); ++i) scene.samples[i].statics.determinant = -1;
  const std::vector<BrokenLimit> all = broken_limits(scene);
  ASSERT_EQ(all.size(), 3u);
  EXPECT_TRUE(all[2].is_singular);
  EXPECT_FALSE(all[2].is_proved());
  EXPECT_EQ(all[2].position, scene.samples[299].position);
  EXPECT_EQ(all[2].to, scene.samples[300].position);
}

TEST(BrokenLimits, AreNoneWhereThePathIsProvedOrNoneWasFound) {
  EXPECT_TRUE(broken_limits(with_tension(sample::proved(), 100, 3, -7)).empty());
  EXPECT_TRUE(broken_limits(sample::scene(sample::no_path())).empty());
}

TEST(BrokenLimits, AreSampledAtMostWhereNothingWasChecked) {
  const ReportContext scene = sample::unchecked(refuted_audit());
  for (const BrokenLimit& broken : broken_limits(scene)) EXPECT_FALSE(broken.is_proved());
}

TEST(BrokenLimits, HeadTheReportWithTheGravestThatWasConfirmed) {
  // The certificate names the slight one; one of a stretch is graver.
  const ReportContext scene = sample::scene(refuted_audit());
  ASSERT_TRUE(scene.gravest);
  EXPECT_EQ(scene.gravest->violation.value_upper, "0.03");
  EXPECT_THAT(headline(scene), HasSubstr("the tension of cable 6 falls to at most 0.03 N"));
  EXPECT_EQ(broken_limits(scene).front().position, position(scene.gravest->violation.at));
}

/// An audit whose poses are implied.
ReportContext implied(const json& certificate) {
  ReportContext scene = sample::scene(certificate);
  Path& path = scene.certificate.path;
  path.interpolation = Interpolation::kCableLengths;
  LengthsPoint point{{0, 0, 0.35, 0, 0, 0, 1}, {}};
  point.length_m.fill(0.3);
  path.waypoints.assign(path.waypoints.size(), point);
  return scene;
}

TEST(BrokenLimits, OfPosesThatTheMoveMayNotReachComeLastAndSaySo) {
  const std::vector<BrokenLimit> all = broken_limits(implied(refuted_audit()));
  ASSERT_EQ(all.size(), 3u);
  EXPECT_TRUE(all[0].is_reached);
  EXPECT_EQ(all[0].value, 0.0499) << "the certificate's own witness, though there is a graver one";
  EXPECT_EQ(known_by(all[0]), "proved");
  for (const std::size_t k : {1u, 2u}) {
    EXPECT_FALSE(all[k].is_reached);
    EXPECT_EQ(known_by(all[k]), "proved of the pose in its tube, not that the move leads there");
  }
  EXPECT_EQ(all[1].value, 0.03);
  const std::vector<std::string> details = verdict_details(implied(refuted_audit()));
  EXPECT_THAT(details, Contains(HasSubstr("the only pose in each tube")));
  EXPECT_THAT(details, Not(Contains(HasSubstr("the path is proved"))));
}

TEST(BrokenLimits, AreSaidOfTheMachineThatBreaksThem) {
  BrokenLimit broken = broken_limits(sample::scene(refuted_audit())).front();
  EXPECT_EQ(what_text(broken), "below its slack limit");
  broken.proof->deviation = std::make_shared<Deviation>();
  EXPECT_EQ(what_text(broken), "below its slack limit, on a machine within the tolerances");
}

TEST(BrokenLimits, SayAmountsAsTheSentencesDo) {
  const ReportContext scene = with_tension(refuted_audit(), 100, 3, -18.749);
  const std::vector<BrokenLimit> all = broken_limits(scene);
  EXPECT_EQ(amount_text(scene, all[0]), "at most 0.03 N; limit 0.05 N");
  EXPECT_EQ(amount_text(scene, all[2]), "about −18.7 N; limit 0.05 N");
  EXPECT_EQ(key_numbers(scene, sampled_use(scene))[0].value, "Cable 4: −18.7 N");
  EXPECT_THAT(verdict_details(scene), Contains(HasSubstr("falls to −18.7 N")));
}

TEST(BrokenLimits, AreAtPlacesThatNeedNothingElse) {
  json certificate = refuted_audit();
  certificate["illustration"]["lines"] = {{"runs", {{0, 2}, {2, 9}}}, {"waypoints", 3}};
  const ReportContext scene = sample::scene(certificate);
  EXPECT_THAT(where_text(scene, broken_limits(scene).front()),
              MatchesRegex("segment 1 at s = 0.375, after [0-9.]+° of turning; lines 3-9; in 2 stretches"));
}

TEST(BrokenLimits, ThatAreJustReachedAreAtTheLimitOrBeyondIt) {
  json certificate = sample::refuted();
  certificate["witness"]["value"] = {"0.5", "0.9"};
  EXPECT_THAT(verdict_details(sample::scene(certificate)), Contains(StartsWith("It is at the limit or beyond it")));
}

TEST(BrokenLimits, OfTheOnlyPoseAreOfTheQueryWhereThereIsOne) {
  json certificate = sample::refuted();
  certificate["path"]["waypoints"].erase(2);
  certificate["path"]["waypoints"].erase(1);
  certificate["witness"]["at"] = {{"waypoint", 0}};
  EXPECT_THAT(verdict_details(sample::scene(certificate)), Contains(HasSubstr("Every path of the query passes")));
  certificate["problem"]["query"]["waypoints"] = json::array();
  EXPECT_THAT(verdict_details(sample::scene(certificate)), Not(Contains(HasSubstr("query"))));
}

TEST(RowsText, NamesTheLinesOfTheFileWhereTheCertificateTellsThem) {
  json certificate = refuted_audit();
  EXPECT_EQ(rows_text(sample::scene(certificate), 1.5), "");
  certificate["illustration"]["lines"] = {{"runs", {{0, 2}, {2, 9}}}, {"waypoints", 3}};
  const ReportContext scene = sample::scene(certificate);
  EXPECT_EQ(rows_text(scene, 0), "line 2");
  EXPECT_EQ(rows_text(scene, 0.25), "lines 2-3");
  EXPECT_EQ(rows_text(scene, 1.5), "lines 3-9");
  EXPECT_EQ(rows_text(scene, 2), "line 9");
  EXPECT_EQ(audited_file(scene), "monday.csv");
  certificate["source"] = nullptr;
  EXPECT_EQ(rows_text(sample::scene(certificate), 1.5), "");
}

}  // namespace
}  // namespace taut
