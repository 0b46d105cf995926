// SPDX-License-Identifier: GPL-3.0-or-later
#include "map/singular.h"

#include <tbb/parallel_for.h>

#include <memory>
#include <optional>

#include "map/determinant.h"

namespace taut {
namespace {

std::optional<std::size_t> widest_axis(const MapSpace& space, const Cell& cell, double width) {
  std::optional<std::size_t> widest;
  for (std::size_t k = 0; k < space.size(); ++k) {
    if (2 * cell.radius(k) > width && (!widest || cell.depth[k] < cell.depth[*widest])) widest = k;
  }
  return widest;
}

class CellRefinement {
 public:
  CellRefinement(const Problem& problem, const MapSpace& space, double width)
      : space_(space),
        width_(width),
        proof_(make_cell_proof(problem, space)),
        determinant_(make_determinant_sign(problem, space)) {}

  void refine(const Cell& cell, std::vector<Cell>& found) const {
    const CellVerdict verdict = proof_->judge(cell);
    if (verdict.regular || verdict.kind == CellKind::kLength || determinant_->is_nonzero(cell)) return;
    const std::optional<std::size_t> axis = widest_axis(space_, cell, width_);
    if (!axis) {
      found.push_back(cell);
      return;
    }
    for (unsigned side = 0; side < 2; ++side) refine(cell.half(*axis, side), found);
  }

 private:
  const MapSpace& space_;
  double width_;
  std::unique_ptr<CellProof> proof_;
  std::unique_ptr<DeterminantSign> determinant_;
};

}  // namespace

std::vector<Cell> singular_cells(const Problem& problem, const CellMap& map, double width) {
  const CellRefinement refinement(problem, map.space, width);
  std::vector<Cell> open;
  map.for_each_leaf([&](const Cell& cell, std::uint32_t node) {
    if (!map.nodes[node].regular && map.nodes[node].kind != CellKind::kLength) open.push_back(cell);
  });
  std::vector<std::vector<Cell>> parts(open.size());
  tbb::parallel_for(std::size_t{0}, open.size(), [&](std::size_t n) { refinement.refine(open[n], parts[n]); });
  std::vector<Cell> found;
  for (const std::vector<Cell>& part : parts) found.insert(found.end(), part.begin(), part.end());
  return found;
}

}  // namespace taut
