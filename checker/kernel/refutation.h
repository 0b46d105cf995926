// SPDX-License-Identifier: GPL-3.0-or-later
// What a witness claims: a limit broken at one pose of the path, or a sign change of det J between two.
//
// A limit kind: at the pose of the path (shown by motion.h, at one place), for the machine as the problem states it or with
// the deviation that the witness states, the named quantity is within `value`, which lies beyond the limit.
//
// Where a deviation leads.  A length-controlled machine's anchors and lengths grow into a_i + tau a_i', b_i + tau b_i',
// L_i + tau e_i, tau from 0 to 1. The witness states a reference polyline in tau and tubes around it, and boxes of tau that
// tile [0, 1]: for each there is exactly one pose in the tube for every tau (motion.h with anchors that depend on u). The
// derivatives by the pose are non-singular in the tube, so that pose is continuous in tau and never singular. At tau = 0 the
// commanded pose has these lengths and lies in the tube, so it is that pose. Where two tubes meet one contains the other: the
// pose goes on. So at tau = 1 it is the pose to which the deviation leads.
#pragma once

#include "checker/kernel/motion.h"

namespace taut::checker {

/// The machine over a box of the way of a deviation that grows, tau in place of s, near the reference that the deviation
/// states. @param stated  the machine as the problem states it, at the commanded pose
[[nodiscard]] LengthControlled growing_deviation(const Machine& machine, const Geometry& stated,
                                                 const WitnessDeviation& by, const Box& box);

/// det D at a place of the path. @throws Undefined where the pose is not shown.
[[nodiscard]] Ball determinant_at(const Machine& machine, const Problem& problem, const Path& path,
                                  const PathPoint& place, const Box& how);

/// f0 - v, f0 + v [N] or d [m] of the witness's cable, at its pose and for its machine. @pre not kSingular
/// @throws Rejected where the deviation is not within the tolerances; Undefined where the quantity can't be enclosed.
[[nodiscard]] Ball witnessed_quantity(const Machine& machine, const Problem& problem, const Path& path,
                                      const Witness& witness);

/// Confirms that this quantity is within the witness's `value`. @pre `value` lies beyond the limit.
/// @throws Rejected where it is certainly outside; Undefined where that can't be told.
void confirm_violation(const Machine& machine, const Problem& problem, const Path& path, const Witness& witness);

}  // namespace taut::checker
