// SPDX-License-Identifier: GPL-3.0-or-later
// The topics of a lift plan as ASME P30.1-2014 names them for critical lifts, what this report says about each, and
// what somebody else has to fill in. Topics only: the standard's requirements are in the standard.
#pragma once

#include <nlohmann/json_fwd.hpp>
#include <string>
#include <vector>

#include "reports/summary/scene.h"

namespace taut {

struct Summary;

struct LiftPlanItem {
  const char* key;     ///< for machines: "load_weight"
  const char* group;   ///< the part of the plan: "The load"
  const char* topic;   ///< "Weight"
  std::string filled;  ///< what this report says of it; empty: nothing
  std::string open;    ///< what is left for others, and for whom; empty: nothing
};

/// Topics in the order of the standard. Bounds of tensions and lengths are filled in only where the whole move is
/// proved; text of the case is marked as such.
[[nodiscard]] std::vector<LiftPlanItem> lift_plan(const ReportContext& scene, const Summary& summary);

/// The key `lift_plan` of docs/report.md.
[[nodiscard]] nlohmann::json to_json(const std::vector<LiftPlanItem>& items);

}  // namespace taut
