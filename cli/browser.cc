// SPDX-License-Identifier: GPL-3.0-or-later
#include "cli/browser.h"

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

bool is_whole_png(const std::string& bytes) {
  using namespace std::string_literals;
  return bytes.starts_with("\x89PNG\r\n\x1a\n") && bytes.ends_with("\0\0\0\0IEND\xae\x42\x60\x82"s);
}

/// Something that a browser makes of a page.
struct Product {
  const char* option;     ///< of taut, which messages name
  const char* kind;       ///< "PDF"
  const char* file;       ///< in the scratch directory
  const char* otherwise;  ///< what to do where there is no browser
  bool (*is_whole)(const std::string& bytes);
};

std::string found_browser(const Product& product) {
  const std::vector<std::string> candidates = browsers();
  const auto browser = std::ranges::find_if(candidates, can_be_found);
  if (browser != candidates.end()) return *browser;
  throw InputError(
      ErrorCode::kBrowser,
      fmt::format("{}: found no browser ({}), expected Chromium: install Debian's package chromium, or set "
                  "TAUT_BROWSER to a Chromium or Chrome; or {}",
                  product.option, fmt::join(candidates, ", "), product.otherwise));
}

/// What the browser makes of a page with these further options, the last of which says where to write it.
std::optional<std::string> made_by_browser(const Product& product, const std::string& page,
                                           const std::vector<std::string>& further, const char* write,
                                           const std::stop_token& stop) {
  constexpr double kMostSeconds = 300;
  const ScratchDirectory scratch;
  const std::filesystem::path html = scratch.path() / "page.html";
  const std::filesystem::path made = scratch.path() / product.file;
  write_whole({{html, page}});
  std::vector<std::string> command = {found_browser(product),
                                      "--headless",
                                      "--disable-background-networking",
                                      "--disable-component-update",
                                      "--disable-default-apps",
                                      "--disable-dev-shm-usage",
                                      "--disable-extensions",
                                      "--disable-gpu",
                                      "--disable-sync",
                                      "--no-first-run",
                                      "--host-resolver-rules=MAP * ~NOTFOUND",
                                      "--virtual-time-budget=20000",  // [ms]: the page's script draws its plots
                                      fmt::format("--user-data-dir={}", (scratch.path() / "profile").string())};
  command.insert(command.end(), further.begin(), further.end());
  command.push_back(write + made.string());
  if (::geteuid() == 0) command.emplace_back("--no-sandbox");  // which Chromium refuses to set up for root
  command.push_back(address(html));

  const FinishedProgram finished = run_program(command, stop, kMostSeconds);
  std::string bytes = std::filesystem::exists(made) ? read_whole(made) : "";
  if (finished.interrupted) return std::nullopt;
  if (finished.timed_out) throw BrowserFailed(fmt::format("{}: no {} in {} s", command[0], product.kind, kMostSeconds));
  if (finished.exit_code != 0 || !product.is_whole(bytes)) {
    throw BrowserFailed(fmt::format("{}: no {}: it ended with {}; its last words: {}", command[0], product.kind,
                                    finished.exit_code, last_words(finished.out + finished.err)));
  }
  return bytes;
}

}  // namespace

std::optional<std::string> print_to_pdf(const std::string& page, const std::stop_token& stop) {
  constexpr Product kPdf = {"--pdf", "PDF", "report.pdf", "print report.html from any browser", is_whole_pdf};
  return made_by_browser(kPdf, page, {"--no-pdf-header-footer"}, "--print-to-pdf=", stop);
}

std::optional<std::string> draw_as_png(const std::string& svg, int width, int height, const std::stop_token& stop) {
  constexpr Product kPng = {"--png", "PNG", "picture.png", "open map.svg in any browser", is_whole_png};
  const std::string page =
      "<!DOCTYPE html>\n<html lang=\"en\"><head><meta charset=\"utf-8\"><title>map</title>"
      "<style>body { margin: 0 } svg { display: block }</style></head><body>" +
      svg + "</body></html>\n";
  return made_by_browser(
      kPng, page,
      {"--hide-scrollbars", "--force-device-scale-factor=2", fmt::format("--window-size={},{}", width, height)},
      "--screenshot=", stop);
}

}  // namespace taut
