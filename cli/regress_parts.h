// SPDX-License-Identifier: GPL-3.0-or-later
// Regression proofs in parts, a case each: on threads, under mpirun, as shards, or from files (docs/clusters.md).
#pragma once

#include <filesystem>
#include <functional>
#include <optional>
#include <stop_token>
#include <string>
#include <vector>

#include "cli/regress.h"
#include "shards/dealing.h"
#include "shards/part_files.h"
#include "shards/ranks.h"

namespace taut {

class RegressParts {
 public:
  /// @param parts  folder of files for finished cases; empty: none are read or written
  /// @throws InputError
  RegressParts(const std::filesystem::path& folder, std::vector<std::filesystem::path> files,
               const RegressOptions& options, const std::string& parts);

  /// What determines the results.
  [[nodiscard]] const std::string& digest() const { return digest_; }
  /// The result of a case as bytes; empty where `stop` was requested before it ended.
  [[nodiscard]] std::string run(std::size_t number, const std::filesystem::path& results,
                                const std::stop_token& stop) const;

  /// Runs the cases of a shard that files don't know. Cases without a result are run again.
  /// @param ranks  that share in it, or null: threads do it
  /// @param done   called after each case, one at a time, with how many are done
  /// @returns the shard's cases, in order; only those that ended where `stop` was requested.
  /// @throws InputError naming a file that is not such a part
  [[nodiscard]] std::vector<RegressedCase> make(const Shard& shard, Ranks* ranks,
                                                const std::function<void(std::size_t)>& done,
                                                const std::stop_token& stop);
  /// All cases, from files alone. @throws InputError naming a part that is missing or is none
  [[nodiscard]] std::vector<RegressedCase> merge() const;

 private:
  [[nodiscard]] RegressedCase read(std::size_t number, const std::string& text) const;

  std::vector<std::string> names_;
  std::vector<std::filesystem::path> files_;
  const RegressOptions& options_;
  std::string digest_;
  std::optional<PartFiles> parts_;
};

}  // namespace taut
