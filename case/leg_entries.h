// SPDX-License-Identifier: GPL-3.0-or-later
// Entries of a list of a case file, items of the load or bodies, that are there in some legs only: those that say
// `legs`. Internal to case/.
#pragma once

#include <string>
#include <vector>

#include "case/fields.h"

namespace taut::case_fields {

/// Whether an entry is one of the leg's: it says so, or it has no `legs`.
[[nodiscard]] bool is_in_leg(const YAML::Node& entry, const std::string& leg);

/// @param noun  what an entry is, with its article: "an item"
/// @throws InputError for `legs` of an entry that is no list of one or more of these names, each once
void require_legs_of_entry(const Field& entry, const std::string& noun, const std::vector<std::string>& legs);

/// Removes the entries of other legs, and `legs` of those that stay; leaves what is no list to its reader.
void keep_entries_of_leg(YAML::Node list, const std::string& leg);

}  // namespace taut::case_fields
