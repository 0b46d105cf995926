// SPDX-License-Identifier: GPL-3.0-or-later
// How far each tolerance alone may grow before the proof of a path fails.
#pragma once

#include <stop_token>
#include <string>
#include <vector>

#include "certify/prover.h"

namespace taut {

enum class ToleranceKind { kBaseAnchors, kPlatformAnchors, kLoadPoint, kLoad, kPosition, kOrientation, kCableLengths };

/// "base_anchors", …: the key of a case file.
[[nodiscard]] const char* name(ToleranceKind kind);

/// What a tolerance may grow to, all others as stated: proved at `proved`, for every deviation; beyond, the proof fails
/// or was not tried. Sizes are in m or rad, of six the largest; of the load the largest of the wrench's six numbers, in
/// N or N m.
struct ToleranceLimit {
  ToleranceKind kind = ToleranceKind::kBaseAnchors;
  double stated = 0;
  double proved = 0;  ///< rounded down
};

/// The limits of all kinds, by bisection; each is shown by a proof of the whole path. A tolerance that is not stated
/// grows from nothing, that of the load along w0. The limit of cable lengths is sought only where lengths are
/// controlled.
/// @pre The path is proved with the problem's tolerances.
[[nodiscard]] std::vector<ToleranceLimit> tolerance_limits(const Problem& problem, const Path& path,
                                                           const std::stop_token& stop);

}  // namespace taut
