// SPDX-License-Identifier: GPL-3.0-or-later
// taut formal: a proved certificate as a theorem that Coq's kernel checks.
#pragma once

#include <CLI/CLI.hpp>
#include <string>

#include "app/recheck.h"

namespace taut {

struct FormalArguments {
  std::string certificate_path;
  std::string out;      ///< empty: beside the certificate, with its name and .v
  std::string boxes;    ///< file for taut-verify; empty: none
  std::string library;  ///< folder of formal/build's results; empty: where taut was built or installed
  double max_seconds = kCheckSeconds;
  bool fast = false;
  bool no_coq = false;
};

void add_formal_options(CLI::App& command, FormalArguments& arguments);

[[nodiscard]] int run_formal(const FormalArguments& arguments);

}  // namespace taut
