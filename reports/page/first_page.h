// SPDX-License-Identifier: GPL-3.0-or-later
// The report's first page: everything that the person who signs it has to know, usually on one sheet of A4.
#pragma once

#include "reports/page/markup.h"
#include "reports/summary/summary.h"

namespace taut {

[[nodiscard]] Html first_page(const ReportContext& scene, const Summary& summary);

}  // namespace taut
