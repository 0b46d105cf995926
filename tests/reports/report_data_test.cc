// SPDX-License-Identifier: GPL-3.0-or-later
#include "reports/page/report_data.h"

#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <nlohmann/json.hpp>

#include "reports/page/plane.h"
#include "tests/reports/sample_certificates.h"

namespace taut {
namespace {

using nlohmann::json;
using ::testing::HasSubstr;
using ::testing::Not;

/// `proved` with `copies` of its first segment before the others; all of its waypoints but the last are the same one.
json long_path(std::size_t copies) {
  json certificate = sample::proved();
  json segments = json::array();
  json waypoints = json::array();
  const json first = certificate["path"]["waypoints"][0];
  for (std::size_t k = 0; k < copies; ++k) {
    json segment = certificate["segments"][0];
    segment["from"] = k;
    segment["to"] = k + 1;
    segment["margins"]["tension_N"] = fmt::format("{}", 1 + k);
    segments.push_back(segment);
    waypoints.push_back(first);
  }
  waypoints.push_back(first);
  certificate["segments"] = segments;
  certificate["path"]["waypoints"] = waypoints;
  return certificate;
}

TEST(ReportData, HasPosesAndProvedRangesAlongThePath) {
  const ReportContext scene = sample::scene(sample::proved());
  const json data = report_data(scene);
  EXPECT_EQ(data["segments"], 2);
  EXPECT_EQ(data["samples"]["position"].size(), scene.samples.size());
  for (const char* key : {"distance", "turned", "wrench_scale", "sign"}) {
    EXPECT_EQ(data["samples"][key].size(), scene.samples.size()) << key;
  }
  EXPECT_EQ(data["samples"]["time"].size(), 0u);
  EXPECT_NEAR(data["samples"]["p"][2][0].get<double>(), 0.35, 1e-6);
  EXPECT_EQ(data["bands"]["from"].front(), 0);
  EXPECT_EQ(data["bands"]["to"].back(), 2);
  EXPECT_EQ(data["margins"]["tension_N"].size(), 2u);
}

TEST(ReportData, RoundsProvedRangesOutward) {
  const ReportContext scene = sample::scene(sample::proved());
  const json bands = report_data(scene)["bands"];
  std::size_t k = 0;
  for (const auto& segment : scene.ranges.segments) {
    for (const BoxRanges& box : segment) {
      for (std::size_t i = 0; i < kCables; ++i) {
        const double lower = bands["tension"][i]["lower"][k].get<double>();
        const double upper = bands["tension"][i]["upper"][k].get<double>();
        EXPECT_LE(lower, box.tension[i].lower);
        EXPECT_NEAR(lower, box.tension[i].lower, 1e-5);
        EXPECT_GE(upper, box.tension[i].upper);
        EXPECT_NEAR(upper, box.tension[i].upper, 1e-5);
        EXPECT_LE(bands["length"][i]["lower"][k].get<double>(), box.length[i].lower);
        EXPECT_GE(bands["length"][i]["upper"][k].get<double>(), box.length[i].upper);
      }
      ++k;
    }
  }
  EXPECT_EQ(k, bands["from"].size());
}

TEST(ReportData, PutsLongPathsTogetherWithoutLosingTheLeastAndTheGreatest) {
  const ReportContext scene = sample::scene(long_path(4000));
  const json data = report_data(scene);
  EXPECT_LE(data["samples"]["position"].size(), 2000u);
  ASSERT_LE(data["margins"]["from"].size(), 1500u);
  EXPECT_EQ(data["margins"]["to"].back(), 4000);
  EXPECT_EQ(data["margins"]["tension_N"].front(), 1) << "the least of those put together";
  ASSERT_LE(data["bands"]["from"].size(), 1600u);
  EXPECT_EQ(data["bands"]["from"].front(), 0);
  EXPECT_EQ(data["bands"]["to"].back(), 4000);
  for (std::size_t k = 1; k < data["bands"]["from"].size(); ++k) {
    EXPECT_EQ(data["bands"]["from"][k], data["bands"]["to"][k - 1]) << "no gaps";
  }
  EXPECT_LE(data["bands"]["tension"][0]["lower"][0].get<double>(), scene.ranges.segments[0][0].tension[0].lower);
}

TEST(ReportData, KeepsGapsBetweenBoxes) {
  json certificate = sample::proved();
  certificate["segments"][0]["boxes"] = json::parse(R"([{"bits": 64, "s": ["0", "1/4"]},
          {"bits": 64, "s": ["1/2", "1"]}])");
  const json bands = report_data(sample::scene(certificate))["bands"];
  std::size_t gaps = 0;
  for (std::size_t k = 1; k < bands["from"].size(); ++k) gaps += bands["from"][k] > bands["to"][k - 1] ? 1 : 0;
  EXPECT_EQ(gaps, 1u);
}

TEST(ReportData, TellsWhatIsNotProved) {
  const json refuted = report_data(sample::scene(sample::refuted()));
  EXPECT_EQ(refuted["witness"]["position"], 1.375);
  EXPECT_EQ(refuted["witness"]["cable"], 3);
  const json undecided = report_data(sample::scene(sample::undecided()));
  EXPECT_EQ(undecided["stretches"], json::parse(R"([{"from": 1.25, "to": 1.375, "violated": false}])"));
  EXPECT_TRUE(undecided["bands"].is_null());
  EXPECT_EQ(report_data(sample::scene(sample::no_path()))["samples"]["position"].size(), 0u);
}

TEST(ReportData, SetsWhatIsStatedBesideWhatIsProvedOfATolerance) {
  json certificate = sample::proved();
  certificate["problem"]["tolerances"] = json::parse(R"({"base_anchor_m": ["0","0","0.0001","0","0","0"],
      "platform_anchor_m": ["0","0","0","0","0","0"], "load_point_m": "0", "wrench": ["0","0","-0.005","0","0","0"],
      "position_m": "0.001", "orientation_rad": "(0.1)*pi/180", "cable_length_m": null})");
  certificate["illustration"]["headroom"] = json::parse(R"({"subject": "path", "waypoint": null, "tightest": null,
      "nominal": null, "shares": [
      {"of": "all", "share": "1.2", "stated": "1", "proved": "1.2", "unit": "1", "complete": true},
      {"of": "base_anchors", "share": "1.83", "stated": "7", "proved": "0.000183", "unit": "m", "complete": true},
      {"of": "load", "share": "16.8", "stated": "7", "proved": "0.0841", "unit": "N, N m", "complete": true}]})");
  const json data = report_data(sample::scene(certificate));
  EXPECT_EQ(data["tube_m"], 0.001);
  EXPECT_EQ(data["tolerances"], json::parse(R"([
      {"name": "base_anchors", "unit": "m", "stated": 0.0001, "proved": 0.000183},
      {"name": "load", "unit": "N, N m", "stated": 0.005, "proved": 0.0841}])"));
}

