// SPDX-License-Identifier: GPL-3.0-or-later
// Writes the parts of a certificate that say how it is proved, as reader.h reads them.
#pragma once

#include <nlohmann/json.hpp>

#include "checker/format/witness.h"

namespace taut::checker {

[[nodiscard]] nlohmann::json to_json(const NearZero& near);
/// An entry of `path.directions`.
[[nodiscard]] nlohmann::json to_json(const Direction& direction);
/// An entry of `apart`: null, an index, or a list of them.
[[nodiscard]] nlohmann::json apart_to_json(const std::vector<std::size_t>& directions);
/// `apart` of a segment and, unless there are none, of a box.
[[nodiscard]] nlohmann::json apart_to_json(const Apart& apart);
[[nodiscard]] nlohmann::json apart_to_json(const ApartChanges& changes);
/// Without `apart`.
/// @param has_tolerances  whether the problem has tolerances: then a box of a segment has `parts` and `guesses`.
[[nodiscard]] nlohmann::json to_json(const Box& box, bool has_tolerances);
/// The `proof` of a witness: a box without its ends.
[[nodiscard]] nlohmann::json proof_to_json(const Box& box);
[[nodiscard]] nlohmann::json to_json(const MotionBox& box);
/// The key `way` of a witness's deviation: null where there are no boxes.
[[nodiscard]] nlohmann::json way_to_json(const WitnessDeviation& deviation);

}  // namespace taut::checker
