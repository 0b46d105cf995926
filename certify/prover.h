// SPDX-License-Identifier: GPL-3.0-or-later
// Proves or refutes one segment, or says of each part of it which of the two holds.
//
// Prover::prove() and Prover::survey() are the same walk along a segment (segment_walk.h); prove() ends it at the first
// box that is not proved.
#pragma once

#include <array>
#include <memory>
#include <mutex>
#include <optional>
#include <span>
#include <stop_token>

#include "certify/bodies/clear_poses.h"
#include "certify/bodies/nearest.h"
#include "certify/precision_ladder.h"
#include "certify/segment_proof.h"
#include "kinematics/constraint_functions.h"
#include "kinematics/pose_sampler.h"

namespace taut {

struct ProofOptions {
  /// The last rung of the ladder [bits], at least 128: only what is exactly zero, or takes more, stays undecided.
  mpfr_prec_t max_bits = 4096;
  int max_boxes = 200'000;                ///< boxes judged in one segment
  int max_multiprecision_boxes = 10'000;  ///< of them in MPFR, each of which takes about a millisecond
  /// Depth from which a box for which no motion on the constraints was proved climbs the ladder, and is not split.
  int motion_depth = 12;
  /// Depth from which a box that can't be inverted climbs the ladder and is examined for a change of sign of det J.
  int singular_depth = 16;
  /// Depth from which a box is given up whose margin deviations may exceed: a smaller box would hardly narrow what they
  /// may do.
  int tolerance_depth = 6;
};

enum class ProofAim {
  kDecide,  ///< proved, refuted, or undecided
  kProve,   ///< what is not proved is undecided, soon: nothing is looked for that refutes it
};

/// A problem ready to be proved about, at every rung of the ladder. Immutable; share it between threads.
class Prover {
 public:
  /// @throws InputError if the problem can't be enclosed (E not positive definite).
  explicit Prover(const Problem& problem, ProofOptions options = {});

  /// The straight segment a→b; where the space has constraints, with its suitable_tube().
  [[nodiscard]] Segment segment(const Waypoint& a, const Waypoint& b) const;
  /// Four times the distance from the segment to the constraints, as floating point finds it; 2^-30, which will prove
  /// nothing, where it finds none. @pre The space has constraints.
  [[nodiscard]] double suitable_tube(const Segment& segment) const;

  /// Whether the cables' lengths decide where the machine is along a path of this law.
  [[nodiscard]] bool is_length_controlled(Interpolation law) const;
  /// `segment` with the tubes that it needs; under the law of cable lengths with inner poses, too (reference_path.h).
  [[nodiscard]] Segment prepared(Segment segment) const;

  /// Claim (docs/certificate-format.md): for every s in [0, 1] the motion γ(s) exists (segment.h), its parameters stay
  /// in their closed ranges, and for every wrench in K at γ(s), J is non-singular and all tensions and lengths are
  /// strictly inside their limits; and all checked pairs of bodies are farther apart than their clearances. With a
  /// `clearance` from limits (judge_box) the proof also fails, as undecided, where the segment
  /// comes closer to a limit than that. A proof that `stop` cuts short is undecided, "interrupted".
  /// @param clear  clear_poses() of a stretch of a path that the segment is part of; null: nothing is known
  /// Thread-safe; restores the caller's rounding mode.
  [[nodiscard]] SegmentProof prove(const Segment& segment, double clearance = 0, const std::stop_token& stop = {},
                                   ProofAim aim = ProofAim::kDecide, const ClearPoses* clear = nullptr) const;
  [[nodiscard]] SegmentProof prove(const Waypoint& a, const Waypoint& b, double clearance = 0,
                                   const std::stop_token& stop = {}, ProofAim aim = ProofAim::kDecide) const {
    return prove(segment(a, b), clearance, stop, aim);
  }