TEST(ReportData, RefusesAHeadroomThatIsNone) {
  for (const char* text :
       {R"({"shares": []})", R"({"subject": "sky", "waypoint": null, "tightest": null, "nominal": null,
       "shares": []})",
        R"({"subject": "path", "waypoint": null, "tightest": null, "nominal": null, "shares": [
       {"of": "<b>", "share": "1", "stated": "1", "proved": "1", "unit": "1", "complete": true}]})"}) {
    json certificate = sample::proved();
    certificate["illustration"]["headroom"] = json::parse(text);
    EXPECT_THROW(sample::scene(certificate), InputError) << text;
  }
}

TEST(ReportData, RepeatsNoClaimOfAnUncheckedCertificate) {
  const json data = report_data(sample::unchecked(sample::proved()));
  EXPECT_EQ(data["verdict"], "unchecked");
  EXPECT_TRUE(data["bands"].is_null());
  EXPECT_TRUE(data["margins"]["tension_N"].empty());
  EXPECT_EQ(data["samples"], report_data(sample::scene(sample::proved()))["samples"]) << "what is computed is there";
  EXPECT_TRUE(report_data(sample::unchecked(sample::refuted()))["witness"].is_null());
  EXPECT_TRUE(report_data(sample::unchecked(sample::undecided()))["stretches"].empty());
}

