// SPDX-License-Identifier: GPL-3.0-or-later
#include "cli/subprocess.h"

#include <fcntl.h>
#include <fmt/format.h>
#include <poll.h>
#include <spawn.h>
#include <sys/auxv.h>
#include <sys/wait.h>
#include <unistd.h>

#include <array>
#include <cerrno>
#include <chrono>
#include <csignal>
#include <cstring>
#include <filesystem>
#include <system_error>
#include <utility>

#include "base/input_error.h"

namespace taut {
namespace {

using Clock = std::chrono::steady_clock;

class Descriptor {
 public:
  Descriptor() = default;
  explicit Descriptor(int number) : number_(number) {}
  ~Descriptor() { close(); }
  Descriptor(const Descriptor&) = delete;
  Descriptor& operator=(const Descriptor&) = delete;
  [[nodiscard]] int get() const { return number_; }
  void reset(int number) {
    close();
    number_ = number;
  }
  void close() {
    if (number_ >= 0) ::close(number_);
    number_ = -1;
  }

 private:
  int number_ = -1;
};

/// Programs that are started meanwhile do not inherit either end.
struct Pipe {
  Descriptor read, write;
  Pipe() {
    std::array<int, 2> ends{};
    if (::pipe2(ends.data(), O_CLOEXEC) != 0) throw std::system_error(errno, std::generic_category(), "pipe");
    read.reset(ends[0]);
    write.reset(ends[1]);
  }
};

class FileActions {
 public:
  FileActions() { ::posix_spawn_file_actions_init(&actions_); }
  ~FileActions() { ::posix_spawn_file_actions_destroy(&actions_); }
  FileActions(const FileActions&) = delete;
  FileActions& operator=(const FileActions&) = delete;
  [[nodiscard]] posix_spawn_file_actions_t* get() { return &actions_; }

 private:
  posix_spawn_file_actions_t actions_{};
};

class SpawnAttributes {
 public:
  SpawnAttributes() { ::posix_spawnattr_init(&attributes_); }
  ~SpawnAttributes() { ::posix_spawnattr_destroy(&attributes_); }
  SpawnAttributes(const SpawnAttributes&) = delete;
  SpawnAttributes& operator=(const SpawnAttributes&) = delete;
  [[nodiscard]] posix_spawnattr_t* get() { return &attributes_; }

 private:
  posix_spawnattr_t attributes_{};
};

pid_t start(const std::vector<std::string>& command, const Pipe& out, const Pipe& err) {
  FileActions actions;
  ::posix_spawn_file_actions_addopen(actions.get(), STDIN_FILENO, "/dev/null", O_RDONLY, 0);
  ::posix_spawn_file_actions_adddup2(actions.get(), out.write.get(), STDOUT_FILENO);
  ::posix_spawn_file_actions_adddup2(actions.get(), err.write.get(), STDERR_FILENO);
  SpawnAttributes attributes;
  // A group of its own: a terminal's Ctrl-C reaches it through us, and what it has started ends with it.
  ::posix_spawnattr_setflags(attributes.get(), POSIX_SPAWN_SETPGROUP);
  ::posix_spawnattr_setpgroup(attributes.get(), 0);
  std::vector<std::string> words = command;  // argv's strings are not constant
  std::vector<char*> argv;
  for (std::string& word : words) argv.push_back(word.data());
  argv.push_back(nullptr);
  pid_t pid = 0;
  const int error = ::posix_spawnp(&pid, argv[0], actions.get(), attributes.get(), argv.data(), ::environ);
  if (error != 0) {
    throw InputError(fmt::format("{}: {}, expected a program that can be started", command[0], std::strerror(error)));
  }
  return pid;
}

/// Takes what there is to read. Closes at the end.
void drain(Descriptor& from, std::string& into) {
  std::array<char, 1 << 16> buffer;  // NOLINT(cppcoreguidelines-pro-type-member-init): read() fills it
  const ssize_t size = ::read(from.get(), buffer.data(), buffer.size());
  if (size > 0) {
    into.append(buffer.data(), static_cast<std::size_t>(size));
  } else if (size == 0 || errno != EINTR) {
    from.close();
  }
}

}  // namespace

FinishedProgram run_program(const std::vector<std::string>& command, const std::stop_token& stop,
                            std::optional<double> most_seconds) {
  constexpr std::chrono::milliseconds kLook{50};  // how often a stop request and the time are looked at
  constexpr std::chrono::milliseconds kLookAtTheEnd{1};
  constexpr std::chrono::seconds kGrace{3};  // between SIGTERM and SIGKILL
  FinishedProgram result;
  Pipe out;
  Pipe err;
  const Clock::time_point begin = Clock::now();
  const pid_t pid = start(command, out, err);
  out.write.close();
  err.write.close();
  std::optional<Clock::time_point> asked;
  bool killed = false;
  int status = 0;
  bool has_ended = false;
  while (!has_ended || out.read.get() >= 0 || err.read.get() >= 0) {
    std::array<pollfd, 2> ends = {pollfd{out.read.get(), POLLIN, 0}, pollfd{err.read.get(), POLLIN, 0}};
    const bool is_silent = out.read.get() < 0 && err.read.get() < 0;  // then it is about to end
    ::poll(ends.data(), ends.size(), static_cast<int>((is_silent ? kLookAtTheEnd : kLook).count()));
    if (ends[0].revents != 0) drain(out.read, result.out);
    if (ends[1].revents != 0) drain(err.read, result.err);
    if (!has_ended && ::waitpid(pid, &status, WNOHANG) == pid) has_ended = true;
    // A program of its own that goes on with the pipes is not waited for.
    if (has_ended && ends[0].revents == 0 && ends[1].revents == 0) break;
    const Clock::time_point now = Clock::now();
    const bool is_late = most_seconds && std::chrono::duration<double>(now - begin).count() > *most_seconds;
    if (!has_ended && !asked && (stop.stop_requested() || is_late)) {
      (stop.stop_requested() ? result.interrupted : result.timed_out) = true;
      asked = now;
      ::kill(-pid, SIGTERM);
    }
    if (!has_ended && asked && !killed && now - *asked > kGrace) {
      killed = true;
      ::kill(-pid, SIGKILL);
    }
  }
  if (asked) ::kill(-pid, SIGKILL);  // what it leaves behind
  result.exit_code = WIFEXITED(status) ? WEXITSTATUS(status) : 128 + WTERMSIG(status);
  result.seconds = std::chrono::duration<double>(Clock::now() - begin).count();
  return result;
}

std::string own_program() {
  // The name that it was started by, which the kernel tells, also where /proc is not mounted.
  const unsigned long name = ::getauxval(AT_EXECFN);
  // NOLINTNEXTLINE(performance-no-int-to-ptr): the kernel's interface
  return reinterpret_cast<const char*>(name);
}

std::string checker_program() {
  const std::filesystem::path own = own_program();
  std::error_code ignored;
  for (const std::filesystem::path& program :
       {own, std::filesystem::canonical(own, ignored)}) {  // a link may lead to it
    const std::filesystem::path here = program.parent_path();
    for (const std::filesystem::path& candidate : {here / "taut-check", here / "../checker/taut-check"}) {
      if (std::filesystem::exists(candidate)) return candidate.string();
    }
  }
  return "taut-check";
}

}  // namespace taut
