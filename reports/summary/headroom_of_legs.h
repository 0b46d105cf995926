// SPDX-License-Identifier: GPL-3.0-or-later
// What of all uncertainties is provable in every leg of a case: the least of what is in each.
#pragma once

#include <cstddef>
#include <nlohmann/json_fwd.hpp>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "certify/headroom.h"
#include "reports/summary/display_units.h"

namespace taut {

/// A leg, and what is known of its headroom.
struct LegHeadroom {
  std::string name;
  const std::optional<Headroom>& headroom;
  const Problem& problem;
};

/// The largest share that is proved in all legs, and a leg in which no larger one is.
struct CommonShare {
  ProvableShare share;
  std::size_t leg = 0;
};

/// That of all uncertainties, and then each that the legs share: the tolerances of the machine, the deviations of each
/// leg's load, and each item of the load over the legs that have it, where that is the same item. As what is proved
/// within a share is so within any smaller one, the least of the legs' shares is proved in all of them.
/// @returns nothing unless the share of all uncertainties is known of the path or the move of every leg
[[nodiscard]] std::vector<CommonShare> common_shares(std::span<const LegHeadroom> legs);

/// "All legs are provable at 120 % of …, together; no more is in leg carry." None where there are no common shares.
[[nodiscard]] std::vector<std::string> headroom_sentences(std::span<const LegHeadroom> legs, const DisplayUnits& units);

/// `shares`, as in the headroom of one path, each with the name of its leg; null where there are no common shares.
[[nodiscard]] nlohmann::json headroom_json(std::span<const LegHeadroom> legs);

}  // namespace taut
