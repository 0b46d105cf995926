// SPDX-License-Identifier: GPL-3.0-or-later
// On which lines of an audited file its waypoints stand, for people who look into that file. Nothing checks it.
#pragma once

#include <nlohmann/json_fwd.hpp>
#include <optional>
#include <utility>
#include <vector>

namespace taut {

class FileLines {
 public:
  FileLines() = default;
  /// As to_json() writes them. What is not of that form says nothing.
  explicit FileLines(const nlohmann::json& json);

  /// Adds the line of the next waypoint. Files with very many gaps are only kept up to a place.
  void add(std::size_t line);
  /// The line of waypoint k; nothing where it is not known.
  [[nodiscard]] std::optional<std::size_t> line_of(std::size_t waypoint) const;

  /// `{"runs": [[0, 2], [40, 45]], "waypoints": 90}`: waypoint 0 is on line 2 and those after it on the lines after
  /// that, until waypoint 40, which is on line 45; waypoint 89 is the last one known.
  [[nodiscard]] nlohmann::json to_json() const;

 private:
  /// Waypoints that stand on successive lines: the first of them, and its line.
  struct Run {
    std::size_t waypoint, line;
  };
  std::vector<Run> runs_;
  std::size_t waypoints_ = 0;
  bool is_full_ = false;
};

}  // namespace taut
