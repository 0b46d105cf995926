// SPDX-License-Identifier: GPL-3.0-or-later
#include "kinematics/margin.h"

namespace taut {

const char* name(MarginKind kind) {
  switch (kind) {
    case MarginKind::kTensionMin: return "tension_min";
    case MarginKind::kTensionMax: return "tension_max";
    case MarginKind::kLengthMin: return "length_min";
    case MarginKind::kLengthMax: return "length_max";
  }
  return "?";
}

}  // namespace taut
