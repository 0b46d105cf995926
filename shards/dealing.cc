// SPDX-License-Identifier: GPL-3.0-or-later
#include "shards/dealing.h"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <exception>
#include <mutex>
#include <thread>
#include <utility>

#include "base/input_error.h"
#include "base/sanitize.h"

namespace taut {

std::size_t usable_threads() { return std::max(1U, std::thread::hardware_concurrency()); }

void deal_to_threads(const std::vector<Task>& tasks, std::size_t threads, const RunTask& run, const TaskDone& done,
                     const std::stop_token& stop) {
  std::mutex mutex;
  std::size_t next = 0;
  std::exception_ptr failure;
  const auto take = [&] {
    const std::lock_guard lock(mutex);
    return failure || stop.stop_requested() ? tasks.size() : std::min(next++, tasks.size());
  };
  const auto work = [&] {
    for (std::size_t task = take(); task < tasks.size(); task = take()) {
      try {
        std::string result = run(tasks[task]);
        const std::lock_guard lock(mutex);
        if (!failure) done(task, std::move(result));
      } catch (...) {
        const std::lock_guard lock(mutex);
        if (!failure) failure = std::current_exception();
      }
    }
  };
  {
    std::vector<std::jthread> others;
    for (std::size_t n = 1; n < std::min(threads, tasks.size()); ++n) others.emplace_back(work);
    work();
  }
  if (failure) std::rethrow_exception(failure);
}

Shard read_shard(std::string_view text) {
  constexpr std::size_t kMost = 1'000'000;
  std::size_t index = 0, count = 0;
  const char* const end = text.data() + text.size();
  const auto [slash, error] = std::from_chars(text.data(), end, index);
  bool is_shard = error == std::errc() && slash != end && *slash == '/';
  if (is_shard) {
    const auto [last, count_error] = std::from_chars(slash + 1, end, count);
    is_shard = count_error == std::errc() && last == end && 1 <= index && index <= count && count <= kMost;
  }
  if (!is_shard) {
    throw InputError(ErrorCode::kUse, fmt::format("--shard: got '{}', expected k/m with 1 <= k <= m <= {}, such as 3/8",
                                                  excerpt(std::string(text)), kMost));
  }
  return {index - 1, count};
}

}  // namespace taut
