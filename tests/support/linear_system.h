// SPDX-License-Identifier: GPL-3.0-or-later
// Small linear systems at the working precision, for oracles.
#pragma once

#include <algorithm>
#include <cstddef>
#include <utility>
#include <vector>

#include "tests/support/exact.h"

namespace taut::testing {

using Vector = std::vector<BigFloat>;

/// x of a x = b by Gauss elimination with pivots; not finite where a is singular.
inline Vector solve(std::vector<Vector> a, Vector b) {
  const std::size_t n = b.size();
  for (std::size_t c = 0; c < n; ++c) {
    std::size_t pivot = c;
    for (std::size_t i = c + 1; i < n; ++i) {
      if (abs(a[i][c]) > abs(a[pivot][c])) pivot = i;
    }
    std::swap(a[c], a[pivot]);
    std::swap(b[c], b[pivot]);
    for (std::size_t i = 0; i < n; ++i) {
      if (i == c) continue;
      const BigFloat factor = a[i][c] / a[c][c];
      for (std::size_t j = c; j < n; ++j) a[i][j] -= factor * a[c][j];
      b[i] -= factor * b[c];
    }
  }
  for (std::size_t i = 0; i < n; ++i) b[i] /= a[i][i];
  return b;
}

}  // namespace taut::testing
