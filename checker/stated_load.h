// SPDX-License-Identifier: GPL-3.0-or-later
// The load that a certificate states, in one line, for people who check it without its case.
#pragma once

#include <string>

namespace taut::checker {

/// Such as: load: "payload" 11760 to 12240 kg at (0, 0, -1.2) m … Printable ASCII; numbers are rounded, and names are
/// quoted as JSON quotes them.
/// @pre `certificate` is well formed: check() did not call it malformed.
[[nodiscard]] std::string stated_load(const std::string& certificate);

}  // namespace taut::checker
