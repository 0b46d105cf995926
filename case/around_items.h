// SPDX-License-Identifier: GPL-3.0-or-later
// `ellipsoid: around_items`: one ellipsoid in place of the items of a load. Internal to case/.
#pragma once

#include "problem/problem.h"
#include "problem/rational.h"

namespace taut::case_fields {

/// A load whose K is one ellipsoid, as small as was found, that contains all wrenches of `load` in every orientation of
/// the platform; docs/theory.md, "An ellipsoid around items", has the proof. The ellipsoid is about the nominal centre
/// of gravity of the weights, or about load.point_m where there are none. It is decided in exact arithmetic that it
/// contains the items.
/// @pre `load` is valid, and has items but no ellipsoid. @param arm_m  the size of the platform, > 0 [m]: how a force
/// so small that it doesn't matter compares with a moment
/// @throws InputError where numbers are so far apart that no ellipsoid is found.
[[nodiscard]] LoadText ellipsoid_around_items(const LoadText& load, double arm_m);

/// The greatest magnitude of a vector in the set.
[[nodiscard]] Rational greatest(const VectorSet& set);

}  // namespace taut::case_fields
