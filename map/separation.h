// SPDX-License-Identifier: GPL-3.0-or-later
// Whether two places are apart for the machine exactly as typed: a map that is refined only where that matters.
//
// Undecided cells are halved, the largest first, that hang together with the first place by cells that are not outside
// (topology.h). As soon as the second place does not, the two are apart.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "map/topology.h"

namespace taut {

struct SeparationOptions {
  double least_width = 1.0 / (1 << 16);  ///< no axis is halved to cells narrower than this share of it
  std::size_t most_cells = 2'000'000;    ///< leaves
  double seconds = 10;
  std::stop_token stop = {};
};

/// Undecided cells that lie between the two places.
struct OpenPlace {
  std::vector<double> at;          ///< its middle: t of each axis
  std::vector<double> half_width;  ///< of the cell in its middle, likewise
  std::size_t cells = 0;           ///< undecided ones, on a way that passes as few of them as any
};

struct Separation {
  enum class Answer {
    kApart,   ///< no feasible motion of the coordinates leads from one to the other
    kJoined,  ///< inside cells join them: a motion exists, every pose of which is feasible
    kOpen,    ///< neither is proved
  };
  Answer answer = Answer::kOpen;
  CellMap map;
  std::vector<bool> reached;     ///< by node: leaves that hang together with the first place and are not outside
  std::optional<OpenPlace> gap;  ///< where open
  double open_share = 0;         ///< of the space's volume: the undecided cells that hang together with the first place
};

/// By node: the leaves of a map that are not outside and hang together with a place.
[[nodiscard]] std::vector<bool> reached_leaves(const CellMap& map, const std::vector<MapBox>& from);

/// @param problem  its tolerances do not matter
/// @throws InputError as make_cell_proof()
[[nodiscard]] Separation separate(const Problem& problem, const MapSpace& space,
                                  const std::vector<ExpressionText>& from, const std::vector<ExpressionText>& to,
                                  const SeparationOptions& options = {});

}  // namespace taut
