// SPDX-License-Identifier: GPL-3.0-or-later
// taut report: a certificate for people, on a page, on paper or in a log.
#pragma once

#include <CLI/CLI.hpp>
#include <string>

#include "app/recheck.h"

namespace taut {

struct ReportArguments {
  std::string certificate_path;
  std::string out;
  bool pdf = false, text = false, markdown = false, json = false;  ///< at most one; none: HTML
  double max_seconds = kCheckSeconds;                              ///< that the checker may take
  std::string document, revision, date;
};

void add_report_options(CLI::App& command, ReportArguments& arguments);

/// @returns the exit code: 0, also of an undecided certificate; 1 where it was rejected, and nothing was written; 2
/// where it was not checked within the budget, or somebody asked to stop. @throws as main expects.
[[nodiscard]] int run_report(const ReportArguments& arguments);

}  // namespace taut
