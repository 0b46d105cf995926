// The table of reasons, and that what the prover says is found in it.
#include "certify/undecided.h"

#include <gtest/gtest.h>

#include <set>

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

TEST(Undecided, WhatIsNoneOfOursHasNoCode) {
  EXPECT_FALSE(undecided_reason("because"));
  EXPECT_EQ(with_code("because"), "because");
  EXPECT_EQ(with_code("the path has no segment"), "the path has no segment [U12]");
}

}  // namespace
}  // namespace taut
