// SPDX-License-Identifier: GPL-3.0-or-later
#include "cli/doctor_command.h"

#include <fmt/format.h>
#include <mpfr.h>
#include <unistd.h>

#include <cstdlib>
#include <exception>
#include <filesystem>
#include <optional>
#include <sstream>
#include <string>
#include <thread>

#include "base/sanitize.h"
#include "certify/arithmetic/rounding.h"
#include "cli/console.h"
#include "cli/subprocess.h"

namespace taut {
namespace {

namespace fs = std::filesystem;

void line(bool is_well, const std::string& what, const std::string& found) {
  fmt::print("{:<4} {:<22} {}\n", is_well ? "ok" : "!", what, sanitize(found));
}

std::optional<std::string> in_path(const std::string& program) {
  const char* path = std::getenv("PATH");
  std::istringstream folders(path == nullptr ? "" : path);
  for (std::string folder; std::getline(folders, folder, ':');) {
    const fs::path candidate = fs::path(folder) / program;
    if (::access(candidate.c_str(), X_OK) == 0) return candidate.string();
  }
  return std::nullopt;
}

bool check_rounding() {
  try {
    rounding_self_test();
  } catch (const std::exception& error) {
    line(false, "directed rounding", fmt::format("{}; no proof made here can be trusted", error.what()));
    return false;
  }
  line(true, "directed rounding",
       "sums, products, quotients and roots round as IEEE 754 says, and underflow is gradual");
  return true;
}

/// The library at run time may be another than the headers.
bool check_mpfr() {
  const bool is_well = std::string(mpfr_get_version()) >= "4" && mpfr_buildopt_tls_p() != 0;
  line(is_well, "MPFR",
       fmt::format("{}, built against {}{}", mpfr_get_version(), MPFR_VERSION_STRING,
                   mpfr_buildopt_tls_p() != 0 ? ", safe with threads" : "; not safe with threads"));
  return is_well;
}

void check_cores() {
  const unsigned cores = std::thread::hardware_concurrency();
  line(cores > 0, "processor cores", cores > 0 ? fmt::format("{}", cores) : "unknown");
}

void check_checker() {
  const FinishedProgram said = [] {
    try {
      return run_program({checker_program(), "--version"}, {}, 10);
    } catch (const std::exception& error) {
      FinishedProgram failed;
      failed.exit_code = kInternalExit;
      failed.err = error.what();
      return failed;
    }
  }();
  const bool is_well = said.exit_code == 0;
  line(is_well, "taut-check",
       is_well ? said.out.substr(0, said.out.find('\n')) + ", " + checker_program()
               : "not found: certificates can't be proved again here");
}

void check_browser() {
  for (const char* name : {"chromium", "chromium-browser", "google-chrome", "google-chrome-stable"}) {
    if (const auto found = in_path(name)) return line(true, "browser", *found);
  }
  line(false, "browser", "no Chromium: taut report --pdf and taut map --png need one (Debian's package chromium)");
}

void check_temporary() {
  std::error_code error;
  const fs::path folder = fs::temp_directory_path(error);
  const bool is_well = !error && ::access(folder.c_str(), W_OK) == 0;
  line(is_well, "temporary files", is_well ? folder.string() : "no folder for them that can be written (TMPDIR)");
}

}  // namespace

int run_doctor() {
  fmt::print("taut {}\n", TAUT_VERSION);
  const bool rounds = check_rounding();
  const bool has_mpfr = check_mpfr();
  check_cores();
  check_checker();
  check_browser();
  check_temporary();
  return rounds && has_mpfr ? kProvedExit : kInternalExit;
}

}  // namespace taut