  /// Which bodies stay apart at all poses near these, for proofs of segments among them. Null where nothing is known,
  /// or where deviations decide: there are tolerances.
  [[nodiscard]] std::unique_ptr<const ClearPoses> clear_poses(std::span<const RigidPose> poses, const ClearPoses* wider,
                                                              ClearPoses::Use use) const;

  /// The claim of prove() box by box, where it does not stop at what it can't prove: for paths of which all violations
  /// are asked for. A segment that is proved costs what prove() takes. Boxes that `stop` leaves are open,
  /// "interrupted".
  [[nodiscard]] SegmentSurvey survey(const Segment& segment, const std::stop_token& stop = {}) const;

  /// One box, at the cheapest rung that decides it. Bodies are not judged.
  [[nodiscard]] BoxVerdict judge(const Segment& segment, const DyadicBox& box) const;

  /// Encloses what a witness of a limit is about, at the midpoint of its box: f0 − v, f0 + v [N], d [m] or the
  /// magnitude of a rate of a move [SI], for all times at which it is there. At the least precision at which the limit
  /// is seen to be broken, else at the highest that works. @throws std::logic_error if there is none.
  [[nodiscard]] MpInterval witnessed_quantity(const Segment& segment, const SegmentWitness& witness) const;

  /// Of a segment that is not admissible because of a range: ": px is 1.7, its range is from -1.5 to 1.1 (SI: m, rad)".
  /// Empty where there is no such parameter.
  [[nodiscard]] std::string range_violation(const Segment& segment) const;
  /// Whether all control points are such as the law asks for, and certainly in their ranges where it runs through
  /// parameters.
  [[nodiscard]] bool is_admissible(const Segment& segment) const;
  /// Whether λ lies in the closed ranges of the parameters, certainly. Then so does every segment between two such
  /// waypoints.
  [[nodiscard]] bool certainly_in_ranges(const Waypoint& waypoint) const;

  [[nodiscard]] const Problem& problem() const { return problem_; }
  [[nodiscard]] const ProofOptions& options() const { return options_; }
  [[nodiscard]] const PrecisionLadder& ladder() const { return ladder_; }
  [[nodiscard]] const ProofModel<Interval>& model() const { return ladder_.binary64(); }
  /// The problem in floating point, for guesses; made when it is first needed.
  [[nodiscard]] const PoseSampler& sampler() const;
  /// Its bodies, likewise; null where it has none.
  [[nodiscard]] const BodySampler* bodies() const { return bodies_ ? &*bodies_ : nullptr; }

 private:
  /// Of moves that are run so everywhere; what it proves of them is not what prove() claims.
  Prover(const Problem& problem, ProofOptions options, const std::optional<Slowing>& slowing);

  /// Whether it is a move of which more is claimed than that it can be run as its law says.
  [[nodiscard]] bool may_stop(const Segment& segment) const;
  /// That it is run as its law says, or slowed down in one of extreme_slowings(); made when it is first needed.
  [[nodiscard]] const Prover& run(const std::optional<Slowing>& slowing) const;
  [[nodiscard]] std::optional<SegmentProof> refute_by_slowing(const Segment& segment, double clearance,
                                                              const std::stop_token& stop) const;
  [[nodiscard]] MpInterval margin_at_mid(const Segment& segment, const DyadicBox& box, MarginId margin) const;
  [[nodiscard]] MpInterval rate_at_mid(const Segment& segment, const DyadicBox& box, RateId rate) const;

  Problem problem_;
  ProofOptions options_;
  bool is_slowed_;  ///< a move that may be slowed down is so, everywhere
  std::optional<ConstraintFunctions> constraints_;
  PrecisionLadder ladder_;
  mutable std::once_flag sampler_made_;
  mutable std::optional<PoseSampler> sampler_;
  std::optional<BodySampler> bodies_;
  struct Run {
    std::once_flag made;
    std::unique_ptr<const Prover> prover;
  };
  mutable std::array<Run, 1 + std::tuple_size_v<decltype(extreme_slowings())>>
      runs_;  ///< run(): that by the law, and the others
};

}  // namespace taut
