// SPDX-License-Identifier: GPL-3.0-or-later
#include "reports/page/report_data.h"

#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <nlohmann/json.hpp>
#include <numeric>

#include "reports/page/plane.h"
#include "reports/page/plane_map.h"
#include "reports/summary/cable_use.h"
#include "tests/reports/sample_certificates.h"

namespace taut {
namespace {

using nlohmann::json;
using ::testing::HasSubstr;
using ::testing::Not;
using ::testing::UnorderedElementsAre;

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
  EXPECT_TRUE(refuted["reached"].is_null());
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
      {"of": "base_anchors", "share": "1.83", "stated": "7", "proved": "0.0001834", "unit": "m", "complete": true},
      {"of": "load", "share": "16.8", "stated": "7", "proved": "0.08412", "unit": "N, N m", "complete": true}]})");
  const json data = report_data(sample::scene(certificate));
  EXPECT_EQ(data["tube_m"], 0.001);
  EXPECT_EQ(data["tolerances"], json::parse(R"json([
      {"what": "base anchors", "words": "183 % (0.183 mm)", "used": 54.64481
},
      {"what": "load", "words": "1680 % (0.0841 N or N·m)", "used": 5.952381}])json"));
}

TEST(ReportData, RefusesAHeadroomThatIsNone) {
  for (const char* text :
       {R"({"shares": []})", R"({"subject": "sky", "waypoint": null, "tightest": null, "nominal": null,
       "shares": []})",
        R"({"subject": "path", "waypoint": null, "tightest": null, "nominal": null, "shares": [
       {"of": "<b>", "share": "1", "stated": "1", "proved": "1", "unit": "1", "complete": true}]})",
        R"({"subject": "path", "waypoint": null, "tightest": null, "nominal": null, "shares": [],
       "free_ends": {"base": null, "platform": "<b>", "complete": true}})",
        R"({"subject": "path", "waypoint": null, "tightest": null, "nominal": null, "shares": [],
       "free_ends": {"base": null, "complete": true}})"}) {
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

TEST(ReportData, OrdersCablesByHowNearTheyComeToTheirLimits) {
  const ReportContext scene = sample::scene(sample::proved());
  const json cables = report_data(scene)["cables"];
  EXPECT_EQ(cables["is_proved"], true);
  const CableUse use = cable_use(scene);
  for (const char* what : {"tension", "length"}) {
    const json& of = cables[what];
    const auto& uses = of == cables["length"] ? use.length : use.tension;
    EXPECT_THAT(of["order"].get<std::vector<int>>(), UnorderedElementsAre(0, 1, 2, 3, 4, 5));
    const std::vector<std::string> classes = {"calm", "near", "close", "out"};
    for (std::size_t k = 0; k + 1 < kCables; ++k) {
      const auto a = of["order"][k].get<std::size_t>();
      const auto b = of["order"][k + 1].get<std::size_t>();
      const auto rank = [&](std::size_t i) {
        return std::ranges::find(classes, of["nearness"][i].get<std::string>()) - classes.begin();
      };
      EXPECT_GE(rank(a), rank(b)) << what << k;
      EXPECT_LE(of["ranges"][a][0].get<double>(), uses[a].range.lower);
      EXPECT_GE(of["ranges"][a][1].get<double>(), uses[a].range.upper);
    }
  }
}

TEST(ReportData, RangesOfCablesAreOfTheWholePath) {
  const ReportContext scene = sample::scene(sample::refuted());
  const json cables = report_data(scene)["cables"];
  EXPECT_EQ(cables["is_proved"], false);
  for (std::size_t i = 0; i < kCables; ++i) {
    for (const PathSample& sample : scene.samples) {
      EXPECT_LE(cables["length"]["ranges"][i][0].get<double>(), sample.statics.length[i] * (1 + 1e-6));
      EXPECT_GE(cables["length"]["ranges"][i][1].get<double>(), sample.statics.length[i] * (1 - 1e-6));
    }
  }
  EXPECT_EQ(cables["tension"]["nearness"][2], "out") << "the cable of the witness, whatever the samples are";
  EXPECT_GE(cables["tension"]["ranges"][2][1].get<double>(), 0.8129);
  EXPECT_EQ(cables["tension"]["order"][0], 2);
  EXPECT_EQ(report_data(sample::scene(sample::undecided()))["cables"]["is_proved"], false);
}

