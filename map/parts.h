// SPDX-License-Identifier: GPL-3.0-or-later
// A map in parts that are divided apart from each other, in other processes or on other machines.
//
// The space is halved a number of times that depends on the least width alone; each cell that is still open then is a
// part. What is proved of a cell depends on the cell alone, and whether it may be halved, too (HalvingRule). So parts
// make the same map, bit for bit, whoever divides them, and in whatever order.
//
// The tree of a part is told in preorder, lower halves first, one byte a node:
//   bits 0 to 3   0 to 5: a leaf of that CellKind; 6: undecided because of tolerances; 7: not judged; 8: halved
//   bits 4 and 5  if halved: along which axis
//   bit 6         CellVerdict::regular
//   bit 7         two bytes follow: CellVerdict::reason; otherwise the reason is 0
// Eight bytes follow a leaf that is not judged: what is proved of the cell around it (CellVerdict::proved). The lowest
// byte of a number comes first.
#pragma once

#include <array>
#include <cstddef>
#include <memory>
#include <stdexcept>
#include <string>
#include <string_view>
#include <vector>

#include "map/known_verdicts.h"

namespace taut {

/// The bytes of a tree are none of this part.
class MalformedTree : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

/// What is known of some cells, level by level: a cell's level is how often the space was halved to make it.
struct TreeExtent {
  static constexpr std::size_t kLevels = kMaxCellHalvings + 1;

  std::array<double, kLevels> decided{};      ///< the share of the space that cells of a level decide, exactly
  std::array<std::size_t, kLevels> halved{};  ///< cells of a level that are halved
  std::size_t first_open = kLevels;           ///< the level of the largest cell that is not judged; else kLevels

  [[nodiscard]] bool is_complete() const { return first_open == kLevels; }
  /// Adds what is known of cells that lie in one that is not judged.
  void add(const TreeExtent& part);
  /// Of the whole space, where all cells of this level and of those before it are judged and of no others: the share
  /// that is undecided, exactly, and the number of cells.
  [[nodiscard]] double undecided(std::size_t level) const;
  [[nodiscard]] std::size_t cells(std::size_t level) const;
};

class MapParts {
 public:
  /// Cells are made parts by no fewer halvings, and by no more: there are 4096 parts at most.
  static constexpr int kLeastHalvings = 6, kMostHalvings = 12;

  /// Divides the space into parts. @throws InputError as make_cell_proof().
  MapParts(const Problem& problem, const MapSpace& space, double least_width);

  [[nodiscard]] std::size_t size() const { return cells_.size(); }
  /// By how many halvings of the space parts are made: half of those that make the least cells.
  [[nodiscard]] int halvings() const { return halvings_; }
  [[nodiscard]] const Cell& cell(std::size_t part) const { return cells_.at(part).cell; }
  /// What is known without the parts, which count as complete here.
  [[nodiscard]] const TreeExtent& top() const { return top_extent_; }
  /// The tree of a part of which nothing is known.
  [[nodiscard]] std::string start(std::size_t part) const;

  /// Judges all cells of a part that are made by fewer than `halvings` halvings of the space. Thread-safe; a function
  /// of its arguments.
  /// @param tree  what is known of the part
  /// @throws MalformedTree
  [[nodiscard]] std::string refine(std::size_t part, std::string_view tree, int halvings) const;

  /// Checks a tree from its first byte to its last: that it covers the part's cell, each place once, that its cells are
  /// halved as they should be, and no further than they may be. @throws MalformedTree
  [[nodiscard]] TreeExtent extent(std::size_t part, std::string_view tree) const;

  /// Whether assemble() needs nothing that is not known. @param all  of the top and of all parts
  [[nodiscard]] static bool is_enough(const TreeExtent& all, const SubdivisionOptions& options);

  /// The map that subdivide() makes with these options, bit for bit. The parts are proved to cover the space: each
  /// place is in one cell, but for the cells' faces.
  /// @param trees  of all parts, each once, in order
  /// @throws MalformedTree; std::logic_error where is_enough() does not hold.
  [[nodiscard]] CellMap assemble(const std::vector<std::string>& trees, const SubdivisionOptions& options) const;

 private:
  struct Part {
    Cell cell;
    std::uint64_t proved = 0;
  };

  MapSpace space_;
  HalvingRule rule_;
  int halvings_;
  std::unique_ptr<CellProof> proof_;
  std::string top_;  ///< the tree of the whole: its leaves that are not judged are the parts, in order
  std::vector<Part> cells_;
  TreeExtent top_extent_;
};

}  // namespace taut
