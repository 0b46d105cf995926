// SPDX-License-Identifier: GPL-3.0-or-later
// How long something takes.
#pragma once

#include <chrono>

namespace taut {

using Clock = std::chrono::steady_clock;

/// [s]
[[nodiscard]] inline double seconds_since(Clock::time_point start) {
  return std::chrono::duration<double>(Clock::now() - start).count();
}

}  // namespace taut
