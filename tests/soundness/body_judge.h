// SPDX-License-Identifier: GPL-3.0-or-later
// Trials of the clause "clearance": random bodies around a segment, a hidden contact or a pair that is just clear.
#pragma once

#include <cstdint>

#include "tests/soundness/tally.h"

namespace taut::campaign {

/// Judges the trial of one seed. Within PrecisionScope(oracle::kBits).
void judge_bodies(std::uint64_t seed, const Options& options, Tally& tally);

}  // namespace taut::campaign
