// SPDX-License-Identifier: GPL-3.0-or-later
// What a certificate's `illustration` says of the search: free text of the program that wrote it, not checked.
#pragma once

#include <array>
#include <map>
#include <nlohmann/json_fwd.hpp>
#include <string>
#include <vector>

#include "reports/summary/display_units.h"

namespace taut {

struct Illustration {
  /// How far a tolerance could grow alone; as printed.
  struct ToleranceLimit {
    std::string tolerance;  ///< key of the case file
    std::string proved;
    std::string unit;
  };
  /// A chart's polygon in the plane of two parameters.
  struct Chart {
    std::vector<double> centre;
    std::vector<std::array<double, 2>> corners;
  };

  std::vector<ToleranceLimit> tolerance_limits;
  std::vector<Chart> charts;                 ///< none unless the space has two parameters
  std::map<std::string, std::string> stats;  ///< of the search, as printed
  DisplayUnits units;                        ///< the case's, in which the report shows results

  Illustration() = default;
  /// @throws InputError for a missing key or a wrong type.
  Illustration(const nlohmann::json& json, std::size_t parameters);
};

}  // namespace taut
