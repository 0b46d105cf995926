// SPDX-License-Identifier: GPL-3.0-or-later
#include "reports/summary/shown_bodies.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <nlohmann/json.hpp>
#include <numbers>

#include "reports/page/machine_picture.h"
#include "tests/reports/sample_certificates.h"

namespace taut {
namespace {

using ::testing::HasSubstr;
using ::testing::Not;

/// A box of quadrangles that are cut into triangles, each of which has corners of its own, as in STL files.
ShownBody box(double x, double y, double z) {
  const auto at = [&](int k) {
    return std::array<double, 3>{(k & 1) != 0 ? x : 0, (k & 2) != 0 ? y : 0, (k & 4) != 0 ? z : 0};
  };
  ShownBody body;
  for (const auto& side : {std::array{0, 1, 3, 2}, std::array{4, 5, 7, 6}, std::array{0, 1, 5, 4},
                           std::array{2, 3, 7, 6}, std::array{0, 2, 6, 4}, std::array{1, 3, 7, 5}}) {
    for (const auto& [a, b, c] : {std::array{0, 1, 2}, std::array{0, 2, 3}}) {
      const auto first = static_cast<std::uint32_t>(body.corners.size());
      for (const int i : {a, b, c}) body.corners.push_back(at(side[static_cast<std::size_t>(i)]));
      body.triangles.push_back({first, first + 1, first + 2});
    }
  }
  return body;
}

TEST(ShownBodies, OfABoxTheTwelveEdgesAreDrawnAndNoDiagonal) {
  const auto edges = feature_edges(box(1, 2, 3), Eigen::Vector3d(3, 2, 1).normalized());
  EXPECT_EQ(edges.size(), 12u);
  for (const auto& [a, b] : edges) {
    const int differ = (a[0] != b[0] ? 1 : 0) + (a[1] != b[1] ? 1 : 0) + (a[2] != b[2] ? 1 : 0);
    EXPECT_EQ(differ, 1);
  }
}

TEST(ShownBodies, RimsAreDrawn) {
  const ShownBody plate{{{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0}}, {{0, 1, 2}, {0, 2, 3}}};
  EXPECT_EQ(feature_edges(plate, Eigen::Vector3d(1, 2, 3).normalized()).size(), 4u);
}

TEST(ShownBodies, OfWhatIsRoundTheOutlineIsDrawn) {
  constexpr std::uint32_t kSides = 24;  // of a drum about the axis z; it turns by 15 degrees from one to the next
  ShownBody drum;
  for (std::uint32_t k = 0; k < kSides; ++k) {
    const double angle = 2 * std::numbers::pi * k / kSides + 0.1;
    for (const double z : {0.0, 1.0}) drum.corners.push_back({std::cos(angle), std::sin(angle), z});
  }
  for (std::uint32_t k = 0; k < kSides; ++k) {
    const std::uint32_t a = 2 * k, b = 2 * ((k + 1) % kSides);
    drum.triangles.push_back({a, b, a + 1});
    drum.triangles.push_back({b + 1, a + 1, b});  // whichever way round
  }
  std::size_t upright = 0;
  for (const auto& [a, b] : feature_edges(drum, Eigen::Vector3d(1, 0, 0.2).normalized())) {
    if (a[2] == b[2]) continue;  // of a rim
    EXPECT_EQ(a[0], b[0]) << "a diagonal";
    EXPECT_GT(std::abs(a[1]), 0.98) << "at the left and the right";
    ++upright;
  }
  EXPECT_EQ(upright, 2u);
}

TEST(ShownBodies, TravelInAnIllustrationOfIntegers) {
  const Decoration stated{box(0.1, 0.2, 0.30001), box(1, 1, 1)};
  const nlohmann::json json = to_json(stated);
  for (const nlohmann::json& x : json["frame"]["corners"]) EXPECT_TRUE(x.is_number_integer());
  EXPECT_EQ(decoration_from_json(json), stated);
  EXPECT_EQ(to_json(Decoration()), nlohmann::json::object());
}

TEST(ShownBodies, NoneIsShownThatACaseCouldNotState) {
  const nlohmann::json good = to_json(Decoration{box(1, 1, 1), std::nullopt});
  ASSERT_TRUE(decoration_from_json(good).frame);
  const auto altered = [&](const char* pointer, const nlohmann::json& value) {
    nlohmann::json json = good;
    json[nlohmann::json::json_pointer(pointer)] = value;
    return decoration_from_json(json).frame.has_value();
  };
  EXPECT_FALSE(altered("/frame", 7));
  EXPECT_FALSE(altered("/frame/corners", "0"));
  EXPECT_FALSE(altered("/frame/corners/0", nullptr));
  EXPECT_FALSE(altered("/frame/corners/0", 0.5));
  EXPECT_FALSE(altered("/frame/corners/0", 200'000'000'000)) << "beyond 1000 km";
  EXPECT_FALSE(altered("/frame/triangles/0", 36)) << "there is no such corner";
  EXPECT_FALSE(altered("/frame/triangles/0", -1));
  EXPECT_FALSE(altered("/frame/triangles", nlohmann::json::array()));
  EXPECT_FALSE(altered("/frame/triangles", nlohmann::json::array({0, 1})));
  EXPECT_FALSE(altered("/frame/triangles", nlohmann::json(std::vector<int>(3 * kMostShownTriangles + 3, 0))));
  EXPECT_FALSE(decoration_from_json(nlohmann::json(7)).frame);
}

TEST(ShownBodies, ThePictureSaysThatTheyAreNotChecked) {
  nlohmann::json certificate = sample::proved();
  const auto note = [&] { return shown_bodies_note(sample::scene(certificate)).str(); };
  EXPECT_EQ(note(), "");
  certificate["illustration"]["decoration"] = to_json(Decoration{box(1, 1, 1), std::nullopt});
  EXPECT_THAT(note(), HasSubstr("The frame in thin lines is drawn as the case says: <b>not checked</b>"));
  certificate["illustration"]["decoration"] = to_json(Decoration{box(1, 1, 1), box(0.1, 0.1, 0.1)});
  EXPECT_THAT(note(), HasSubstr("The frame and the payload in thin lines are drawn"));
  const std::string svg = machine_picture(sample::scene(certificate), 0, {}, "Worst place", {}).str();
  EXPECT_THAT(svg, HasSubstr("class=\"shown\""));
  EXPECT_THAT(svg, HasSubstr("class=\"shown payload\""));
  EXPECT_THAT(svg, Not(HasSubstr("class=\"post\""))) << "a frame that is shown stands for them";
}

}  // namespace
}  // namespace taut
