// SPDX-License-Identifier: GPL-3.0-or-later
// Confirms that no path exists: closed cells tile the space, those with a reason hold no feasible pose, and all others
// that can be reached from the first waypoint, from cell to cell that share a pose, leave out the second.
//
// The argument (docs/theory.md, "Maps"): the poses of a feasible motion lie in finitely many closed cells that have no
// reason. An interval is connected, so these cells hang together by shared poses. Cells that share a pose are found
// exactly, with integers; places of waypoints are rounded outward. A waypoint in cells with reasons alone is itself
// infeasible, and then the claim is true as well.
#pragma once

#include "checker/confirm.h"
#include "checker/format/no_path.h"

namespace taut::checker {

/// Confirms the claim. @returns no segments; boxes are the cells with a reason.
/// @throws Rejected naming the first statement that is false or was not confirmed; whatever options.before_box throws.
/// Cost: some tenths of a millisecond for each cell with a reason, and some microseconds for each other one.
Theorem::Counts confirm(const NoPathCertificate& certificate, const ConfirmOptions& options);

/// Whether the cells with a reason part the two waypoints, be these reasons true or not.
/// @param before_step  is called now and then, and may throw
/// @throws Rejected or Undefined where a waypoint's place is not enclosed, or is out of its range.
[[nodiscard]] bool is_parted(const NoPathCertificate& certificate, const std::function<void()>& before_step);

/// The parameters over a cell: for each axis the part [k/2^depth, (k+1)/2^depth] of it.
struct CellPart {
  std::uint32_t k = 0;
  int depth = 0;
};
[[nodiscard]] std::vector<CellForm> parameters(std::span<const CellAxis> axes, std::span<const CellPart> cell);

}  // namespace taut::checker
