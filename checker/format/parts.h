// SPDX-License-Identifier: GPL-3.0-or-later
// Readers of the parts of a certificate, on values that know their place. All of them throw Malformed.
#pragma once

#include "checker/format/cursor.h"
#include "checker/format/reader.h"

namespace taut::checker {

[[nodiscard]] Problem read_problem(const Cursor& json);
/// `problem.space` of a path whose law is one of poses: the free coordinates px py pz phi theta sigma.
[[nodiscard]] const Json& coordinate_space();

[[nodiscard]] Law read_law(const Cursor& json);
/// Leaves out the sizes and ranges that the problem prescribes.
[[nodiscard]] Waypoint read_waypoint(const Cursor& json, Law law);
/// Appends an entry of `pose_tubes` to the path.
void read_pose_tube(const Cursor& json, Path& path);
/// Of two successive tubes one contains the other. Otherwise the motion might change from one pose to another between
/// them.
[[nodiscard]] bool are_nested(const PoseTube& a, const PoseTube& b);

[[nodiscard]] Margins read_margins(const Cursor& json);
[[nodiscard]] Segment read_segment(const Cursor& json, std::size_t k, const Problem& problem, const Path& path);
[[nodiscard]] Witness read_witness(const Cursor& json, const Problem& problem, const Path& path);
[[nodiscard]] Stretch read_stretch(const Cursor& json, const Problem& problem, const Path& path);

/// The place along the whole path, on which each segment has length 1.
[[nodiscard]] inline mpq_class abscissa(const PathPoint& point) { return point.s + mpq_class(point.segment); }

}  // namespace taut::checker
