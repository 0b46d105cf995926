// SPDX-License-Identifier: GPL-3.0-or-later
// Plans a move in time along a path that is proved at rest: a time law that is proposed (time_optimal.h) and then
// proved, with inertia and all limits in time.
//
// Where a proposal is not proved, its limits are tightened around the places where proofs failed, a few times; then the
// whole move is slowed down evenly, until it is proved. A path that is proved at rest leaves something to every
// tension, so that slow enough is always possible. If a law keeps all limits, one that is evenly slower keeps them,
// too,
// but for those of power, since what inertia takes goes with the square of the speed, and K is convex. It is proved
// again all the same.
#pragma once

#include <functional>
#include <optional>
#include <stop_token>

#include "case/case_file.h"
#include "certify/path_proof.h"
#include "planner/time_optimal.h"

namespace taut {

/// The least share of its planned speed at which a move may be asked for.
inline constexpr double kLeastSpeed = 1e-3;

/// What is asked of a move besides the limits.
struct MoveRequest {
  double speed_share = 1;             ///< of the planned speed, from kLeastSpeed to 1
  bool seeks_greatest_speed = false;  ///< how fast the law could be run
};

/// How fast a planned law could be run, in shares of its speed. The move that is returned runs at `proved`.
struct GreatestSpeed {
  double proved = 1;                        ///< the largest share that was proved
  std::optional<double> refuted = {};       ///< the smallest share that was refuted; there may be none
  std::optional<PathWitness> witness = {};  ///< and what stands in its way
};

struct MoveStatistics {
  std::optional<double> fastest_s =
      {};                  ///< the fastest law without a limit of jerk, in floating point, if one was found
  double planned_s = 0;    ///< of the law that was proved first
  double duration_s = 0;   ///< of the law of the path
  double speed_share = 1;  ///< planned_s over duration_s
  int tries = 0;           ///< laws that were to be proved
  double plan_seconds = 0;
  double prove_seconds = 0;
  std::optional<GreatestSpeed> greatest = {};
};

struct PlannedMove {
  Path path;  ///< with a law
  PathProof proof;
  MoveStatistics statistics;
};

/// @param path  without a law; straight segments or a spline, proved at rest
/// @returns the proved move; one that is refuted or undecided where even the slowest try was not proved, or `stop` came
/// before one was.
/// @throws InputError if the path has more segments than a law can have corners.
[[nodiscard]] PlannedMove plan_move(const Case& the_case, const Prover& prover, const Path& path,
                                    const MoveRequest& request, const std::stop_token& stop,
                                    const std::function<void(int tries)>& progress);

/// What deviations within the tolerances take of tensions along a path at rest, as TimedPathProblem asks for it; empty
/// where there are no tolerances.
[[nodiscard]] std::vector<TensionLoss> tension_losses(const Prover& prover, const Path& path, std::size_t grid);

/// A slow law that rests at both ends, and at the corners of straight segments: a second each.
[[nodiscard]] TimeLaw resting_law(const Path& path);

}  // namespace taut
