// SPDX-License-Identifier: GPL-3.0-or-later
// A proved map: the tree of halvings of a space, with what is proved of each cell that is not halved.
//
// Undecided cells are halved, the largest first, until the wanted share of the space is decided, they are as small as
// cells may get, or a budget is used up. All but a budget of time gives the same tree, bit for bit, on any number of
// threads.
#pragma once

#include <cstdint>
#include <functional>
#include <limits>
#include <stop_token>
#include <vector>

#include "map/cell_proof.h"

namespace taut {

/// One node of the tree. 8 bytes; a tree of n leaves has 2 n − 1.
struct MapNode {
  static constexpr std::uint8_t kLeaf = 0xFF;

  std::uint32_t child = 0;    ///< the lower half; the upper one is the next node
  std::uint16_t reason = 0;   ///< CellVerdict::reason
  std::uint8_t axis = kLeaf;  ///< that was halved, or kLeaf
  CellKind kind : 7 = CellKind::kUndecided;
  bool regular : 1 = false;  ///< CellVerdict::regular
};
static_assert(sizeof(MapNode) == 8);

/// How far a map is that is being made.
struct MapProgress {
  std::size_t cells = 0;  ///< leaves
  double undecided = 1;   ///< share of the space's volume
};

struct SubdivisionOptions {
  /// No axis is halved to cells narrower than this share of it.
  double least_width = 0.0005;
  double undecided_share = 0.01;        ///< of the space's volume, at which to stop
  std::size_t most_cells = 20'000'000;  ///< leaves
  double seconds = std::numeric_limits<double>::infinity();
  std::stop_token stop = {};
  std::function<void(const MapProgress&)> progress = {};  ///< where set: called now and then, by the calling thread
};

struct CellMap {
  enum class End {
    kShare,   ///< no more than the wanted share is undecided
    kWidth,   ///< all undecided cells are as small as they may get, or limited by tolerances
    kCells,   ///< there are as many cells as there may be
    kTime,    ///< the time was over
    kStopped  ///< on demand
  };
  MapSpace space;
  std::vector<MapNode> nodes;  ///< the first is the whole
  End end = End::kShare;
  std::size_t judged = 0;  ///< cells of which something was tried to be proved
  /// Shares of the space's volume in its coordinates, exact sums: by CellKind.
  std::array<double, kCellKinds> share{};
  /// What part of the undecided share is CellVerdict::is_tolerance.
  double tolerance_share = 0;

  [[nodiscard]] std::size_t leaves() const { return (nodes.size() + 1) / 2; }

  /// Calls visit(cell, node number) for each leaf, in preorder: lower halves before upper ones.
  template <class Visit>
  void for_each_leaf(const Visit& visit) const {
    for_each_leaf(visit, Cell(), 0);
  }

 private:
  template <class Visit>
  void for_each_leaf(const Visit& visit, const Cell& cell, std::uint32_t node) const {
    const MapNode& here = nodes[node];
    if (here.axis == MapNode::kLeaf) {
      visit(cell, node);
      return;
    }
    for (unsigned side = 0; side < 2; ++side) for_each_leaf(visit, cell.half(here.axis, side), here.child + side);
  }
};

/// @throws InputError as make_cell_proof().
[[nodiscard]] CellMap subdivide(const Problem& problem, const MapSpace& space, const SubdivisionOptions& options = {});

}  // namespace taut
