// SPDX-License-Identifier: GPL-3.0-or-later
// What there is to say of a certificate that no path exists, in the case's units: for its page and its other forms.
#pragma once

#include <string>
#include <vector>

#include "checker/check.h"
#include "reports/page/map_axis.h"
#include "reports/summary/illustration.h"
#include "reports/summary/load_statement.h"
#include "reports/summary/report_options.h"
#include "reports/summary/scene.h"
#include "reports/summary/scope.h"
#include "reports/summary/sentences.h"

namespace taut {

/// The certificate's problem, start and goal. Words about the verdict are there only where the checker made a theorem.
struct NoPathContent {
  /// @pre is_about_no_path() (no_path_page.h), and the checker rejected nothing
  NoPathContent(const checker::CheckResult& checked, const ReportOptions& options);

  [[nodiscard]] bool is_proved() const { return checked.theorem.has_value(); }
  [[nodiscard]] const nlohmann::json& certificate() const { return *checked.certificate; }

  const checker::CheckResult& checked;
  ReportContext scene;  ///< start and goal as a path without a claim, for pictures and tables
  std::size_t from;     ///< the waypoint of the query at which motions start; they would end at the next
  MapSpace space;
  std::vector<ShownAxis> axes;
  DocumentFields fields;
  std::string document, revision, date;  ///< empty where not known
  std::string title;                     ///< as the case states it, else made from its name
  std::string word;                      ///< "NO PATH EXISTS" or "UNCHECKED"
  std::string headline;
  LoadStatement load;
  std::vector<Statement> statements;  ///< move, space, limits, tolerances, re-check
  std::vector<ScopeItem> assumed, not_covered;
};

}  // namespace taut
