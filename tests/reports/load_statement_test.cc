// SPDX-License-Identifier: GPL-3.0-or-later
#include "reports/summary/load_statement.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <nlohmann/json.hpp>

namespace taut {
namespace {

using ::testing::AllOf;
using ::testing::ElementsAre;
using ::testing::HasSubstr;

LoadText example_crane() {
  LoadText load;
  load.point_m = {"0", "0", "0"};
  load.gravity_m_s2 = {"0", "0", "-9.81"};
  load.items = {{"platform", Weight{"8000", "8000", {"0", "0", "0"}, "0"}},
                {"payload", Weight{"11760", "12240", {"0", "0", "-1.2"}, "0.05"}},
                {"wind", Force{DiscOfVectors{"6000", {"0", "0", "-9.81"}}, Axes::kWorld, {"0", "0", "-1"}}}};
  return load;
}

TEST(LoadStatement, SaysTheExampleCranesLoadInTonnesAndKilonewtons) {
  const LoadStatement s = load_statement(example_crane());
  EXPECT_EQ(s.total,
            "In all 19.76 to 20.24 t, nominally with the centre of gravity at (0, 0, -720) mm of the platform: a force "
            "of 196.2 kN along −z and no moment about the load point (0, 0, 0) m.");
  EXPECT_THAT(s.spread, HasSubstr("force x ± 6 kN, y ± 6 kN, z -198.6 to -193.8 kN; moment x "));
  EXPECT_THAT(lines(s), ElementsAre(s.total, s.spread, "platform: 8 t, centre of gravity at (0, 0, 0) m.",
                                    "payload: 11.76 to 12.24 t, centre of gravity within 50 mm of (0, 0, -1.2) m.",
                                    "wind: a force of up to 6 kN in any horizontal direction, at (0, 0, -1) m."));
}

TEST(LoadStatement, EnclosesTheExtremesOfEachComponent) {
  const LoadStatement s = load_statement(example_crane());
  // Horizontally only the wind; vertically the masses; moments from the wind's lever of 1 m and the payload's offset.
  const double offset = 12240 * 9.81 * 0.05;
  const std::array<double, 6> largest = {6000, 6000, -9.81 * 19760, 6000 + offset, 6000 + offset, 0};
  const std::array<double, 6> least = {-6000, -6000, -9.81 * 20240, -6000 - offset, -6000 - offset, 0};
  for (std::size_t k = 0; k < 6; ++k) {
    EXPECT_LE(s.extremes.at(k).lower, least.at(k) + 1e-9) << k;
    EXPECT_GE(s.extremes.at(k).lower, least.at(k) - 1e-9 * std::abs(least.at(k)) - 1e-9) << k;
    EXPECT_GE(s.extremes.at(k).upper, largest.at(k) - 1e-9) << k;
    EXPECT_LE(s.extremes.at(k).upper, largest.at(k) + 1e-9 * std::abs(largest.at(k)) + 1e-9) << k;
  }
  EXPECT_LE(s.mass_kg->lower, 19760);
  EXPECT_GE(s.mass_kg->upper, 20240);
}

TEST(LoadStatement, SaysItemsOfEveryKind) {
  LoadText load = example_crane();
  load.items = {
      {"any", Force{BallOfVectors{"100"}, Axes::kWorld, {"0", "0", "0.2"}}},
      {"tool", Force{SegmentOfVectors{{"2", "0", "0"}, "-1000", "1000"}, Axes::kPlatform, {"0", "0", "-2"}}},
      {"slew", Moment{SegmentOfVectors{{"0", "0", "-1"}, "0", "2000"}, Axes::kWorld}},
      {"twist", Moment{DiscOfVectors{"5", {"1", "0", "0"}}, Axes::kPlatform}},
      {"cases",
       LoadCases{{{"0", "0", "-5", "0", "0", "0"}, {"1", "0", "-5", "0", "0", "0"}}, Axes::kPlatform, {"0", "0", "0"}}},
      {"third", Weight{"1000/3", "1000/3", {"0", "0", "0"}, "0"}}};
  EXPECT_THAT(
      load_statement(load).items,
      ElementsAre(
          std::pair("any", "a force of up to 100 N in any direction, at (0, 0, 200) mm"),
          std::pair("tool", "a force of ± 1 kN along x of the platform, at (0, 0, -2) m"),
          std::pair("slew", "a moment of 0 to 2 kN·m along −z"),
          std::pair("twist",
                    "a moment of up to 5 N·m in any direction at right angles to the one along x of the "
                    "platform"),
          std::pair("cases", "2 load cases about (0, 0, 0) m, and all between them, in the axes of the platform"),
          std::pair("third", "333.3 to 333.4 kg, centre of gravity at (0, 0, 0) m")));
}

TEST(LoadStatement, SaysThatAnEllipsoidTakesFromOneComponentWhatItGivesAnother) {
  LoadText load;
  load.point_m = {"0.03", "0.014", "-0.021"};
  load.wrench = {"0", "0", "1", "0", "0", "0"};
  EllipsoidText& e = load.ellipsoid.emplace();
  for (auto& row : e) row.fill("0");
  for (std::size_t i = 0; i < 6; ++i) e[i][i] = i < 3 ? "10000" : "1000000";
  const std::string text = load_text(load);
  EXPECT_THAT(text,
              AllOf(HasSubstr("Nominally a force of 1 N along +z and no moment about the load point (30, 14, -21) mm"),
                    HasSubstr("the weight of 102 g under standard gravity"),
                    HasSubstr("z 0.99 to 1.01 N; moment x ± 0.001 N·m"),
                    HasSubstr("each component of the force by up to 0.01 N"),
                    HasSubstr("each alone up to this, together only inside the ellipsoid with these semi-axes")));
  // 1/36 is no decimal; with it the semi-axis is 6 N.
  e[0][0] = "1/36";
  EXPECT_NEAR(load_statement(load).extremes[0].upper, 6, 1e-12);
  EXPECT_GE(load_statement(load).extremes[0].upper, 6);
}

TEST(LoadStatement, HasNumbersForMachines) {
  const nlohmann::json json = to_json(load_statement(example_crane()));
  EXPECT_EQ(json["mass_kg"], (nlohmann::json{19760.0, 20240.0}));
  EXPECT_EQ(json["items"][2]["name"], "wind");
  EXPECT_EQ(json["extreme_wrenches"].size(), 6U);
  EXPECT_EQ(json["text"].size(), 5U);
}

}  // namespace
}  // namespace taut
