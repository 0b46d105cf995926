// SPDX-License-Identifier: GPL-3.0-or-later
#include "reports/summary/assurance_case.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <map>
#include <nlohmann/json.hpp>

#include "reports/page/assurance_drawing.h"
#include "reports/summary/scope.h"
#include "tests/reports/sample_certificates.h"

namespace taut {
namespace {

using ::testing::HasSubstr;
using ::testing::Not;
using Kind = AssuranceNode::Kind;

std::vector<AssuranceNode> nodes_of(const nlohmann::json& certificate) {
  return assurance_case(sample::scene(certificate), "Turn in place");
}

std::vector<std::string> texts(const std::vector<AssuranceNode>& nodes, auto is_wanted) {
  std::vector<std::string> result;
  for (const AssuranceNode& node : nodes) {
    if (is_wanted(node)) result.push_back(node.text);
  }
  return result;
}

TEST(AssuranceCase, IsATreeFromTheTopGoal) {
  const std::vector<AssuranceNode> nodes = nodes_of(sample::proved());
  ASSERT_FALSE(nodes.empty());
  EXPECT_EQ(nodes.front().id, "G1");
  EXPECT_THAT(nodes.front().text, HasSubstr("Turn in place"));
  std::map<std::string, int> mentions;
  std::map<std::string, Kind> kinds;
  for (const AssuranceNode& node : nodes) {
    EXPECT_TRUE(kinds.emplace(node.id, node.kind).second) << node.id << " twice";
    for (const std::string& id : node.supported_by) ++mentions[id];
    for (const std::string& id : node.in_context_of) ++mentions[id];
  }
  for (const AssuranceNode& node : nodes) EXPECT_EQ(mentions[node.id], node.id == "G1" ? 0 : 1) << node.id;
  EXPECT_EQ(mentions.size(), nodes.size()) << "all that is mentioned is there";
}

TEST(AssuranceCase, KeepsTheRulesOfTheNotation) {
  const std::vector<AssuranceNode> nodes = nodes_of(sample::proved());
  const auto kind = [&](const std::string& id) { return std::ranges::find(nodes, id, &AssuranceNode::id)->kind; };
  for (const AssuranceNode& node : nodes) {
    const bool may_be_supported = node.kind == Kind::kGoal || node.kind == Kind::kStrategy;
    EXPECT_EQ(!node.supported_by.empty(), may_be_supported && !node.is_undeveloped) << node.id;
    for (const std::string& id : node.supported_by) {
      const bool is_right = kind(id) == Kind::kGoal || (node.kind == Kind::kGoal && kind(id) != Kind::kContext);
      EXPECT_TRUE(is_right) << node.id << " by " << id;
    }
    for (const std::string& id : node.in_context_of) {
      EXPECT_TRUE(kind(id) == Kind::kContext || kind(id) == Kind::kAssumption || kind(id) == Kind::kJustification);
      EXPECT_TRUE(may_be_supported) << node.id;
    }
    const std::map<Kind, std::string> letters = {{Kind::kGoal, "G"},       {Kind::kStrategy, "S"},
                                                 {Kind::kSolution, "Sn"},  {Kind::kContext, "C"},
                                                 {Kind::kAssumption, "A"}, {Kind::kJustification, "J"}};
    EXPECT_TRUE(node.id.starts_with(letters.at(node.kind))) << node.id;
  }
}

TEST(AssuranceCase, LeavesToOthersWhatIsNotCoveredAndAssumesWhatIsAssumed) {
  const ReportContext scene = sample::scene(sample::proved());
  const std::vector<AssuranceNode> nodes = assurance_case(scene, "t");
  std::vector<std::string> goals, assumptions;
  for (const ScopeItem& item : not_covered(scene.certificate.problem)) goals.push_back(item.goal);
  for (const ScopeItem& item : assumed(scene.certificate.problem, scene.certificate.path.interpolation)) {
    assumptions.push_back(item.text);
  }
  EXPECT_EQ(texts(nodes, [](const AssuranceNode& node) { return node.is_undeveloped; }), goals);
  EXPECT_EQ(texts(nodes, [](const AssuranceNode& node) { return node.kind == Kind::kAssumption; }), assumptions);
}

TEST(AssuranceCase, NamesItsEvidence) {
  const std::vector<std::string> evidence =
      texts(nodes_of(sample::proved()), [](const AssuranceNode& node) { return node.kind == Kind::kSolution; });
  ASSERT_EQ(evidence.size(), 2U);
  EXPECT_THAT(evidence[0], HasSubstr(sample::kFooterDigest));
  EXPECT_THAT(evidence[1], HasSubstr("proved the certificate again"));
}

TEST(AssuranceCase, IsNoneOfWhatIsNotProved) {
  for (const nlohmann::json& certificate :
       {sample::refuted(), sample::singular(), sample::undecided(), sample::no_path()}) {
    EXPECT_TRUE(nodes_of(certificate).empty());
    const ReportContext scene = sample::scene(certificate);
    const Summary summary(scene, {});
    EXPECT_THAT(assurance_section(scene, summary).str(), HasSubstr("There is no assurance case for this move"));
    EXPECT_TRUE(to_json(summary)["assurance_case"].is_null());
  }
  const ReportContext unchecked = sample::unchecked(sample::proved());
  EXPECT_TRUE(assurance_case(unchecked, "t").empty());
  EXPECT_THAT(assurance_section(unchecked, Summary(unchecked, {})).str(), HasSubstr("was not checked"));
}

TEST(AssuranceCase, IsDrawnWithOneShapeForEachNode) {
  nlohmann::json certificate = sample::proved();
  certificate["illustration"]["document_fields"] = {{"title", "<b>" + std::string(110, 'W') + " & ende"}};
  const ReportContext scene = sample::scene(certificate);
  const Summary summary(scene, {});
  const std::string drawing = assurance_drawing(summary.assurance_case).str();
  const auto count = [&](const std::string& what) {
    std::size_t result = 0;
    for (std::size_t at = drawing.find(what); at != std::string::npos; at = drawing.find(what, at + 1)) ++result;
    return result;
  };
  EXPECT_EQ(count("<g class="), summary.assurance_case.size() + 1) << "the claim is in both figures";
  EXPECT_EQ(count("<ellipse"), 9U);  // 7 assumptions and 2 justifications
  EXPECT_EQ(count("<circle"), 2U);
  EXPECT_EQ(count("class=\"open\""), 8U);
  EXPECT_THAT(drawing, HasSubstr("&lt;b&gt;"));
  EXPECT_THAT(drawing, Not(HasSubstr("<b>")));
  const std::string page = assurance_section(scene, summary).str();
  for (const AssuranceNode& node : summary.assurance_case) EXPECT_THAT(page, HasSubstr("<b>" + node.id + "</b>"));
}

}  // namespace
}  // namespace taut
