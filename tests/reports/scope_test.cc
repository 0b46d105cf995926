// SPDX-License-Identifier: GPL-3.0-or-later
#include "reports/summary/scope.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <fstream>
#include <set>
#include <sstream>

#include "reports/page/sections.h"
#include "reports/summary/summary.h"
#include "tests/reports/sample_certificates.h"

namespace taut {
namespace {

using ::testing::HasSubstr;
using ::testing::Not;

std::string without_line_ends(const std::string& file) {
  std::ifstream stream(std::string(TAUT_SOURCE_DIR) + "/" + file);
  std::ostringstream text;
  std::string word;
  while (stream >> word) text << word << " ";
  return text.str();
}

Problem problem(bool with_tolerances, bool holds_lengths = false) {
  Problem result = sample::scene(sample::proved()).certificate.problem;
  if (with_tolerances) result.tolerances.emplace();
  if (holds_lengths) result.tolerances->cable_length_m.emplace().fill("0");
  return result;
}

TEST(Scope, IsOneListInSectionAndSummary) {
  const ReportContext scene = sample::scene(sample::proved());
  const Problem& stated = scene.certificate.problem;
  const std::string section = assumptions(scene.certificate).str();
  const std::string text = to_text(Summary(scene, {}));
  std::vector<ScopeItem> items = assumed(stated, scene.certificate.path.interpolation);
  std::ranges::copy(not_covered(stated), std::back_inserter(items));
  EXPECT_EQ(items.size(), 15U);
  std::set<std::string> briefs;
  for (const ScopeItem& item : items) {
    EXPECT_THAT(section, HasSubstr("<li>" + item.text + "</li>")) << item.key;
    EXPECT_THAT(text, HasSubstr(item.text)) << item.key;
    EXPECT_FALSE(item.brief.empty()) << item.key;
    briefs.insert(item.brief);
  }
  EXPECT_EQ(briefs.size(), items.size());
  for (const ScopeItem& item : not_covered(stated)) EXPECT_FALSE(item.goal.empty()) << item.key;
}

TEST(Scope, IsTheListOfTheTheory) {
  const std::string theory = without_line_ends("docs/theory.md");
  for (const Problem& stated : {problem(false), problem(true), problem(true, true)}) {
    for (const ScopeItem& item : assumed(stated, Interpolation::kStraight)) {
      if (std::string(item.key) == "control") continue;  // is written there for all machines at once
      EXPECT_THAT(theory, HasSubstr(item.text)) << item.key;
    }
    for (const ScopeItem& item : not_covered(stated)) {
      if (std::string(item.key) == "errors") continue;  // is written there for the model, not for a machine
      EXPECT_THAT(theory, HasSubstr(item.text)) << item.key;
    }
  }
}

TEST(Scope, OfMovesIsThatOfTheTheoryWithRowsAndWithout) {
  const std::string theory = without_line_ends("docs/theory.md");
  Problem stated = sample::timed().problem;
  const auto text = [&](const std::vector<ScopeItem>& items, const char* key) {
    return std::ranges::find(items, std::string(key), &ScopeItem::key)->text;
  };
  const std::string drives = text(not_covered(stated, true), "drives");
  EXPECT_THAT(theory, HasSubstr(drives));
  EXPECT_THAT(drives, HasSubstr("between the rows of a table"));
  stated.tolerances.emplace();
  stated.time->rows.emplace();
  EXPECT_THAT(theory, HasSubstr(text(not_covered(stated, true), "drives")));
  EXPECT_THAT(text(not_covered(stated, true), "drives"), HasSubstr("jumps of speed at the rows"));
  EXPECT_THAT(theory, HasSubstr(text(assumed(stated, Interpolation::kStraight, true), "control")));
}

TEST(Scope, SaysWhoHasToFollowThePathAndHowWell) {
  const auto control = [](const Problem& stated, Interpolation law) {
    const std::vector<ScopeItem> items = assumed(stated, law);
    return std::ranges::find(items, std::string("control"), &ScopeItem::key)->text;
  };
  EXPECT_THAT(control(problem(false), Interpolation::kStraight), HasSubstr("controller follows the path"));
  EXPECT_THAT(control(problem(false), Interpolation::kStraight), HasSubstr(", exactly."));
  EXPECT_THAT(control(problem(true), Interpolation::kStraight), HasSubstr("within the stated tolerances."));
  EXPECT_THAT(control(problem(true, true), Interpolation::kStraight), HasSubstr("winches hold the lengths"));
  EXPECT_THAT(control(problem(false), Interpolation::kCableLengths), HasSubstr("winches hold the lengths"));
}

TEST(Scope, CoversErrorsAsFarAsTolerancesAreStated) {
  EXPECT_THAT(in_full(not_covered(problem(true))), HasSubstr("control beyond the stated tolerances;"));
  EXPECT_THAT(in_full(not_covered(problem(false))), Not(HasSubstr("beyond the stated tolerances")));
}

}  // namespace
}  // namespace taut
