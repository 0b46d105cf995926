// SPDX-License-Identifier: GPL-3.0-or-later
// A machine that deviates as a witness states, at the pose to which the deviation leads.
//
// A machine whose pose is controlled stays at the commanded pose; one whose lengths are controlled is led away from it
// by deviations of anchors and lengths. Tracking errors come on top: p + position, R(turn, 1) R.
//
// Where a deviation leads.  A length-controlled machine's anchors and lengths grow into a_i + tau a_i', b_i + tau b_i',
// L_i + tau e_i, tau from 0 to 1. The witness states a reference polyline in tau and tubes around it, and boxes of tau
// that tile [0, 1]: for each there is exactly one pose in the tube for every tau (motion.h with anchors that depend on
// u). The derivatives by the pose are non-singular in the tube, so that pose is continuous in tau and never singular.
// At tau = 0 the commanded pose has these lengths and lies in the tube, so it is that pose. Where two tubes meet one
// contains the other: the pose goes on. So at tau = 1 it is the pose to which the deviation leads.
#pragma once

#include "checker/kernel/motion.h"

namespace taut::checker {

/// The machine over a box of the way of a deviation that grows, tau in place of s, near the reference that the
/// deviation states. @param stated  the machine as the problem states it, at the commanded pose
[[nodiscard]] LengthControlled growing_deviation(const Machine& machine, const Geometry& stated,
                                                 const WitnessDeviation& by, const Box& box);

/// The machine that deviates, and where it is.
struct Deviant {
  Machine machine;
  Geometry geometry;
};
/// @param stated  the machine as the problem states it, at the commanded pose, at one place of the path
/// @throws Rejected where the deviation is not within the tolerances; Undefined where its pose is not shown.
[[nodiscard]] Deviant deviant(const Machine& machine, const Problem& problem, const Geometry& stated,
                              const WitnessDeviation& by);

}  // namespace taut::checker
