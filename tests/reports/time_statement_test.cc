// SPDX-License-Identifier: GPL-3.0-or-later
#include "reports/summary/time_statement.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <nlohmann/json.hpp>

#include "problem/rows.h"
#include "reports/page/html_report.h"
#include "reports/page/report_data.h"
#include "reports/summary/broken_limits.h"
#include "reports/summary/summary.h"
#include "tests/reports/sample_certificates.h"

namespace taut {
namespace {

using ::testing::AllOf;
using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::Not;
using ::testing::StartsWith;

std::string statement(const Summary& s, std::string_view key) {
  return std::ranges::find(s.statements, key, &Statement::key)->text;
}

TEST(TimeStatement, SaysLimitsInPeoplesUnits) {
  TimeText time;
  time.winch_speed_m_s.fill("1");
  time.winch_speed_m_s[2] = "0.5";
  time.winch_acceleration_m_s2.fill("0.5");
  time.winch_power_W = {"60000", "60000", "60000", "60000", "60000", "60000"};
  time.load_speed_m_s = "25/18";
  time.load_angular_speed_rad_s = "(5)*pi/180";
  time.load_angular_acceleration_rad_s2 = "0.1";
  EXPECT_EQ(time_limits_text(time, DisplayUnits(CaseUnits{})),
            "In time: winches: speed below 1 m/s (cables 1, 2, 4, 5, 6), 0.5 m/s (cable 3), acceleration below 0.5 "
            "m/s², power below 60 kW; the load point: speed below 25/18 m/s; the platform: angular speed below 5°/s, "
            "angular acceleration below 0.1 rad/s².");
  EXPECT_THAT(time_limits_text(time, DisplayUnits()), HasSubstr("acceleration below 500 mm/s²"));
  time.rows = rows_between(time, Rational(1, 100), {0, 0, 0, Rational(1, 1000), 0, 0});
  EXPECT_THAT(
      time_limits_text(time, DisplayUnits(CaseUnits{})),
      HasSubstr(" Drives may run lengths straight between the rows of a table, at least 100 a second, and be up "
                "to 1.01 mm off by that; limits in time are those of the move itself."));
}

TEST(TimeStatement, NamesBoxesAndPointMasses) {
  EXPECT_EQ(inertia_text(sample::timed().problem.load),
            "Inertia counts of all weights, with all masses and centres of gravity that they may have: 'payload' as an "
            "evenly filled box of 0.05 × 0.05 × 0.04 m; 'probe' as a point mass.");
}

TEST(TimeStatement, SaysMomentsOfInertiaOfBoxesThatWereMadeOfThem) {
  LoadText load;
  load.items = {{"payload", Weight{"11", "13", {"0", "0", "0"}, "0", RationalVector{"1.4142135623731", "2", "1/2"}}}};
  EXPECT_THAT(inertia_text(load),
              HasSubstr("'payload' as an evenly filled box of 1.41421 × 2 × 0.5 m (moments of inertia "
                        "4.25, 2.25 and 6 kg·m²)."));
}

TEST(TimeStatement, StandsOnTheFirstPageOfAMoveOnly) {
  const ReportContext scene = sample::scene(sample::timed());
  const Summary s(scene, {});
  EXPECT_THAT(s.move, HasSubstr(" in T = 5 s; it rests at every waypoint."));
  EXPECT_THAT(s.headline, StartsWith("At every time of this move, with the inertia of the load, for every load"));
  EXPECT_THAT(s.headline, HasSubstr("no limit of speed, acceleration or power that is stated is reached"));
  EXPECT_THAT(statement(s, "limits"), HasSubstr("In time: winches: speed below 100 mm/s, power below 2 W (cable 3)"));
  EXPECT_THAT(statement(s, "load"), HasSubstr("'probe' as a point mass"));
  EXPECT_THAT(statement(s, "assumptions"), AllOf(Not(HasSubstr("slow")), HasSubstr("The drives follow the move")));
  EXPECT_THAT(statement(s, "not_covered"),
              AllOf(HasSubstr("jerk, which is planned and not proved"), HasSubstr("between the rows of a table"),
                    HasSubstr("Of winches also their acceleration and power")));

  Certificate certificate = sample::timed();
  certificate.path.timing.reset();  // at rest: a refuted or undecided one
  const Summary at_rest(sample::scene(certificate), {});
  EXPECT_THAT(statement(at_rest, "limits"), Not(HasSubstr("In time")));
  EXPECT_THAT(statement(at_rest, "load"), Not(HasSubstr("Inertia")));
  EXPECT_THAT(statement(at_rest, "assumptions"), HasSubstr("The platform is at rest"));
}

TEST(TimeStatement, ClaimsNoGrowthOfAMove) {
  const ReportContext scene = sample::scene(sample::timed());
  const Summary s(scene, {});
  std::vector<std::string> keys;
  for (const KeyNumber& number : s.key_numbers) keys.emplace_back(number.key);
  EXPECT_THAT(keys, ElementsAre("slack", "top", "length", "duration", "winch_speed", "winch_power", "load_acceleration",
                                "load_angular_speed"));
  EXPECT_EQ(s.key_numbers[3].value, "T = 5 s");
  for (const std::string& text : {to_text(s), to_markdown(s), to_json(s).dump()}) {
    EXPECT_THAT(text, Not(HasSubstr("grow")));
    EXPECT_THAT(text, Not(HasSubstr("wrench_scale")));
  }
  const std::string page = html_report(scene);
  const std::string words = page.substr(0, page.find("<script"));
  EXPECT_THAT(words, Not(HasSubstr("could grow")));
  EXPECT_THAT(words, Not(HasSubstr("may grow")));
  EXPECT_THAT(words, Not(HasSubstr("wrench_scale")));
  EXPECT_THAT(words, HasSubstr("Winches during the move"));
  EXPECT_THAT(words, HasSubstr("its drives follow this move in time"));
  EXPECT_THAT(words, HasSubstr("w − w<sub>in</sub>(t)"));
}

TEST(TimeStatement, SaysHowMuchOfALimitSamplesUse) {
  const ReportContext scene = sample::scene(sample::timed());
  const std::vector<RateUse> uses = rate_uses(scene);
  ASSERT_EQ(uses.size(), 4u);
  double fastest = 0;
  for (const PathSample& at : scene.samples) {
    for (std::size_t i = 0; i < kCables; ++i) fastest = std::max(fastest, std::abs(at.in_time->winches.speed[i]));
  }
  EXPECT_EQ(uses[0].size, fastest);
  EXPECT_GT(fastest, 0);
  const KeyNumber number = Summary(scene, {}).key_numbers[4];
  EXPECT_EQ(number.title, "Fastest winch");
  EXPECT_THAT(number.value, StartsWith("cable "));
  EXPECT_THAT(number.detail, AllOf(HasSubstr(" % of 100 mm/s at t = "), HasSubstr("that the limit is kept is proved")));
  EXPECT_EQ(number.nearness, Nearness::kCalm);
  EXPECT_FALSE(number.is_proved);
}

TEST(TimeStatement, ShowsSampledRatesBeyondTheirLimits) {
  Certificate fast = sample::timed(1.0 / 128);
  fast.verdict = Verdict::kUndecided;
  fast.segments.clear();
  fast.margins.reset();
  fast.undecided = OpenPart{"a rate may reach its limit", 1, {}};
  const ReportContext scene = sample::scene(fast);
  const Summary s(scene, {});
  const auto speed = std::ranges::find(s.key_numbers, std::string_view("winch_speed"), &KeyNumber::key);
  ASSERT_NE(speed, s.key_numbers.end());
  EXPECT_EQ(speed->nearness, Nearness::kOut);
  EXPECT_THAT(speed->detail, HasSubstr("sampled, not proved"));
  const std::vector<BrokenLimit> broken = broken_limits(scene);
  const auto rate = std::ranges::find_if(broken, [](const BrokenLimit& b) { return b.rate.has_value(); });
  ASSERT_NE(rate, broken.end());
  EXPECT_FALSE(rate->is_proved());
  EXPECT_FALSE(rate->is_of_cable());
  EXPECT_THAT(amount_text(scene, *rate), StartsWith("about "));
}

TEST(TimeStatement, SaysWhatIsTooFastAndWhen) {
  const ReportContext scene = sample::scene(sample::too_fast());
  EXPECT_EQ(headline(scene),
            "Refuted: on this move cable 3 would be wound at 123000 mm/s or more; its limit is 100 mm/s, 3.75 s after "
            "the start (segment 1, s = 0.5).");
  const std::vector<BrokenLimit> broken = broken_limits(scene);
  ASSERT_FALSE(broken.empty());
  EXPECT_EQ(subject_text(scene, broken[0]), "Cable 3");
  EXPECT_EQ(what_text(broken[0]), "wound too fast");
  EXPECT_EQ(amount_text(scene, broken[0]), "at least 123000 mm/s; limit 100 mm/s");
  EXPECT_THAT(verdict_details(scene)[0], HasSubstr("It is beyond the limit by at least 120000 % of it."));
  const nlohmann::json data = report_data(scene);
  EXPECT_EQ(data["witness"]["kind"], "winch_speed");
  EXPECT_EQ(data["witness"]["cable"], 3);
  EXPECT_THAT(html_report(scene), HasSubstr("wound at 123000 mm/s or more"));
}

TEST(TimeStatement, SaysEveryKindOfRate) {
  const auto said = [](RateId id) {
    const Certificate certificate = sample::too_fast(id);
    return violation_text(certificate.witness->violation, certificate.problem, DisplayUnits());
  };
  EXPECT_EQ(said({RateKind::kWinchPower, 2}),
            "the winch of cable 3 would need a power of 123 W or more; its limit is 2 W");
  EXPECT_EQ(said({RateKind::kLoadAcceleration}),
            "the load point would accelerate by 123000 mm/s² or more; its limit is 250 mm/s²");
  EXPECT_EQ(said({RateKind::kLoadAngularSpeed}), "the platform would turn at 7070°/s or more; its limit is 30°/s");
}

TEST(TimeStatement, GivesThePageSamplesEquallySpacedInTime) {
  const nlohmann::json data = report_data(sample::scene(sample::timed()));
  const nlohmann::json& time = data["samples"]["time"];
  const std::size_t count = time.size();
  ASSERT_GT(count, 100u);
  EXPECT_EQ(time.front(), 0);
  EXPECT_EQ(time.back(), 5);
  for (std::size_t k = 1; k < count; ++k) {
    EXPECT_NEAR(time[k].get<double>() - time[k - 1].get<double>(), 5.0 / static_cast<double>(count - 1), 2e-6);
  }
  EXPECT_EQ(data["samples"]["position"].back(), 2);
  EXPECT_FALSE(data["margins"].contains("wrench_scale"));
  EXPECT_EQ(data["winches"]["winch_speed"]["limits"], nlohmann::json({0.1, 0.1, 0.1, 0.1, 0.1, 0.1}));
  EXPECT_EQ(data["winches"]["winch_power"]["limits"], nlohmann::json({nullptr, nullptr, 2, nullptr, nullptr, nullptr}));
  EXPECT_EQ(data["winches"]["winch_acceleration"]["values"][5].size(), count);
  EXPECT_TRUE(report_data(sample::scene(sample::proved()))["winches"].is_null());
}

TEST(TimeStatement, EnclosesTensionsWithInertia) {
  const ReportContext scene = sample::scene(sample::timed(1.0 / 32));
  ASSERT_EQ(scene.ranges.missing, 0u);
  double most = 0;
  for (const PathSample& at : scene.samples) {
    const Statics<double> still = statics(scene.sampler.model(), at.pose);
    const auto k = static_cast<std::size_t>(std::min(at.position, 1.0));
    const double s = at.position - static_cast<double>(k);
    for (const BoxRanges& box : scene.ranges.segments[k]) {
      if (s < box.box.lower().approx() || s > box.box.upper().approx()) continue;
      for (std::size_t i = 0; i < kCables; ++i) {
        EXPECT_LE(box.tension[i].lower, at.statics.tension[i] - at.statics.tension_below[i] + 1e-12);
        EXPECT_GE(box.tension[i].upper, at.statics.tension[i] + at.statics.tension_above[i] - 1e-12);
        most = std::max(most, std::abs(at.statics.tension[i] - still.tension[i]));
      }
    }
  }
  EXPECT_GT(most, 1e-4) << "inertia counts";
}

TEST(TimeStatement, FillsTheLiftPlan) {
  const ReportContext scene = sample::scene(sample::timed());
  const Summary s(scene, {});
  const auto item = std::ranges::find(s.lift_plan, std::string_view("dynamics"), &LiftPlanItem::key);
  EXPECT_THAT(item->filled, HasSubstr("The move takes T = 5 s."));
  const Summary refuted(sample::scene(sample::too_fast()), {});
  EXPECT_TRUE(std::ranges::find(refuted.lift_plan, std::string_view("dynamics"), &LiftPlanItem::key)->filled.empty());
}

}  // namespace
}  // namespace taut
