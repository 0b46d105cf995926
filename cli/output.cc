// SPDX-License-Identifier: GPL-3.0-or-later
#include "cli/output.h"

#include <fmt/format.h>

#include <cctype>

#include "app/recheck.h"
#include "base/sanitize.h"
#include "certify/undecided.h"
#include "cli/console.h"

namespace taut {

double Stopwatch::seconds() const {
  return std::chrono::duration<double>(std::chrono::steady_clock::now() - begin_).count();
}

std::string json_text(const nlohmann::json& document) {
  return document.dump(1, ' ', true, nlohmann::json::error_handler_t::replace) + "\n";
}

void print_json(const nlohmann::json& document) { fmt::print("{}", json_text(document)); }

nlohmann::json message_json(const std::string& text) {
  const std::size_t open = text.rfind(" [");
  const std::size_t close = text.rfind(']');
  const std::size_t begin = open + 2;
  const bool has_code = open != std::string::npos && close != std::string::npos && begin < close &&
                        close + 2 >= text.size() &&
                        std::string_view("UEF").find(text[begin]) != std::string_view::npos && begin + 1 < close &&
                        text.find_first_not_of("0123456789", begin + 1) == close;
  if (!has_code) return {{"code", nullptr}, {"text", text}};
  return {{"code", text.substr(begin, close - begin)}, {"text", text.substr(0, open)}};
}

nlohmann::json messages_json(const std::vector<std::string>& texts) {
  nlohmann::json list = nlohmann::json::array();
  for (const std::string& text : texts) {
    if (!text.empty()) list.push_back(message_json(sanitize(text)));
  }
  return list;
}

nlohmann::json result_json(const checker::CheckResult& checked) {
  const bool is_undecided = checked.outcome == checker::Outcome::kUndecided;
  const bool has_path = checked.theorem && checked.theorem->verdict() != checker::Theorem::Verdict::kNoPath;
  return {{"verdict", verdict_name(checked)},
          {"margins", has_path ? checked.theorem->margins() : nlohmann::json::object()},
          {"witness", has_path ? checked.theorem->witness() : nlohmann::json()},
          {"undecided", is_undecided ? checked.certificate->at("undecided") : nlohmann::json()},
          {"recheck", to_json(checked)}};
}

void add_ending(nlohmann::json& document, const Stopwatch& stopwatch, int exit_code,
                const std::vector<std::filesystem::path>& files) {
  document["elapsed_seconds"] = stopwatch.seconds();
  document["exit_code"] = exit_code;
  document["files"] = nlohmann::json::array();
  for (const std::filesystem::path& file : files) document["files"].push_back(file.string());
}

nlohmann::json error_json(const std::string& command, const std::string& message, const std::string& code,
                          int exit_code, const InputPlace& place) {
  const auto or_null = [](const std::string& text) { return text.empty() ? nlohmann::json() : nlohmann::json(text); };
  return {{"command", command},
          {"exit_code", exit_code},
          {"error",
           {{"code", code},
            {"text", message},
            {"file", or_null(place.file)},
            {"line", place.line == 0 ? nlohmann::json() : nlohmann::json(place.line)},
            {"field", or_null(place.field)}}}};
}

int report_interruption(const std::string& command, const std::string& message, bool as_json) {
  complain(message);
  if (as_json) print_json(error_json(command, message, code(Undecided::kInterrupted), kUndecidedExit, {}));
  return kUndecidedExit;
}

}  // namespace taut
