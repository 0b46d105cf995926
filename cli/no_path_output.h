// SPDX-License-Identifier: GPL-3.0-or-later
// What `taut map` writes where waypoints are apart.
#pragma once

#include <optional>
#include <stop_token>
#include <string>

#include "case/case_file.h"

namespace taut {

/// The certificate that no path exists from the first waypoint of the query that is apart from the next, once the
/// checker has proved it; nothing where that is not proved within the budget of `taut plan`.
[[nodiscard]] std::optional<std::string> no_path_certificate(const Case& the_case, const std::stop_token& stop);

}  // namespace taut
