// SPDX-License-Identifier: GPL-3.0-or-later
// What a campaign is asked, and what it counts.
#pragma once

#include <array>
#include <atomic>
#include <cstdint>
#include <optional>

#include "tests/soundness/trial.h"

namespace taut::campaign {

inline constexpr int kDecades = 13;      // δ/range in [1e-13, 1]
inline constexpr int kLeastEffect = -8;  // δ/effect in [1e-8, 1e5], and beyond
inline constexpr double kMild = 0.01;    // effect/range up to which tolerances are mild

using Count = std::atomic<long>;

struct Decades {
  std::array<Count, kDecades> violated{}, violated_refuted{}, clear{}, clear_decided{};
};

struct Counts {
  Count trials{0}, skipped{0}, proved{0}, refuted{0}, undecided{0}, boxes{0}, multiprecision{0};
};

/// Of trials with bodies.
struct BodyTally {
  /// (least distance − clearance)/size without tolerances, on paths of poses and of cable lengths; with tolerances.
  std::array<Decades, 3> decades;
  std::array<std::array<Counts, kToleranceKinds>, kLaws> counts;
  std::array<std::array<Count, 3>, kPairClasses + 1> classes;  ///< of the pair that decides: proved, refuted, undecided
  Count zones{0};                                              ///< trials with a pair that may touch somewhere
  Count with_clear_poses{0};                                   ///< proofs that were told what is known of poses around
  Count walls{0}, walls_refuted{0};  ///< thinner than a sample: points of both bodies that meet are known
  Count pairs{0};                    ///< distances that were computed after proofs, in 200 bits
};

struct Tally {
  /// δ/range exactly on a path, and by lengths; δ/effect with tolerances that are mild, and with others; δ/range by
  /// lengths with a bad reference, and with a lost row.
  std::array<Decades, 6> decades;
  std::array<std::array<Counts, kToleranceKinds>, kLaws> counts;
  std::array<std::array<Count, 3>, 4> angles;  ///< of each AngleKind: proved, refuted, undecided
  Count wrong{0}, looked_at{0}, violated_elsewhere{0};
  Count crossing{0}, crossing_refuted{0};  ///< segments along which det J changes its sign
  Count surveyed{0};
  /// Of points that were judged: margins, those asked of 200 bits, and those whose bound in binary64 was held to them.
  Count margins{0}, margins_exact{0}, margins_compared{0};
  Count kernel_asked{0};                        ///< boxes with a violation inside that the checker's kernel was given
  Count kernel_proofs{0}, kernel_confirmed{0};  ///< proofs that it was given, and those for which it found boxes
  BodyTally bodies;
};

struct Options {
  long count = 2000;
  std::uint64_t seed = 20261121;
  std::optional<Law> law;
  std::optional<ToleranceKind> tolerances;
  std::optional<LoadKind> loads;
  std::optional<bool> bodies;  ///< all trials, or none, are of bodies
  bool list_undecided = false;
  std::uint64_t surveys =
      16;  ///< of so many seeds one is surveyed, and judged if det J changes its sign: a hundred times the work
  std::uint64_t kernels = 1;  ///< of so many seeds one is given to the checker's kernel
  int decades = kDecades;     ///< only the so many smallest decades of δ
  int multiprecision = ProofOptions().max_multiprecision_boxes;
};

}  // namespace taut::campaign
