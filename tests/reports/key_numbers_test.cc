// SPDX-License-Identifier: GPL-3.0-or-later
#include "reports/summary/key_numbers.h"

#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>

#include "tests/reports/sample_certificates.h"

namespace taut {
namespace {

using ::testing::AnyOf;
using ::testing::ElementsAre;
using ::testing::EndsWith;
using ::testing::HasSubstr;
using ::testing::IsEmpty;
using ::testing::Not;
using ::testing::StartsWith;

std::vector<KeyNumber> numbers_of(const nlohmann::json& certificate) {
  const ReportContext scene = sample::scene(certificate);
  return key_numbers(scene, cable_use(scene));
}

TEST(KeyNumbers, OfAProvedMoveAreTrueOfIt) {
  // By a separate program: at q_s, cable 3 has 0.10167 N and cable 5 has 10.659 mm left, the least along this path.
  const std::vector<KeyNumber> numbers = numbers_of(sample::proved());
  ASSERT_EQ(numbers.size(), 4u);
  EXPECT_STREQ(numbers[0].key, "slack");
  EXPECT_EQ(numbers[0].value, "Cable 3: +103 %");
  EXPECT_THAT(numbers[0].detail, StartsWith("0.101 N, limit 0.05 N · after "));
  EXPECT_STREQ(numbers[2].key, "length");
  EXPECT_EQ(numbers[2].value, "Cable 5: 10.6 mm");
  EXPECT_THAT(numbers[2].detail, StartsWith("540 mm of at most 550 mm · "));
  EXPECT_EQ(numbers[2].nearness, Nearness::kNear);
  EXPECT_STREQ(numbers[3].key, "growth");
  EXPECT_EQ(numbers[3].value, "× 2.71");
  for (const KeyNumber& number : numbers) EXPECT_TRUE(number.is_proved) << number.key;
}

TEST(KeyNumbers, AgreeWithTheMarginsOfTheCertificate) {
  nlohmann::json certificate = sample::proved();
  for (nlohmann::json* margins :
       {&certificate["margins"], &certificate["segments"][0]["margins"], &certificate["segments"][1]["margins"]}) {
    (*margins)["length_m"] = "0.01065";  // sharper than the boxes' enclosures, and true
  }
  EXPECT_EQ(numbers_of(certificate)[2].value, "Cable 5: 10.6 mm") << "0.01065 m, rounded down";
}

TEST(KeyNumbers, AreNeverRoundedOntoTheLimitThatIsKept) {
  // The least length of cable 1 along this path is about 308.44 mm.
  nlohmann::json certificate = sample::proved();
  for (nlohmann::json* margins :
       {&certificate["margins"], &certificate["segments"][0]["margins"], &certificate["segments"][1]["margins"]}) {
    (*margins)["length_m"] = "1e-5";
  }
  certificate["problem"]["robot"]["length_m"][0][0] = "0.30841";
  const KeyNumber length = numbers_of(certificate)[2];
  EXPECT_THAT(length.value, StartsWith("Cable 1: 0.0"));
  EXPECT_THAT(length.detail, StartsWith("308.43")) << "three digits would be 308";
  EXPECT_THAT(length.detail, HasSubstr(" mm of at least 308.41 mm"));
}

TEST(KeyNumbers, OfSamplesSaySo) {
  for (const nlohmann::json& certificate : {sample::refuted(), sample::undecided()}) {
    for (const KeyNumber& number : numbers_of(certificate)) {
      EXPECT_FALSE(number.is_proved);
      EXPECT_THAT(number.detail, EndsWith("sampled, not proved"));
    }
  }
}

TEST(KeyNumbers, AreNoneWithoutAPath) {
  EXPECT_THAT(numbers_of(sample::no_path()), IsEmpty());
  const ReportContext scene = sample::scene(sample::no_path());
  EXPECT_THAT(cable_lines(scene, cable_use(scene)), IsEmpty());
}

TEST(KeyNumbers, SayAnAmountWhereTheSlackLimitIsZero) {
  nlohmann::json certificate = sample::proved();
  for (nlohmann::json& limits : certificate["problem"]["robot"]["tension_N"]) limits[0] = "0";
  EXPECT_EQ(numbers_of(certificate)[0].value, "Cable 3: +0.101 N");
}

TEST(KeyNumbers, NameTheCableWithTheLeastForceWhereAmountsArePrinted) {
  nlohmann::json certificate = sample::proved();
  for (nlohmann::json& limits : certificate["problem"]["robot"]["tension_N"]) limits[0] = "0";
  certificate["problem"]["robot"]["tension_N"][3][1] = "50";  // by its share of so wide a range, cable 4 is nearest
  EXPECT_EQ(numbers_of(certificate)[0].value, "Cable 3: +0.101 N");
  EXPECT_EQ(numbers_of(certificate)[1].title, "Tension nearest its top limit") << "the highest is another cable's";
  EXPECT_EQ(numbers_of(sample::proved())[1].title, "Highest tension");
}

TEST(KeyNumbers, NameTheCableWithTheLeastLengthLeft) {
  nlohmann::json certificate = sample::proved();
  // About 12 mm below the least length of cable 1, and far above it: less by share than the 10.6 mm of cable 5.
  certificate["problem"]["robot"]["length_m"][0] = {"0.2964", "2"};
  EXPECT_EQ(numbers_of(certificate)[2].value, "Cable 5: 10.6 mm");
}

TEST(KeyNumbers, SayOneKindOfAmountWhereOneLimitIsZero) {
  nlohmann::json certificate = sample::proved();
  certificate["problem"]["robot"]["tension_N"][5][0] = "0";
  const ReportContext scene = sample::scene(certificate);
  for (const CableLine& line : cable_lines(scene, cable_use(scene))) EXPECT_THAT(line.above_slack, EndsWith(" N"));
}

/// The sampled use with cable 1's least tension replaced.
CableLine line_of_first_cable(double least) {
  const ReportContext scene = sample::scene(sample::refuted());
  CableUse use = sampled_use(scene);
  use.tension[0].range.lower = least;
  const std::vector<CableLine> lines = cable_lines(scene, use);
  return *std::ranges::find(lines, 0u, &CableLine::cable);
}

TEST(CableLines, HaveTheSignOfTheExactLimit) {
  // The binary64 that is nearest to 0.05 is above it, and the one before that is below it.
  const CableLine kept = line_of_first_cable(0.05);
  EXPECT_THAT(kept.above_slack, StartsWith("+"));
  EXPECT_EQ(kept.slack, Nearness::kClose);
  const CableLine broken = line_of_first_cable(std::nextafter(0.05, 0));
  EXPECT_THAT(broken.above_slack, StartsWith("−"));
  EXPECT_EQ(broken.slack, Nearness::kOut);
  for (const CableLine& line : {kept, broken}) EXPECT_THAT(line.above_slack, Not(AnyOf("+0 %", "−0 %")));
}

TEST(CableLines, SayNothingOfASignAtTheLimitItself) {
  nlohmann::json certificate = sample::refuted();
  certificate["problem"]["robot"]["tension_N"][0][0] = "0.0625";
  const ReportContext scene = sample::scene(certificate);
  CableUse use = sampled_use(scene);
  use.tension[0].range.lower = 0.0625;
  const std::vector<CableLine> lines = cable_lines(scene, use);
  const CableLine& line = *std::ranges::find(lines, 0u, &CableLine::cable);
  EXPECT_EQ(line.above_slack, "0 %");
  EXPECT_EQ(line.slack, Nearness::kOut);
}

TEST(KeyNumbers, AndTheTableRoundSamplesAlike) {
  for (const double least : {-18.749, -18.751}) {
    const ReportContext scene = sample::scene(sample::refuted());
    CableUse use = sampled_use(scene);
    for (std::size_t i = 0; i < kCables; ++i) use.tension[i].range.lower = i == 0 ? least : 0.1;
    const KeyNumber slack = key_numbers(scene, use)[0];
    const std::vector<CableLine> lines = cable_lines(scene, use);
    EXPECT_EQ(slack.value, fmt::format("Cable 1: {} N", std::ranges::find(lines, 0u, &CableLine::cable)->from));
    EXPECT_EQ(slack.value, "Cable 1: −18.7 N") << "towards the limit";
  }
}

TEST(CableLines, PutTheWorstFirst) {
  const ReportContext scene = sample::scene(sample::proved());
  const std::vector<CableLine> lines = cable_lines(scene, cable_use(scene));
  ASSERT_EQ(lines.size(), kCables);
  EXPECT_EQ(lines[0].cable, 4u) << "cable 5 has the least length left";
  for (std::size_t k = 1; k < kCables; ++k) {
    const auto of = [&](const CableLine& line) { return worse(worse(line.slack, line.top), line.length); };
    EXPECT_GE(of(lines[k - 1]), of(lines[k]));
  }
}

}  // namespace
}  // namespace taut
