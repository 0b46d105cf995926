// SPDX-License-Identifier: GPL-3.0-or-later
#include "base/nearest.h"

#include <gtest/gtest.h>

#include "base/plural.h"

namespace taut {
namespace {

const std::vector<std::string> kKnown = {"plan", "audit", "regress", "show"};

TEST(NearestWord, IsWhatASlipOfTypingMeant) {
  EXPECT_EQ(nearest_word("pln", kKnown), "plan");
  EXPECT_EQ(nearest_word("audti", kKnown), "audit");
  EXPECT_EQ(nearest_word("regres", kKnown), "regress");
  EXPECT_EQ(nearest_word("plan", kKnown), "plan");
}

TEST(NearestWord, IsNoneWhereAllAreFarOff) {
  EXPECT_FALSE(nearest_word("x", kKnown));
  EXPECT_FALSE(nearest_word("fly", kKnown));
  EXPECT_FALSE(nearest_word("frobnicate", kKnown));
  EXPECT_FALSE(nearest_word(std::string(1000, 'p'), kKnown));
  EXPECT_FALSE(nearest_word("plan", {}));
}

TEST(Plural, OfOneIsTheNoun) {
  EXPECT_EQ(plural(1, "waypoint"), "1 waypoint");
  EXPECT_EQ(plural(0, "box"), "0 boxes");
  EXPECT_EQ(plural(2, "stretch"), "2 stretches");
  EXPECT_EQ(plural(2, "path"), "2 paths");
}

}  // namespace
}  // namespace taut
