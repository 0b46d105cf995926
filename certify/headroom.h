// SPDX-License-Identifier: GPL-3.0-or-later
// What stands in the way of a path's proof, or by how much it succeeds.
//
// Shares are proved: "62 % of all tolerances and deviations" means that the whole path was proved for every machine and
// load within 62 % of them. Floating point only guesses where to look, and names the place.
#pragma once

#include <functional>
#include <optional>
#include <stop_token>
#include <vector>

#include "certify/free_ends.h"
#include "certify/path_proof.h"
#include "certify/prover.h"
#include "kinematics/margin_budget.h"
#include "problem/scaled.h"

namespace taut {

/// The largest share of an uncertainty, all others as stated, at which the whole path was proved.
struct ProvableShare {
  Uncertainty of{};
  double stated = 0;        ///< size_of(): 0 where the case states none
  DecimalText share = "0";  ///< of what is stated; of a tolerance that is not stated, in with_unit_uncertainty()'s unit
  double proved = 0;        ///< the size that was proved, rounded down
  bool is_complete = true;  ///< false: time ended the search, and a larger share may be provable
};

/// The place of a path where the least is left, in floating point and to first order.
struct TightPlace {
  std::size_t segment = 0;
  double s = 0;
  bool singular = false;  ///< then there is no budget
  MarginBudget budget;    ///< of the margin that is in the way
};

struct Headroom {
  /// What the shares are about: the path; a single waypoint of the query; where a planner found no path, the straight
  /// way through the query's waypoints; or a move, by its law.
  enum class Subject { kPath, kWaypoint, kStraightWay, kMove };
  Subject subject = Subject::kPath;
  std::size_t waypoint = 0;              ///< of the query; only of kWaypoint
  std::vector<ProvableShare> shares;     ///< kAll first; none of a proved path where nothing is uncertain
  std::optional<TightPlace> tightest;    ///< nothing of a path without samples
  std::optional<bool> nominal_provable;  ///< where no share of all is provable: whether the nominal machine alone is
  std::optional<PathWitness> nominal_violation;  ///< what refutes the nominal machine, proved; no limit of a rate
  std::optional<ProvedFreeEnds> free_ends = {};  ///< of an unproved path: what lets it be proved
};

/// Options of a proof that is a trial: one that fails should do so soon.
inline constexpr ProofOptions kTrial = {.max_bits = 128,
                                        .max_boxes = 2000,
                                        .max_multiprecision_boxes = 1,
                                        .motion_depth = 5,
                                        .singular_depth = 6,
                                        .tolerance_depth = 4};

/// How many shares were sought, of how many. Calls don't overlap.
using HeadroomProgress = std::function<void(std::size_t done, std::size_t all)>;

/// Where on the path the least is left of a margin. Of a move, what inertia takes is taken off.
[[nodiscard]] std::optional<TightPlace> tightest_place(const Problem& problem, const Path& path);

/// Seeks the largest provable share of all uncertainties and of each alone, to within some 3 %, by bisection around
/// what floating point expects; of an unproved path longer free ends of cables, too (find_free_ends()). Of a proved
/// path, tolerances that are not stated grow from nothing; that of cable lengths only where lengths are controlled,
/// and that of the load along w0; with load items, neither that of the load nor that of its point. A share that has not
/// been proved when `stop` is requested is not stated.
/// @param verdict       of the path with the problem as it is
/// @param wrench_scale  its proved margin, if the path is proved: without tolerances, that is the share
[[nodiscard]] Headroom find_headroom(const Problem& problem, const Path& path, Verdict verdict,
                                     const DecimalText& wrench_scale, const HeadroomProgress& progress,
                                     const std::stop_token& stop);

}  // namespace taut
