// SPDX-License-Identifier: GPL-3.0-or-later
#include "reports/summary/lift_plan.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <nlohmann/json.hpp>
#include <set>

#include "reports/page/assurance_drawing.h"
#include "reports/summary/summary.h"
#include "tests/reports/sample_certificates.h"

namespace taut {
namespace {

using ::testing::HasSubstr;
using ::testing::Not;

std::vector<LiftPlanItem> plan_of(const ReportContext& scene) { return lift_plan(scene, Summary(scene, {})); }

LiftPlanItem item(const std::vector<LiftPlanItem>& items, std::string_view key) {
  const auto found = std::ranges::find(items, key, &LiftPlanItem::key);
  EXPECT_NE(found, items.end()) << key;
  return found == items.end() ? LiftPlanItem{} : *found;
}

TEST(LiftPlan, FillsWhatIsProvedAndSaysWhatIsOpen) {
  const std::vector<LiftPlanItem> items = plan_of(sample::scene(sample::proved()));
  std::set<std::string> keys;
  for (const LiftPlanItem& item : items) {
    EXPECT_TRUE(keys.insert(item.key).second) << item.key;
    EXPECT_FALSE(item.open.empty()) << item.key << ": taut fills in no topic by itself";
  }
  for (const char* group :
       {"The load", "Load handling equipment", "Rigging", "Movement of equipment and load",
        "Personnel and communication", "Site, ground and weather", "Contingencies and emergencies"}) {
    EXPECT_TRUE(std::ranges::any_of(items, [&](const LiftPlanItem& item) { return item.group == std::string(group); }));
  }
  EXPECT_THAT(item(items, "load_weight").filled, HasSubstr("1 N"));
  EXPECT_THAT(item(items, "load_indicator").filled, HasSubstr("no cable's tension exceeds 0.338 N"));
  EXPECT_THAT(item(items, "clearances").open, HasSubstr("Collisions are not examined"));
  EXPECT_TRUE(item(items, "rigging").filled.empty());
}

TEST(LiftPlan, ShowsTextOfTheCaseAsSuch) {
  nlohmann::json certificate = sample::proved();
  certificate["illustration"]["document_fields"] = {
      {"machine", "Portal <2>"}, {"site", "Hall B"}, {"load_name", "container"}, {"prepared_by", "A. Niemi"}};
  const ReportContext scene = sample::scene(certificate);
  const std::vector<LiftPlanItem> items = plan_of(scene);
  EXPECT_THAT(item(items, "equipment").filled, HasSubstr("“Portal <2>”, as the case says"));
  EXPECT_THAT(item(items, "site").filled, HasSubstr("“Hall B”, as the case says"));
  EXPECT_THAT(item(items, "load_description").filled, HasSubstr("“container”, as the case says"));
  EXPECT_THAT(item(items, "personnel").filled, HasSubstr("“A. Niemi”, as the case says"));
  const std::string section = lift_plan_section(scene, Summary(scene, {})).str();
  EXPECT_THAT(section, HasSubstr("Portal &lt;2&gt;"));
  EXPECT_THAT(section, HasSubstr("Only the topics are named here"));
}

TEST(LiftPlan, FillsNoBoundsWhereNothingIsProved) {
  const ReportContext unchecked = sample::unchecked(sample::proved());
  for (const std::vector<LiftPlanItem>& items :
       {plan_of(sample::scene(sample::refuted())), plan_of(sample::scene(sample::singular())),
        plan_of(sample::scene(sample::undecided())), plan_of(sample::scene(sample::no_path())), plan_of(unchecked)}) {
    for (const LiftPlanItem& item : items) {
      EXPECT_THAT(item.filled, Not(HasSubstr("exceeds"))) << item.key;
      EXPECT_THAT(item.filled, Not(HasSubstr("Highest tension"))) << item.key;
      EXPECT_THAT(item.filled, Not(HasSubstr("grow"))) << item.key;
    }
    EXPECT_THAT(item(items, "capacity").open, HasSubstr("this report proves none"));
  }
  EXPECT_TRUE(item(plan_of(sample::scene(sample::no_path())), "travel_path").filled.empty());
}

}  // namespace
}  // namespace taut
