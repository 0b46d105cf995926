// SPDX-License-Identifier: GPL-3.0-or-later
// The rows of D^-1 over a box, around middles.
#pragma once

#include "certify/inverse_bound.h"
#include "certify/loads/item_rows.h"

namespace taut {

/// Under run_upward(). @param radius  that for which `inverse` was set
[[nodiscard]] RowForms row_forms(const InverseBound<Interval>& inverse, double radius);

}  // namespace taut
