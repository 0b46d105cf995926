// SPDX-License-Identifier: GPL-3.0-or-later
// Moves in time through the library: as the command plans them, as callers prove them, and their tables.
#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <taut/taut.h>
#include <unistd.h>

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <limits>
#include <sstream>
#include <tuple>

namespace {

using taut::Certificate;
using taut::Verdict;
using testing::HasSubstr;

constexpr double kMass = 20'000, kGravity = 9.81;  // of the crane's load [kg, m/s²]

/// A crane whose load moves 8 m and rises by 1 m without turning.
std::string crane_text(const std::string& limits) {
  return R"(taut: 1
name: crane
units: {length: m, force: kN, moment: kN*m, mass: t, angle: deg, time: s}
robot:
  base_anchors: [[15, 10, 15], [15, 10, 15], [-15, 10, 15], [-15, 10, 15], [0, -10, 15], [0, -10, 15]]
  platform_anchors: [[0, 1.5, 0], [1.3, -0.75, 0], [0, 1.5, 0], [-1.3, -0.75, 0], [1.3, -0.75, 0], [-1.3, -0.75, 0]]
  tension: [2, 160]
  length: [3, 35]
load:
  gravity: [0, 0, -9.81 m/s^2]
  items:
    - {name: platform, mass: 8, at: [0, 0, 0]}
    - {name: payload, mass: 12, at: [0, 0, -1.2]}
    - {name: wind, force: 6, direction: horizontal, at: [0, 0, -1]}
space:
  slice: {px: [-8, 8], py: 0, pz: [3, 10], phi: 0, theta: 0, sigma: 0}
query:
  waypoints:
    - {px: -4, pz: 6}
    - {px: 4, pz: 7}
planner: {strategy: greedy, smooth: spline}
)" + limits;
}

taut::Case crane(const std::string& limits) { return taut::Case::parse(crane_text(limits), "crane.yaml"); }

const char* const kLimits = R"(time:
  winches: {speed: 1 m/s, acceleration: 0.5 m/s^2, power: 60 kW}
  load: {speed: 0.8 m/s, acceleration: 0.2 m/s^2}
  jerk: 1 m/s^3
  rate: 20 Hz
)";
const char* const kWinchSpeed = "time: {winches: {speed: [2, 2, 2, 0.4 m/s, 2, 2]}}\n";
const char* const kLoadSpeed = "time: {load: {speed: 0.8 m/s}}\n";

/// The plan of kLimits, made once.
const Certificate& planned() {
  static const Certificate certificate = taut::plan(crane(kLimits));
  return certificate;
}

std::string content_of(const std::filesystem::path& path) {
  std::ifstream file(path, std::ios::binary);
  std::ostringstream text;
  text << file.rdbuf();
  return text.str();
}

/// The last line of a table in text.
std::string last_line(const std::string& text) { return text.substr(text.rfind('\n', text.size() - 2) + 1); }

double at(const taut::Table& table, std::size_t row, std::size_t column) {
  return table.values.at(row * table.columns.size() + column);
}
std::size_t rows(const taut::Table& table) { return table.values.size() / table.columns.size(); }

template <class Work>
std::string field_of_error(const Work& work) {
  try {
    work();
  } catch (const taut::InputError& error) {
    return error.field();
  }
  return "no error";
}

/// A new folder with the crane in it.
class Folder {
 public:
  explicit Folder(const std::string& limits) {
    std::filesystem::create_directory(path_);
    std::ofstream(file("crane.yaml")) << crane_text(limits);
  }
  ~Folder() { std::filesystem::remove_all(path_); }
  Folder(const Folder&) = delete;
  Folder& operator=(const Folder&) = delete;

  [[nodiscard]] std::string file(const std::string& name) const { return (path_ / name).string(); }
  /// @returns the exit code of taut, which writes into `out`
  [[nodiscard]] int run(const std::string& command) const {
    const int status = std::system(
        fmt::format("{} {} --no-report --out {} >/dev/null 2>&1", TAUT_PROGRAM, command, file("out")).c_str());
    return WEXITSTATUS(status);
  }

