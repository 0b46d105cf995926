// SPDX-License-Identifier: GPL-3.0-or-later
// Tasks that depend on each other in nothing, dealt to whoever computes them.
#pragma once

#include <cstddef>
#include <functional>
#include <stop_token>
#include <string>
#include <string_view>
#include <vector>

namespace taut {

struct Task {
  std::size_t part = 0;  ///< of the whole work
  std::string input;     ///< what was found of it before; its meaning is the work's
};

/// The result of a task. Thread-safe, and a function of the task and of what all know: whoever computes it, bit for bit
/// the same.
using RunTask = std::function<std::string(const Task&)>;
/// Takes a result, by the task's number among those that were dealt. Called once for each, one at a time.
using TaskDone = std::function<void(std::size_t, std::string)>;

/// How many threads run at a time on the processors that this process may use.
[[nodiscard]] std::size_t usable_threads();

/// Deals tasks, the first one first. Returns when all are done, or as soon as `stop` is requested and nothing runs.
/// Throws what `run` and `done` throw, when nothing runs.
void deal_to_threads(const std::vector<Task>& tasks, std::size_t threads, const RunTask& run, const TaskDone& done,
                     const std::stop_token& stop);

/// One share of the parts of a work: those with number `index`, `index + count`, …
struct Shard {
  std::size_t index = 0;  ///< from 0
  std::size_t count = 1;

  [[nodiscard]] bool has(std::size_t part) const { return part % count == index; }
};

/// Reads "k/m" with 1 <= k <= m. @throws InputError naming --shard
[[nodiscard]] Shard read_shard(std::string_view text);

}  // namespace taut
