// SPDX-License-Identifier: GPL-3.0-or-later
// Bodies of a case of legs, some of which are there in some legs only: a load that stands on the floor in one leg and
// hangs from the platform in the next is two of them. What the case says of pairs and clearances holds in each leg for
// the bodies that are there. Internal to case/.
#pragma once

#include <string>
#include <vector>

#include "case/fields.h"

namespace taut::case_fields {

/// @param root  of the file @throws InputError with its place for bodies of no leg or of one that is not there, a name
/// that two bodies have, even in different legs, and pairs with a clearance or a contact of their own that no leg has
void require_legs_of_bodies(const Map& root, const std::vector<std::string>& legs);

/// Leaves the bodies of one leg, and of pairs, clearances and contacts those that are about them. Where bodies can
/// touch in some leg, but not in this one, and there are no exit cones, `bodies` goes.
/// @param root  of the file @pre require_legs_of_bodies() takes it
void keep_bodies_of_leg(YAML::Node& root, const std::string& leg, const std::vector<std::string>& legs);

}  // namespace taut::case_fields
