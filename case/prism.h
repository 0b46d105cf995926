// SPDX-License-Identifier: GPL-3.0-or-later
// A prism around a cylinder, which is no convex hull of finitely many points. Internal to case/.
#pragma once

#include <array>
#include <vector>

#include "problem/bodies.h"
#include "problem/rational.h"

namespace taut::case_fields {

using RationalPoint = std::array<Rational, 3>;

struct Prism {
  std::vector<PointText> points_m;  ///< corners: kPrismSides around each end, exact decimals [m]
  /// No point of the prism is farther than this from the cylinder [m]; exact, and rounded up.
  DecimalText excess_m;
};
inline constexpr std::size_t kPrismSides = 16;

/// A prism that contains all points within `radius` of the segment between two points and between the planes through
/// these at right angles to it. Containment is decided in rational arithmetic:
///
/// The corners are from + t w + a U + b V, where w = to − from, t is −τ or 1 + τ, and (a, b) is a corner of a polygon.
/// Let m0, m1, m2 be the rows of [w U V]^-1. A point of the cylinder is from + t w + y with 0 <= t <= 1, y·w = 0 and
/// |y| <= radius. It is in the prism if |m0·y| <= τ and, for each edge n·(a, b) <= h of the polygon, (n1 m1 + n2 m2)·y
/// <= h. Both are linear in y, so their largest values are the radius times the length of m0, less its part along w,
/// and of n1 m1 + n2 m2, which is at right angles to w. Squares of lengths are rational.
///
/// The polygon is regular but for its rounding, and reaches 2 % farther than the circle.
/// @pre from != to, radius > 0
/// @throws InputError where the numbers are so far apart that no such prism is found
[[nodiscard]] Prism prism_around_cylinder(const PointText& from, const PointText& to, const DecimalText& radius);

}  // namespace taut::case_fields
