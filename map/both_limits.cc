// SPDX-License-Identifier: GPL-3.0-or-later
#include "map/both_limits.h"

#include <tbb/parallel_for.h>

#include <algorithm>
#include <memory>
#include <optional>

namespace taut {
namespace {

/// The margins of lengths in CellVerdict::proved.
constexpr std::uint32_t length_margins() {
  std::uint32_t result = 0;
  const auto margins = all_margins();
  for (std::size_t n = 0; n < margins.size(); ++n) {
    const bool is_length = margins[n].kind == MarginKind::kLengthMin || margins[n].kind == MarginKind::kLengthMax;
    if (is_length) result |= 1U << n;
  }
  return result;
}

class BothLimits {
 public:
  BothLimits(const Problem& problem, const CellMap& map, double width) : space_(map.space), width_(width) {
    Problem without_lengths = problem;
    without_lengths.bodies.reset();
    lengths_ = make_cell_proof(without_lengths, map.space);
    without_lengths.robot.length_m.fill({"1e-9", "1e9"});
    tensions_ = make_cell_proof(without_lengths, map.space);
  }

  void refine(const Cell& cell, bool beyond_length, bool beyond_tension, std::vector<Cell>& found) const {
    constexpr std::uint32_t kLengths = length_margins();
    if (!beyond_length) {
      const CellVerdict verdict = lengths_->judge(cell);
      if ((verdict.proved & kLengths) == kLengths) return;
      beyond_length = verdict.kind == CellKind::kLength;
    }
    if (!beyond_tension) {
      const CellVerdict verdict = tensions_->judge(cell);
      if (verdict.kind == CellKind::kInside) return;
      beyond_tension = verdict.kind == CellKind::kTension || verdict.kind == CellKind::kUnbalanced;
    }
    if (beyond_length && beyond_tension) {
      found.push_back(cell);
      return;
    }
    std::optional<std::size_t> widest;
    for (std::size_t k = 0; k < space_.size(); ++k) {
      if (2 * cell.radius(k) > width_ && (!widest || cell.depth[k] < cell.depth[*widest])) widest = k;
    }
    if (!widest) return;
    for (unsigned side = 0; side < 2; ++side) refine(cell.half(*widest, side), beyond_length, beyond_tension, found);
  }

 private:
  const MapSpace& space_;
  double width_;
  std::unique_ptr<CellProof> lengths_, tensions_;
};

}  // namespace

std::vector<Cell> cells_beyond_both(const Problem& problem, const CellMap& map, double width) {
  const BothLimits both(problem, map, width);
  std::vector<std::pair<Cell, CellKind>> outside;
  map.for_each_leaf([&](const Cell& cell, std::uint32_t node) {
    const CellKind kind = map.nodes[node].kind;
    if (is_outside(kind) && kind != CellKind::kContact) outside.emplace_back(cell, kind);
  });
  std::vector<std::vector<Cell>> parts(outside.size());
  tbb::parallel_for(std::size_t{0}, outside.size(), [&](std::size_t n) {
    const auto& [cell, kind] = outside[n];
    both.refine(cell, kind == CellKind::kLength, kind == CellKind::kTension, parts[n]);
  });
  std::vector<Cell> found;
  for (const std::vector<Cell>& part : parts) found.insert(found.end(), part.begin(), part.end());
  return found;
}

}  // namespace taut
