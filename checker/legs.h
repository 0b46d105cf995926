// SPDX-License-Identifier: GPL-3.0-or-later
// What a certificate of legs states beyond what each leg's own certificate does: one machine, and poses that meet.
// Everything is exact: equal texts, and rational numbers. docs/theory.md, "Legs".
#pragma once

#include <array>
#include <vector>

#include "checker/format/legs.h"

namespace taut::checker {

/// All problems are the same but for name, query, load and bodies; of loads gravity and the load point are the same, of
/// bodies those of the cables. @throws Rejected naming the leg and the key
void require_one_machine(const LegsCertificate& certificate);

/// Each leg but the first begins at the pose at which the one before it ends. @pre require_one_machine(), and no space
/// has constraints @throws Rejected naming the leg
void require_joined(const LegsCertificate& certificate);

}  // namespace taut::checker
