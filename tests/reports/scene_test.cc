// SPDX-License-Identifier: GPL-3.0-or-later
#include "reports/summary/scene.h"

#include <gtest/gtest.h>

#include <nlohmann/json.hpp>

#include "base/input_error.h"
#include "tests/reports/sample_certificates.h"

namespace taut {
namespace {

TEST(ReportContext, EnclosesWhatIsSampledOnTheCertificatesBoxes) {
  const ReportContext scene = sample::scene(sample::proved());
  ASSERT_EQ(scene.ranges.segments.size(), 2u);
  std::size_t seen = 0;
  for (const PathSample& sample : scene.samples) {
    const auto k = static_cast<std::size_t>(std::min(sample.position, 1.0));
    const double s = sample.position - static_cast<double>(k);
    for (const BoxRanges& box : scene.ranges.segments[k]) {
      if (s < box.box.lower().approx() || s > box.box.upper().approx()) continue;
      ++seen;
      for (std::size_t i = 0; i < kCables; ++i) {
        EXPECT_LE(box.tension[i].lower, sample.statics.tension[i] - sample.statics.tension_below[i] + 1e-12);
        EXPECT_GE(box.tension[i].upper, sample.statics.tension[i] + sample.statics.tension_above[i] - 1e-12);
        EXPECT_LE(box.length[i].lower, sample.statics.length[i] + 1e-12);
        EXPECT_GE(box.length[i].upper, sample.statics.length[i] - 1e-12);
      }
    }
  }
  EXPECT_GE(seen, scene.samples.size());
}

TEST(ReportContext, ReadsBoxesAsTheyAre) {
  const ReportContext scene = sample::scene(sample::proved());
  ASSERT_EQ(scene.boxes.size(), 2u);
  EXPECT_EQ(scene.boxes[0], (std::vector<DyadicBox>{{0, 1}, {1, 1}}));
  EXPECT_EQ(scene.boxes[1], (std::vector<DyadicBox>{{0, 0}}));
}

TEST(ReportContext, LeavesOutBoxesThatAreNotHalvesOfHalves) {
  nlohmann::json certificate = sample::proved();
  certificate["segments"][0]["boxes"] = nlohmann::json::parse(R"([{"bits": 64, "s": ["0", "1/4"]},
          {"bits": 64, "s": ["1/4", "3/4"]},
          {"bits": 64, "s": ["3/4", "1"]}])");
  EXPECT_EQ(sample::scene(certificate).boxes[0], (std::vector<DyadicBox>{{0, 2}, {3, 2}}));
}

TEST(ReportContext, RefusesBoxesThatAreNoNumbers) {
  for (const char* end : {"1/3", "2", "-1", "1/0", "0x1", "", "1/", "/2", "01/2", "1/2 "}) {
    nlohmann::json certificate = sample::proved();
    certificate["segments"][1]["boxes"][0]["s"] = {"0", end};
    EXPECT_THROW(static_cast<void>(sample::scene(certificate)), InputError) << end;
  }
}

}  // namespace
}  // namespace taut
