// SPDX-License-Identifier: GPL-3.0-or-later
#include "reports/summary/worst_place.h"

#include <gtest/gtest.h>

#include "tests/reports/sample_certificates.h"

namespace taut {
namespace {

/// Tensions from 4 to 6 between 1 and 10, lengths from 40 to 60 between 0 and 100, everywhere.
CableUse calm() {
  CableUse use;
  use.source = CableUse::Source::kProved;
  use.tension.fill({{4, 6}, 1, 10, 0, 0});
  use.length.fill({{40, 60}, 0, 100, 0, 0});
  return use;
}

TEST(WorstPlace, IsWhereACableIsNearestToOneOfItsLimits) {
  const ReportContext scene = sample::scene(sample::proved());
  CableUse use = calm();
  use.tension[2] = {{4, 7.6}, 1, 10, 0.25, 0.5};
  EXPECT_EQ(worst_place(scene, use), 0.5) << "76 % of the greatest tension";
  use.tension[4] = {{1.3, 6}, 1, 10, 0.75, 0.1};
  EXPECT_EQ(worst_place(scene, use), 0.75) << "as near, but to going slack";
  use.length[0] = {{40, 99}, 0, 100, 0, 1.5};
  EXPECT_EQ(worst_place(scene, use), 1.5) << "closer than near";
  use.length[1] = {{0.5, 60}, 0, 100, 1.75, 0};
  EXPECT_EQ(worst_place(scene, use), 1.75) << "to the lower limit";
}

TEST(WorstPlace, IsTheWitnessOfARefutedPathAndNothingWhereNothingIsKnown) {
  EXPECT_EQ(worst_place(sample::scene(sample::refuted()), calm()), 1.375);
  EXPECT_EQ(worst_place(sample::scene(sample::no_path()), {}), std::nullopt);
}

}  // namespace
}  // namespace taut
