// SPDX-License-Identifier: GPL-3.0-or-later
// Whether det D keeps its sign on a cell, by the determinant itself.
//
// A cell's proof shows that D is regular by an approximate inverse, which near singular poses takes cells much smaller
// than their distance from det D = 0. The determinant's own form over the cell errs by second order alone.
#pragma once

#include <memory>

#include "map/cell.h"
#include "map/map_space.h"

namespace taut {

/// Immutable; may be shared between threads.
class DeterminantSign {
 public:
  virtual ~DeterminantSign() = default;
  DeterminantSign() = default;
  DeterminantSign(const DeterminantSign&) = delete;
  DeterminantSign& operator=(const DeterminantSign&) = delete;

  /// Whether det D is proved to vanish at no pose of the closed cell. D is the matrix of force densities; it is J with
  /// its columns scaled by lengths, so that with positive lengths J is singular exactly where D is.
  [[nodiscard]] virtual bool is_nonzero(const Cell& cell) const = 0;
};

/// @throws InputError where the problem can't be enclosed in binary64
[[nodiscard]] std::unique_ptr<DeterminantSign> make_determinant_sign(const Problem& problem, const MapSpace& space);

}  // namespace taut
