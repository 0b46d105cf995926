// SPDX-License-Identifier: GPL-3.0-or-later
// A problem as the checker's kernel has it.
#pragma once

#include "checker/kernel/statement.h"
#include "problem/problem.h"

namespace taut {

/// What the checker reads from a certificate of this problem, and the surfaces of its meshes, which it reads from the
/// case. @throws InputError where the checker would refuse the problem
[[nodiscard]] checker::Problem to_kernel(const Problem& problem);

}  // namespace taut
