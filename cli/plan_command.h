// SPDX-License-Identifier: GPL-3.0-or-later
// `taut plan`: its arguments, what it writes and what it says.
#pragma once

#include <CLI/CLI.hpp>
#include <optional>
#include <string>

#include "app/headroom.h"
#include "app/no_path.h"
#include "app/recheck.h"
#include "path_io/controller_csv.h"

namespace taut {

struct PlanArguments {
  std::string case_path;
  std::string out;
  std::string atlas;
  std::string save_atlas;
  std::string step = ControllerStep().text;  ///< of controller.csv
  std::string key;                           ///< file of the private key that signs, or empty
  bool grow = false;
  double grow_seconds = 300;         ///< that growing the atlas may take
  double budget_seconds = 0;         ///< 0: the case's
  bool timed = false;                ///< the case has to state limits in time
  std::optional<std::string> speed;  ///< share of the planned speed, as typed
  bool max_speed = false;            ///< how fast the move could be run
  bool json = false;
  bool no_report = false;
  double max_seconds = kCheckSeconds;          ///< that the checker may take
  double headroom_seconds = kHeadroomSeconds;  ///< for finding provable shares
  double no_path_seconds = kNoPathSeconds;     ///< for proving that no path exists
};

void add_plan_options(CLI::App& command, PlanArguments& arguments);

/// @returns the exit code. @throws InputError
[[nodiscard]] int run_plan(const PlanArguments& arguments);

}  // namespace taut
