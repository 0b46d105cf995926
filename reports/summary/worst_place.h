// SPDX-License-Identifier: GPL-3.0-or-later
// The place of a path at which the pictures first show the machine.
#pragma once

#include <optional>

#include "reports/summary/cable_use.h"

namespace taut {

/// Counted in segments: the certificate's witness; else where a cable is nearest to one of its limits by Nearness, and
/// among equally near ones bodies that come near to each other before a cable that comes near to going slack before the
/// greatest tension, and that before its lengths. Nothing where nothing is known.
[[nodiscard]] std::optional<double> worst_place(const ReportContext& scene, const CableUse& use);

}  // namespace taut
