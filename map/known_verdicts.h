// SPDX-License-Identifier: GPL-3.0-or-later
// Maps of verdicts that were found before: what lets any part of a space be divided on its own.
#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <vector>

#include "map/subdivision.h"

namespace taut {

/// Along which axis a cell is halved. A function of the cell and its verdict alone.
class HalvingRule {
 public:
  HalvingRule(const MapSpace& space, double least_width);

  /// The axis that the verdict proposes, if it may be halved; else the widest that may. Nothing for a cell that is
  /// decided, as small as it may get, or limited by tolerances.
  [[nodiscard]] std::optional<std::size_t> axis(const Cell& cell, const CellVerdict& verdict) const;
  /// How many halvings make the least cells.
  [[nodiscard]] int most_halvings() const;

 private:
  std::size_t axes_;
  std::array<int, kMaxMapAxes> deepest_{};
};

/// A tree of verdicts; node 0 is the whole. `axis` has more values than in a map.
struct KnownVerdicts {
  static constexpr std::uint8_t kTolerance = 0xFE;  ///< a leaf that tolerances leave undecided
  static constexpr std::uint8_t kNotJudged = 0xFD;  ///< a leaf of which nothing is known yet

  std::vector<MapNode> nodes;
};

/// The map that subdivide() makes, bit for bit, where the verdicts are those that it would find.
/// @throws std::logic_error where it needs a verdict that is not known.
[[nodiscard]] CellMap subdivide(const KnownVerdicts& known, const MapSpace& space, const SubdivisionOptions& options);

}  // namespace taut
