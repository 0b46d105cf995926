// SPDX-License-Identifier: GPL-3.0-or-later
// `taut audit`: its arguments, what it writes and what it says (docs/audits.md).
#pragma once

#include <CLI/CLI.hpp>
#include <filesystem>
#include <string>

#include "app/headroom.h"
#include "app/recheck.h"
#include "cli/result_folder.h"

namespace taut {

struct AuditArguments {
  std::string case_path;
  std::string path;  ///< empty: the case's
  std::string law;   ///< empty: the file's own
  std::string out;
  std::string step;  ///< of controller.csv; empty: none is written
  bool timed = false;
  std::string rounding;  ///< of a table's rows; empty: the case's
  std::string key;       ///< file of the private key that signs, or empty
  long bits = 4096;      ///< of the prover's last rung
  bool json = false;
  bool no_report = false;
  double max_seconds = kCheckSeconds;          ///< that the checker may take
  double headroom_seconds = kHeadroomSeconds;  ///< for finding provable shares
};

void add_audit_options(CLI::App& command, AuditArguments& arguments);

/// The folder of the results of auditing the file `path`, made if need be; none of them may take the place of what is
/// read.
[[nodiscard]] std::filesystem::path audit_folder(const AuditArguments& arguments, const std::string& path,
                                                 const ResultInputs& inputs);

/// @returns the exit code. @throws InputError
[[nodiscard]] int run_audit(const AuditArguments& arguments);

}  // namespace taut
