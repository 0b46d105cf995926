// SPDX-License-Identifier: GPL-3.0-or-later
// `taut regress`: its arguments and what it says (docs/regress.md).
#pragma once

#include <CLI/CLI.hpp>
#include <string>

#include "cli/parts_options.h"
#include "cli/regress.h"

namespace taut {

struct RegressArguments {
  std::string folder;
  std::string junit;
  std::string baseline;
  bool update = false;
  double tolerance = 0.05;
  RegressOptions options;
  std::string out;
  double budget = 0;  ///< 0: each case's own
  bool json = false;
  PartsArguments parts;
};

void add_regress_options(CLI::App& command, RegressArguments& arguments);

/// @returns 0 where every case is as declared, 1 where one differs, 3 where one is bad input, 4 where one had no
/// result.
/// @throws InputError
[[nodiscard]] int run_regress(const RegressArguments& arguments);

}  // namespace taut
