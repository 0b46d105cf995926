// SPDX-License-Identifier: GPL-3.0-or-later
// A limit on time as a stop token, so that everything that can be interrupted can be given a deadline.
#pragma once

#include <chrono>
#include <cmath>
#include <condition_variable>
#include <functional>
#include <mutex>
#include <stop_token>
#include <thread>

namespace taut {

/// Requests a stop when its time is over, or when `parent` does. With a limit it uses a thread.
class TimeBudget {
 public:
  /// @param seconds  from now; infinite for no limit, none left if not positive.
  TimeBudget(double seconds, const std::stop_token& parent) : on_parent_(parent, [this] { end(); }) {
    if (!(seconds > 0)) {
      end();
    } else if (std::isfinite(seconds)) {
      timer_ = std::jthread([this, seconds](const std::stop_token& finished) { wait(seconds, finished); });
    }
  }
  TimeBudget(const TimeBudget&) = delete;
  TimeBudget& operator=(const TimeBudget&) = delete;
  ~TimeBudget() = default;

  [[nodiscard]] std::stop_token token() const { return source_.get_token(); }

 private:
  void end() { source_.request_stop(); }
  void wait(double seconds, const std::stop_token& finished) {
    constexpr double kLongest = 1e9;  // more overflows the clock
    const auto limit = std::chrono::duration<double>(std::fmin(seconds, kLongest));
    std::mutex mutex;
    std::unique_lock lock(mutex);
    std::condition_variable_any wake;
    wake.wait_for(lock, finished, limit, [] { return false; });
    if (!finished.stop_requested()) end();
  }

  std::stop_source source_;
  std::stop_callback<std::function<void()>> on_parent_;
  std::jthread timer_;  // last: joins before the rest goes
};

}  // namespace taut
