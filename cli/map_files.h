// SPDX-License-Identifier: GPL-3.0-or-later
// The files that `taut map` writes.
#pragma once

#include <array>
#include <filesystem>
#include <optional>
#include <stop_token>
#include <vector>

#include "cli/case_map.h"
#include "cli/map_command.h"
#include "cli/map_path.h"
#include "map/grid.h"

namespace taut {

/// What is to be written. Refers to its arguments.
class MapFiles {
 public:
  /// Checks all that can be checked before the map is made. @throws InputError
  MapFiles(const MapArguments& arguments, const MappedCase& mapped);

  /// Writes all of them, or none. @returns their paths; nothing where `stop` asked to stop.
  /// @throws InputError; BrowserFailed
  [[nodiscard]] std::optional<std::vector<std::filesystem::path>> write(const CaseMap& made,
                                                                        const std::stop_token& stop) const;

 private:
  const MapArguments& arguments_;
  const MappedCase& mapped_;
  GridSize grid_size_{1, 1, 1};
  std::vector<MapLine> path_, charts_;  ///< to draw
};

}  // namespace taut
