// SPDX-License-Identifier: GPL-3.0-or-later
#include "checker/check.h"

#include <gmpxx.h>
#include <gtest/gtest.h>

#include "checker/format/claims.h"
#include "tests/checker/fixtures.h"

namespace taut::checker {
namespace {

/// What NAME.txt expects of the message; empty if nothing.
std::string expected_message(std::filesystem::path certificate) {
  const std::string why = read_text(certificate.replace_extension(".txt"));
  const std::string key = "expect: ";
  const std::size_t begin = why.find(key);
  return begin == std::string::npos ? "" : why.substr(begin + key.size(), why.find('\n', begin) - begin - key.size());
}

void expect_outcome(const std::string& folder, Outcome outcome, bool with_message) {
  const auto files = certificates(folder);
  EXPECT_GE(files.size(), 10U);
  for (const auto& file : files) {
    const CheckResult result = check(read_text(file));
    EXPECT_EQ(result.outcome, outcome) << file << ": " << result.message;
    const std::string expected = expected_message(file);
    EXPECT_EQ(expected.empty(), !with_message) << file;
    EXPECT_NE(result.message.find(expected), std::string::npos) << file << ": " << result.message;
  }
}

TEST(Checker, AcceptsEveryTrueCertificate) { expect_outcome("accepted", Outcome::kAccepted, false); }
TEST(Checker, RejectsEveryFalseCertificateAndSaysWhy) { expect_outcome("rejected", Outcome::kRejected, true); }
TEST(Checker, RecognisesEveryMalformedCertificateAndSaysWhy) { expect_outcome("malformed", Outcome::kMalformed, true); }

TEST(Checker, AcceptsAnyCanonicallyEqualText) {
  const nlohmann::json json = accepted("robot1_near_goal");
  EXPECT_EQ(check(json.dump()).outcome, Outcome::kAccepted);
  EXPECT_EQ(check("\n " + json.dump(4) + "\n\n").outcome, Outcome::kAccepted);
}

TEST(Checker, AnUntouchedResultProvesNothing) { EXPECT_EQ(CheckResult{}.outcome, Outcome::kMalformed); }

TEST(Checker, SaysUndecidedWhereTheCertificateDoes) {
  nlohmann::json json = accepted("robot1_near_goal");
  json["verdict"] = "undecided";
  json["claim"] = kUndecidedClaim;
  json["segments"] = nlohmann::json::array();
  json["margins"] = nlohmann::json::object();
  json["undecided"] = {{"reason", "out of time"}, {"segment", 0}, {"box", {"1/4", "1/2"}}};
  seal(json);
  const CheckResult result = check(json.dump());
  EXPECT_EQ(result.outcome, Outcome::kUndecided);
  EXPECT_NE(result.message.find("out of time"), std::string::npos);
  json["path"]["waypoints"] = nlohmann::json::array();
  json["undecided"] = {{"reason", "no path was found"}, {"segment", nullptr}, {"box", nullptr}};
  seal(json);
  EXPECT_EQ(check(json.dump()).outcome, Outcome::kUndecided);
}

TEST(Checker, KeepsToItsBudgetAndToItsCaller) {
  const std::string text = accepted("robot1_near_goal").dump();
  const CheckResult no_time = check(text, {.max_seconds = 0});
  EXPECT_EQ(no_time.outcome, Outcome::kUnchecked);
  EXPECT_EQ(no_time.certificate->at("verdict"), "proved") << "what was read is there, with no theorem";
  EXPECT_FALSE(no_time.theorem);
  EXPECT_EQ(check(text, {.max_seconds = 1e300}).outcome, Outcome::kAccepted);
  EXPECT_EQ(check(accepted("lengths_inner").dump(), {.max_seconds = 1e-6}).outcome, Outcome::kUnchecked);
  std::stop_source stop;
  stop.request_stop();
  EXPECT_THROW((void)check(text, {.stop = stop.get_token()}), Interrupted);
}

TEST(Checker, AcceptsTheExpectedVerdictOnly) {
  const std::string proved = accepted("robot1_near_goal").dump();
  const std::string refuted = accepted("refuted_singular").dump();
  EXPECT_EQ(check(proved, {.expect = Theorem::Verdict::kProved}).outcome, Outcome::kAccepted);
  EXPECT_EQ(check(proved, {.expect = Theorem::Verdict::kRefuted}).outcome, Outcome::kRejected);
  EXPECT_EQ(check(refuted, {.expect = Theorem::Verdict::kRefuted}).outcome, Outcome::kAccepted);
  EXPECT_EQ(check(refuted, {.expect = Theorem::Verdict::kProved}).message,
            "the certificate says refuted, expected proved");
}

TEST(Checker, SaysWhatItDidNotCompare) {
  const nlohmann::json json = accepted("robot1_near_goal");
  const nlohmann::json problem = json["problem"];
  using Names = std::vector<std::string>;
  EXPECT_EQ(check(json.dump()).not_compared, (Names{"case", "path file"}));
  EXPECT_EQ(check(json.dump(), {.problem = &problem}).not_compared, Names{"path file"});
}

TEST(Checker, PrintsWhatAFileSaysAsOneLineOfAscii) {
  nlohmann::json json = accepted("robot1_near_goal");
  json["verdict"] = "undecided";
  json["claim"] = kUndecidedClaim;
  json["segments"] = nlohmann::json::array();
  json["margins"] = nlohmann::json::object();
  json["undecided"] = {
      {"reason", "x\r\x1b[2Kaccepted: proved again\n\u202e\x7f"}, {"segment", nullptr}, {"box", nullptr}};
  seal(json);
  EXPECT_EQ(check(json.dump()).message,
            "the certificate claims nothing: x\\x0d\\x1b[2Kaccepted: proved again\\x0a\\xe2\\x80\\xae\\x7f");
}

TEST(Checker, ARefutedPathOfOneWaypointIsAnyOfTheQuerys) {
  nlohmann::json json = accepted("refuted_length_min");  // at the query's second waypoint
  EXPECT_EQ(check(json.dump()).outcome, Outcome::kAccepted);
  json["path"]["waypoints"][0]["half_turns"][0] = 2;
  seal(json);
  EXPECT_EQ(check(json.dump()).outcome, Outcome::kAccepted);
  json["path"]["waypoints"][0] = {{"x", {"0x1p+0", "-0x0p+0"}}, {"half_turns", {1, 0}}};  // phi = 1, flipped
  seal(json);
  EXPECT_EQ(check(json.dump()).outcome, Outcome::kAccepted);  // theta is 0, so that phi does not matter
  json["path"]["waypoints"][0]["half_turns"][0] = 0;
  json["path"]["waypoints"][0]["x"][1] = "0x1p-1022";
  seal(json);
  EXPECT_NE(check(json.dump()).message.find("none of the query's"), std::string::npos);
}

TEST(Checker, ComparesWithTheCase) {
  const nlohmann::json json = accepted("robot1_near_goal");
  nlohmann::json problem = json["problem"];
  EXPECT_EQ(check(json.dump(), {.problem = &problem}).outcome, Outcome::kAccepted);
  problem["robot"]["tension_N"][3][0] = "0.0500";  // the same number, another text: not what the user gave
  const CheckResult result = check(json.dump(), {.problem = &problem});
  EXPECT_EQ(result.outcome, Outcome::kRejected);
  EXPECT_NE(result.message.find("another problem"), std::string::npos);
}

TEST(Checker, ConfirmsEachMarginUpToWhatTheBoxesProve) {
  // Halving the doubt, each margin is confirmed up to one number, and denied from there on.
  for (const std::string margin : {"tension_N", "length_m", "wrench_scale", "clearance_m"}) {
    nlohmann::json json = accepted(margin == "clearance_m" ? "clearance" : "robot1_near_goal");
    const double stated = std::stod(json["margins"][margin].get<std::string>());
    const auto outcome_of = [&](double value) {
      char text[32];
      std::snprintf(text, sizeof text, "%.15f", value);
      json["margins"][margin] = text;
      for (auto& segment : json["segments"]) segment["margins"][margin] = text;
      seal(json);
      return check(json.dump()).outcome;
    };
    double low = stated, high = 2 * stated;
    ASSERT_EQ(outcome_of(low), Outcome::kAccepted) << margin;
    ASSERT_EQ(outcome_of(high), Outcome::kRejected) << margin;
    for (int i = 0; i < 20; ++i) {
      const double middle = (low + high) / 2;
      const Outcome outcome = outcome_of(middle);
      ASSERT_TRUE(outcome == Outcome::kAccepted || outcome == Outcome::kRejected) << margin;
      (outcome == Outcome::kAccepted ? low : high) = middle;
    }
    EXPECT_EQ(outcome_of(0.5 * (margin == "wrench_scale" ? 1 + stated : stated)), Outcome::kAccepted) << margin;
    EXPECT_EQ(outcome_of(margin == "wrench_scale" ? 0.999 : -0.001), Outcome::kRejected) << margin;
  }
}

TEST(Checker, BoxesDoNotReachAcrossInnerPoses) {
  nlohmann::json certificate = accepted("lengths_inner_still");
  nlohmann::json& inner = certificate["path"]["pose_tubes"][0]["inner"];
  nlohmann::json pose = inner[0];
  inner.clear();
  for (int k = 1; k < 4096; ++k) {
    mpq_class s(k, 4096);
    s.canonicalize();
    pose["s"] = s.get_str();
    inner.push_back(pose);
  }
  seal(certificate);
  const CheckResult result = check(certificate.dump());
  EXPECT_EQ(result.outcome, Outcome::kMalformed);
  EXPECT_NE(result.message.find("reaches across no pose"), std::string::npos) << result.message;
}

TEST(Checker, AQueryThatCannotBeRoundedIsRejected) {
  nlohmann::json json = accepted("robot1_near_goal");
  json["problem"]["query"]["waypoints"][0][0] = "1.7 + sin(pi)";  // equal to 1.7, but no finite precision shows that
  seal(json);
  EXPECT_EQ(check(json.dump()).outcome, Outcome::kAccepted);        // 1.7 is no tie: its neighbourhood is enough
  json["problem"]["query"]["waypoints"][0][0] = "0*1.7 + sin(pi)";  // the sign, hence the neighbour, stays open
  seal(json);
  EXPECT_EQ(check(json.dump()).outcome, Outcome::kRejected);
}

TEST(Checker, ATieRoundsToEven) {
  nlohmann::json json = accepted("robot1_start_is_goal");
  for (auto& typed : json["problem"]["query"]["waypoints"])
    typed[1] = "1.6000000000000000888178419700125232338905334472656250";
  seal(json);  // the binary64 nearest to 1.6, all its digits
  EXPECT_EQ(check(json.dump()).outcome, Outcome::kAccepted);
  // Half an ulp (2^-53) above it: the mantissa ends in ...a, even, so the tie falls back to it.
  for (auto& typed : json["problem"]["query"]["waypoints"])
    typed[1] = "1.6000000000000000888178419700125232338905334472656250 + 2^-53";
  seal(json);
  EXPECT_EQ(check(json.dump()).outcome, Outcome::kAccepted);
  for (auto& typed : json["problem"]["query"]["waypoints"])
    typed[1] = "1.6000000000000000888178419700125232338905334472656250 + 2^-53 + 2^-200";
  seal(json);
  EXPECT_EQ(check(json.dump()).outcome, Outcome::kRejected);
}

}  // namespace
}  // namespace taut::checker