TEST(ReportData, HasOnlyFiniteNumbers) {
  json certificate = sample::proved();
  certificate["path"]["waypoints"][1]["x"] = {"0x1p+1023", "-0x1p+1023"};
  const std::string text = script_safe(report_data(sample::scene(certificate)));
  EXPECT_THAT(text, Not(HasSubstr("nan")));
  EXPECT_THAT(text, Not(HasSubstr("inf")));
  EXPECT_TRUE(json::accept(text));
}

TEST(ReportData, CannotEndItsScriptElement) {
  json certificate = sample::hostile();
  certificate["problem"]["space"]["parameters"][0]["name"] = "phi";
  EXPECT_THAT(script_safe(report_data(sample::scene(certificate))), Not(HasSubstr("<")));
  const json attack = sample::kAttack + "\xff";
  const std::string text = script_safe(attack);
  EXPECT_THAT(text, Not(HasSubstr("<")));
  EXPECT_EQ(json::parse(text), sample::kAttack + "\uFFFD");
}

TEST(Plane, ColoursThePathsPosesAsTheyAre) {
  const ReportContext scene = sample::scene(sample::proved());
  const Plane plane = sample_plane(scene).value();
  ASSERT_EQ(plane.cells.size(), static_cast<std::size_t>(plane.rows) * static_cast<std::size_t>(plane.columns));
  for (const PathSample& sample : scene.samples) {
    const auto share = [&](std::size_t j) {
      return (sample.parameters[j] - plane.window[j].lower) / plane.window[j].length();
    };
    const auto column = static_cast<std::size_t>(share(0) * plane.columns);
    const auto row = static_cast<std::size_t>((1 - share(1)) * plane.rows);
    EXPECT_EQ(plane.cells.at(row * static_cast<std::size_t>(plane.columns) + column), '0') << sample.position;
  }
  EXPECT_FALSE(plane.singular.empty());
  EXPECT_FALSE(plane.charts.empty());
}

TEST(ReportData, TellsFromWhereTheMachineIsSeenAndWhichPlaceIsWorst) {
  const json proved = report_data(sample::scene(sample::proved()));
  EXPECT_EQ(proved["view"]["up"], json({0, 0, -1})) << "the load pulls along z";
  EXPECT_EQ(proved["view"]["load"], "1 N (102 g)");
  EXPECT_GT(proved["view"]["step"], 0);
  EXPECT_LT(proved["view"]["ground"], -0.4) << "below the platform, which is 0.35 m below the base";
  EXPECT_TRUE(proved["is_found"]);
  EXPECT_TRUE(proved["worst"].is_number());
  EXPECT_EQ(proved["samples"]["force"], json::array()) << "as the robot's all along";
  EXPECT_EQ(report_data(sample::scene(sample::refuted()))["worst"], 1.375) << "the witness";
  const json lost = report_data(sample::scene(sample::not_found()));
  EXPECT_FALSE(lost["is_found"]);
  EXPECT_TRUE(lost["worst"].is_null());
}

TEST(ReportData, HasTheForceOfALoadThatTurnsWithThePlatform) {
  json certificate = sample::proved();
  certificate["problem"]["load"] = json::parse(R"({"point_m": ["0.03","0.014","-0.021"],
      "gravity_m_s2": ["0", "0", "0"], "items": [{"name": "thrust", "force": {"axes": "P", "at_m": ["0", "0", "0"],
        "segment": {"direction": ["0", "0", "1"], "range": ["1", "2"]}}}]})");
  const json force = report_data(sample::scene(certificate))["samples"]["force"];
  ASSERT_EQ(force.size(), 3);
  EXPECT_NE(force[2].front(), force[2].back());
}

}  // namespace
}  // namespace taut
