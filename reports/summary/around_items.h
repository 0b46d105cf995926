// SPDX-License-Identifier: GPL-3.0-or-later
// The items that a case puts one ellipsoid around, and what the ellipsoid costs. A certificate's problem has the
// ellipsoid alone: what is said here travels in its `illustration`, which nothing checks.
#pragma once

#include <nlohmann/json_fwd.hpp>
#include <optional>
#include <string>
#include <vector>

#include "certificate/certificate.h"
#include "reports/summary/display_units.h"
#include "reports/summary/load_statement.h"

namespace taut {

/// What becomes of the same path where the items take the place of the ellipsoid. Margins are those of a proved path of
/// at least a segment.
struct AsItems {
  std::string subject =
      "this path";  ///< or "waypoint 1 of the query", "the straight way through the query's waypoints"
  Verdict verdict = Verdict::kUndecided;
  std::optional<Margins> margins, of_ellipsoid;
};

/// `as_items` in the JSON of commands and in an illustration: verdict and margins, in SI; null for nothing.
[[nodiscard]] nlohmann::json to_json(const std::optional<AsItems>& found);
/// Whether the ellipsoid stands in the way, or by how much it makes margins smaller.
[[nodiscard]] std::string sentence(const AsItems& found, const DisplayUnits& units);

/// `around_items` in an illustration: the keys of to_json(LoadStatement), with numbers in strings.
[[nodiscard]] nlohmann::json stated_json(const LoadStatement& items);
/// What a certificate's illustration says; nothing where it says nothing, or not what taut writes.
[[nodiscard]] std::optional<LoadStatement> stated_items(const Certificate& certificate);
[[nodiscard]] std::optional<AsItems> stated_as_items(const Certificate& certificate);

/// The load of a report, where nothing checks `around_items`: K itself comes first, and the items behind words that say
/// so. The JSON has the keys of to_json(LoadStatement).
[[nodiscard]] std::vector<std::string> report_lines(const LoadStatement& load);
[[nodiscard]] nlohmann::json report_json(const LoadStatement& load);
inline constexpr const char* kItemsNotChecked =
    "From the case, not checked: this ellipsoid was put around the items that follow. The verdict is about the "
    "ellipsoid, which contains other loads besides.";

}  // namespace taut
