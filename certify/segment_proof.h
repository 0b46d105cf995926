// SPDX-License-Identifier: GPL-3.0-or-later
// What is proved of one segment (prover.h).
#pragma once

#include <memory>
#include <optional>
#include <vector>

#include "certify/arithmetic/dyadic.h"
#include "certify/bodies/body_gaps.h"
#include "certify/motion/slowing.h"
#include "certify/tolerance/deviation.h"
#include "certify/undecided.h"
#include "kinematics/margin.h"
#include "kinematics/time_limits.h"

namespace taut {

enum class Verdict { kProved, kRefuted, kUndecided };

/// What refutes a segment, itself proved: a margin that is not positive at the midpoint of `box`, bodies that are too
/// near there, or det D of opposite signs at its two ends.
struct SegmentWitness {
  bool singular = false;
  MarginId margin;  ///< unless singular, or bodies are too near
  DyadicBox box;
  std::shared_ptr<const Deviation> deviation = nullptr;  ///< of the machine whose margin it is; null: undisturbed
  std::optional<PairContact> contact = {};
  std::optional<RateId> rate = {};      ///< at its limit or beyond it, at the midpoint of `box`
  std::optional<Slowing> slowing = {};  ///< how a move that may be slowed down is run there; none: at full speed
};

struct SegmentProof {
  Verdict verdict = Verdict::kUndecided;
  std::vector<DyadicBox> boxes;  ///< cover [0, 1] in order; only if proved
  double tension_N = 0;          ///< proved lower bounds along the segment; only if proved
  double length_m = 0;
  double wrench_scale = 0;
  double clearance_m = 0;  ///< of all pairs of bodies, beyond their clearances; infinite where there are none
  std::vector<std::shared_ptr<const PairDirections>> directions;  ///< of each box, where the problem has bodies
  std::optional<SegmentWitness> witness;                          ///< only if refuted
  DyadicBox open_box;                                             ///< only if undecided: the smallest box left
  Reason reason;                                                  ///< only if undecided
  int boxes_judged = 0;                                           ///< including those that were split
  int boxes_multiprecision = 0;
};

/// A part of a segment, and what is known about it.
struct SurveyedBox {
  enum class Kind {
    kProved,
    kViolated,        ///< at every point of it, by one margin
    kViolatedInside,  ///< at the witness
    kSingular,        ///< somewhere between its ends
    kOpen,
  };
  DyadicBox box;
  Kind kind = Kind::kOpen;
  /// Within `box`; unless kProved or kOpen. Where the box is kViolated, the midpoint of any box within it will do.
  std::optional<SegmentWitness> witness;
  Reason reason;                                               ///< only if kOpen
  std::shared_ptr<const PairDirections> directions = nullptr;  ///< only if kProved, where the problem has bodies
};

struct SegmentSurvey {
  std::vector<SurveyedBox> boxes;  ///< cover [0, 1] in order
  double tension_N = 0;            ///< proved lower bounds over the boxes that are proved; infinite where none is
  double length_m = 0;
  double wrench_scale = 0;
  double clearance_m = 0;
  int boxes_judged = 0;
  int boxes_multiprecision = 0;
};

}  // namespace taut
