// SPDX-License-Identifier: GPL-3.0-or-later
#include "reports/summary/key_numbers.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <nlohmann/json.hpp>

#include "tests/reports/sample_certificates.h"

namespace taut {
namespace {

using ::testing::ElementsAre;
using ::testing::EndsWith;
using ::testing::HasSubstr;
using ::testing::IsEmpty;
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
