// Margins: what a claim is a conjunction of.
//
// A margin is a function of the pose that must be positive. The prover knows no particular ones: it walks the list that comes
// with a box's enclosure (MarginList in box_proof.h). More kinds (clearance between bodies, inertial wrenches) are more
// functions that add to it, and what deviations change of them.
#pragma once

#include <array>
#include <string>

namespace taut {

enum class MarginKind { kTensionMin, kTensionMax, kLengthMin, kLengthMax };

struct MarginId {
  MarginKind kind = MarginKind::kTensionMin;
  int cable = 0;  ///< 0…5; printed from 1
  bool operator==(const MarginId&) const = default;
};

/// "tension_min", "tension_max", "length_min", "length_max".
[[nodiscard]] const char* name(MarginKind kind);

}  // namespace taut
