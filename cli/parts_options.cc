// SPDX-License-Identifier: GPL-3.0-or-later
#include "cli/parts_options.h"

#include <fmt/format.h>

#include "base/input_error.h"
#include "cli/console.h"

namespace taut {
namespace {

/// The other processes, where mpirun started this one.
std::unique_ptr<Ranks> join_ranks(const PartsArguments& arguments) {
  auto ranks = Ranks::join([](const std::string& message) { complain(message); });
  if (ranks && ranks->is_first() && (arguments.merge || !arguments.shard.empty())) {
    throw InputError(ErrorCode::kUse, fmt::format("mpirun: got {} processes and {}, expected one of them",
                                                  ranks->size(), arguments.merge ? "--merge" : "--shard"));
  }
  return ranks;
}

}  // namespace

void add_parts_options(CLI::App& command, PartsArguments& arguments) {
  CLI::Option* const parts = command.add_option(
      "--parts", arguments.folder, "folder that keeps finished parts, so that a run that was ended goes on");
  CLI::Option* const shard =
      command.add_option("--shard", arguments.shard, "compute only shard k of m, as k/m, into --parts");
  CLI::Option* const merge =
      command.add_flag("--merge", arguments.merge, "compute nothing: make the result from all parts in --parts");
  shard->needs(parts)->excludes(merge);
  merge->needs(parts);
}

std::optional<Shard> shard_of(const PartsArguments& arguments) {
  if (arguments.shard.empty()) return std::nullopt;
  return read_shard(arguments.shard);
}

int run_in_ranks(const PartsArguments& arguments, const RunFirst& first, const ServeRanks& serve) {
  std::unique_ptr<Ranks> ranks = join_ranks(arguments);
  if (!ranks) return first(ranks);
  if (!ranks->is_first()) {
    const Interruption interruption;
    try {
      serve(*ranks, interruption.token());
    } catch (const InputError& error) {
      ranks->fail(error.what());
    }
    return kProvedExit;
  }
  const int code = first(ranks);
  if (code != kProvedExit) {
    complain(fmt::format("the exit code is {}; mpirun --enable-recovery ends with 0 nevertheless", code));
  }
  return code;
}

}  // namespace taut
