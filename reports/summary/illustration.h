// SPDX-License-Identifier: GPL-3.0-or-later
// What a certificate's `illustration` says of the search: free text of the program that wrote it, not checked.
#pragma once

#include <array>
#include <map>
#include <nlohmann/json_fwd.hpp>
#include <optional>
#include <string>
#include <vector>

#include "case/decoration.h"
#include "case/document_fields.h"
#include "certify/headroom.h"
#include "reports/summary/display_units.h"
#include "reports/summary/file_lines.h"

namespace taut {

struct Illustration {
  /// A chart's polygon in the plane of two parameters.
  struct Chart {
    std::vector<double> centre;
    std::vector<std::array<double, 2>> corners;
  };

  /// A table to which the move was fitted.
  struct Table {
    std::size_t rows = 0;
    std::string rounding;  ///< stated: "0.1 mm and 0.01 deg"
    bool is_of_lengths = false;
  };

  std::optional<Headroom> headroom;
  std::optional<Table> table;
  std::vector<Chart> charts;                 ///< none unless the space has two parameters
  std::map<std::string, std::string> stats;  ///< of the search, as printed
  DisplayUnits units;                        ///< the case's, in which the report shows results
  FileLines lines;                           ///< of an audited file, where waypoints stand
  DocumentFields document_fields;            ///< the case's, for the head of the report
  Decoration decoration;                     ///< the case's, for its pictures

  Illustration() = default;
  /// @throws InputError for a missing key or a wrong type.
  Illustration(const nlohmann::json& json, std::size_t parameters);
};

/// The object `document_fields` of an illustration: the fields that are not empty, by their names.
[[nodiscard]] nlohmann::json to_json(const DocumentFields& fields);
/// Reads it. A field that a case could not state is taken as not stated: anybody can alter an illustration.
[[nodiscard]] DocumentFields document_fields_from_json(const nlohmann::json& fields);

}  // namespace taut
