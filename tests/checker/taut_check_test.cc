// SPDX-License-Identifier: GPL-3.0-or-later
// The executable's surface: exit codes and what it prints.
#include <gtest/gtest.h>
#include <sys/wait.h>

#include <array>
#include <cstdio>
#include <cstdlib>
#include <utility>

#include "tests/checker/fixtures.h"

namespace taut::checker {
namespace {

struct Output {
  int exit_code;
  std::string text;
};

/// What is printed on stdout, or on another stream as `redirection` says.
Output run(const std::string& arguments, const std::string& redirection = "2>/dev/null") {
  Output result{-1, ""};
  FILE* pipe = popen((TAUT_CHECK " " + arguments + " " + redirection).c_str(), "r");
  for (int c = std::fgetc(pipe); c != EOF; c = std::fgetc(pipe)) result.text += static_cast<char>(c);
  const int status = pclose(pipe);
  result.exit_code = WIFEXITED(status) ? WEXITSTATUS(status) : -1;
  return result;
}

const std::string kFolder = TAUT_CERTIFICATES "/";

TEST(TautCheck, ExitCodesSayTheOutcome) {
  EXPECT_EQ(run(kFolder + "accepted/robot1_near_goal.json").exit_code, 0);
  EXPECT_EQ(run(kFolder + "accepted/refuted_singular.json").exit_code, 0);
  EXPECT_EQ(run(kFolder + "rejected/anchor_moved.json").exit_code, 1);
  EXPECT_EQ(run(kFolder + "malformed/cut.json").exit_code, 3);
  EXPECT_EQ(run(kFolder + "no-such-file.json").exit_code, 3);
  EXPECT_EQ(run(kFolder).exit_code, 3);
  EXPECT_EQ(run("").exit_code, 3);
  EXPECT_EQ(run("--no-such-flag x").exit_code, 3);
  EXPECT_EQ(run("--help").exit_code, 0);
}

TEST(TautCheck, AnotherCaseIsRejectedAndABrokenOneIsBadInput) {
  const std::string certificate = kFolder + "accepted/robot1_near_goal.json ";
  EXPECT_EQ(run(certificate + TAUT_SOURCE_DIR "/cases/robot1-slice-qs-qg.yaml").exit_code, 1);
  EXPECT_EQ(run(certificate + TAUT_SOURCE_DIR "/tests/certificates/make_bases.py").exit_code, 3);
  EXPECT_EQ(run(certificate + "no-such-case.yaml").exit_code, 3);
}

TEST(TautCheck, PrintsASentence) {
  const Output proved = run(kFolder + "accepted/robot1_near_goal.json");
  EXPECT_TRUE(proved.text.starts_with("accepted: proved again: 1 segment, 5 boxes, ")) << proved.text;
  EXPECT_NE(proved.text.find("\nload: an ellipsoid around (0, 0, 1) N"), std::string::npos) << proved.text;
  EXPECT_EQ(run(kFolder + "rejected/anchor_moved.json").text.find("load:"), std::string::npos);
  EXPECT_TRUE(
      run(kFolder + "rejected/anchor_moved.json").text.starts_with("rejected: not confirmed: segment 0, box ["));
  EXPECT_EQ(run("--quiet " + kFolder + "malformed/cut.json").text, "");
}

TEST(TautCheck, ComplainsOfBadInputOnStderr) {
  const std::array<std::pair<const char*, const char*>, 2> complaints = {
      {{"malformed/cut.json", "malformed: "}, {"no-such-file.json", "bad input: "}}};
  for (const auto& [file, begin] : complaints) {
    const std::string arguments = kFolder + file;
    EXPECT_EQ(run(arguments).text, "");
    const std::string complaint = run(arguments, "2>&1 >/dev/null").text;
    EXPECT_TRUE(complaint.starts_with(begin)) << complaint;
    EXPECT_EQ(std::count(complaint.begin(), complaint.end(), '\n'), 1) << complaint;
    EXPECT_EQ(nlohmann::json::parse(run("--json " + arguments).text)["outcome"], "malformed");
  }
  EXPECT_EQ(run(kFolder + "rejected/anchor_moved.json", "2>&1 >/dev/null").text, "");
}

TEST(TautCheck, ReadsNoMoreOfAKeyThanAKeyHas) {
  const std::string trust = kFolder + "accepted/refuted_length_max.json --trust ";
  EXPECT_EQ(run(trust + "/dev/zero").exit_code, 3);
  EXPECT_NE(run(trust + "/dev/zero", "2>&1").text.find("/dev/zero: got a device, expected a file"), std::string::npos);
  const std::string pipe = ::testing::TempDir() + "taut_check_endless_key";
  ASSERT_EQ(std::system(("rm -f " + pipe + " && mkfifo " + pipe).c_str()), 0);
  const std::string seen = run(trust + pipe, "2>&1 & timeout 30 sh -c 'yes >" + pipe + "'; wait").text;
  EXPECT_NE(seen.find("got more than 65536 bytes, expected a smaller file"), std::string::npos) << seen;
  std::remove(pipe.c_str());
}

TEST(TautCheck, NoticesThatNobodyCanReadItsResult) {
  EXPECT_EQ(run(kFolder + "accepted/robot1_near_goal.json", ">/dev/full 2>/dev/null").exit_code, 4);
}

TEST(TautCheck, PrintsJsonForMachines) {
  const nlohmann::json report = nlohmann::json::parse(run("--json " + kFolder + "accepted/robot1_near_goal.json").text);
  EXPECT_EQ(report["outcome"], "accepted");
  EXPECT_EQ(report["verdict"], "proved");
  EXPECT_EQ(report["boxes"], 5);
  EXPECT_GE(report["bits"], 32);
}

}  // namespace
}  // namespace taut::checker
