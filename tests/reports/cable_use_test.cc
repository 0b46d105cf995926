// SPDX-License-Identifier: GPL-3.0-or-later
#include "reports/summary/cable_use.h"

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <nlohmann/json.hpp>
#include <random>

#include "problem/decimal.h"
#include "reports/summary/wording.h"
#include "tests/reports/sample_certificates.h"

namespace taut {
namespace {

TEST(CableUse, ContainsEverySampleOfAProvedPath) {
  const ReportContext scene = sample::scene(sample::proved());
  const CableUse use = cable_use(scene);
  EXPECT_EQ(use.source, CableUse::Source::kProved);
  for (const PathSample& sample : scene.samples) {
    for (std::size_t i = 0; i < kCables; ++i) {
      EXPECT_LE(use.tension[i].range.lower, sample.statics.tension[i] - sample.statics.tension_below[i]);
      EXPECT_GE(use.tension[i].range.upper, sample.statics.tension[i] + sample.statics.tension_above[i]);
      EXPECT_LE(use.length[i].range.lower, sample.statics.length[i]);
      EXPECT_GE(use.length[i].range.upper, sample.statics.length[i]);
    }
  }
}

TEST(CableUse, SaysWhatItRestsOn) {
  nlohmann::json certificate = sample::proved();
  certificate["segments"][1]["boxes"] = nlohmann::json::array();
  EXPECT_EQ(cable_use(sample::scene(certificate)).source, CableUse::Source::kProvedParts);
  certificate = sample::proved();
  certificate["segments"].erase(1);
  EXPECT_EQ(cable_use(sample::scene(certificate)).source, CableUse::Source::kProvedParts) << "a segment is missing";
  EXPECT_EQ(cable_use(sample::scene(sample::refuted())).source, CableUse::Source::kSamples);
  EXPECT_EQ(cable_use(sample::scene(sample::no_path())).source, CableUse::Source::kNone);
  certificate = sample::undecided();
  EXPECT_EQ(cable_use(sample::scene(certificate)).source, CableUse::Source::kSamples);
  certificate["undecided"] = {{"reason", "no path was found"}, {"segment", nullptr}, {"box", nullptr}};
  EXPECT_EQ(cable_use(sample::scene(certificate)).source, CableUse::Source::kNone)
      << "its waypoints are the query's alone";
}

TEST(CableUse, OfSamplesIsOfTheWholePath) {
  nlohmann::json certificate = sample::proved();
  certificate["segments"].erase(1);
  const ReportContext scene = sample::scene(certificate);
  const CableUse sampled = sampled_use(scene);
  EXPECT_EQ(sampled.source, CableUse::Source::kSamples);
  for (const PathSample& sample : scene.samples) {
    EXPECT_LE(sampled.length[2].range.lower, sample.statics.length[2]);
    EXPECT_GE(sampled.length[2].range.upper, sample.statics.length[2]);
  }
  EXPECT_EQ(sampled_use(sample::scene(sample::no_path())).source, CableUse::Source::kNone);
}

TEST(CableUse, PlacesABoundThatManyBoxesShareWhereASampleComesNearestToIt) {
  ReportContext scene = sample::scene(sample::proved());
  std::vector<double> places;
  for (std::size_t k = 0; k < scene.ranges.segments.size(); ++k) {
    for (BoxRanges& box : scene.ranges.segments[k]) {
      for (Range& range : box.tension) range = {0.06, 0.49};
      places.push_back(static_cast<double>(k) + box.box.mid().approx());
    }
  }
  const CableUse use = cable_use(scene);
  std::size_t later = 0;
  for (std::size_t i = 0; i < kCables; ++i) {
    const auto tension = [&](double place) {
      return scene.sampler.at(scene.certificate.path, place).statics.tension[i];
    };
    const auto [least, greatest] = std::ranges::minmax_element(places, {}, tension);
    EXPECT_EQ(use.tension[i].range.lower, 0.06);
    EXPECT_NEAR(tension(use.tension[i].least_at), tension(*least), 1e-9);
    EXPECT_NEAR(tension(use.tension[i].greatest_at), tension(*greatest), 1e-9);
    later += (least != places.begin() ? 1 : 0) + (greatest != places.begin() ? 1 : 0);
  }
  EXPECT_GT(later, 0u) << "the first box is not always the one";
}

TEST(Use, IsNeverSaidToBeLessThanItIs) {
  std::mt19937 random(7);
  std::uniform_int_distribution<int> digits(1, 99999);
  using Rational = boost::multiprecision::cpp_rational;
  for (int i = 0; i < 20000; ++i) {
    const DecimalText limit = fmt::format("0.{:05}", digits(random));
    Use use;
    use.upper_limit = ScalarTraits<double>::from_decimal(limit);
    use.range.upper = use.upper_limit * digits(random) / 1000;  // just at a printed share, often
    const Rational exact = 100 * Rational(use.range.upper) / Decimal::parse(limit).rational();
    EXPECT_GE(Decimal::parse(rounded_up(use.used_percent(), 3)).rational(), exact);
    EXPECT_GE(100 * Rational(use.used()), exact);
  }
}

}  // namespace
}  // namespace taut