TEST(ReportData, ShowsNoPathThatWasNotFound) {
  const json data = report_data(sample::scene(sample::no_path_of_query()));
  EXPECT_FALSE(data["is_found"]) << "its samples are of the straight way through the query's waypoints";
  EXPECT_TRUE(data["cables"].is_null());
  EXPECT_EQ(data["plane"]["waypoints"].size(), 3u) << "what was asked for";
  EXPECT_TRUE(data["plane"]["detail"].is_null());
}

/// The letters that a text of contour_text() stands for.
std::string unpacked(const std::string& text) {
  std::string letters;
  std::size_t count = 0;
  for (const char c : text) {
    if (c >= '0' && c <= '9') {
      count = 10 * count + static_cast<std::size_t>(c - '0');
    } else {
      letters.append(count > 0 ? count : 1, c);
      count = 0;
    }
  }
  return letters;
}

TEST(ContourText, TellsSignsOfAllAndSizesNextToAChangeOfSign) {
  constexpr double kNaN = std::numeric_limits<double>::quiet_NaN();
  EXPECT_EQ(contour_text({1, 1, 1, 1, 1, 1, 1, 1, 1}, 3), "9Z");
  EXPECT_EQ(contour_text({0, -1e-9, kNaN, -5}, 2), "4z") << "zero and NaN are not positive";
  EXPECT_EQ(contour_text({1, 0.1, -0.1, -5, -5}, 5), "2Z3z") << "sizes count next to the change only";
  // 0.1 / 1 is one decade, which is 6.25 letters.
  EXPECT_EQ(contour_text({9, 9, 0.1, -1, -9, -9}, 6), "2ZT3z");
  EXPECT_EQ(contour_text({1e-9, -1}, 2), "Az");
}

TEST(ContourText, KeepsEverySignAndPlacesContoursWithinATenthOfACell) {
  constexpr int kColumns = 40;
  std::vector<double> field;
  for (int row = 0; row < 30; ++row) {
    for (int column = 0; column < kColumns; ++column) {
      field.push_back(std::sin(0.3 * column + 0.1 * row) - 0.02 * row);
    }
  }
  const std::string letters = unpacked(contour_text(field, kColumns));
  ASSERT_EQ(letters.size(), field.size());
  const auto level = [&](std::size_t k) {
    const bool is_positive = letters[k] < 'a';
    return (is_positive ? 1 : -1) * std::pow(10, 0.16 * (letters[k] - (is_positive ? 'A' : 'a')));
  };
  int crossings = 0;
  for (std::size_t k = 0; k + 1 < field.size(); ++k) {
    EXPECT_EQ(level(k) > 0, field[k] > 0) << k;
    if (k % kColumns == kColumns - 1 || (field[k] > 0) == (field[k + 1] > 0)) continue;
    ++crossings;
    EXPECT_NEAR(level(k) / (level(k) - level(k + 1)), field[k] / (field[k] - field[k + 1]), 0.1) << k;
  }
  EXPECT_GT(crossings, 50);
}

TEST(Plane, KeepsTheLimitsAtThePathsPoses) {
  const ReportContext scene = sample::scene(sample::proved());
  const Plane plane = sample_plane(scene).value();
  const PlaneGrid& grid = plane.grid;
  const std::size_t cells = static_cast<std::size_t>(grid.rows) * static_cast<std::size_t>(grid.columns);
  ASSERT_EQ(grid.tension.size(), cells);
  ASSERT_EQ(grid.length.size(), cells);
  ASSERT_EQ(grid.determinant.size(), cells);
  for (const PathSample& sample : scene.samples) {
    const auto share = [&](std::size_t j) {
      return (sample.parameters[j] - grid.window[j].lower) / grid.window[j].length();
    };
    const auto column = static_cast<std::size_t>(share(0) * grid.columns);
    const auto row = static_cast<std::size_t>((1 - share(1)) * grid.rows);
    EXPECT_GT(grid.tension.at(row * static_cast<std::size_t>(grid.columns) + column), 0) << sample.position;
    EXPECT_GT(grid.length.at(row * static_cast<std::size_t>(grid.columns) + column), 0) << sample.position;
  }
  EXPECT_TRUE(std::ranges::any_of(grid.determinant, [](double x) { return x > 0; }));
  EXPECT_TRUE(std::ranges::any_of(grid.determinant, [](double x) { return x < 0; }));
  EXPECT_FALSE(plane.charts.empty());
}

