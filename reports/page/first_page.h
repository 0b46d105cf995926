// SPDX-License-Identifier: GPL-3.0-or-later
// The report's first page: all that whoever signs it has to know, on one sheet of A4 in usual cases.
#pragma once

#include "reports/page/markup.h"
#include "reports/summary/summary.h"

namespace taut {

[[nodiscard]] Html first_page(const ReportContext& scene, const Summary& summary);

}  // namespace taut
