// SPDX-License-Identifier: GPL-3.0-or-later
#include "cli/console.h"

#include <fmt/format.h>
#include <unistd.h>

#include <atomic>
#include <condition_variable>
#include <csignal>
#include <cstdio>
#include <mutex>
#include <nlohmann/json.hpp>

#include "app/recheck.h"
#include "base/files.h"
#include "base/sanitize.h"
#include "checker/arguments.h"
#include "cli/terminal.h"
#include "reports/summary/bodies_statement.h"
#include "reports/summary/load_statement.h"
#include "reports/summary/time_statement.h"

namespace taut {
namespace {

std::atomic<bool> interrupt_requested = false;
extern "C" void request_interrupt(int signal) {
  interrupt_requested = true;
  std::signal(signal, SIG_DFL);  // a second one ends the program at once
}

}  // namespace

ExitCode exit_code(const checker::CheckResult& checked) {
  if (!checked.theorem) return kUndecidedExit;
  return checked.theorem->verdict() == checker::Theorem::Verdict::kProved ? kProvedExit : kRefutedExit;
}

void add_max_seconds_option(CLI::App& command, double& max_seconds) {
  command
      .add_option("--max-seconds", max_seconds,
                  fmt::format("what the independent checker may take before the result is UNCHECKED (default: {:.0f}); "
                              "0: don't check",
                              kCheckSeconds))
      ->check(checker::complain_of_seconds);
}

std::optional<SigningKey> load_signing_key(const std::string& path) {
  if (path.empty()) return std::nullopt;
  constexpr std::size_t kMaxKeyBytes = std::size_t{1} << 16U;  // an Ed25519 key in PEM has 119
  SigningKey key(read_whole(path, kMaxKeyBytes), path);
  std::error_code ignored;
  const std::filesystem::file_status status = std::filesystem::status(path, ignored);
  constexpr auto kOthers = std::filesystem::perms::group_all | std::filesystem::perms::others_all;
  if (std::filesystem::is_regular_file(status) && (status.permissions() & kOthers) != std::filesystem::perms::none) {
    complain(fmt::format("warning: {}: others than its owner may use this private key (chmod 600)", path));
  }
  return key;
}

void complain(std::string_view message) {
  const std::string line = "taut: " + sanitize(message) + "\n";
  static_cast<void>(std::fwrite(line.data(), 1, line.size(), stderr));
}

Case at_rest(Case the_case) {
  if (!the_case.problem.time) return the_case;
  the_case.problem = without_time(std::move(the_case.problem));
  the_case.warnings.emplace_back(
      "time: is not looked at by this command: it takes the machine for one that moves so slowly that inertia and "
      "speeds "
      "do not count");
  return the_case;
}

void announce(const Case& the_case, bool json) {
  for (const std::string& warning : the_case.warnings) complain("warning: " + warning);
  if (!json) print_problem(the_case);
}

void print_problem(const Case& the_case) {
  std::string before = "Load: ";
  for (const std::string& line : brief_lines(load_statement(the_case))) {
    print_wrapped(before + sanitize(line), before.front() == ' ' ? 0 : before.size());
    before = std::string(before.size(), ' ');
  }
  if (the_case.problem.time) print_wrapped(time_limits_text(*the_case.problem.time, DisplayUnits(the_case.units)));
  if (!the_case.bodies) return;
  before = "Bodies: ";
  for (const std::string& line : lines(bodies_statement(*the_case.bodies))) {
    print_wrapped(before + sanitize(line), before.front() == ' ' ? 0 : before.size());
    before = std::string(before.size(), ' ');
  }
}

std::string load_that_breaks(const LoadText& load, const checker::CheckResult& checked) {
  if (!checked.theorem || !checked.theorem->witness().is_object()) return "";
  const nlohmann::json& witness = checked.theorem->witness();
  if (!witness.contains("loads")) return "";
  return fmt::format("\nA load that breaks the limit there: {}.",
                     sanitize(witness_load_text(load, witness.at("loads"))));
}

ProgressLine::ProgressLine(bool wanted) : enabled_(wanted && ::isatty(STDERR_FILENO) == 1) {}

ProgressLine::~ProgressLine() { clear(); }

void ProgressLine::clear() {
  if (shown_) static_cast<void>(std::fputs("\r\033[K", stderr));
  shown_ = false;
}

bool ProgressLine::is_due() {
  const auto now = std::chrono::steady_clock::now();
  if (!enabled_ || now - last_ < std::chrono::milliseconds(100)) return false;
  last_ = now;
  return true;
}

void ProgressLine::print(const std::string& text) {
  shown_ = true;
  static_cast<void>(std::fputs(fmt::format("\r\033[K{}", text).c_str(), stderr));
  std::fflush(stderr);
}

Interruption::Interruption() {
  std::signal(SIGINT, request_interrupt);
  std::signal(SIGTERM, request_interrupt);
  if (std::signal(SIGHUP, request_interrupt) == SIG_IGN) std::signal(SIGHUP, SIG_IGN);  // as under nohup
  std::signal(SIGXFSZ, SIG_IGN);  // then it is an error of writing
  watcher_ = std::jthread([this](const std::stop_token& finished) {
    std::mutex mutex;
    std::unique_lock lock(mutex);
    std::condition_variable_any wake;
    while (!finished.stop_requested()) {
      wake.wait_for(lock, finished, std::chrono::milliseconds(50), [] { return interrupt_requested.load(); });
      if (interrupt_requested) {
        source_.request_stop();
        return;
      }
    }
  });
}

}  // namespace taut
