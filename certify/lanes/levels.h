// SPDX-License-Identifier: GPL-3.0-or-later
// The kernels of each level, whether the processor has it or not.
#pragma once

#include "certify/lanes/kernel.h"

namespace taut::lanes {

extern const Kernels kSse2Kernels, kAvx2Kernels, kAvx512Kernels;

}  // namespace taut::lanes
