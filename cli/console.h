// SPDX-License-Identifier: GPL-3.0-or-later
// What commands share: exit codes, interruption, a progress line, keys.
#pragma once

#include <CLI/CLI.hpp>
#include <chrono>
#include <optional>
#include <stop_token>
#include <string>
#include <string_view>
#include <thread>

#include "case/case_file.h"
#include "certificate/signature.h"
#include "checker/check.h"

namespace taut {

enum ExitCode { kProvedExit = 0, kRefutedExit = 1, kUndecidedExit = 2, kBadInputExit = 3, kInternalExit = 4 };

/// The exit code for what the checker says: proved or, for "no path" too, refuted where there is a theorem, else
/// undecided.
[[nodiscard]] ExitCode exit_code(const checker::CheckResult& checked);

/// "--max-seconds" of plan, audit and report: the checker's budget.
void add_max_seconds_option(CLI::App& command, double& max_seconds);

/// The key that signs certificates, if any was asked for. Warns where others than its owner may read it.
/// @throws InputError as SigningKey
[[nodiscard]] std::optional<SigningKey> load_signing_key(const std::string& path);

/// Writes "taut: MESSAGE" on a line of its own to stderr. Where that can't be written, nothing happens: a closed stderr
/// changes no exit code.
void complain(std::string_view message);

/// The case for a command that looks at poses alone: without limits in time and inertia, which it is warned of.
[[nodiscard]] Case at_rest(Case the_case);

/// print_problem(); and on stderr what may not be meant as it was typed. With `json`, on stderr only.
void announce(const Case& the_case, bool json);
/// Says on the screen what load was understood, its total and its extremes, which limits in time, and which bodies may
/// not touch.
void print_problem(const Case& the_case);

/// "\nA load that breaks the limit there: …", where the checker confirmed a witness that names one; else empty.
[[nodiscard]] std::string load_that_breaks(const LoadText& load, const checker::CheckResult& checked);

/// A line on stderr that overwrites itself, on a terminal only.
class ProgressLine {
 public:
  explicit ProgressLine(bool wanted);
  ~ProgressLine();
  ProgressLine(const ProgressLine&) = delete;
  ProgressLine& operator=(const ProgressLine&) = delete;
  /// Removes the line, so that something else may be printed.
  void clear();
  /// Calls `text()` and shows what it returns, ten times a second at most.
  template <class Text>
  void show(Text text) {
    if (is_due()) print(text());
  }

 private:
  [[nodiscard]] bool is_due();
  void print(const std::string& text);

  bool enabled_;
  bool shown_ = false;
  std::chrono::steady_clock::time_point last_;
};

/// Turns SIGINT, SIGTERM and SIGHUP into a stop request, which a signal handler may not make itself.
class Interruption {
 public:
  Interruption();
  [[nodiscard]] std::stop_token token() const { return source_.get_token(); }

 private:
  std::stop_source source_;
  std::jthread watcher_;  // last: joins before the rest goes
};

}  // namespace taut
