// SPDX-License-Identifier: GPL-3.0-or-later
#include "reports/summary/travel.h"

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <nlohmann/json.hpp>

#include "reports/summary/scene.h"
#include "tests/reports/sample_certificates.h"

namespace taut {
namespace {

/// Two straight segments: 0.3 m along x while tilting by 0.5 rad, then 0.4 m along y.
nlohmann::json around_a_corner() {
  nlohmann::json certificate = sample::certificate();
  certificate["verdict"] = "undecided";
  certificate["undecided"] = {{"reason", "for a test"}, {"segment", nullptr}, {"box", nullptr}};
  certificate["illustration"] = nullptr;
  nlohmann::json& space = certificate["problem"]["space"];
  space = nlohmann::json::parse(R"({"parameters": [{"name": "x", "kind": "real"}, {"name": "y", "kind": "real"},
      {"name": "theta", "kind": "real"}], "constants": {}, "flip": null, "constraints": [],
      "pose": {"px": "x", "py": "y", "pz": "0.35", "phi": "0", "theta": "theta", "sigma": "0"}})");
  certificate["problem"]["query"]["waypoints"] = nlohmann::json::parse(R"([["0","0","0"],["0.3","0.4","0.5"]])");
  const auto waypoint = [](double x, double y, double theta) {
    return nlohmann::json{{"x", {fmt::format("{:a}", x), fmt::format("{:a}", y), fmt::format("{:a}", theta)}},
                          {"half_turns", {0, 0, 0}}};
  };
  certificate["path"]["waypoints"] = {waypoint(0, 0, 0), waypoint(0.3, 0, 0.5), waypoint(0.3, 0.4, 0.5)};
  certificate["path"]["times"] = {"1", "3", "4"};
  return certificate;
}

TEST(Travel, AddsUpTheWayTheTurnAndTheTime) {
  const ReportContext scene = sample::scene(around_a_corner());
  EXPECT_NEAR(scene.travel.distance_m(0.5), 0.15, 1e-9);
  EXPECT_NEAR(scene.travel.distance_m(1.5), 0.5, 1e-9);
  EXPECT_NEAR(scene.travel.distance_m(2), 0.7, 1e-9);
  EXPECT_NEAR(scene.travel.turned_rad(0.5), 0.25, 1e-9);
  EXPECT_NEAR(scene.travel.turned_rad(2), 0.5, 1e-9);
  EXPECT_NEAR(scene.travel.time_s(0.5).value(), 2, 1e-12);
  EXPECT_NEAR(scene.travel.time_s(1.75).value(), 3.75, 1e-12);
}

TEST(Travel, StaysWithinTheMove) {
  const ReportContext scene = sample::scene(around_a_corner());
  EXPECT_NEAR(scene.travel.distance_m(99), 0.7, 1e-9);
  EXPECT_EQ(scene.travel.distance_m(-1), 0);
}

TEST(Travel, HasNoTimeWhereThePathHasNone) {
  EXPECT_FALSE(sample::scene(sample::proved()).travel.time_s(1).has_value());
}

TEST(Travel, OfNoPathIsNothing) { EXPECT_EQ(sample::scene(sample::no_path()).travel.distance_m(0), 0); }

}  // namespace
}  // namespace taut