 private:
  std::filesystem::path path_ = std::filesystem::temp_directory_path() / fmt::format("taut-moves-{}", ::getpid());
};

TEST(MoveInTime, IsThatOfTheCommandWithItsTables) {
  const Folder folder(kLimits);
  EXPECT_EQ(folder.run("plan " + folder.file("crane.yaml")), 0);
  ASSERT_EQ(planned().verdict(), Verdict::kProved) << planned().reason();
  EXPECT_EQ(planned().text(), content_of(folder.file("out/certificate.json")));
  EXPECT_EQ(planned().winches_csv(20), content_of(folder.file("out/winches.csv")));
  EXPECT_EQ(planned().poses_csv(20), content_of(folder.file("out/poses.csv")));
  EXPECT_EQ(planned().poses_tum(20), content_of(folder.file("out/poses.tum")));
}

TEST(MoveInTime, HasALawAndSaysHowLongItTakes) {
  const taut::Path path = planned().path();
  ASSERT_TRUE(path.timing && planned().duration_s());
  EXPECT_EQ(path.timing->duration_s(), *planned().duration_s());
  const double length = std::hypot(8, 1);
  EXPECT_GT(*planned().duration_s(), length / 0.8 + 0.8 / 0.2);  // at full speed, and 4 s to speed up and slow down
  EXPECT_LT(*planned().duration_s(), 1.3 * (length / 0.8 + 0.8 / 0.2));
  EXPECT_EQ(planned().theorem()->margins()->wrench_scale, 1);
  EXPECT_THAT(planned().theorem()->claim(), HasSubstr("move"));
  const taut::MovePlan plan = planned().move_plan().value();
  EXPECT_EQ(plan.speed_share, 1);
  EXPECT_EQ(plan.planned_s, *planned().duration_s());
  EXPECT_LT(plan.fastest_s.value(), plan.planned_s);
  EXPECT_GE(plan.tries, 1U);
  EXPECT_FALSE(plan.refuted_share || plan.witness);

  const Certificate loaded = Certificate::parse(planned().text());
  EXPECT_EQ(loaded.duration_s(), planned().duration_s());
  EXPECT_FALSE(loaded.move_plan());
  taut::CheckOptions options;
  options.the_case = crane(kLimits);
  EXPECT_EQ(taut::check(loaded, options).outcome, taut::Outcome::kAccepted);
  options.the_case = crane(kLoadSpeed);
  EXPECT_EQ(taut::check(loaded, options).outcome, taut::Outcome::kRejected);
}

TEST(MoveInTime, IsProvedBitForBit) {
  const taut::Path path = planned().path();
  const Certificate proved = taut::prove(crane(kLimits), path);
  ASSERT_EQ(proved.verdict(), Verdict::kProved) << proved.reason();
  ASSERT_TRUE(proved.path().timing);
  EXPECT_EQ(proved.path().timing->step_s, path.timing->step_s);
  EXPECT_EQ(proved.path().timing->controls, path.timing->controls);
  EXPECT_EQ(proved.theorem()->margins()->tension_N, planned().theorem()->margins()->tension_N);
  EXPECT_FALSE(proved.move_plan());

  taut::Path slowly = path;
  slowly.timing.reset();
  const Certificate at_rest = taut::prove(crane(kLimits), slowly);
  EXPECT_EQ(at_rest.verdict(), Verdict::kProved) << at_rest.reason();
  EXPECT_FALSE(at_rest.duration_s() || at_rest.path().timing);
  EXPECT_GT(at_rest.theorem()->margins()->wrench_scale, 1);
  EXPECT_THROW((void)at_rest.winches(), taut::InputError);
}

