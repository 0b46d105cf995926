// SPDX-License-Identifier: GPL-3.0-or-later
// What stands in the way of a proof, or by how much it succeeds, in words and as JSON.
#pragma once

#include <nlohmann/json_fwd.hpp>
#include <string>
#include <vector>

#include "base/json_cursor.h"
#include "certify/headroom.h"
#include "reports/summary/display_units.h"

namespace taut {

/// The object `headroom` of an `illustration` (docs/sensitivity.md): numbers are strings, in SI.
[[nodiscard]] nlohmann::json to_json(const Headroom& headroom);
/// Its inverse. @throws FieldError
[[nodiscard]] Headroom headroom_from_json(const JsonCursor& json);

/// Sentences: what is tightest, the provable share of all uncertainties, and each alone. None if nothing was sought.
/// @param problem  what the headroom is about; items that it has not are named without a size
[[nodiscard]] std::vector<std::string> headroom_sentences(const Headroom& headroom, const Problem& problem,
                                                          const DisplayUnits& units);

/// How far one uncertainty may go alone, with all others as stated, as the program says that sought it.
struct EachAlone {
  Uncertainty of;
  std::string what;         ///< "base anchors"
  std::string share;        ///< "183 %", or "none"; empty where nothing is stated
  std::string size;         ///< "0.183 mm"; empty of sets and where no share is provable
  double used = 0;          ///< what is stated, in percent of what could be; 0 where nothing is stated
  bool is_complete = true;  ///< else time ended the search

  /// "183 % (0.183 mm)", "up to 0.2 mm", "none".
  [[nodiscard]] std::string words() const;
};
/// One for each that was sought and says anything, in the order of the headroom.
[[nodiscard]] std::vector<EachAlone> each_alone(const Headroom& headroom, const Problem& problem,
                                                const DisplayUnits& units);

/// "62 %", exactly.
[[nodiscard]] std::string percent_text(const DecimalText& share);

}  // namespace taut
