// SPDX-License-Identifier: GPL-3.0-or-later
// What a witness claims: a limit broken or bodies in contact at one pose of the path, or a sign change of det J between
// two.
//
// A limit kind: at the pose of the path (shown by kernel/motion.h, at one place), for the machine as the problem states
// it or with the deviation that the witness states (kernel/deviant.h), the named quantity is within `value`, which lies
// beyond the limit. Where the witness states a load of each item, a tension is that under these loads (and, of the
// ellipsoid, the worst). That the motion of the path leads to this pose is shown by confirm.cc.
//
// In a move the quantity is enclosed for all times at which the move is at this place, which may be many where it rests
// there, and tensions are those of w - w_in (kernel/moving.h). The enclosure holds w_in for every mass and centre of
// gravity that the load allows, so it also holds the tension of the one load that is worst. A machine that deviates has
// the velocities and accelerations that path and law command. A limit in time is broken where the rate, or a winch's
// power, is not below it. Where the move may be slowed down, a witness may state how it is run there.
#pragma once

#include "checker/format/witness.h"
#include "checker/kernel/clearance.h"
#include "checker/kernel/deviant.h"

namespace taut::checker {

/// det D at a place of the path. @throws Undefined where the pose is not shown.
[[nodiscard]] Ball determinant_at(const Machine& machine, const Problem& problem, const Path& path,
                                  const PathPoint& place, const Box& how);

/// The least or largest tension [N] or |d| [m] of the witness's cable, at its pose and for its machine; of a limit in
/// time, the magnitude of the rate or the power (the largest tension, for its machine, times the commanded speed), in
/// SI units. @pre the witness is
/// of a limit, which in time the problem states, and a path with a law has one (require_time_law)
/// @throws Rejected where the deviation is not within the tolerances, or a load not in its item, or where a move's
/// witness has loads; Undefined where the quantity can't be enclosed.
[[nodiscard]] Ball witnessed_quantity(const Machine& machine, const Problem& problem, const Path& path,
                                      const Witness& witness);

/// Confirms that this quantity is within the witness's `value`; and of a limit in time, that no number in `value` is
/// below it. @pre `value` lies beyond any other limit.
/// @throws Rejected where it is certainly outside, or a number in `value` certainly below the limit; Undefined where
/// that can't be told.
void confirm_violation(const Machine& machine, const Problem& problem, const Path& path, const Witness& witness);

/// By how much the bodies of a witness of contact are nearer than is allowed, at least, for the machine as stated.
/// @pre geometry is that of its pose
/// @throws Undefined where it can't be told.
[[nodiscard]] Ball witnessed_depth(const Machine& machine, const Geometry& geometry, const Witness& witness);

/// Confirms that the two points of a witness of contact, of the machine as stated and at its pose, are no farther apart
/// than the radii around them and the clearance of the pair are together; or that one point is inside of a closed mesh,
/// or four pairs of points around a common point.
/// @throws Rejected where they certainly are; Undefined where that can't be told.
void confirm_contact(const Machine& machine, const Problem& problem, const Path& path, const Witness& witness);

}  // namespace taut::checker
