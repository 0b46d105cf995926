// SPDX-License-Identifier: GPL-3.0-or-later
#include "reports/summary/file_lines.h"

#include <gtest/gtest.h>

#include <nlohmann/json.hpp>

namespace taut {
namespace {

using nlohmann::json;

FileLines lines(const std::vector<std::size_t>& of_waypoints) {
  FileLines result;
  for (const std::size_t line : of_waypoints) result.add(line);
  return result;
}

TEST(FileLines, TellTheLineOfEachWaypoint) {
  const std::vector<std::size_t> expected = {2, 3, 4, 7, 8, 8, 20};
  const FileLines written = lines(expected);
  const FileLines read(written.to_json());
  for (std::size_t k = 0; k < expected.size(); ++k) {
    EXPECT_EQ(written.line_of(k), expected[k]) << k;
    EXPECT_EQ(read.line_of(k), expected[k]) << k;
  }
  EXPECT_FALSE(read.line_of(7));
}

TEST(FileLines, AreShortWhereLinesFollowEachOther) {
  EXPECT_EQ(lines({2, 3, 4, 7, 8}).to_json(), json::parse(R"({"runs": [[0, 2], [3, 7]], "waypoints": 5})"));
}

TEST(FileLines, AreKnownUpToAPlaceWhereTheFileHasVeryManyGaps) {
  FileLines gaps;
  for (std::size_t k = 0; k < 30'000; ++k) gaps.add(2 * k);
  EXPECT_EQ(gaps.line_of(9'999), 19'998u);
  EXPECT_FALSE(gaps.line_of(10'000));
  EXPECT_FALSE(gaps.line_of(29'999));
}

TEST(FileLines, OfAnotherFormSayNothing) {
  for (const char* text : {"null", "[]", "{}", R"({"runs": 1, "waypoints": 5})",
                           R"({"runs": [[0, -2]], "waypoints": 5})", R"({"runs": [[0, 2, 3]], "waypoints": 5})",
                           R"({"runs": [[3, 2], [3, 4]], "waypoints": 5})", R"({"runs": [[0, 2]], "waypoints": "5"})",
                           R"({"runs": [["0", 2]], "waypoints": 5})", R"({"runs": [[0, 2]]})"}) {
    EXPECT_FALSE(FileLines(json::parse(text)).line_of(0)) << text;
  }
  EXPECT_FALSE(FileLines(json::parse(R"({"runs": [[3, 2]], "waypoints": 5})")).line_of(2));
}

}  // namespace
}  // namespace taut
