// SPDX-License-Identifier: GPL-3.0-or-later
// What `taut map` writes where waypoints are apart.
#pragma once

#include <filesystem>
#include <stop_token>
#include <vector>

#include "case/case_file.h"

namespace taut {

/// Writes certificate.json into a folder, the certificate that no path exists from the first waypoint of the query that
/// is apart from the next, once the checker has proved it. @returns the files written: none where that is not proved
/// within the budget of `taut plan`. @throws InputError where it can't be written.
[[nodiscard]] std::vector<std::filesystem::path> write_no_path(const Case& the_case, const std::filesystem::path& out,
                                                               const std::stop_token& stop);

}  // namespace taut
