// SPDX-License-Identifier: GPL-3.0-or-later
// Guesses, in floating point, at what may be wrong with a path file's columns. What is read never depends on them.
#pragma once

#include <string>

#include "kinematics/pose_sampler.h"
#include "path_io/path_file.h"

namespace taut {

/// A line of text that suspects quaternions of being written w first, or two columns of having been exchanged. It is
/// empty where the first row's pose is within all limits as it was read, or where no such guess helps.
[[nodiscard]] std::string column_hint(const PoseSampler& sampler, const PathHeader& header, const PathRow& first);

}  // namespace taut
