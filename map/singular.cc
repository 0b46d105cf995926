// SPDX-License-Identifier: GPL-3.0-or-later
#include "map/singular.h"

#include <tbb/parallel_for.h>

#include <memory>
#include <optional>

namespace taut {
namespace {

std::optional<std::size_t> widest_axis(const MapSpace& space, const Cell& cell, double width) {
  std::optional<std::size_t> widest;
  for (std::size_t k = 0; k < space.size(); ++k) {
    if (2 * cell.radius(k) > width && (!widest || cell.depth[k] < cell.depth[*widest])) widest = k;
  }
  return widest;
}

void refine(const CellProof& proof, const MapSpace& space, const Cell& cell, double width, std::vector<Cell>& found) {
  const CellVerdict verdict = proof.judge(cell);
  if (verdict.regular || verdict.kind == CellKind::kLength) return;
  const std::optional<std::size_t> axis = widest_axis(space, cell, width);
  if (!axis) {
    found.push_back(cell);
    return;
  }
  for (unsigned side = 0; side < 2; ++side) refine(proof, space, cell.half(*axis, side), width, found);
}

}  // namespace

std::vector<Cell> singular_cells(const Problem& problem, const CellMap& map, double width) {
  const std::unique_ptr<CellProof> proof = make_cell_proof(problem, map.space);
  std::vector<Cell> open;
  map.for_each_leaf([&](const Cell& cell, std::uint32_t node) {
    if (!map.nodes[node].regular && map.nodes[node].kind != CellKind::kLength) open.push_back(cell);
  });
  std::vector<std::vector<Cell>> parts(open.size());
  tbb::parallel_for(std::size_t{0}, open.size(),
                    [&](std::size_t n) { refine(*proof, map.space, open[n], width, parts[n]); });
  std::vector<Cell> found;
  for (const std::vector<Cell>& part : parts) found.insert(found.end(), part.begin(), part.end());
  return found;
}

}  // namespace taut
