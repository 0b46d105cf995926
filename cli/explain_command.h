// SPDX-License-Identifier: GPL-3.0-or-later
// `taut explain`: what the short code behind a message means (reports/summary/explanations.h).
#pragma once

#include <CLI/CLI.hpp>
#include <string>

namespace taut {

struct ExplainArguments {
  std::string code;  ///< or empty: all
  bool markdown = false;
};

void add_explain_options(CLI::App& command, ExplainArguments& arguments);

/// @returns the exit code. @throws InputError for a code that there isn't.
[[nodiscard]] int run_explain(const ExplainArguments& arguments);

}  // namespace taut
