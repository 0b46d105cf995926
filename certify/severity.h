// SPDX-License-Identifier: GPL-3.0-or-later
// How grave a violation is: one rule for which violation a result names first.
#pragma once

#include "certify/path_proof.h"

namespace taut {

[[nodiscard]] constexpr bool is_length(MarginId margin) {
  return margin.kind == MarginKind::kLengthMin || margin.kind == MarginKind::kLengthMax;
}
[[nodiscard]] constexpr bool is_upper(MarginId margin) {
  return margin.kind == MarginKind::kTensionMax || margin.kind == MarginKind::kLengthMax;
}
/// The two limits of the quantity that a margin keeps within one of them [N, m].
[[nodiscard]] const Limits& limits_of(const RobotText& robot, MarginId margin);

/// By how much a violation is proved to break its limit, as a share of the width between the two limits of that
/// quantity: 0.1 is a tenth of it. Infinite for a singular pose. Bodies that are too near come next, the deepest
/// contact first: that is a million, and how much nearer than allowed they are [m].
[[nodiscard]] double severity(const PathWitness& witness, const RobotText& robot);

}  // namespace taut
