// SPDX-License-Identifier: GPL-3.0-or-later
// The bodies that a certificate states, in one line, for people who check it without its case.
#pragma once

#include <string>

namespace taut::checker {

/// Such as: bodies: checked: platform-obstacles (2 pairs), 0.2 m; …. NOT CHECKED: cables-cables. Printable ASCII;
/// numbers are rounded, and names are quoted as JSON quotes them. Empty where the problem has none.
/// @pre `certificate` is well formed: check() did not call it malformed.
[[nodiscard]] std::string stated_bodies(const std::string& certificate);

}  // namespace taut::checker
