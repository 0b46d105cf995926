// SPDX-License-Identifier: GPL-3.0-or-later
// taut sensitivity: what to change in a case so that its path is proved.
#pragma once

#include <CLI/CLI.hpp>
#include <string>

namespace taut {

struct SensitivityArguments {
  std::string case_path;
  std::string audit;  ///< path file; empty: the case is planned, or its own `audit` is taken
  std::string law;    ///< empty: the file's own
  double seconds = 60;
  std::size_t rows = 12;
  bool json = false;
};

void add_sensitivity_options(CLI::App& command, SensitivityArguments& arguments);

[[nodiscard]] int run_sensitivity(const SensitivityArguments& arguments);

}  // namespace taut
