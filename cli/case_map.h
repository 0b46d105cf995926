// SPDX-License-Identifier: GPL-3.0-or-later
// A case's map, and what `taut map` says of it.
#pragma once

#include <nlohmann/json_fwd.hpp>
#include <optional>
#include <string>
#include <vector>

#include "case/waypoint.h"
#include "cli/output.h"
#include "map/topology.h"
#include "reports/map/map_result.h"

namespace taut {

/// Where one starts from.
struct MapStart {
  std::string words;  ///< "waypoint 0 of the query"
  TypedWaypoint waypoint;
};

/// A case that has a map.
struct MappedCase {
  /// @param from  the number of a waypoint of the query, or coordinates; empty: the first of the query, if it has one
  /// @throws InputError for a case that can't be read or has no map, and for a start that is none
  MappedCase(const std::string& case_path, const std::string& from);

  MapSpace space;
  Case the_case;
  std::optional<MapStart> start;
};

/// The map, what hangs together, and what is known of the ways between the query's waypoints.
class CaseMap {
 public:
  using Connection = MapTopology::Connection;

  /// @param seconds  that the map took
  CaseMap(const MappedCase& mapped, CellMap map, double seconds);
  CaseMap(const CaseMap&) = delete;  // the result refers to the map
  CaseMap& operator=(const CaseMap&) = delete;
  ~CaseMap() = default;

  [[nodiscard]] const MapResult& result() const { return result_; }
  [[nodiscard]] double seconds() const { return seconds_; }  ///< that the map took
  /// Of the query's waypoints.
  [[nodiscard]] const std::vector<std::vector<MapBox>>& places() const { return places_; }
  /// From each waypoint to the next.
  [[nodiscard]] const std::vector<Connection>& connections() const { return connections_; }
  /// Where one starts; empty without a start.
  [[nodiscard]] const std::vector<MapBox>& start() const { return start_; }

 private:
  CellMap map_;
  double seconds_;
  MapTopology topology_;
  std::vector<std::vector<MapBox>> places_;
  std::vector<Connection> connections_;
  std::vector<MapBox> start_;
  MapResult result_;
};

/// Prints it for people.
void print(const Case& the_case, const CaseMap& made);

/// The same for programs (docs/json.md), without what is common to all commands.
[[nodiscard]] nlohmann::json to_json(const Case& the_case, const CaseMap& made);

}  // namespace taut
