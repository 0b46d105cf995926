// SPDX-License-Identifier: GPL-3.0-or-later
// Proves a path segment by segment, on all cores.
#pragma once

#include <functional>
#include <optional>
#include <stop_token>
#include <string>
#include <vector>

#include "certify/prover.h"

namespace taut {

/// Where on a path: waypoint `index`, or the point s of segment `index`.
struct PathPoint {
  bool on_segment = false;
  int index = 0;
  Dyadic s;  ///< only on a segment
};

/// What refutes a path, proved.
struct PathWitness {
  PathPoint at;
  bool singular = false;
  PathPoint to;                             ///< the second point; only if singular
  std::optional<PairContact> contact = {};  ///< only if bodies are too near; then nothing below is set,
  DecimalText depth_m;                      ///< but that they are nearer by this much than allowed, or more
  MarginId margin;                          ///< unless singular
  DecimalText value_lower, value_upper;     ///< enclosure of f0 − v, f0 + v or d [N, m]; unless singular
  DecimalText limit;                        ///< the limit it violates; unless singular, or of a rate
  std::optional<RateId> rate = {};          ///< of a move: what is proved too fast; then `margin` means nothing
  std::shared_ptr<const Deviation> deviation = nullptr;  ///< within the tolerances; null: of the undisturbed machine
  std::optional<Slowing> slowing = {};                   ///< how a move that may be slowed down is run there, if it is
};

struct Margins {
  DecimalText tension_N, length_m, wrench_scale;  ///< decimals, rounded down
  std::optional<DecimalText> clearance_m = {};    ///< where the problem has bodies
};

/// Proved lower bounds as decimals.
[[nodiscard]] Margins margins_below(double tension_N, double length_m, double wrench_scale,
                                    std::optional<double> clearance_m = {});

struct PathProof {
  Verdict verdict = Verdict::kUndecided;
  std::vector<SegmentProof> segments;  ///< one a segment; complete only if proved
  std::optional<PathWitness> witness;  ///< only if refuted
  Reason reason;                       ///< only if undecided
  int open_segment = -1;               ///< only if undecided
  long boxes = 0;
  long boxes_judged = 0;
};

/// The proof of a segment if it was made before, else null: so that a planner's proofs are not made twice.
using KnownProof = std::function<const SegmentProof*(const Segment& segment)>;

/// Verdict for the whole path, and if it has a law, for the move. A path of one waypoint is refuted if that is
/// infeasible, else undecided ("no segment").
/// @throws InputError where the law is none of a move along this path (time_law.h)
[[nodiscard]] PathProof prove_path(const Prover& prover, const Path& path, const KnownProof& known = {},
                                   const std::stop_token& stop = {}, ProofAim aim = ProofAim::kDecide);

/// What refutes segment `index` of a path, as a statement about the path.
[[nodiscard]] PathWitness path_witness(const Prover& prover, const Segment& segment, int index,
                                       const SegmentWitness& witness);

/// Tries to prove or refute one pose. Returns the witness if it is refuted, about the limit that is broken most, else
/// nothing; `undecided` is set to a reason if it could not be proved either.
[[nodiscard]] std::optional<PathWitness> refute_waypoint(const Prover& prover, const Waypoint& waypoint, int index,
                                                         Reason& undecided, const std::stop_token& stop = {});

/// The binary64 nearest to the exact value of a constant expression (ties to even).
/// @throws InputError if it is not finite or can't be told at 4096 bits.
[[nodiscard]] double nearest_binary64(const ExpressionText& expression);

/// The waypoints of the query, each coordinate moved to the nearest binary64; with their normals where the space has
/// constraints.
[[nodiscard]] std::vector<Waypoint> query_waypoints(const Problem& problem);

}  // namespace taut