TEST(MoveInTime, ThatIsTooFastIsRefutedWithItsRate) {
  taut::Path fast = planned().path();
  fast.timing->step_s /= 2;
  const Certificate load = taut::prove(crane(kLoadSpeed), fast);
  ASSERT_EQ(load.verdict(), Verdict::kRefuted) << load.reason();
  const taut::Witness of_load = load.theorem()->witness().value();
  EXPECT_EQ(of_load.kind, "load_speed");
  EXPECT_EQ(of_load.cable, 0);
  EXPECT_EQ(of_load.limit, 0.8);
  EXPECT_GE(of_load.value_lower, 0.8);
  EXPECT_LT(of_load.value_upper, 2.0);
  EXPECT_LE(of_load.value_lower, of_load.value_upper);

  const Certificate winch = taut::prove(crane(kWinchSpeed), fast);
  ASSERT_EQ(winch.verdict(), Verdict::kRefuted) << winch.reason();
  const taut::Witness of_winch = winch.theorem()->witness().value();
  EXPECT_EQ(of_winch.kind, "winch_speed");
  EXPECT_EQ(of_winch.cable, 4);
  EXPECT_EQ(of_winch.limit, 0.4);
  EXPECT_GE(of_winch.value_lower, 0.4);
  EXPECT_LT(of_winch.value_upper, 2.0);
}

TEST(MoveInTime, IsRunAtAShareOrAsFastAsIsProved) {
  taut::PlanOptions options;
  options.speed_share = 0.5;
  std::size_t most_tries = 0;
  options.progress = [&](const taut::Progress& at) {
    if (std::string(at.stage) == "proving the move") most_tries = std::max(most_tries, at.done);
  };
  const Certificate slow = taut::plan(crane(kLimits), options);
  ASSERT_EQ(slow.verdict(), Verdict::kProved) << slow.reason();
  EXPECT_NEAR(slow.duration_s().value(), 2 * planned().duration_s().value(), 1e-3);
  EXPECT_NEAR(slow.move_plan()->speed_share, 0.5, 1e-4);
  EXPECT_EQ(slow.move_plan()->planned_s, *planned().duration_s());
  EXPECT_EQ(most_tries, slow.move_plan()->tries);

  options = {};
  options.greatest_speed = true;
  const Certificate fast = taut::plan(crane(kLimits), options);
  ASSERT_EQ(fast.verdict(), Verdict::kProved) << fast.reason();
  const taut::MovePlan plan = fast.move_plan().value();
  EXPECT_GE(plan.speed_share, 1);
  ASSERT_TRUE(plan.refuted_share && plan.witness);
  EXPECT_GT(*plan.refuted_share, plan.speed_share);
  EXPECT_LT(*plan.refuted_share, 1.02 * plan.speed_share);
  EXPECT_GE(plan.witness->value_lower, plan.witness->limit);
}

TEST(MoveInTime, IsAuditedFromItsOwnPoses) {
  const taut::Table poses = planned().poses(50);
  taut::AuditOptions options;
  options.timed = true;
  options.rounding = taut::Rounding{1e-5, 1e-5};
  const Certificate audited = taut::audit(crane(kLimits), poses, options);
  ASSERT_EQ(audited.verdict(), Verdict::kProved) << audited.reason();
  EXPECT_NEAR(audited.duration_s().value(), planned().duration_s().value(), 1e-9);
  EXPECT_TRUE(audited.stretches().empty());
  EXPECT_EQ(audited.path().interpolation, taut::Interpolation::kSpline);
  EXPECT_EQ(audited.path().timing->controls.size(), audited.path().waypoints.size());

  taut::Table fast = poses;
  for (std::size_t i = 0; i < fast.values.size(); i += fast.columns.size()) fast.values[i] /= 2;
  const Certificate refuted = taut::audit(crane(kLoadSpeed), fast, options);
  ASSERT_EQ(refuted.verdict(), Verdict::kRefuted) << refuted.reason();
  EXPECT_EQ(refuted.theorem()->witness()->kind, "load_speed");

  const auto field_of = [&](taut::AuditOptions wrong, const char* limits = kLimits) -> std::string {
    try {
      (void)taut::audit(crane(limits), poses, wrong);
    } catch (const taut::InputError& error) {
      return error.field().empty() ? error.what() : error.field();
    }
    return "no error";
  };
  taut::AuditOptions wrong = options;
  wrong.rounding = taut::Rounding{1e-5, 0};
  EXPECT_EQ(field_of(wrong), "rounding.angle_rad");
  wrong.rounding = taut::Rounding{std::numeric_limits<double>::quiet_NaN(), 1e-5};
  EXPECT_EQ(field_of(wrong), "rounding.position_m");
  wrong.rounding.reset();
  EXPECT_THAT(field_of(wrong), HasSubstr("no rounding"));
  wrong = options;
  wrong.timed = false;
  EXPECT_EQ(field_of(wrong), "rounding");
  EXPECT_THAT(field_of(options, ""), HasSubstr("without the key 'time'"));
}

