// SPDX-License-Identifier: GPL-3.0-or-later
// Readers of the parts of a certificate, on values that know their place. All of them throw Malformed.
#pragma once

#include "checker/format/cursor.h"
#include "checker/format/reader.h"

namespace taut::checker {

inline constexpr std::array<std::pair<const char*, Law>, 4> kLaws = {
    {{"straight-in-parameters", Law::kStraight},
     {"cubic-b-spline", Law::kCubicBSpline},
     {"geodesic", Law::kGeodesic},
     {"straight-in-cable-lengths", Law::kCableLengths}}};

void read(const Cursor& json, Limits& limits);
void read(const Cursor& json, ToleranceBounds& tolerances);
/// `problem.load`.
void read_load(const Cursor& json, Problem& problem);
/// Of a `load` that was read: no weight has `inertia_box_m`.
void require_no_inertia_box(const Cursor& json);
/// Load point and wrench have no tolerances, as items have their own.
void require_no_tolerance_of_load(const Cursor& tolerances, const ToleranceBounds& bounds);
/// `loads` of a witness: one for each item.
[[nodiscard]] std::vector<LoadChoice> read_loads(const Cursor& json, const std::vector<LoadItem>& items);
[[nodiscard]] Problem read_problem(const Cursor& json);
/// `problem.bodies`, with the pairs that follow from it.
void read(const Cursor& json, Bodies& bodies);
/// `problem.space` of a path whose law is one of poses: the free coordinates px py pz phi theta sigma.
[[nodiscard]] const Json& coordinate_space();
/// Whether a `space` is that of the free coordinates, with tilt-and-torsion angles, with roll, pitch and yaw, or with
/// the angles of a case's space.
[[nodiscard]] bool is_coordinate_space(const Json& space, const Json& of_case);

/// Leaves out the sizes and ranges that the problem prescribes.
[[nodiscard]] Waypoint read_waypoint(const Cursor& json, Law law);
/// Widths >= 0; that they are positive is asked where something is claimed.
void read(const Cursor& json, PoseTube& tube);
/// Appends an entry of `pose_tubes` to the path.
void read_pose_tube(const Cursor& json, Path& path);
/// Of two successive tubes one contains the other. Otherwise the motion might change from one pose to another between
/// them.
[[nodiscard]] bool are_nested(const PoseTube& a, const PoseTube& b);

/// `timing` of a path whose law and waypoints were read.
void read_timing(const Cursor& json, const Problem& problem, Path& path);

/// Appends an entry of `directions` to the path.
void append_direction(const Cursor& json, Path& path);
/// An entry of `apart` for a pair of the problem's bodies.
[[nodiscard]] std::vector<std::size_t> read_apart(const Cursor& json, std::size_t pair, const Problem& problem,
                                                  const Path& path);
/// `inside` of a witness of contact between the bodies of a pair: the mesh, 0 the first body or 1 the second.
[[nodiscard]] std::size_t read_contact_inside(const Cursor& json, std::size_t pair, const Problem& problem);
/// `elements` of a witness of contact between the bodies of a pair, one of which is a mesh. The body that has the
/// other's point inside has none, and no weights.
[[nodiscard]] ContactElements read_contact_elements(const Cursor& json, std::size_t pair,
                                                    const std::optional<std::size_t>& inside, const Problem& problem);
/// `weights` of a witness of contact between the bodies of a pair.
[[nodiscard]] ContactWeights read_contact_weights(const Cursor& json, std::size_t pair,
                                                  const std::optional<std::size_t>& inside, const Problem& problem);

void read_margins(const Cursor& json, const Problem& problem, Margins& margins);
[[nodiscard]] Segment read_segment(const Cursor& json, std::size_t k, const Problem& problem, const Path& path);
[[nodiscard]] Witness read_witness(const Cursor& json, const Problem& problem, const Path& path);
[[nodiscard]] Stretch read_stretch(const Cursor& json, const Problem& problem, const Path& path);

/// The place along the whole path, on which each segment has length 1.
[[nodiscard]] inline mpq_class abscissa(const PathPoint& point) { return point.s + mpq_class(point.segment); }
/// The first and the last place that a witness is about; the same but where it is singular.
[[nodiscard]] std::pair<mpq_class, mpq_class> places(const Witness& witness);
/// Whether a witness is about nothing outside of a stretch's outer ends.
[[nodiscard]] bool is_inside(const Witness& witness, const Stretch& stretch);

}  // namespace taut::checker
