// SPDX-License-Identifier: GPL-3.0-or-later
#include "cli/map_parts.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <nlohmann/json.hpp>
#include <utility>

#include "base/input_error.h"
#include "base/sha256.h"
#include "cli/parts_options.h"

namespace taut {
namespace {

using nlohmann::json;

/// What determines all verdicts: the problem but for its query, and how far cells are halved.
json work_of(const MappedCase& mapped, double least_width) {
  json problem = to_json(mapped.the_case.problem);
  problem.erase("query");
  return {{"command", "map"},
          {"taut", TAUT_VERSION},
          {"case", mapped.the_case.problem.name},
          {"cell", least_width},
          {"problem_sha256", sha256(problem)}};
}

/// Levels are small numbers: two digits before the tree.
std::string input_of(std::size_t level, const std::string& tree) { return fmt::format("{:02}", level) + tree; }

}  // namespace

PartedMap::PartedMap(const MappedCase& mapped, const SubdivisionOptions& options, const std::string& folder)
    : mapped_(mapped), options_(options), parts_(mapped.the_case.problem, mapped.space, options.least_width) {
  const json work = work_of(mapped, options.least_width);
  digest_ = sha256(work);
  trees_.resize(parts_.size());
  extents_.resize(parts_.size());
  if (!folder.empty()) files_.emplace(folder, work, parts_.size());
  for (std::size_t part = 0; part < parts_.size(); ++part) set(part, parts_.start(part));
}

void PartedMap::read_known(const Shard& shard) {
  if (!files_) return;
  for (std::size_t part = 0; part < parts_.size(); ++part) {
    if (!shard.has(part)) continue;
    if (std::optional<std::string> known = files_->read(part)) set(part, std::move(*known));
  }
}

void PartedMap::set(std::size_t part, std::string tree) {
  try {
    extents_[part] = parts_.extent(part, tree);
  } catch (const MalformedTree& error) {
    throw InputError(ErrorCode::kFile,
                     fmt::format("{}: {}", files_ ? files_->file(part).string() : "part", error.what()));
  }
  trees_[part] = std::move(tree);
}

void PartedMap::keep(std::size_t part, std::string tree) {
  set(part, std::move(tree));
  if (files_) files_->write(part, trees_[part]);
}

std::string PartedMap::run(const Task& task) const {
  const int level = 10 * (task.input.at(0) - '0') + task.input.at(1) - '0';
  return parts_.refine(task.part, std::string_view(task.input).substr(2), level);
}

Task PartedMap::task(std::size_t part, std::size_t level) const { return {part, input_of(level, trees_[part])}; }

TreeExtent PartedMap::extent() const {
  TreeExtent all = parts_.top();
  for (const TreeExtent& part : extents_) all.add(part);
  return all;
}

/// Few rounds take little time for talk, and small steps judge little that is not needed: where the undecided share
/// goes down as the boundary's cells do, the last step is a single level.
std::size_t PartedMap::next_level(const TreeExtent& all) const {
  constexpr double kMostSteps = 6;
  const auto axes = static_cast<double>(mapped_.space.size());
  const std::size_t known = all.first_open - 1;
  const double by_share = axes * std::log2(all.undecided(known) / std::max(options_.undecided_share, 1e-9)) - 1;
  const double by_cells =
      axes / (axes - 1) * std::log2(static_cast<double>(options_.most_cells) / static_cast<double>(all.cells(known))) -
      1;
  const double steps = std::clamp(std::floor(std::min(by_share, by_cells)), 1.0, kMostSteps);
  return std::min(all.first_open + static_cast<std::size_t>(steps), TreeExtent::kLevels);
}

/// The parts that are not known so far, the largest first: what is known tells how large the rest may be.
std::vector<Task> PartedMap::tasks_up_to(std::size_t level) const {
  std::vector<std::size_t> open;
  for (std::size_t part = 0; part < parts_.size(); ++part) {
    if (extents_[part].first_open < level) open.push_back(part);
  }
  std::ranges::stable_sort(open, std::greater(), [&](std::size_t part) { return trees_[part].size(); });
  std::vector<Task> tasks;
  for (const std::size_t part : open) tasks.push_back(task(part, level));
  return tasks;
}

bool PartedMap::judge(Ranks* ranks, const PartDone& part_done) {
  read_known({});
  const RunTask run_task = [this](const Task& task) { return run(task); };
  for (TreeExtent all = extent(); !MapParts::is_enough(all, options_); all = extent()) {
    const std::vector<Task> tasks = tasks_up_to(next_level(all));
    std::size_t count = 0;
    const TaskDone done = [&](std::size_t task, std::string tree) {
      keep(tasks[task].part, std::move(tree));
      part_done(++count, tasks.size());
    };
    if (ranks != nullptr) {
      ranks->deal(digest_, tasks, run_task, done, options_.stop);
    } else {
      deal_to_threads(tasks, usable_threads(), run_task, done, options_.stop);
    }
    if (options_.stop.stop_requested()) return false;
  }
  return true;
}

std::optional<PartedMap::Made> PartedMap::make_shard(const Shard& shard, const PartDone& part_done) {
  read_known(shard);
  std::vector<Task> tasks = tasks_up_to(TreeExtent::kLevels);
  std::erase_if(tasks, [&](const Task& task) { return !shard.has(task.part); });
  std::size_t count = 0;
  const TaskDone done = [&](std::size_t task, std::string tree) {
    keep(tasks[task].part, std::move(tree));
    part_done(++count, tasks.size());
  };
  deal_to_threads(
      tasks, usable_threads(), [this](const Task& task) { return run(task); }, done, options_.stop);
  if (options_.stop.stop_requested()) return std::nullopt;
  Made made{0, tasks.size()};
  for (std::size_t part = 0; part < parts_.size(); ++part) made.parts += shard.has(part) ? 1 : 0;
  return made;
}

CellMap PartedMap::merge() {
  std::vector<std::string> trees = files_->read_all();
  for (std::size_t part = 0; part < parts_.size(); ++part) set(part, std::move(trees[part]));
  const TreeExtent all = extent();
  if (!MapParts::is_enough(all, options_)) {
    const auto open = std::ranges::find_if(extents_, [](const TreeExtent& part) { return !part.is_complete(); });
    throw InputError(
        ErrorCode::kFile,
        fmt::format("{}: got a part in which not all cells are judged, expected it complete, or so large a share "
                    "--undecided that its cells are enough",
                    files_->file(static_cast<std::size_t>(open - extents_.begin())).string()));
  }
  return map();
}

}  // namespace taut
