#include "cli/pdf.h"

#include <fcntl.h>
#include <fmt/format.h>
#include <signal.h>
#include <spawn.h>
#include <sys/wait.h>
#include <unistd.h>

#include <cerrno>
#include <chrono>
#include <cstdlib>
#include <cstring>
#include <optional>
#include <thread>
#include <vector>

#include "cli/files.h"
#include "kinematics/input_error.h"

namespace taut {
namespace {

/// A new directory for temporary files; removed with all that is in it.
class ScratchDirectory {
 public:
  ScratchDirectory() {
    std::string name = (std::filesystem::temp_directory_path() / "taut-XXXXXX").string();
    if (::mkdtemp(name.data()) == nullptr) {
      throw InputError(fmt::format("{}: could not make a directory: {}", name, std::strerror(errno)));
    }
    path_ = name;
  }
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

/// Starts a program that is sought in PATH, at the head of a process group of its own, its output into `log`.
/// @returns nothing where there is no such program.
std::optional<pid_t> start(std::vector<std::string> command, const std::filesystem::path& log) {
  std::vector<char*> arguments;
  for (std::string& argument : command) arguments.push_back(argument.data());
  arguments.push_back(nullptr);
  posix_spawn_file_actions_t actions;
  posix_spawnattr_t attributes;
  posix_spawn_file_actions_init(&actions);
  posix_spawnattr_init(&attributes);
  posix_spawn_file_actions_addopen(&actions, STDIN_FILENO, "/dev/null", O_RDONLY, 0);
  posix_spawn_file_actions_addopen(&actions, STDOUT_FILENO, log.c_str(), O_WRONLY | O_CREAT | O_TRUNC, 0600);
  posix_spawn_file_actions_adddup2(&actions, STDOUT_FILENO, STDERR_FILENO);
  posix_spawnattr_setflags(&attributes, POSIX_SPAWN_SETPGROUP);
  posix_spawnattr_setpgroup(&attributes, 0);
  pid_t process = 0;
  const int error = ::posix_spawnp(&process, arguments[0], &actions, &attributes, arguments.data(), environ);
  posix_spawn_file_actions_destroy(&actions);
  posix_spawnattr_destroy(&attributes);
  if (error == ENOENT || error == EACCES) return std::nullopt;
  if (error != 0) throw BrowserFailed(fmt::format("{}: could not be started: {}", command[0], std::strerror(error)));
  return process;
}

/// Its exit code; nothing where it was ended, with all its children, for the stop or for taking too long.
std::optional<int> wait_for(pid_t process, std::chrono::seconds longest, const std::stop_token& stop) {
  const auto deadline = std::chrono::steady_clock::now() + longest;
  int status = 0;
  for (;;) {
    const pid_t ended = ::waitpid(process, &status, WNOHANG);
    if (ended == process || (ended < 0 && errno != EINTR)) break;
    if (stop.stop_requested() || std::chrono::steady_clock::now() > deadline) {
      ::kill(-process, SIGKILL);
      ::waitpid(process, &status, 0);
      return std::nullopt;
    }
    std::this_thread::sleep_for(std::chrono::milliseconds(10));
  }
  ::kill(-process, SIGKILL);  // what it left behind
  return WIFEXITED(status) ? WEXITSTATUS(status) : -1;
}

std::vector<std::string> browsers() {
  if (const char* chosen = std::getenv("TAUT_BROWSER"); chosen != nullptr && *chosen != '\0') return {chosen};
  return {"chromium", "chromium-browser", "google-chrome-stable", "google-chrome"};
}

/// The end of what a program printed.
std::string last_words(const std::filesystem::path& log) {
  constexpr std::size_t kMost = 400;
  std::string text = std::filesystem::exists(log) ? read_whole(log) : "";
  if (text.size() > kMost) text.erase(0, text.size() - kMost);
  return text;
}

bool is_whole_pdf(const std::string& bytes) {
  constexpr std::size_t kTail = 32;
  return bytes.starts_with("%PDF-") && bytes.find("%%EOF", bytes.size() - std::min(bytes.size(), kTail)) != std::string::npos;
}

}  // namespace

std::string print_to_pdf(const std::string& page, const std::stop_token& stop) {
  constexpr std::chrono::seconds kLongest{300};
  const ScratchDirectory scratch;
  const std::filesystem::path html = scratch.path() / "report.html";
  const std::filesystem::path pdf = scratch.path() / "report.pdf";
  const std::filesystem::path log = scratch.path() / "log";
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
  options.push_back("file://" + html.string());

  std::string tried;
  for (const std::string& browser : browsers()) {
    tried += (tried.empty() ? "" : ", ") + browser;
    std::vector<std::string> command = {browser};
    command.insert(command.end(), options.begin(), options.end());
    const std::optional<pid_t> process = start(std::move(command), log);
    if (!process) continue;
    const std::optional<int> code = wait_for(*process, kLongest, stop);
    if (!code) {
      throw BrowserFailed(fmt::format("{}: no PDF: {}", browser,
                                      stop.stop_requested() ? "interrupted" : fmt::format("it took more than {} s", kLongest.count())));
    }
    std::string bytes = std::filesystem::exists(pdf) ? read_whole(pdf) : "";
    if (*code != 0 || !is_whole_pdf(bytes)) {
      throw BrowserFailed(fmt::format("{}: no PDF: it ended with {}; its last words: {}", browser, *code, last_words(log)));
    }
    return bytes;
  }
  throw InputError(fmt::format("--pdf: got no browser ({} not found), expected Chromium: install Debian's package chromium, or set "
                               "TAUT_BROWSER to a Chromium or Chrome; or print report.html from any browser",
                               tried));
}

}  // namespace taut
