// SPDX-License-Identifier: GPL-3.0-or-later
// What a certificate of legs states beyond what each leg's own certificate does: one machine, and poses that meet.
// Everything is exact: equal texts, and rational numbers. docs/theory.md, "Legs".
#pragma once

#include <array>
#include <vector>

#include "checker/format/legs.h"

namespace taut::checker {

/// All problems are the same but for name, query, load and bodies; of loads gravity and the load point are the same, of
/// bodies the exit cones. Legs that state bodies state the same bodies of cables; and of what two of them both state,
/// each body of a name is the same one in the same list, each class of which both have bodies has the same clearance or
/// none, and of each pair that both have all that is stated of it is the same.
/// @throws Rejected naming the leg and the key
void require_one_machine(const LegsCertificate& certificate);

/// Each leg but the first begins at the pose at which the one before it ends. @pre require_one_machine(), and no space
/// has constraints @throws Rejected naming the leg
void require_joined(const LegsCertificate& certificate);

}  // namespace taut::checker
