// SPDX-License-Identifier: GPL-3.0-or-later
// Proposes where a machine that holds its cables' lengths may be found: inner poses and tubes of a segment's reference.
//
// The reference is a polyline near the motion, which Newton's method finds in floating point, and each of its pieces
// has a tube of a few times the distance between the two. A piece is kept once binary64 intervals prove that there is
// one pose in its tube all along it, at one go; else it is halved. So pieces are short where the motion bends, as it
// does next to singular poses. A heuristic: whatever it proposes, the proof of a box judges it afresh.
#pragma once

#include "certify/box_proof.h"

namespace taut {

/// Sets pose_tube and inner_poses. Where no proof succeeds, however short the pieces, one
/// unproved piece spans the gap between forward and backward continuation.
/// @param approx  the same problem
/// @pre `segment` is of the law of cable lengths; its waypoints have all their numbers, and these are finite.
void propose_reference(const ProofModel<Interval>& model, const Model<double>& approx, Segment& segment);

}  // namespace taut
