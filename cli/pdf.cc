// SPDX-License-Identifier: GPL-3.0-or-later
#include "cli/pdf.h"

#include <fmt/format.h>
#include <unistd.h>

#include <algorithm>
#include <cstdlib>
#include <sstream>
#include <vector>

#include "base/files.h"
#include "base/input_error.h"
#include "base/sanitize.h"
#include "cli/subprocess.h"

namespace taut {
namespace {

/// A new directory for temporary files; removed with all that is in it.
class ScratchDirectory {
 public:
  ScratchDirectory() : path_(make_temporary_folder("taut")) {}
  ~ScratchDirectory() {
    std::error_code ignored;
    std::filesystem::remove_all(path_, ignored);
  }
  ScratchDirectory(const ScratchDirectory&) = delete;
  ScratchDirectory& operator=(const ScratchDirectory&) = delete;
  [[nodiscard]] const std::filesystem::path& path() const { return path_; }

 private:
  std::filesystem::path path_;
};

bool is_program(const std::filesystem::path& path) {
  std::error_code ignored;
  return std::filesystem::is_regular_file(path, ignored) && ::access(path.c_str(), X_OK) == 0;
}

/// Whether a program of that name is in PATH, or at that place if it contains a slash.
bool can_be_found(const std::string& name) {
  if (name.find('/') != std::string::npos) return is_program(name);
  const char* path = std::getenv("PATH");
  std::istringstream folders(path == nullptr ? "" : path);
  for (std::string folder; std::getline(folders, folder, ':');) {
    if (is_program(std::filesystem::path(folder) / name)) return true;
  }
  return false;
}

std::vector<std::string> browsers() {
  if (const char* chosen = std::getenv("TAUT_BROWSER"); chosen != nullptr && *chosen != '\0') return {chosen};
  return {"chromium", "chromium-browser", "google-chrome-stable", "google-chrome"};
}

/// The end of what a program printed.
std::string last_words(const std::string& text) {
  constexpr std::size_t kMost = 400;
  return sanitize(text.size() > kMost ? text.substr(text.size() - kMost) : text);
}

/// The address of a file, whatever the names on the way to it contain.
std::string address(const std::filesystem::path& file) {
  std::string result = "file://";
  for (const char c : std::filesystem::absolute(file).string()) {
    const auto byte = static_cast<unsigned char>(c);
    const bool is_plain = (c >= '0' && c <= '9') || (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') ||
                          std::string_view("/-_.~").find(c) != std::string_view::npos;
    result += is_plain ? std::string(1, c) : fmt::format("%{:02X}", byte);
  }
  return result;
}

bool is_whole_pdf(const std::string& bytes) {
  constexpr std::size_t kTail = 32;
  return bytes.starts_with("%PDF-") &&
         bytes.find("%%EOF", bytes.size() - std::min(bytes.size(), kTail)) != std::string::npos;
}

}  // namespace

std::optional<std::string> print_to_pdf(const std::string& page, const std::stop_token& stop) {
  constexpr double kMostSeconds = 300;
  const ScratchDirectory scratch;
  const std::filesystem::path html = scratch.path() / "report.html";
  const std::filesystem::path pdf = scratch.path() / "report.pdf";
  write_whole({{html, page}});
  std::vector<std::string> options = {"--headless",
                                      "--disable-background-networking",
                                      "--disable-component-update",
                                      "--disable-default-apps",
                                      "--disable-dev-shm-usage",
                                      "--disable-extensions",
                                      "--disable-gpu",
                                      "--disable-sync",
                                      "--no-first-run",
                                      "--no-pdf-header-footer",
                                      "--host-resolver-rules=MAP * ~NOTFOUND",
                                      "--virtual-time-budget=20000",  // [ms]: the page's script draws its plots
                                      fmt::format("--user-data-dir={}", (scratch.path() / "profile").string()),
                                      fmt::format("--print-to-pdf={}", pdf.string())};
  if (::geteuid() == 0) options.emplace_back("--no-sandbox");  // which Chromium refuses to set up for root
  options.push_back(address(html));

  const std::vector<std::string> candidates = browsers();
  const auto browser = std::ranges::find_if(candidates, can_be_found);
  if (browser == candidates.end()) {
    throw InputError(
        ErrorCode::kBrowser,
        fmt::format("--pdf: found no browser ({}), expected Chromium: install Debian's package chromium, or set "
                    "TAUT_BROWSER to a Chromium or Chrome; or print report.html from any browser",
                    fmt::join(candidates, ", ")));
  }
  options.insert(options.begin(), *browser);
  const FinishedProgram finished = run_program(options, stop, kMostSeconds);
  std::string bytes = std::filesystem::exists(pdf) ? read_whole(pdf) : "";
  if (finished.interrupted) return std::nullopt;
  if (finished.timed_out) throw BrowserFailed(fmt::format("{}: no PDF in {} s", *browser, kMostSeconds));
  if (finished.exit_code != 0 || !is_whole_pdf(bytes)) {
    throw BrowserFailed(fmt::format("{}: no PDF: it ended with {}; its last words: {}", *browser, finished.exit_code,
                                    last_words(finished.out + finished.err)));
  }
  return bytes;
}

}  // namespace taut
