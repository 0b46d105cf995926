// SPDX-License-Identifier: GPL-3.0-or-later
// Options of commands whose work comes in parts (docs/clusters.md).
#pragma once

#include <CLI/CLI.hpp>
#include <memory>
#include <optional>
#include <string>

#include "shards/dealing.h"
#include "shards/ranks.h"

namespace taut {

struct PartsArguments {
  std::string folder;  ///< of the parts' files, or empty
  std::string shard;   ///< "3/8", or empty: all parts
  bool merge = false;

  [[nodiscard]] bool any() const { return !folder.empty(); }
};

/// --parts, --shard, --merge.
void add_parts_options(CLI::App& command, PartsArguments& arguments);

/// The shard that was asked for. @throws InputError
[[nodiscard]] std::optional<Shard> shard_of(const PartsArguments& arguments);

/// The other processes, where mpirun started this one. @throws InputError as Ranks::join(), and for options that make
/// no sense there
[[nodiscard]] std::unique_ptr<Ranks> join_ranks(const PartsArguments& arguments);

/// Says on stderr that an exit code other than 0 may not be seen under mpirun.
void say_exit_code(int exit_code);

/// How many threads the processors have that this process may use.
[[nodiscard]] std::size_t usable_threads();

}  // namespace taut
