// SPDX-License-Identifier: GPL-3.0-or-later
#include "app/tolerance_table.h"

#include <gtest/gtest.h>

namespace taut {
namespace {

TEST(ToleranceTable, IsForPeopleInMillimetresAndDegrees) {
  EXPECT_EQ(tolerance_table({}), "");
  EXPECT_EQ(tolerance_table({{ToleranceKind::kBaseAnchors, 0.002, 0.0569999},
                             {ToleranceKind::kOrientation, 0.0034906585, 0.0199999},
                             {ToleranceKind::kLoad, 49.05, 5249.9}}),
            "Tolerances, and how far each could grow alone with the path still proved:\n"
            "  base_anchors               2  up to     56.9 mm\n"
            "  orientation              0.2  up to     1.14 deg\n"
            "  load                   49.05  up to 5.24e+03 N, N m\n");
}

TEST(ToleranceTable, IsInTheUnitsOfTheCase) {
  const DisplayUnits metres(CaseUnits{});
  EXPECT_EQ(tolerance_table({{ToleranceKind::kBaseAnchors, 0.002, 0.0569999}, {ToleranceKind::kOrientation, 0.1, 0.25}},
                            metres),
            "Tolerances, and how far each could grow alone with the path still proved:\n"
            "  base_anchors           0.002  up to   0.0569 m\n"
            "  orientation              0.1  up to    0.249 rad\n");
}

TEST(ToleranceTable, NothingAboveWhatIsProvedIsShown) {
  // Just below 1 mm.
  EXPECT_NE(tolerance_table({{ToleranceKind::kPosition, 0, 0.0009999999999999998}}).find("up to    0.999 mm"),
            std::string::npos);
  // Just below 1 degree.
  EXPECT_NE(tolerance_table({{ToleranceKind::kOrientation, 0, 0.017453292519943295}}).find("up to    0.999 deg"),
            std::string::npos);
}

TEST(ToleranceTable, IsForMachinesInSi) {
  const nlohmann::json list = to_json({{ToleranceKind::kOrientation, 0.25, 0.0199999}});
  EXPECT_EQ(list.dump(), R"([{"proved":"0.0199","stated":"0.25","tolerance":"orientation","unit":"rad"}])");
}

}  // namespace
}  // namespace taut
