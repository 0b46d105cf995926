// SPDX-License-Identifier: GPL-3.0-or-later
// What `taut plan` says of one path that was planned, and the files that it writes of it.
#pragma once

#include <filesystem>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <vector>

#include "app/plan.h"
#include "base/files.h"
#include "cli/console.h"
#include "path_io/controller_csv.h"
#include "path_io/move_tables.h"
#include "reports/summary/report_options.h"
#include "reports/summary/scene.h"

namespace taut {

/// What there is to say once all is written.
struct PlanOutcome {
  const PlannedCase& planned;
  MotionLengths lengths{};  ///< only if proved
  std::filesystem::path out;

  [[nodiscard]] bool is_proved() const { return exit_code(planned.checked) == kProvedExit; }
};

/// A verdict in lower case, as scripts know it, and what is said of it.
struct Said {
  std::string verdict;
  std::string text;
};

[[nodiscard]] bool is_no_path(const PlannedCase& planned);
[[nodiscard]] Said said(const Case& the_case, const PlannedCase& planned);

/// What may be wrong with the case, if its first infeasible waypoint suggests it; else empty.
[[nodiscard]] std::string hint(const Case& the_case, const Plan& plan);

/// All that `--json` prints but its ending.
[[nodiscard]] nlohmann::json plan_json(const Case& the_case, const PlanOutcome& outcome);

/// For a progress line: "planning: 12 charts".
[[nodiscard]] std::string plan_progress_text(const PlanProgress& at);

/// Prints hint(), and of a move that is proved how long it takes and how fast it might be.
void print_remarks(const Case& the_case, const PlanOutcome& outcome);

/// Prints everything but the files.
/// @param context  none where no path exists
void print_result(const Case& the_case, const PlanOutcome& outcome, const std::optional<ReportContext>& context,
                  const ReportOptions& report_options);

void add_move_tables(const std::filesystem::path& out, MoveTables tables, std::vector<FileContent>& files);

/// The tables of a proved path, path.csv as the last; none of another one.
[[nodiscard]] std::vector<FileContent> plan_files(const Case& the_case, const PlanOutcome& outcome,
                                                  const ControllerStep& step);

}  // namespace taut
