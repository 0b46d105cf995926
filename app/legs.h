// SPDX-License-Identifier: GPL-3.0-or-later
// Plans the legs of a case, each as a case of its own, and has the checker prove one certificate of all.
#pragma once

#include <functional>
#include <span>
#include <stop_token>
#include <string>
#include <vector>

#include "app/plan.h"
#include "case/case_of_legs.h"

namespace taut {

struct PlannedLeg {
  PlannedCase planned;    ///< with the bytes that stand in the certificate of legs, and what the checker says of them
  MotionLengths lengths;  ///< of its path
  double seconds = 0;     ///< that planning took
};

struct PlannedLegs {
  std::vector<PlannedLeg> legs;
  std::string text;              ///< of certificate.json: of legs
  checker::CheckResult checked;  ///< what the checker says of it: the verdict
};

/// Plans leg after leg; one that is not proved does not keep the others from being planned. Asked to stop, it ends the
/// leg that it is at as plan_case() does, and those after it at once.
/// @param options  of each leg; that no path exists is not tried to prove, as no certificate of legs says that
/// @param at_leg  is called before each, with its index
/// @throws as plan_case() @pre there are legs
[[nodiscard]] PlannedLegs plan_legs(std::span<const CaseLeg> legs, PlannedCaseOptions options,
                                    const std::function<void(std::size_t)>& at_leg, const Progress& progress,
                                    const std::stop_token& stop);

}  // namespace taut
