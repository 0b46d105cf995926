// SPDX-License-Identifier: GPL-3.0-or-later
// From a certificate's bytes to a report: what is shown with a theorem, and without one.
#include "checker/theorem.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <memory>
#include <nlohmann/json.hpp>
#include <type_traits>

#include "checker/check.h"
#include "reports/page/html_report.h"
#include "tests/checker/fixtures.h"

namespace taut {
namespace {

using checker::CheckResult;
using checker::Outcome;
using checker::Theorem;
using ::testing::HasSubstr;
using ::testing::Not;

static_assert(!std::is_default_constructible_v<Theorem>);
static_assert(!std::is_constructible_v<Theorem, Theorem::Verdict, std::shared_ptr<const nlohmann::json>, std::string,
                                       Theorem::Counts>,
              "nobody but check() makes a theorem");

const std::string& bytes() {
  static const std::string kBytes = checker::read_text(TAUT_CERTIFICATES "/accepted/robot1_near_goal.json");
  return kBytes;
}

std::string forged() { return checker::read_text(TAUT_SOURCE_DIR "/tests/attacks/f1.json"); }

TEST(Theorem, IsOfTheBytesThatWereChecked) {
  const CheckResult checked = checker::check(bytes());
  ASSERT_EQ(checked.outcome, Outcome::kAccepted) << checked.message;
  ASSERT_TRUE(checked.theorem);
  const Theorem& theorem = *checked.theorem;
  const nlohmann::json certificate = nlohmann::json::parse(bytes());
  EXPECT_EQ(theorem.verdict(), Theorem::Verdict::kProved);
  EXPECT_EQ(theorem.claim(), certificate["claim"]);
  EXPECT_EQ(theorem.problem(), certificate["problem"]);
  EXPECT_EQ(theorem.path(), certificate["path"]);
  EXPECT_EQ(theorem.margins(), certificate["margins"]);
  EXPECT_TRUE(theorem.witness().is_null());
  EXPECT_EQ(theorem.counts().boxes, 5U);
  EXPECT_EQ(theorem.sha256(), checker::sha256(bytes()));
}

TEST(Theorem, IsMadeOfNothingThatIsNotAccepted) {
  checker::CheckOptions no_time;
  no_time.max_seconds = 0;
  for (const CheckResult& checked : {checker::check(forged()), checker::check(bytes(), no_time), checker::check("{")}) {
    EXPECT_NE(checked.outcome, Outcome::kAccepted);
    EXPECT_FALSE(checked.theorem) << checked.message;
  }
}

TEST(Theorem, IsWhatAReportShows) {
  const std::string text = text_summary(checker::check(bytes()));
  EXPECT_THAT(text, HasSubstr("PROVED: Everywhere on this move"));
  EXPECT_THAT(text, HasSubstr("Closest to going slack: Cable "));
}

TEST(Report, OfWhatIsUncheckedHasNoVerdictAndNoMargins) {
  checker::CheckOptions no_time;
  no_time.max_seconds = 0;
  for (const std::string& certificate : {bytes(), forged()}) {
    const CheckResult checked = checker::check(certificate, no_time);
    ASSERT_EQ(checked.outcome, Outcome::kUnchecked);
    for (const std::string& report : {html_report(checked), text_summary(checked), markdown_summary(checked)}) {
      EXPECT_THAT(report, HasSubstr("UNCHECKED"));
      EXPECT_THAT(report, Not(HasSubstr("PROVED")));
      EXPECT_THAT(report, Not(HasSubstr("Closest to going slack")));
      EXPECT_THAT(report, Not(HasSubstr("0.01764834")));
    }
    EXPECT_EQ(json_summary(checked)["verdict"], "unchecked");
  }
}

TEST(Report, OfAForgedCertificateCannotBeMade) {
  const CheckResult checked = checker::check(forged());
  ASSERT_EQ(checked.outcome, Outcome::kRejected);
  EXPECT_THROW((void)html_report(checked), std::logic_error);
  EXPECT_THROW((void)text_summary(checked), std::logic_error);
  EXPECT_THROW((void)json_summary(checker::check("{")), std::logic_error);
}

}  // namespace
}  // namespace taut
