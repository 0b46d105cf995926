// SPDX-License-Identifier: GPL-3.0-or-later
// Finds where implied motions are, along a path and along the way of a deviation, so that the checker's kernel can
// prove them. What is found here is floating point: it proves nothing.
#pragma once

#include <optional>

#include "checker/kernel/deviant.h"
#include "kinematics/model.h"

namespace taut {

/// Where the implied motion of a box of segment k is; nothing where it is not found. The kernel may be unable to prove
/// it.
/// @pre `machine` has the precision of the box
[[nodiscard]] std::optional<checker::NearZero> find_motion(const checker::Machine& machine,
                                                           const checker::Problem& problem, const checker::Path& path,
                                                           std::size_t k, const checker::Box& box);

/// Finds poses and boxes with which the kernel follows a deviation as it grows, beginning at `stated`, and puts them
/// into `deviation`. @returns false where the kernel cannot be led to its end.
/// @param model  the machine as the problem states it
[[nodiscard]] bool find_way(const checker::Machine& machine, const checker::Geometry& stated,
                            const Model<double>& model, checker::WitnessDeviation& deviation, int bits);

}  // namespace taut
