// SPDX-License-Identifier: GPL-3.0-or-later
// Maps whose parts are made by several processes: under mpirun, as shards, or one after the other with what is finished
// kept in files (docs/clusters.md).
#pragma once

#include <functional>
#include <optional>
#include <stop_token>
#include <string>
#include <vector>

#include "cli/case_map.h"
#include "map/parts.h"
#include "shards/dealing.h"
#include "shards/part_files.h"
#include "shards/ranks.h"

namespace taut {

class PartedMap {
 public:
  /// Is told after each part how many of how many are done, of those that are judged together.
  using PartDone = std::function<void(std::size_t done, std::size_t all)>;

  /// Divides the space into parts. Refers to its arguments.
  /// @param folder  of the parts' files; empty: none are read or written
  PartedMap(const MappedCase& mapped, const SubdivisionOptions& options, const std::string& folder);

  /// What determines the verdicts on all parts.
  [[nodiscard]] const std::string& digest() const { return digest_; }
  [[nodiscard]] std::size_t size() const { return parts_.size(); }
  /// A task is a part: the level up to which it is judged, and what is known of it.
  [[nodiscard]] std::string run(const Task& task) const;

  /// Judges as much as the map needs and the files don't know, a few levels of all parts at a time.
  /// @param ranks  that share in it, or null: threads do it
  /// @returns false where `options` asked to stop
  /// @throws InputError naming a file that is not such a part
  [[nodiscard]] bool judge(Ranks* ranks, const PartDone& part_done);
  /// The map of what is judged. @pre judge() returned true
  [[nodiscard]] CellMap map() const { return parts_.assemble(trees_, options_); }
  struct Made {
    std::size_t parts = 0;     ///< of the shard
    std::size_t computed = 0;  ///< that were not finished before
  };
  /// Judges all of a shard's parts. @returns nothing where `options` asked to stop
  /// @throws InputError naming a file that is not such a part
  [[nodiscard]] std::optional<Made> make_shard(const Shard& shard, const PartDone& part_done);
  /// The map of what is known. @throws InputError naming a part that is missing, or is not judged as far as necessary,
  /// or a file that is not such a part
  [[nodiscard]] CellMap merge();

 private:
  [[nodiscard]] Task task(std::size_t part, std::size_t level) const;
  [[nodiscard]] TreeExtent extent() const;
  [[nodiscard]] std::size_t next_level(const TreeExtent& all) const;
  [[nodiscard]] std::vector<Task> tasks_up_to(std::size_t level) const;
  void read_known(const Shard& shard);
  void keep(std::size_t part, std::string tree);
  void set(std::size_t part, std::string tree);

  const MappedCase& mapped_;
  const SubdivisionOptions& options_;
  MapParts parts_;
  std::string digest_;
  std::optional<PartFiles> files_;
  std::vector<std::string> trees_;
  std::vector<TreeExtent> extents_;
};

}  // namespace taut
