// SPDX-License-Identifier: GPL-3.0-or-later
// `taut init`: a commented case to begin from, or a case made from another program's robot.
#pragma once

#include <CLI/CLI.hpp>
#include <string>

namespace taut {

struct InitArguments {
  std::string path;  ///< the case file to write
  std::string from;  ///< "caspr:PATH", or empty
  std::string units;
  std::string bodies;
  std::string cable_set;
};

void add_init_options(CLI::App& command, InitArguments& arguments);

/// The case's text (cli/new_case.yaml), by that name; it plans and is proved as it stands.
/// @pre name is what read_name() of a case file takes, and plain YAML
[[nodiscard]] std::string new_case(const std::string& name);

/// Writes it, or the case made from another program's robot, named after the file. @returns the exit code.
/// @throws InputError where the file exists or can't be written, or where the robot is wrong.
[[nodiscard]] int run_init(const InitArguments& arguments);

}  // namespace taut
