// SPDX-License-Identifier: GPL-3.0-or-later
// The report's tables of proved margins.
#pragma once

#include "reports/page/markup.h"
#include "reports/summary/scene.h"

namespace taut {

/// Reserves of each segment in the case's units, rounded down; for a long path, of blocks of segments and of the
/// segments whose loads may grow least.
[[nodiscard]] Html margins(const ReportContext& scene);
/// For the appendix: margins as the certificate states them, of the whole path and of each segment; of a long path
/// those segments whose loads may grow least.
[[nodiscard]] Html exact_margins(const ReportContext& scene);

}  // namespace taut
