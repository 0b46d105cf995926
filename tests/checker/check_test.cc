// SPDX-License-Identifier: GPL-3.0-or-later
#include "checker/check.h"

#include <gmpxx.h>
#include <gtest/gtest.h>

#include "checker/format/claims.h"
#include "checker/format/exact.h"
#include "checker/stated_load.h"
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

TEST(Checker, AnAuditWithoutALawIsComparedWithACaseWithoutTime) {
  using Names = std::vector<std::string>;
  const CheckOptions nothing_proved = {.max_seconds = 0};
  const auto compare = [&](const nlohmann::json& certificate, const nlohmann::json& of_case) {
    CheckOptions options = nothing_proved;
    options.problem = &of_case;
    return check(certificate.dump(), options);
  };
  nlohmann::json audit = accepted("geodesic");
  audit["problem"]["load"] = nlohmann::json::parse(R"({"point_m": ["0", "0", "0"], "gravity_m_s2": ["0", "0", "-9.81"],
    "items": [{"name": "payload", "weight": {"mass_kg": ["1", "1"], "at_m": ["0", "0", "0"], "at_tolerance_m": "0"}},
              {"name": "any", "force": {"ball": {"radius": "1"}, "axes": "W", "at_m": ["0", "0", "0"]}}]})");
  audit["claim"] = claim_text(true, {.has_items = true});
  seal(audit);
  nlohmann::json of_case = audit["problem"];
  of_case["time"] = {{"load_speed_m_s", "1"}};
  of_case["load"]["items"][0]["weight"]["inertia_box_m"] = {"1", "1", "1"};
  const CheckResult compared = compare(audit, of_case);
  EXPECT_EQ(compared.outcome, Outcome::kUnchecked) << compared.message;
  EXPECT_EQ(compared.not_compared, (Names{"time", "path file"}));
  of_case["load"]["items"][0]["weight"]["mass_kg"][1] = "2";
  EXPECT_EQ(compare(audit, of_case).message, "the certificate is about another problem");

  const nlohmann::json planned = accepted("robot1_near_goal");
  of_case = planned["problem"];
  EXPECT_EQ(compare(planned, of_case).outcome, Outcome::kUnchecked);
  of_case["time"] = {{"load_speed_m_s", "1"}};
  EXPECT_EQ(compare(planned, of_case).message, "the certificate is about another problem");
}

/// robot1_near_goal as a move that rests at each waypoint, with steps of so many seconds.
nlohmann::json a_move(const std::string& step_s, const nlohmann::json& limits) {
  nlohmann::json json = accepted("robot1_near_goal");
  json["version"] = 6;
  json["claim"] = claim_text(true, {.has_time = true, .is_move = true});
  json["problem"]["time"] = limits;
  nlohmann::json controls = nlohmann::json::array();
  for (std::size_t k = 0; k < json["path"]["waypoints"].size(); ++k) {
    for (int n = 0; n < 3; ++n) controls.push_back(print_binary64(static_cast<double>(k)));
  }
  json["path"]["timing"] = {{"controls", controls}, {"step_s", step_s}};
  for (nlohmann::json& segment : json["segments"]) segment["margins"]["wrench_scale"] = "1";
  json["margins"]["wrench_scale"] = "1";
  seal(json);
  return json;
}

TEST(Checker, AcceptsAMoveThatKeepsItsLimitsInTime) {
  const nlohmann::json limits = {{"load_acceleration_m_s2", "1"},
                                 {"load_angular_acceleration_rad_s2", "1"},
                                 {"load_angular_speed_rad_s", "pi"},
                                 {"load_speed_m_s", "1/10"},
                                 {"winch_acceleration_m_s2", nlohmann::json(6, "1")},
                                 {"winch_power_W", {nullptr, "1", "1", "1", "1", "1"}},
                                 {"winch_speed_m_s", nlohmann::json(6, "0.1")}};
  const nlohmann::json slow = a_move("0x1p+4", limits);
  const CheckResult result = check(slow.dump());
  EXPECT_EQ(result.outcome, Outcome::kAccepted) << result.message;
  EXPECT_NE(result.message.find("a move, proved again"), std::string::npos) << result.message;
  EXPECT_NE(result.message.find("limits in time kept"), std::string::npos) << result.message;
  EXPECT_EQ(check(a_move("0x1p-4", limits).dump()).outcome, Outcome::kRejected);
  for (const auto& [key, value] : limits.items()) {
    const nlohmann::json least = value.is_array() ? nlohmann::json(6, "1e-9") : nlohmann::json("1e-9");
    const CheckResult rejected = check(a_move("0x1p+4", {{key, least}}).dump());
    EXPECT_EQ(rejected.outcome, Outcome::kRejected) << key;
    EXPECT_NE(rejected.message.find("may not be kept"), std::string::npos) << rejected.message;
  }
  EXPECT_EQ(
      stated_time(slow.dump()),
      "limits in time: winch speed below 0.1 m/s; winch acceleration below 1 m/s^2; winch power below (no limit, 1, "
      "1, 1, 1, 1) W; speed of the load point below 1/10 m/s; acceleration of the load point below 1 m/s^2; angular "
      "speed below pi rad/s; angular acceleration below 1 rad/s^2");
  EXPECT_EQ(stated_time(accepted("robot1_near_goal").dump()), "");
  nlohmann::json growing = slow;
  for (nlohmann::json& segment : growing["segments"]) segment["margins"]["wrench_scale"] = "1.0001";
  growing["margins"]["wrench_scale"] = "1.0001";
  seal(growing);
  EXPECT_NE(check(growing.dump()).message.find("the wrench scale is not proved as claimed"), std::string::npos);
}

TEST(Checker, ConfirmsThatAMoveIsTooFast) {
  const auto refuted = [&](const std::string& step_s, const char* lower) {
    nlohmann::json json = a_move(step_s, {{"load_speed_m_s", "1/1000"}});
    json["verdict"] = "refuted";
    json["claim"] = claim_text(false, {.has_time = true, .is_move = true});
    json["margins"] = nlohmann::json::object();
    json["segments"] = nlohmann::json::array();
    json["witness"] = {{"at", {{"segment", 0}, {"s", "1/2"}}},
                       {"cable", nullptr},
                       {"kind", "load_speed"},
                       {"limit", "1/1000"},
                       {"motion", nlohmann::json::array()},
                       {"proof", {{"bits", 64}}},
                       {"value", {lower, "1e3"}}};
    seal(json);
    return check(json.dump());
  };
  const CheckResult accepted = refuted("0x1p-7", "0.0011");
  EXPECT_EQ(accepted.outcome, Outcome::kAccepted) << accepted.message;
  EXPECT_NE(accepted.message.find("a move, refuted again"), std::string::npos) << accepted.message;
  EXPECT_NE(refuted("0x1p-7", "0.0009").message.find("states a rate that may be below its limit"), std::string::npos);
  EXPECT_NE(refuted("0x1p+10", "0.0011").message.find("the rate at the witness is outside"), std::string::npos);
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
