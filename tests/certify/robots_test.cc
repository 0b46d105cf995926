// SPDX-License-Identifier: GPL-3.0-or-later
// Published robots of cases/robots/: their anchors agree with the cable lengths that their own controllers state.
#include <gtest/gtest.h>

#include <array>
#include <fstream>
#include <sstream>
#include <string>
#include <vector>

#include "case/case_file.h"
#include "certify/arithmetic/interval.h"
#include "kinematics/geometry.h"

namespace taut::testing {
namespace {

struct Home {
  std::vector<std::string> pose;     ///< px, py, pz [cm], phi, theta, sigma [deg]
  std::vector<std::string> lengths;  ///< as the controller's file states them [cm]
};

/// The row of cases/robots/ROBOT/home.csv.
Home home_of(const std::string& robot) {
  std::ifstream file(std::string(TAUT_SOURCE_DIR) + "/cases/robots/" + robot + "/home.csv");
  std::string header;
  std::string row;
  std::getline(file, header);
  std::getline(file, row);
  EXPECT_EQ(header, "px[cm],py[cm],pz[cm],phi[deg],theta[deg],sigma[deg],l1[cm],l2[cm],l3[cm],l4[cm],l5[cm],l6[cm]");
  Home home;
  std::istringstream cells(row);
  for (std::string cell; std::getline(cells, cell, ',');) {
    (home.pose.size() < 6 ? home.pose : home.lengths).push_back(cell);
  }
  return home;
}

/// Half a unit of the last digit of a decimal without exponent: "5e-4" for "349.373".
std::string half_of_last_digit(const std::string& text) {
  const std::size_t point = text.find('.');
  const std::size_t digits = point == std::string::npos ? 0 : text.size() - point - 1;
  return "5e-" + std::to_string(digits + 1);
}

/// The cables' lengths at a pose that is level and not turned, from decimals in metres.
std::vector<Interval> lengths_at(const Problem& problem, const std::array<const char*, 3>& position_m) {
  using Traits = ScalarTraits<Interval>;
  const Interval zero(0.0);
  const Pose<Interval> pose{Vector3<Interval>(Traits::from_decimal(position_m[0]), Traits::from_decimal(position_m[1]),
                                              Traits::from_decimal(position_m[2])),
                            {zero, zero, zero}};
  const CableGeometry<Interval> cables = cable_geometry(make_model<Interval>(problem), pose);
  std::vector<Interval> lengths;
  for (const Vector3<Interval>& cable : cables.p_AB_W) lengths.push_back(length(cable));
  return lengths;
}

Problem problem_of(const std::string& robot, const std::string& name) {
  return load_case(TAUT_SOURCE_DIR "/cases/robots/" + robot + "/" + name + ".yaml").problem;
}

class PublishedRobot : public ::testing::TestWithParam<const char*> {};

TEST_P(PublishedRobot, HasItsHomeLengthsToTheLastDigitStated) {
  using Traits = ScalarTraits<Interval>;
  const Home home = home_of(GetParam());
  ASSERT_EQ(home.pose, std::vector<std::string>(6, "0"));
  ASSERT_EQ(home.lengths.size(), static_cast<std::size_t>(kCables));
  const std::vector<Interval> lengths = lengths_at(problem_of(GetParam(), "home"), {"0", "0", "0"});
  for (std::size_t i = 0; i < kCables; ++i) {
    const Interval length_cm = lengths[i] * Interval(100.0);
    const Interval stated = Traits::from_decimal(home.lengths[i]);
    const Interval half = Traits::from_decimal(half_of_last_digit(home.lengths[i]));
    EXPECT_TRUE(certainly_positive(length_cm - stated + half)) << "cable " << i + 1;
    EXPECT_TRUE(certainly_positive(stated + half - length_cm)) << "cable " << i + 1;
  }
}

TEST(Hexacrane, HasEqualCablesAtHomeAsItsReadmeSays) {
  using Traits = ScalarTraits<Interval>;
  for (const Interval& length : lengths_at(problem_of("iri-hexacrane", "q1-q2"), {"0", "0", "0.3"})) {
    EXPECT_TRUE(certainly_positive(length - Traits::from_decimal("0.38185")));
    EXPECT_TRUE(certainly_positive(Traits::from_decimal("0.38195") - length));
  }
}

INSTANTIATE_TEST_SUITE_P(All, PublishedRobot, ::testing::Values("nist-roboprinter", "nist-roboprinter2"),
                         [](const auto& parameter) {
                           std::string name = parameter.param;
                           std::erase(name, '-');
                           return name;
                         });

}  // namespace
}  // namespace taut::testing
