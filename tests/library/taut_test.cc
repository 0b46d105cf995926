// SPDX-License-Identifier: GPL-3.0-or-later
#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <immintrin.h>
#include <taut/taut.h>
#include <tbb/task_arena.h>
#include <unistd.h>

#include <atomic>
#include <cfenv>
#include <clocale>
#include <cmath>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <limits>
#include <numbers>
#include <sstream>
#include <thread>

#include "tests/support/temporary_file.h"

namespace {

using taut::Certificate;
using taut::Verdict;
using testing::AllOf;
using testing::HasSubstr;
using testing::Not;

const std::string kCases = TAUT_SOURCE_DIR "/cases/";
const std::string kRobot1 = kCases + "robot1-slice-qs-qg.yaml";
const std::string kBridging = kCases + "audits/robot1-bridging.yaml";

std::string content_of(const std::filesystem::path& path) {
  std::ifstream file(path, std::ios::binary);
  std::ostringstream text;
  text << file.rdbuf();
  return text.str();
}

/// The certificate that a command of taut writes.
std::string certificate_of_command(const std::string& command) {
  const std::filesystem::path out = std::filesystem::temp_directory_path() / fmt::format("taut-{}", ::getpid());
  const int status = std::system(
      fmt::format("{} {} --max-seconds 0 --out {} >/dev/null 2>&1", TAUT_PROGRAM, command, out.string()).c_str());
  EXPECT_LE(WEXITSTATUS(status), 2) << command;
  std::string text = content_of(out / "certificate.json");
  std::filesystem::remove_all(out);
  return text;
}

/// path.csv without its last line, which names the certificate.
std::string rows(const Certificate& certificate) {
  const std::string text = certificate.path_csv();
  return text.substr(0, text.rfind("# certificate.json"));
}

taut::Outcome outcome(const Certificate& certificate) { return taut::check(certificate).outcome; }

// --- Cases -----------------------------------------------------------------------------------------------------------

TEST(Case, SaysWhatItIsAbout) {
  const taut::Case robot = taut::Case::load(kRobot1);
  EXPECT_EQ(robot.name(), "robot1-slice-qs-qg");
  EXPECT_EQ(robot.parameters(), (std::vector<std::string>{"phi", "theta"}));
  EXPECT_EQ(robot.query_waypoints(), 2U);
  EXPECT_THAT(robot.description(), HasSubstr("Turning straight from q_s to q_g"));
  EXPECT_EQ(robot.tension_limits_N()[5], (std::array<double, 2>{0.05, 0.5}));
  EXPECT_EQ(robot.length_limits_m()[0], (std::array<double, 2>{0.1, 0.55}));
}

TEST(Case, SaysTheLoadAndWhatMayNotBeMeant) {
  const taut::Case crane = taut::Case::load(kCases + "cranes/portal-20t.yaml");
  EXPECT_THAT(
      crane.load_statement(),
      testing::ElementsAre(HasSubstr("In all 19.76 to 20.24 t"), HasSubstr("Extremes of"), HasSubstr("'platform': 8 t"),
                           HasSubstr("'payload': 11.76 to"), HasSubstr("'wind': a force of up to 6 kN")));
  for (const std::string& line : crane.load_statement()) EXPECT_THAT(crane.summary(), HasSubstr(line));
  EXPECT_TRUE(crane.warnings().empty());
  std::string text = content_of(kCases + "cranes/portal-20t.yaml");
  text.insert(text.find("  items:"), "  ellipsoid: around_items\n");
  EXPECT_THAT(taut::Case::parse(text).load_statement(), testing::Contains(HasSubstr("the load is one ellipsoid")));
  text.insert(text.find("mass_tolerance"), "inertia: {box: [1, 1, 1]}, ");
  EXPECT_THAT(taut::Case::parse(text, "crane.yaml").warnings(),
              testing::ElementsAre(AllOf(testing::StartsWith("crane.yaml:23:"), HasSubstr("is not used"))));
}

TEST(Case, HasTextForTheHeadOfAReport) {
  using Fields = std::vector<std::pair<std::string, std::string>>;
  EXPECT_EQ(taut::Case::load(kCases + "cranes/portal-20t.yaml").document_fields(),
            (Fields{{"title", "Container to the second bay"},
                    {"machine", "Portal 2, six winches"},
                    {"site", "Hall B"},
                    {"load_name", "20 ft container"}}));
  EXPECT_EQ(taut::Case::load(kCases + "tutorial/01-a-free-move.yaml").document_fields(), Fields());
}

TEST(Case, ThatIsWrongSaysWhere) {
  std::string text = content_of(kRobot1);
  text.replace(text.find("tension: [0.05, 0.5]"), 20, "tension: [0.5, 0.05]");
  try {
    static_cast<void>(taut::Case::parse(text, "crane.yaml"));
    FAIL();
  } catch (const taut::InputError& error) {
    EXPECT_EQ(error.file(), "crane.yaml");
    EXPECT_EQ(error.line(), 35U);
    EXPECT_EQ(error.field(), "robot.tension[0]");
    EXPECT_EQ(error.code(), "E3");
    EXPECT_THAT(error.what(), testing::StartsWith("crane.yaml:35:12: robot.tension[0]: got [0.5, 0.05], expected"));
  }
  EXPECT_THROW(static_cast<void>(taut::Case::load("/no/such/file.yaml")), taut::InputError);
}

// --- As the commands do ----------------------------------------------------------------------------------------------

TEST(Plan, GivesTheCommandsCertificateByteForByte) {
  for (const char* name : {"robot1-slice-qs-qg", "robot1-slice-qs1-qg", "robot2-sphere-q1-q2-q3",
                           "robot2-implicit-rail", "robot2-free-q2-q3"}) {
    const std::string file = kCases + name + ".yaml";
    const Certificate certificate = taut::plan(taut::Case::load(file));
    EXPECT_EQ(certificate.text(), certificate_of_command("plan " + file)) << name;
  }
}

TEST(Audit, GivesTheCommandsCertificateByteForByte) {
  int count = 0;
  for (const auto& entry : std::filesystem::directory_iterator(kCases + "audits")) {
    if (entry.path().extension() != ".yaml") continue;
    // How far each tolerance may grow is sought for minutes under sanitizers.
    const bool has_tolerances = entry.path().stem() == "robot1-cable-lengths-tolerances";
    if (has_tolerances && std::getenv("TAUT_SAMPLED") != nullptr) continue;
    const Certificate certificate = taut::audit(taut::Case::load(entry.path().string()));
    EXPECT_EQ(certificate.text(), certificate_of_command("audit " + entry.path().string())) << entry.path();
    ++count;
  }
  EXPECT_GE(count, 8);
}

TEST(Audit, OfAFileGivesTheCommandsCertificate) {
  const std::string path = kCases + "audits/robot1-bridging.csv";
  const Certificate certificate = taut::audit(taut::Case::load(kRobot1), path);
  EXPECT_EQ(certificate.text(), certificate_of_command("audit " + kRobot1 + " " + path));
}

TEST(Plan, KeepsAndUsesAtlases) {
  const taut::testing::TemporaryFile atlas("");
  const taut::Case robot = taut::Case::load(kRobot1);
  taut::PlanOptions options;
  options.save_atlas = atlas.path();
  const Certificate first = taut::plan(robot, options);
  EXPECT_GT(std::filesystem::file_size(atlas.path()), 1000U);
  options = {};
  options.atlas = atlas.path();
  EXPECT_EQ(rows(taut::plan(robot, options)), rows(first));
}

/// Two poses between which there is no path.
taut::Case apart() { return taut::Case::load(kCases + "maps/robot1-sigma34-apart.yaml"); }

TEST(Plan, ProvesThatNoPathExists) {
  const Certificate planned = taut::plan(apart());
  EXPECT_EQ(planned.verdict(), Verdict::kNoPath);
  EXPECT_EQ(planned.no_path_from(), 0U);
  EXPECT_EQ(planned.text(), certificate_of_command("plan " + kCases + "maps/robot1-sigma34-apart.yaml"));
  ASSERT_TRUE(planned.theorem());
  EXPECT_THAT(planned.theorem()->claim(), testing::StartsWith("No path exists from the first"));
  EXPECT_FALSE(planned.theorem()->margins() || planned.theorem()->witness());
  EXPECT_EQ(planned.boxes(), taut::check(planned).boxes);
  EXPECT_GT(planned.boxes(), 100U);
  EXPECT_EQ(planned.segments(), 0U);
  EXPECT_TRUE(planned.path().waypoints.empty() && planned.samples().empty() && planned.stretches().empty());
  EXPECT_EQ(planned.document_fields(), apart().document_fields());
  EXPECT_THROW((void)planned.path_csv(), taut::InputError);
  EXPECT_THROW((void)planned.controller_csv(), taut::InputError);
  EXPECT_FALSE(taut::plan(taut::Case::load(kRobot1)).no_path_from());
}

TEST(Plan, NeedNotTryToProveThatNoPathExists) {
  taut::PlanOptions options;
  options.no_path_seconds = 0;
  const Certificate planned = taut::plan(apart(), options);
  EXPECT_EQ(planned.verdict(), Verdict::kUndecided);
  EXPECT_FALSE(planned.no_path_from());
  options.no_path_seconds = -1;
  EXPECT_THROW((void)taut::plan(apart(), options), taut::InputError);
}

TEST(Certificate, ThatNoPathExistsIsLoadedUncheckedAndReported) {
  const Certificate planned = taut::plan(apart());
  const Certificate loaded = Certificate::parse(planned.text());
  EXPECT_EQ(loaded.verdict(), Verdict::kUnchecked);
  EXPECT_EQ(loaded.no_path_from(), 0U);
  EXPECT_EQ(loaded.case_name(), "robot1-sigma34-apart");
  EXPECT_EQ(loaded.boxes(), planned.boxes());
  const taut::CheckResult checked = taut::check(loaded, {apart(), {}, {}, {}});
  ASSERT_TRUE(checked.theorem) << checked.message;
  EXPECT_EQ(checked.theorem->verdict(), Verdict::kNoPath);
  taut::ReportOptions options;
  EXPECT_THAT(taut::report(loaded, options), HasSubstr("NO PATH EXISTS"));
  options.max_check_seconds = 0;
  EXPECT_THAT(taut::report(loaded, options), AllOf(HasSubstr("UNCHECKED"), Not(HasSubstr("NO PATH EXISTS"))));

  std::string altered = planned.text();
  altered.replace(altered.find("\"waypoints\": ["), 15, "\"waypoints\":[ ");
  EXPECT_EQ(Certificate::parse(altered).boxes(), planned.boxes()) << "white space is no part of the content";
  std::string other = planned.text();
  const std::size_t letter = other.find_first_of("abcdefghijkl", other.find("\"tree\":") + 9);
  other[letter] = other[letter] == 'a' ? 'b' : 'a';
  EXPECT_THROW((void)Certificate::parse(other), taut::InputError);
}

TEST(Plan, OfACaseWithoutAQueryIsAnInputError) {
  try {
    static_cast<void>(taut::plan(taut::Case::load(kBridging)));
    FAIL();
  } catch (const taut::InputError& error) {
    EXPECT_EQ(error.field(), "query");
    EXPECT_THAT(error.what(), HasSubstr("robot1-bridging.yaml: query"));
  }
}

// --- Proofs of the caller's paths ------------------------------------------------------------------------------------

TEST(Prove, ProvesAPlannedPathWithItsMargins) {
  for (const char* name : {"robot1-slice-qs-qg", "robot2-implicit-rail", "robot2-sphere-q1-q2-q3"}) {
    const taut::Case robot = taut::Case::load(kCases + name + ".yaml");
    const Certificate planned = taut::plan(robot);
    const Certificate proved = taut::prove(robot, planned.path());
    EXPECT_EQ(proved.verdict(), Verdict::kProved) << name;
    EXPECT_EQ(proved.theorem()->margins()->tension_N, planned.theorem()->margins()->tension_N);
    EXPECT_EQ(proved.boxes(), planned.boxes());
    EXPECT_EQ(rows(proved), rows(planned));
    EXPECT_EQ(outcome(proved), taut::Outcome::kAccepted) << taut::check(proved).message;
  }
}

TEST(Prove, KeepsWaypointsBitForBit) {
  const taut::Case robot = taut::Case::load(kRobot1);
  const double third = 1.0 / 3.0;
  const taut::Path path = {taut::Interpolation::kStraight,
                           {{{0.1, third}, {}}, {{0.1 + 1e-17, std::nextafter(third, 1)}, {2, 0}}},
                           {"0", "0.25"}};
  const taut::Path again = taut::prove(robot, path).path();
  ASSERT_EQ(again.waypoints.size(), 2U);
  for (std::size_t k : {0U, 1U}) EXPECT_EQ(again.waypoints[k].x, path.waypoints[k].x);
  EXPECT_EQ(again.waypoints[1].half_turns, (std::vector<int>{2, 0}));
  EXPECT_EQ(again.times, path.times);
}

TEST(Prove, RefutesWithAWitness) {
  const taut::Case robot = taut::Case::load(kRobot1);
  const Certificate refuted =
      taut::prove(robot, {taut::Interpolation::kStraight, {{{-2.3, 1.6}, {}}, {{1.7, 1.7}, {}}}, {}});
  ASSERT_EQ(refuted.verdict(), Verdict::kRefuted);
  EXPECT_FALSE(refuted.theorem()->margins());
  const taut::Witness witness = *refuted.theorem()->witness();
  EXPECT_THAT(witness.kind, testing::StartsWith("tension"));
  EXPECT_TRUE(witness.kind == "tension_min" ? witness.value_upper <= witness.limit
                                            : witness.value_lower >= witness.limit);
  EXPECT_EQ(outcome(refuted), taut::Outcome::kAccepted);
}

TEST(Prove, OfPosesAndOfLengths) {
  for (const char* name : {"robot1-geodesic", "robot1-cable-lengths", "robot1-spline"}) {
    const taut::Case robot = taut::Case::load(kCases + "audits/" + name + ".yaml");
    const Certificate audited = taut::audit(robot);
    const Certificate proved = taut::prove(robot, audited.path());
    EXPECT_EQ(proved.verdict(), audited.verdict()) << name;
    EXPECT_EQ(outcome(proved), taut::Outcome::kAccepted) << taut::check(proved).message;
  }
}

TEST(Prove, OfLengthsFarApart) {
  const taut::Case robot = taut::Case::load(kCases + "audits/robot1-cable-lengths.yaml");
  const taut::Path path = taut::audit(robot).path();
  taut::Path sparse = path;
  sparse.waypoints.clear();
  for (std::size_t k = 0; k < path.waypoints.size(); k += 32) sparse.waypoints.push_back(path.waypoints[k]);
  sparse.times.clear();
  ASSERT_GE(sparse.waypoints.size(), 2U);
  const Certificate proved = taut::prove(robot, sparse);
  EXPECT_EQ(proved.verdict(), Verdict::kProved) << proved.reason();
  EXPECT_EQ(outcome(proved), taut::Outcome::kAccepted) << taut::check(proved).message;
}

TEST(Prove, OfLengthsRefinesARoughPose) {
  const taut::Case robot = taut::Case::load(kCases + "audits/robot1-cable-lengths.yaml");
  const taut::Path path = taut::audit(robot).path();
  taut::Path rough = path;
  for (taut::Waypoint& waypoint : rough.waypoints) {
    for (std::size_t j = 0; j < 3; ++j) waypoint.x[j] += 0.01;
    for (std::size_t j = 3; j < 7; ++j) waypoint.x[j] = std::round(100 * waypoint.x[j]) / 100;
  }
  const Certificate proved = taut::prove(robot, rough);
  EXPECT_EQ(proved.verdict(), Verdict::kProved) << proved.reason();
  EXPECT_EQ(outcome(proved), taut::Outcome::kAccepted);
  const taut::Path refined = proved.path();
  for (std::size_t k = 0; k < path.waypoints.size(); ++k) {
    for (std::size_t j = 0; j < 7; ++j) EXPECT_NEAR(refined.waypoints[k].x[j], path.waypoints[k].x[j], 1e-9);
    for (std::size_t j = 7; j < 13; ++j) EXPECT_EQ(refined.waypoints[k].x[j], path.waypoints[k].x[j]);
  }
  const taut::Path kept = taut::prove(robot, path).path();
  for (std::size_t k = 0; k < path.waypoints.size(); ++k) EXPECT_EQ(kept.waypoints[k].x, path.waypoints[k].x);
}

TEST(Prove, OfASinglePoseStaysThere) {
  const taut::Case robot = taut::Case::load(kRobot1);
  const Certificate proved = taut::prove(robot, {taut::Interpolation::kStraight, {{{-2.3, 1.6}, {}}}, {}});
  EXPECT_EQ(proved.verdict(), Verdict::kProved);
  EXPECT_EQ(proved.segments(), 1U);
}

TEST(Prove, SaysWhichNumberIsWrong) {
  const taut::Case robot = taut::Case::load(kRobot1);
  const auto field = [&](const taut::Path& path) -> std::string {
    try {
      static_cast<void>(taut::prove(robot, path));
    } catch (const taut::InputError& error) {
      return error.field();
    }
    return "no error";
  };
  const auto straight = [](taut::Waypoint a, taut::Waypoint b, std::vector<std::string> times = {}) {
    return taut::Path{taut::Interpolation::kStraight, {std::move(a), std::move(b)}, std::move(times)};
  };
  const double nan = std::numeric_limits<double>::quiet_NaN();
  EXPECT_EQ(field({}), "waypoints");
  EXPECT_EQ(field(straight({{1, 2, 3}, {}}, {{1, 2}, {}})), "waypoints[0].x");
  EXPECT_EQ(field(straight({{1, 1}, {}}, {{1, nan}, {}})), "waypoints[1].x[1]");
  EXPECT_EQ(field(straight({{1, 1}, {0}}, {{1, 1}, {}})), "waypoints[0].half_turns");
  EXPECT_EQ(field(straight({{1, 1}, {2'000'000, 0}}, {{1, 1}, {}})), "waypoints[0].half_turns[0]");
  EXPECT_EQ(field(straight({{1, 1}, {}}, {{1, 1}, {}}, {"0"})), "times");
  EXPECT_EQ(field(straight({{1, 1}, {}}, {{1, 1}, {}}, {"1", "1.0"})), "times[1]");
  EXPECT_EQ(field({taut::Interpolation::kGeodesic, {{{0, 0, 0, 0, 0, 0, 2}, {}}}, {}}), "waypoints[0].x");
  EXPECT_EQ(field({taut::Interpolation::kSpline, {{{1, 1}, {}}, {{1, 1}, {}}}, {}}), "waypoints");
}

TEST(Audit, OfATableIsThatOfItsFile) {
  const taut::Case robot = taut::Case::load(kRobot1);
  taut::Table table = {{"t[s]", "phi[deg]", "theta[deg]"}, {}};
  std::string text = "t[s],phi[deg],theta[deg]\n";
  for (int k = 0; k < 20; ++k) {
    const std::array<double, 3> row = {0.1 * k, -114.9 + 5.3 * k, 72.0 + k / 3.0};
    table.values.insert(table.values.end(), row.begin(), row.end());
    text += fmt::format("{},{},{}\n", row[0], row[1], row[2]);
  }
  const taut::testing::TemporaryFile file(text);
  const Certificate of_file = taut::audit(robot, file.path());
  const Certificate of_table = taut::audit(robot, table, {}, std::filesystem::path(file.path()).filename());
  EXPECT_EQ(of_table.text(), of_file.text());
  ASSERT_EQ(of_table.verdict(), Verdict::kRefuted);
  ASSERT_FALSE(of_table.stretches().empty());
  EXPECT_TRUE(of_table.stretches().front().violations);
  EXPECT_LT(of_table.stretches().front().begin.position(), of_table.stretches().front().end.position());

  table.values[4] = std::numeric_limits<double>::infinity();
  try {
    static_cast<void>(taut::audit(robot, table));
    FAIL();
  } catch (const taut::InputError& error) {
    EXPECT_EQ(error.file(), "table");
    EXPECT_EQ(error.line(), 3U);
    EXPECT_EQ(error.field(), "phi");
    EXPECT_EQ(error.code(), "E4");
  }
  table.values.pop_back();
  EXPECT_THROW(static_cast<void>(taut::audit(robot, table)), taut::InputError);
}

// --- Certificates ----------------------------------------------------------------------------------------------------

TEST(Certificate, IsSavedAndLoadedByteForByte) {
  const taut::testing::TemporaryFile file("");
  const Certificate planned = taut::plan(taut::Case::load(kRobot1));
  planned.save(file.path());
  EXPECT_EQ(content_of(file.path()), planned.text());
  const Certificate loaded = Certificate::load(file.path());
  EXPECT_EQ(loaded.text(), planned.text());
  EXPECT_EQ(loaded.case_name(), "robot1-slice-qs-qg");
  EXPECT_EQ(loaded.document_fields(), taut::Case::load(kRobot1).document_fields());
}

TEST(Theorem, IsMadeByTheCheckerAlone) {
  static_assert(!std::is_default_constructible_v<taut::Theorem>);
  const Certificate planned = taut::plan(taut::Case::load(kRobot1));
  EXPECT_EQ(planned.verdict(), Verdict::kProved);
  ASSERT_TRUE(planned.theorem());
  EXPECT_EQ(planned.theorem()->verdict(), Verdict::kProved);
  EXPECT_FALSE(planned.theorem()->witness());
  EXPECT_THAT(planned.path_csv(), HasSubstr(planned.theorem()->certificate_sha256() + "\n"));
  const std::string table = planned.controller_csv(0.005);
  EXPECT_THAT(table, HasSubstr("# Step: 5 mm."));
  EXPECT_THAT(table, HasSubstr("SHA-256 " + planned.theorem()->certificate_sha256() + "\n"));
  EXPECT_THAT(table, HasSubstr("\nsegment,s,px[m],py[m],pz[m],qx,qy,qz,qw,l1[m],"));
  for (const double wrong : {0.0, -1.0, 1e7, std::nan("")}) {
    EXPECT_THROW((void)planned.controller_csv(wrong), taut::InputError) << wrong;
  }

  const Certificate loaded = Certificate::parse(planned.text());
  EXPECT_EQ(loaded.verdict(), Verdict::kUnchecked);
  EXPECT_FALSE(loaded.theorem());
  EXPECT_THROW((void)loaded.controller_csv(), taut::InputError) << "nothing is known to be proved";
  const taut::CheckResult checked = taut::check(loaded);
  ASSERT_TRUE(checked.theorem);
  EXPECT_EQ(checked.theorem->verdict(), Verdict::kProved);
  EXPECT_THAT(checked.theorem->claim(), HasSubstr("every"));
  EXPECT_GT(checked.theorem->margins()->tension_N, 0);
  EXPECT_EQ(checked.not_compared, (std::vector<std::string>{"case", "path file"}));

  taut::PlanOptions no_time;
  no_time.max_check_seconds = 0;
  const Certificate unchecked = taut::plan(taut::Case::load(kRobot1), no_time);
  EXPECT_EQ(unchecked.text(), planned.text());
  EXPECT_EQ(unchecked.verdict(), Verdict::kUnchecked);
  EXPECT_FALSE(unchecked.theorem());
  taut::ReportOptions options;
  options.format = taut::ReportFormat::kText;
  EXPECT_THAT(taut::report(unchecked, options), HasSubstr("PROVED: ")) << "a report has it checked";
  options.max_check_seconds = 0;
  EXPECT_THAT(taut::report(loaded, options), testing::AllOf(HasSubstr("UNCHECKED: "), Not(HasSubstr("PROVED: "))));
  EXPECT_THAT(taut::report(planned, options), HasSubstr("PROVED: ")) << "there is a theorem already";
}

TEST(Theorem, IsNotMadeOfAForgedCertificate) {
  const Certificate forged = Certificate::load(TAUT_SOURCE_DIR "/tests/attacks/f1.json");
  EXPECT_EQ(forged.verdict(), Verdict::kUnchecked);
  EXPECT_FALSE(taut::check(forged).theorem);
  EXPECT_THROW(static_cast<void>(taut::report(forged)), taut::InputError);
}

TEST(Certificate, ThatWasAlteredIsNoneAndIsMalformed) {
  std::string text = taut::plan(taut::Case::load(kRobot1)).text();
  const std::size_t digit = text.find("\"0.05\"") + 4;
  text[digit] = '4';
  EXPECT_THROW(static_cast<void>(Certificate::parse(text)), taut::InputError);
  EXPECT_THROW(static_cast<void>(Certificate::parse("{}")), taut::InputError);
  EXPECT_EQ(taut::check(text).outcome, taut::Outcome::kMalformed);
  EXPECT_EQ(taut::check("").outcome, taut::Outcome::kMalformed);
}

TEST(Certificate, HasSamplesWithinTheProvedLimits) {
  const taut::Case robot = taut::Case::load(kRobot1);
  const std::vector<taut::Sample> samples = taut::plan(robot).samples(50);
  ASSERT_GE(samples.size(), 40U);
  EXPECT_EQ(samples.front().position, 0);
  for (const taut::Sample& sample : samples) {
    EXPECT_NEAR(sample.p_m[2], 0.35, 1e-12);
    for (std::size_t i = 0; i < 6; ++i) {
      EXPECT_GT(sample.tension_lower_N[i], 0.05);
      EXPECT_LT(sample.tension_upper_N[i], 0.5);
      EXPECT_GT(sample.length_m[i], 0.1);
    }
  }
}

TEST(Check, ComparesWithTheCase) {
  const taut::Case robot = taut::Case::load(kRobot1);
  const Certificate planned = taut::plan(robot);
  taut::CheckOptions options;
  options.the_case = robot;
  EXPECT_EQ(taut::check(planned, options).outcome, taut::Outcome::kAccepted);
  options.the_case = taut::Case::load(kCases + "robot1-slice-qs1-qg.yaml");
  EXPECT_EQ(taut::check(planned, options).outcome, taut::Outcome::kRejected);
  options = {};
  options.trusted_keys_pem = {"no key"};
  EXPECT_THROW(static_cast<void>(taut::check(planned, options)), taut::InputError);
}

TEST(Report, ComesInFourForms) {
  const Certificate planned = taut::plan(taut::Case::load(kRobot1));
  taut::ReportOptions options;
  options.document = "LIFT-1";
  EXPECT_THAT(taut::report(planned, options),
              testing::AllOf(testing::StartsWith("<!DOCTYPE html>"), HasSubstr("LIFT-1")));
  options.format = taut::ReportFormat::kJson;
  EXPECT_THAT(taut::report(planned, options), HasSubstr("\"confirmed\""));
  options.format = taut::ReportFormat::kText;
  const std::string text = taut::report(planned, options);
  options.format = taut::ReportFormat::kMarkdown;
  EXPECT_NE(taut::report(planned, options), text);
  options.date = std::string(10'000, 'x');
  EXPECT_THROW(static_cast<void>(taut::report(planned, options)), taut::InputError);
}

// --- ABI -------------------------------------------------------------------------------------------------------------

// Programs that were built against the library have these sizes in them. Changing one changes the ABI, and with it the
// minor version (docs/library.md). tests/packaging/symbols.txt has the functions.
TEST(Abi, HasTypesOfTheseSizes) {
  EXPECT_STREQ(taut::version(), "0.1.0");
  EXPECT_EQ(sizeof(taut::InputError), 120U);
  EXPECT_EQ(sizeof(taut::Case), 16U);
  EXPECT_EQ(sizeof(taut::Path), 96U);
  EXPECT_EQ(sizeof(taut::TimeLaw), 32U);
  EXPECT_EQ(sizeof(taut::Waypoint), 48U);
  EXPECT_EQ(sizeof(taut::Table), 48U);
  EXPECT_EQ(sizeof(taut::Witness), 224U);
  EXPECT_EQ(sizeof(taut::Stretch), 568U);
  EXPECT_EQ(sizeof(taut::Sample), 232U);
  EXPECT_EQ(sizeof(taut::MovePlan), 288U);
  EXPECT_EQ(sizeof(taut::Certificate), 16U);
  EXPECT_EQ(sizeof(taut::Theorem), 16U);
  EXPECT_EQ(sizeof(taut::Progress), 24U);
  EXPECT_EQ(sizeof(taut::PlanOptions), 192U);
  EXPECT_EQ(sizeof(taut::ProveOptions), 56U);
  EXPECT_EQ(sizeof(taut::AuditOptions), 144U);
  EXPECT_EQ(sizeof(taut::SensitivityOptions), 56U);
  EXPECT_EQ(sizeof(taut::CheckResult), 144U);
  EXPECT_EQ(sizeof(taut::CheckOptions), 72U);
  EXPECT_EQ(sizeof(taut::ReportOptions), 120U);
}

// --- Stopping, threads, rounding modes -------------------------------------------------------------------------------

TEST(Stop, EndsEverythingSoon) {
  const taut::Case robot = taut::Case::load(kRobot1);
  std::stop_source stop;
  stop.request_stop();
  taut::PlanOptions plan_options;
  plan_options.stop = stop.get_token();
  const Certificate planned = taut::plan(robot, plan_options);
  EXPECT_EQ(planned.verdict(), Verdict::kUndecided);
  EXPECT_EQ(planned.reason(), "interrupted");
  EXPECT_EQ(planned.reason_code(), "U11");
  const Certificate whole = taut::plan(robot);
  taut::ProveOptions prove_options;
  prove_options.stop = stop.get_token();
  EXPECT_THROW(static_cast<void>(taut::prove(robot, whole.path(), prove_options)), taut::Interrupted);
  taut::CheckOptions check_options;
  check_options.stop = stop.get_token();
  EXPECT_THROW(static_cast<void>(taut::check(whole, check_options)), taut::Interrupted);
  taut::ReportOptions report_options;
  report_options.stop = stop.get_token();
  EXPECT_THROW(static_cast<void>(taut::report(whole, report_options)), taut::Interrupted);
  taut::SensitivityOptions sensitivity_options;
  sensitivity_options.stop = stop.get_token();
  EXPECT_THROW(static_cast<void>(taut::sensitivity(robot, sensitivity_options)), taut::Interrupted);
}

TEST(Stop, MayComeFromProgress) {
  const taut::Case robot = taut::Case::load(kBridging);
  std::stop_source stop;
  std::atomic<std::size_t> calls = 0;
  taut::AuditOptions options;
  options.stop = stop.get_token();
  options.progress = [&](const taut::Progress& progress) {
    EXPECT_STREQ(progress.stage, "auditing");
    EXPECT_LE(progress.done, progress.total);
    ++calls;
    stop.request_stop();
  };
  EXPECT_THROW(static_cast<void>(taut::audit(robot, options)), taut::Interrupted);
  EXPECT_GE(calls, 1U);
}

struct Oops {};

TEST(Progress, MayThrowAnything) {
  taut::AuditOptions audit_options;
  audit_options.progress = [](const taut::Progress&) { throw Oops(); };
  EXPECT_THROW(static_cast<void>(taut::audit(taut::Case::load(kBridging), audit_options)), Oops);
  taut::PlanOptions plan_options;
  plan_options.progress = audit_options.progress;
  EXPECT_THROW(static_cast<void>(taut::plan(taut::Case::load(kRobot1), plan_options)), Oops);
}

/// What a plan, an audit, a report and a check say.
std::vector<std::string> all_texts() {
  std::vector<std::string> texts;
  taut::ReportOptions report_options;
  report_options.date = "2026-01-01";
  for (const taut::Certificate& certificate :
       {taut::plan(taut::Case::load(kRobot1)), taut::audit(taut::Case::load(kBridging))}) {
    texts.push_back(certificate.text());
    texts.push_back(taut::Certificate::parse(certificate.text()).text());
    texts.push_back(taut::report(certificate, report_options));
    texts.push_back(taut::check(certificate).message);
  }
  return texts;
}

TEST(Locale, WithADecimalCommaChangesNothing) {
  const std::vector<std::string> usual = all_texts();
  const auto folder = std::filesystem::temp_directory_path() / fmt::format("taut-locale-{}", ::getpid());
  std::filesystem::create_directories(folder);
  const std::string made = "localedef -c -i de_DE -f UTF-8 " + (folder / "de_DE.UTF-8").string();
  ASSERT_EQ(std::system(made.c_str()), 0);
  ASSERT_EQ(::setenv("LOCPATH", folder.c_str(), 1), 0);
  ASSERT_NE(std::setlocale(LC_NUMERIC, "de_DE.UTF-8"), nullptr);
  EXPECT_EQ(std::strtod("0,5", nullptr), 0.5);
  EXPECT_EQ(all_texts(), usual);
  std::setlocale(LC_NUMERIC, "C");
  ::unsetenv("LOCPATH");
  std::filesystem::remove_all(folder);
}

/// A caller's floating-point environment.
struct Mode {
  int rounding;
  bool flushes;  ///< subnormals to zero
  bool traps;    ///< where an operation is invalid, divides by zero or overflows
};

TEST(Threads, GiveTheSameInEveryRoundingModeAndKeepIt) {
  const taut::Case robot = taut::Case::load(kRobot1);
  const taut::Case bridging = taut::Case::load(kBridging);
  const std::string planned = taut::plan(robot).text();
  const std::string audited = taut::audit(bridging).text();
  const int kRounds = std::getenv("TAUT_SAMPLED") == nullptr ? 3 : 1;
  std::vector<std::jthread> threads;
  for (const Mode mode : {Mode{FE_UPWARD, false, false}, Mode{FE_DOWNWARD, false, true},
                          Mode{FE_TOWARDZERO, true, false}, Mode{FE_TONEAREST, true, true}}) {
    threads.emplace_back([&, mode] {
      constexpr unsigned kFlushing = 0x8040;
      constexpr int kTraps = FE_INVALID | FE_DIVBYZERO | FE_OVERFLOW;
      std::fesetround(mode.rounding);
      if (mode.flushes) _mm_setcsr(_mm_getcsr() | kFlushing);
      if (mode.traps) feenableexcept(kTraps);
      for (int round = 0; round < kRounds; ++round) {
        const Certificate plan = taut::plan(robot);
        EXPECT_EQ(plan.text(), planned);
        EXPECT_EQ(taut::audit(bridging).text(), audited);
        EXPECT_EQ(taut::prove(robot, plan.path()).verdict(), Verdict::kProved);
        EXPECT_EQ(taut::check(plan).outcome, taut::Outcome::kAccepted);
        EXPECT_THROW(static_cast<void>(taut::Case::parse("no case")), taut::InputError);
        EXPECT_EQ(std::fegetround(), mode.rounding);
        EXPECT_EQ((_mm_getcsr() & kFlushing) != 0, mode.flushes);
        EXPECT_EQ(fegetexcept(), mode.traps ? kTraps : 0);
      }
    });
  }
}

TEST(Threads, OfTheCallersArenaRoundAsTheyDo) {
  // Its tubes are made in floating point, by the threads that prove.
  const taut::Case lengths = taut::Case::load(kCases + "audits/robot1-cable-lengths.yaml");
  const std::string audited = taut::audit(lengths).text();
  std::thread([&] {
    std::fesetround(FE_UPWARD);
    tbb::task_arena arena;
    arena.execute([&] { EXPECT_EQ(taut::audit(lengths).text(), audited); });
    EXPECT_EQ(std::fegetround(), FE_UPWARD);
  }).join();
}

}  // namespace
