// SPDX-License-Identifier: GPL-3.0-or-later
// Plans a case, and has the checker prove the certificate of the plan.
#pragma once

#include <functional>
#include <limits>
#include <optional>
#include <stop_token>
#include <string>
#include <vector>

#include "app/as_items.h"
#include "app/headroom.h"
#include "app/no_path.h"
#include "app/recheck.h"
#include "certificate/signature.h"
#include "planner/planner.h"

namespace taut {

/// A check for load_case(): that there is something to plan.
/// @throws InputError where there is not.
void require_plannable(const Case& the_case);

/// For what is about moves. @param option  how the user asked for it @throws InputError where the case has no limits in
/// time.
void require_limits_in_time(const Case& the_case, const std::string& option);

/// What growing an atlas to the case's max_charts may cost, from the first charts; it may end before.
struct GrowthEstimate {
  int most_charts = 0;
  double seconds = 0;
  double file_bytes = 0;
};

/// What growing an atlas came to. A chart is complete if everything around it was looked at.
struct Growth {
  int charts = 0;
  int complete_charts = 0;
  double seconds = 0;
  bool time_is_up = false;
  [[nodiscard]] bool is_whole() const { return charts > 0 && complete_charts == charts; }
};

struct PlannedCase {
  Plan plan;
  std::optional<Growth> growth;          ///< where it was asked for
  std::optional<Headroom> headroom;      ///< where it was sought
  std::optional<AsItems> as_items;       ///< of an ellipsoid around items, where headroom was sought
  std::optional<NoPathAttempt> no_path;  ///< where the search found no path, and a proof that there is none was tried
  std::string text;                      ///< of certificate.json
  checker::CheckResult checked;          ///< what the checker says of it: the verdict
};

struct PlannedCaseOptions {
  bool grow = false;                                              ///< the atlas, before it is drawn and stored
  const SigningKey* key = nullptr;                                ///< null: the certificate is not signed
  double max_seconds = kCheckSeconds;                             ///< that the checker may take
  double grow_seconds = std::numeric_limits<double>::infinity();  ///< that growing the atlas may take
  /// Called once while the atlas grows, unless that ends at once.
  std::function<void(const GrowthEstimate&)> announce_growth{};
  double headroom_seconds = kHeadroomSeconds;  ///< that find_headroom() may take; 0: it is not sought
  HeadroomProgress headroom_progress = {};
  /// That proving that no path exists may take where the search found none; 0: it is not tried.
  double no_path_seconds = 0;
  MoveRequest move = {};   ///< of a case with limits in time
  bool is_checked = true;  ///< off: `checked` is left as it is
};

/// Plans, proves and has the checker prove the certificate again. Asked to stop before it is done with planning, it
/// still has the best path so far checked. Where the search found no path and it is proved that there is none, text and
/// verdict are those of that proof.
/// @throws as Planner::plan(); std::logic_error where the checker rejects the certificate.
[[nodiscard]] PlannedCase plan_case(const Case& the_case, Planner& planner, const PlannedCaseOptions& options,
                                    const Progress& progress, const std::stop_token& stop);

}  // namespace taut
