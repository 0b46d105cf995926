// SPDX-License-Identifier: GPL-3.0-or-later
// Certificates of legs; what each edit of one makes of it is in tests/certificates/cases/legs.yaml.
#include "checker/legs.h"

#include <gtest/gtest.h>

#include "checker/check.h"
#include "checker/format/claims.h"
#include "tests/checker/fixtures.h"

namespace taut::checker {
namespace {

using nlohmann::json;

std::string text_of(const std::string& name) { return read_text(TAUT_CERTIFICATES "/accepted/" + name + ".json"); }

json problems_of(const json& certificate) {
  json result = json::array();
  for (const json& leg : certificate["legs"]) result.push_back(leg["problem"]);
  return result;
}

/// Of which the last leg claims nothing, and has the path that is given.
json with_an_undecided_leg(const json& waypoints) {
  json certificate = accepted("legs");
  json& leg = certificate["legs"][2];
  leg["verdict"] = "undecided";
  leg["claim"] = kUndecidedClaim;
  leg["segments"] = json::array();
  leg["margins"] = json::object();
  leg["undecided"] = {{"reason", "out of time"}, {"segment", nullptr}, {"box", nullptr}};
  leg["path"]["waypoints"] = waypoints;
  certificate["verdict"] = "undecided";
  certificate["claim"] = kLegsUndecidedClaim;
  seal_legs(certificate);
  return certificate;
}

TEST(Legs, EachIsCheckedAsACertificateOfItsOwn) {
  const std::string text = text_of("legs");
  const CheckResult result = check(text);
  ASSERT_EQ(result.outcome, Outcome::kAccepted) << result.message;
  EXPECT_EQ(result.theorem->verdict(), Theorem::Verdict::kProved);
  EXPECT_TRUE(result.theorem->is_of_legs());
  EXPECT_EQ(result.theorem->claim(), legs_proved_claim(3, false));
  ASSERT_EQ(result.legs.size(), 3U);
  std::size_t boxes = 0, at = 0;
  for (const CheckResult& leg : result.legs) {
    ASSERT_TRUE(leg.theorem) << leg.message;
    EXPECT_FALSE(leg.theorem->is_of_legs());
    boxes += leg.counts.boxes;
    // The bytes of the leg stand in those of the whole.
    const std::size_t begin = text.find("{\n   \"claim\"", at);
    ASSERT_NE(begin, std::string::npos);
    const std::size_t end = text.find("\n  }", begin) + 4;
    EXPECT_EQ(sha256(text.substr(begin, end - begin)), leg.sha256);
    at = end;
  }
  EXPECT_EQ(result.counts.boxes, boxes);
  EXPECT_EQ(result.legs[1].theorem->problem()["name"], "robot1-legs, leg on");
}

TEST(Legs, HaveNoProblemPathOrMarginsOfTheWhole) {
  const CheckResult result = check(text_of("legs"));
  EXPECT_THROW((void)result.theorem->problem(), std::logic_error);
  EXPECT_THROW((void)result.theorem->path(), std::logic_error);
  EXPECT_THROW((void)result.theorem->margins(), std::logic_error);
  EXPECT_THROW((void)result.theorem->witness(), std::logic_error);
}

TEST(Legs, OneThatIsRefutedRefutesTheWhole) {
  const CheckResult result = check(text_of("legs_refuted"));
  ASSERT_EQ(result.outcome, Outcome::kAccepted) << result.message;
  EXPECT_EQ(result.theorem->verdict(), Theorem::Verdict::kRefuted);
  EXPECT_EQ(result.theorem->claim(), legs_refuted_claim(3, 2));
  EXPECT_EQ(result.message.find("leg 2 of 3: refuted again"), 0U) << result.message;
  EXPECT_EQ(result.legs.at(0).theorem->verdict(), Theorem::Verdict::kProved);
  EXPECT_FALSE(result.legs.at(1).theorem->witness().is_null());
}

TEST(Legs, OneThatIsUndecidedLeavesTheWholeUndecided) {
  for (const json& waypoints : {accepted("leg_back")["path"]["waypoints"], json::array()}) {
    const CheckResult result = check(with_an_undecided_leg(waypoints).dump());
    EXPECT_EQ(result.outcome, Outcome::kUndecided) << result.message;
    EXPECT_EQ(result.message, "leg 3: the certificate claims nothing: out of time");
    EXPECT_FALSE(result.theorem);
    EXPECT_TRUE(result.legs.at(0).theorem);
  }
}

TEST(Legs, AnUndecidedWholeDoesNotHideAFalseLeg) {
  json certificate = with_an_undecided_leg(json::array());
  certificate["legs"][0]["problem"]["robot"]["tension_N"][0] = {"0.4", "0.5"};
  for (json& leg : certificate["legs"]) leg["problem"]["robot"] = certificate["legs"][0]["problem"]["robot"];
  seal_legs(certificate);
  EXPECT_EQ(check(certificate.dump()).outcome, Outcome::kRejected);
}

TEST(Legs, KeepToTheBudgetAndToTheCaller) {
  const std::string text = text_of("legs");
  const CheckResult no_time = check(text, {.max_seconds = 0});
  EXPECT_EQ(no_time.outcome, Outcome::kUnchecked);
  EXPECT_FALSE(no_time.theorem);
  ASSERT_EQ(no_time.legs.size(), 3U);
  for (const CheckResult& leg : no_time.legs) EXPECT_EQ(leg.outcome, Outcome::kUnchecked);
  EXPECT_EQ(check(text, {.max_seconds = 1e300}).outcome, Outcome::kAccepted);
  std::stop_source stop;
  stop.request_stop();
  EXPECT_THROW((void)check(text, {.stop = stop.get_token()}), Interrupted);
}

TEST(Legs, AreWhatWasAskedForOrRejected) {
  const std::string text = text_of("legs");
  EXPECT_EQ(check(text, {.expect = Theorem::Verdict::kProved}).outcome, Outcome::kAccepted);
  EXPECT_EQ(check(text, {.expect = Theorem::Verdict::kRefuted}).outcome, Outcome::kRejected);
  EXPECT_EQ(check(text_of("legs_refuted"), {.expect = Theorem::Verdict::kProved}).outcome, Outcome::kRejected);
  EXPECT_EQ(check(text, {.trusted = {std::string(64, 'a')}}).message, "nobody signed it");
  const ExpectedPath path;
  EXPECT_NE(check(text, {.path = &path}).message.find("a leg's certificate"), std::string::npos);
}

TEST(Legs, AreComparedWithTheLegsOfACase) {
  const json certificate = accepted("legs");
  const json of_case = problems_of(certificate);
  const auto compare = [](const json& what, const json& with) {
    CheckOptions options;
    options.problem = &with;
    return check(what.dump(), options);
  };
  const CheckResult same = compare(certificate, of_case);
  EXPECT_EQ(same.outcome, Outcome::kAccepted) << same.message;
  EXPECT_TRUE(same.not_compared.empty());
  json other = of_case;
  other[1]["load"]["wrench"][2] = "1.03";
  EXPECT_EQ(compare(certificate, other).message, "leg 2 is about another problem than the case's");
  other = of_case;
  other.erase(2);
  EXPECT_EQ(compare(certificate, other).message, "the certificate has 3 legs, the case has 2");
  EXPECT_EQ(compare(certificate, of_case[0]).message, "the certificate is about legs, and the case has none");

  const CheckResult one = compare(certificate["legs"][1], of_case);
  EXPECT_EQ(one.outcome, Outcome::kAccepted) << one.message;
  EXPECT_EQ(one.not_compared, (std::vector<std::string>{"the case's other legs", "path file"}));
  other = of_case;
  other[1]["load"]["wrench"][2] = "1.03";
  EXPECT_EQ(compare(certificate["legs"][1], other).message, "the certificate is about another problem");
  EXPECT_EQ(compare(accepted("robot1_near_goal"), of_case).message, "the certificate is about none of the case's legs");
}

}  // namespace
}  // namespace taut::checker
