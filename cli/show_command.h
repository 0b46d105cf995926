// SPDX-License-Identifier: GPL-3.0-or-later
// `taut show`: what a case was understood to say, and a drawing of the robot. Proves nothing.
#pragma once

#include <CLI/CLI.hpp>
#include <string>

namespace taut {

struct ShowArguments {
  std::string case_path;
  std::string out;  ///< SVG file to write, or empty
  bool json = false;
};

void add_show_options(CLI::App& command, ShowArguments& arguments);

/// @returns the exit code: 0, whatever becomes of the query. @throws InputError for a case that is wrong.
[[nodiscard]] int run_show(const ShowArguments& arguments);

}  // namespace taut
