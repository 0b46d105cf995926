// SPDX-License-Identifier: GPL-3.0-or-later
// The key `decoration` of a case. Internal to case/.
#pragma once

#include <filesystem>

#include "case/decoration.h"
#include "case/fields.h"

namespace taut::case_fields {

/// @param folder  of the case file: file names are relative to it
[[nodiscard]] DecorationFiles read_decoration(const Field& field, const Units& units,
                                              const std::filesystem::path& folder);

}  // namespace taut::case_fields
