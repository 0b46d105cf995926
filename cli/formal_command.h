// SPDX-License-Identifier: GPL-3.0-or-later
// taut formal: a proved certificate as a theorem that Coq's kernel checks.
#pragma once

#include <CLI/CLI.hpp>
#include <string>

namespace taut {

struct FormalArguments {
  std::string certificate_path;
  std::string out;  ///< empty: the certificate's name with .v
  bool fast = false;
  bool exact = false;
  bool no_coq = false;
};

void add_formal_options(CLI::App& command, FormalArguments& arguments);

[[nodiscard]] int run_formal(const FormalArguments& arguments);

}  // namespace taut
