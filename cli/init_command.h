// SPDX-License-Identifier: GPL-3.0-or-later
// `taut init`: a commented case to begin from.
#pragma once

#include <string>

namespace taut {

/// The case's text (cli/new_case.yaml), by that name; it plans and is proved as it stands.
/// @pre name is what read_name() of a case file takes, and plain YAML
[[nodiscard]] std::string new_case(const std::string& name);

/// Writes it, named after the file. @returns the exit code. @throws InputError where the file exists, or can't be
/// written.
[[nodiscard]] int run_init(const std::string& path);

}  // namespace taut
