// A plan, and the certificate that is handed out of it.
#pragma once

#include <nlohmann/json.hpp>
#include <optional>
#include <stop_token>
#include <string>
#include <vector>

#include "certificate/signature.h"
#include "certify/tolerance_limits.h"
#include "planner/planner.h"

namespace taut {

/// A check for load_case(): that there is something to plan.
void require_plannable(const Case& the_case);

/// The text of a file certificate.json.
[[nodiscard]] std::string certificate_text(const nlohmann::json& certificate);

struct PlannedCase {
  Plan plan;
  bool whole_atlas = false;                      ///< whether the atlas was grown until nothing was left
  std::vector<ToleranceLimit> tolerance_limits;  ///< where the path is proved and the case states tolerances
  nlohmann::json certificate;
};

struct PlannedCaseOptions {
  bool grow = false;                ///< the atlas, before it is drawn and stored
  const SigningKey* key = nullptr;  ///< null: the certificate is not signed
};

/// @throws as Planner::plan()
[[nodiscard]] PlannedCase plan_case(const Case& the_case, Planner& planner, const PlannedCaseOptions& options,
                                    const Progress& progress, const std::stop_token& stop);

}  // namespace taut
