// SPDX-License-Identifier: GPL-3.0-or-later
// Margins: what a claim is a conjunction of.
//
// A margin is a function of the pose that must be positive. The prover knows no particular ones: it walks the list that
// comes with a box's enclosure (MarginList in box_proof.h). More kinds (clearance between bodies, inertial wrenches)
// are more functions that add to it, and what deviations change of them.
#pragma once

#include <array>

#include "kinematics/model.h"
#include "kinematics/statics.h"

namespace taut {

enum class MarginKind { kTensionMin, kTensionMax, kLengthMin, kLengthMax };

struct MarginId {
  MarginKind kind = MarginKind::kTensionMin;
  int cable = 0;  ///< 0…5; printed from 1
  bool operator==(const MarginId&) const = default;
};

/// "tension_min", "tension_max", "length_min", "length_max".
[[nodiscard]] const char* name(MarginKind kind);

[[nodiscard]] constexpr std::array<MarginId, 4 * kCables> all_margins() {
  std::array<MarginId, 4 * kCables> result;
  std::size_t n = 0;
  for (const MarginKind kind :
       {MarginKind::kTensionMin, MarginKind::kTensionMax, MarginKind::kLengthMin, MarginKind::kLengthMax}) {
    for (int cable = 0; cable < static_cast<int>(kCables); ++cable) result[n++] = {kind, cable};
  }
  return result;
}

/// What a margin keeps inside a limit: f0 − v, f0 + v [N] or d [m].
template <class S>
[[nodiscard]] S limited_quantity(const Statics<S>& statics, MarginId margin) {
  const auto i = static_cast<std::size_t>(margin.cable);
  switch (margin.kind) {
    case MarginKind::kTensionMin: return statics.tension[i] - statics.tension_below[i];
    case MarginKind::kTensionMax: return statics.tension[i] + statics.tension_above[i];
    case MarginKind::kLengthMin:
    case MarginKind::kLengthMax: break;
  }
  return statics.length[i];
}

/// The distance from the quantity that `margin` limits to its limit; negative beyond the limit.
template <class S>
[[nodiscard]] S slack(const Model<S>& model, const S& quantity, MarginId margin) {
  const auto i = static_cast<std::size_t>(margin.cable);
  switch (margin.kind) {
    case MarginKind::kTensionMin: return quantity - model.tension_lower[i];
    case MarginKind::kTensionMax: return model.tension_upper[i] - quantity;
    case MarginKind::kLengthMin: return quantity - model.length_lower[i];
    case MarginKind::kLengthMax: break;
  }
  return model.length_upper[i] - quantity;
}

}  // namespace taut
