// SPDX-License-Identifier: GPL-3.0-or-later
#include "reports/summary/file_lines.h"

#include <algorithm>
#include <nlohmann/json.hpp>

namespace taut {
namespace {

constexpr std::size_t kMostRuns = 10'000;

}  // namespace

FileLines::FileLines(const nlohmann::json& json) {
  const auto is_count = [](const nlohmann::json& number) { return number.is_number_integer() && number >= 0; };
  if (!json.is_object() || !json.contains("runs") || !json.contains("waypoints")) return;
  if (!json["runs"].is_array() || !is_count(json["waypoints"])) return;
  std::vector<Run> runs;
  for (const nlohmann::json& run : json["runs"]) {
    if (!run.is_array() || run.size() != 2 || !is_count(run[0]) || !is_count(run[1])) return;
    if (run[0] < (runs.empty() ? 0 : runs.back().waypoint + 1)) return;
    runs.push_back({run[0], run[1]});
  }
  runs_ = std::move(runs);
  waypoints_ = json["waypoints"];
}

void FileLines::add(std::size_t line) {
  if (is_full_) return;
  if (runs_.empty() || line != runs_.back().line + (waypoints_ - runs_.back().waypoint)) {
    is_full_ = runs_.size() == kMostRuns;
    if (is_full_) return;
    runs_.push_back({waypoints_, line});
  }
  ++waypoints_;
}

std::optional<std::size_t> FileLines::line_of(std::size_t waypoint) const {
  if (waypoint >= waypoints_) return std::nullopt;
  const auto next = std::ranges::upper_bound(runs_, waypoint, {}, &Run::waypoint);
  if (next == runs_.begin()) return std::nullopt;
  const Run& run = *std::prev(next);
  return run.line + (waypoint - run.waypoint);
}

nlohmann::json FileLines::to_json() const {
  nlohmann::json runs = nlohmann::json::array();
  for (const Run& run : runs_) runs.push_back({run.waypoint, run.line});
  return {{"runs", runs}, {"waypoints", waypoints_}};
}

}  // namespace taut
