// SPDX-License-Identifier: GPL-3.0-or-later
// Whether a point is inside of a closed mesh.
//
// A mesh is closed if each edge belongs to two triangles and each of its shells, the parts that hang together by edges,
// has two sides. Take a point that is on no triangle, and a ray from it that meets no edge. Of a shell whose triangles
// all turn the same way, count how often the ray crosses it from one side, less how often from the other: the shell's
// winding number, up to its sign. It is the same for each such ray, 0 far away, and it only changes where the point
// crosses a triangle. A point is inside of the mesh if some shell's winding number is not 0: so shells that overlap,
// cross themselves, or are one in another have all of that inside.
//
// With corners a, b, c as seen from the point, and the ray's vector r, let x = det(r, a, b), y = det(r, b, c), z =
// det(r, c, a). If two of them have opposite signs, the line through the point along r does not meet the triangle's
// inside, nor its edges. If all have one sign, it crosses the triangle inside, at t r with t (x + y + z) = det(a, b,
// c); their sign says from which side.
#pragma once

#include "checker/kernel/bodies.h"

namespace taut::checker {

enum class Side { kOutside, kInside, kUnknown };

/// Of a point in the mesh's unit. @pre surface.is_closed()
[[nodiscard]] Side side_of(const Surface& surface, const Vector3<Ball>& point);

/// The coordinates, in the mesh's unit, of a point in the axes in which the mesh is placed.
[[nodiscard]] Vector3<Ball> in_unit_of(const PlacedSurface& mesh, const Vector3<Ball>& point);

}  // namespace taut::checker
