// SPDX-License-Identifier: GPL-3.0-or-later
// Area and Euler characteristic of a surface (n = 2), computed from its finished atlas.
//
// The charts' polygons give each chart a cyclic order of neighbours, a rotation system, in which faces are traced
// combinatorially: no triangle is guessed from distances. Tangent frames may differ in orientation, as they must
// somewhere on a surface that is not orientable; each edge stores whether its two frames agree.
#pragma once

#include "atlas/atlas.h"

namespace taut {

/// V - E + F of the charts, their adjacencies and the faces between them, all restricted to what the balls of radius
/// r_i cover: the Euler characteristic of the union of the balls (nerve theorem). For a closed surface, once grow_all()
/// has returned true, it is that of the surface; so it is for a surface with boundary if its holes and gaps are wider
/// than a ball.
/// @throws std::invalid_argument unless n = 2.
[[nodiscard]] int euler_characteristic(const Atlas& atlas);

/// Area of the polygons within their balls, in squared ambient units. Its relative error is of the order (r k)^2 for
/// curvature k.
/// @throws std::invalid_argument unless n = 2.
[[nodiscard]] double area(const Atlas& atlas);

}  // namespace taut
