// SPDX-License-Identifier: GPL-3.0-or-later
// Work on several threads.
#pragma once

#include <flint/flint.h>

#include <atomic>
#include <exception>
#include <mutex>
#include <thread>
#include <vector>

namespace taut::checker {

/// Calls `work(k)` for k in [0, count) on some threads. Rethrows what was thrown for the smallest k.
template <class Work>
void for_each(std::size_t count, unsigned threads, const Work& work) {
  std::atomic<std::size_t> next = 0;
  std::atomic<std::size_t> first_failure = count;
  std::mutex mutex;
  std::exception_ptr failure;
  const auto run = [&] {
    for (std::size_t k = next++; k < first_failure; k = next++) {
      try {
        work(k);
      } catch (...) {
        const std::lock_guard lock(mutex);
        if (k >= first_failure) continue;
        first_failure = k;
        failure = std::current_exception();
      }
    }
  };
  {
    std::vector<std::jthread> pool;
    for (unsigned i = 1; i < threads && i < count; ++i) {
      pool.emplace_back([&] {
        run();
        flint_cleanup();
      });
    }
    run();
  }
  if (failure) std::rethrow_exception(failure);
}

}  // namespace taut::checker
