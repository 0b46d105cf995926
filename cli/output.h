// SPDX-License-Identifier: GPL-3.0-or-later
// What commands print with --json, where it is the same for all of them (docs/json.md, docs/output.schema.json).
#pragma once

#include <chrono>
#include <filesystem>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "base/input_error.h"
#include "checker/check.h"

namespace taut {

/// Wall-clock time since it was made.
class Stopwatch {
 public:
  [[nodiscard]] double seconds() const;

 private:
  std::chrono::steady_clock::time_point begin_ = std::chrono::steady_clock::now();
};

/// A JSON document in ASCII, with a line end.
[[nodiscard]] std::string json_text(const nlohmann::json& document);
/// Prints one JSON document to standard output.
void print_json(const nlohmann::json& document);

/// {"code", "text"}: a message, with the code that it ends with ("… there [U5]") taken from it; else a null code.
[[nodiscard]] nlohmann::json message_json(const std::string& text);
/// The non-empty ones of these messages, sanitised.
[[nodiscard]] nlohmann::json messages_json(const std::vector<std::string>& texts);

/// "verdict", "margins", "witness" and "undecided", as the checker proved or read them.
[[nodiscard]] nlohmann::json result_json(const checker::CheckResult& checked);

/// "elapsed_seconds", "exit_code" and "files" of a command that came to its end.
void add_ending(nlohmann::json& document, const Stopwatch& stopwatch, int exit_code,
                const std::vector<std::filesystem::path>& files);

/// What a command prints instead of its result where it failed: "error", "exit_code".
[[nodiscard]] nlohmann::json error_json(const std::string& command, const std::string& message, const std::string& code,
                                        int exit_code, const InputPlace& place);

/// Says that a command was interrupted, on stderr and, if wanted, as JSON. @returns kUndecidedExit
[[nodiscard]] int report_interruption(const std::string& command, const std::string& message, bool as_json);

}  // namespace taut
