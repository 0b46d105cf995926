// SPDX-License-Identifier: GPL-3.0-or-later
// taut monitor: holds measurements to a certificate, line by line, while its move is executed.
#pragma once

#include <CLI/CLI.hpp>
#include <string>

#include "app/recheck.h"

namespace taut {

struct MonitorArguments {
  std::string certificate_path;
  std::string measurements = "-";  ///< a file or a pipe; "-": standard input
  /// Errors of gauges with their units, or in SI units; empty: 0.
  std::string length_error, tension_error, position_error, orientation_error, time_error;
  double max_seconds = kCheckSeconds;  ///< that the checker may take
  bool json = false;
};

void add_monitor_options(CLI::App& command, MonitorArguments& arguments);

/// @returns the exit code: 0 if all rows are good, 1 if there was an alarm or the certificate was rejected, 2 if the
/// certificate was not checked within the budget, or somebody asked to stop, 3 if there was no alarm and a line could
/// not be read. @throws as main expects.
[[nodiscard]] int run_monitor(const MonitorArguments& arguments);

}  // namespace taut
