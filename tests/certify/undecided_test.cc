// SPDX-License-Identifier: GPL-3.0-or-later
// The table of reasons, and that whatever says one has its code.
#include "certify/undecided.h"

#include <gtest/gtest.h>

#include <set>
#include <type_traits>
#include <vector>

namespace taut {
namespace {

TEST(Undecided, EachReasonHasWordsOfItsOwnThatTellIt) {
  std::set<std::string> seen;
  for (std::size_t k = 0; k < kUndecidedReasons; ++k) {
    const auto reason = static_cast<Undecided>(k);
    const UndecidedWords said = words(reason);
    ASSERT_NE(std::string(said.words), "") << k;
    EXPECT_TRUE(seen.insert(said.words).second) << said.words;
    EXPECT_EQ(undecided_reason(std::string("waypoint 3: ") + said.words + " margin"), reason) << said.words;
    if (said.at_pose != nullptr) {
      EXPECT_EQ(undecided_reason(said.at_pose), reason) << said.at_pose;
    }
    EXPECT_EQ(code(reason), "U" + std::to_string(k + 1));
  }
  EXPECT_EQ(std::string(words(static_cast<Undecided>(kUndecidedReasons)).words), "")
      << "kUndecidedReasons counts them all";
}

/// A prover can only tell a Reason, and a Reason can't be made of a text alone.
TEST(Undecided, WhateverIsToldHasItsCode) {
  static_assert(!std::is_convertible_v<std::string, Reason> && !std::is_constructible_v<Reason, std::string>);
  static_assert(!std::is_constructible_v<Reason, const char*> &&
                !std::is_constructible_v<Reason, std::string, std::string>);
  for (std::size_t k = 0; k < kUndecidedReasons; ++k) {
    const auto reason = static_cast<Undecided>(k);
    std::vector<Reason> told = {reason, {reason, " margin length_min of cable 1: it is zero"}};
    if (words(reason).at_pose != nullptr) {
      told.push_back(Reason::at_pose(reason));
      told.push_back(Reason::at_pose(reason, ": px is 1.7"));
    }
    const std::size_t plain = told.size();
    for (std::size_t i = 0; i < plain; ++i) told.push_back(told[i].preceded_by("waypoint 3 of the query: "));
    for (const Reason& text : told) {
      EXPECT_EQ(undecided_reason(text.text()), reason) << text;
      EXPECT_EQ(with_code(text.text()), text.text() + " [" + code(reason) + "]");
    }
  }
  EXPECT_TRUE(Reason().empty());
  EXPECT_FALSE(Reason(Undecided::kDepth).empty());
}

TEST(Undecided, WhatIsNoneOfOursHasNoCode) {
  EXPECT_FALSE(undecided_reason("because"));
  EXPECT_EQ(with_code("because"), "because");
  EXPECT_EQ(with_code("the path has no segment"), "the path has no segment [U12]");
}

}  // namespace
}  // namespace taut
