// SPDX-License-Identifier: GPL-3.0-or-later
// The theorem of a proved box, from the clauses: motion.h (where the machine is), machine.h and loads.h (machine,
// loads, limits), deviation.h (what tolerances take away) and clearance.h (bodies).
#pragma once

#include "checker/kernel/machine.h"

namespace taut::checker {

/// Proved lower bounds over a box; each is one number.
struct Bounds {
  Ball tension;  ///< of the least tensions minus f_lo,i, and of f_hi,i minus the largest [N]
  Ball length;   ///< of d_i - d_lo,i and d_hi,i - d_i [m]
  /// K may be so many times as large, about its nominal wrench, before a tension reaches its limit. Of a move 1: that K
  /// may grow is not claimed of moves.
  Ball wrench_scale;
  /// Where bodies are stated: of the least distance of a checked pair minus its clearance, and which pair that is [m].
  std::optional<Ball> clearance;
  std::size_t closest_pair = 0;
};

/// Claim. For every s of the box, every machine, load and pose within the tolerances: the pose exists, its parameters
/// are in their ranges, J is non-singular, tensions and lengths keep the returned distances from their limits, and the
/// bodies of each checked pair that from its clearance. Of a move, tensions are those with inertia at every time at
/// which it is on the box, and the limits in time are kept; a winch's power is for every machine, load and pose, too,
/// but with the commanded speed of its cable.
/// @pre the box reaches across no inner pose, and its precision is the working precision of `machine`
/// @param apart  along which of the path's directions each pair of bodies is told apart
/// @param enough  if given, no larger clearance of a mesh is asked for [m]
/// @throws Undefined where that is not proved at one go. The bounds may be negative: the caller asks for more.
[[nodiscard]] Bounds prove_box(const Machine& machine, const Problem& problem, const Path& path, std::size_t k,
                               const Box& box, const Apart& apart = {}, const std::optional<mpq_class>& enough = {});

}  // namespace taut::checker
