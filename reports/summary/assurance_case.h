// SPDX-License-Identifier: GPL-3.0-or-later
// The assurance case of a certificate in Goal Structuring Notation: what is claimed, by which argument, on which
// evidence, under which assumptions, and what somebody else has to show before the move may be called safe.
#pragma once

#include <nlohmann/json_fwd.hpp>
#include <string>
#include <vector>

#include "reports/summary/scene.h"

namespace taut {

struct AssuranceNode {
  enum class Kind { kGoal, kStrategy, kSolution, kContext, kAssumption, kJustification };

  std::string id;  ///< "G1", "S1", "Sn1", "C1", "A1" or "J1"
  Kind kind = Kind::kGoal;
  bool is_undeveloped = false;               ///< a goal that this argument leaves to others
  std::string text;                          ///< whole sentences
  std::string label;                         ///< the same in fewer words, for the drawing
  std::vector<std::string> supported_by{};   ///< ids
  std::vector<std::string> in_context_of{};  ///< ids
};

/// The nodes, the top goal first; none unless the checker confirmed that the move is proved.
/// @param title  of the move, for the top goal
[[nodiscard]] std::vector<AssuranceNode> assurance_case(const ReportContext& scene, const std::string& title);

/// "goal", "strategy", "solution", "context", "assumption" or "justification".
[[nodiscard]] const char* name(AssuranceNode::Kind kind);

/// The key `assurance_case` of docs/report.md; null where there are no nodes.
[[nodiscard]] nlohmann::json to_json(const std::vector<AssuranceNode>& nodes);

}  // namespace taut
