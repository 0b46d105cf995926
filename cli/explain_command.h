// SPDX-License-Identifier: GPL-3.0-or-later
// `taut explain`: what the short code behind a message means, what usually causes it and what to do. One table, of
// which docs/errors.md is a print.
#pragma once

#include <CLI/CLI.hpp>
#include <string>
#include <vector>

#include "base/input_error.h"

namespace taut {

inline constexpr const char* kInternalCode = "F1";
inline constexpr const char* kUntrustworthyCode = "F2";
inline constexpr const char* kBrowserFailedCode = "F3";

struct Explanation {
  std::string code;
  const char* title;    ///< what is wrong or open, in a few words
  const char* meaning;  ///< sentences
  const char* causes;
  const char* remedy;
  const char* example;  ///< a line that a program prints
};

/// All explanations: reasons of "undecided" (certify/undecided.h), kinds of wrong input, failures.
[[nodiscard]] const std::vector<Explanation>& explanations();

struct ExplainArguments {
  std::string code;  ///< or empty: all
  bool markdown = false;
};

void add_explain_options(CLI::App& command, ExplainArguments& arguments);

/// @returns the exit code. @throws InputError for a code that there isn't.
[[nodiscard]] int run_explain(const ExplainArguments& arguments);

}  // namespace taut
