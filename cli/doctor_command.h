// SPDX-License-Identifier: GPL-3.0-or-later
// `taut doctor`: whether this machine can be trusted with proofs, and has what taut makes use of.
#pragma once

namespace taut {

/// Prints a line for each thing that is looked at. @returns 0, or 4 where proofs can't be trusted here.
[[nodiscard]] int run_doctor();

}  // namespace taut
