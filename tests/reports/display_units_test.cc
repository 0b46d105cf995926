// SPDX-License-Identifier: GPL-3.0-or-later
#include "reports/summary/display_units.h"

#include <gtest/gtest.h>

#include <limits>
#include <nlohmann/json.hpp>

#include "reports/summary/hints.h"

namespace taut {
namespace {

CaseUnits metres_and_kilonewtons() {
  return {.length = *find_unit("m"), .force = *find_unit("kN"), .moment = *find_unit("kN*m")};
}

TEST(DisplayUnits, ShowDecimalsExactly) {
  const DisplayUnits units(metres_and_kilonewtons());
  EXPECT_EQ(units.force.exact("123456.789") + " " + units.force.name(), "123.456789 kN");
  EXPECT_EQ(units.moment.exact("50") + " " + units.moment.name(), "0.05 kN·m");
  EXPECT_EQ(DisplayUnits().length.exact("0.0123") + " " + DisplayUnits().length.name(), "12.3 mm");
}

TEST(DisplayUnits, RoundInTheDirectionThatWasAskedFor) {
  const DisplayUnits units(metres_and_kilonewtons());
  EXPECT_EQ(units.force.down(1234.56), "1.234");
  EXPECT_EQ(units.force.up(1234.51), "1.235");
  EXPECT_EQ(units.force.down(-1234.51), "-1.235");
  EXPECT_EQ(DisplayUnits().length.down(1e300), "1e+303") << "beyond the range of decimals";
}

TEST(DisplayUnits, AreMillimetresWhereTheCaseHasFeet) {
  const DisplayUnits units(CaseUnits{.length = *find_unit("ft")});
  EXPECT_EQ(units.length.name(), "mm");
  EXPECT_EQ(units.length.exact("0.3048"), "304.8");
}

TEST(DisplayUnits, KeepMicrometresInAnyUnit) {
  EXPECT_EQ(DisplayUnits().length.fixed(1.2345678, 6), "1234.568");
  EXPECT_EQ(DisplayUnits(metres_and_kilonewtons()).length.fixed(1.2345678, 6), "1.234568");
}

TEST(DisplayUnits, TurnIntoDegreesOnlyWhereTheCaseDoes) {
  EXPECT_EQ(DisplayUnits(CaseUnits{}).angle(0.5), "0.5 rad");
  EXPECT_EQ(DisplayUnits(CaseUnits{.angle = *find_unit("deg")}).angle(0.5), "28.65 deg");
}

TEST(DisplayUnits, ComeBackFromACertificate) {
  const DisplayUnits back = display_units_from_json(to_json(metres_and_kilonewtons()));
  EXPECT_EQ(back.length.name(), "m");
  EXPECT_EQ(back.force.name(), "kN");
  EXPECT_EQ(back.moment.name(), "kN·m");
}

TEST(DisplayUnits, AreTheUsualOnesWhereACertificateStatesNonsense) {
  for (const char* text : {"null", "[]", "{}", R"({"length": 3, "force": "mm"})", R"({"length": "parsec"})"}) {
    const DisplayUnits units = display_units_from_json(nlohmann::json::parse(text));
    EXPECT_EQ(units.length.name(), "mm") << text;
    EXPECT_EQ(units.force.name(), "N") << text;
  }
}

/// Six cables with limits of 50 N and 4 kN.
struct Cables {
  Cables() {
    model.tension_lower.fill(50);
    model.tension_upper.fill(4000);
    statics.regular = true;
    statics.tension.fill(-900);
    statics.tension_below.fill(90);
    statics.tension_above.fill(90);
  }
  Model<double> model;
  Statics<double> statics;
};

TEST(ReversedLoad, IsSuspectedOnlyWhereEveryCableWouldDo) {
  Cables cables;
  EXPECT_NE(reversed_load_hint(cables.model, cables.statics), "");
  cables.statics.tension[3] = 900;
  EXPECT_EQ(reversed_load_hint(cables.model, cables.statics), "");
  cables.statics.tension[3] = -40;
  EXPECT_EQ(reversed_load_hint(cables.model, cables.statics), "") << "below the lower limit";
  cables.statics.tension[3] = -4001;
  EXPECT_EQ(reversed_load_hint(cables.model, cables.statics), "") << "above the upper limit";
}

TEST(NearlySingular, IsWhereTensionsAreAMillionTimesTheLimits) {
  Cables cables;
  EXPECT_FALSE(is_nearly_singular(cables.model, cables.statics));
  cables.statics.tension[2] = 3.9e9;
  EXPECT_FALSE(is_nearly_singular(cables.model, cables.statics));
  cables.statics.tension_above[2] = 2e8;
  EXPECT_TRUE(is_nearly_singular(cables.model, cables.statics));
  cables.statics.tension[2] = std::numeric_limits<double>::quiet_NaN();
  EXPECT_TRUE(is_nearly_singular(cables.model, cables.statics));
  EXPECT_EQ(reversed_load_hint(cables.model, cables.statics), "");
}

}  // namespace
}  // namespace taut
