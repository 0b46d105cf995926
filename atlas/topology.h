// SPDX-License-Identifier: GPL-3.0-or-later
// What a finished atlas of a surface (n = 2) tells about the surface: area and Euler characteristic.
//
// The charts' polygons give each chart a cyclic order of neighbours, a rotation system, in which faces are traced
// combinatorially: no triangle is guessed from distances. Tangent frames may differ in orientation, also all round a
// surface that is not orientable; each edge carries whether its two frames agree.
#pragma once

#include "atlas/atlas.h"

namespace taut {

/// V - E + F of the charts, their adjacencies and the faces between them, all restricted to what the balls of radius
/// r_i cover: the Euler characteristic of the union of the balls (nerve theorem). So for a closed surface, once
/// grow_all() has returned true, it is the surface's own; with a boundary, that of the surface if its holes and gaps
/// are wider than a ball.
/// @throws std::invalid_argument unless n = 2.
[[nodiscard]] int euler_characteristic(const Atlas& atlas);

/// Area of the polygons within their balls, in squared ambient units. Its relative error is of the order (r k)^2 for
/// curvature k.
/// @throws std::invalid_argument unless n = 2.
[[nodiscard]] double area(const Atlas& atlas);

}  // namespace taut
