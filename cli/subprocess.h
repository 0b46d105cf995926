// SPDX-License-Identifier: GPL-3.0-or-later
// Programs that taut starts: without a shell, and never left behind.
#pragma once

#include <optional>
#include <stop_token>
#include <string>
#include <vector>

namespace taut {

struct FinishedProgram {
  int exit_code = 0;         ///< 128 + the signal, where one ended it
  bool timed_out = false;    ///< ended because its time was over
  bool interrupted = false;  ///< ended because of a stop request
  std::string out, err;      ///< what it wrote to its standard output and error
  double seconds = 0;
};

/// Runs a program to its end, with nothing on its standard input. It is asked to end (SIGTERM), and a little later made
/// to, on a stop request or when `most_seconds` have passed. Thread-safe.
/// @param command  program, looked for in PATH unless it contains a slash, and arguments
/// @throws InputError where it can't be started.
[[nodiscard]] FinishedProgram run_program(const std::vector<std::string>& command, const std::stop_token& stop,
                                          std::optional<double> most_seconds = std::nullopt);

/// The path of the running program.
[[nodiscard]] std::string own_program();

/// taut-check: beside taut, where it was installed, else where it was built, else wherever PATH has it.
[[nodiscard]] std::string checker_program();

}  // namespace taut
