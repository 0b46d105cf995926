// SPDX-License-Identifier: GPL-3.0-or-later
// Cells of a map: boxes of the free coordinates with exact dyadic ends.
//
// Each axis of the space is [0, 1] here; map_space.h says which coordinate t stands for. A cell is made of the whole
// by halving it along one axis at a time, so that a tree of halvings, in preorder, states all cells exactly.
#pragma once

#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>

#include "certify/arithmetic/dyadic.h"

namespace taut {

/// The largest number of free coordinates that a map may have.
inline constexpr std::size_t kMaxMapAxes = 3;
/// How often an axis may be halved, and all of them together: sums of volumes of cells are exact in binary64.
inline constexpr int kMaxCellDepth = 30;
inline constexpr int kMaxCellHalvings = 50;

/// The product over the axes of [k/2^depth, (k+1)/2^depth]; of axes that the space does not have, [0, 1].
struct Cell {
  std::array<std::uint32_t, kMaxMapAxes> k{};
  std::array<std::uint8_t, kMaxMapAxes> depth{};

  [[nodiscard]] double lower(std::size_t axis) const { return std::ldexp(k[axis], -depth[axis]); }
  [[nodiscard]] double upper(std::size_t axis) const { return std::ldexp(k[axis] + 1.0, -depth[axis]); }
  [[nodiscard]] double mid(std::size_t axis) const { return std::ldexp(k[axis] + 0.5, -depth[axis]); }
  /// Half the width.
  [[nodiscard]] double radius(std::size_t axis) const { return std::ldexp(0.5, -depth[axis]); }
  [[nodiscard]] int halvings() const { return depth[0] + depth[1] + depth[2]; }
  /// The share of the whole space, 2^-halvings.
  [[nodiscard]] double volume() const { return std::ldexp(1.0, -halvings()); }
  /// The lower (0) or upper (1) half along an axis. @pre depth[axis] < kMaxCellDepth
  [[nodiscard]] Cell half(std::size_t axis, unsigned side) const {
    Cell result = *this;
    result.k[axis] = 2 * k[axis] + side;
    ++result.depth[axis];
    return result;
  }
  /// The ends along an axis as certificates state them.
  [[nodiscard]] DyadicBox along(std::size_t axis) const { return {k[axis], depth[axis]}; }
  bool operator==(const Cell&) const = default;
};

}  // namespace taut