TEST(MoveInTime, MayRunStraightFromRowToRow) {
  std::string text = crane_text(std::string(kLimits) + "  between_rows: straight\n");
  const std::string wind = "    - {name: wind, force: 6";
  text.replace(text.find(wind), wind.size(),
               "    - {name: drives, acceleration: 0.05 m/s^2}\n    - {name: wind, force: 3");
  const taut::Case stated = taut::Case::parse(text, "crane.yaml");
  EXPECT_THAT(stated.time_statement(), HasSubstr("at least 20 a second, and be up to 0.157 mm off by that;"));
  const Certificate certificate = taut::plan(stated);
  ASSERT_EQ(certificate.verdict(), Verdict::kProved) << certificate.reason();
  EXPECT_THAT(certificate.text(), HasSubstr("\"0.000156251007\""));
  EXPECT_THAT(certificate.text(), HasSubstr("The lengths that are commanded may be those of a table"));
  EXPECT_THAT(certificate.winches_csv(20), HasSubstr("holds for lengths that are so far off"));
  EXPECT_THAT(certificate.winches_csv(10), HasSubstr("How drives join the rows is no part of the certificate"));
}

TEST(MoveInTime, IsAuditedFromItsOwnLengths) {
  const taut::Table winches = planned().winches(50);
  const auto all = static_cast<std::ptrdiff_t>(winches.columns.size());
  constexpr std::ptrdiff_t kKept = 7;  // t[s], l1[m] …
  taut::Table lengths{{winches.columns.begin(), winches.columns.begin() + kKept}, {}};
  for (auto row = winches.values.begin(); row != winches.values.end(); row += all) {
    lengths.values.insert(lengths.values.end(), row, row + kKept);
  }
  taut::AuditOptions options;
  options.timed = true;
  options.rounding = taut::Rounding{0, 0, 2e-5};
  const Certificate audited = taut::audit(crane(kLimits), lengths, options);
  ASSERT_EQ(audited.verdict(), Verdict::kProved) << audited.reason();
  EXPECT_NEAR(audited.duration_s().value(), planned().duration_s().value(), 1e-9);
  EXPECT_EQ(audited.path().interpolation, taut::Interpolation::kSpline);

  const auto field_of = [&](const taut::Rounding& rounding, const taut::Table& table) -> std::string {
    options.rounding = rounding;
    try {
      (void)taut::audit(crane(kLimits), table, options);
    } catch (const taut::InputError& error) {
      return error.field().empty() ? error.what() : error.field();
    }
    return "no error";
  };
  EXPECT_EQ(field_of({1e-5, 0, 1e-5}, lengths), "rounding.position_m");
  EXPECT_EQ(field_of({0, 0, -1}, lengths), "rounding.length_m");
  EXPECT_THAT(field_of({1e-5, 1e-5}, lengths), HasSubstr("got cable lengths and a rounding of poses"));
  EXPECT_THAT(field_of({0, 0, 1e-5}, planned().poses(50)), HasSubstr("got poses and a rounding of cable lengths"));
}

