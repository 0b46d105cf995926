// SPDX-License-Identifier: GPL-3.0-or-later
#include "base/process.h"

#include <fcntl.h>
#include <sys/resource.h>
#include <unistd.h>

#include <array>
#include <csignal>
#include <cstring>
#include <exception>
#include <initializer_list>
#include <new>

namespace taut {
namespace {

constexpr int kInternalExit = 4;
const char* program_name = "";
const char* failure_code = "";

/// Allocates no memory and is safe in a signal handler.
void write_to_stderr(const char* text) { static_cast<void>(!::write(STDERR_FILENO, text, std::strlen(text))); }

[[noreturn]] void end_with(const char* reason) {
  for (const char* part : {program_name, ": internal failure: ", reason}) write_to_stderr(part);
  if (*failure_code != '\0') {
    for (const char* part : {" [", failure_code, "]"}) write_to_stderr(part);
  }
  write_to_stderr("\n");
  ::_exit(kInternalExit);
}

extern "C" void end_at_abort(int /*signal*/) { end_with("aborted"); }

extern "C" void end_at_fault(int /*signal*/) { end_with("out of memory for the stack, or a fault"); }

/// Where memory is limited the stack may find none to grow into, which is a segmentation fault. It is handled on a
/// stack of its own. Elsewhere faults stay what they are, for debuggers and sanitizers.
void end_where_the_stack_cannot_grow() {
  rlimit limit{};
  if (::getrlimit(RLIMIT_AS, &limit) != 0 || limit.rlim_cur == RLIM_INFINITY) return;
  constexpr std::size_t kBytes = std::size_t{64} << 10U;
  static std::array<char, kBytes> memory;
  stack_t stack{};
  stack.ss_sp = memory.data();
  stack.ss_size = memory.size();
  struct sigaction action {};
  action.sa_handler = end_at_fault;
  action.sa_flags = SA_ONSTACK;
  if (::sigaltstack(&stack, nullptr) == 0) static_cast<void>(::sigaction(SIGSEGV, &action, nullptr));
}

[[noreturn]] void end_at_terminate() {
  if (const std::exception_ptr thrown = std::current_exception()) {
    try {
      std::rethrow_exception(thrown);
    } catch (const std::bad_alloc&) {
      end_with("out of memory");
    } catch (const std::exception& error) {
      end_with(error.what());
    } catch (...) {
    }
  }
  end_with("an exception that could not be caught, or no memory for one");
}

/// Opens /dev/null for reading in place of an output, for writing in place of the input. Every use fails then, as it
/// does on a closed descriptor.
void replace_if_closed(int descriptor) {
  if (::fcntl(descriptor, F_GETFD) >= 0) return;
  static_cast<void>(::open("/dev/null", descriptor == STDIN_FILENO ? O_WRONLY : O_RDONLY));  // gets the lowest number
}

}  // namespace

void prepare_process(const char* program, const char* code) noexcept {
  program_name = program;
  failure_code = code;
  for (const int descriptor : {STDIN_FILENO, STDOUT_FILENO, STDERR_FILENO}) replace_if_closed(descriptor);
  std::signal(SIGABRT, end_at_abort);
  std::set_terminate(end_at_terminate);
  end_where_the_stack_cannot_grow();
}

}  // namespace taut
