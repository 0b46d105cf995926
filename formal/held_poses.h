// SPDX-License-Identifier: GPL-3.0-or-later
// A path whose cables' lengths are straight, from pose to pose of its reference, as formal/Statement.v has it: each
// waypoint or inner pose with its lengths, and the tube that begins there.
#pragma once

#include <array>
#include <cstddef>
#include <vector>

#include "kinematics/segment.h"
#include "problem/rational.h"

namespace taut::formal {

struct HeldPose {
  std::array<double, 7> pose{};     ///< px, py, pz [m], qx, qy, qz, qw
  std::array<Rational, 6> lengths;  ///< [m]
  PoseTube tube;                    ///< none at the end of the path
  std::size_t segment = 0;          ///< which begins here, or in which this is
  double s = 0;                     ///< where in it
};

/// @pre the path's law is that of cable lengths, and it has a segment
[[nodiscard]] std::vector<HeldPose> held_poses(const Path& path);

}  // namespace taut::formal
