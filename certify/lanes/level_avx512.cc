// SPDX-License-Identifier: GPL-3.0-or-later
#define TAUT_LANES_LEVEL 5
#include "certify/lanes/kernel_body.h"
#include "certify/lanes/levels.h"
#include "certify/lanes/winch_body.h"

namespace taut::lanes {

const Kernels kAvx512Kernels = {
    Level::kAvx512, box_kernel_of_level<1>(), box_kernel_of_level<2>(), box_kernel_of_level<3>(),
    find_pose,      differentiate_lengths,    failed_rounding,          divide};

}  // namespace taut::lanes
