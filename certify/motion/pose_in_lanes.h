// SPDX-License-Identifier: GPL-3.0-or-later
// forward_kinematics() in binary64 for all six cables at once, by the kernel of certify/lanes.
#pragma once

#include "certify/lanes/kernel.h"
#include "certify/motion/length_controlled_motion.h"

namespace taut {

/// As forward_kinematics(); its numbers are not the templates', but the same on all levels.
/// @param machine  made of `model` (forms_in_lanes.h)
[[nodiscard]] MotionEnclosure<Interval> forward_kinematics_in_lanes(const lanes::Kernels& kernels,
                                                                    const lanes::Machine& machine,
                                                                    const Model<Interval>& model,
                                                                    const Segment& segment, const Interval& range,
                                                                    const Interval& mid, const Interval& offset);

}  // namespace taut
