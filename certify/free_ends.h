// SPDX-License-Identifier: GPL-3.0-or-later
// With how much longer free ends of cables a path is proved, where cables touch what they are made fast to, or each
// other at a common anchor.
//
// A length is stated only after a proof of the whole path, of the problem with exactly this decimal. Which ends may
// help is floating point's guess.
#pragma once

#include <array>
#include <optional>
#include <span>
#include <stop_token>

#include "certify/prover.h"

namespace taut {

/// Lengths near the base's and the platform's anchors [m]; nothing where those of the problem stay as they are.
using FreeEnds = std::array<std::optional<DecimalText>, 2>;

/// The problem in which no cable's free end is shorter than these. @pre problem.bodies
[[nodiscard]] Problem with_free_ends(Problem problem, const FreeEnds& free_ends);

/// Free ends with which the whole path was proved.
struct ProvedFreeEnds {
  FreeEnds free_ends;       ///< one of them at least
  bool is_complete = true;  ///< false: time ended the search, and shorter ones may do
};

/// Seeks the shortest of two digits, up to a fifth of the shortest cable. Nothing where something else touches than
/// cables near their own anchors: an obstacle near the platform's end, for one, is not to be hidden.
/// @param prover    of the problem, in which the path is not proved
/// @param segments  of the path, prepared
[[nodiscard]] std::optional<ProvedFreeEnds> find_free_ends(const Prover& prover, std::span<const Segment> segments,
                                                           const std::stop_token& stop);

}  // namespace taut
