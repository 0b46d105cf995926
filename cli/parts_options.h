// SPDX-License-Identifier: GPL-3.0-or-later
// Options of commands whose work comes in parts (docs/clusters.md).
#pragma once

#include <CLI/CLI.hpp>
#include <functional>
#include <memory>
#include <optional>
#include <stop_token>
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

/// What one process does, and rank 0 under mpirun: it alone prints and writes. It is given the other ranks, or null,
/// and may let them go before it ends. Returns the exit code.
using RunFirst = std::function<int(std::unique_ptr<Ranks>& ranks)>;
/// What other ranks do: they compute. An InputError is said by rank 0.
using ServeRanks = std::function<void(Ranks& ranks, const std::stop_token& stop)>;

/// Does what this process is to do: all of the work, or its share where mpirun started it with others.
/// @returns the exit code
/// @throws InputError as Ranks::join(), for options that make no sense there, and as `first`
[[nodiscard]] int run_in_ranks(const PartsArguments& arguments, const RunFirst& first, const ServeRanks& serve);

}  // namespace taut
