// SPDX-License-Identifier: GPL-3.0-or-later
// What a case says of legs: paths that follow one another, each with a load and bodies of its own (docs/case-format.md,
// "Legs"). A leg is read as a case of its own: that of the file without what is not of this leg. Internal to case/.
#pragma once

#include <cstddef>
#include <string>
#include <vector>

#include "case/case_of_legs.h"
#include "case/fields.h"

namespace taut::case_fields {

/// Whether a case file, whatever else may be wrong with it, has `query.legs`.
[[nodiscard]] bool has_legs(const YAML::Node& root);

/// The names of the legs, in their order.
///
/// @param root  of a file that has_legs()
/// @throws InputError with its place for fewer than two legs or more than 64, names that are not fit for a folder or
/// stand twice, items of the load and bodies that are of no leg or of one that is not there, and what does not go with
/// legs: constraints, an audit, an ellipsoid around items
[[nodiscard]] std::vector<std::string> read_legs(const Field& root);

/// Makes the document of a file that of its leg k alone: its waypoints are the query's, and items and bodies of other
/// legs are gone. Marks of what is left are those of the file. @param names  of all legs: read_legs()
void keep_leg(YAML::Node& root, const std::vector<std::string>& names, std::size_t k);

/// Each leg but the first begins where the one before it ends: with the same expressions, or decimals of equal values.
/// @param root  of the file @param legs  as they were read @throws InputError at the waypoint
void require_joined(const Field& root, const std::vector<CaseLeg>& legs);

}  // namespace taut::case_fields