TEST(Plane, HasAProvedMapThatAgreesWithSamples) {
  const ReportContext scene = sample::scene(sample::proved());
  const PlaneMap map = plane_map(scene).value();
  const auto share = [&](CellKind kind) { return map.share.at(static_cast<std::size_t>(kind)); };
  EXPECT_NEAR(std::accumulate(map.share.begin(), map.share.end(), 0.0), 1, 1e-12);
  EXPECT_LT(share(CellKind::kUndecided), 0.06);
  EXPECT_GT(map.cells, 1000U);
  ASSERT_TRUE(map.flip);
  EXPECT_EQ(map.turns, (std::array<bool, 2>{true, true}));
  constexpr int kSide = 120;
  int inside = 0;
  for (int i = 0; i < kSide * kSide; ++i) {
    const auto at = [&](std::size_t k, int n) {
      return map.window[k].lower + map.window[k].length() * (n + 0.5) / kSide;
    };
    const Statics<double> s = statics(scene.sampler.model(), scene.sampler.pose({at(0, i % kSide), at(1, i / kSide)}));
    const Reserves left = reserves(scene.sampler.model(), s);
    inside += left.tension > 0 && left.length > 0 ? 1 : 0;
  }
  const double sampled = static_cast<double>(inside) / (kSide * kSide);
  EXPECT_GT(sampled, share(CellKind::kInside) - 0.01);
  EXPECT_LT(sampled, share(CellKind::kInside) + share(CellKind::kUndecided) + 0.01);
}

TEST(Plane, HasAMapOfItsEnlargedPartWithTheSameColours) {
  const ReportContext scene = sample::scene(sample::proved());
  const Plane plane = sample_plane(scene, false).value();
  ASSERT_TRUE(plane.detail);
  EXPECT_TRUE(plane.grid.tension.empty() && plane.detail->tension.empty());
  const PlaneMap part = plane_map(scene, plane.detail->window).value();
  EXPECT_EQ(part.window[0].lower, plane.detail->window[0].lower);
  EXPECT_EQ(part.turns, (std::array<bool, 2>{false, false}));
  EXPECT_GT(part.share.at(static_cast<std::size_t>(CellKind::kInside)), 0) << "the path is in it";
}

TEST(ReportData, HasTheProvedMapOrElseSamples) {
  const json proved = report_data(sample::scene(sample::proved()))["plane"]["grid"];
  EXPECT_FALSE(proved["map"]["areas"]["inside"].get<std::string>().empty());
  EXPECT_FALSE(proved.contains("tension")) << "not both";
  EXPECT_LT(proved.dump().size(), 150'000U) << "bytes on the page";
  const json unchecked = report_data(sample::unchecked(sample::proved()))["plane"]["grid"];
  EXPECT_TRUE(unchecked["map"].is_null());
  EXPECT_TRUE(unchecked.contains("tension"));
}

TEST(Plane, EnlargesAPathThatIsSmallInTheWindow) {
  json certificate = sample::proved();
  certificate["path"]["waypoints"][1]["x"][0] = "0x1p+0";
  EXPECT_FALSE(sample_plane(sample::scene(certificate))->detail) << "it crosses half of the window";
  const ReportContext scene = sample::scene(sample::proved());
  const Plane plane = sample_plane(scene).value();
  ASSERT_TRUE(plane.detail);
  for (std::size_t j = 0; j < 2; ++j) {
    const Span& part = plane.detail->window[j];
    const Span& whole = plane.grid.window[j];
    EXPECT_GE(part.lower, whole.lower);
    EXPECT_LE(part.upper, whole.upper);
    EXPECT_NEAR(part.length() / whole.length(), plane.detail->window[0].length() / plane.grid.window[0].length(), 1e-9)
        << "the same proportions";
    for (const PathSample& sample : scene.samples) {
      EXPECT_GT(sample.parameters[j], part.lower);
      EXPECT_LT(sample.parameters[j], part.upper);
    }
  }
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
  const json lost = report_data(sample::scene(sample::no_path_of_query()));
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
