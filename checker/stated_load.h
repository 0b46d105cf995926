// SPDX-License-Identifier: GPL-3.0-or-later
// The load and the limits in time that a certificate states, a line each, for people who check it without its case.
#pragma once

#include <string>

namespace taut::checker {

/// Such as: load: "payload" 11760 to 12240 kg at (0, 0, -1.2) m … Printable ASCII; numbers are rounded, and names are
/// quoted as JSON quotes them.
/// @pre `certificate` is well formed: check() did not call it malformed.
[[nodiscard]] std::string stated_load(const std::string& certificate);
/// Such as: limits in time: winch speed below 1 m/s; angular speed below (5)*pi/180 rad/s. Expressions are as stated;
/// nothing where there are no such limits. @pre likewise
[[nodiscard]] std::string stated_time(const std::string& certificate);

}  // namespace taut::checker
