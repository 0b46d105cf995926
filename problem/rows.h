// SPDX-License-Identifier: GPL-3.0-or-later
// Rows of a table of a move, between which drives run the lengths of cables straight (docs/theory.md, 14, "Rows").
#pragma once

#include <array>

#include "problem/rational.h"
#include "problem/time.h"

namespace taut {

/// What is left for rows that are rounded: of error_m, and of the time between two rows.
inline constexpr const char* kRowRounding_m = "1e-9";
inline constexpr const char* kRowRounding_s = "1e-9";

/// Those that the problem states, or null.
[[nodiscard]] inline const RowsText* stated_rows(const Problem& problem) {
  return problem.time && problem.time->rows ? &*problem.time->rows : nullptr;
}

/// Rows at most so far apart, each within `off_m` of the lengths that path and law have at its time, and kRowRounding_m
/// more; errors are rounded up to 1e-12 m. @throws FieldError unless all winches have a limit of acceleration that is a
/// number
[[nodiscard]] RowsText rows_between(const TimeText& time, const Rational& step_s,
                                    const std::array<Rational, kCables>& off_m);

/// Checks that errors are above a h²/8, exactly. @pre time.rows @throws FieldError
void validate_rows(const TimeText& time);

}  // namespace taut
