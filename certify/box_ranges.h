// SPDX-License-Identifier: GPL-3.0-or-later
// What tensions and lengths do over boxes of a path, in numbers: for reports. Margins say whether limits are kept;
// these say what is between them.
//
// Claim.  Over a box, at every pose of it, for every load in K and every deviation within the tolerances, the tension
// of cable i is in tension[i] and its length in length[i]. Enclosed as a proof encloses them (box_proof.h), rounded
// outward. No part of a certificate: computed anew, from the path and the problem alone.
#pragma once

#include <array>
#include <optional>
#include <vector>

#include "certify/prover.h"

namespace taut {

/// All numbers from lower to upper.
struct Range {
  double lower = 0;
  double upper = 0;

  [[nodiscard]] friend Range hull(const Range& a, const Range& b) {
    return {a.lower < b.lower ? a.lower : b.lower, a.upper > b.upper ? a.upper : b.upper};
  }
};

struct BoxRanges {
  DyadicBox box;
  std::array<Range, kCables> tension;  ///< from f0_i − v_i to f0_i + v_i [N]
  std::array<Range, kCables> length;   ///< d_i [m]
  /// About how much wider these are than what they enclose, as a share of the width between limits; it falls with the
  /// square of the box's width. Floating point: for deciding whether to halve the box.
  double excess = 0;
};

/// In binary64 intervals; nothing where the motion or the tensions can't be enclosed over all of the box.
[[nodiscard]] std::optional<BoxRanges> enclose_ranges(const ProofModel<Interval>& problem, const Segment& segment,
                                                      const DyadicBox& box);
/// At working_precision().
[[nodiscard]] std::optional<BoxRanges> enclose_ranges(const ProofModel<MpInterval>& problem, const Segment& segment,
                                                      const DyadicBox& box);

struct RangeOptions {
  /// Boxes are halved until their excess is below this, at most so often. Half a percent is about a pixel of a plot.
  double excess = 0.005;
  int most_halvings = 5;
  /// Boxes that binary64 can't enclose are tried with more bits, the first so many along the path. A right certificate
  /// has few such boxes; in a wrong one, all might be such, at tens of milliseconds each.
  std::size_t most_hard = 1000;
};

struct PathRanges {
  std::vector<std::vector<BoxRanges>> segments;  ///< in order along each; a box may come in pieces
  std::size_t missing = 0;  ///< boxes that were not enclosed: it failed, or there were too many that are hard
};

/// Encloses the ranges over the boxes of each segment, on all cores. A piece costs what judging a box costs; a box
/// whose claim is false has seven pieces in binary64 and two in more bits. The result does not depend on the number of
/// threads.
/// @param boxes  of the first segments of the path, or of all.
[[nodiscard]] PathRanges path_ranges(const Prover& prover, const Path& path,
                                     const std::vector<std::vector<DyadicBox>>& boxes,
                                     const RangeOptions& options = {});

}  // namespace taut