TEST(MoveInTime, SaysWhatIsWrong) {
  const taut::Case at_rest = crane(""), in_time = crane(kLimits);
  const auto field_of_plan = [](const taut::Case& the_case, double share, bool greatest) {
    taut::PlanOptions options;
    options.speed_share = share;
    options.greatest_speed = greatest;
    return field_of_error([&] { (void)taut::plan(the_case, options); });
  };
  const double nan = std::numeric_limits<double>::quiet_NaN();
  EXPECT_EQ(field_of_plan(at_rest, 0.5, false), "speed_share");
  EXPECT_EQ(field_of_plan(at_rest, 1, true), "greatest_speed");
  EXPECT_EQ(field_of_plan(in_time, 0.5, true), "greatest_speed");
  for (const double wrong : {0.0, -1.0, 1.5, nan}) EXPECT_EQ(field_of_plan(in_time, wrong, false), "speed_share");

  const taut::Path good = planned().path();
  const auto field_of_proof = [&](const taut::Case& the_case, const auto& change) {
    taut::Path path = good;
    change(path);
    return field_of_error([&] { (void)taut::prove(the_case, path); });
  };
  EXPECT_EQ(field_of_proof(at_rest, [](taut::Path&) {}), "timing");
  EXPECT_EQ(field_of_proof(in_time, [](taut::Path& path) { path.timing->step_s = 0; }), "timing");
  EXPECT_EQ(field_of_proof(in_time, [&](taut::Path& path) { path.timing->step_s = nan; }), "timing");
  EXPECT_EQ(field_of_proof(in_time, [](taut::Path& path) { path.timing->controls.pop_back(); }), "timing");
  EXPECT_EQ(field_of_proof(in_time, [](taut::Path& path) { path.timing->controls[3] = -1; }), "timing");
  EXPECT_EQ(field_of_proof(in_time, [](taut::Path& path) { path.timing->controls.clear(); }), "timing");

  for (const double wrong : {0.0, -1.0, 10'001.0, nan}) {
    EXPECT_EQ(field_of_error([&] { (void)planned().winches(wrong); }), "rate_Hz");
    EXPECT_EQ(field_of_error([&] { (void)planned().poses_tum(wrong); }), "rate_Hz");
  }
  taut::PlanOptions slow;
  slow.speed_share = 0.01;  // some 1500 s
  EXPECT_EQ(field_of_error([&] { (void)taut::plan(crane(kLimits), slow).poses(1000); }), "rate_Hz");
  const Certificate loaded = Certificate::parse(planned().text());
  for (const auto& table : {&Certificate::winches, &Certificate::poses}) {
    EXPECT_THROW((void)(loaded.*table)(100), taut::InputError);
  }
  EXPECT_THROW((void)loaded.winches_csv(), taut::InputError);
}

TEST(MoveInTime, HasTablesInNumbersAndInText) {
  constexpr double kRate = 20;
  const taut::Table winches = planned().winches(kRate), poses = planned().poses(kRate);
  EXPECT_EQ(winches.columns.size(), 31U);
  EXPECT_EQ(poses.columns, (std::vector<std::string>{"t[s]", "px[m]", "py[m]", "pz[m]", "qx", "qy", "qz", "qw"}));
  ASSERT_EQ(rows(winches), rows(poses));
  const std::size_t last = rows(poses) - 1;
  EXPECT_EQ(at(winches, 1, 0), 1 / kRate);
  EXPECT_EQ(at(poses, last, 0), *planned().duration_s());
  EXPECT_EQ(at(poses, last, 1), 4);
  EXPECT_EQ(at(poses, last, 3), 7);
  for (const auto& [table, text] :
       {std::pair(winches, planned().winches_csv(kRate)), std::pair(poses, planned().poses_csv(kRate))}) {
    EXPECT_THAT(text, HasSubstr(fmt::format("\n{}\n", fmt::join(table.columns, ","))));
    const auto begin = table.values.end() - static_cast<std::ptrdiff_t>(table.columns.size());
    EXPECT_EQ(last_line(text), fmt::format("{}\n", fmt::join(begin, table.values.end(), ",")));
  }
  // What a table says is a path like any other.
  const Certificate audited = taut::audit(crane(kLimits), planned().poses(1));
  EXPECT_EQ(audited.verdict(), Verdict::kProved) << audited.reason();
  EXPECT_FALSE(audited.duration_s());
}

TEST(MoveInTime, TensionsOfSamplesAreWithinThoseOfTheirRows) {
  constexpr double kRate = 50;
  const taut::Table table = planned().winches(kRate);
  ASSERT_EQ(table.columns.size(), 31U);
  EXPECT_EQ(std::pair(table.columns[19], table.columns[30]),
            std::pair(std::string("fmin1[N]"), std::string("fmax6[N]")));
  double widest = 0, tightest = 1e300;
  for (const taut::Sample& sample : planned().samples(3000)) {
    const auto row = std::min(static_cast<std::size_t>(*sample.time_s * kRate), rows(table) - 1);
    for (std::size_t i = 0; i < 6; ++i) {
      const double least = at(table, row, 19 + i), greatest = at(table, row, 25 + i);
      EXPECT_LE(least, sample.tension_lower_N[i] + 1e-6) << *sample.time_s;
      EXPECT_GE(greatest, sample.tension_upper_N[i] - 1e-6) << *sample.time_s;
      const double excess = greatest - least - (sample.tension_upper_N[i] - sample.tension_lower_N[i]);
      widest = std::max(widest, excess);
      tightest = std::min(tightest, excess);
    }
  }
  EXPECT_LT(widest, 3e3) << "of 158 kN between the limits";
  EXPECT_LT(tightest, 500);
}

TEST(MoveInTime, IsAuditedAsTheCommandDoesIt) {
  const Folder folder(kLimits);
  planned().save(folder.file("planned.json"));
  const Certificate audited = taut::audit(taut::Case::load(folder.file("crane.yaml")), folder.file("planned.json"));
  EXPECT_EQ(audited.verdict(), Verdict::kProved) << audited.reason();
  EXPECT_FALSE(audited.duration_s() || audited.path().timing);
  EXPECT_EQ(folder.run(fmt::format("audit {} {}", folder.file("crane.yaml"), folder.file("planned.json"))), 0);
  EXPECT_EQ(audited.text(), content_of(folder.file("out/certificate.json")));
}

TEST(MoveInTime, HasSamplesWithTimesAndInertia) {
  const std::vector<taut::Sample> samples = planned().samples(1000);
  ASSERT_GE(samples.size(), 1000U);
  EXPECT_EQ(samples.front().time_s, 0);
  EXPECT_EQ(samples.back().time_s, planned().duration_s());
  double greatest_power = 0;
  for (std::size_t k = 1; k + 1 < samples.size(); ++k) {
    const auto& [before, now, after] = std::tie(samples[k - 1], samples[k], samples[k + 1]);
    const double h = after.time_s.value() - now.time_s.value();
    ASSERT_GT(h, 0);
    // What the winches do goes into the load's energy: wind, on either side, takes no part in the mean tension.
    double power = 0, kinetic = 0, potential = 0;
    for (std::size_t i = 0; i < 6; ++i) {
      EXPECT_GT(now.tension_lower_N[i], 2000);
      EXPECT_LT(now.tension_upper_N[i], 160'000);
      const double mean = (now.tension_lower_N[i] + now.tension_upper_N[i]) / 2;
      power -= mean * (after.length_m[i] - before.length_m[i]) / (2 * h);
    }
    for (std::size_t j = 0; j < 3; ++j) {
      const double speed = (after.p_m[j] - before.p_m[j]) / (2 * h);
      kinetic += kMass * speed * (after.p_m[j] - 2 * now.p_m[j] + before.p_m[j]) / (h * h);
      if (j == 2) potential = kMass * kGravity * speed;
    }
    EXPECT_NEAR(power, kinetic + potential, 30) << *now.time_s;
    greatest_power = std::max(greatest_power, std::abs(kinetic));
  }
  EXPECT_GT(greatest_power, 1500) << "inertia counts";
  taut::Path slowly = planned().path();
  slowly.timing.reset();
  for (const taut::Sample& sample : taut::prove(crane(""), slowly).samples(10)) EXPECT_FALSE(sample.time_s);
}

TEST(MoveInTime, LimitsAreSaidAgain) {
  EXPECT_THAT(crane(kLimits).time_statement(),
              testing::AllOf(HasSubstr("speed below 1 m/s"), HasSubstr("power below 60 kW"), HasSubstr("0.2 m/s²")));
  EXPECT_THAT(crane(kLimits).summary(), HasSubstr(crane(kLimits).time_statement()));
  EXPECT_EQ(crane("").time_statement(), "");
}

}  // namespace
