// SPDX-License-Identifier: GPL-3.0-or-later
// Checks of command-line arguments that taut and taut-check share.
#pragma once

#include <CLI/CLI.hpp>
#include <charconv>
#include <cmath>
#include <string>

namespace taut::checker {

/// Refuses an empty argument to any option of `app` or of its commands. An empty argument usually is a variable of a
/// script that was never set; to ignore it would be to do less than was asked for, such as not to sign.
inline void refuse_empty_arguments(CLI::App& app) {
  const auto complaint = [](const std::string& text) {
    return text.empty() ? std::string("got '', expected an argument that is not empty") : std::string();
  };
  for (CLI::Option* option : app.get_options()) {
    if (option->get_type_size() != 0) option->check(complaint);
  }
  for (CLI::App* command : app.get_subcommands({})) refuse_empty_arguments(*command);
}

/// A check for CLI::Option: a finite number of seconds, 0 or more.
inline std::string complain_of_seconds(const std::string& text) {
  double seconds = -1;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), seconds);
  const bool is_number = error == std::errc() && end == text.data() + text.size() && std::isfinite(seconds);
  return is_number && seconds >= 0 ? "" : "got '" + text + "', expected a number of seconds, 0 or more";
}

}  // namespace taut::checker
